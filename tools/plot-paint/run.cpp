#include "tool.h"

#include <algorithm>
#include <map>
#include <set>

#include "base/file.h"
#include "base/paths.h"
#include "base/text.h"
#include "formats/xml.h"
#include "page.h"
#include "png.h"

namespace goniochrome::tool {

namespace {

using Brdfs = std::map<std::string, std::unique_ptr<brdf::MeasuredBrdf>>;

Result<Brdfs> read_brdfs(const std::vector<std::string>& paths) {
  Brdfs brdfs;
  for (const std::string& path : paths) {
    GONIO_ASSIGN(auto brdf, brdf::read_measured(path));
    brdfs[std::filesystem::path(path).stem().string()] = std::move(brdf);
  }
  return brdfs;
}

// The paints asked for, in the order of the libraries.
Result<std::vector<paint::Paint>> chosen_paints(const Options& options) {
  std::vector<paint::Paint> chosen;
  std::vector<std::string> missing = options.names;
  for (const std::string& path : options.libraries.empty() ? std::vector<std::string>{"-"} : options.libraries) {
    GONIO_ASSIGN(std::vector<paint::Paint> paints, formats::read_paints(path));
    for (paint::Paint& paint : paints) {
      const bool named = std::ranges::find(options.names, paint.name) != options.names.end();
      if (!options.names.empty() && !named) continue;
      std::erase(missing, paint.name);
      chosen.push_back(std::move(paint));
    }
  }
  if (!missing.empty()) return input_error("there is no paint \"{}\": see the names in the library", missing.front());
  if (chosen.empty()) return input_error("there is no paint to draw");
  return chosen;
}

Result<void> write_drawing(const std::string& path, bool png, const report::Drawing& drawing) {
  const std::string document = report::svg(std::vector<report::Drawing>{drawing}, 1);
  if (!png) return write_file(path, document);
  GONIO_ASSIGN(const std::string bytes, png_of(document));
  return write_file(path, bytes);
}

// A name that a file may have, and that no earlier page has: a number follows where two names would become the same.
// Long names are cut, to leave room for the number and the ending.
std::string file_name(std::string name, std::set<std::string>& taken) {
  constexpr std::size_t kLongest = 200;
  for (char& c : name)
    if (c == '/' || static_cast<unsigned char>(c) < ' ') c = '_';
  if (name.starts_with('.')) name = "_" + name;
  if (name.size() > kLongest) name = name.substr(0, kLongest);
  std::string unique = name;
  for (int n = 2; !taken.insert(unique).second; ++n) unique = fmt::format("{}-{}", name, n);
  return unique;
}

void report(const PageInput& input, const std::string& file, cli::Session& session) {
  const paint::Paint& paint = input.paint;
  const char* target = input.brdf ? "measured BRDF" : paint.measurement || paint.appearance ? "curve" : "none";
  session.results()["paints"].push_back({{"name", paint.name},
                                         {"file", file},
                                         {"lobes", paint.lobes ? paint.lobes->lobes.size() : 0},
                                         {"target", target}});
}

}  // namespace

Result<cli::Verdict> run(const Options& options, cli::Session& session) {
  if (!options.pages.empty()) {
    if (!is_folder(options.pages)) return input_error("{}: is no folder: make it first", options.pages);
    GONIO_TRY(can_be_written(options.pages + "/page." + options.format));
  }
  GONIO_ASSIGN(const std::vector<paint::Paint> paints, chosen_paints(options));
  GONIO_ASSIGN(const Brdfs brdfs, read_brdfs(options.brdfs));
  for (const auto& [name, brdf] : brdfs)
    if (std::ranges::find(paints, name, &paint::Paint::name) == paints.end())
      session.warn(fmt::format("no paint is named \"{}\" as the measured BRDF is: it is not used", name));
  session.results()["paints"] = Json::array();

  std::vector<report::Drawing> rows;
  std::size_t unfitted = 0;
  std::set<std::string> taken;  // by pages
  for (const paint::Paint& paint : paints) {
    const auto brdf = brdfs.find(paint.name);
    const PageInput input{paint, brdf == brdfs.end() ? nullptr : brdf->second.get(), options.incidence_deg};
    unfitted += !paint.lobes;
    const bool as_page = !options.pages.empty() || paints.size() == 1;
    GONIO_ASSIGN(report::Drawing drawing, as_page ? page_of(input) : row_of_sheet(input));
    std::string file = options.output;
    if (!options.pages.empty()) {
      file = fmt::format("{}/{}.{}", options.pages, file_name(paint.name, taken), options.format);
      GONIO_TRY(write_drawing(file, options.format == "png", drawing));
    } else {
      rows.push_back(std::move(drawing));
    }
    report(input, file, session);
    session.progress(fmt::format("{}: {}", session.tool(), paint.name));
  }
  if (options.pages.empty())
    GONIO_TRY(write_drawing(options.output, lower(options.output).ends_with(".png"), report::column_of(rows)));
  session.say(
      fmt::format("{}: {} paints drawn{}", session.tool(), paints.size(),
                  unfitted > 0 ? fmt::format(", {} of them without lobes: fit-paint makes them", unfitted) : ""));
  return cli::Verdict::kDone;
}

}  // namespace goniochrome::tool
