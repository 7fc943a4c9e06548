#include "formats/imported.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>

#include "base/text.h"
#include "color/illuminant.h"
#include "paint/date.h"

namespace goniochrome::formats {

namespace {
constexpr double kMostNumber = 1e12;
}

Result<double> number_in(std::string_view text, Domain domain) {
  constexpr std::string_view kMinus = "\xe2\x88\x92";  // U+2212, as typesetters write it
  const std::string with_hyphen = trimmed(text).starts_with(kMinus) ? '-' + std::string(trimmed(text).substr(3)) : "";
  const std::string_view value = with_hyphen.empty() ? trimmed(text) : with_hyphen;
  if (value.empty()) return input_error("is empty: write a number");
  const auto number = parse_number(value);
  if (!number && value.find(',') != std::string_view::npos)
    return input_error("is \"{}\": write a decimal point", shown(value));
  const std::string word = lower(value.substr(0, 5));
  if (!number && (word.find("nan") != word.npos || word.find("inf") != word.npos))
    return input_error("is \"{}\": write a finite number", shown(value));
  if (!number) return input_error("is \"{}\": write a number such as 12.5", shown(value));
  if (domain == Domain::kNotNegative && *number < 0) return input_error("is {}: write 0 or more", value);
  if (domain == Domain::kPositive && *number <= 0) return input_error("is {}: write a number above 0", value);
  if (domain == Domain::kRefractiveIndex && *number < 1) return input_error("is {}: write 1 or more", value);
  if (domain == Domain::kLab && std::abs(*number) > kMostLab)
    return input_error("is {}: write a CIELAB value from {} to {}", value, -kMostLab, kMostLab);
  if (std::abs(*number) > kMostNumber) return input_error("is {}: write a number below 1e12", value);
  return *number;
}

Result<void> check_lab(const color::Lab& lab) {
  for (const auto& [name, value] : {std::pair{"L*", lab.L}, {"a*", lab.a}, {"b*", lab.b}})
    if (!(std::abs(value) <= kMostLab))
      return input_error("{} is {}: CIELAB values lie between {} and {}", name, shortest(value), -kMostLab, kMostLab);
  return {};
}

namespace {

// True if every number that it was given is finite.
class Finite {
 public:
  Finite& numbers(std::initializer_list<double> numbers) {
    all_ = all_ && std::ranges::all_of(numbers, [](double value) { return std::isfinite(value); });
    return *this;
  }
  Finite& color(const color::Rgb& rgb) { return numbers({rgb.x, rgb.y, rgb.z}); }
  Finite& lobes(const color::Rgb& diffuse, const std::vector<paint::Lobe>& lobes) {
    color(diffuse);
    for (const paint::Lobe& lobe : lobes) {
      if (!lobe.is_mirror()) numbers({lobe.exponent});  // that of the mirror is infinite
      color(lobe.directional_diffuse).color(lobe.gloss);
    }
    return *this;
  }
  Finite& fit(const paint::LobeFit& fit) {
    numbers({fit.max_de00, fit.mean_de00, fit.coat_index}).lobes(fit.diffuse, fit.lobes);
    for (const paint::ViewLobes& view : fit.views) numbers({view.view_deg}).lobes(view.diffuse, view.lobes);
    for (const paint::TiltedLobes& tilts : fit.tilts) {
      numbers({tilts.mean_de00});
      for (const paint::TiltedLobe& lobe : tilts.lobes) numbers({lobe.exponent, lobe.tilt_deg, lobe.out_deg});
      for (const paint::TiltedView& view : tilts.views) {
        numbers({view.view_deg}).color(view.diffuse);
        for (const color::Rgb& weight : view.weights) color(weight);
      }
    }
    return *this;
  }
  bool all() const { return all_; }

 private:
  bool all_ = true;
};

}  // namespace

Result<void> check_writable(const paint::Paint& paint) {
  const auto refused = [&](const std::string& why) { return input_error("paint \"{}\": {}", shown(paint.name), why); };
  std::vector<color::Lab> colors;
  if (paint.measurement)
    for (const paint::LabReading& row : paint.measurement->rows) colors.push_back(row.lab);
  if (paint.appearance) colors.insert(colors.end(), {paint.appearance->face, paint.appearance->flop});
  for (const color::Lab& lab : colors)
    if (const auto checked = check_lab(lab); !checked.ok()) return refused(checked.error().message);
  Finite finite;
  if (paint.measurement)
    for (const paint::SpectrumReading& spectrum : paint.measurement->spectra) {
      if (spectrum.factors.size() < 2) return refused("a spectrum of it has fewer than two wavelengths");
      finite.numbers({spectrum.from_nm, spectrum.step_nm});
      for (const double factor : spectrum.factors) finite.numbers({factor});
    }
  if (paint.measurement)
    for (const paint::TextureReading& texture : paint.measurement->textures) finite.numbers({texture.value});
  for (const paint::GlossReading& gloss : paint.gloss) finite.numbers({gloss.angle_deg, gloss.gloss_units});
  if (paint.appearance) finite.numbers({paint.appearance->travel_deg, paint.appearance->residual_de00.value_or(0)});
  if (paint.anisotropy) finite.numbers({paint.anisotropy->alpha_x, paint.anisotropy->alpha_y});
  if (paint.flakes) finite.numbers({paint.flakes->diameter_um, paint.flakes->coverage, paint.flakes->spread_deg});
  finite.numbers({paint.color_map ? paint.color_map->index : 0, paint.coat_index.value_or(0)});
  if (paint.lobes) finite.fit(*paint.lobes);
  if (!finite.all()) return refused("a number of it is not finite: only finite numbers are written");
  return {};
}

Result<paint::PaintClass> class_in(std::string_view text) {
  if (const auto known = paint::paint_class_of(text)) return *known;
  return input_error("is \"{}\": write solid, metallic, pearl, interference or unknown", shown(text));
}

Result<int> observer_in(std::string_view text) {
  if (text == "2" || text == "10") return text == "2" ? 2 : 10;
  return input_error("is \"{}\": write 2 or 10 (degrees)", shown(text));
}

Result<color::ViewingCondition> stated_condition(std::string_view illuminant, int observer_deg) {
  const color::ViewingCondition condition = color::condition_of(illuminant, observer_deg);
  if (observer_deg != 0 && condition.observer_deg != observer_deg)
    return input_error("illuminant is \"{}\" beside the observer {}: write one observer", shown(illuminant),
                       observer_deg);
  return condition;
}

color::ViewingCondition completed(color::ViewingCondition stated, const ImportOptions& options,
                                  const color::ViewingCondition& assumed) {
  if (stated.illuminant.empty())
    stated.illuminant = options.illuminant.empty() ? assumed.illuminant : options.illuminant;
  if (stated.observer_deg == 0)
    stated.observer_deg = options.observer_deg ? options.observer_deg : assumed.observer_deg;
  return stated;
}

void Remarks::note(const std::string& what, std::string_view example) {
  const auto known = std::ranges::find(kinds_, what, &Kind::what);
  if (known != kinds_.end()) {
    ++known->count;
    return;
  }
  kinds_.push_back({what, std::string(example), 1});
}

std::string unheard(std::string_view key, std::string_view value) {
  return fmt::format(
      "{} \"{}\" may change what the readings are, and has no place in a paint: they are kept as they stand", key,
      shown(value));
}

std::vector<std::string> Remarks::lines() const {
  std::vector<std::string> result;
  for (const Kind& kind : kinds_) {
    const std::string more = kind.count > 1 ? fmt::format(" and {} more", kind.count - 1) : "";
    if (!kind.example.empty())
      result.push_back(fmt::format("{} ({}{})", kind.what, kind.example, more));
    else
      result.push_back(kind.count > 1 ? fmt::format("{} ({} times)", kind.what, kind.count) : kind.what);
  }
  return result;
}

namespace {

// True where the words stand in the text, in letters of either case, and are no part of other words.
bool has_words(std::string_view text, std::string_view words) {
  const std::string whole = lower(text), part = lower(words);
  const auto is_letter = [&](std::size_t at) {
    return at < whole.size() && ((whole[at] >= 'a' && whole[at] <= 'z') || (whole[at] >= '0' && whole[at] <= '9'));
  };
  for (std::size_t at = whole.find(part); at != std::string::npos; at = whole.find(part, at + 1))
    if ((at == 0 || !is_letter(at - 1)) && !is_letter(at + part.size())) return true;
  return false;
}

// 45/0 and 0/45, which read what 45as45 reads.
bool is_45_0(std::string_view words) {
  const auto mark = words.find_first_of("/:");
  if (mark == std::string_view::npos) return false;
  const auto leading = [](std::string_view text) {
    text = trimmed(text);
    return text.substr(0, text.find_first_not_of("0123456789"));
  };
  const std::string_view from = leading(words), to = leading(words.substr(mark + 1));
  return (from == "45" && to == "0") || (from == "0" && to == "45");
}

}  // namespace

std::optional<paint::Geometry> geometry_in_words(std::string_view words, const ImportOptions& options,
                                                 Remarks& remarks) {
  constexpr std::string_view kDegreeSign = "\xc2\xb0";
  std::string text(trimmed(words));
  for (auto at = text.find(kDegreeSign); at != std::string::npos; at = text.find(kDegreeSign)) text.erase(at, 2);
  if (is_45_0(text)) return paint::Geometry{45, 45};
  if (const auto named = paint::parse_geometry(trimmed(text)); named.ok()) return *named;
  for (const Viewing& viewing : options.viewings)
    if (viewing.words.empty() || has_words(text, viewing.words)) {
      remarks.note(text.empty() ? fmt::format("no viewing geometry is stated: taken as {}, as --viewing says",
                                              paint::geometry_name(viewing.geometry))
                                : fmt::format("the viewing \"{}\" was taken as {}, as --viewing says", shown(text),
                                              paint::geometry_name(viewing.geometry)),
                   "");
      return viewing.geometry;
    }
  const std::string typical = has_words(text, "SCE") ? "SCE" : has_words(text, "SCI") ? "SCI" : shown(text);
  remarks.note(
      text.empty()
          ? "no viewing geometry is stated, and readings without one are left out: give "
            "paint-convert --viewing GEOMETRY, such as 45as45, to take them as that"
          : fmt::format("the viewing \"{}\" has no aspecular angle, and its readings are left out: "
                        "give paint-convert --viewing \"WORDS=GEOMETRY\", such as \"{}=45as45\", to take them as that",
                        shown(text), typical),
      "");
  return std::nullopt;
}

bool OpenPaint::complete(const ImportOptions& options, Remarks& remarks) {
  const auto is_wanted = [&](const SeenReading& seen) {
    return (options.illuminant.empty() || options.illuminant == seen.condition.illuminant) &&
           (options.observer_deg == 0 || options.observer_deg == seen.condition.observer_deg);
  };
  const auto first = std::ranges::find_if(readings, is_wanted);
  if (first == readings.end()) {
    if (!readings.empty()) remarks.note("no reading under the illuminant and observer asked for", paint.name);
    return !paint.gloss.empty();
  }
  paint::Measurement& measurement = paint.measurement.emplace();
  measurement.condition = first->condition;
  measurement.instrument = instrument, measurement.serial = serial;
  measurement.date = paint::plain_date(date);
  bool others = false;
  for (const auto& [condition, reading] : readings) {
    if (condition != measurement.condition)
      others = true;
    else if (std::ranges::find(measurement.rows, reading.geometry, &paint::LabReading::geometry) ==
             measurement.rows.end())
      measurement.rows.push_back(reading);
    else
      remarks.note("several readings at one geometry: the first was taken",
                   fmt::format("{} at {}", paint.name, paint::geometry_name(reading.geometry)));
  }
  for (const paint::SpectrumReading& spectrum : spectra)
    if (std::ranges::find(measurement.rows, spectrum.geometry, &paint::LabReading::geometry) !=
            measurement.rows.end() &&
        std::ranges::find(measurement.spectra, spectrum.geometry, &paint::SpectrumReading::geometry) ==
            measurement.spectra.end())
      measurement.spectra.push_back(spectrum);
  measurement.textures = textures;
  if (others)
    remarks.note(fmt::format("readings under other illuminants or observers than {}/{} were left out: choose with "
                             "paint-convert --illuminant and --observer",
                             measurement.condition.illuminant, measurement.condition.observer_deg),
                 paint.name);
  return true;
}

std::string UniqueNames::own(const std::string& name, Remarks& remarks) {
  std::string own = name;
  for (int k = 2; !used_.insert(own).second; ++k) own = fmt::format("{} ({})", name, k);
  if (own != name) remarks.note("names that stood before got a number", own);
  return own;
}

namespace {

// FNV-1a from a given start, with the bits stirred at the end (the finalizer of MurmurHash3), since FNV's high bits are
// weak for short names.
std::uint64_t hash_of(std::string_view text, std::uint64_t start) {
  std::uint64_t h = start;
  for (const char c : text) h = (h ^ static_cast<unsigned char>(c)) * 0x100000001b3;
  h = (h ^ (h >> 33)) * 0xff51afd7ed558ccd;
  h = (h ^ (h >> 33)) * 0xc4ceb9fe1a85ec53;
  return h ^ (h >> 33);
}

}  // namespace

NameLedger::Entry& NameLedger::slot(const Entry& wanted) {
  const std::size_t mask = slots_.size() - 1;
  std::size_t i = wanted.hash[0] & mask;
  while (slots_[i].line != 0 && (slots_[i].hash[0] != wanted.hash[0] || slots_[i].hash[1] != wanted.hash[1]))
    i = (i + 1) & mask;
  return slots_[i];
}

std::optional<int> NameLedger::note(std::string_view name, int line) {
  const Entry entry{{hash_of(name, 0xcbf29ce484222325), hash_of(name, 0x9e3779b97f4a7c15)}, line};
  Entry& found = slot(entry);
  if (found.line != 0) return found.line;
  found = entry;
  if (2 * ++used_ > slots_.size()) {
    std::vector<Entry> old(2 * slots_.size());
    old.swap(slots_);
    for (const Entry& kept : old)
      if (kept.line != 0) slot(kept) = kept;
  }
  return std::nullopt;
}

std::optional<int> PaintLedger::note(paint::Paint& paint, int line, Remarks& remarks) {
  const std::string stated = paint.name, date = paint.measurement ? paint.measurement->date : "";
  const bool is_told_apart = !date.empty() || !paint.code.empty();
  if (const auto before = names_.note(is_told_apart ? stated + '\n' + date + '\n' + paint.code : stated, line))
    return before;
  if (!is_told_apart) return std::nullopt;
  for (int k = 2; names_.note(paint.name, line); ++k) paint.name = fmt::format("{} ({})", stated, k);
  if (paint.name != stated) remarks.note("samples with another date or code than before got a number", paint.name);
  return std::nullopt;
}

}  // namespace goniochrome::formats
