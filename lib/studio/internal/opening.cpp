#include "studio/internal/opening.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <utility>

#include "base/text.h"
#include "envmap/remarks.h"
#include "formats/paint_source.h"
#include "mesh/mesh.h"
#include "prefilter/prefilter.h"
#include "studio/packed_scene.h"
#include "studio/paint_json.h"

namespace goniochrome::studio {

namespace {

// A step of an 8-bit screen is 8e-3 of a middle gray.
constexpr double kTolerance = 5e-3;

bool is_mesh(const std::string& path) {
  constexpr std::array kEndings = {".obj",  ".gltf", ".glb",  ".off",  ".ply", ".stl",  ".usd",
                                   ".usda", ".usdc", ".usdz", ".step", ".stp", ".iges", ".igs"};
  const std::string ending = goniochrome::lower(std::filesystem::path(path).extension().string());
  return std::ranges::find(kEndings, ending) != kEndings.end();
}

bool is_light(std::string_view head) {
  return head.starts_with("#?") || head.starts_with("\x76\x2f\x31\x01");
}

Result<Json> opened_mesh(const std::string& path, PackedNumbers& numbers) {
  GONIO_ASSIGN(const mesh::Mesh mesh, mesh::read_mesh(path));
  return Json{{"kind", "mesh"},
              {"mesh", packed_mesh(mesh, numbers)},
              {"triangles", mesh.triangles.size()},
              {"remarks", mesh.remarks}};
}

Result<Json> opened_basis(const std::string& path) {
  GONIO_ASSIGN(const formats::Basis basis, formats::read_basis(path));
  return Json{{"kind", "basis"},
              {"basis", {{"name", basis.name}, {"exponents", basis.exponents}, {"mirror", basis.mirror}}}};
}

// Paints that cannot be read are left out, unless none can.
Result<Json> opened_paints(InputFile input) {
  const std::string name = input.name();
  formats::ImportOptions options;
  options.keep_going = true;
  GONIO_ASSIGN(const formats::PaintSourcePointer source, formats::open_paints(std::move(input), std::nullopt, options));
  std::vector<std::string> remarks;
  Json list = Json::array();
  for (std::size_t errors = 0; errors < 100;) {
    auto paint = source->next();
    if (!paint.ok()) {
      remarks.push_back(paint.error().message);
      ++errors;
    } else if (!*paint) {
      break;
    } else if ((*paint)->measurement || (*paint)->appearance) {
      list.push_back(paint_json(**paint));
    } else {
      remarks.push_back(fmt::format("{}: the paint \"{}\" has neither readings nor a face and a flop: give it a color",
                                    source->place(), shown((*paint)->name)));
    }
  }
  for (const auto& lines : {source->warnings(), source->closing_warnings()})
    remarks.insert(remarks.end(), lines.begin(), lines.end());
  if (list.empty()) return input_error("{}", remarks.empty() ? name + ": has no paint" : remarks.front());
  return Json{{"kind", "paints"}, {"list", std::move(list)}, {"format", source->format()}, {"remarks", remarks}};
}

}  // namespace

Result<Json> opened(const std::string& path, PackedNumbers& numbers) {
  if (is_mesh(path)) return opened_mesh(path, numbers);
  GONIO_ASSIGN(InputFile input, InputFile::open(path));
  GONIO_ASSIGN(const std::string head, formats::head_of(input));
  if (is_light(head)) return Json{{"kind", "light"}};
  if (head.find("urn:goniochrome:basis:1") != std::string::npos) return opened_basis(path);
  return opened_paints(std::move(input));
}

Result<Json> filtered_light(const std::string& path, const formats::Basis& basis, PackedNumbers& numbers,
                            const std::function<void(double)>& progress) {
  GONIO_ASSIGN(const envmap::Environment env, envmap::Environment::read(path, envmap::Environment::BadPixels::kZero));
  prefilter::PrefilterRequest request;
  request.exponents = prefilter::filter_exponents(basis.exponents);
  request.mirror = basis.mirror;
  request.tolerance = kTolerance;
  const std::vector<prefilter::LobePlan> plan = prefilter::prefilter_plan(env, request);
  double done_s = 0, all_s = 0;
  for (const prefilter::LobePlan& lobe : plan) all_s += lobe.predicted_time_s;
  std::size_t next = 0;
  const envmap::PrefilteredEnvironment filtered =
      prefilter::prefiltered(env, request, plan, [&](const envmap::PrefilteredLobe&, double) {
        done_s += plan[next++].predicted_time_s;
        progress(done_s / all_s);
      });
  const std::string name = std::filesystem::path(path).stem().string();
  GONIO_ASSIGN(Json environment, packed_environment(plain_utf8(name), filtered, basis, numbers));
  return Json{{"environment", std::move(environment)}, {"remarks", envmap::remarks(env)}};
}

}  // namespace goniochrome::studio
