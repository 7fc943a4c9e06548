#include "formats/basis.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/scratch_for_test.h"
#include "base/testdata_for_test.h"
#include "formats/default_basis.h"

namespace goniochrome::formats::basis_test {
namespace {

using testing::HasSubstr;

TEST(BasisXml, SurvivesWithItsErrorTable) {
  const ScratchFolder folder;
  const Basis basis{"b\"7\"", {0.3, 1.3, 1e6}, true, {{1, 9.5, 2.25, 11.75}, {2, 1.0 / 3, 0.1, 0.5}}};
  ASSERT_TRUE(write_basis(folder.path("b.xml"), basis).ok());
  const auto back = read_basis(folder.path("b.xml"));
  ASSERT_TRUE(back.ok()) << back.error().message;
  EXPECT_EQ(back->name, basis.name);
  EXPECT_EQ(back->exponents, basis.exponents);
  EXPECT_TRUE(back->mirror);
  ASSERT_EQ(back->sets.size(), 2u);
  EXPECT_EQ(back->sets[1].lobes, 2);
  EXPECT_EQ(back->sets[1].max_error, 1.0 / 3);
  EXPECT_EQ(back->sets[1].objective, 0.5);
  const auto sample = read_basis(testdata("b7.basis.xml"));
  ASSERT_TRUE(sample.ok());
  EXPECT_EQ(sample->exponents, (std::vector<double>{1.3, 6, 20, 70, 250, 900, 3000}));
  EXPECT_TRUE(sample->mirror);
}

TEST(BasisXml, DefaultIsThatOfTheExamples) {
  const auto sample = read_basis(testdata("b7.basis.xml"));
  const auto stand_in = basis_or_default("");
  ASSERT_TRUE(sample.ok() && stand_in.ok());
  EXPECT_EQ(stand_in->name, sample->name);
  EXPECT_EQ(stand_in->exponents, sample->exponents);
  EXPECT_EQ(stand_in->mirror, sample->mirror);
  EXPECT_FALSE(basis_or_default("missing.xml").ok());
}

TEST(BasisXml, WhatIsNotFiniteIsNotWritten) {
  const ScratchFolder folder;
  for (const double wrong : {std::nan(""), HUGE_VAL}) {
    for (const Basis& basis : {Basis{"b", {1, wrong}, false, {}}, Basis{"b", {1, 2}, false, {{2, wrong, 1, 1}}}}) {
      const auto written = write_basis(folder.path("b.xml"), basis);
      ASSERT_FALSE(written.ok());
      EXPECT_THAT(written.error().message, HasSubstr("not finite"));
    }
  }
  EXPECT_EQ(folder.files(), 0u);
}

TEST(BasisXml, WrongValuesAreNamedWithLineAndRemedy) {
  const ScratchFolder folder;
  const auto error = [&](const std::string& body) {
    const auto basis = read_basis(
        folder.file("b.xml", "<basis xmlns=\"urn:goniochrome:basis:1\" name=\"b\">\n" + body + "\n</basis>\n"));
    EXPECT_FALSE(basis.ok()) << body;
    return basis.ok() ? "" : basis.error().message.substr(basis.error().message.rfind("b.xml"));
  };
  EXPECT_EQ(error("<exponent>1,5</exponent>"), "b.xml:2: exponent is \"1,5\": write a decimal point");
  EXPECT_EQ(error("<exponent>5</exponent>\n<exponent>5</exponent>"),
            "b.xml:3: exponent 5 follows 5: write them in ascending order, each once");
  EXPECT_EQ(error("<exponent>-1</exponent>"), "b.xml:2: exponent is -1: write 0 or more");
  EXPECT_EQ(error("<exponent>inf</exponent>"), "b.xml:2: exponent is \"inf\": write a finite number");
  EXPECT_THAT(error("<mirror/>"), HasSubstr("the basis has no <exponent>"));
  EXPECT_THAT(error("<exponent>1</exponent><lobe/>"), HasSubstr("<lobe> is not known inside <basis>"));
  EXPECT_THAT(error("<exponent>1</exponent><set lobes=\"1.5\" max=\"1\" mean=\"1\" objective=\"1\"/>"),
              HasSubstr("write a whole number"));
  EXPECT_EQ(error("<exponent>1</exponent><mirror/><exponent>2</exponent>"),
            "b.xml:2: <exponent> stands behind <mirror> or <set>: write the exponents first");
  EXPECT_THAT(error(""), HasSubstr("the basis has no <exponent>: give it at least one"));
  EXPECT_THAT(read_basis(testdata("paints.paints.xml")).error().message,
              HasSubstr("this begins with <paints>, not with a basis"));
  EXPECT_THAT(read_basis(folder.file("c.xml", "<basis xmlns=\"urn:goniochrome:basis:2\" name=\"b\"/>")).error().message,
              HasSubstr("c.xml:1: this <basis> is of the namespace \"urn:goniochrome:basis:2\": the first element"));
}

}  // namespace
}  // namespace goniochrome::formats::basis_test
