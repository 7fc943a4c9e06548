#include "panels/goniogeom_seam.h"

#include <algorithm>
#include <cmath>

#include "base/angles.h"
#include "envmap/cube_map.h"
#include "fit/paint_fit.h"

namespace goniochrome::panels {

namespace {

constexpr double kEdgeOn = 0.02;  // cosine; a panel nearer to edge on is not seen

bool sees_both(const mesh::SeamPoint& p, const Vec3& view) {
  return dot(p.normal_a, view) > kEdgeOn && dot(p.normal_b, view) > kEdgeOn;
}

bool is_glare(const Vec3& light, const Vec3& view, const Vec3& normal) {
  return paint::aspecular_angle_rad(light, view, normal) < kIndexGlare_deg * kDegree - 1e-9;
}

double luminance(const float* rgb) {
  return color::xyz_d65_from_rgb({rgb[0], rgb[1], rgb[2]}).Y;
}

}  // namespace

// In the frame of the first panel at a place, x points away from the light in the plane of incidence. For a seam across
// that plane x is `across` where the light comes from the first panel's side, and its opposite for the second's.
std::vector<SeamView> views_at_seam(const mesh::Seam& seam, const GeometryList& geometries, double seam_deg) {
  std::vector<SeamView> views;
  const double turn = (90 - seam_deg) * kDegree;
  for (std::size_t i = 0; i < seam.points.size(); ++i) {
    const mesh::SeamPoint& p = seam.points[i];
    for (const double side : {1.0, -1.0}) {
      const Vec3 across = side * p.across;
      const Vec3 x = std::cos(turn) * across - std::sin(turn) * cross(p.normal_a, across), y = cross(p.normal_a, x);
      const auto to_world = [&](const Vec3& v) { return v.x * x + v.y * y + v.z * p.normal_a; };
      for (std::size_t g = 0; g < geometries.pairs.size(); ++g) {
        const paint::DirectionPair pair = directions(geometries.pairs[g]);
        const Vec3 view = to_world(pair.view);
        if (sees_both(p, view)) views.push_back({i, to_world(pair.light), view, geometries.weights[g]});
      }
    }
  }
  return views;
}

std::vector<SeamView> views_in_world(const mesh::Seam& seam, const std::vector<Vec3>& lights,
                                     const std::vector<Vec3>& viewers) {
  std::vector<SeamView> views;
  for (std::size_t i = 0; i < seam.points.size(); ++i) {
    const mesh::SeamPoint& p = seam.points[i];
    for (const Vec3& view : viewers) {
      if (!sees_both(p, view)) continue;
      if (lights.empty()) views.push_back({i, std::nullopt, view, 1});
      for (const Vec3& light : lights) {
        const bool dark = dot(light, p.normal_a) <= 0 && dot(light, p.normal_b) <= 0;
        if (!dark && !is_glare(light, view, p.normal_a) && !is_glare(light, view, p.normal_b))
          views.push_back({i, light, view, 1});
      }
    }
  }
  return views;
}

std::vector<std::size_t> spread_places(std::size_t count, std::size_t most) {
  constexpr double kGolden = 0.6180339887498949;
  std::vector<std::size_t> places(std::min(count, most));
  for (std::size_t i = 0; i < places.size(); ++i) {
    const double part = std::fmod(static_cast<double>(i) * kGolden, 1.0);
    places[i] = count <= most ? i : static_cast<std::size_t>(part * static_cast<double>(count));
  }
  return places;
}

PanelView panel_view(const mesh::Seam& seam, const SeamView& view) {
  const mesh::SeamPoint& p = seam.points[view.point];
  const auto aspecular = [&](const Vec3& n) { return paint::aspecular_angle_rad(*view.light, view.view, n) / kDegree; };
  const auto cosine = [&](const Vec3& n) { return std::max(0.0, dot(n, *view.light)); };
  return {aspecular(p.normal_a), cosine(p.normal_a), aspecular(p.normal_b), cosine(p.normal_b), view.weight};
}

std::vector<SeamDifference> by_place(const mesh::Seam& seam, const std::vector<SeamView>& views,
                                     const std::vector<double>& de) {
  std::vector<SeamDifference> places(seam.points.size());
  std::vector<double> weight(seam.points.size(), 0.0);
  for (std::size_t i = 0; i < views.size(); ++i) {
    SeamDifference& place = places[views[i].point];
    place.max = std::max(place.max, de[i]);
    place.rms += views[i].weight * de[i] * de[i];
    weight[views[i].point] += views[i].weight;
    ++place.views;
  }
  for (std::size_t p = 0; p < places.size(); ++p) {
    places[p].rms = std::sqrt(places[p].rms / weight[p]);  // NaN without views
    if (places[p].views == 0) places[p].max = std::numeric_limits<double>::quiet_NaN();
  }
  return places;
}

fit::PaintFitter appearance_fitter(const std::vector<double>& exponents) {
  fit::FitOptions options;
  options.method = fit::FitMethod::kL2;
  options.target = paint::TargetCurve::Kind::kCurve;
  return {formats::Basis{"appearance", exponents}, options};
}

Result<paint::LobeFit> appearance_lobes(const fit::PaintFitter& fitter, const paint::Appearance& appearance,
                                        const color::ViewingCondition& condition) {
  paint::Paint paint;
  paint.measurement = paint::Measurement{condition, "", paint::rows_of(appearance)};
  paint.appearance = appearance;
  GONIO_ASSIGN(fit::PaintFit fit, fitter.fit(paint));
  return std::move(fit.lobes);
}

Result<EnvironmentPanels> EnvironmentPanels::make(const envmap::PrefilteredEnvironment& env,
                                                  const color::ViewingCondition& condition) {
  EnvironmentPanels panels;
  panels.env_ = &env;
  for (const envmap::PrefilteredLobe& lobe : env.lobes) panels.exponents_.push_back(lobe.exponent);
  if (panels.exponents_.empty())
    return input_error("the environment has no lobes: make it by prefilter-envmap with a basis or --exponents");
  double most = 0;
  const envmap::CubeMap& diffuse = env.diffuse.map;
  for (std::size_t i = 0; i < diffuse.texels.size(); i += 3) most = std::max(most, luminance(&diffuse.texels[i]));
  if (!(most > 0)) return input_error("the environment is black: there is no white to compare with");
  panels.luminance_ = most;
  panels.condition_ = condition;
  GONIO_ASSIGN(panels.white_, color::white_point(condition));
  panels.fitter_ = std::make_shared<const fit::PaintFitter>(appearance_fitter(panels.exponents_));
  return panels;
}

// The mirrored view stands for the light's direction, as it does in the renderer: pi P_1(n) is the irradiance, and
// 2 pi/(E + 1) P_E(r) the light in a lobe of exponent E.
EnvironmentPanels::Light EnvironmentPanels::light(const Vec3& normal, const Vec3& view) const {
  const Vec3 mirrored = 2 * dot(normal, view) * normal - view;
  Light light{kPi * envmap::bilinear(env_->diffuse.map, normal), {}, std::max(0.0, dot(normal, mirrored))};
  for (const envmap::PrefilteredLobe& lobe : env_->lobes)
    light.lobes.push_back((2 * kPi / (lobe.exponent + 1)) * envmap::bilinear(lobe.map, mirrored));
  return light;
}

Result<paint::LobeFit> EnvironmentPanels::lobes(const paint::Appearance& appearance) const {
  return appearance_lobes(*fitter_, appearance, condition_);
}

color::Lab EnvironmentPanels::color(const paint::LobeFit& paint, const Light& light) const {
  color::Rgb radiance = paint.diffuse * light.diffuse;
  for (const paint::Lobe& lobe : paint.lobes) {
    const auto at = std::ranges::find(exponents_, lobe.exponent);
    if (at == exponents_.end()) continue;
    radiance +=
        light.cosine * (lobe.directional_diffuse * light.lobes[static_cast<std::size_t>(at - exponents_.begin())]);
  }
  return color::lab_from_rgb((1 / luminance_) * radiance, white_);
}

PanelColors seam_colors(const EnvironmentPanels& panels, const mesh::Seam& seam, const std::vector<SeamView>& views,
                        SeamSide side) {
  std::vector<EnvironmentPanels::Light> lights;
  for (const SeamView& view : views) {
    const mesh::SeamPoint& p = seam.points[view.point];
    lights.push_back(panels.light(side == SeamSide::kA ? p.normal_a : p.normal_b, view.view));
  }
  return [&panels, lights = std::move(lights)](const paint::Appearance& paint) -> Result<std::vector<color::Lab>> {
    GONIO_ASSIGN(const paint::LobeFit fit, panels.lobes(paint));
    std::vector<color::Lab> colors;
    for (const auto& light : lights) colors.push_back(panels.color(fit, light));
    return colors;
  };
}

}  // namespace goniochrome::panels
