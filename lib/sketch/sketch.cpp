#include "sketch/sketch.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include "base/angles.h"
#include "base/parallel.h"
#include "brdf/gloss.h"
#include "brdf/lobe_model.h"
#include "display/paint_view.h"
#include "paint/curve.h"
#include "sketch/internal/sketch_curve.h"
#include "sketch/internal/sketch_gloss.h"
#include "sketch/internal/sketch_residual.h"
#include "sketch/internal/sketch_search.h"
#include "sketch/internal/view_angles.h"

namespace goniochrome::sketch {

namespace {

constexpr double kContrastRegion_deg = 15;  // [Shimizu2009] 3.7.3
constexpr std::size_t kFewestCells = 8, kChunk = 8192;
constexpr double kFace_deg = 15;                              // the least of the export angles
constexpr double kReach_deg = 2;                              // an angle this close to one seen counts as seen
constexpr std::size_t kSearchCells = 700, kFirstCells = 400;  // that the answer and the way to it look at

constexpr std::size_t kAnswerPixels = 6000;  // of an environment's picture, looked at for the answer; more change it by
                                             // less than 0.05 dE
constexpr std::size_t kFirstPixels = 1000;   // and on the way to it
constexpr std::size_t kFewestPixels = 30;

// The part of a color that the edited picture could show.
color::Rgb as_displayed(const color::Rgb& rgb, const SketchInput& input) {
  return input.edited->scene_linear ? rgb : display::in_display_gamut(rgb);
}

std::string poor_match(const SketchFit& fit) {
  return fmt::format("half of the pixels differ by more than {:.1f} dE76 from the best paint", fit.median_de76);
}

// Turns `fit` into the matt color, of which `color` is the reflectance factor.
void fall_back(const color::Rgb& color, const std::string& reason, SketchFit& fit) {
  fit.status = "diffuse_fallback", fit.reason = reason, fit.model = "diffuse";
  const color::Lab lab = paint_lab(color);
  fit.appearance = {lab, lab, 60, std::nullopt};
  fit.rows = paint::rows_of(fit.appearance);
  fit.extrapolated_deg.clear();
}

// Rows, face, flop, travel, gloss and condition of a search.
void take_found(const FoundPaint& found, SketchFit& fit) {
  const paint::Paint paint = found.paint();
  fit.model = found.model();
  fit.appearance =
      paint.appearance ? *paint.appearance : paint::appearance_from_rows(paint.measurement->rows)->appearance;
  fit.rows = paint.appearance ? paint::rows_of(fit.appearance) : paint.measurement->rows;
  fit.gloss_60_gu = paint.gloss.front().gloss_units;
  fit.gloss_from = "search";
  fit.condition = found.search.condition;
}

// Rows are read off the lobes that were found where is_told(angle) and where they differ from those of face, flop and
// travel: a curve of few numbers misses what the lobes show where the paint does not follow one. Export angles without
// a row get one.
void take_shown(const formats::Basis& basis, const PaintWeights& weights, double coat_index,
                const std::function<bool(double angle_deg)>& is_told, SketchFit& fit) {
  constexpr double kApart_de00 = 1;  // lobes fitted to a designed curve miss it by less
  for (paint::LabReading& row : fit.rows) {
    const double angle_deg = row.geometry.aspecular_deg;
    if (!is_told(angle_deg)) continue;
    const color::Lab shown = instrument_lab(basis, weights, coat_index, angle_deg);
    if (color::delta_e_2000(shown, row.lab) > kApart_de00) row.lab = shown;
  }
  for (const double angle_deg : paint::kExportAngles_deg) {
    const auto behind = std::ranges::find_if(
        fit.rows, [&](const paint::LabReading& row) { return row.geometry.aspecular_deg >= angle_deg; });
    if (behind != fit.rows.end() && behind->geometry.aspecular_deg == angle_deg) continue;
    fit.rows.insert(behind, {{45, angle_deg}, instrument_lab(basis, weights, coat_index, angle_deg)});
  }
}

// True if a paint of few numbers explains the picture to rounding. It is then the paint that was drawn, and its lobes
// are how far these can follow it.
bool is_exact(const FoundPaint& found) {
  constexpr double kRounded = 1e-4;  // RMS 0.01 dE
  return found.search.cost <= kRounded;
}

// The data of the buffers and the picture at each pixel, relative to the light.
class Seen {
 public:
  explicit Seen(const SketchInput& input) : input_(input), image_(input.buffers->image), views_(*input.buffers) {
    aspecular_ = *input.buffers->channel("aspecular");
    lambert_ = *input.buffers->channel("lambert");
    const auto normal = input.buffers->channel("normal.X");
    const bool coat = std::ranges::find(input.buffers->drawn, "coat") != input.buffers->drawn.end();
    if (coat && normal.ok() && input.buffers->has_rays) normal_ = *normal;
    if (input.buffers->lights.empty()) return;
    const color::Rgb white = input.buffers->lights.front().white;
    for (int c = 0; c < 3; ++c) scale_[c] = white[c] > 0 ? 1 / white[c] : 0;
  }

  SketchSample at(std::uint32_t place) const {
    const float* pixel = &image_.data[static_cast<std::size_t>(place) * image_.channels];
    return {pixel[aspecular_], pixel[lambert_] * coat_share(place, pixel), floats(scale_ * edited_light(input_, place)),
            views_.are_known() ? static_cast<float>(views_.at(place)) : 0};
  }

  bool knows_views() const { return views_.are_known(); }

  // The index of the coat that the picture was drawn with.
  double coat_index() const { return normal_ < 0 ? paint::kNoCoat : brdf::kCoatIndex; }

 private:
  // The share of the base's light that a coat leaves at a pixel, relative to that where an instrument reads the color
  // of that aspecular angle.
  float coat_share(std::uint32_t place, const float* pixel) const {
    if (normal_ < 0) return 1;
    const int x = static_cast<int>(place) % image_.width, y = static_cast<int>(place) / image_.width;
    const Vec3 normal{pixel[normal_], pixel[normal_ + 1], pixel[normal_ + 2]};
    const auto cosine = [](double c) { return std::clamp(c, 0.0, 1.0); };
    const double here = brdf::coat_passages(coat_index(), cosine(pixel[lambert_]),
                                            cosine(dot(normal, input_.buffers->to_viewer(x, y))));
    return static_cast<float>(here / instrument_passages(pixel[aspecular_], coat_index()));
  }

  const SketchInput& input_;
  const image::Image& image_;
  const ViewAngles views_;
  int aspecular_ = 0, lambert_ = 0;
  int normal_ = -1;  // the first of three channels, where the base is seen through a coat
  color::Rgb scale_{1, 1, 1};
};

double luminance(const std::array<float, 3>& rgb) {
  return color::luminance({rgb[0], rgb[1], rgb[2]});
}

// The evidence on gloss in the pixels within 15 deg of specular; both are empty where there is none.
struct Highlight {
  std::optional<double> by_shape, by_contrast;
};

Highlight highlight_of(const SketchInput& input, const SketchPixels& pixels, const Seen& seen,
                       const SketchCurve& curve) {
  std::vector<double> brightness;
  std::vector<HighlightSample> highlight;
  std::size_t clipped = 0;
  const int width = input.buffers->image.width;
  const auto look = [&](std::uint32_t place) {
    const SketchSample s = seen.at(place);
    if (s.aspecular_deg >= kContrastRegion_deg) return;
    const double y = luminance(s.seen);
    const color::Rgb matt = static_cast<double>(s.cos_i) * curve.reflectance(s.aspecular_deg);
    const double matt_y = std::max(0.0, color::luminance(as_displayed(matt, input)));
    brightness.push_back(display::srgb_signal(y) - display::srgb_signal(matt_y));
    const auto shifted = static_cast<std::size_t>(static_cast<int>(place) + input.shift_y * width + input.shift_x);
    if (input.edited->state[shifted] == Picture::kClipped) {
      ++clipped;
      return;
    }
    highlight.push_back({s.aspecular_deg, y - color::luminance(matt)});
  };
  for (const std::uint32_t place : pixels.glare) look(place);
  for (const std::uint32_t place : pixels.used) look(place);
  Highlight found;
  if (clipped == 0) found.by_shape = highlight_gloss(highlight);
  constexpr double kLeastContrast_gu = 5;  // less is what the curve misses
  const double contrast = contrast_gloss(brightness);
  if (clipped > 0 && contrast >= kLeastContrast_gu) found.by_contrast = contrast;
  return found;
}

// Takes the highlight's gloss, by shape or else by contrast. Where there is `allows`, it says whether the pixels
// farther from specular, which show the flanks of wide lobes, agree; where they do not, the gloss of the search stays.
// Where no highlight is seen, the gloss is undetermined: a mirror image of a point lights no pixel.
void take_gloss(const Highlight& highlight, const std::function<bool(double)>& allows, SketchFit& fit) {
  const auto take = [&](double gloss, const char* from) {
    if (allows && !allows(gloss)) return false;
    fit.gloss_60_gu = gloss, fit.gloss_from = from;
    return true;
  };
  if (!highlight.by_shape && !highlight.by_contrast) {
    fit.gloss_from = "undetermined", fit.gloss_low_gu = 0, fit.gloss_high_gu = 100;
    return;
  }
  if (highlight.by_shape && take(*highlight.by_shape, "highlight")) return;
  if (highlight.by_contrast) take(*highlight.by_contrast, "contrast");
}

// The light of a lamp without extent in each part of the model, relative to white; its mirror image is a point.
void lamp_columns(double aspecular_deg, double cos_i, const formats::Basis& basis, double coat_index, Vec3* columns) {
  const auto light = [](double value) { return value * kPi * Vec3{1, 1, 1}; };
  const double base = cos_i * instrument_passages(aspecular_deg, coat_index);
  *columns++ = light(base);
  for (const double exponent : basis.exponents) {
    const double power = lobe_at(aspecular_deg, exponent);
    *columns++ = light(base * power), *columns++ = light(power);
  }
  *columns = {};
}

// The cells as light on lobes: about `most` of them, of all angles and cosines alike. `by_view`: the cells know the
// angles of the viewer.
SearchSamples search_samples(const std::vector<SketchCell>& cells, const formats::Basis& basis, double coat_index,
                             bool by_view, bool display, std::size_t most) {
  const std::size_t step = sketch_step(cells.size(), most);
  SearchSamples samples;
  samples.columns = search_columns(basis);
  samples.coat_index = coat_index;
  samples.display = display;
  for (std::size_t i = 0; i < cells.size(); i += step) {
    const SketchCell& cell = cells[i];
    samples.light.resize(samples.light.size() + samples.columns);
    lamp_columns(cell.aspecular_deg, cell.cos_i, basis, coat_index,
                 &samples.light[samples.seen.size() * samples.columns]);
    samples.seen.push_back(cell.seen);
    if (by_view) samples.view_deg.push_back(cell.view_deg);
    samples.importance.push_back(cell_importance(cell));
  }
  return samples;
}

bool is_seen(const std::vector<SketchCell>& cells, double angle_deg) {
  return std::ranges::any_of(
      cells, [&](const SketchCell& cell) { return std::abs(cell.aspecular_deg - angle_deg) <= kReach_deg; });
}

// Rows, face, flop and travel of a curve.
void take_curve(const SketchCurve& curve, SketchFit& fit) {
  fit.model = curve.travel_deg > 0 ? "quadratic" : "lobes";
  std::vector<paint::LabReading> designed;  // [Shimizu2009] 3.7.3 evaluates at these three
  for (const double angle : paint::kExportAngles_deg) {
    const paint::LabReading row{{45, angle}, paint_lab(curve.reflectance(angle))};
    fit.rows.push_back(row);
    if (angle == 15 || angle == 45 || angle == 110) designed.push_back(row);
  }
  fit.appearance = paint::appearance_from_rows(designed)->appearance;
}

// True if the search, which has a paint's few degrees of freedom, explains the cells as well as a free curve. In a
// clean picture its cost must be nearly the same. In a noisy one the curve may gain by following the noise, and it may
// do so the more where no pixel holds it at the angles asked for, so the search may cost more.
bool is_as_good(double search_cost, double curve_cost, bool extrapolates) {
  constexpr double kNoisy = 0.2;  // of log(1 + dE^2): about half a dE
  if (extrapolates && search_cost <= kNoisy + 1.6 * curve_cost) return true;
  return search_cost <= 1.15 * curve_cost + 0.02 || (curve_cost > kNoisy && search_cost <= 1.6 * curve_cost);
}

// Why a paint found, or a quadratic, is no answer; "" where it is one, or where a pixel shows its face. `face` is its
// reflectance factor there, and `error` has the standard errors of the search, which begin with the face's.
std::string face_problem(const std::vector<SketchCell>& cells, const color::Rgb& face, const std::vector<double>& error,
                         const SketchFit& fit, const SketchLimits& limits) {
  if (is_seen(cells, kFace_deg)) return "";
  const bool open = std::hypot(error[0], error[1], error[2]) > limits.face_error_de76;
  if (!open && is_paint_color(face, limits.median_de76)) return "";
  const std::string problem =
      open ? fmt::format("leave the color at {} deg open by more than {} dE76", kFace_deg, limits.face_error_de76)
           : fmt::format("lead to a color at {} deg that no paint can have", kFace_deg);
  return fmt::format("the pixels show aspecular angles from {:.1f} to {:.1f} deg, which {}", fit.seen_from_deg,
                     fit.seen_to_deg, problem);
}

color::Rgb face_of(const FoundPaint& found) {
  const std::vector<double>& v = found.search.values;
  return color::rgb_from_lab({v[0], v[1], v[2]}, *color::white_point({}));
}

SketchCurve curve_of(const FoundPaint& found, const formats::Basis& basis, double coat_index) {
  SketchCurve curve;
  curve.coat_index = coat_index;
  curve.exponents = basis.exponents;
  curve.diffuse = kPi * found.weights.all.front();
  for (std::size_t j = 0; j < basis.exponents.size(); ++j) {
    curve.flake.push_back(kPi * found.weights.all[1 + 2 * j]);
    curve.glare.push_back(kPi * found.weights.all[2 + 2 * j]);
  }
  return curve;
}

std::string rank_problem(const std::vector<SketchCell>& cells, const SketchFit& fit, const SketchLimits& limits) {
  if (cells.size() < kFewestCells)
    return fmt::format("the pixels show {} different views of the paint, too few for a curve", cells.size());
  if (fit.seen_to_deg - fit.seen_from_deg < limits.least_span_deg)
    return fmt::format("the pixels show aspecular angles from {:.1f} to {:.1f} deg only", fit.seen_from_deg,
                       fit.seen_to_deg);
  return "";
}

SearchSamples samples_of(const SketchInput& input, const std::vector<std::uint32_t>& used, const SketchLight& light,
                         std::size_t most) {
  const std::size_t step = std::max<std::size_t>(1, used.size() / most);
  std::vector<std::uint32_t> places;
  for (std::size_t i = 0; i < used.size(); i += step) places.push_back(used[i]);
  SearchSamples samples;
  samples.columns = search_columns(light.basis);
  samples.reflection = light.reflection;
  samples.coat_index = light.coat_index;
  samples.display = !input.edited->scene_linear;
  samples.light.resize(places.size() * samples.columns);
  samples.importance.assign(places.size(), 1.0);
  parallel_for(places.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) light.shade(places[i], &samples.light[i * samples.columns]);
  });
  const double scale = 1 / input.buffers->white_luminance;
  const ViewAngles views(*input.buffers);
  for (const std::uint32_t place : places) {
    samples.seen.push_back(scale * edited_light(input, place));
    if (views.are_known()) samples.view_deg.push_back(views.at(place));
  }
  return samples;
}

}  // namespace

bool is_paint_color(const color::Rgb& rgb, double within_de76) {
  const color::Rgb nearest{std::max(rgb.x, 0.0), std::max(rgb.y, 0.0), std::max(rgb.z, 0.0)};
  return color::delta_e_76(paint_lab(rgb), paint_lab(nearest)) <= within_de76;
}

namespace {

std::vector<SketchSample> seen_samples(const Seen& seen, const SketchPixels& pixels) {
  std::vector<SketchSample> samples(pixels.used.size());
  parallel_for(samples.size(), kChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) samples[i] = seen.at(pixels.used[i]);
  });
  return samples;
}

// Which aspecular angles the pixels show.
void take_seen(const std::vector<SketchCell>& cells, SketchFit& fit) {
  if (!cells.empty()) fit.seen_from_deg = cells.front().aspecular_deg, fit.seen_to_deg = cells.back().aspecular_deg;
}

// Which of the export angles no pixel shows.
void take_extrapolated(const std::vector<SketchCell>& cells, SketchFit& fit) {
  fit.extrapolated_deg.clear();
  for (const double angle : paint::kExportAngles_deg)
    if (!is_seen(cells, angle)) fit.extrapolated_deg.push_back(angle);
}

}  // namespace

SketchFit sketch_point(const SketchInput& input, const SketchPixels& pixels, const formats::Basis& basis,
                       const SketchLimits& limits, bool with_differences) {
  // The colors of the pixels, sorted into cells.
  const Seen seen(input);
  const std::vector<SketchSample> samples = seen_samples(seen, pixels);
  const std::vector<SketchCell> cells = sketch_cells(samples);
  SketchFit fit;
  take_seen(cells, fit);

  // How the curve that was found is judged, and what is answered where none will do.
  SketchCurve curve;
  const PaintWeights* by_view = nullptr;  // in place of the curve
  std::vector<Vec3> columns(search_columns(basis));
  const auto pixel = [&](std::size_t i) -> PixelPair {
    const SketchSample& s = samples[i];
    color::Rgb shown = static_cast<double>(s.cos_i) * curve.reflectance(s.aspecular_deg) + curve.gloss(s.aspecular_deg);
    if (by_view != nullptr) {
      lamp_columns(s.aspecular_deg, s.cos_i, basis, seen.coat_index(), columns.data());
      shown = shown_light(columns.data(), by_view->mixed_at(s.view_deg), {});
    }
    return {paint_lab({s.seen[0], s.seen[1], s.seen[2]}), paint_lab(as_displayed(shown, input))};
  };
  const auto judge = [&] { take_residual(*input.buffers, pixels.used, pixel, with_differences, fit); };
  const auto give_up = [&](const std::string& problem) {
    curve = {}, curve.diffuse = mean_diffuse(cells), by_view = nullptr;
    fall_back(curve.diffuse, problem, fit);
    judge();
    return fit;
  };
  // A free curve, and a paint by search; the paint is the answer where it explains the cells as well.
  if (const std::string problem = rank_problem(cells, fit, limits); !problem.empty()) return give_up(problem);
  const CurveFit quadratic = fit_quadratic(cells), lobes = fit_lobes(cells);
  const CurveFit& better = lobes.cost <= quadratic.cost ? lobes : quadratic;
  const bool display = !input.edited->scene_linear;
  const double coat = seen.coat_index();
  const SearchFitters fitters(basis, coat);
  const LobeSearch first(fitters, search_samples(cells, basis, coat, seen.knows_views(), display, kFirstCells));
  const LobeSearch search(fitters, search_samples(cells, basis, coat, seen.knows_views(), display, kSearchCells));
  const FoundPaint found = search.find_plain(first);
  const bool as_good = is_as_good(found.search.cost, better.cost, !is_seen(cells, kFace_deg));
  curve = as_good ? curve_of(found, basis, coat) : better.curve;
  if (as_good && !found.weights.views_deg.empty()) by_view = &found.weights;
  judge();
  if (fit.median_de76 > limits.median_de76) return give_up(poor_match(fit));
  std::string problem;
  if (as_good || better.curve.travel_deg > 0)  // lobes of any weight hold to what is seen
    problem =
        face_problem(cells, as_good ? face_of(found) : curve.reflectance(kFace_deg), found.search.error, fit, limits);
  if (!problem.empty()) return give_up(problem);
  // The answer: rows, face, flop and travel, and gloss.
  take_curve(curve, fit);
  if (as_good) take_found(found, fit);
  fit.condition = quadratic.condition;
  take_extrapolated(cells, fit);
  if (as_good)
    take_shown(
        basis, found.weights, coat, [&](double angle) { return !is_exact(found) && is_seen(cells, angle); }, fit);
  const auto allows = [&](double gloss) {
    return search.cost_with_gloss(found, gloss) <= kSameCost * found.search.cost + kSameCostBy;
  };
  take_gloss(highlight_of(input, pixels, seen, curve), as_good ? allows : std::function<bool(double)>(), fit);
  return fit;
}

namespace {

// The pixels that the search looks at: all of them, or all within the highlight of the first lamp and as many others.
struct Looked {
  std::vector<std::uint32_t> answer, way;
};

Looked looked_under_lamps(const SketchInput& input, const SketchPixels& pixels) {
  constexpr double kHighlight_deg = 12;
  constexpr std::size_t kMostAnswer = 3000, kMostWay = 700;
  const image::Image& image = input.buffers->image;
  const int aspecular = *input.buffers->channel("aspecular");
  std::vector<std::uint32_t> near, far;
  for (const std::uint32_t place : pixels.used) {
    const bool is_near = image.data[static_cast<std::size_t>(place) * image.channels + aspecular] < kHighlight_deg;
    (is_near ? near : far).push_back(place);
  }
  const auto take = [](const std::vector<std::uint32_t>& from, std::size_t most, std::vector<std::uint32_t>& to) {
    const std::size_t step = std::max<std::size_t>(1, (from.size() + most - 1) / most);
    for (std::size_t i = 0; i < from.size(); i += step) to.push_back(from[i]);
  };
  Looked looked;
  take(near, kMostAnswer, looked.answer), take(far, kMostAnswer, looked.answer);
  take(near, kMostWay, looked.way), take(far, kMostWay, looked.way);
  return looked;
}

// Which readings explain the pixels as well as the one that was found.
void take_gloss_range(const LobeSearch& search, const FoundPaint& found, SketchFit& fit) {
  constexpr double kStep_gu = 2.5, kOpen_gu = 10;
  fit.gloss_low_gu = fit.gloss_high_gu = fit.gloss_60_gu;
  for (double gloss = 0; gloss <= 100; gloss += kStep_gu) {
    if (!search.explains_as_well(found, gloss)) continue;
    fit.gloss_low_gu = std::min(fit.gloss_low_gu, gloss), fit.gloss_high_gu = std::max(fit.gloss_high_gu, gloss);
  }
  if (fit.gloss_high_gu - fit.gloss_low_gu > kOpen_gu) fit.gloss_from = "undetermined";
}

// The reading of a paint whose mirror image is brighter than that of the usual coat, and which is therefore of a coat
// of a higher index. The search brightens the image by as much as the meter reads more at 60 deg. An index counts more
// at the steeper incidence of a highlight, so that it is sought from the brightness there.
double gloss_of_index(const SketchInput& input, const SketchPixels& pixels, const FoundPaint& found, double gloss) {
  const double usual = *brdf::smooth_gloss(60, brdf::kCoatIndex), found_gloss = found.search.values.back();
  const double base = found_gloss - found.weights.all.back().y * usual;  // what is read of diffuse and flake light
  const double brighter = (gloss - base) / usual;
  if (!(found.weights.all.back().y > 1 && brighter > 1) || pixels.used.empty()) return gloss;
  const image::AovFile& buffers = *input.buffers;
  const int aspecular = *buffers.channel("aspecular"), normal = *buffers.channel("normal.X");
  const auto pixel = [&](std::uint32_t place) {
    return &buffers.image.data[static_cast<std::size_t>(place) * buffers.image.channels];
  };
  const std::uint32_t place =
      *std::ranges::min_element(pixels.used, {}, [&](std::uint32_t p) { return pixel(p)[aspecular]; });
  const float* n = pixel(place) + normal;
  const int x = static_cast<int>(place) % buffers.image.width, y = static_cast<int>(place) / buffers.image.width;
  const double cosine = std::clamp(dot(Vec3{n[0], n[1], n[2]}, buffers.to_viewer(x, y)), 0.0, 1.0);
  return std::min(100.0, base + *brdf::smooth_gloss(60, brdf::coat_index_of_mirror(brighter, cosine)));
}

SketchFit searched(const SketchInput& input, const SketchPixels& pixels, const SketchLight& light,
                   const SketchLimits& limits, bool with_differences, const Looked* lamps) {
  const SearchFitters fitters(light.basis, light.coat_index);
  const LobeSearch search(fitters, lamps != nullptr ? samples_of(input, lamps->answer, light, lamps->answer.size())
                                                    : samples_of(input, pixels.used, light, kAnswerPixels));
  SketchFit fit;
  PaintWeights weights{std::vector<color::Rgb>(search_columns(light.basis))};
  std::vector<Vec3> columns(weights.all.size());
  const ViewAngles views(*input.buffers);
  const double scale = 1 / input.buffers->white_luminance;
  const auto pixel = [&](std::size_t i) -> PixelPair {
    light.shade(pixels.used[i], columns.data());
    const color::Rgb seen = scale * edited_light(input, pixels.used[i]);
    const color::Rgb shown =
        views.are_known() ? shown_light(columns.data(), weights.mixed_at(views.at(pixels.used[i])), light.reflection)
                          : shown_light(columns.data(), weights.all, light.reflection);
    return {paint_lab(seen), paint_lab(as_displayed(shown, input))};
  };
  const auto judge = [&] { take_residual(*input.buffers, pixels.used, pixel, with_differences, fit); };
  const auto give_up = [&](const std::string& reason) {
    const color::Rgb matt = search.matt();
    fall_back(matt, reason, fit);
    weights = {std::vector<color::Rgb>(weights.all.size())}, weights.all[0] = (1 / kPi) * matt;
    judge();
    return fit;
  };
  if (pixels.used.size() < kFewestPixels)
    return give_up(fmt::format("{} pixels are too few for a search", pixels.used.size()));
  const LobeSearch first(fitters, lamps != nullptr ? samples_of(input, lamps->way, light, lamps->way.size())
                                                   : samples_of(input, pixels.used, light, kFirstPixels));
  const FoundPaint found = search.find(first);
  if (lamps != nullptr) {
    const std::vector<SketchCell> cells = sketch_cells(seen_samples(Seen(input), pixels));
    take_seen(cells, fit);
    take_found(found, fit);
    const color::Rgb face = color::rgb_from_lab(fit.appearance.face, *color::white_point({}));
    const std::string problem = face_problem(cells, face, found.search.error, fit, limits);
    if (!problem.empty()) return give_up(problem);
    take_extrapolated(cells, fit);
    take_gloss_range(search, found, fit);
    for (double* gloss : {&fit.gloss_60_gu, &fit.gloss_low_gu, &fit.gloss_high_gu})
      *gloss = gloss_of_index(input, pixels, found, *gloss);
  } else {
    take_found(found, fit);
  }
  weights = found.weights, fit.weights = found.weights.all;
  fit.by_views = !found.weights.views_deg.empty();
  take_shown(
      light.basis, weights, light.coat_index,
      [&](double angle) {
        return !is_exact(found) && std::ranges::find(fit.extrapolated_deg, angle) == fit.extrapolated_deg.end();
      },
      fit);
  judge();
  if (fit.median_de76 > limits.median_de76) return give_up(poor_match(fit));
  return fit;
}

}  // namespace

SketchFit sketch_environment(const SketchInput& input, const SketchPixels& pixels, const SketchLight& light,
                             const SketchLimits& limits, bool with_differences) {
  return searched(input, pixels, light, limits, with_differences, nullptr);
}

SketchFit sketch_lamps(const SketchInput& input, const SketchPixels& pixels, const SketchLight& light,
                       const SketchLimits& limits, bool with_differences) {
  const Looked looked = looked_under_lamps(input, pixels);
  return searched(input, pixels, light, limits, with_differences, &looked);
}

paint::Paint sketch_paint(const SketchFit& fit, const std::string& name) {
  paint::Paint paint;
  paint.name = name;
  paint.paint_class = fit.status == "fitted" ? paint::PaintClass::kUnknown : paint::PaintClass::kSolid;
  paint.measurement = paint::Measurement{{}, "", fit.rows};
  paint.appearance = fit.appearance;
  if (!fit.gloss_from.empty() && fit.gloss_from != "undetermined") paint.gloss.push_back({60, fit.gloss_60_gu});
  return paint;
}

}  // namespace goniochrome::sketch
