#include "views.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/angles.h"
#include "base/text.h"
#include "brdf/lobe_model.h"
#include "compressed.h"
#include "fit/paint_fit.h"
#include "image/aov_file.h"
#include "rays/ray_scene.h"
#include "render/aov.h"
#include "render/light_transport.h"
#include "render/trim.h"
#include "studio/packed_numbers.h"

namespace goniochrome::tool {

namespace {

// A view shows the mesh where it sees the same part under the same normal, but for a few points on edges.
constexpr double kSameNormal = 0.999, kMostOther = 0.01;

constexpr std::size_t kMostJudges = 4;  // paints that packing is judged by

std::string listed(const std::vector<double>& exponents) {
  if (exponents.empty()) return "no lobes";
  return joined(exponents, ", ", [](double exponent) { return fmt::format("{:.6g}", exponent); });
}

Result<void> check_basis(const std::string& path, const render::LobeColumns& columns, const formats::Basis& basis) {
  constexpr double kSame = 1e-6;  // environments hold exponents as floats
  const auto known = [&](double exponent) {
    return std::ranges::any_of(columns.exponents,
                               [&](double other) { return std::abs(other - exponent) <= kSame * exponent; });
  };
  if (std::ranges::all_of(basis.exponents, known)) return {};
  return input_error(
      "{}: holds the light of lobes of the exponents {}, and the basis {} has {}: trace it again in an environment of "
      "this basis",
      path, listed(columns.exponents), basis.name, listed(basis.exponents));
}

// Checks that the file shows this mesh: its parts, and the surfaces that the rays through its pixels meet.
Result<void> check_mesh(const image::AovFile& file, const render::LobeTransport& light, const render::Gbuffer& seen,
                        const mesh::Mesh& mesh) {
  const std::size_t parts = light.worn.brushed.size();
  if (parts != mesh.parts.size() || parts > file.parts.size())
    return input_error("{}: shows another mesh: it has {} parts, and the mesh has {}", file.path, parts,
                       mesh.parts.size());
  for (std::size_t i = 0; i < parts; ++i)
    if (file.parts[i] != mesh.parts[i].name)
      return input_error("{}: shows another mesh: its part {} is \"{}\", and that of the mesh is \"{}\"", file.path,
                         i + 1, shown(file.parts[i]), shown(mesh.parts[i].name));
  GONIO_ASSIGN(const rays::RayScene scene, rays::RayScene::create(mesh));
  const render::Rays rays{file.corner, file.right, file.down, *file.eye};
  const render::Gbuffer again = render::visible_surface(scene, rays, seen.width, seen.height);
  std::size_t points = 0, others = 0;
  for (int y = 0; y < seen.height; ++y) {
    for (int x = 0; x < seen.width; ++x) {
      const int part = seen.part(x, y), other = again.part(x, y);
      const bool is_mesh = part >= 0 && part < static_cast<int>(parts);
      if (!is_mesh && (other < 0 || part >= 0)) continue;  // a floor may hide the mesh
      ++points;
      others += part != other || dot(seen.normal(x, y), again.normal(x, y)) < kSameNormal ? 1 : 0;
    }
  }
  if (static_cast<double>(others) > kMostOther * static_cast<double>(points))
    return input_error("{}: shows another mesh: {} of its {} points are not on this one", file.path, others, points);
  return {};
}

// Paints of the page, spread over its library, on the parts that wear the design.
Result<std::vector<render::ShownPaints>> judges(const render::LobeTransport& light, const mesh::Mesh& mesh,
                                                const formats::Basis& basis, bool with_mirrors,
                                                const std::vector<paint::Paint>& paints) {
  const fit::PaintFitter fitter(basis, {});
  std::vector<render::ShownPaints> all;
  const std::size_t step = 1 + (paints.size() - 1) / kMostJudges;
  for (std::size_t i = 0; i < paints.size(); i += step) {
    const auto fit = fitter.fit(paints[i]);
    if (!fit.ok()) continue;  // the page says what is wrong with it
    std::vector<std::optional<paint::LobeFit>> finishes;
    for (const mesh::MeshPart& part : mesh.parts) finishes.push_back(render::trim_of(part, with_mirrors));
    std::vector<render::PartPaint> parts;
    for (std::size_t part = 0; part < finishes.size(); ++part)
      parts.push_back({finishes[part] ? &*finishes[part] : &fit->lobes, light.worn.brushed[part],
                       brdf::kGlossIncidence_deg, paints[i].name, mesh.parts[part].name});
    GONIO_ASSIGN(render::ShownPaints shown, render::shown_paints(light.columns, light.worn, parts));
    all.push_back(std::move(shown));
  }
  return Result(std::move(all));
}

// The background of the picture; nothing where there is none.
image::Image beside_of(const image::AovFile& file) {
  const image::Image& picture = file.image;
  const auto gain = static_cast<float>(std::exp2(-file.exposure_stops));
  image::Image beside{picture.width, picture.height, 4, {}, {}};
  bool any = false;
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      const float* pixel = picture.pixel(x, y);  // R G B A normal part
      const bool is_beside = pixel[7] == 0 && pixel[3] > 0;
      any = any || is_beside;
      for (int c = 0; c < 4; ++c) beside.data.push_back(is_beside ? (c < 3 ? gain : 1) * std::max(0.0F, pixel[c]) : 0);
    }
  }
  return any ? beside : image::Image{};
}

}  // namespace

Result<PackedTracedView> packed_traced_view(const std::string& path, const std::string& name, const mesh::Mesh& mesh,
                                            const formats::Basis& basis, const std::vector<paint::Paint>& paints,
                                            studio::PackedNumbers& numbers) {
  GONIO_ASSIGN(const image::AovFile file,
               image::read_aov_file(path, {"R", "G", "B", "A", "normal.X", "normal.Y", "normal.Z", "part"}));
  GONIO_ASSIGN(const auto read, render::transport_of(file));
  if (!read) return input_error("{}: holds no light of lobes: render it with --aov transport", path);
  const render::LobeTransport& light = *read;
  GONIO_ASSIGN(const render::Gbuffer seen, render::gbuffer_of(file));
  if (!file.eye) return input_error("{}: does not tell where its camera stands: render it again", path);
  GONIO_TRY(check_basis(path, light.columns, basis));
  GONIO_TRY(check_mesh(file, light, seen, mesh));
  const bool with_mirrors = !file.environment.empty();  // as render-osmesa dresses parts that nobody paints
  const std::vector<float> angles = render::view_angles_deg(light, {&seen});
  const auto packed = render::packed_view(light, angles, beside_of(file));
  if (!packed.ok()) return input_error("{}: {}", path, packed.error().message);
  GONIO_ASSIGN(const render::UnpackedView unpacked, render::unpacked_view(*packed));
  GONIO_ASSIGN(const std::vector<render::ShownPaints> shown, judges(light, mesh, basis, with_mirrors, paints));
  const render::PackingError error =
      render::packing_error(light, angles, unpacked, shown, render::operator_or_null(file.reflection));
  Json reflection = Json::array();
  for (const auto& matrix : file.reflection.k)
    for (const auto& row : matrix)
      for (const double value : row) reflection.push_back(value);
  Json parts = Json::array();
  for (const mesh::MeshPart& part : mesh.parts)
    parts.push_back({{"name", plain_utf8(part.name)}, {"material", plain_utf8(part.material)}});
  const Vec3 middle = file.corner + 0.5 * light.width * file.right + 0.5 * light.height * file.down;
  const double fov_deg = 2 * std::atan2(0.5 * light.height * length(file.down), length(middle)) / kDegree;
  const std::vector<std::uint8_t> bytes(packed->begin(), packed->end());
  PackedTracedView view;
  view.error_de00 = error.p95_de00;
  view.json = {
      {"name", name},
      {"width", light.width},
      {"height", light.height},
      {"white", std::exp2(-file.automatic_stops)},
      {"camera", {{"eye", *file.eye}, {"target", *file.eye + middle}, {"fov", fov_deg}}},
      {"brightest", {{"direction", file.light}, {"extent", file.lights.empty() ? 0 : file.lights.front().extent_deg}}},
      {"floor", light.worn.has_floor},
      {"mirrors", with_mirrors},
      {"operator", std::move(reflection)},
      {"parts", std::move(parts)},
      {"light", numbers.add(bytes)}};
  view.figures = {{"name", name},
                  {"points", light.places.size()},
                  {"columns", light.columns.count()},
                  {"bytes", bytes.size()},
                  {"page_bytes", compressed_text(*packed).size()},
                  {"rounding_de00_mean", json_number(error.mean_de00)},
                  {"rounding_de00_p95", json_number(error.p95_de00)}};
  return Result(std::move(view));
}

}  // namespace goniochrome::tool
