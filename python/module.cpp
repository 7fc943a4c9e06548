// The library of the Python package goniochrome: paints, fits, color differences and environments as functions in C. It
// needs no header of Python, so one build serves every version; package/__init__.py is its only caller.
//
// A function returns facts in JSON, valid until its thread calls again; a text alone is the message of an error.
// `place` in the facts of an object is its address, and `keep` gets what keeps it there until goniochrome_release().
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>

#include "base/file.h"
#include "base/json.h"
#include "brdf/lobe_model.h"
#include "color/color.h"
#include "envmap/environment.h"
#include "envmap/prefiltered.h"
#include "fit/paint_fit.h"
#include "formats/basis.h"
#include "formats/paint_source.h"
#include "formats/xml.h"
#include "paint/curve.h"
#include "paint/metrics.h"

namespace goniochrome::python {

namespace {

// Python hands colors and directions over as arrays of three numbers each.
static_assert(sizeof(color::Lab) == 3 * sizeof(double) && sizeof(Vec3) == 3 * sizeof(double));

using Keep = std::shared_ptr<const void>;

thread_local std::string answer;

// The facts that body() returns, if any, or the message of what it throws.
template <class Body>
const char* answered(const Body& body) {
  try {
    if constexpr (std::is_void_v<decltype(body())>)
      body(), answer = "null";
    else
      answer = json_text(body());
  } catch (const std::exception& error) {
    answer = json_text(error.what());
  } catch (...) {
    answer = json_text("an unknown error");
  }
  return answer.c_str();
}

template <class T>
T value_of(Result<T> result) {
  if (!result.ok()) throw std::runtime_error(result.error().message);
  if constexpr (!std::is_void_v<T>) return std::move(result).value();
}

template <class T>
const T& kept(T object, Keep** keep) {
  auto shared = std::make_shared<const T>(std::move(object));
  *keep = new Keep(shared);
  return *shared;
}

Json place(const void* object) {
  return reinterpret_cast<std::uintptr_t>(object);
}
// A number that is not finite is a text in JSON.
Json number(double value) {
  return std::isfinite(value) ? Json(value) : Json(fmt::format("{}", value));
}
Json triple(const Vec3& v) {
  return {v.x, v.y, v.z};
}

Json facts(const paint::LobeFit& fit) {
  Json result{{"coat_index", fit.coat_index}, {"diffuse", triple(fit.diffuse)}, {"lobes", Json::array()}};
  result["mean_de00"] = number(fit.mean_de00);
  result["max_de00"] = number(fit.max_de00);
  for (const auto& [exponent, diffuse, gloss] : fit.lobes)
    result["lobes"].push_back(
        {{"exponent", number(exponent)}, {"directional_diffuse", triple(diffuse)}, {"gloss", triple(gloss)}});
  return result;
}

Json facts(const paint::Paint& paint) {
  const auto [illuminant, observer_deg] = paint::condition_of(paint);
  Json result{{"place", place(&paint)}, {"name", paint.name}, {"code", paint.code}, {"observer_deg", observer_deg}};
  result["illuminant"] = illuminant;
  result["paint_class"] = paint::paint_class_name(paint.paint_class);
  result["lobes"] = paint.lobes ? facts(*paint.lobes) : Json();
  result["geometries"] = result["readings"] = Json::array();
  if (paint.measurement)
    for (const auto& [geometry, lab] : paint.measurement->rows) {
      result["geometries"].push_back(paint::geometry_name(geometry));
      result["readings"].push_back({lab.L, lab.a, lab.b});
    }
  return result;
}

Json facts(const envmap::PrefilteredLobe& lobe) {
  const envmap::SphereGrid grid = envmap::map_grid(lobe.layout, lobe.map.size);
  return {{"texels", place(lobe.map.texels.data())},
          {"shape", grid.is_cube() ? Json{6, lobe.map.size, lobe.map.size, 3} : Json{grid.height(), grid.width(), 3}},
          {"exponent", number(lobe.exponent)},
          {"max_error", number(lobe.max_error)}};
}

template <class T>
Json facts(const std::vector<T>& objects) {
  Json result = Json::array();
  for (const T& object : objects) result.push_back(facts(object));
  return result;
}

fit::FitMethod method_of(const std::string& name) {
  for (const auto method : {fit::FitMethod::kL1, fit::FitMethod::kL2, fit::FitMethod::kDeltaE})
    if (name == fit::fit_method_name(method)) return method;
  throw std::runtime_error("method \"" + name + "\": l1, l2 and deltae are known");
}

double coat_of(double index) {
  if (index == paint::kNoCoat || (index >= paint::kLeastCoatIndex && index <= paint::kMostCoatIndex)) return index;
  throw std::runtime_error(fmt::format("coat_index {}: give 1 for none, or from {} to {}", index,
                                       paint::kLeastCoatIndex, paint::kMostCoatIndex));
}

}  // namespace

extern "C" {

void goniochrome_release(const Keep* keep) {
  delete keep;
}

const char* goniochrome_read_paints(const char* path, Keep** keep) {
  return answered([&]() -> Json {
    std::vector<std::string> warnings;
    const auto& paints = kept(value_of(formats::read_paints(path, &warnings)), keep);
    return {{"paints", facts(paints)}, {"warnings", warnings}};
  });
}

const char* goniochrome_write_paints(const char* path, const paint::Paint* const* paints, std::size_t count) {
  return answered([&] {
    auto writer = value_of(formats::PaintWriter::begin(value_of(OutputFile::create(path))));
    for (std::size_t i = 0; i < count; ++i) value_of(writer.write(*paints[i]));
    value_of(writer.finish());
  });
}

const char* goniochrome_metrics(const paint::Paint* paint) {
  return answered([&] {
    const paint::PaintMetrics numbers = value_of(paint::metrics(*paint));
    Json result;
    for (const auto& [name, value, meaning] : paint::metric_columns()) result[name] = number(numbers.*value);
    return result;
  });
}

// Lab at aspecular angles, by the curve that the paint states or that its readings make.
const char* goniochrome_curve(const paint::Paint* paint, const double* angles_deg, std::size_t count, color::Lab* out) {
  return answered([&] {
    if (!paint->appearance && !paint->measurement)
      throw std::runtime_error("paint \"" + paint->name + "\" has neither readings nor a curve");
    const paint::Appearance curve = paint->appearance
                                        ? *paint->appearance
                                        : value_of(paint::appearance_from_rows(paint->measurement->rows)).appearance;
    for (std::size_t i = 0; i < count; ++i) out[i] = paint::lab_at(curve, std::abs(angles_deg[i]));
  });
}

// f of pairs of directions, in the frame whose z is the normal.
const char* goniochrome_brdf(const paint::Paint* paint, const Vec3* light, const Vec3* view, std::size_t count,
                             color::Rgb* out) {
  return answered([&] {
    if (!paint->lobes) throw std::runtime_error("paint \"" + paint->name + "\" has no lobes: fit it first");
    const double gloss_deg = paint->gloss.empty() ? brdf::kGlossIncidence_deg : paint->gloss.front().angle_deg;
    for (std::size_t i = 0; i < count; ++i)
      out[i] = brdf::coated_brdf(*paint->lobes, normalized(light[i]), normalized(view[i]), {0, 0, 1}, gloss_deg);
  });
}

// No coat_index: that of each paint, or what its gloss asks for.
const char* goniochrome_fit(const paint::Paint* const* paints, std::size_t count, const char* basis,
                            const double* exponents, std::size_t lobes, bool mirror, const char* method,
                            const double* coat_index, Keep** keep) {
  return answered([&] {
    fit::FitOptions options;
    options.method = method_of(method);
    if (coat_index) options.coat_index = coat_of(*coat_index);
    std::vector<paint::Paint> fitted;
    for (std::size_t i = 0; i < count; ++i) fitted.push_back(*paints[i]);
    const auto made = fit::fits({{basis, {exponents, exponents + lobes}, mirror}, options}, fitted);
    for (std::size_t i = 0; i < count; ++i) {
      if (!made[i].ok()) throw std::runtime_error("paint \"" + fitted[i].name + "\": " + made[i].error().message);
      fitted[i].lobes = made[i]->lobes;
      fitted[i].coat_index = made[i]->lobes.coat_index;
    }
    return facts(kept(std::move(fitted), keep));
  });
}

const char* goniochrome_read_basis(const char* path) {
  return answered([&]() -> Json {
    const formats::Basis basis = value_of(formats::read_basis(path));
    return {{"name", basis.name}, {"mirror", basis.mirror}, {"exponents", basis.exponents}};
  });
}

// CIEDE2000 or CIE 1976 of every x from its y, or of all x from one y.
const char* goniochrome_delta_e(bool is_2000, const color::Lab* x, std::size_t count, const color::Lab* y,
                                std::size_t others, double* out) {
  const auto difference = is_2000 ? color::delta_e_2000 : color::delta_e_76;
  for (std::size_t i = 0; i < count; ++i) out[i] = difference(x[i], y[others == 1 ? 0 : i]);
  return "null";
}

// Lab of RGB, or RGB of Lab.
const char* goniochrome_convert(bool to_lab, const Vec3* in, std::size_t count, const char* illuminant,
                                double observer_deg, Vec3* out) {
  return answered([&] {
    if (observer_deg != std::clamp(std::round(observer_deg), 0., 180.))
      throw std::runtime_error(fmt::format("observer {} is not known: give 2 or 10 (degrees)", observer_deg));
    const color::Xyz white = value_of(color::white_point({illuminant, static_cast<int>(observer_deg)}));
    for (std::size_t i = 0; i < count; ++i) {
      const auto [L, a, b] = to_lab ? color::lab_from_rgb(in[i], white) : color::Lab{in[i].x, in[i].y, in[i].z};
      out[i] = to_lab ? Vec3{L, a, b} : color::rgb_from_lab({L, a, b}, white);
    }
  });
}

const char* goniochrome_geometry(const char* name) {
  return answered([&]() -> Json {
    const paint::Geometry geometry = value_of(paint::parse_geometry(name));
    const auto [light, view] = paint::directions(geometry);
    return {triple(light), triple(view), paint::aspecular_angle_deg(geometry)};
  });
}

// In the order of Environment::Layout.
constexpr const char* kLayouts[] = {"lat-long", "cube", "cube-edges", "angular"};

const char* goniochrome_read_environment(const char* path, Keep** keep) {
  return answered([&]() -> Json {
    const auto& read = kept(value_of(envmap::Environment::read(path, envmap::Environment::BadPixels::kError)), keep);
    return {{"place", place(&read)},
            {"layout", kLayouts[static_cast<int>(read.layout())]},
            {"texels", place(read.values().data())},
            {"shape", {read.height(), read.width(), 3}}};
  });
}

const char* goniochrome_directions(const envmap::Environment* environment, Vec3* out) {
  for (int row = 0; row < environment->height(); ++row)
    for (int column = 0; column < environment->width(); ++column) *out++ = environment->direction(column, row);
  return "null";
}
const char* goniochrome_solid_angles(const envmap::Environment* environment, double* out) {
  for (int row = 0; row < environment->height(); ++row)
    for (int column = 0; column < environment->width(); ++column) *out++ = environment->solid_angle(column, row);
  return "null";
}

const char* goniochrome_read_prefiltered(const char* path, Keep** keep) {
  return answered([&]() -> Json {
    const auto& read = kept(value_of(envmap::read_env(path)), keep);
    return {{"source", read.source},
            {"diffuse", facts(read.diffuse)},
            {"mirror", facts(read.mirror)},
            {"lobes", facts(read.lobes)}};
  });
}

}  // extern "C"

}  // namespace goniochrome::python
