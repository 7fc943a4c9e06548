#include <algorithm>
#include <array>
#include <cmath>
#include <deque>

#include "base/text.h"
#include "formats/imported.h"
#include "formats/internal/paint_elements.h"
#include "formats/internal/tilts_xml.h"
#include "formats/internal/xml_stream.h"
#include "formats/xml.h"
#include "paint/curve.h"

namespace goniochrome::formats {

namespace {

constexpr const char* kRoot = "<paints xmlns=\"urn:goniochrome:paint:1\" version=\"1\">";

// Results of the stream: a paint or its error.
struct Found {
  Result<paint::Paint> paint;
  int line;
};

// Turns elements into paints. A wrong value inside a paint ends up in its place; all else ends the document.
class PaintHandler : public XmlHandler {
 public:
  explicit PaintHandler(std::string file) : file_(std::move(file)), tilts_(file_) {}

  Result<void> start(const XmlTag& tag) override;
  Result<void> end(int line) override;
  Result<void> text(std::string_view text, int line) override;
  // The document broke off: what was already known to be wrong with the open paint is told first.
  void break_off() {
    if (lost_) found.push_back({*lost_, paint_line_});
  }

  std::deque<Found> found;
  std::vector<Processing> processing;
  std::vector<std::string> foreign;
  bool in_paints = false;      // the first paint has begun
  std::size_t bytes_read = 0;  // of the whole input, kept up to date by the reader

 private:
  Result<void> element(const XmlTag& tag);
  Result<void> in_order(const ElementRule& rule, const XmlValues& values);
  Result<void> foreign_element(const XmlTag& tag);
  Result<void> begin(Node node, const XmlValues& values);
  Result<void> begin_document(const XmlTag& tag, const XmlValues& values);
  Result<void> begin_paint(const XmlValues& values);
  Result<void> begin_measurement(const XmlValues& values);
  Result<void> begin_lab(const XmlValues& values);
  Result<void> begin_spectrum(const XmlValues& values);
  Result<void> finish_spectrum();
  Result<void> begin_texture(const XmlValues& values);
  Result<void> begin_gloss(const XmlValues& values);
  Result<void> begin_appearance(const XmlValues& values);
  Result<void> begin_coat(const XmlValues& values);
  Result<void> begin_flakes(const XmlValues& values);
  Result<void> begin_lobes(const XmlValues& values);
  Result<void> begin_lobe(const XmlValues& values, std::vector<paint::Lobe>& lobes);
  Result<void> begin_view(const XmlValues& values);
  Result<void> finish(Node node, int line);
  Result<void> once(bool seen, const XmlValues& values) const;
  Result<void> lose_paint(const Error& error);
  Node current() const { return open_.empty() ? Node::kDocument : open_.back(); }
  bool in_paint() const { return depth_ >= 2 && in_paints; }

  std::string file_;
  NameLedger names_;
  std::vector<Node> open_;
  std::vector<Node> last_child_;   // of the document and of each of those
  int depth_ = 0;                  // elements open, ours or not
  std::vector<XmlScope> scope_;    // of <paints> and of the open <paint>
  XmlCopy copy_{kPaintNamespace};  // of the foreign element that is open
  TiltsReader tilts_;
  std::vector<paint::TiltedLobes> tilt_sets_;  // of the open paint
  std::optional<Error> lost_;                  // what is wrong with the open paint; the rest of it is skipped
  paint::Paint paint_;
  int paint_line_ = 0;
  std::size_t paint_bytes_ = 0;
  bool has_face_ = false, has_flop_ = false, has_diffuse_ = false, has_view_diffuse_ = false;
  std::string value_text_;  // of the <gloss> or <spectrum> that is open
  int value_line_ = 0;
  std::size_t spectrum_values_ = 0;  // that its attributes announce
};

Result<void> PaintHandler::lose_paint(const Error& error) {
  if (!in_paint()) return error;
  if (!lost_) lost_ = error;
  return {};
}

Result<void> PaintHandler::start(const XmlTag& tag) {
  ++depth_;
  if (lost_) return {};
  if (in_paint() && bytes_read - paint_bytes_ > kLargestPaint_bytes)
    return input_error("{}:{}: paint \"{}\" is longer than {} MB: split it", file_, tag.line, shown(paint_.name),
                       kLargestPaint_bytes >> 20);
  if (copy_.active()) return copy_.start(tag, {}), Result<void>();
  const bool tilts = current() == Node::kPaint && tag.space == kTiltsNamespace && tag.name == "tilts";
  if (tilts_.active() || tilts) {
    const XmlValues values(file_, tag);
    const auto once_only = tilts_.active() ? Result<void>() : once(!tilt_sets_.empty(), values);
    const auto begun = once_only.ok() ? tilts_.start(tag) : once_only;
    return begun.ok() ? begun : lose_paint(begun.error());
  }
  // A paint that is refused as a whole counts as begun, so that it alone is lost.
  in_paints = in_paints || (depth_ == 2 && tag.name == "paint" && tag.space == kPaintNamespace);
  const auto done = element(tag);
  return done.ok() ? done : lose_paint(done.error());
}

Result<void> PaintHandler::element(const XmlTag& tag) {
  const Node parent = current();
  if (tag.space != kPaintNamespace && parent != Node::kDocument) return foreign_element(tag);
  const auto rule =
      std::ranges::find_if(kRules, [&](const ElementRule& r) { return r.parent == parent && r.name == tag.name; });
  if (parent == Node::kDocument && rule != kRules.end() && tag.space != kPaintNamespace)
    return input_error("{}:{}: this <{}> is of the namespace \"{}\": the first element must be {}", file_, tag.line,
                       tag.name, shown(tag.space), kRoot);
  if (parent == Node::kDocument && rule == kRules.end())
    return input_error("{}:{}: this begins with <{}>, not with paints: the first element must be {}", file_, tag.line,
                       tag.name, kRoot);
  if (rule == kRules.end())
    return input_error("{}:{}: <{}> is not known inside <{}>: it holds {}", file_, tag.line, tag.name, name_of(parent),
                       children_of(parent));
  const XmlValues values(file_, tag);
  GONIO_TRY(values.check_names(rule->attributes));
  GONIO_TRY(in_order(*rule, values));
  if (rule->node == Node::kProcessing && in_paints)
    return values.error("<processing> stands behind a paint: move it to the front");
  if (rule->node == Node::kPaints) GONIO_TRY(begin_document(tag, values));
  if (rule->node == Node::kPaint) {
    scope_.resize(1);
    scope_.push_back(scope_.front());
    declare(tag, scope_.back());
  }
  open_.push_back(rule->node);
  return begin(rule->node, values);
}

// Returns an error where the parent of `rule` orders its elements and this one comes after a later one.
Result<void> PaintHandler::in_order(const ElementRule& rule, const XmlValues& values) {
  last_child_.resize(open_.size() + 1);
  const Node last = std::exchange(last_child_.back(), rule.node);
  if (!is_sequence(rule.parent) || last <= rule.node) return {};
  return values.error(fmt::format("<{}> stands behind <{}> inside <{}>: write {} in this order", rule.name,
                                  name_of(last), name_of(rule.parent), children_of(rule.parent)));
}

Result<void> PaintHandler::foreign_element(const XmlTag& tag) {
  const Node parent = current();
  if (tag.space.empty())
    return input_error("{}:{}: <{}> has no namespace: declare one with xmlns=\"...\"", file_, tag.line, tag.name);
  if (parent == Node::kPaints && in_paints)
    return input_error("{}:{}: <{}> stands behind a paint: move it in front of the first paint, or into one", file_,
                       tag.line, tag.name);
  if (parent != Node::kPaint && parent != Node::kPaints)
    return input_error("{}:{}: <{}> of another vocabulary stands inside <{}>: move it up into <paint>", file_, tag.line,
                       tag.name, name_of(parent));
  copy_.start(tag, scope_.back());
  return {};
}

Result<void> PaintHandler::begin_document(const XmlTag& tag, const XmlValues& values) {
  if (values.text("version") != "1")
    return values.error("version", "this program reads version 1: convert the file with the program that wrote it");
  scope_.resize(1);
  declare(tag, scope_.front());
  return {};
}

Result<void> PaintHandler::begin(Node node, const XmlValues& values) {
  switch (node) {
    case Node::kProcessing:
      if (values.text("tool").empty()) return values.error("tool", "write the name of the program");
      processing.push_back(
          {std::string(values.text("tool")), std::string(values.text("version")), std::string(values.text("command"))});
      return {};
    case Node::kPaint:
      return begin_paint(values);
    case Node::kMeasurement:
      return begin_measurement(values);
    case Node::kLab:
      return begin_lab(values);
    case Node::kSpectrum:
      return begin_spectrum(values);
    case Node::kTexture:
      return begin_texture(values);
    case Node::kGloss:
      return begin_gloss(values);
    case Node::kAppearance:
      return begin_appearance(values);
    case Node::kFace:
      GONIO_TRY(once(std::exchange(has_face_, true), values));
      return values.lab(paint_.appearance->face);
    case Node::kFlop:
      GONIO_TRY(once(std::exchange(has_flop_, true), values));
      return values.lab(paint_.appearance->flop);
    case Node::kAnisotropy:
      GONIO_TRY(once(paint_.anisotropy.has_value(), values));
      paint_.anisotropy.emplace();
      GONIO_TRY(values.number("alphaX", paint_.anisotropy->alpha_x, Domain::kPositive));
      return values.number("alphaY", paint_.anisotropy->alpha_y, Domain::kPositive);
    case Node::kColorMap:
      GONIO_TRY(once(paint_.color_map.has_value(), values));
      paint_.color_map.emplace();
      GONIO_TRY(values.name("href", paint_.color_map->href));
      return values.has("index") ? values.number("index", paint_.color_map->index, Domain::kRefractiveIndex)
                                 : Result<void>();
    case Node::kCoat:
      return begin_coat(values);
    case Node::kFlakes:
      return begin_flakes(values);
    case Node::kLobes:
      return begin_lobes(values);
    case Node::kDiffuse:
      GONIO_TRY(once(std::exchange(has_diffuse_, true), values));
      return values.rgb("", paint_.lobes->diffuse);
    case Node::kLobe:
      return begin_lobe(values, paint_.lobes->lobes);
    case Node::kView:
      return begin_view(values);
    case Node::kViewDiffuse:
      GONIO_TRY(once(std::exchange(has_view_diffuse_, true), values));
      return values.rgb("", paint_.lobes->views.back().diffuse);
    case Node::kViewLobe:
      return begin_lobe(values, paint_.lobes->views.back().lobes);
    default:
      return {};
  }
}

Result<void> PaintHandler::once(bool seen, const XmlValues& values) const {
  if (!seen) return {};
  return values.error(fmt::format("a second <{}> in paint \"{}\": keep one", values.tag().name, shown(paint_.name)));
}

Result<void> PaintHandler::begin_paint(const XmlValues& values) {
  paint_ = {};
  tilt_sets_.clear();
  paint_line_ = values.tag().line;
  paint_bytes_ = bytes_read;
  GONIO_TRY(values.name("name", paint_.name));
  paint_.code = values.text("code");
  if (values.has("class")) GONIO_TRY(values.word("class", paint_.paint_class, class_in));
  if (const auto line = names_.note(paint_.name, paint_line_))
    return values.error(
        fmt::format("paint \"{}\" is already at line {}: rename one of them", shown(paint_.name), *line));
  return {};
}

Result<void> PaintHandler::begin_measurement(const XmlValues& values) {
  GONIO_TRY(once(paint_.measurement.has_value(), values));
  paint::Measurement& measurement = paint_.measurement.emplace();
  std::string illuminant;
  int observer_deg = 0;
  GONIO_TRY(values.name("illuminant", illuminant));
  GONIO_TRY(values.word("observer", observer_deg, observer_in));
  const auto condition = stated_condition(illuminant, observer_deg);
  if (!condition.ok()) return values.error(condition.error().message);
  measurement.condition = *condition;
  measurement.instrument = values.text("instrument");
  measurement.serial = values.text("serial"), measurement.date = values.text("date");
  return {};
}

Result<void> PaintHandler::begin_lab(const XmlValues& values) {
  auto& rows = paint_.measurement->rows;
  auto geometry = paint::parse_geometry(values.text("geometry"));
  if (!geometry.ok()) return values.error(geometry.error().message);
  for (const paint::LabReading& row : rows)
    if (row.geometry == *geometry)
      return values.error(
          fmt::format("geometry {} is given twice: keep one, or give the mean", paint::geometry_name(*geometry)));
  if (rows.size() >= kMostRows) return values.error(fmt::format("more than {} rows in one paint: split it", kMostRows));
  rows.push_back({*geometry, {}});
  return values.lab(rows.back().lab);
}

Result<void> PaintHandler::begin_gloss(const XmlValues& values) {
  const std::string_view angle = values.text("angle");
  if (angle != "20" && angle != "60" && angle != "85")
    return values.error("angle", "a gloss meter reads at 20, 60 or 85 (degrees)");
  const double angle_deg = *parse_number(angle);
  if (std::ranges::find(paint_.gloss, angle_deg, &paint::GlossReading::angle_deg) != paint_.gloss.end())
    return values.error(fmt::format("a second gloss at {} deg: keep one", angle));
  paint_.gloss.push_back({angle_deg, 0});
  value_text_.clear();
  value_line_ = values.tag().line;
  return {};
}

Result<void> PaintHandler::begin_spectrum(const XmlValues& values) {
  constexpr double kMostValues = 2001;
  auto& spectra = paint_.measurement->spectra;
  paint::SpectrumReading spectrum;
  auto geometry = paint::parse_geometry(values.text("geometry"));
  if (!geometry.ok()) return values.error(geometry.error().message);
  for (const paint::SpectrumReading& other : spectra)
    if (other.geometry == *geometry)
      return values.error(fmt::format("a second spectrum at {}: keep one", paint::geometry_name(*geometry)));
  if (spectra.size() >= kMostRows) return values.error(fmt::format("more than {} spectra in one paint", kMostRows));
  spectrum.geometry = *geometry;
  double to_nm = 0;
  GONIO_TRY(values.number("from", spectrum.from_nm, Domain::kPositive));
  GONIO_TRY(values.number("to", to_nm, Domain::kPositive));
  GONIO_TRY(values.number("step", spectrum.step_nm, Domain::kPositive));
  if (to_nm <= spectrum.from_nm) return values.error("to", "it must be above `from` (nanometers)");
  const double steps = (to_nm - spectrum.from_nm) / spectrum.step_nm;
  if (std::abs(steps - std::round(steps)) > 1e-6 || steps + 1 > kMostValues)
    return values.error("step", fmt::format("the way from {} to {} nm must be whole steps, at most {} of them",
                                            shortest(spectrum.from_nm), shortest(to_nm), kMostValues - 1));
  spectrum_values_ = static_cast<std::size_t>(std::lround(steps)) + 1;
  spectra.push_back(std::move(spectrum));
  value_text_.clear();
  value_line_ = values.tag().line;
  return {};
}

Result<void> PaintHandler::finish_spectrum() {
  paint::SpectrumReading& spectrum = paint_.measurement->spectra.back();
  const std::string_view text = value_text_;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find_first_of(" \t\r\n", at), text.size());
    if (end > at) {
      const auto value = number_in(text.substr(at, end - at));
      if (!value.ok())
        return input_error("{}:{}: value {} of the spectrum at {} {}", file_, value_line_, spectrum.factors.size() + 1,
                           paint::geometry_name(spectrum.geometry), value.error().message);
      spectrum.factors.push_back(*value);
    }
    at = end + 1;
  }
  if (spectrum.factors.size() == spectrum_values_) return {};
  return input_error("{}:{}: the spectrum at {} has {} values, and its wavelengths make {}", file_, value_line_,
                     paint::geometry_name(spectrum.geometry), spectrum.factors.size(), spectrum_values_);
}

Result<void> PaintHandler::begin_texture(const XmlValues& values) {
  auto& textures = paint_.measurement->textures;
  paint::TextureReading texture;
  GONIO_TRY(values.name("quantity", texture.quantity));
  GONIO_TRY(values.name("geometry", texture.geometry));
  texture.version = values.text("version");
  GONIO_TRY(values.number("value", texture.value));
  for (const paint::TextureReading& other : textures)
    if (other.quantity == texture.quantity && other.geometry == texture.geometry && other.version == texture.version)
      return values.error(
          fmt::format("a second \"{}\" at {}: keep one", shown(texture.quantity), shown(texture.geometry)));
  if (textures.size() >= kMostRows) return values.error(fmt::format("more than {} textures in one paint", kMostRows));
  textures.push_back(std::move(texture));
  return {};
}

Result<void> PaintHandler::begin_appearance(const XmlValues& values) {
  GONIO_TRY(once(paint_.appearance.has_value(), values));
  paint::Appearance& appearance = paint_.appearance.emplace();
  has_face_ = has_flop_ = false;
  GONIO_TRY(values.number("travel", appearance.travel_deg));
  if (const auto checked = paint::check(appearance); !checked.ok()) return values.error(checked.error().message);
  if (!values.has("residual_de00")) return {};
  return values.number("residual_de00", appearance.residual_de00.emplace(), Domain::kNotNegative);
}

Result<void> PaintHandler::begin_coat(const XmlValues& values) {
  GONIO_TRY(once(paint_.coat_index.has_value(), values));
  double& index = paint_.coat_index.emplace();
  GONIO_TRY(values.number("index", index, Domain::kRefractiveIndex));
  if (index != paint::kNoCoat && !(index >= paint::kLeastCoatIndex && index <= paint::kMostCoatIndex))
    return values.error("index", fmt::format("a coat has {} to {}, and {} says that there is none",
                                             paint::kLeastCoatIndex, paint::kMostCoatIndex, paint::kNoCoat));
  return {};
}

Result<void> PaintHandler::begin_flakes(const XmlValues& values) {
  GONIO_TRY(once(paint_.flakes.has_value(), values));
  paint::Flakes& flakes = paint_.flakes.emplace();
  GONIO_TRY(values.number("diameter_um", flakes.diameter_um, Domain::kPositive));
  GONIO_TRY(values.number("coverage", flakes.coverage, Domain::kPositive));
  GONIO_TRY(values.number("spread_deg", flakes.spread_deg, Domain::kNotNegative));
  if (flakes.diameter_um > paint::kMostFlake_um)
    return values.error("diameter_um", fmt::format("flakes have up to {} micrometers", paint::kMostFlake_um));
  if (flakes.coverage > 1) return values.error("coverage", "it is a part of the surface: write up to 1");
  if (flakes.spread_deg > paint::kMostFlakeSpread_deg)
    return values.error("spread_deg",
                        fmt::format("one flake spreads light by up to {} deg", paint::kMostFlakeSpread_deg));
  return {};
}

Result<void> PaintHandler::begin_lobes(const XmlValues& values) {
  GONIO_TRY(once(paint_.lobes.has_value(), values));
  paint::LobeFit& lobes = paint_.lobes.emplace();
  has_diffuse_ = false;
  if (values.text("space") != "lin_rec2020_scene")
    return values.error("space", "weights must be in lin_rec2020_scene: fit the paint again");
  lobes.basis = values.text("basis");
  lobes.method = values.text("method");
  GONIO_TRY(values.number("max_de00", lobes.max_de00, Domain::kNotNegative));
  return values.number("mean_de00", lobes.mean_de00, Domain::kNotNegative);
}

Result<void> PaintHandler::begin_view(const XmlValues& values) {
  auto& views = paint_.lobes->views;
  if (views.size() >= kMostRows) return values.error(fmt::format("more than {} views in one paint", kMostRows));
  has_view_diffuse_ = false;
  paint::ViewLobes view;
  GONIO_TRY(values.number("angle", view.view_deg, Domain::kNotNegative));
  if (view.view_deg > 90) return values.error("angle", "give degrees from the normal, 0 to 90");
  if (!views.empty() && view.view_deg <= views.back().view_deg)
    return values.error("angle", "views stand in the order of their angles, each once");
  views.push_back(std::move(view));
  return {};
}

Result<void> PaintHandler::begin_lobe(const XmlValues& values, std::vector<paint::Lobe>& lobes) {
  if (lobes.size() >= kMostRows) return values.error(fmt::format("more than {} lobes in one paint", kMostRows));
  paint::Lobe& lobe = lobes.emplace_back();
  if (values.text("exponent") == "mirror")
    lobe.exponent = paint::kMirrorExponent;
  else
    GONIO_TRY(values.number("exponent", lobe.exponent, Domain::kNotNegative));
  GONIO_TRY(values.rgb("dd", lobe.directional_diffuse));
  return values.rgb("g", lobe.gloss);
}

Result<void> PaintHandler::text(std::string_view text, int line) {
  if (lost_) return {};
  if (copy_.active()) return copy_.text(text), Result<void>();
  if (tilts_.active()) {
    const auto done = tilts_.text(text, line);
    return done.ok() ? done : lose_paint(done.error());
  }
  if (current() == Node::kGloss || current() == Node::kSpectrum) return value_text_ += text, Result<void>();
  const std::string_view words = trimmed(text);
  if (words.empty()) return {};
  return lose_paint(input_error("{}:{}: text \"{}\" stands between elements: remove it", file_, line, shown(words)));
}

Result<void> PaintHandler::end(int line) {
  --depth_;
  if (lost_) {
    if (depth_ > 1) return {};
    open_.resize(1);
    copy_ = XmlCopy(kPaintNamespace);
    tilts_ = TiltsReader(file_);
    found.push_back({*std::exchange(lost_, std::nullopt), paint_line_});
    return {};
  }
  if (copy_.active()) {
    if (copy_.end()) (current() == Node::kPaint ? paint_.foreign : foreign).push_back(copy_.take());
    return {};
  }
  if (tilts_.active()) {
    const auto done = tilts_.end(line);
    if (!done.ok()) lost_ = done.error();
    if (!tilts_.active()) tilt_sets_ = tilts_.take();
    return {};
  }
  const Node node = open_.back();
  open_.pop_back();
  const auto done = finish(node, line);
  if (!done.ok()) lost_ = done.error();
  return {};
}

Result<void> PaintHandler::finish(Node node, int line) {
  const auto lacks = [&](const char* child) {
    return input_error("{}:{}: <{}> of paint \"{}\" has no <{}>: add it", file_, line, name_of(node),
                       shown(paint_.name), child);
  };
  switch (node) {
    case Node::kMeasurement:
      if (paint_.measurement->rows.empty()) return lacks("lab");
      break;
    case Node::kSpectrum:
      return finish_spectrum();
    case Node::kAppearance:
      if (!has_face_) return lacks("face");
      if (!has_flop_) return lacks("flop");
      break;
    case Node::kLobes:
      if (!has_diffuse_) return lacks("diffuse");
      break;
    case Node::kView:
      if (!has_view_diffuse_) return lacks("diffuse");
      break;
    case Node::kGloss: {
      auto gloss = number_in(value_text_, Domain::kNotNegative);
      if (!gloss.ok()) return input_error("{}:{}: gloss {}", file_, value_line_, gloss.error().message);
      paint_.gloss.back().gloss_units = *gloss;
      break;
    }
    case Node::kPaint:
      if (!tilt_sets_.empty() && !paint_.lobes) return lacks("lobes");
      if (paint_.lobes) paint_.lobes->tilts = std::exchange(tilt_sets_, {});
      if (paint_.lobes) paint_.lobes->coat_index = paint_.coat_index.value_or(paint::kNoCoat);
      found.push_back({std::move(paint_), paint_line_});
      break;
    default:
      break;
  }
  return {};
}

}  // namespace

struct PaintReader::State {
  State(InputFile input, std::optional<NameChoice> wanted)
      : file(input.name()), choice(std::move(wanted)), handler(file), stream(std::move(input), handler) {}

  // Reads on until a paint or the end is found.
  bool more() {
    if (at_end) return false;
    const auto advanced = stream.advance();
    handler.bytes_read = stream.bytes();
    at_end = !advanced.ok() || !*advanced;
    if (!advanced.ok()) {
      handler.break_off();
      failure = advanced.error();
    }
    return !at_end;
  }

  std::string file;
  std::optional<NameChoice> choice;
  PaintHandler handler;
  XmlStream stream;
  std::optional<Error> failure;  // told when the paints before it are taken
  bool at_end = false;
  int line = 0;
};

Result<PaintReader> PaintReader::open(const std::string& path) {
  auto [file, names] = paint_reference(path);
  GONIO_ASSIGN(InputFile input, InputFile::open(file));
  std::optional<NameChoice> choice;
  if (names) choice.emplace(std::move(*names));
  return PaintReader(std::move(input), std::move(choice));
}

PaintReader::PaintReader(InputFile input, std::optional<NameChoice> choice)
    : state_(std::make_unique<State>(std::move(input), std::move(choice))) {}
PaintReader::PaintReader(PaintReader&&) noexcept = default;
PaintReader& PaintReader::operator=(PaintReader&&) noexcept = default;
PaintReader::~PaintReader() = default;

Result<std::optional<paint::Paint>> PaintReader::next() {
  auto& found = state_->handler.found;
  for (;;) {
    while (found.empty() && state_->more()) {
    }
    if (found.empty()) break;
    Found first = std::move(found.front());
    found.pop_front();
    state_->line = first.line;
    if (!first.paint.ok()) return first.paint.error();
    if (!state_->choice || state_->choice->takes(first.paint->name))
      return std::optional<paint::Paint>(std::move(*first.paint));
  }
  if (state_->failure) return *std::exchange(state_->failure, std::nullopt);
  if (const auto choice = std::exchange(state_->choice, std::nullopt)) GONIO_TRY(choice->check_all_met(state_->file));
  return std::optional<paint::Paint>();
}

int PaintReader::line() const {
  return state_->line;
}

void PaintReader::read_prolog() {
  while (!state_->handler.in_paints && state_->more()) {
  }
}

const std::vector<Processing>& PaintReader::processing() const {
  return state_->handler.processing;
}

const std::vector<std::string>& PaintReader::foreign() const {
  return state_->handler.foreign;
}

}  // namespace goniochrome::formats
