#include "capture/map_fit.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <mutex>
#include <utility>

#include "base/angles.h"
#include "base/clock.h"
#include "base/parallel.h"
#include "capture/internal/error_tally.h"
#include "capture/internal/texel_fit.h"
#include "math/statistics.h"

namespace goniochrome::capture {

namespace {

// The rounding of the file is most of a value below so many standard deviations of it.
constexpr double kAboveRounding = 3;

struct Band {
  int first = 0, rows = 0;
  std::vector<PhotoPixel> pixels;
};

// A job holds the data of the photographs, and which of them the fit may use.
class Job {
 public:
  Job(const PhotoTable& table, const PhotoStack& stack, const MapFitOptions& options)
      : table_(table),
        stack_(stack),
        options_(options),
        scale_(table.photos.size()),
        fitted_(table.photos.size(), true) {
    for (std::size_t k = 0; k < scale_.size(); ++k) scale_[k] = 1 / (kPi * table.photos[k].exposure);
    for (int h = 0; h < options.holdout; ++h) fitted_[held(h)] = false;
  }

  Result<void> check() const;
  Result<MapFit> run();

 private:
  std::size_t held(int h) const { return static_cast<std::size_t>((h + 0.5) * stack_.count() / options_.holdout); }
  bool is_held(std::size_t photo) const {
    for (int h = 0; h < options_.holdout; ++h)
      if (held(h) == photo) return true;
    return false;
  }
  double texel_size() const { return options_.width / stack_.width(); }
  std::size_t texel(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(stack_.width()) + static_cast<std::size_t>(column);
  }
  Vec3 normal_of(int column, int row) const {
    const float* n = options_.normals->pixel(column, row);
    return normalized(Vec3{n[0], n[1], n[2]});
  }
  bool inside(int column, int row) const { return !options_.mask || options_.mask->pixel(column, row)[0] > 0.5F; }
  void put_samples(const Band& band, int column, int row, TexelSamples& samples) const;
  void hold_out(TexelSamples& samples) const;
  TexelOptions texel_options() const;

  Result<std::vector<TexelSamples>> probes() const;
  Result<void> mend(std::vector<TexelSamples>& probes_seen, MapFit& out);
  void find_exposures(const std::vector<TexelSamples>& probes, MapFit& out);
  void compare_methods(const std::vector<TexelSamples>& probes, MapFit& out);
  TexelFit fit_at(const brdf::SbrdfTexture& map, int column, int row) const;
  void put_texel(const TexelFit& fit, int column, int row, brdf::SbrdfTexture& map) const;
  Result<void> for_bands(const char* stage, double from, double to,
                         const std::function<void(const Band&, int row)>& work) const;
  Result<void> fit_alone(MapFit& out);
  Result<void> fit_together(MapFit& out);

  const PhotoTable& table_;
  const PhotoStack& stack_;
  const MapFitOptions& options_;
  std::vector<double> scale_;  // from a pixel's value to f cos_i at distance 1
  std::vector<char> fitted_;   // whether the fit sees the photograph
  TexelOptions chosen_;

  // Results of the first fit of a texel, besides the map.
  struct First {
    float spread = 1;
    std::uint16_t used = 0, left_out = 0;
    bool certain = false;
  };
  std::vector<First> first_;
};

Result<void> Job::check() const {
  const int width = stack_.width(), height = stack_.height();
  GONIO_TRY(
      check_stations(table_, options_.width, texel_size() * height, least_photos(options_.lobes) + options_.holdout));
  for (const auto& [image, what] : {std::pair{options_.mask, "mask"}, {options_.normals, "picture of normals"}})
    if (image && (image->width != width || image->height != height))
      return input_error("the {} is {} x {}, but the photographs are {} x {}: give it their size", what, image->width,
                         image->height, width, height);
  if (!options_.normals) return {};
  for (int row = 0; row < height; ++row)
    for (int column = 0; column < width; ++column) {
      const float* n = options_.normals->pixel(column, row);
      constexpr float kLeast = 0.1F;
      if (!(n[2] >= kLeast))
        return input_error("the normal of texel ({},{}) is {} {} {}: its z must be {} or more", column, row, n[0], n[1],
                           n[2], kLeast);
    }
  return {};
}

void Job::put_samples(const Band& band, int column, int row, TexelSamples& samples) const {
  const double size = texel_size();
  const Vec3 at = {(column + 0.5) * size - options_.width / 2, (0.5 * stack_.height() - row - 0.5) * size, 0};
  brdf::SurfaceFrame frame{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  if (options_.normals) frame = brdf::surface_frame({}, normal_of(column, row), {1, 0, 0});
  samples.resize(stack_.count());
  const std::size_t in_band = static_cast<std::size_t>(row - band.first) * static_cast<std::size_t>(stack_.width()) +
                              static_cast<std::size_t>(column);
  const std::size_t per_photo = static_cast<std::size_t>(band.rows) * static_cast<std::size_t>(stack_.width());
  for (Eigen::Index k = 0; k < samples.count(); ++k) {
    const auto photo = static_cast<std::size_t>(k);
    const Photo& p = table_.photos[photo];
    const Vec3 light = p.light.direction(at);
    if (!samples.aim(k, frame.local(light), frame.local(p.camera.direction(at)))) continue;
    const PhotoPixel& pixel = band.pixels[photo * per_photo + in_band];
    const double distance = p.light.distance(at), gain = scale_[photo] * distance * distance;
    samples.value.row(k) << gain * pixel.r, gain * pixel.g, gain * pixel.b;
    samples.rounding[k] = gain * std::abs(pixel.rounding);
    samples.use[k] = pixel.rounding < 0 ? Use::kLowerBound : Use::kValue;
  }
}

void Job::hold_out(TexelSamples& samples) const {
  for (Eigen::Index k = 0; k < samples.count(); ++k)
    if (!fitted_[static_cast<std::size_t>(k)]) samples.use[k] = Use::kNone;
}

TexelOptions Job::texel_options() const {
  return {.lobes = options_.lobes, .relative_noise = options_.relative_noise};
}

// The relative errors of a fit over those photographs of a texel that `which` takes.
template <class Which, class Take>
void tell_errors(const TexelSamples& samples, const TexelFit& fit, const Which& which, const Take& take) {
  const Eigen::ArrayX3d model = fitted_values(samples, fit);
  for (Eigen::Index k = 0; k < samples.count(); ++k) {
    if (samples.use[k] != Use::kValue || !which(static_cast<std::size_t>(k))) continue;
    const double size = samples.value.row(k).abs().sum();
    if (size <= 3 * kAboveRounding * samples.rounding[k] || !(size > 0)) continue;
    take(static_cast<std::size_t>(k), (model.row(k) - samples.value.row(k)).abs().sum() / size,
         model.row(k).sum() / size);
  }
}

// At most 256 texels of the surface, evenly spread: of the texels in the order of reading, one at a place in each of as
// many equal parts, where the places follow the golden ratio and therefore no columns.
Result<std::vector<TexelSamples>> Job::probes() const {
  std::size_t surface = 0;
  for (int row = 0; row < stack_.height(); ++row)
    for (int column = 0; column < stack_.width(); ++column) surface += inside(column, row);
  constexpr std::size_t kMost = 256;
  const std::size_t count = std::min(kMost, surface);
  const double part = static_cast<double>(surface) / static_cast<double>(std::max<std::size_t>(1, count));
  std::vector<TexelSamples> probes;
  std::size_t passed = 0;
  Band band{-1, 1, {}};
  for (int row = 0; row < stack_.height(); ++row)
    for (int column = 0; column < stack_.width(); ++column) {
      if (!inside(column, row)) continue;
      const auto i = static_cast<double>(probes.size());
      const double place = std::fmod(i * 0.6180339887498949, 1.0);
      if (probes.size() == count || passed++ < static_cast<std::size_t>((i + place) * part)) continue;
      if (row != band.first) {
        band.first = row;
        GONIO_TRY(stack_.read_rows(row, 1, band.pixels));
      }
      probes.emplace_back();
      put_samples(band, column, row, probes.back());
    }
  return probes;
}

// A photograph whose values are everywhere the same multiple of what the others predict has the wrong exposure.
void Job::find_exposures(const std::vector<TexelSamples>& probes, MapFit& out) {
  std::vector<std::vector<std::vector<double>>> logs(probes.size());
  std::vector<double> spreads(probes.size());
  parallel_for(probes.size(), 4, [&](std::size_t begin, std::size_t end) {
    TexelFitter fitter(texel_options());
    for (std::size_t i = begin; i < end; ++i) {
      logs[i].resize(table_.photos.size());
      TexelSamples seen = probes[i];
      hold_out(seen);
      const TexelFit fit = fitter.fit(seen, {});
      spreads[i] = fit.spread;
      tell_errors(
          probes[i], fit, [](std::size_t) { return true; },
          [&](std::size_t k, double, double ratio) {
            if (ratio > 0) logs[i][k].push_back(-std::log(ratio));
          });
    }
  });
  constexpr double kWrong = 0.17, kEnough = 8;  // a quarter of a stop; texels that see the photograph
  for (std::size_t k = 0; k < table_.photos.size(); ++k) {
    std::vector<double> all;
    for (const auto& probe : logs)
      if (!probe.empty()) all.insert(all.end(), probe[k].begin(), probe[k].end());
    if (static_cast<double>(all.size()) < kEnough) continue;
    const double middle = math::median(all);
    for (double& value : all) value = std::abs(value - middle);
    out.photos[k].exposure_factor = std::exp(middle);
    out.photos[k].wrong_exposure = std::abs(middle) > kWrong && math::median(all) < 0.5 * std::abs(middle);
  }
  if (!spreads.empty()) chosen_.good_spread = 1.25 * math::median(spreads);
}

// Leaves out photographs of a wrong exposure, or corrects them, until there are no more: one of them hides another.
Result<void> Job::mend(std::vector<TexelSamples>& probes_seen, MapFit& out) {
  std::vector<double> factor(table_.photos.size(), 1.0);
  std::vector<char> wrong(table_.photos.size());
  constexpr int kRounds = 4;
  for (int round = 0; round < kRounds; ++round) {
    find_exposures(probes_seen, out);
    bool news = false;
    for (std::size_t k = 0; k < wrong.size(); ++k) {
      if (!out.photos[k].wrong_exposure || (wrong[k] && !options_.mend_exposures)) continue;
      wrong[k] = true, news = true;
      if (options_.mend_exposures)
        scale_[k] /= out.photos[k].exposure_factor, factor[k] *= out.photos[k].exposure_factor;
      else
        fitted_[k] = false;
    }
    if (!news) break;
    GONIO_ASSIGN(probes_seen, probes());
    if (round + 1 == kRounds) find_exposures(probes_seen, out);
  }
  for (std::size_t k = 0; k < wrong.size(); ++k) {
    out.photos[k].exposure_factor *= factor[k];
    out.photos[k].wrong_exposure = wrong[k];
  }
  return {};
}

void Job::compare_methods(const std::vector<TexelSamples>& probes, MapFit& out) {
  std::vector<MapMethod> methods = {MapMethod::kDictionary};
  constexpr int kMostOfSource = 2;
  if (options_.lobes <= kMostOfSource) methods.push_back(MapMethod::kNonlinear);
  for (const MapMethod method : methods) {
    TexelOptions options = texel_options();
    options.method = method == MapMethod::kNonlinear ? FitMethod::kNonlinear : FitMethod::kDictionary;
    options.good_spread = chosen_.good_spread;
    TexelFitter fitter(options);
    ErrorTally tally;
    constexpr std::size_t kProbes = 64;
    const std::size_t step = std::max<std::size_t>(1, probes.size() / kProbes);
    std::size_t fits = 0;
    const Stopwatch clock;
    for (std::size_t i = 0; i < probes.size(); i += step, ++fits) {
      TexelSamples seen = probes[i];
      hold_out(seen);
      const auto left_out = [](std::size_t k) { return k % 5 == 2; };
      for (Eigen::Index k = 0; k < seen.count(); ++k)
        if (left_out(static_cast<std::size_t>(k))) seen.use[k] = Use::kNone;
      tell_errors(
          probes[i], fitter.fit(seen, {}), [&](std::size_t k) { return left_out(k) && fitted_[k]; },
          [&](std::size_t, double error, double) { tally.add(error); });
    }
    out.methods.push_back(
        {method, tally.median(), 1e6 * clock.elapsed_s() / std::max<double>(1, static_cast<double>(fits))});
  }
  out.method = options_.method;
  // Plain least squares has to be clearly better: a sample need not hold the shadows and specks of the whole.
  constexpr double kClearly = 0.9;
  if (out.method == MapMethod::kBest)
    out.method = out.methods.back().rel_error < kClearly * out.methods.front().rel_error ? out.methods.back().method
                                                                                         : MapMethod::kDictionary;
  chosen_.method = out.method == MapMethod::kNonlinear ? FitMethod::kNonlinear : FitMethod::kDictionary;
}

void Job::put_texel(const TexelFit& fit, int column, int row, brdf::SbrdfTexture& map) const {
  float* to = &map.values[texel(column, row) * static_cast<std::size_t>(map.stride())];
  const auto put = [&](double value) { *to++ = static_cast<float>(value); };
  for (int c = 0; c < 3; ++c) put(fit.surface.diffuse[c]);
  put(std::cos(fit.frame.twice_angle)), put(std::sin(fit.frame.twice_angle));
  for (const brdf::LafortuneLobe& lobe : fit.surface.lobes) {
    for (int c = 0; c < 3; ++c) put(lobe.albedo[c]);
    for (int c = 0; c < 3; ++c) put(lobe.axes[c]);
    put(lobe.exponent);
  }
}

TexelFit Job::fit_at(const brdf::SbrdfTexture& map, int column, int row) const {
  const float* at = map.texel(column, row);
  const First& first = first_[texel(column, row)];
  TexelFit fit;
  fit.frame.twice_angle = std::atan2(at[4], at[3]);
  fit.surface = brdf::sbrdf_texel(map, column, row).surface;
  for (const brdf::LafortuneLobe& lobe : fit.surface.lobes) {
    const double odd = 0.5 * (lobe.axes.x - lobe.axes.y);
    fit.shapes.push_back({std::log(lobe.exponent), 0.5 * (lobe.axes.x + lobe.axes.y), odd * at[3], odd * at[4]});
  }
  fit.spread = first.spread, fit.used = first.used, fit.left_out = first.left_out, fit.certain = first.certain;
  return fit;
}

Result<void> Job::for_bands(const char* stage, double from, double to,
                            const std::function<void(const Band&, int)>& work) const {
  constexpr std::size_t kBytes = std::size_t{1} << 26;
  const std::size_t row_bytes =
      sizeof(PhotoPixel) * static_cast<std::size_t>(stack_.width()) * static_cast<std::size_t>(stack_.count());
  int rows =
      options_.tile_rows > 0 ? options_.tile_rows : static_cast<int>(std::max<std::size_t>(1, kBytes / row_bytes));
  rows = std::min(rows, stack_.height());
  Band band;
  for (band.first = 0; band.first < stack_.height(); band.first += rows) {
    band.rows = std::min(rows, stack_.height() - band.first);
    if (options_.progress) options_.progress(stage, from + (to - from) * band.first / stack_.height());
    GONIO_TRY(stack_.read_rows(band.first, band.rows, band.pixels));
    parallel_for(static_cast<std::size_t>(band.rows), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) work(band, band.first + static_cast<int>(i));
    });
  }
  return {};
}

// Each texel by itself, where its left neighbor's shapes are one start. A row is the work of one thread, so that the
// map depends neither on their number nor on the size of the bands.
Result<void> Job::fit_alone(MapFit& out) {
  return for_bands("fitting", 0, 0.8, [&](const Band& band, int row) {
    TexelFitter fitter(chosen_);
    TexelSamples samples;
    std::vector<TexelFitter::Start> starts;
    for (int column = 0; column < stack_.width(); ++column) {
      if (!inside(column, row)) {
        starts.clear();
        continue;
      }
      put_samples(band, column, row, samples);
      hold_out(samples);
      const TexelFit fit = fitter.fit(samples, starts);
      put_texel(fit, column, row, out.map);
      first_[texel(column, row)] = {static_cast<float>(fit.spread), static_cast<std::uint16_t>(fit.used),
                                    static_cast<std::uint16_t>(fit.left_out), fit.certain};
      starts.clear();
      if (fit.certain) starts.push_back({fit.shapes, fit.frame});
    }
  });
}

// Once more with the eight neighbors of the first map, for those that need it; and the errors of all.
Result<void> Job::fit_together(MapFit& out) {
  const brdf::SbrdfTexture first = out.map;
  ErrorTally fitted, held;
  std::vector<ErrorTally> by_photo(table_.photos.size());
  std::size_t used = 0, left_out = 0;
  std::mutex mutex;
  GONIO_TRY(for_bands("refining", 0.8, 1, [&](const Band& band, int row) {
    TexelFitter fitter(chosen_);
    TexelSamples samples;
    ErrorTally row_fitted, row_held;
    std::vector<ErrorTally> row_photos(table_.photos.size());
    std::size_t row_used = 0, row_left_out = 0, row_texels = 0, row_uncertain = 0;
    std::vector<double> errors;
    std::vector<TexelFitter::Start> starts;
    for (int column = 0; column < stack_.width(); ++column) {
      const std::size_t here = texel(column, row);
      if (!inside(column, row)) continue;
      put_samples(band, column, row, samples);
      const TexelSamples all = samples;
      hold_out(samples);
      TexelFit fit = fit_at(first, column, row);
      if (chosen_.method == FitMethod::kDictionary && !(fit.certain && fit.spread < chosen_.good_spread)) {
        starts.clear();
        for (int y = std::max(0, row - 1); y <= std::min(stack_.height() - 1, row + 1); ++y)
          for (int x = std::max(0, column - 1); x <= std::min(stack_.width() - 1, column + 1); ++x)
            if ((x != column || y != row) && first_[texel(x, y)].certain) {
              const TexelFit neighbor = fit_at(first, x, y);
              starts.push_back({neighbor.shapes, neighbor.frame});
            }
        fit = fitter.together(samples, fit, starts);
        put_texel(fit, column, row, out.map);
      }
      row_used += static_cast<std::size_t>(fit.used), row_left_out += static_cast<std::size_t>(fit.left_out);
      ++row_texels, row_uncertain += !fit.certain;
      out.certainty[here] = fit.certain ? 1.0F : 0.0F;
      errors.clear();
      tell_errors(
          all, fit, [](std::size_t) { return true; },
          [&](std::size_t k, double error, double) {
            row_photos[k].add(error);
            if (is_held(k)) {
              row_held.add(error);
            } else if (fitted_[k]) {
              row_fitted.add(error);
              errors.push_back(error);
            }
          });
      out.error[here] = errors.empty() ? 0 : static_cast<float>(math::median(errors));
    }
    const std::lock_guard<std::mutex> lock(mutex);  // counts, whose order does not matter
    fitted.add(row_fitted), held.add(row_held);
    for (std::size_t k = 0; k < by_photo.size(); ++k) by_photo[k].add(row_photos[k]);
    used += row_used, left_out += row_left_out, out.texels += row_texels, out.uncertain += row_uncertain;
  }));
  out.rel_error_median = fitted.median();
  out.holdout_rel_error = held.median();
  for (std::size_t k = 0; k < by_photo.size(); ++k) out.photos[k].rel_error = by_photo[k].median();
  out.left_out_share = used + left_out > 0 ? static_cast<double>(left_out) / static_cast<double>(used + left_out) : 0;
  return {};
}

Result<MapFit> Job::run() {
  const Stopwatch clock;
  MapFit out;
  out.photos.resize(table_.photos.size());
  for (std::size_t k = 0; k < out.photos.size(); ++k) out.photos[k].held_out = is_held(k);
  chosen_ = texel_options();
  GONIO_ASSIGN(std::vector<TexelSamples> samples, probes());
  if (samples.empty()) return input_error("the mask leaves no texel to fit: white is the surface");
  GONIO_TRY(mend(samples, out));
  compare_methods(samples, out);
  const int width = stack_.width(), height = stack_.height();
  const std::size_t texels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  out.map = {width, height, options_.lobes, {}};
  out.map.values.assign(texels * static_cast<std::size_t>(out.map.stride()), 0.0F);
  for (std::size_t i = 0; i < texels; ++i) {
    float* values = &out.map.values[i * static_cast<std::size_t>(out.map.stride())];
    values[3] = 1;
    for (int j = 0; j < options_.lobes; ++j)
      values[8 + 7 * j] = values[9 + 7 * j] = -1, values[10 + 7 * j] = values[11 + 7 * j] = 1;
  }
  out.alpha.assign(texels, 0), out.certainty.assign(texels, 0), out.error.assign(texels, 0);
  for (int row = 0; row < height; ++row)
    for (int column = 0; column < width; ++column) out.alpha[texel(column, row)] = inside(column, row) ? 1.0F : 0.0F;
  if (options_.normals)
    for (int row = 0; row < height; ++row)
      for (int column = 0; column < width; ++column) {
        const Vec3 n = normal_of(column, row);
        for (int k = 0; k < 3; ++k) out.map.normals.push_back(static_cast<float>(n[k]));
      }
  first_.assign(texels, {});
  GONIO_TRY(fit_alone(out));
  GONIO_TRY(fit_together(out));
  out.fit_s = clock.elapsed_s();
  return out;
}

}  // namespace

int least_photos(int lobes) {
  return 4 + 4 * lobes;
}

const char* method_name(MapMethod method) {
  return method == MapMethod::kBest ? "best" : method == MapMethod::kDictionary ? "dictionary" : "nonlinear";
}

Result<MapFit> fit_map(const PhotoTable& table, const PhotoStack& stack, const MapFitOptions& options) {
  Job job(table, stack, options);
  GONIO_TRY(job.check());
  return job.run();
}

}  // namespace goniochrome::capture
