#include "formats/batches.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/scratch_for_test.h"

namespace goniochrome::formats::batches_test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

std::string document(const std::string& paints) {
  return "<paints xmlns=\"urn:goniochrome:paint:1\" version=\"1\">" + paints + "</paints>";
}

// The result of all batches.
struct Outcome {
  std::vector<std::string> names;
  std::vector<std::size_t> sizes;
  std::string error;
};

Outcome read_all(const std::vector<std::string>& paths, const std::vector<std::string>& only = {},
                 const std::function<void(const Error&)>& left_out = {}) {
  Outcome outcome;
  auto batches = PaintBatches::open(paths, only);
  if (!batches.ok()) return {{}, {}, batches.error().message};
  for (;;) {
    const auto batch = batches->next(left_out);
    if (!batch.ok()) outcome.error = batch.error().message;
    if (!batch.ok() || batch->empty()) return outcome;
    outcome.sizes.push_back(batch->size());
    for (const paint::Paint& paint : *batch) outcome.names.push_back(paint.name);
  }
}

class PaintBatchesTest : public testing::Test {
 protected:
  ScratchFolder folder_;
  const std::string first_ = folder_.file("1.xml", document("<paint name=\"a\"/><paint name=\"b\"/>"));
  const std::string second_ = folder_.file("2.xml", document("<paint name=\"c\"/><paint name=\"d\"/>"));
};

TEST_F(PaintBatchesTest, GiveAllPaintsOfAllInputsInOrder) {
  const Outcome all = read_all({first_, second_});
  EXPECT_THAT(all.names, ElementsAre("a", "b", "c", "d"));
  ASSERT_FALSE(all.sizes.empty());
  EXPECT_EQ(all.sizes.front(), 1u);  // so that a slow pipe is answered from its first paint on
  EXPECT_EQ(all.error, "");
}

TEST_F(PaintBatchesTest, GiveThePaintsOfTablesTooAndTellTheirWarnings) {
  const std::string table = folder_.file("3.csv", "sample,L15,a15,b15,odd\ne,50,1,2,x\n");
  auto batches = PaintBatches::open({first_, table});
  ASSERT_TRUE(batches.ok()) << batches.error().message;
  std::vector<std::string> names, warnings;
  for (;;) {
    const auto batch = batches->next();
    ASSERT_TRUE(batch.ok()) << batch.error().message;
    for (const std::string& warning : batches->take_warnings()) warnings.push_back(warning);
    if (batch->empty()) break;
    for (const paint::Paint& paint : *batch) names.push_back(paint.name);
  }
  EXPECT_THAT(names, ElementsAre("a", "b", "e"));
  EXPECT_THAT(warnings, testing::Contains(testing::HasSubstr("odd")));
}

TEST_F(PaintBatchesTest, GiveOnlyThePaintsOfTheNamesAsked) {
  const Outcome some = read_all({first_, second_}, {"d", "b", "d"});
  EXPECT_THAT(some.names, ElementsAre("b", "d"));
  EXPECT_EQ(some.error, "");
}

TEST_F(PaintBatchesTest, ANameThatNoPaintHasIsToldAtTheEnd) {
  const Outcome none = read_all({first_}, {"b", "B"});
  EXPECT_THAT(none.names, ElementsAre("b"));
  EXPECT_EQ(none.error, "no paint is named \"B\": names are taken letter by letter; did you mean \"b\"?");
}

TEST_F(PaintBatchesTest, AWrongPaintIsTheErrorOrToldAndPassedOver) {
  const std::string wrong = folder_.file("w.xml", document("<paint name=\"a\"/><paint name=\"x\" class=\"shiny\"/>"
                                                           "<paint name=\"b\"/>"));
  EXPECT_THAT(read_all({wrong}).error, testing::HasSubstr("shiny"));
  std::vector<std::string> told;
  const Outcome rest = read_all({wrong}, {}, [&](const Error& error) { told.push_back(error.message); });
  EXPECT_THAT(rest.names, ElementsAre("a", "b"));
  EXPECT_THAT(told, ElementsAre(testing::HasSubstr("shiny")));
  EXPECT_THAT(read_all({folder_.path("absent.xml")}).names, IsEmpty());
}

TEST_F(PaintBatchesTest, GiveThePaintsThatAnInputNames) {
  EXPECT_THAT(read_all({second_ + "#d", first_}).names, ElementsAre("d", "a", "b"));
  EXPECT_THAT(read_all({second_ + "#x", first_}).error, testing::HasSubstr("no paint is named \"x\""));
}

}  // namespace
}  // namespace goniochrome::formats::batches_test
