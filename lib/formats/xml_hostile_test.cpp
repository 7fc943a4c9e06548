// Hostile and broken XML, each with the textbook way of reading it beside ours.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <libxml/parser.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <locale>
#include <sstream>
#include <thread>

#include "base/clock.h"
#include "base/hard_case_for_test.h"
#include "base/scratch_for_test.h"
#include "base/text.h"
#include "formats/imported.h"
#include "formats/xml.h"

namespace goniochrome::formats::xml_hostile_test {
namespace {

using testing::HasSubstr;

const std::string kRoot = "<paints xmlns=\"urn:goniochrome:paint:1\" version=\"1\">\n";
const std::string kLab =
    "<measurement illuminant=\"D65\" observer=\"10\"><lab geometry=\"45as15\" L=\"41.87\" a=\"-45.99\" "
    "b=\"-21.73\"/></measurement>";

// The textbook: the whole text at once, entities replaced, limits off.
struct TextbookDocument {
  explicit TextbookDocument(const std::string& text, int options) {
    xmlSetStructuredErrorFunc(nullptr, [](void*, xmlErrorPtr) {});
    document = xmlReadMemory(text.data(), static_cast<int>(text.size()), "p.xml", nullptr, options);
    xmlSetStructuredErrorFunc(nullptr, nullptr);
    xmlResetLastError();
  }
  ~TextbookDocument() { xmlFreeDoc(document); }
  std::string content() const {
    xmlChar* text = xmlNodeGetContent(xmlDocGetRootElement(document));
    const std::string copy = reinterpret_cast<const char*>(text);
    xmlFree(text);
    return copy;
  }
  int paints() const { return static_cast<int>(xmlChildElementCount(xmlDocGetRootElement(document))); }
  xmlDocPtr document;
};

// How much the peak of this process's memory has grown, MB. Nothing under AddressSanitizer, which keeps what was freed.
class MemoryGrowth {
 public:
  double mb() const { return kMeasures ? peak_rss_mb() - before_mb_ : 0; }

 private:
#ifdef __SANITIZE_ADDRESS__
  static constexpr bool kMeasures = false;
#else
  static constexpr bool kMeasures = true;
#endif
  double before_mb_ = peak_rss_mb();
};

struct Outcome {
  int paints = 0;
  std::vector<std::string> errors;
};
Outcome outcome_of(const std::string& path) {
  Outcome outcome;
  auto reader = PaintReader::open(path);
  for (;;) {
    const auto paint = reader->next();
    if (!paint.ok())
      outcome.errors.push_back(paint.error().message);
    else if (!*paint)
      return outcome;
    else
      ++outcome.paints;
  }
}
Outcome outcome_of_text(const std::string& text) {
  const ScratchFolder folder;
  return outcome_of(folder.file("p.xml", text));
}

// Entities a0..an, each ten times the one before.
std::string bomb(int levels, const std::string& use) {
  std::string text = "<?xml version=\"1.0\"?>\n<!DOCTYPE paints [\n<!ENTITY a0 \"0123456789\">\n";
  for (int i = 1; i <= levels; ++i) {
    text += "<!ENTITY a" + std::to_string(i) + " \"";
    for (int k = 0; k < 10; ++k) text += "&a" + std::to_string(i - 1) + ";";
    text += "\">\n";
  }
  return text + "]>\n" + use;
}

TEST(HardCase, XmlHostileEntityBomb) {
  // 10^6 characters from 600 bytes; 10^9 would take the machine down.
  const TextbookDocument textbook(bomb(5, "<paints>&a5;</paints>"), XML_PARSE_NOENT | XML_PARSE_HUGE);
  int passed = 0;
  const MemoryGrowth growth;
  for (const std::string& use : {kRoot + "&a8;</paints>", kRoot + "<paint name=\"&a8;\"/></paints>",
                                 std::string("<paints xmlns=\"urn:goniochrome:paint:1\" version=\"&a8;\"/>")}) {
    const Outcome outcome = outcome_of_text(bomb(8, use));
    passed += outcome.paints;
    ASSERT_EQ(outcome.errors.size(), 1u);
    EXPECT_THAT(outcome.errors[0], HasSubstr("p.xml:2: <!DOCTYPE is not accepted, nor are the entities it declares"));
  }
  EXPECT_LT(growth.mb(), 20);
  hard_case("xml-hostile", {.what = "bytes that an entity bomb of 600 bytes grew to",
                            .textbook = static_cast<double>(textbook.content().size()),
                            .ours = static_cast<double>(passed),
                            .bound = 0,
                            .unit = "bytes"});
}

TEST(HardCase, XmlHostileExternalEntity) {
  const ScratchFolder folder;
  const std::string secret = folder.file("secret.txt", "the secret");
  const std::string text =
      "<!DOCTYPE paints [<!ENTITY x SYSTEM \"file://" + secret + "\">]>\n" + kRoot + "&x;</paints>";
  const Outcome outcome = outcome_of(folder.file("p.xml", text));
  ASSERT_EQ(outcome.errors.size(), 1u);
  hard_case("xml-hostile", {.what = "bytes read from another file by an external entity",
                            .textbook = static_cast<double>(TextbookDocument(text, XML_PARSE_NOENT).content().size()),
                            .ours = static_cast<double>(outcome.paints),
                            .bound = 0,
                            .unit = "bytes"});
  EXPECT_THAT(outcome.errors[0], HasSubstr("p.xml:1: <!DOCTYPE is not accepted"));
  // An external subset is not fetched either, nor a schema named by the file.
  EXPECT_THAT(outcome_of_text("<!DOCTYPE paints SYSTEM \"http://127.0.0.1:1/p.dtd\">" + kRoot + "</paints>").errors[0],
              HasSubstr("<!DOCTYPE is not accepted"));
  EXPECT_TRUE(outcome_of_text("<paints xmlns=\"urn:goniochrome:paint:1\" version=\"1\" "
                              "xmlns:xsi=\"http://www.w3.org/2001/XMLSchema-instance\" "
                              "xsi:schemaLocation=\"urn:goniochrome:paint:1 http://127.0.0.1:1/p.xsd\"/>")
                  .errors.empty());
}

// A pipe into which a thread writes `head` and then `filler` over and over, up to 1 GB.
class EndlessPipe {
 public:
  EndlessPipe(std::string head, const std::string& filler) : path_(folder_.path("pipe")) {
    signal(SIGPIPE, SIG_IGN);
    mkfifo(path_.c_str(), 0600);
    std::string block;
    while (block.size() < (1 << 16)) block += filler;
    writer_ = std::thread([this, head = std::move(head), block = std::move(block)] {
      const int pipe = open(path_.c_str(), O_WRONLY);
      bool taken = write(pipe, head.data(), head.size()) > 0;
      while (taken && written_ < (1u << 30)) {
        taken = write(pipe, block.data(), block.size()) > 0;
        written_ += block.size();
      }
      close(pipe);
    });
  }
  ~EndlessPipe() {
    if (writer_.joinable()) writer_.join();
  }
  const std::string& path() const { return path_; }
  // How much was taken, once the reader has hung up.
  std::size_t written() {
    writer_.join();
    return written_;
  }

 private:
  ScratchFolder folder_;
  std::string path_;
  std::size_t written_ = 0;
  std::thread writer_;
};

TEST(HardCase, XmlHostileGiantAttribute) {
  const std::string giant = kRoot + "<paint name=\"" + std::string(20 << 20, 'x') + "\"/></paints>";
  const bool taken = TextbookDocument(giant, XML_PARSE_HUGE).paints() == 1;
  hard_case("xml-hostile", {.what = "size of one attribute that is read without an error",
                            .textbook = taken ? 20.0 : 0,
                            .ours = outcome_of_text(giant).errors.empty() ? 20.0 : 0,
                            .bound = 1,
                            .unit = "MB"});
  const MemoryGrowth growth;
  struct {
    const char *head, *filler, *error;
  } const giants[] = {
      {"<paint name=\"", "x", "one text or attribute is longer than 1048576 bytes"},
      {"<paint name=\"p\"><gloss angle=\"60\">", "9", "one text or attribute is longer than 1048576 bytes"},
      {"<!--", "x", "one text or attribute is longer than 1048576 bytes"},
      {"<paint name=\"p\"><n xmlns=\"urn:x\">", "<m/>", "paint \"p\" is longer than 16 MB: split it"},
      {"<paint name=\"p\"><n xmlns=\"urn:x\">", "<m>", "elements are nested more than 256 deep"},
  };
  for (const auto& row : giants) {
    EndlessPipe pipe(kRoot + row.head, row.filler);
    {
      auto reader = PaintReader::open(pipe.path());
      const auto paint = reader->next();
      ASSERT_FALSE(paint.ok());
      EXPECT_THAT(paint.error().message, HasSubstr(row.error));
      EXPECT_THAT(paint.error().message, HasSubstr("pipe:2: "));
    }
    EXPECT_LT(pipe.written(), 1u << 26) << row.error;  // and not 1 GB
  }
  EXPECT_LT(growth.mb(), 80);
}

TEST(HardCase, XmlHostileCutFile) {
  const std::string whole =
      kRoot + "<paint name=\"a\">" + kLab + "</paint>\n<paint name=\"b\">" + kLab + "</paint>\n</paints>\n";
  // The textbook cure for broken files takes what is there and says nothing.
  const int silent = TextbookDocument(whole.substr(0, whole.size() / 2 + 40), XML_PARSE_RECOVER).paints();
  int cut_off = 0, untold = 0;
  for (std::size_t length = 1; length + 1 < whole.size(); ++length) {
    const Outcome outcome = outcome_of_text(whole.substr(0, length));
    untold += outcome.errors.empty();
    if (outcome.errors.empty()) continue;
    ASSERT_EQ(outcome.errors.size(), 1u) << length;
    EXPECT_THAT(outcome.errors[0], HasSubstr("p.xml:"));
    cut_off += outcome.errors[0].find("cut off") != std::string::npos;
  }
  EXPECT_EQ(cut_off, static_cast<int>(whole.size()) - 2);
  hard_case("xml-hostile", {.what = "files cut off at any byte and taken for whole",
                            .textbook = silent == 2 ? 1.0 : 0,
                            .ours = static_cast<double>(untold),
                            .bound = 0,
                            .unit = "files"});
  EXPECT_THAT(outcome_of_text(whole.substr(0, whole.size() - 15)).errors[0],
              HasSubstr("p.xml:3: the file ends inside <paint>: it was cut off"));
}

TEST(HardCase, XmlHostileBadUtf8) {
  const std::string latin1 = kRoot + "<paint name=\"caf\xe9\"/>\n</paints>\n";
  int untold = 0;
  for (const char* name : {"caf\xe9", "\xff\xfe", "\xed\xa0\x80", "a\x01z", "\xc0\xaf"}) {
    const Outcome outcome = outcome_of_text(kRoot + "<paint name=\"" + name + "\"/>\n</paints>\n");
    untold += outcome.errors.empty();
    ASSERT_EQ(outcome.errors.size(), 1u) << name;
    EXPECT_THAT(outcome.errors[0], HasSubstr("p.xml:2: a character is not valid UTF-8: save the file as UTF-8"));
  }
  hard_case("xml-hostile", {.what = "files read without an error though their bytes are not UTF-8",
                            .textbook = static_cast<double>(TextbookDocument(latin1, XML_PARSE_RECOVER).paints()),
                            .ours = static_cast<double>(untold),
                            .bound = 0,
                            .unit = "files"});
  // A declared encoding is honored.
  EXPECT_EQ(outcome_of_text("<?xml version=\"1.0\" encoding=\"ISO-8859-1\"?>" + latin1).paints, 1);
}

TEST(HardCase, XmlHostileDuplicateNames) {
  std::string text = kRoot;
  for (const char* name : {"a", "b", "a", "c", "b"})
    text += std::string("<paint name=\"") + name + "\">" + kLab + "</paint>\n";
  text += "</paints>\n";
  const Outcome outcome = outcome_of_text(text);
  hard_case("xml-hostile", {.what = "paints read though another paint of the file has their name",
                            .textbook = TextbookDocument(text, 0).paints() - 3.0,
                            .ours = outcome.paints - 3.0,
                            .bound = 0,
                            .unit = "paints"});
  ASSERT_EQ(outcome.errors.size(), 2u);
  EXPECT_THAT(outcome.errors[0], HasSubstr("p.xml:4: paint \"a\" is already at line 2: rename one of them"));
  EXPECT_THAT(outcome.errors[1], HasSubstr("p.xml:6: paint \"b\" is already at line 3: rename one of them"));

  NameLedger ledger;
  for (int i = 1; i <= 200000; ++i) ASSERT_FALSE(ledger.note("paint " + std::to_string(i), i));
  for (int i = 1; i <= 200000; i += 997) ASSERT_EQ(ledger.note("paint " + std::to_string(i), 1), i);
}

// A locale as in Germany: a decimal comma and a dot between thousands. Made here, since a bare system has none.
struct Comma : std::numpunct<char> {
  char do_decimal_point() const override { return ','; }
  char do_thousands_sep() const override { return '.'; }
  std::string do_grouping() const override { return "\3"; }
};

TEST(HardCase, XmlHostileCommaLocale) {
  const std::locale before = std::locale::global(std::locale(std::locale::classic(), new Comma));
  // The textbook way through streams: 41.87 is not 41.87, and 1234.5 is written as something else.
  double textbook = 0;
  std::istringstream("41.87") >> textbook;
  std::ostringstream written;
  written << 1234.5;

  const ScratchFolder folder;
  paint::Paint paint;
  paint.name = "p";
  paint.gloss = {{60, 1234.5}};
  {
    auto writer = PaintWriter::begin(*OutputFile::create(folder.path("q.xml")));
    EXPECT_TRUE(writer->write(paint).ok());
    EXPECT_TRUE(writer->finish().ok());
  }
  auto reader = PaintReader::open(folder.file("p.xml", kRoot + "<paint name=\"p\">" + kLab + "</paint></paints>"));
  const auto read = reader->next();
  std::locale::global(before);

  EXPECT_NE(written.str(), "1234.5");
  ASSERT_TRUE(read.ok());
  hard_case("xml-hostile", {.what = "L* read where numbers have a decimal comma",
                            .textbook = std::abs(textbook - 41.87),
                            .ours = color::delta_e_76((*read)->measurement->rows[0].lab, {41.87, -45.99, -21.73}),
                            .bound = 0,
                            .unit = "L*"});
  EXPECT_THAT(folder.content("q.xml"), HasSubstr("<gloss angle=\"60\">1234.5</gloss>"));
}

// 20,000 paints take no more memory than 200.
TEST(PaintReader, ALongStreamTakesConstantMemory) {
  const auto library = [](int paints) {
    std::string text = kRoot;
    for (int i = 0; i < paints; ++i) text += "<paint name=\"p" + std::to_string(i) + "\">" + kLab + "</paint>\n";
    return text + "</paints>\n";
  };
  const ScratchFolder folder;
  const std::string small = folder.file("small.xml", library(200)), large = folder.file("large.xml", library(20000));
  EXPECT_EQ(outcome_of(small).paints, 200);
  const MemoryGrowth growth;
  EXPECT_EQ(outcome_of(large).paints, 20000);
  EXPECT_LT(growth.mb(), 4);
}

}  // namespace
}  // namespace goniochrome::formats::xml_hostile_test
