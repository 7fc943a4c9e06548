#include "cli/parse.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "base/text.h"
#include "cli/tool.h"

namespace goniochrome::cli::parse_test {
namespace {

struct Values {
  std::string output = "-";
  std::string method = "l2";
  double tolerance = 0.5;
  int size = 0;
  bool quiet = false;
  std::vector<std::string> parts;
  std::vector<double> exponents;
  std::vector<std::string> inputs;
};

ToolSpec table(Values& v) {
  ToolSpec spec;
  spec.name = "sample-tool";
  spec.summary = "do nothing, for a test";
  spec.description = {"One paragraph."};
  spec.heading = "output";
  spec.option("output,o", "FILE", "x", &v.output, "where to write");
  spec.heading = "method";
  spec.option("method", "M", "l1", &v.method, "how").one_of({"l1", "l2"});
  spec.option("tolerance", "DE", "0.1", &v.tolerance, "error").from(0, 1).in("units").more("It is relative.");
  spec.option("size", "N", "64", &v.size, "texels").from(1);
  spec.flag("quiet", &v.quiet, "silence");
  spec.option("part", "NAME=PAINT", "A=b", &v.parts, "paint of a part");
  spec.option("exponents", "N,...", "1,2.5", &v.exponents, "exponents");
  spec.inputs = Positional{"FILE", "files to read", &v.inputs, 0, 2};
  spec.examples = {{"sample-tool -o x", "writes x"}};
  spec.report = {{"lobes[].time_s", "seconds"}};
  return spec;
}

Result<void> parsed(Values& v, const std::vector<std::string>& arguments) {
  return parse(table(v), arguments);
}

std::string message(const std::vector<std::string>& arguments) {
  Values v;
  const auto result = parsed(v, arguments);
  return result.ok() ? "" : result.error().message;
}

TEST(Parse, ValuesReachTheirTargets) {
  EXPECT_EQ(message({"--quiet", "-"}), "");
  EXPECT_EQ(message({"in", "-"}), "");
  EXPECT_EQ(message({"--tolerance", "1e-3"}), "");
  EXPECT_EQ(message({"--exponents", "1,2.5", "in"}), "");
  EXPECT_EQ(message({"--part", "1,2.5", "--part", "in"}), "");
  Values v;
  ASSERT_TRUE(parsed(v, {"-o", "x", "--method=l1", "--tolerance", "1e-3", "--size", "64", "--quiet", "--part", "A=b",
                         "--part", "C=d", "--exponents", "1,2.5", "in", "-"})
                  .ok());
  EXPECT_EQ(v.output, "x");
  EXPECT_EQ(v.method, "l1");
  EXPECT_EQ(v.tolerance, 1e-3);
  EXPECT_EQ(v.size, 64);
  EXPECT_TRUE(v.quiet);
  EXPECT_EQ(v.parts, (std::vector<std::string>{"A=b", "C=d"}));
  EXPECT_EQ(v.exponents, (std::vector<double>{1, 2.5}));
  EXPECT_EQ(v.inputs, (std::vector<std::string>{"in", "-"}));
}

TEST(Parse, ItIsKnownWhetherAnOptionWasGiven) {
  for (const bool given : {false, true}) {
    CommonOptions common;
    ToolSpec spec{.name = "sample-tool"};
    spec.heading = "sampling";
    add_tolerance(spec, common, "DE00", "largest difference");
    std::vector<std::string> arguments;
    if (given) arguments = {"--tolerance", shortest(common.tolerance)};
    ASSERT_TRUE(parse(spec, arguments).ok());
    EXPECT_EQ(common.tolerance_given, given);
    EXPECT_EQ(common.tolerance, CommonOptions{}.tolerance);
  }
}

TEST(Parse, NegativeNumbersAreValues) {
  Values v;
  ASSERT_TRUE(parsed(v, {"--exponents", "-1,-2"}).ok());
  EXPECT_EQ(v.exponents, (std::vector<double>{-1, -2}));
}

TEST(Parse, AMistakeIsToldWithOptionValueAndRemedy) {
  EXPECT_EQ(message({"--size", "64abc"}), "--size is \"64abc\": give a whole number of 1 or more");
  EXPECT_EQ(message({"--size", "0"}), "--size is \"0\": give a whole number of 1 or more");
  EXPECT_EQ(message({"--tolerance", "1,5"}), "--tolerance is \"1,5\": give a number from 0 to 1");
  EXPECT_EQ(message({"--method", "l3"}), "--method is \"l3\": give l1, l2");
  EXPECT_EQ(message({"--methd", "l1"}), "unknown option --methd: did you mean --method?");
  EXPECT_EQ(message({"--zzzzzzzz"}), "unknown option --zzzzzzzz: `sample-tool --help` lists them");
  EXPECT_EQ(message({"--size"}), "--size needs a value");
  EXPECT_EQ(message({"--size", "1", "--size", "2"}), "--size is given 2 times: give it once");
  EXPECT_EQ(message({"a", "b", "c"}), "3 inputs are given: sample-tool takes at most 2");
}

TEST(Parse, AnAliasIsTheSameOption) {
  Values v;
  ToolSpec spec = table(v);
  std::ranges::find(spec.options, "size", &Option::name)->alias = "width";
  ASSERT_TRUE(parse(spec, {"--width", "64"}).ok());
  EXPECT_EQ(v.size, 64);
  EXPECT_EQ(parse(spec, {"--width", "1", "--size", "2"}).error().message, "--size is given 2 times: give it once");
  EXPECT_NE(help_text(spec).find("; also --width"), std::string::npos);
}

TEST(Parse, AnOptionThatIsGoneNamesWhatToUseInstead) {
  Values v;
  ToolSpec spec = table(v);
  spec.gone = {{"width", "give --size"}};
  for (const std::vector<std::string>& words : {std::vector<std::string>{"--width", "3"}, {"--width=3"}, {"--width"}}) {
    const auto result = parse(spec, words);
    ASSERT_FALSE(result.ok());
    EXPECT_EQ(result.error().message, "--width is gone: give --size");
    EXPECT_EQ(exit_status(result.error()), 2);
  }
  EXPECT_TRUE(man_page(spec).ends_with(".SH OPTIONS THAT ARE GONE\n.TP\n.B \\-\\-width\nGive \\-\\-size.\n"));
}

TEST(Parse, ARequiredOptionIsAskedFor) {
  Values v;
  ToolSpec spec = table(v);
  spec.options[0].required = true;
  const auto result = parse(spec, {});
  ASSERT_FALSE(result.ok());
  EXPECT_EQ(result.error().message, "--output FILE is missing: where to write");
  EXPECT_EQ(exit_status(result.error()), 2);
}

TEST(Texts, EveryOptionIsInHelpManPageAndCompletion) {
  Values v;
  const ToolSpec spec = table(v);
  std::string man = man_page(spec);
  for (std::size_t at; (at = man.find("\\-")) != std::string::npos;) man.replace(at, 2, "-");
  for (const Option& option : spec.options) {
    EXPECT_NE(help_text(spec).find("--" + option.name), std::string::npos);
    EXPECT_NE(man.find("--" + option.name), std::string::npos);
    EXPECT_NE(bash_completion(spec).find("--" + option.name), std::string::npos);
  }
}

TEST(Texts, OptionsStandUnderTheirHeadings) {
  Values v;
  const std::string help = help_text(table(v)), man = man_page(table(v));
  EXPECT_LT(help.find("\nmethod:\n"), help.find("--tolerance"));
  EXPECT_GT(help.find("\nmethod:\n"), help.find("--output"));
  EXPECT_LT(man.find(".SS Method\n"), man.find("tolerance"));
}

TEST(Texts, TheManPageTellsUnitDomainDefaultAndExample) {
  Values v;
  EXPECT_NE(man_page(table(v)).find("Error. It is relative. Value: units, from 0 to 1. Default: 0.5. "
                                    "Example: \\-\\-tolerance 0.1"),
            std::string::npos);
}

TEST(Texts, LinesWithHyphensAreAList) {
  Values v;
  ToolSpec spec = table(v);
  std::ranges::find(spec.options, "tolerance", &Option::name)->details = "It is:\n- small.\n- relative.";
  EXPECT_NE(man_page(spec).find("Error. It is:\n.RS\n.IP \\(bu 2\nsmall.\n.IP \\(bu\nrelative.\n.RE\n.IP\n"
                                "Value: units, from 0 to 1."),
            std::string::npos);
}

// The controls: a table without a fault, and one fault at a time.
TEST(Texts, WhatATableLacksIsTold) {
  Values v;
  EXPECT_EQ(table_faults(table(v)), std::vector<std::string>());
  const auto fault = [&](void (*spoil)(Option&)) {
    ToolSpec spec = table(v);
    spoil(*std::ranges::find(spec.options, "tolerance", &Option::name));
    const std::vector<std::string> faults = table_faults(spec);
    return faults.size() == 1 ? faults[0] : "";
  };
  EXPECT_EQ(fault([](Option& o) { o.category = ""; }), "sample-tool --tolerance: stands under no heading");
  EXPECT_EQ(fault([](Option& o) { o.unit = ""; }), "sample-tool --tolerance: its unit is not told");
  EXPECT_EQ(fault([](Option& o) { o.help = "error."; }),
            "sample-tool --tolerance: its help is not one line without a full stop");
  EXPECT_EQ(fault([](Option& o) { o.details = "It is  relative."; }),
            "sample-tool --tolerance: a blank too many in its text");
  EXPECT_EQ(fault([](Option& o) { o.example = "2"; }),
            "sample-tool --tolerance: refuses its own example: --tolerance is \"2\": give a number from 0 to 1");
}

TEST(Texts, ThePageNamesEveryOtherPageOnce) {
  Values v;
  ToolSpec spec = table(v);
  spec.see_also = {"goniochrome(7)", "fit-paint(1)"};
  const std::string man = man_page(spec);
  EXPECT_EQ(man.substr(man.find(".SH SEE ALSO")),
            ".SH SEE ALSO\n.BR goniochrome (7),\n.BR fit\\-paint (1),\n.BR goniochrome\\-paint (5)\n");
}

TEST(Texts, ThePageOpensWithItsFirstParagraphAndExamples) {
  Values v;
  ToolSpec spec = table(v);
  spec.description = {"First.", "# A title\nSecond.", "Third."};
  spec.examples = {{"sample-tool x", "do it"}};
  const std::string man = man_page(spec);
  const std::size_t at = man.find(".SH DESCRIPTION");
  EXPECT_EQ(man.substr(at, man.find(".SH OPTIONS") - at),
            ".SH DESCRIPTION\nFirst.\n.SH EXAMPLES\nDo it.\n.PP\n.nf\n.RS\nsample\\-tool x\n.RE\n.fi\n"
            ".SH DETAILS\n.SS A title\nSecond.\n.PP\nThird.\n");
}

TEST(Texts, ThePageGivesValuesOfTheReportAsTheyAre) {
  Values v;
  ToolSpec spec = table(v);
  spec.report = {{"status", "optimal or failed"}};
  EXPECT_NE(man_page(spec).find(".B status\noptimal or failed.\n"), std::string::npos);
}

int run_tool(const std::vector<std::string>& words, const std::function<Result<Verdict>(Session&)>& run,
             const CommonOptions& common = {}) {
  Values v;
  std::vector<std::string> storage = {"sample-tool"};
  storage.insert(storage.end(), words.begin(), words.end());
  std::vector<char*> argv;
  for (std::string& word : storage) argv.push_back(word.data());
  return tool_main(static_cast<int>(argv.size()), argv.data(), table(v), common, run);
}

TEST(Tool, TheExitStatusFollowsTheOutcome) {
  EXPECT_EQ(run_tool({}, [](Session&) { return Verdict::kDone; }), 0);
  EXPECT_EQ(run_tool({}, [](Session&) { return Verdict::kNegative; }), 1);
  EXPECT_EQ(run_tool({"--nonsense"}, [](Session&) { return Verdict::kDone; }), 2);
  EXPECT_EQ(run_tool({}, [](Session&) -> Result<Verdict> { return input_error("x: is bad"); }), 3);
  EXPECT_EQ(run_tool({}, [](Session&) { return Verdict::kStopped; }), 4);
  EXPECT_EQ(run_tool({}, [](Session&) -> Result<Verdict> { throw std::logic_error("broken"); }), 70);
}

TEST(Tool, QuietKeepsWhatExplainsAnExitStatus) {
  const auto told = [](Verdict verdict, bool quiet) {
    CommonOptions common;
    common.quiet = quiet;
    testing::internal::CaptureStderr();
    run_tool(
        {},
        [&](Session& session) {
          session.say("first");
          if (verdict != Verdict::kDone) session.say_verdict("too far");
          session.warn("left out");
          session.say("summary");
          return verdict;
        },
        common);
    return testing::internal::GetCapturedStderr();
  };
  EXPECT_EQ(told(Verdict::kDone, true), "");
  EXPECT_EQ(told(Verdict::kNegative, true), "too far\nsample-tool: warning: left out\nsummary\n");
  EXPECT_EQ(told(Verdict::kStopped, false), "first\ntoo far\nsample-tool: warning: left out\nsummary\n");
}

}  // namespace
}  // namespace goniochrome::cli::parse_test
