#include "tool.h"

#include <algorithm>
#include <map>
#include <optional>

#include "base/file.h"
#include "base/file_names.h"
#include "base/paths.h"
#include "base/text.h"
#include "brdf/flakes.h"
#include "hud.h"
#include "image/surface_file.h"
#include "map_page.h"
#include "output_names.h"
#include "page.h"
#include "paint_stream.h"
#include "png.h"
#include "sparkle_page.h"

namespace goniochrome::tool {

namespace {

using Brdfs = std::map<std::string, std::unique_ptr<brdf::MeasuredBrdf>>;

Result<Brdfs> read_brdfs(const std::vector<std::string>& paths, cli::Session& session) {
  Brdfs brdfs;
  for (const std::string& path : paths) {
    GONIO_ASSIGN(auto brdf, brdf::read_measured(path));
    for (const std::string& doubt : brdf::checks(*brdf).warnings) session.warn(fmt::format("{}: {}", path, doubt));
    brdfs[std::filesystem::path(path).stem().string()] = std::move(brdf);
  }
  return brdfs;
}

// A paint with the folder from which its color map is named.
struct ChosenPaint {
  paint::Paint paint;
  std::filesystem::path folder;
};

// The paints asked for, in the order of the libraries.
Result<std::vector<ChosenPaint>> chosen_paints(const Options& options, cli::Session& session) {
  std::vector<ChosenPaint> chosen;
  std::vector<formats::WantedName> missing(options.names.begin(), options.names.end());
  for (const std::string& path : options.libraries.empty() ? std::vector<std::string>{"-"} : options.libraries) {
    GONIO_ASSIGN(std::vector<paint::Paint> paints, all_paints(path, session));
    const std::filesystem::path folder = std::filesystem::path(formats::paint_reference(path).file).parent_path();
    for (paint::Paint& paint : paints) {
      const bool named = std::ranges::find(options.names, paint.name) != options.names.end();
      if (named) std::erase_if(missing, [&](const formats::WantedName& wanted) { return wanted.name() == paint.name; });
      for (formats::WantedName& wanted : missing) wanted.see(paint.name);
      if (!options.names.empty() && !named) continue;
      chosen.push_back({std::move(paint), folder});
    }
  }
  if (!missing.empty()) return input_error("{}", missing.front().not_found());
  if (chosen.empty()) return input_error("there is no paint to draw");
  return Result(std::move(chosen));
}

// The drawing becomes a PNG if the name ends in .png, else an SVG.
Result<void> write_drawing(const std::string& path, const report::Drawing& drawing) {
  const std::string document = report::svg(std::vector<report::Drawing>{drawing}, 1);
  if (!lower(path).ends_with(".png")) return write_file(path, document);
  GONIO_ASSIGN(const std::string bytes, png_of(document));
  return write_file(path, bytes);
}

// The files of the pages, where every paint gets one of its own.
class PageFiles {
 public:
  // Nothing where all paints are on one sheet. Error (usage): a word in braces that there is not.
  static Result<std::optional<PageFiles>> create(const Options& options) {
    const bool is_pattern = FileNames::is_pattern(options.output);
    const std::vector<std::string> words = {"name", "code", "index"};
    GONIO_TRY(FileNames::check(options.output, words, "--output"));
    if (!options.output.ends_with(".png")) GONIO_TRY(check_output_name(options.output, "an SVG or a PNG", ".svg"));
    if (!is_pattern && options.pages.empty()) return std::optional<PageFiles>();
    if (is_pattern && !options.pages.empty())
      return usage_error("--pages and --output {} exclude each other: each names the pages", options.output);
    // Braces in the name of a folder are no words.
    const std::string folder = is_pattern ? "" : options.pages + "/";
    const std::string pattern = is_pattern ? options.output : "{name}." + options.format;
    GONIO_ASSIGN(FileNames names, FileNames::create(pattern, words, "--output"));
    return std::optional(PageFiles(folder, std::move(names)));
  }

  // Writes the page of the next paint and returns its file.
  Result<std::string> write(const paint::Paint& paint, const report::Drawing& page) {
    std::string file = folder_ + names_.next(++count_, paint.name, paint.code);
    GONIO_TRY(write_drawing(file, page));
    return Result(std::move(file));
  }

 private:
  PageFiles(std::string folder, FileNames names) : folder_(std::move(folder)), names_(std::move(names)) {}

  std::string folder_;
  FileNames names_;
  std::size_t count_ = 0;
};

// The pages of the color maps, each with its paint. A paint without one is told.
Result<std::vector<report::Drawing>> map_pages(const std::vector<ChosenPaint>& paints, const Options& options,
                                               cli::Session& session, std::vector<const paint::Paint*>& drawn) {
  std::vector<report::Drawing> pages;
  for (const ChosenPaint& chosen : paints) {
    if (!chosen.paint.color_map) {
      session.warn(fmt::format("paint \"{}\" has no color map: fit-paint --color-map makes one", chosen.paint.name));
      continue;
    }
    GONIO_ASSIGN(const brdf::ColorMap map,
                 image::read_color_map((chosen.folder / chosen.paint.color_map->href).string()));
    pages.push_back(map_page(chosen.paint.name, map, options.incidence_deg));
    drawn.push_back(&chosen.paint);
    session.results()["paints"].push_back(
        {{"name", chosen.paint.name}, {"model", map.aspecular ? "aspecular" : "isolines"}});
  }
  if (pages.empty()) return input_error("none of the paints has a color map: fit-paint --color-map makes them");
  return Result(std::move(pages));
}

// The charts of the grain, each with its paint. A paint without flakes is told.
Result<std::vector<report::Drawing>> sparkle_pages(const std::vector<ChosenPaint>& paints, cli::Session& session,
                                                   std::vector<const paint::Paint*>& drawn) {
  std::vector<report::Drawing> pages;
  for (const ChosenPaint& chosen : paints) {
    const paint::Paint& paint = chosen.paint;
    const std::optional<paint::KnownFlakes> known = paint::known_flakes(paint);
    const bool has_flakes =
        known && paint.lobes && std::ranges::any_of(brdf::flake_shares(*paint.lobes), [](double s) { return s > 0; });
    if (!has_flakes) {
      session.warn(fmt::format(
          "paint \"{}\" has no {}", paint.name,
          known && !paint.lobes ? "lobes: fit-paint makes them" : "flakes: paint-edit --flakes states them"));
      continue;
    }
    pages.push_back(sparkle_page(paint, *known));
    drawn.push_back(&paint);
    session.results()["paints"].push_back({{"name", paint.name}, {"flakes_assumed", known->assumed}});
  }
  if (pages.empty()) return input_error("none of the paints has flakes and lobes: fit-paint makes lobes");
  return Result(std::move(pages));
}

void report(const PageInput& input, const std::string& file, cli::Session& session) {
  const paint::Paint& paint = input.paint;
  const char* target = input.brdf ? "measured BRDF" : paint.measurement || paint.appearance ? "curve" : "none";
  session.results()["paints"].push_back({{"name", paint.name},
                                         {"file", file},
                                         {"lobes", paint.lobes ? paint.lobes->lobes.size() : 0},
                                         {"target", target}});
}

Result<cli::Verdict> draw_pages(const std::vector<ChosenPaint>& paints, const Options& options,
                                std::optional<PageFiles>& files, cli::Session& session) {
  std::vector<const paint::Paint*> drawn;
  GONIO_ASSIGN(const std::vector<report::Drawing> pages,
               options.sparkle ? sparkle_pages(paints, session, drawn) : map_pages(paints, options, session, drawn));
  for (std::size_t i = 0; i < pages.size() && files; ++i) {
    GONIO_ASSIGN(session.results()["paints"][i]["file"], files->write(*drawn[i], pages[i]));
  }
  if (!files) GONIO_TRY(write_drawing(options.output, report::column_of(pages)));
  session.say(fmt::format("{}: {} {} drawn", session.tool(), pages.size(), options.sparkle ? "charts" : "color maps"));
  return cli::Verdict::kDone;
}

}  // namespace

Result<cli::Verdict> run(const Options& options, cli::Session& session) {
  if (!options.pages.empty()) {
    if (!is_folder(options.pages)) return input_error("{}: is no folder: make it first", options.pages);
    GONIO_TRY(can_be_written(options.pages + "/page." + options.format));
  }
  GONIO_ASSIGN(std::optional<PageFiles> files, PageFiles::create(options));
  GONIO_ASSIGN(const std::vector<ChosenPaint> paints, chosen_paints(options, session));
  GONIO_ASSIGN(const Brdfs brdfs, read_brdfs(options.brdfs, session));
  for (const auto& [name, brdf] : brdfs)
    if (std::ranges::none_of(paints, [&](const ChosenPaint& chosen) { return chosen.paint.name == name; }))
      session.warn(fmt::format("no paint is named \"{}\" as the measured BRDF is: it is not used", name));
  session.results()["paints"] = Json::array();

  if (options.color_map + options.sparkle + !options.hud.empty() > 1)
    return usage_error("--color-map, --sparkle and --hud exclude each other: each draws a page of its own");
  if (options.color_map || options.sparkle) return draw_pages(paints, options, files, session);
  std::optional<HudView> view;
  if (!options.hud.empty()) {
    GONIO_ASSIGN(view, read_hud_view(options.hud));
  }
  std::vector<report::Drawing> rows;
  std::size_t unfitted = 0;
  for (const ChosenPaint& chosen : paints) {
    const paint::Paint& paint = chosen.paint;
    const auto brdf = brdfs.find(paint.name);
    const PageInput input{paint, brdf == brdfs.end() ? nullptr : brdf->second.get(), options.incidence_deg};
    unfitted += !paint.lobes;
    const bool as_page = files || paints.size() == 1;
    GONIO_ASSIGN(report::Drawing drawing, view      ? hud_drawing(paint, *view)
                                          : as_page ? page_of(input)
                                                    : row_of_sheet(input));
    std::string file = options.output;
    if (files) {
      GONIO_ASSIGN(file, files->write(paint, drawing));
    } else {
      rows.push_back(std::move(drawing));
    }
    report(input, file, session);
    session.progress(fmt::format("{}: {}", session.tool(), paint.name));
  }
  if (!files) GONIO_TRY(write_drawing(options.output, report::column_of(rows)));
  session.say(
      fmt::format("{}: {} paints drawn{}", session.tool(), paints.size(),
                  unfitted > 0 ? fmt::format(", {} of them without lobes: fit-paint makes them", unfitted) : ""));
  return cli::Verdict::kDone;
}

}  // namespace goniochrome::tool
