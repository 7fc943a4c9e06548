#include <algorithm>

#include "base/text.h"
#include "formats/internal/tilts_xml.h"

namespace goniochrome::formats {

Result<void> TiltsReader::start(const XmlTag& tag) {
  const XmlValues values(file_, tag);
  const bool known = tag.space == kTiltsNamespace;
  ++depth_;
  line_ = tag.line;
  if (depth_ == 1) {
    sets_.clear();
    return values.check_names("");
  }
  if (depth_ == 2 && known && tag.name == "set") return begin_set(values);
  if (depth_ == 3 && known && tag.name == "lobe") return begin_lobe(values);
  if (depth_ == 3 && known && tag.name == "view") return begin_view(values);
  return values.error(fmt::format("<{}> is not known here: <tilts> holds <set>, and a set holds <lobe> and then <view>",
                                  shown(tag.name)));
}

Result<void> TiltsReader::begin_set(const XmlValues& values) {
  GONIO_TRY(values.check_names("mean_de00"));
  if (sets_.size() >= kMostTiltSets)
    return values.error(fmt::format("more than {} sets of tilted lobes in one paint", kMostTiltSets));
  return values.number("mean_de00", sets_.emplace_back().mean_de00, Domain::kNotNegative);
}

Result<void> TiltsReader::begin_lobe(const XmlValues& values) {
  GONIO_TRY(values.check_names("exponent tilt out"));
  paint::TiltedLobes& set = sets_.back();
  if (!set.views.empty()) return values.error("<lobe> stands behind <view>: write the lobes first");
  if (set.lobes.size() >= kMostTiltedLobes)
    return values.error(fmt::format("more than {} tilted lobes in one set", kMostTiltedLobes));
  paint::TiltedLobe& lobe = set.lobes.emplace_back();
  GONIO_TRY(values.number("exponent", lobe.exponent, Domain::kNotNegative));
  GONIO_TRY(values.number("tilt", lobe.tilt_deg));
  GONIO_TRY(values.number("out", lobe.out_deg, Domain::kNotNegative));
  if (std::abs(lobe.tilt_deg) > 180) return values.error("tilt", "give degrees, -180 to 180");
  if (lobe.out_deg > 90) return values.error("out", "give degrees, 0 to 90");
  return {};
}

Result<void> TiltsReader::begin_view(const XmlValues& values) {
  GONIO_TRY(values.check_names("angle"));
  auto& views = sets_.back().views;
  if (views.size() >= kMostTiltedViews) return values.error(fmt::format("more than {} views", kMostTiltedViews));
  paint::TiltedView view;
  GONIO_TRY(values.number("angle", view.view_deg, Domain::kNotNegative));
  if (view.view_deg > 90) return values.error("angle", "give degrees from the normal, 0 to 90");
  if (!views.empty() && view.view_deg <= views.back().view_deg)
    return values.error("angle", "views stand in the order of their angles, each once");
  views.push_back(std::move(view));
  in_view_ = true;
  text_.clear();
  return {};
}

Result<void> TiltsReader::text(std::string_view text, int line) {
  if (in_view_) {
    if (text_.size() + text.size() > kLongestXmlToken) return input_error("{}:{}: this view is too long", file_, line);
    text_ += text;
    return {};
  }
  if (trimmed(text).empty()) return {};
  return input_error("{}:{}: text \"{}\" stands between elements: remove it", file_, line, shown(trimmed(text)));
}

// Three numbers for the diffuse part, then three for each lobe.
Result<void> TiltsReader::finish_view() {
  paint::TiltedLobes& set = sets_.back();
  std::vector<double> numbers;
  std::string_view rest = trimmed(text_);
  while (!rest.empty()) {
    const std::string_view word = rest.substr(0, rest.find_first_of(" \t\r\n"));
    const auto number = number_in(word, Domain::kNotNegative);
    if (!number.ok()) return input_error("{}:{}: weight {}", file_, line_, number.error().message);
    numbers.push_back(*number);
    rest = trimmed(rest.substr(word.size()));
  }
  const std::size_t wanted = 3 * (1 + set.lobes.size());
  if (numbers.size() != wanted)
    return input_error(
        "{}:{}: a view of {} tilted lobes holds {} numbers, three for the diffuse part and three for each "
        "lobe; this one holds {}",
        file_, line_, set.lobes.size(), wanted, numbers.size());
  paint::TiltedView& view = set.views.back();
  view.diffuse = {numbers[0], numbers[1], numbers[2]};
  for (std::size_t i = 3; i < wanted; i += 3) view.weights.push_back({numbers[i], numbers[i + 1], numbers[i + 2]});
  return {};
}

Result<void> TiltsReader::end(int line) {
  --depth_;
  if (in_view_) {
    in_view_ = false;
    return finish_view();
  }
  if (depth_ == 1 && sets_.back().views.size() < 2)
    return input_error("{}:{}: a set of tilted lobes has {} views: it needs two or more", file_, line,
                       sets_.back().views.size());
  return {};
}

std::string tilts_element(const std::vector<paint::TiltedLobes>& sets) {
  if (sets.empty()) return "";
  const auto rgb = [](const color::Rgb& c) {
    return fmt::format("{} {} {}", shortest(c.x), shortest(c.y), shortest(c.z));
  };
  std::string text = fmt::format("    <tilts xmlns=\"{}\">\n", kTiltsNamespace);
  for (const paint::TiltedLobes& set : sets) {
    text += fmt::format("      <set mean_de00=\"{}\">\n", shortest(set.mean_de00));
    for (const paint::TiltedLobe& lobe : set.lobes)
      text += fmt::format("        <lobe exponent=\"{}\" tilt=\"{}\" out=\"{}\"/>\n", shortest(lobe.exponent),
                          shortest(lobe.tilt_deg), shortest(lobe.out_deg));
    for (const paint::TiltedView& view : set.views) {
      text += fmt::format("        <view angle=\"{}\">{}", shortest(view.view_deg), rgb(view.diffuse));
      for (const color::Rgb& weight : view.weights) text += " " + rgb(weight);
      text += "</view>\n";
    }
    text += "      </set>\n";
  }
  return text + "    </tilts>\n";
}

}  // namespace goniochrome::formats
