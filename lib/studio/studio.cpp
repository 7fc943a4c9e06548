#include "studio/studio.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "brdf/highlight.h"
#include "fit/paint_fit.h"
#include "library/search.h"
#include "library/verdict.h"
#include "paint/curve.h"
#include "render/page_stage.h"
#include "render/scene_effects.h"
#include "sketch/dropper.h"
#include "studio/internal/describe.h"
#include "studio/internal/edit_json.h"
#include "studio/internal/handoff.h"
#include "studio/internal/json_reader.h"
#include "studio/internal/library_pane.h"
#include "studio/internal/opening.h"
#include "studio/internal/view_pane.h"
#include "studio/paint_json.h"

namespace goniochrome::studio {

render::Effects page_effects(const std::vector<double>& exponents, bool mirror, std::size_t spots) {
  render::Effects effects;
  effects.environment = true;
  for (const double exponent : exponents) effects.lobes.push_back({exponent, true, true});
  effects.mirror = mirror;
  effects.fresnel = effects.coat = effects.views = effects.reflection = true;
  effects.horizon = !exponents.empty();
  effects.spots = effects.horizon ? spots : 0;
  effects.background = mirror ? render::Background::kEnvironment : render::Background::kNone;
  return effects;
}

color::ReflectionOperator page_operator() {
  return color::fitted_operator();
}

struct Studio::State {
  std::optional<fit::PaintFitter> fitter;
  render::Effects effects;
  std::optional<library::LibraryIndex> index;
  std::optional<library::LibrarySearch> by_de76, by_de00;
  std::optional<LibraryPane> pane;
  std::optional<color::PrintGamut> print;
  std::vector<float> weights, tilts, flakes;
  std::map<int, ViewPane> views;
  const ViewPane* shown_view = nullptr;
  std::string attached;
  PackedNumbers numbers;
  std::function<void(double)> progress = [](double) {};

  Result<Json> load(JsonReader& request);
  Result<Json> edit(JsonReader& request) const;
  Result<Json> fit(JsonReader& request);
  Result<Json> flakes_of(JsonReader& request);
  Result<Json> describe(JsonReader& request) const;
  Result<Json> variations(JsonReader& request) const;
  Result<Json> nearest(JsonReader& request) const;
  Result<Json> write(JsonReader& request) const;
  Result<Json> color(JsonReader& request) const;
  Result<Json> at(JsonReader& request) const;
  Result<Json> gloss(JsonReader& request) const;
  Result<Json> dropper(JsonReader& request) const;
  Result<Json> gradient(JsonReader& request) const;
  Result<Json> view(JsonReader& request);
  Result<Json> show(JsonReader& request);
  Result<Json> open(JsonReader& request);
  Result<Json> light(JsonReader& request);
  Result<Json> answer(const Json& request);
  Result<paint::Paint> fitted(const paint::Paint& paint) const;
};

namespace {

Json edited_json(const paint::Edited& edited) {
  return {{"paint", paint_json(edited.paint)},
          {"dropped", edited.dropped},
          {"clipped", edited.clipped},
          {"skipped", edited.skipped}};
}

// Without a reading of gloss it is the angle at which render-osmesa takes gloss to hold.
double gloss_angle_deg(const paint::Paint& paint) {
  return paint.gloss.empty() ? brdf::kGlossIncidence_deg : paint.gloss.front().angle_deg;
}

Json lobes_json(const paint::LobeFit& fit) {
  Json json = {{"coat", fit.coat_index}, {"diffuse", fit.diffuse}, {"lobes", Json::array()}};
  for (const paint::Lobe& lobe : fit.lobes) {
    json["lobes"].push_back({{"exponent", lobe.is_mirror() ? Json("mirror") : Json(lobe.exponent)},
                             {"flake", lobe.directional_diffuse},
                             {"gloss", lobe.gloss}});
  }
  return json;
}

Result<formats::Basis> basis_of(JsonReader& request) {
  JsonReader of(request.member("basis"));
  formats::Basis basis{of.text("name"), of.numbers("exponents"), of.flag("mirror"), {}};
  GONIO_TRY(of.status());
  return Result(std::move(basis));
}

}  // namespace

Result<Json> Studio::State::load(JsonReader& request) {
  GONIO_ASSIGN(formats::Basis basis, basis_of(request));
  effects = page_effects(basis.exponents, basis.mirror, 0);
  fitter.emplace(std::move(basis), fit::FitOptions{});
  by_de76.reset(), by_de00.reset(), pane.reset(), print.reset();
  if (request.has("print")) {
    JsonReader of(request.member("print"));
    constexpr std::size_t kCount = std::size_t{1} * color::PrintGamut::kLightnesses * color::PrintGamut::kHues;
    print = {of.text("name"), of.number("darkest"), of.number("lightest"), of.numbers("chroma", kCount)};
    GONIO_TRY(of.status());
  }
  if (request.flag("attached")) {
    GONIO_ASSIGN(index, library::LibraryIndex::from_bytes(std::exchange(attached, {})));
  } else {
    const Json& list = request.list("paints");
    auto next = list.begin();
    GONIO_ASSIGN(index, library::LibraryIndex::from_paints([&]() -> Result<std::optional<paint::Paint>> {
                   if (next == list.end()) return std::optional<paint::Paint>();
                   GONIO_ASSIGN(paint::Paint paint, paint_of_json(*next++));
                   return std::optional(std::move(paint));
                 }));
  }
  by_de76.emplace(*index, library::LibrarySearchOptions{});
  by_de00.emplace(*index, library::LibrarySearchOptions{.metric = library::kDe00});
  pane.emplace(*index);
  return Json{{"paints", index->size()}, {"geometries", pane->geometries()}};
}

Result<Json> Studio::State::edit(JsonReader& request) const {
  GONIO_ASSIGN(const paint::Paint paint, paint_of_json(request.member("paint")));
  GONIO_ASSIGN(const paint::Edit edit, edit_of_json(request.member("edit")));
  GONIO_ASSIGN(const paint::Edited edited, paint::edited(paint, edit));
  return edited_json(edited);
}

// The paint as fit-paint writes it.
Result<paint::Paint> Studio::State::fitted(const paint::Paint& paint) const {
  if (!fitter) return input_error("\"load\" must come first");
  GONIO_ASSIGN(fit::PaintFit fit, fitter->fit(paint));
  paint::Paint result = paint;
  if (fit.lobes.coat_index != paint::kNoCoat) result.coat_index = fit.lobes.coat_index;
  result.lobes = std::move(fit.lobes);
  return Result(std::move(result));
}

Result<Json> Studio::State::fit(JsonReader& request) {
  if (!fitter) return input_error("\"load\" must come first");
  GONIO_ASSIGN(const paint::Paint paint, paint_of_json(request.member("paint")));
  GONIO_ASSIGN(const fit::PaintFit fit, fitter->fit(paint));
  render::Scene scene;
  scene.paints = {fit.lobes};
  scene.gloss_deg = {gloss_angle_deg(paint)};
  scene.reflection = page_operator();
  weights = render::weight_table(scene, effects).rgba;
  tilts.clear();
  if (paint.anisotropy) {
    scene.anisotropy = {*paint.anisotropy};
    tilts = render::tilt_texels(render::tilts_of(scene, effects));
  }
  Json answer = lobes_json(fit.lobes);
  answer["status"] = fit::fit_status_name(fit.report.status);
  answer["de00_max"] = json_number(fit.report.de00_max);
  answer["de00_mean"] = json_number(fit.report.de00_mean);
  answer["gamut_de00"] = json_number(fit.report.gamut_de00);
  answer["limit"] = fit.report.limit;
  answer["time_us"] = json_number(fit.report.time_us);
  answer["seen"] = curve_json(fit.lobes, paint::condition_of(paint));
  if (const double extent_deg = request.number("extent", 0); extent_deg > 0)
    answer["highlight"] = json_number(brdf::highlight_edge_deg(fit.lobes, extent_deg));
  return answer;
}

Result<Json> Studio::State::flakes_of(JsonReader& request) {
  if (!fitter) return input_error("\"load\" must come first");
  GONIO_ASSIGN(const paint::Paint paint, paint_of_json(request.member("paint")));
  const std::vector<double> lamps = request.numbers("lamps");
  GONIO_TRY(request.status());
  flakes.clear();
  if (!paint.flakes) return Json{{"per_m2", 0}, {"most", Json::array()}};
  GONIO_ASSIGN(const fit::PaintFit fit, fitter->fit(paint));
  render::PageFlakes page = render::page_flakes(fit.lobes, *paint.flakes, lamps);
  flakes = std::move(page.texels);
  return Json{{"per_m2", page.per_m2}, {"most", page.most}};
}

Result<Json> Studio::State::describe(JsonReader& request) const {
  GONIO_ASSIGN(const paint::Paint paint, paint_of_json(request.member("paint")));
  const display::Screen screen = screen_of(request);
  GONIO_TRY(request.status());
  return description(paint, screen, print ? &*print : nullptr);
}

Result<Json> Studio::State::variations(JsonReader& request) const {
  GONIO_ASSIGN(const paint::Paint paint, paint_of_json(request.member("paint")));
  const std::string of = request.text("of");
  static const std::map<std::string, paint::Variation, std::less<>> kKinds = {{"face", paint::Variation::kFace},
                                                                              {"flop", paint::Variation::kFlop},
                                                                              {"travel", paint::Variation::kTravel},
                                                                              {"gloss", paint::Variation::kGloss}};
  const auto kind = kKinds.find(of);
  if (kind == kKinds.end()) request.fail("face, flop, travel or gloss", "of");
  const double step = request.number("step", 5);
  if (!(step > 0)) request.fail("a number above 0", "step");
  GONIO_TRY(request.status());
  Json list = Json::array();
  for (const paint::Neighbor& neighbor : paint::neighbors(kind->second, step)) {
    GONIO_ASSIGN(const paint::Edited edited, paint::edited(paint, neighbor.edit));
    if (!edited.skipped.empty() || !paint::is_distinct(edited, paint)) continue;
    list.push_back(
        {{"name", neighbor.name}, {"edit", shifts_json(neighbor.edit)}, {"paint", paint_json(edited.paint)}});
  }
  return Json{{"list", std::move(list)}};
}

Result<Json> Studio::State::nearest(JsonReader& request) const {
  if (!index) return input_error("\"load\" must come first");
  GONIO_ASSIGN(const paint::Paint paint, paint_of_json(request.member("paint")));
  const bool de00 = request.text("metric", "de76") == "de00";
  const double count = request.number("count", 5);
  if (!(count >= 1 && count <= 100)) request.fail("a number from 1 to 100", "count");
  GONIO_TRY(request.status());
  const library::LibrarySearch& search = de00 ? *by_de00 : *by_de76;
  GONIO_ASSIGN(const library::SearchPlan plan, search.plan(paint));
  Json list = Json::array();
  std::optional<library::Verdict> verdict;
  for (const library::LibraryMatch& match : search.nearest(plan, static_cast<std::size_t>(count))) {
    Json by_geometry = Json::object();
    for (std::size_t i = 0; i < plan.geometries.size(); ++i)
      by_geometry[paint::geometry_name(plan.geometries[i])] =
          json_number(de00 ? color::delta_e_2000(plan.terms[i].lab, match.lab[i])
                           : color::delta_e_76(plan.terms[i].lab, match.lab[i]));
    if (!verdict)
      verdict = library::verdict(paint, *index, match.paint,
                                 match.distance / static_cast<double>(plan.geometries.size()), {});
    list.push_back({{"place", match.paint},
                    {"name", std::string(index->name(match.paint))},
                    {"code", std::string(index->code(match.paint))},
                    {"distance", json_number(match.distance)},
                    {"de_by_geometry", std::move(by_geometry)}});
  }
  return Json{{"list", std::move(list)},
              {"left_out", plan.left_out},
              {"outside", verdict && verdict->outside},
              {"off_radial", verdict && verdict->off_radial},
              {"hue_travel", verdict ? json_number(verdict->hue_travel_deg) : Json()},
              {"matched_hue_travel", verdict ? json_number(verdict->matched_hue_travel_deg) : Json()}};
}

Result<Json> Studio::State::write(JsonReader& request) const {
  GONIO_ASSIGN(paint::Paint paint, paint_of_json(request.member("paint")));
  if (request.flag("lobes")) {
    GONIO_ASSIGN(paint, fitted(paint));
  }
  const std::string as = request.text("as"), file = request.text("file", "-");
  const formats::Processing step = {"paint-studio", request.text("version", ""), request.text("command", "")};
  if (as != "xml" && as != "csv" && as != "cxf") request.fail("xml, csv or cxf", "as");
  GONIO_TRY(request.status());
  if (as == "xml") {
    GONIO_TRY(write_xml(file, paint, step));
  } else if (as == "cxf") {
    GONIO_TRY(write_cxf(file, std::move(paint), step, request.text("created", "")));
  } else {
    GONIO_TRY(write_csv(file, std::move(paint)));
  }
  return Json::object();
}

Result<Json> Studio::State::color(JsonReader& request) const {
  const color::Lab lab = request.lab("lab");
  const display::Screen screen = screen_of(request);
  GONIO_TRY(request.status());
  return Json{{"css", css_color(lab, color::ViewingCondition{}, screen)},
              {"rgb", color::rgb_from_lab(lab, screen_white({}))}};
}

// The color of the curve at an aspecular angle.
Result<Json> Studio::State::at(JsonReader& request) const {
  GONIO_ASSIGN(const paint::Paint paint, paint_of_json(request.member("paint")));
  const double angle = request.number("angle");
  if (!(angle >= 0 && angle <= 180)) request.fail("an angle from 0 to 180", "angle");
  const display::Screen screen = screen_of(request);
  GONIO_TRY(request.status());
  GONIO_ASSIGN(const paint::TargetCurve curve, paint::TargetCurve::make(paint, paint::TargetCurve::Kind::kMeasured));
  const color::Lab lab = curve.at(angle);
  return Json{{"lab", lab_json(lab)},
              {"chroma", json_number(color::chroma(lab))},
              {"hue", json_number(color::hue_deg(lab))},
              {"css", css_color(lab, paint::condition_of(paint), screen)}};
}

Result<Json> Studio::State::gloss(JsonReader& request) const {
  const double edge_deg = request.number("edge"), meter_deg = request.number("meter", 60),
               extent_deg = request.number("extent");
  GONIO_TRY(request.status());
  GONIO_ASSIGN(const double units, brdf::gloss_of_edge(edge_deg, meter_deg, extent_deg));
  return Json{{"units", json_number(units)}};
}

// Signals are those of an sRGB picture, 0..255, red, green and blue of one pixel after the other.
Result<Json> Studio::State::dropper(JsonReader& request) const {
  const std::vector<double> signals = request.numbers("signals");
  if (signals.empty() || signals.size() % 3 != 0) request.fail("three signals for each pixel", "signals");
  const display::Screen screen = screen_of(request);
  GONIO_TRY(request.status());
  std::vector<color::Rgb> lights;
  for (std::size_t i = 0; i < signals.size(); i += 3)
    lights.push_back(sketch::light_of_srgb(signals[i] / 255, signals[i + 1] / 255, signals[i + 2] / 255));
  const sketch::DropperColor found = sketch::dropper_color(lights);
  return Json{{"lab", lab_json(found.lab)},
              {"gloss", json_number(found.gloss)},
              {"css", css_color(found.lab, color::ViewingCondition{}, screen)}};
}

// The gradient, made and named as by paint-edit --gradient.
Result<Json> Studio::State::gradient(JsonReader& request) const {
  GONIO_ASSIGN(const paint::Paint from, paint_of_json(request.member("from")));
  GONIO_ASSIGN(const paint::Paint to, paint_of_json(request.member("to")));
  const double count = request.number("count");
  if (!(count >= 1 && count <= 100 && count == std::floor(count)))
    request.fail("a whole number from 1 to 100", "count");
  GONIO_TRY(request.status());
  Json list = Json::array();
  for (int i = 1; i <= static_cast<int>(count); ++i) {
    GONIO_ASSIGN(paint::Paint step, paint::between(from, to, i / (count + 1)));
    step.name = fmt::format("{}-{}.{}", from.name, to.name, i);
    list.push_back(paint_json(step));
  }
  return Json{{"list", std::move(list)}};
}

Result<Json> Studio::State::view(JsonReader& request) {
  const int number = static_cast<int>(request.number("view"));
  if (shown_view != nullptr && views.contains(number) && shown_view == &views.at(number)) shown_view = nullptr;
  const std::string bytes = std::exchange(attached, {});
  GONIO_ASSIGN(ViewPane made, ViewPane::make(bytes, request));
  Json answer = {{"width", made.width()}, {"height", made.height()}};
  views.insert_or_assign(number, std::move(made));
  return Result(std::move(answer));
}

Result<Json> Studio::State::show(JsonReader& request) {
  if (!fitter) return input_error("\"load\" must come first");
  GONIO_ASSIGN(const paint::Paint paint, paint_of_json(request.member("paint")));
  const auto view = views.find(static_cast<int>(request.number("view", -1)));
  if (view == views.end()) request.fail("the number of a view that was loaded", "view");
  const bool small = request.flag("small");
  GONIO_TRY(request.status());
  GONIO_ASSIGN(const fit::PaintFit fit, fitter->fit(paint));
  GONIO_ASSIGN(Json answer, view->second.show(paint, fit.lobes, gloss_angle_deg(paint), small));
  shown_view = &view->second;
  return Result(std::move(answer));
}

Result<Json> Studio::State::open(JsonReader& request) {
  const std::string name = request.text("name");
  GONIO_TRY(request.status());
  numbers = {};
  return opened(name, numbers);
}

Result<Json> Studio::State::light(JsonReader& request) {
  GONIO_ASSIGN(const formats::Basis basis, basis_of(request));
  const std::string name = request.text("name");
  GONIO_TRY(request.status());
  numbers = {};
  return filtered_light(name, basis, numbers, progress);
}

Result<Json> Studio::State::answer(const Json& json) {
  JsonReader request(json);
  const std::string wanted = request.text("do");
  if (wanted == "load") return load(request);
  if (wanted == "edit") return edit(request);
  if (wanted == "fit") return fit(request);
  if (wanted == "flakes") return flakes_of(request);
  if (wanted == "describe") return describe(request);
  if (wanted == "variations") return variations(request);
  if (wanted == "nearest") return nearest(request);
  if (wanted == "write") return write(request);
  if (wanted == "color") return color(request);
  if (wanted == "at") return at(request);
  if (wanted == "gloss") return gloss(request);
  if (wanted == "dropper") return dropper(request);
  if (wanted == "gradient") return gradient(request);
  if (wanted == "view") return view(request);
  if (wanted == "show") return show(request);
  if (wanted == "open") return open(request);
  if (wanted == "light") return light(request);
  if (wanted == "filter" || wanted == "rows" || wanted == "cloud") {
    if (!pane) return input_error("\"load\" must come first");
    return wanted == "filter" ? pane->filter(request) : wanted == "rows" ? pane->rows(request) : pane->cloud(request);
  }
  return input_error("\"do\" is \"{}\": it is none of the requests", wanted);
}

Studio::Studio() : state_(std::make_unique<State>()) {}
Studio::Studio(Studio&&) noexcept = default;
Studio::~Studio() = default;

Json Studio::answer(const Json& request) {
  Result<Json> answer = state_->answer(request);
  if (!answer.ok()) return {{"error", answer.error().message}};
  return std::move(answer).value();
}

const std::vector<float>& Studio::weights() const {
  return state_->weights;
}

std::string& Studio::attached() {
  return state_->attached;
}

std::function<void(double)>& Studio::progress() {
  return state_->progress;
}

namespace {

template <class Element>
std::span<const std::byte> bytes_of(const std::vector<Element>& list) {
  return std::as_bytes(std::span(list));
}

}  // namespace

std::span<const std::byte> Studio::list(List which) const {
  if (which == List::kWeights) return bytes_of(state_->weights);
  if (which == List::kNumbers) return std::as_bytes(std::span(state_->numbers.bytes()));
  if (which == List::kTilts) return bytes_of(state_->tilts);
  if (which == List::kFlakes) return bytes_of(state_->flakes);
  if (which == List::kPicture)
    return state_->shown_view != nullptr ? bytes_of(state_->shown_view->picture()) : std::span<const std::byte>{};
  if (!state_->pane) return {};
  switch (which) {
    case List::kFiltered:
      return bytes_of(state_->pane->list());
    case List::kCloud:
      return bytes_of(state_->pane->cloud());
    case List::kCloudColors:
      return bytes_of(state_->pane->cloud_colors());
    default:
      return bytes_of(state_->pane->cloud_paints());
  }
}

}  // namespace goniochrome::studio
