#include "foreign_formats.h"

#include <filesystem>

#include "brdf/measured.h"
#include "color/spectrum.h"
#include "formats/cgats.h"
#include "formats/cxf.h"
#include "paint/curve.h"
#include "paint/spectra.h"

namespace goniochrome::tool {

namespace {

using SinkPointer = std::unique_ptr<PaintSink>;

Json as_json(const std::string& name, const brdf::MeasuredTraits& traits, const brdf::MeasuredChecks& told,
             const brdf::MeasuredColor& color) {
  Json json = {{"name", name},
               {"format", traits.format},
               {"description", traits.description},
               {"illuminant", color.condition.illuminant},
               {"observer", color.condition.observer_deg},
               {"samples", traits.samples},
               {"negative_share", told.negative_share},
               {"zero_share", told.zero_share},
               {"reciprocity_error", told.reciprocity_error},
               {"reciprocity_if_f_cos", told.reciprocity_if_f_cos},
               {"values", told.values},
               {"noise_floor", told.noise_floor},
               {"albedo_45", told.albedo_45},
               {"held_share", color.held_share},
               {"geometries", Json::array()}};
  for (const brdf::MeasuredReading& reading : color.readings)
    json["geometries"].push_back({{"geometry", paint::geometry_name(reading.geometry)},
                                  {"gap_deg", reading.gap_deg},
                                  {"outside_deg", reading.outside_deg},
                                  {"negative", reading.negative},
                                  {"below_noise", reading.noise}});
  return json;
}

// The readings to be wary of, one line for each reason.
std::vector<std::string> cautions(const brdf::MeasuredColor& color) {
  constexpr double kWideGap_deg = 15;
  std::string gaps, outside, negative, noise, unmeasured;
  const auto append = [](std::string& list, const std::string& item) { list += (list.empty() ? "" : ", ") + item; };
  for (const brdf::MeasuredReading& reading : color.readings) {
    const std::string name = paint::geometry_name(reading.geometry);
    if (reading.outside_deg > 0)
      append(outside, fmt::format("{} by {:.0f} deg", name, reading.outside_deg));
    else if (reading.gap_deg > kWideGap_deg)
      append(gaps, fmt::format("{} across {:.0f} deg", name, reading.gap_deg));
    if (reading.negative) append(negative, name);
    if (reading.noise) append(noise, name);
  }
  for (const paint::Geometry& geometry : color.unmeasured) append(unmeasured, paint::geometry_name(geometry));
  std::vector<std::string> lines;
  if (!gaps.empty()) lines.push_back("interpolated between samples far apart: " + gaps);
  if (!outside.empty()) lines.push_back("beyond the measured directions, the nearest sample was taken: " + outside);
  if (!negative.empty()) lines.push_back("a channel is negative, which no color is, and was taken as 0: " + negative);
  if (!noise.empty()) lines.push_back("darker than the noise of the data: " + noise);
  if (!unmeasured.empty()) lines.push_back("the file has no value, the row is left out: " + unmeasured);
  return lines;
}

// A measured BRDF is one paint, which has the name of its file.
class MeasuredSource : public formats::PaintSource {
 public:
  MeasuredSource(InputFile input, const SourceSetup& setup)
      : name_(input.name()), setup_(setup), input_(std::move(input)) {}

  Result<std::optional<paint::Paint>> next() override {
    if (!input_) return std::optional<paint::Paint>();
    InputFile input = std::move(*input_);
    input_.reset();
    constexpr std::size_t kLargestFile = std::size_t{1} << 30;
    GONIO_ASSIGN(const std::string bytes, input.rest(kLargestFile));
    GONIO_ASSIGN(const auto brdf, brdf::read_measured(name_, bytes));
    const bool is_rgb = brdf->traits().wavelengths_nm.empty();
    brdf::MeasuredColorOptions options{setup_.geometries, {}, setup_.aperture_deg};
    if (is_rgb) options.condition.observer_deg = 2;
    if (!setup_.import.illuminant.empty()) options.condition.illuminant = setup_.import.illuminant;
    if (setup_.import.observer_deg) options.condition.observer_deg = setup_.import.observer_deg;
    const brdf::MeasuredChecks told = brdf::checks(*brdf, options.condition);
    options.noise_floor = told.noise_floor;
    if (options.geometries.empty())
      for (const paint::LabReading& row : paint::rows_of({})) options.geometries.push_back(row.geometry);
    const auto color = brdf::measured_color(*brdf, options);
    if (!color.ok()) return input_error("{}: {}", name_, color.error().message);
    if (color->readings.empty())
      return input_error("{}: has no value at any geometry that is asked for: give others by --geometry", name_);

    for (const std::string& warning : told.warnings) tell(warning);
    for (const std::string& caution : cautions(*color)) tell(caution);
    if (is_rgb && setup_.import.observer_deg == 0)
      tell("its RGB is what the 2 deg observer sees under D65: Lab is D65/2");
    paint::Paint paint;
    paint.name = name_ == "standard input" ? "measured" : std::filesystem::path(name_).stem().string();
    paint.measurement = paint::Measurement{color->condition, "", {}};
    for (const brdf::MeasuredReading& reading : color->readings) {
      paint.measurement->rows.push_back({reading.geometry, reading.lab});
      const auto spectrum = paint::spectrum_of(reading.geometry, brdf->traits().wavelengths_nm, reading.factors);
      if (spectrum) paint.measurement->spectra.push_back(*spectrum);
    }
    figures_ = as_json(paint.name, brdf->traits(), told, *color);
    return std::optional(std::move(paint));
  }
  std::string place() const override { return name_; }
  std::string format() const override { return "measured BRDF"; }
  std::vector<std::string> closing_warnings() const override { return warnings_; }
  Json figures() const override { return figures_; }

 private:
  void tell(const std::string& what) { warnings_.push_back(fmt::format("{}: {}", name_, what)); }

  std::string name_;
  SourceSetup setup_;
  std::optional<InputFile> input_;
  std::vector<std::string> warnings_;
  Json figures_;
};

}  // namespace

Result<formats::PaintSourcePointer> open_measured(InputFile input, const SourceSetup& setup) {
  return formats::PaintSourcePointer(std::make_unique<MeasuredSource>(std::move(input), setup));
}

Result<SinkPointer> begin_cxf(OutputFile file, const SinkSetup& setup) {
  GONIO_ASSIGN(
      formats::CxfWriter writer,
      formats::CxfWriter::begin(std::move(file), {setup.creator, setup.command, setup.created, setup.cxf_compat}));
  return SinkPointer(std::make_unique<SinkOf<formats::CxfWriter>>(std::move(writer)));
}

Result<SinkPointer> begin_cgats(OutputFile file, const SinkSetup& setup) {
  GONIO_ASSIGN(formats::CgatsWriter writer,
               formats::CgatsWriter::begin(std::move(file), setup.creator, setup.created.substr(0, 10)));
  return SinkPointer(std::make_unique<SinkOf<formats::CgatsWriter>>(std::move(writer)));
}

}  // namespace goniochrome::tool
