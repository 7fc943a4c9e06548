#include "formats/internal/spectral_rows.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/angles.h"
#include "base/text.h"
#include "color/spectrum.h"
#include "math/elementary.h"
#include "paint/geometry.h"

namespace goniochrome::formats {

namespace {

// From this angle to specular on, no paint is brighter than a perfect white but for fluorescence and noise.
constexpr double kFar_deg = 45 - 1e-6, kBrightestFar = 1.25;
// A paint that is this bright near to specular has metal or pearl in it, and is then darker than white far from it.
constexpr double kBrightNear = 1.5, kFarOfBright = 0.95;
// A file in percent whose brightest spectrum is this dark may be one of factors.
constexpr double kDarkest = 1.25;
// The dimmest of 243 real panels read 0.8 percent at its brightest angle.
constexpr double kDarkPercent = 1;

// The largest factor of light that is reflected about specular and becomes no brighter away from it: all of the light
// within the cone of that angle. Nearer than 10 deg, gloss has no bound of use.
double brightest_at(double aspecular_deg) {
  if (aspecular_deg >= kFar_deg) return kBrightestFar;
  const double sine = math::sin(std::max(aspecular_deg, 10.0) * kDegree);
  return aspecular_deg < 10 ? kLargestReflectance : 1 / (sine * sine);
}

double mean_of(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return values.empty() ? 0 : sum / static_cast<double>(values.size());
}

// A value as a message shows it.
std::string reflectance(double value) {
  return fmt::format("{:.4g}", value);
}

constexpr const char* kRemedy = "give paint-convert --scale percent, or --scale factor where 1 is the perfect diffuser";
constexpr const char* kOtherScale = "give the other scale, or leave --scale out";

}  // namespace

std::optional<double> wavelength_in(std::string_view heading) {
  std::string text = lower(heading);
  std::erase_if(text, [](char c) { return std::string_view(" _[]()*%").find(c) != std::string_view::npos; });
  for (const std::string_view word : {"percent", "factor"})
    if (const auto at = text.find(word); at != std::string::npos) text.erase(at, word.size());
  for (const std::string_view before : {"spectralnm", "spectral", "spec", "nm", "r"})
    if (text.starts_with(before)) {
      text.erase(0, before.size());
      break;
    }
  if (text.ends_with("nm")) text.erase(text.size() - 2);
  const auto nm = parse_number(text);
  return nm && *nm >= kFirstSpectral_nm && *nm <= kLastSpectral_nm ? nm : std::nullopt;
}

Result<void> check_not_negative(const std::vector<double>& factors) {
  const double least = *std::ranges::min_element(factors);
  if (least > kSmallestFactor) return {};
  return input_error("a reflectance factor is {}: 0 is black, and noise goes no lower than {}", least, kSmallestFactor);
}

Scale scale_in(std::string_view text) {
  const std::string word = lower(text);
  const auto has = [&](std::string_view part) { return word.find(part) != std::string::npos; };
  if (has("%") || has("percent") || has("prozent")) return Scale::kPercent;
  return has("factor") || has("faktor") ? Scale::kFactor : Scale::kUnstated;
}

Result<void> take_scale(std::string_view text, Scale& scale) {
  const Scale stated = scale_in(text);
  if (stated == Scale::kUnstated) return {};
  if (scale != Scale::kUnstated && scale != stated)
    return input_error("\"{}\" says another scale of reflectances than stands before: write percent or factors in all",
                       shown(text));
  scale = stated;
  return {};
}

Result<void> sort_wavelengths(std::vector<WavelengthColumn>& columns) {
  std::ranges::stable_sort(columns, {}, &WavelengthColumn::nm);
  const auto twice = std::ranges::adjacent_find(columns, {}, &WavelengthColumn::nm);
  if (twice != columns.end())
    return input_error("two columns are of the wavelength {} nm: keep one", shortest(twice->nm));
  for (std::size_t i = 2; i < columns.size(); ++i) {
    const double step = columns[1].nm - columns[0].nm, expected = columns[0].nm + step * static_cast<double>(i);
    if (std::abs(columns[i].nm - expected) > 1e-6)
      return input_error("the wavelengths go from {} to {} nm by {} nm, and then to {} nm: give them in equal steps",
                         shortest(columns[0].nm), shortest(columns[i - 1].nm), shortest(step), shortest(columns[i].nm));
  }
  return {};
}

void ScaleJudge::add(std::string_view paint, const paint::Geometry& geometry, const std::vector<double>& values,
                     std::optional<double> L) {
  if (paint_ != paint) close_paint();
  paint_ = paint;
  const double mean = mean_of(values);
  if (!(std::abs(mean) <= kLargestReflectance)) return;  // no reflectance on any scale
  const double angle = paint::aspecular_angle_deg(geometry);
  const std::string at = fmt::format("{} at {}", reflectance(mean), paint::geometry_name(geometry));
  if (mean > brightest_at(angle) && !open_.beyond) open_.beyond = true, open_.beyond_at = at;
  brightest_ = std::max(brightest_, mean);
  double& brightest = angle >= kFar_deg ? open_.far : open_.near;
  if (mean > brightest) brightest = mean, (angle >= kFar_deg ? open_.far_at : open_.near_at) = at;
  constexpr double kTells = 1e-4;  // of Y: darker readings are noise
  const double Y = !L ? 0 : *L > 8 ? math::pow((*L + 16) / 116, 3) : *L / 903.3;
  if (Y > kTells && mean > 0) {
    as_factor_ += std::abs(math::log(mean / Y));
    as_percent_ += std::abs(math::log(mean / 100 / Y));
  }
}

void ScaleJudge::close_paint() {
  if (open_.near_at.empty() && open_.far_at.empty()) return;
  ++paints_;
  const bool bright_twice = open_.near > kBrightNear && open_.far > kFarOfBright;
  const auto named = [&](const std::string& at) { return fmt::format("\"{}\" has {}", shown(paint_), at); };
  if (open_.beyond || bright_twice) {
    if (impossible_++ == 0) first_impossible_ = named(open_.beyond ? open_.beyond_at : open_.far_at);
  } else if (open_.near > kBrightestFar && first_bright_.empty()) {
    first_bright_ = named(open_.near_at);
  }
  const double brightest = std::max(open_.near, open_.far);
  if (brightest <= kDarkPercent && dark_++ == 0)
    first_dark_ = named(open_.near >= open_.far ? open_.near_at : open_.far_at);
  open_ = {};
}

// Remarks that many paints of a file in percent would be nearly black, as those are that are written as factors.
void ScaleJudge::note_dark(Remarks& remarks) const {
  constexpr std::size_t kMany = 20;  // one in so many
  if (!is_told_by_lab() && dark_ > 0 && kMany * dark_ >= paints_)
    remarks.note(fmt::format("{} of {} paints would reflect {} percent or less at every angle: they are dark, or are "
                             "written as factors beside others in percent",
                             dark_, paints_, kDarkPercent),
                 first_dark_);
}

// Error: the values make no sense on this scale.
Result<double> ScaleJudge::checked(Scale scale, const std::string& whose, const std::string& remedy) {
  const bool percent = scale == Scale::kPercent;
  const double off = percent ? as_percent_ : as_factor_, otherwise = percent ? as_factor_ : as_percent_;
  if (is_told_by_lab() && off > 2 * otherwise)
    return input_error("{} says that reflectances are {}, and the L* beside them that they are {}: {}", whose,
                       percent ? "percent" : "factors", percent ? "factors" : "percent", remedy);
  if (!percent && !is_told_by_lab() && impossible_ > 0 && 2 * impossible_ >= paints_)
    return input_error(
        "{} says that reflectances are factors, where 1 is the perfect diffuser, and {}, which is more than a paint "
        "reflects: {}",
        whose, first_impossible_, remedy);
  return percent ? 0.01 : 1;
}

Result<double> ScaleJudge::unit_of_format(const std::string& format, Scale defined, Scale option, Remarks& remarks) {
  close_paint();
  if (option == Scale::kPercent) note_dark(remarks);
  if (option != Scale::kUnstated) return checked(option, "--scale", kOtherScale);
  const bool percent = defined == Scale::kPercent;
  if (is_told_by_lab() && (as_percent_ < as_factor_) != percent) {
    remarks.note(
        fmt::format("reflectances were read as {}, as the L* beside them says", percent ? "factors" : "percent"), "");
    return percent ? 1 : 0.01;
  }
  if (percent && !is_told_by_lab() && paints_ > 0 && brightest_ <= kDarkest)
    remarks.note(
        fmt::format(
            "{} has reflectances in percent, of which none is above {}: give paint-convert --scale factor if they are "
            "factors",
            format, reflectance(brightest_)),
        "");
  else if (percent)
    note_dark(remarks);
  return checked(defined, format, kRemedy);
}

Result<double> ScaleJudge::unit_of_norm() {
  close_paint();
  return checked(Scale::kFactor, "SPECTRAL_NORM", "correct it");
}

Result<double> ScaleJudge::unit(Scale stated, Scale option, Remarks& remarks) {
  close_paint();
  if (stated != Scale::kUnstated) {
    if (option != Scale::kUnstated && option != stated)
      remarks.note("--scale has no effect on reflectances whose scale the file states", "");
    return checked(stated, "the file", "correct it");
  }
  if (option == Scale::kPercent) note_dark(remarks);
  if (option != Scale::kUnstated) return checked(option, "--scale", kOtherScale);
  if (paints_ == 0) return 1;
  if (is_told_by_lab()) {
    if (as_factor_ < as_percent_) return 1;
    remarks.note("reflectances were read as percent, as the L* beside them says", "");
    return 0.01;
  }
  if (impossible_ == 0 && first_bright_.empty()) {
    remarks.note(
        "reflectances were read as factors, where 1 is the perfect diffuser: give paint-convert --scale percent if not",
        "");
    return 1;
  }
  if (2 * impossible_ >= paints_ && impossible_ > 0) {
    constexpr std::size_t kMixed = 4;  // one in so many
    if (kMixed * dark_ >= paints_)
      return input_error(
          "reflectances are written as percent and as factors: {}, which as a factor is more than paint reflects, and "
          "{}, which in percent is nearly black, as {} of {} paints are: split the file, or give paint-convert --scale "
          "percent if "
          "they are so dark",
          first_impossible_, first_dark_, dark_, paints_);
    note_dark(remarks);
    remarks.note(fmt::format("reflectances were read as percent: as factors, {} of {} paints would reflect more than "
                             "paint can; give paint-convert --scale factor if not",
                             impossible_, paints_),
                 "");
    return 0.01;
  }
  return input_error("nothing says whether reflectances are percent or factors, and {}: {}",
                     impossible_ > 0 ? fmt::format("{}, which as a factor is more than paint reflects, unlike {} other "
                                                   "paints",
                                                   first_impossible_, paints_ - impossible_)
                                     : first_bright_ + ", which may be either",
                     kRemedy);
}

void XyzScale::set(Scale option, bool has_spectra) {
  is_given_ = option != Scale::kUnstated && !has_spectra;
  white_ = is_given_ && option == Scale::kFactor ? 1 : 100;
}

color::Xyz XyzScale::scaled(const color::Xyz& xyz) {
  brightest_ = std::max(brightest_, xyz.Y);
  return {xyz.X / white_, xyz.Y / white_, xyz.Z / white_};
}

void XyzScale::finish(Remarks& remarks) const {
  constexpr double kBlack = 1.25;  // of 100: where no reading of a file is brighter, all are nearly black
  if (!is_given_ && brightest_ > 0 && brightest_ <= kBlack)
    remarks.note(
        fmt::format("XYZ were read from 0 to 100, as the format has them, and no Y is above {}: give "
                    "paint-convert --scale factor if they go from 0 to 1, --scale percent if all are that dark",
                    reflectance(brightest_)),
        "");
}

void note_uncovered(double held_share, std::string_view example, Remarks& remarks) {
  if (held_share > color::kToldHeldShare)
    remarks.note(
        fmt::format("spectra leave out {:.0f} % of what the observer sees, and were taken to go on as they end",
                    100 * held_share),
        example);
}

Result<color::Lab> SpectralMeter::lab(const paint::SpectrumReading& spectrum, const color::ViewingCondition& condition,
                                      double unit) {
  if (!meter_ || spectrum.from_nm != from_nm_ || spectrum.step_nm != step_nm_ ||
      spectrum.factors.size() != factors_.size() || condition != condition_) {
    from_nm_ = spectrum.from_nm, step_nm_ = spectrum.step_nm, condition_ = condition;
    std::vector<double> nm;
    for (std::size_t i = 0; i < spectrum.factors.size(); ++i)
      nm.push_back(from_nm_ + step_nm_ * static_cast<double>(i));
    meter_.reset();
    GONIO_ASSIGN(meter_, color::SpectralColorimeter::make(nm, condition));
  }
  factors_ = spectrum.factors;
  for (double& factor : factors_) factor *= unit;
  return meter_->lab(factors_);
}

}  // namespace goniochrome::formats
