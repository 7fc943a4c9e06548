#include "formats/cxf.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <map>
#include <utility>

#include "base/angles.h"
#include "base/text.h"
#include "color/spectrum.h"
#include "formats/internal/spectral_rows.h"
#include "formats/internal/xml_stream.h"

namespace goniochrome::formats {

namespace {

constexpr std::string_view kNamespace = "http://colorexchangeformat.com/CxF3-core";
constexpr double kSmallestStep_nm = 1, kLargestStep_nm = 20;  // of the schema

// One value of an object, as it stands: Lab, or a spectrum to become one.
struct RawColor {
  std::string specification;
  int line = 0;
  color::Lab lab;
  std::vector<double> spectrum;
  double first_nm = 0;  // of the spectrum, where it says so itself
};

struct RawObject {
  paint::Paint paint;
  std::string joined;  // the paint whose angle this object is: our tag
  std::vector<RawColor> colors;
  bool bad = false;  // it had an error that is passed over
};

struct Specification {
  color::ViewingCondition condition{"", 0};
  std::vector<paint::Geometry> angles;
  std::string other;  // a geometry without aspecular angles
  std::string instrument;
  double first_nm = 0, step_nm = 0;
};

// The observer (deg) that a word of CxF3 means; 0 for none.
int observer_of(std::string_view word) {
  return word == "2_Degree" ? 2 : word == "10_Degree" ? 10 : 0;
}

// The angle (deg) that the method of a gloss names, as in `60 deg`, `ISO 2813, 20 degree` and `DIN 67530 85°`: its last
// number that is an angle, because numbers of standards are larger and stand before it. 0 where there is none.
double gloss_angle_of(std::string_view method) {
  constexpr std::string_view kDigits = "0123456789";
  double angle = 0;
  for (auto at = method.find_first_of(kDigits); at != std::string_view::npos; at = method.find_first_of(kDigits, at)) {
    const auto end = std::min(method.find_first_not_of("0123456789.", at), method.size());
    const auto number = parse_number(method.substr(at, method.find_last_not_of('.', end - 1) + 1 - at));
    if (number && *number > 0 && *number <= 90) angle = *number;
    at = end;
  }
  return angle;
}

// The specifications stand behind the objects, so a file is read twice: for them first, and then for the objects.
enum class Pass { kSpecifications, kObjects };

class CxfHandler final : public XmlHandler {
 public:
  CxfHandler(std::string file, Pass pass, bool keep_going)
      : file_(std::move(file)), pass_(pass), keep_going_(keep_going) {}

  Result<void> start(const XmlTag& tag) override {
    line_ = tag.line;
    if (path_.empty()) GONIO_TRY(check_root(tag));
    path_.emplace_back(tag.space == kNamespace ? tag.name : "");
    text_.clear();
    if (pass_ == Pass::kSpecifications && inside("ObjectCollection")) return {};
    const auto attribute = [&](std::string_view name) -> std::string {
      for (const XmlAttribute& a : tag.attributes)
        if (a.name == name && a.space.empty()) return std::string(a.value);
      return "";
    };
    if (in("ObjectCollection", "Object")) {
      ++objects_seen_;
      std::string& own_name = object_.emplace().paint.name;
      const std::string name = attribute("Name");
      own_name = name.empty() ? attribute("Id") : name;
      if (own_name.empty()) {
        own_name = fmt::format("line {}", tag.line);
        remarks_.note("objects with neither Name nor Id are called by their line", own_name);
      }
    } else if (in("ColorValues", "ColorCIELab") || in("ColorValues", "ColorCIELCh") ||
               in("ColorValues", "ReflectanceSpectrum")) {
      color_ = {attribute("ColorSpecification"), tag.line, {}, {}, 0};
      if (const std::string first = attribute("StartWL"); !first.empty()) {
        GONIO_ASSIGN(color_.first_nm, number("StartWL", first));
      }
    } else if (in("PhysicalAttributes", "Gloss")) {
      gloss_method_ = attribute("Method");
    } else if (path_.back() == "TagCollection") {
      own_tags_ = attribute("Name") == "goniochrome";
    } else if (in("TagCollection", "Tag") && own_tags_ && object_) {
      own_tag(attribute("Name"), attribute("Value"));
    } else if (pass_ == Pass::kSpecifications && in("ColorSpecificationCollection", "ColorSpecification")) {
      specification_ = &specifications_[attribute("Id")];
    } else if (in("TristimulusSpec", "Illuminant")) {
      custom_illuminant_ = attribute("Name");
    } else if (in("MultiAngle", "BRDFAngle") || in("GeometryChoice", "SingleAngle")) {
      angle_ = {}, measurement_deg_ = 0;
      angle_.aspecular_deg = std::numeric_limits<double>::quiet_NaN();  // until it is told
      notation_ = attribute("Notation");
    } else if (in("MeasurementSpec", "WavelengthRange") && specification_) {
      GONIO_ASSIGN(specification_->first_nm, number("StartWL", attribute("StartWL")));
      GONIO_ASSIGN(specification_->step_nm, number("Increment", attribute("Increment")));
    }
    return {};
  }

  Result<void> text(std::string_view text, int) override {
    text_ += text;
    return {};
  }

  Result<void> end(int line) override {
    line_ = line;
    const std::string content(trimmed(text_));
    text_.clear();
    const bool of_object = inside("Object") && object_;
    const auto result = of_object        ? end_in_object(content)
                        : specification_ ? end_in_specification(content)
                                         : Result<void>();
    if (!result.ok() && keep_going_ && of_object) {
      skipped_.push_back(result.error().message);
      object_->bad = true;
    }
    if (object_ && in("ObjectCollection", "Object")) {
      if (!object_->bad) objects_.push_back(std::move(*object_));
      object_.reset();
    }
    path_.pop_back();
    return of_object && keep_going_ ? Result<void>() : result;
  }

  Result<void> invalid(int, const std::string&) override { return {}; }

  // What was read since this was last called.
  std::vector<RawObject> take_objects() { return std::exchange(objects_, {}); }
  std::vector<std::string> take_skipped() { return std::exchange(skipped_, {}); }
  std::size_t objects_seen() const { return objects_seen_; }
  const std::map<std::string, Specification>& specifications() const { return specifications_; }
  Remarks& remarks() { return remarks_; }

 private:
  bool in(std::string_view parent, std::string_view name) const {
    return path_.size() >= 2 && path_.back() == name && path_[path_.size() - 2] == parent;
  }
  bool inside(std::string_view name) const {
    for (const std::string& open : path_)
      if (open == name) return true;
    return false;
  }

  Error error(const std::string& what) const { return input_error("{}:{}: {}", file_, line_, what); }

  Result<double> number(std::string_view what, std::string_view text) const {
    const auto value = parse_number(trimmed(text));
    if (!value)
      return error(fmt::format("{} is \"{}\": write a number with a decimal point", what, text.substr(0, 40)));
    return *value;
  }

  Result<void> check_root(const XmlTag& tag) const {
    if (tag.name == "CxF" && tag.space == kNamespace) return {};
    if (tag.name == "CxF") return error(fmt::format("is CxF of another version (\"{}\"): export CxF3", tag.space));
    return error(fmt::format("begins with <{}>, not with <CxF>: this is no CxF file", tag.name));
  }

  void own_tag(const std::string& name, const std::string& value) {
    RawObject& object = *object_;
    if (name == "paint") object.joined = value;
    if (name == "code") object.paint.code = value;
    if (name == "class") object.paint.paint_class = paint::paint_class_of(value).value_or(paint::PaintClass::kUnknown);
  }

  Result<void> end_in_object(const std::string& content) {
    RawObject& object = *object_;
    if (in("ColorCIELab", "L")) return take(color_.lab.L, "L", content);
    if (in("ColorCIELab", "A")) return take(color_.lab.a, "A", content);
    if (in("ColorCIELab", "B")) return take(color_.lab.b, "B", content);
    if (in("ColorCIELCh", "L")) return take(color_.lab.L, "L", content);
    if (in("ColorCIELCh", "C")) return take(chroma_, "C", content);
    if (in("ColorCIELCh", "H")) return take(hue_deg_, "H", content);
    if (in("ColorValues", "ColorCIELCh")) {
      color_.lab.a = chroma_ * std::cos(hue_deg_ * kDegree);
      color_.lab.b = chroma_ * std::sin(hue_deg_ * kDegree);
      object.colors.push_back(color_);
    }
    if (in("ColorValues", "ColorCIELab") || in("ColorValues", "ColorCIELCh"))
      if (const auto checked = check_lab(color_.lab); !checked.ok()) return error(checked.error().message);
    if (in("ColorValues", "ColorCIELab")) object.colors.push_back(color_);
    if (in("ColorValues", "ReflectanceSpectrum")) {
      for (std::size_t i = 0; i < content.size();) {
        const auto end = std::min(content.find_first_of(" \t\r\n", i), content.size());
        if (end > i) {
          GONIO_ASSIGN(const double value, number("ReflectanceSpectrum", std::string_view(content).substr(i, end - i)));
          color_.spectrum.push_back(value);
        }
        i = end + 1;
      }
      if (color_.spectrum.empty()) return error("ReflectanceSpectrum is empty: write its factors, or leave it out");
      object.colors.push_back(color_);
    }
    if (in("PhysicalAttributes", "Gloss")) {
      paint::GlossReading gloss;
      GONIO_TRY(take(gloss.gloss_units, "Gloss", content));
      const double angle = gloss_angle_of(gloss_method_);
      if (angle == 0) remarks_.note("a gloss without its angle was taken as 60 deg", object.paint.name);
      gloss.angle_deg = angle == 0 ? 60 : angle;
      if (gloss.angle_deg == 20 || gloss.angle_deg == 60 || gloss.angle_deg == 85)
        object.paint.gloss.push_back(gloss);
      else
        remarks_.note("a gloss at another angle than 20, 60 and 85 deg was left out", object.paint.name);
    }
    return {};
  }

  Result<void> end_in_specification(const std::string& content) {
    Specification& specification = *specification_;
    if (in("TristimulusSpec", "Illuminant"))
      specification.condition.illuminant =
          content == "Custom" && !custom_illuminant_.empty() ? custom_illuminant_ : content;
    if (in("TristimulusSpec", "Observer")) specification.condition.observer_deg = observer_of(content);
    if (in("BRDFAngle", "IlluminationAngle")) return take(angle_.incidence_deg, "IlluminationAngle", content);
    if (in("BRDFAngle", "Aspecular")) return take(angle_.aspecular_deg, "Aspecular", content);
    if (in("BRDFAngle", "Azimuth")) {
      GONIO_TRY(take(angle_.azimuth_deg, "Azimuth", content));
      angle_.out_of_plane = angle_.azimuth_deg != 0;
    }
    if (in("MultiAngle", "BRDFAngle")) {
      GONIO_ASSIGN(const paint::Geometry angle, noted_angle());
      specification.angles.push_back(angle);
    }
    if (in("SingleAngle", "IlluminationAngle")) return take(angle_.incidence_deg, "IlluminationAngle", content);
    if (in("SingleAngle", "MeasurementAngle")) return take(measurement_deg_, "MeasurementAngle", content);
    if (in("GeometryChoice", "SingleAngle")) {
      // 45/0 and 0/45 read what 45as45 reads; the side of any other pair is not said.
      if (std::abs(angle_.incidence_deg) + std::abs(measurement_deg_) == 45 &&
          angle_.incidence_deg * measurement_deg_ == 0)
        specification.angles.push_back({45, 45});
      else
        specification.other = fmt::format("{}/{}", shortest(angle_.incidence_deg), shortest(measurement_deg_));
    }
    if (in("GeometryChoice", "SphereGeometry")) specification.other = "sphere";
    if (in("GeometryChoice", "UnknownGeometry")) specification.other = "unknown";
    if (in("GeometryChoice", "EmissiveMode")) specification.other = "emissive";
    if (in("Device", "Model")) specification.instrument = content;
    if (in("ColorSpecificationCollection", "ColorSpecification")) specification_ = nullptr;
    return {};
  }

  // The numbers of a BRDFAngle; its notation where that says the same and more (reversed, azimuth 0), or stands alone.
  Result<paint::Geometry> noted_angle() const {
    const auto noted = paint::parse_geometry(notation_);
    if (std::isnan(angle_.aspecular_deg)) {
      if (noted.ok()) return *noted;
      return error(
          fmt::format("BRDFAngle has no Aspecular, and its Notation \"{}\" names no geometry: write one of them",
                      shown(notation_)));
    }
    if (noted && noted->incidence_deg == angle_.incidence_deg && noted->aspecular_deg == angle_.aspecular_deg &&
        noted->azimuth_deg == angle_.azimuth_deg)
      return *noted;
    return angle_;
  }

  Result<void> take(double& target, std::string_view what, const std::string& content) const {
    GONIO_ASSIGN(target, number(what, content));
    return {};
  }

  std::string file_;
  Pass pass_;
  bool keep_going_;
  int line_ = 0;
  std::vector<std::string> path_;  // local names from the root; "" for elements of other vocabularies
  std::string text_;
  bool own_tags_ = false;

  RawColor color_;
  double chroma_ = 0, hue_deg_ = 0, measurement_deg_ = 0;
  std::string gloss_method_, custom_illuminant_, notation_;
  paint::Geometry angle_;
  Specification* specification_ = nullptr;  // the one that is open

  std::optional<RawObject> object_;  // the one that is open
  std::vector<RawObject> objects_;
  std::size_t objects_seen_ = 0;
  std::map<std::string, Specification> specifications_;
  Remarks remarks_;
  std::vector<std::string> skipped_;
};

// Turns raw objects into paints.
class CxfResolver {
 public:
  CxfResolver(const std::map<std::string, Specification>& specifications, Remarks& remarks,
              const ImportOptions& options)
      : specifications_(specifications), options_(options), remarks_(remarks) {}

  Result<void> add(RawObject object) {
    if (object.joined.empty() || object.joined != joined_) {
      finish();
      open_.emplace().paint = std::move(object.paint);
      if (!object.joined.empty()) open_->paint.name = object.joined;
    }
    joined_ = object.joined;
    std::map<std::string, std::size_t> lab_values, spectra, used, kept;  // per specification
    for (const RawColor& color : object.colors) ++(color.spectrum.empty() ? lab_values : spectra)[color.specification];
    for (const RawColor& color : object.colors) {
      const bool spectral = !color.spectrum.empty();
      if (spectral && !is_sound(color)) continue;
      if (spectral) keep_spectrum(color, spectra[color.specification], kept[color.specification]++);
      if (spectral && lab_values.contains(color.specification)) continue;  // the file's own Lab is what it says
      const std::size_t values = (spectral ? spectra : lab_values)[color.specification];
      GONIO_TRY(place(color, values, used[color.specification]++));
    }
    return {};
  }

  void finish() {
    if (!open_) return;
    paint::Paint& paint = open_->paint;
    if (open_->complete(options_, remarks_)) {
      paint.name = names_.own(paint.name, remarks_);
      paints_.push_back(std::move(paint));
    } else if (open_->readings.empty()) {
      remarks_.note("objects without a color at an angle were left out", paint.name);
    }
    open_.reset();
  }

  // The paints that are complete, in order.
  std::deque<paint::Paint>& paints() { return paints_; }

 private:
  static double first_nm_of(const RawColor& color, const Specification& specification) {
    return color.first_nm > 0 ? color.first_nm : specification.first_nm;
  }

  // Whether a spectrum is one; else it is named. Where its specification is missing or has no angles, place() tells it.
  bool is_sound(const RawColor& color) {
    const auto found = specifications_.find(color.specification);
    if (found == specifications_.end() || found->second.angles.empty()) return true;
    std::string fault;
    if (first_nm_of(color, found->second) <= 0 || found->second.step_nm <= 0)
      fault = "spectra without a WavelengthRange were left out";
    else if (color.spectrum.size() < 2)
      fault = "spectra of a single wavelength were left out";
    else if (found->second.step_nm < kSmallestStep_nm || found->second.step_nm > kLargestStep_nm)
      fault = fmt::format("spectra in steps of {} nm were left out: CxF3 has steps of 1, 2, 5, 10 or 20 nm",
                          shortest(found->second.step_nm));
    else if (std::ranges::any_of(color.spectrum, [](double factor) { return factor > kLargestFactor; }))
      fault = fmt::format("spectra with factors beyond {} were left out: 1 is the perfect diffuser", kLargestFactor);
    else if (std::ranges::any_of(color.spectrum, [](double factor) { return factor <= kSmallestFactor; }))
      fault = fmt::format("spectra with factors of {} or less were left out: 0 is black", kSmallestFactor);
    if (!fault.empty()) remarks_.note(fault, open_->paint.name);
    return fault.empty();
  }

  // The k-th of n spectra under one specification, at the angles that place() gives it.
  void keep_spectrum(const RawColor& color, std::size_t n, std::size_t k) {
    const auto found = specifications_.find(color.specification);
    if (found == specifications_.end()) return;
    const Specification& specification = found->second;
    if (n != 1 && n != specification.angles.size()) return;
    const double first_nm = first_nm_of(color, specification);
    for (std::size_t i = 0; i < specification.angles.size(); ++i)
      if (n == 1 || i == k)
        open_->spectra.push_back({specification.angles[i], first_nm, specification.step_nm, color.spectrum});
  }

  // The k-th of n values under one specification: n angles take one each, a single value stands for all.
  Result<void> place(const RawColor& color, std::size_t n, std::size_t k) {
    const auto found = specifications_.find(color.specification);
    if (found == specifications_.end()) {
      remarks_.note(
          fmt::format("color specification \"{}\" is not in the file: its values were left out", color.specification),
          open_->paint.name);
      return {};
    }
    const Specification& specification = found->second;
    const std::vector<paint::Geometry>& angles = specification.angles;
    if (angles.empty()) {
      remarks_.note(fmt::format("values of {} geometry have no aspecular angle and were left out",
                                specification.other.empty() ? "unstated" : specification.other),
                    open_->paint.name);
      return {};
    }
    if (n != 1 && n != angles.size()) {
      remarks_.note(fmt::format("{} values under a specification of {} angles were left out", n, angles.size()),
                    open_->paint.name);
      return {};
    }
    if (n == 1 && angles.size() > 1) remarks_.note("one value stands for several angles", open_->paint.name);
    const color::ViewingCondition condition = stated(specification);
    color::Lab lab = color.lab;
    if (!color.spectrum.empty()) {
      GONIO_ASSIGN(const auto integrated, integrate(color, specification, condition));
      if (!integrated) return {};
      lab = *integrated;
    }
    for (std::size_t i = 0; i < angles.size(); ++i)
      if (n == 1 || i == k) open_->readings.push_back({condition, {angles[i], lab}});
    if (open_->instrument.empty()) open_->instrument = specification.instrument;
    return {};
  }

  color::ViewingCondition stated(const Specification& specification) {
    const bool silent = specification.condition.illuminant.empty() || specification.condition.observer_deg == 0;
    const color::ViewingCondition condition = completed(specification.condition, options_, {"D65", 10});
    if (silent && (options_.illuminant.empty() || options_.observer_deg == 0))
      remarks_.note(
          fmt::format("illuminant or observer is not stated: taken as {}/{}; give --illuminant and --observer if not",
                      condition.illuminant, condition.observer_deg),
          open_->paint.name);
    return condition;
  }

  Result<std::optional<color::Lab>> integrate(const RawColor& color, const Specification& specification,
                                              const color::ViewingCondition& condition) {
    const double first_nm = first_nm_of(color, specification);
    std::vector<double> nm;
    for (std::size_t i = 0; i < color.spectrum.size(); ++i)
      nm.push_back(first_nm + specification.step_nm * static_cast<double>(i));
    const auto meter = color::SpectralColorimeter::make(nm, condition);
    if (!meter) {
      remarks_.note("spectra were left out: " + meter.error().message, open_->paint.name);
      return std::optional<color::Lab>();
    }
    return std::optional(meter->lab(color.spectrum));
  }

  const std::map<std::string, Specification>& specifications_;
  const ImportOptions& options_;
  Remarks& remarks_;
  UniqueNames names_;
  std::optional<OpenPaint> open_;
  std::string joined_;
  std::deque<paint::Paint> paints_;
};

}  // namespace

// The name of the root element decides. Comments and the declaration may stand before it, and it may have a prefix.
bool looks_cxf(std::string_view head) {
  for (std::size_t at = 0; (at = head.find('<', at)) != std::string_view::npos; ++at) {
    std::string_view name = head.substr(at + 1);
    if (name.starts_with('?') || name.starts_with('!')) continue;
    name = name.substr(0, name.find_first_of(" \t\r\n/>"));
    return name.substr(name.find(':') + 1) == "CxF";
  }
  return false;
}

struct CxfReader::State {
  State(InputFile input, const ImportOptions& wanted)
      : options(wanted),
        specifications(input.name(), Pass::kSpecifications, wanted.keep_going),
        objects(input.name(), Pass::kObjects, wanted.keep_going),
        resolver(specifications.specifications(), objects.remarks(), options),
        stream(std::move(input), nullptr, objects) {}

  Result<void> read_on() {
    const auto more = stream.advance();
    ended = !more.ok() || !*more;
    if (!more.ok()) return more.error();
    for (RawObject& object : objects.take_objects()) GONIO_TRY(resolver.add(std::move(object)));
    for (std::string& message : objects.take_skipped()) skipped.push_back(std::move(message));
    if (!ended) return {};
    resolver.finish();
    if (objects.objects_seen() == 0) objects.remarks().note("holds no objects", "");
    return {};
  }

  ImportOptions options;
  CxfHandler specifications, objects;
  CxfResolver resolver;
  XmlStream stream;
  std::deque<std::string> skipped;
  bool ended = false;
};

CxfReader::CxfReader(std::unique_ptr<State> state) : state_(std::move(state)) {}
CxfReader::CxfReader(CxfReader&&) noexcept = default;
CxfReader::~CxfReader() = default;

Result<CxfReader> CxfReader::open(InputFile input, const ImportOptions& options) {
  GONIO_ASSIGN(InputFile first, input.second_reading());
  auto state = std::make_unique<State>(std::move(input), options);
  XmlStream stream(std::move(first), nullptr, state->specifications);
  GONIO_TRY(stream.finish());
  return CxfReader(std::move(state));
}

Result<std::optional<paint::Paint>> CxfReader::next() {
  std::deque<paint::Paint>& paints = state_->resolver.paints();
  for (;;) {
    if (!state_->skipped.empty()) {
      const std::string message = std::move(state_->skipped.front());
      state_->skipped.pop_front();
      return input_error("{}", message);
    }
    if (!paints.empty()) {
      std::optional<paint::Paint> paint = std::move(paints.front());
      paints.pop_front();
      return paint;
    }
    if (state_->ended) return std::optional<paint::Paint>();
    GONIO_TRY(state_->read_on());
  }
}

std::vector<std::string> CxfReader::warnings() const {
  return state_->objects.remarks().lines();
}

Result<ImportedPaints> read_cxf(InputFile input, const ImportOptions& options) {
  GONIO_ASSIGN(CxfReader reader, CxfReader::open(std::move(input), options));
  ImportedPaints imported;
  for (;;) {
    auto paint = reader.next();
    if (!paint.ok() && !options.keep_going) return paint.error();
    if (!paint.ok())
      imported.skipped.push_back(paint.error().message);
    else if (*paint)
      imported.paints.push_back(std::move(**paint));
    else
      break;
  }
  imported.warnings = reader.warnings();
  return imported;
}

}  // namespace goniochrome::formats
