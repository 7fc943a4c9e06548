#include "tool.h"

#include <cmath>
#include <filesystem>
#include <map>

#include "base/paths.h"
#include "base/text.h"
#include "image/aov_file.h"
#include "page.h"
#include "paint_drawing.h"
#include "paint_stream.h"
#include "probe.h"
#include "sketch/pick.h"
#include "sketch/traced_light.h"
#include "studio_session.h"

namespace goniochrome::tool {

namespace {

constexpr const char* kSessionEnding = ".session.json";

// Reads every picture once, whatever the number of droppers on it.
class Shelf {
 public:
  Result<const image::ImagePart*> image(const std::string& path) {
    const auto found = images_.find(path);
    if (found != images_.end()) return &found->second;
    GONIO_ASSIGN(images_[path], image::read_image(path, image::Inks::kKept));
    return &images_[path];
  }

 private:
  std::map<std::string, image::ImagePart> images_;
};

void tell_sample(const std::string& kind, const std::string& paint, const sketch::PickSample& s,
                 cli::Session& session) {
  session.results()["samples"].push_back({{"dropper", kind},
                                          {"paint", paint},
                                          {"image", s.path},
                                          {"x", s.dropper.x},
                                          {"y", s.dropper.y},
                                          {"radius", s.dropper.radius},
                                          {"pixels", s.pixels},
                                          {"clipped", s.clipped},
                                          {"lab", lab_json(s.lab)},
                                          {"lit", s.lit},
                                          {"gloss_gu", s.gloss}});
  for (const std::string& warning : s.warnings) session.warn(warning);
  if (kind != "gloss" && 2 * s.clipped > s.pixels)
    session.warn(
        fmt::format("{} of {}: {} of {} pixels are as bright as the picture can show: the color is darker than "
                    "what was photographed",
                    kind, paint, s.clipped, s.pixels));
}

void tell_paint(const sketch::PickedPaint& picked, cli::Session& session) {
  const paint::Paint& paint = picked.paint;
  const paint::Appearance& a = *paint.appearance;
  session.results()["paints"].push_back(
      {{"name", paint.name},
       {"face", lab_json(a.face)},
       {"flop", lab_json(a.flop)},
       {"travel_deg", a.travel_deg},
       {"gloss_60_gu", paint.gloss.empty() ? Json(nullptr) : Json(paint.gloss.front().gloss_units)},
       {"swapped", picked.swapped}});
  if (picked.swapped)
    session.say(fmt::format("{}: face and flop traded places, for the flop was the lighter one: --retro keeps them",
                            paint.name));
  const std::string gloss =
      paint.gloss.empty() ? "" : fmt::format(", gloss {:.0f} GU", paint.gloss.front().gloss_units);
  session.say(fmt::format("{}: face {:.1f} {:.1f} {:.1f}, flop {:.1f} {:.1f} {:.1f}, travel {}{}", paint.name, a.face.L,
                          a.face.a, a.face.b, a.flop.L, a.flop.a, a.flop.b, shortest(a.travel_deg), gloss));
}

// A dropper takes what shadows and bounced light do to a surface for its paint, unless the light is known.
void tell_rays(const std::string& path, const image::ImagePart& image, cli::Session& session) {
  if (image::is_drawn(image, "sparkle"))
    session.warn(fmt::format("{} shows single flakes, and a paint is their mean: render it with --effects auto,-sparkle",
                             path));
  if (const std::string rays = image::drawn_by_rays(image); !rays.empty())
    session.warn(
        fmt::format("{} shows {}, which a dropper takes for the color of the paint: give --buffers, made by "
                    "render-osmesa --aov transport",
                    path, rays));
}

// Puts a paint's droppers on their pictures; path_of() tells the path of a dropper's image. `light` may be null.
template <class PathOf>
Result<PageOfPaint> picked(const sketch::PaintPick& wanted, Shelf& shelf, PathOf&& path_of,
                           const sketch::PickLight* light, cli::Session& session) {
  PageOfPaint page;
  std::optional<color::Lab> face, flop;
  std::optional<double> gloss;
  const auto take = [&](const char* kind, const std::optional<sketch::Dropper>& dropper) -> Result<void> {
    if (!dropper) return {};
    const std::string path = path_of(dropper->image);
    GONIO_ASSIGN(const image::ImagePart* image, shelf.image(path));
    GONIO_ASSIGN(sketch::PickSample sample, sketch::pick(*image, path, *dropper, light));
    if (light == nullptr) tell_rays(path, *image, session);
    tell_sample(kind, wanted.name, sample, session);
    page.samples.emplace_back(kind, std::move(sample));
    return {};
  };
  GONIO_TRY(take("face", wanted.face));
  if (wanted.face) face = page.samples.back().second.lab;
  GONIO_TRY(take("flop", wanted.flop));
  if (wanted.flop) flop = page.samples.back().second.lab;
  GONIO_TRY(take("gloss", wanted.gloss));
  if (wanted.gloss) gloss = page.samples.back().second.gloss;
  page.picked = sketch::picked_paint(wanted, face, flop, gloss);
  tell_paint(page.picked, session);
  return page;
}

Result<void> write(const std::string& path, const std::vector<PageOfPaint>& pages, const cli::Session& session) {
  std::vector<paint::Paint> paints;
  for (const PageOfPaint& page : pages) paints.push_back(page.picked.paint);
  return write_paints(path, paints, session);
}

StudioLink studio_link(const Options& options) {
  if (options.studio.empty()) return {};
  const std::string folder = std::filesystem::path(options.output).parent_path().string();
  return {relative_path(options.studio, folder.empty() ? "." : folder), options.board};
}

Result<std::vector<PageImage>> pictures_of(const sketch::Board& board, Shelf& shelf) {
  std::vector<PageImage> images;
  for (const sketch::BoardImage& image : board.images) {
    GONIO_ASSIGN(const image::ImagePart* content, shelf.image(image.path));
    images.push_back({image, *content});
  }
  return images;
}

Result<cli::Verdict> run_board(const Options& options, bool as_page, cli::Session& session) {
  GONIO_ASSIGN(const sketch::Board board, sketch::read_board(options.board));
  Shelf shelf;
  const auto path_of = [&](const std::string& name) {
    for (const sketch::BoardImage& image : board.images)
      if (image.name == name) return image.path;
    return name;
  };
  std::vector<PageOfPaint> paints;
  for (const sketch::PaintPick& wanted : board.paints) {
    GONIO_ASSIGN(PageOfPaint paint, picked(wanted, shelf, path_of, nullptr, session));
    paints.push_back(std::move(paint));
  }
  if (options.output.ends_with(kSessionEnding)) {
    GONIO_ASSIGN(const std::vector<PageImage> images, pictures_of(board, shelf));
    GONIO_ASSIGN(const std::string kept, studio_session(board, images, paints));
    GONIO_TRY(write_file(options.output, kept));
    return cli::Verdict::kDone;
  }
  if (!as_page) {
    GONIO_TRY(write(options.output, paints, session));
    return cli::Verdict::kDone;
  }
  GONIO_ASSIGN(PaintDrawing drawing, PaintDrawing::make({options.mesh, options.env, options.basis}));
  for (const std::string& remark : drawing.remarks()) session.warn(remark);
  for (PageOfPaint& paint : paints) {
    GONIO_ASSIGN(paint.picture, drawing.png(paint.picked.paint));
  }
  GONIO_ASSIGN(const std::vector<PageImage> images, pictures_of(board, shelf));
  GONIO_ASSIGN(const std::string page, board_page(board, images, paints, drawing.described(), studio_link(options)));
  GONIO_TRY(write_file(options.output, page));
  return cli::Verdict::kDone;
}

Result<cli::Verdict> run_palette(const Options& options, cli::Session& session) {
  GONIO_ASSIGN(const image::ImagePart image, image::read_image(options.images.front(), image::Inks::kKept));
  GONIO_ASSIGN(const auto pairs, sketch::palette(image, options.images.front(), options.palette));
  std::vector<PageOfPaint> paints;
  for (const sketch::PalettePair& pair : pairs) {
    sketch::PaintPick wanted;
    wanted.name = fmt::format("{}_{}", options.name, paints.size() + 1);
    wanted.travel_deg = options.travel_deg;
    paints.push_back({sketch::picked_paint(wanted, pair.face, pair.flop, std::nullopt), {}, {}});
    tell_paint(paints.back().picked, session);
    session.results()["paints"].back()["share"] = pair.share;
  }
  if (static_cast<int>(pairs.size()) < options.palette)
    session.say(fmt::format("{}: {} of {} paints: the picture has no more colors", options.images.front(), pairs.size(),
                            options.palette));
  GONIO_TRY(write(options.output, paints, session));
  return cli::Verdict::kDone;
}

Result<cli::Verdict> run_droppers(const Options& options, cli::Session& session) {
  sketch::PaintPick wanted;
  wanted.name = options.name, wanted.travel_deg = options.travel_deg, wanted.retro = options.retro;
  const auto parse = [&](const char* option, const std::string& text,
                         std::optional<sketch::Dropper>& to) -> Result<void> {
    if (text.empty()) return {};
    GONIO_ASSIGN(to, sketch::parse_dropper(text, option));
    return {};
  };
  GONIO_TRY(parse("--face", options.face, wanted.face));
  GONIO_TRY(parse("--flop", options.flop, wanted.flop));
  GONIO_TRY(parse("--gloss", options.gloss, wanted.gloss));
  Shelf shelf;
  std::optional<sketch::TracedLight> traced;
  sketch::PickLight light;
  if (!options.buffers.empty()) {
    GONIO_ASSIGN(const image::AovFile buffers, image::read_aov_file(options.buffers));
    GONIO_ASSIGN(traced, sketch::TracedLight::of(buffers));
    light = {&*traced, std::exp2(-buffers.exposure_stops), std::exp2(-buffers.automatic_stops)};
  }
  const auto as_named = [](const std::string& path) { return path; };
  GONIO_ASSIGN(PageOfPaint paint, picked(wanted, shelf, as_named, traced ? &light : nullptr, session));
  GONIO_TRY(write(options.output, {std::move(paint)}, session));
  return cli::Verdict::kDone;
}

}  // namespace

Result<cli::Verdict> run(const Options& options, cli::Session& session) {
  const bool droppers = !options.face.empty() || !options.flop.empty() || !options.gloss.empty();
  const bool as_page = options.output.ends_with(".html");
  const int ways = droppers + (options.palette > 0) + !options.board.empty() + !options.probes.empty();
  if (ways == 0)
    return usage_error(
        "there is nothing to pick: give --face and --flop, --palette N with a picture, --board, or --probe X,Y");
  if (ways > 1) return usage_error("droppers, --palette, --board and --probe exclude each other");
  if ((as_page || options.output.ends_with(kSessionEnding)) && options.board.empty())
    return usage_error("--output is \"{}\": a {} shows a --board", options.output, as_page ? "page" : "session");
  if (!as_page && !(options.mesh.empty() && options.env.empty() && options.basis.empty() && options.studio.empty()))
    return usage_error("--mesh, --env, --basis and --studio are for the page of a board: give -o NAME.html");
  if (!options.basis.empty() && !options.env.empty())
    return usage_error("--basis is for lamps: an environment brings its own");
  if (!options.probes.empty()) return run_probe(options, session);
  if (options.palette == 0 && !options.images.empty())
    return usage_error("the picture {} is given and no --palette: name it in a dropper", options.images.front());
  if (!droppers && !options.buffers.empty()) return usage_error("--buffers is for droppers: give --face or --flop");
  if (droppers && options.face.empty() && options.flop.empty())
    return usage_error("--gloss alone makes no paint: give --face or --flop");
  session.results()["samples"] = Json::array();
  session.results()["paints"] = Json::array();
  if (!options.board.empty()) return run_board(options, as_page, session);
  if (droppers) return run_droppers(options, session);
  if (options.images.empty()) return usage_error("--palette takes a picture: name one");
  return run_palette(options, session);
}

}  // namespace goniochrome::tool
