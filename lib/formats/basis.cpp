#include "formats/basis.h"

#include <cmath>

#include "base/file.h"
#include "base/text.h"
#include "formats/internal/paint_elements.h"
#include "formats/internal/xml_stream.h"

namespace goniochrome::formats {

namespace {

constexpr std::size_t kMostExponents = 1000;

class BasisHandler : public XmlHandler {
 public:
  explicit BasisHandler(std::string file) : file_(std::move(file)) {}

  Result<void> start(const XmlTag& tag) override {
    ++depth_;
    const XmlValues values(file_, tag);
    const std::string where = depth_ == 1 ? "the document" : depth_ == 2 ? "<basis>" : "<" + element_ + ">";
    const bool ours = tag.space == kBasisNamespace;
    element_ = tag.name;
    line_ = tag.line;
    text_.clear();
    if (depth_ == 1 && !ours && tag.name == "basis")
      return values.error(
          fmt::format("this <basis> is of the namespace \"{}\": the first element must be <basis "
                      "xmlns=\"{}\" name=\"...\">",
                      shown(tag.space), kBasisNamespace));
    if (depth_ == 1 && (!ours || tag.name != "basis"))
      return values.error(
          fmt::format("this begins with <{}>, not with a basis: the first element must be <basis "
                      "xmlns=\"{}\" name=\"...\">",
                      tag.name, kBasisNamespace));
    if (depth_ == 1) {
      GONIO_TRY(values.check_names("name"));
      return values.name("name", basis.name);
    }
    if (depth_ == 2 && ours && tag.name == "exponent") return begin_exponent(values);
    if (depth_ == 2 && ours && tag.name == "mirror") return begin_mirror(values);
    if (depth_ == 2 && ours && tag.name == "set") return begin_set(values);
    return values.error(
        fmt::format("<{}> is not known inside {}: a basis holds <exponent>, <mirror>, <set>", tag.name, where));
  }

  Result<void> text(std::string_view text, int) override {
    text_ += text;
    return {};
  }

  Result<void> end(int) override {
    --depth_;
    if (depth_ == 1 && element_ == "exponent")
      GONIO_TRY(finish_exponent());
    else if (!trimmed(text_).empty())
      return input_error("{}:{}: text \"{}\" stands between elements: remove it", file_, line_, shown(trimmed(text_)));
    text_.clear();
    if (depth_ == 0 && basis.exponents.empty())
      return input_error("{}:{}: the basis has no <exponent>: give it at least one", file_, line_);
    return {};
  }

  Basis basis;

 private:
  Result<void> begin_exponent(const XmlValues& values) const {
    if (basis.mirror || !basis.sets.empty())
      return values.error("<exponent> stands behind <mirror> or <set>: write the exponents first");
    return values.check_names("");
  }

  Result<void> begin_mirror(const XmlValues& values) {
    GONIO_TRY(values.check_names(""));
    if (basis.exponents.empty())
      return values.error("the basis has no <exponent> before <mirror>: give it at least one");
    if (basis.mirror) return values.error("a second <mirror>: keep one");
    if (!basis.sets.empty()) return values.error("<mirror> stands behind <set>: write it before the sets");
    basis.mirror = true;
    return {};
  }

  Result<void> begin_set(const XmlValues& values) {
    GONIO_TRY(values.check_names("lobes max mean objective"));
    BasisSet& set = basis.sets.emplace_back();
    const auto lobes = parse_integer(values.text("lobes"));
    if (!lobes || *lobes < 1 || *lobes > static_cast<int>(kMostExponents) || basis.sets.size() > kMostExponents)
      return values.error("lobes", fmt::format("write a whole number from 1 to {}", kMostExponents));
    set.lobes = static_cast<int>(*lobes);
    GONIO_TRY(values.number("max", set.max_error, Domain::kNotNegative));
    GONIO_TRY(values.number("mean", set.mean_error, Domain::kNotNegative));
    return values.number("objective", set.objective, Domain::kNotNegative);
  }

  Result<void> finish_exponent() {
    const auto exponent = number_in(text_, Domain::kNotNegative);
    if (!exponent.ok()) return input_error("{}:{}: exponent {}", file_, line_, exponent.error().message);
    auto& exponents = basis.exponents;
    if (!exponents.empty() && *exponent <= exponents.back())
      return input_error("{}:{}: exponent {} follows {}: write them in ascending order, each once", file_, line_,
                         shortest(*exponent), shortest(exponents.back()));
    if (exponents.size() >= kMostExponents)
      return input_error("{}:{}: more than {} exponents", file_, line_, kMostExponents);
    exponents.push_back(*exponent);
    return {};
  }

  std::string file_, element_, text_;
  int depth_ = 0, line_ = 0;
};

}  // namespace

Result<Basis> read_basis(const std::string& path) {
  GONIO_ASSIGN(InputFile input, InputFile::open(path));
  BasisHandler handler(input.name());
  XmlStream stream(std::move(input), handler);
  GONIO_TRY(stream.finish());
  return std::move(handler.basis);
}

Result<void> write_basis(const std::string& path, const Basis& basis) {
  bool finite = true;
  for (const double exponent : basis.exponents) finite = finite && std::isfinite(exponent);
  for (const BasisSet& set : basis.sets)
    finite = finite && std::isfinite(set.max_error) && std::isfinite(set.mean_error) && std::isfinite(set.objective);
  if (!finite) return input_error("{}: an exponent or an error of the basis is not finite: it is not written", path);
  std::string text = fmt::format("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<basis xmlns=\"{}\" name=\"{}\">\n",
                                 kBasisNamespace, xml_escaped(plain_utf8(basis.name)));
  for (const double exponent : basis.exponents) text += fmt::format("  <exponent>{}</exponent>\n", shortest(exponent));
  if (basis.mirror) text += "  <mirror/>\n";
  for (const BasisSet& set : basis.sets)
    text += fmt::format("  <set lobes=\"{}\" max=\"{}\" mean=\"{}\" objective=\"{}\"/>\n", set.lobes,
                        shortest(set.max_error), shortest(set.mean_error), shortest(set.objective));
  return write_file(path, text + "</basis>\n");
}

}  // namespace goniochrome::formats
