#include <cstdlib>
#include <filesystem>

#include "base/file.h"
#include "base/paths.h"
#include "base/text.h"
#include "compressed.h"
#include "formats/default_basis.h"
#include "formats/reference.h"
#include "image/icc.h"
#include "pack.h"
#include "paint_stream.h"
#include "render/page_ground.h"
#include "render/page_stage.h"
#include "starter.h"
#include "studio/display_program.h"
#include "studio/packed_scene.h"
#include "tool.h"
#include "views.h"

namespace goniochrome::tool {

namespace {

constexpr const char* kPackages =
    "clang-19 lld-19 wasi-libc libc++-19-dev-wasm32 libc++abi-19-dev-wasm32 libclang-rt-19-dev-wasm32";

// The part of the page of that name: in $GONIOCHROME_MODULE_PATH where that is set, else in ../lib/goniochrome beside
// the program. Error: it is not there, with the remedy.
Result<std::string> page_part(const std::string& name) {
  const char* folder = std::getenv("GONIOCHROME_MODULE_PATH");
  const std::filesystem::path program = link_target("/proc/self/exe").value_or("");
  const std::string path = folder != nullptr
                               ? (std::filesystem::path(folder) / name).string()
                               : (program.parent_path().parent_path() / "lib" / "goniochrome" / name).string();
  if (is_plain_file(path)) return file_content(path);
  return input_error(
      "{}: is missing, because there was no compiler for WebAssembly when the tools were built: install {} and build "
      "them again",
      path, kPackages);
}

std::string name_of(const std::string& path) {
  std::string name = std::filesystem::path(path).filename().string();
  return plain_utf8(name.substr(0, name.find('.')));
}

// JSON stands in an element of the type application/json, which ends at the first "</". A browser reads nothing else
// in it.
std::string script_text(std::string_view json) {
  std::string text;
  text.reserve(json.size());
  for (const char c : json) {
    if (c == '<')
      text += "\\u003c";
    else
      text += c;
  }
  return text;
}

Result<PackedLibrary> packed_paints(const Options& options, cli::Session& session) {
  PackedLibrary list;
  if (options.empty && options.paints.empty()) {
    for (const paint::Paint& paint : starter_paints()) list.add("", paint);
    return Result(std::move(list));
  }
  std::size_t mapped = 0;
  for (const std::string& path : options.paints.empty() ? std::vector<std::string>{"-"} : options.paints) {
    GONIO_ASSIGN(const std::vector<paint::Paint> paints, all_paints(path, session));
    for (const paint::Paint& paint : paints) {
      if (!paint.measurement && !paint.appearance)
        return input_error("{}: the paint \"{}\" has neither readings nor a face and a flop: give it a color", path,
                           shown(paint.name));
      mapped += paint.color_map.has_value();
      list.add(plain_utf8(formats::paint_reference(path).file), paint);
    }
  }
  if (list.size() == 0) return input_error("there is no paint: a page starts from one or more");
  if (mapped > 0) session.warn(fmt::format("{} paints have a color map, which the page does not draw", mapped));
  return Result(std::move(list));
}

// Puts `text` in the place of the mark in the page.
Result<void> fill(std::string& page, const std::string& mark, const std::string& text) {
  const auto at = page.find(mark);
  if (at == std::string::npos) return Error{ErrorKind::kBug, fmt::format("studio.html lacks {}", mark)};
  page.replace(at, mark.size(), text);
  return {};
}

std::string plan_text(const Options& options) {
  return fmt::format(
      "mesh {}: positions and normals in 16 bits an axis\n"
      "environments: {}, each lobe of the basis as half floats\n"
      "traced views: {}\n"
      "approximate: light from one part to another{}\n"
      "left out: color maps\n",
      options.mesh.empty() ? "of the page itself" : options.mesh,
      options.environments.empty() ? "of the page itself" : joined(options.environments, ", "),
      options.transports.empty() ? "none"
                                 : joined(options.transports, ", ") +
                                       ", the light of each lobe at every point in as few bits as change a paint by no "
                                       "more than 0.02 dE00",
      options.transports.empty() ? "" : ", but followed by rays in the traced views");
}

}  // namespace

Result<cli::Verdict> run(const Options& options, cli::Session& session) {
  for (const auto& [name, is_missing] :
       {std::pair("mesh", options.mesh.empty()), {"env", options.environments.empty()}})
    if (is_missing && !options.empty) return usage_error("--{} FILE is missing: name one, or say --empty", name);
  GONIO_ASSIGN(std::string page, page_part("studio.html"));
  GONIO_ASSIGN(const std::string module, page_part("studio.wasm"));
  session.explain(plan_text(options));
  GONIO_ASSIGN(const formats::Basis basis, formats::basis_or_default(options.basis));
  GONIO_ASSIGN(const mesh::Mesh mesh,
               options.mesh.empty() ? Result<mesh::Mesh>(starter_mesh()) : mesh::read_mesh(options.mesh));
  for (const std::string& remark : mesh.remarks) session.warn(remark);
  GONIO_ASSIGN(const PackedLibrary paints, packed_paints(options, session));
  GONIO_ASSIGN(const std::string index, paints.index());
  studio::PackedNumbers numbers;
  const render::PagePrograms programs = render::page_programs();
  const std::string title = !options.title.empty() ? plain_utf8(options.title)
                            : options.mesh.empty() ? "Goniochrome"
                                                   : name_of(options.mesh);

  Json data = {{"version", cli::Session::version()},
               {"command", plain_utf8(session.command_line())},
               {"title", title},
               {"basis", {{"name", basis.name}, {"exponents", basis.exponents}, {"mirror", basis.mirror}}},
               {"basis_file", plain_utf8(options.basis)},
               {"mesh", studio::packed_mesh(mesh, numbers)},
               {"finishes", studio::packed_finishes(basis, numbers)},
               {"lamp", studio::packed_lamp(basis, numbers)},
               {"layers", studio::packed_layers(basis)},
               {"programs",
                {{"gbuffer_vertex", programs.gbuffer_vertex},
                 {"gbuffer_fragment", programs.gbuffer_fragment},
                 {"shading_vertex", programs.shading_vertex},
                 {"sparkle_vertex", programs.sparkle_vertex},
                 {"display_fragment", studio::display_program()},
                 {"overlay_fragment", studio::overlay_program()}}},
               {"screens",
                {{"srgb", studio::to_screen(display::Screen::kSrgb)},
                 {"display-p3", studio::to_screen(display::Screen::kDisplayP3)}}},
               {"layouts", paints.layouts()},
               {"environments", Json::array()},
               {"views", Json::array()}};
  if (!options.print_profile.empty()) {
    GONIO_ASSIGN(const std::string profile, file_content(options.print_profile));
    GONIO_ASSIGN(const color::PrintGamut print, image::print_gamut(profile, options.print_profile));
    data["print"] = {{"name", name_of(options.print_profile)},
                     {"darkest", print.darkest},
                     {"lightest", print.lightest},
                     {"chroma", print.chroma}};
  }
  Json& results = session.results();
  const auto add_light = [&](const std::string& path,
                             const Result<envmap::PrefilteredEnvironment>& env) -> Result<void> {
    if (!env.ok()) return env.error();
    const std::size_t before = numbers.bytes().size();
    auto environment = studio::packed_environment(name_of(path), *env, basis, numbers);
    if (!environment.ok()) return input_error("{}: {}", path, environment.error().message);
    if (env->mirror.map.size > 0) {
      GONIO_ASSIGN(const render::PageGroundLight ground,
                   render::page_ground_light(mesh, envmap::Environment::from_cube(env->mirror.map, path)));
      (*environment)["ground_light"] = {{"size", ground.size},
                                        {"turns", ground.turns},
                                        {"reach", ground.reach},
                                        {"steps", render::kGroundSteps},
                                        {"texels", numbers.add_smooth(ground.texels, 4)}};
    }
    results["environments"].push_back(
        {{"name", name_of(path)}, {"bytes", environment->dump().size() + numbers.bytes().size() - before}});
    data["environments"].push_back(std::move(*environment));
    return {};
  };
  for (const std::string& path : options.environments) {
    session.progress(fmt::format("packing {}", path));
    GONIO_TRY(add_light(path, envmap::read_env(path)));
  }
  if (options.environments.empty()) GONIO_TRY(add_light("studio", starter_light(basis)));

  for (const std::string& path : options.transports) {
    session.progress(fmt::format("packing {}", path));
    GONIO_ASSIGN(PackedTracedView view, packed_traced_view(path, name_of(path), mesh, basis, paints.paints(), numbers));
    session.say(fmt::format("{}: {} points, {:.1f} MB in the page; rounding changes paints by {:.3f} dE00 (p95)", path,
                            view.figures["points"].get<std::size_t>(), view.figures["page_bytes"].get<double>() / 1e6,
                            view.error_de00));
    results["transports"].push_back(std::move(view.figures));
    data["views"].push_back(std::move(view.json));
  }

  const std::string library = compressed_text(module);
  const std::size_t code = page.size() + library.size();
  GONIO_TRY(fill(page, "@TITLE@", xml_escaped(title)));
  GONIO_TRY(fill(page, "@MODULE@", library));
  GONIO_TRY(fill(page, "@INDEX@", compressed_text(index)));
  GONIO_TRY(fill(page, "@NUMBERS@", compressed_text(numbers.bytes())));
  GONIO_TRY(fill(page, "@PAINTS@", script_text(paints.lines())));
  GONIO_TRY(fill(page, "@DATA@", script_text(json_text(data))));
  GONIO_ASSIGN(OutputFile file, OutputFile::create(options.output));
  GONIO_TRY(file.write(page));
  GONIO_TRY(file.commit());
  results["bytes"] = page.size();
  results["code_bytes"] = code;
  results["paints"] = paints.size();
  results["triangles"] = mesh.triangles.size();
  session.say(fmt::format("page: {:.1f} MB, of which {:.1f} MB are data; {} paints, {} environments, {} triangles",
                          static_cast<double>(page.size()) / 1e6, static_cast<double>(page.size() - code) / 1e6,
                          paints.size(), data["environments"].size(), mesh.triangles.size()));
  return cli::Verdict::kDone;
}

}  // namespace goniochrome::tool
