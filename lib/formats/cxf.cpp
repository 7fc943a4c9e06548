#include "formats/cxf.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "base/angles.h"
#include "base/text.h"
#include "color/illuminant.h"
#include "formats/internal/cxf_paints.h"
#include "formats/internal/spectral_rows.h"
#include "formats/internal/xml_stream.h"

namespace goniochrome::formats {

namespace {

constexpr std::string_view kNamespace = "http://colorexchangeformat.com/CxF3-core",
                           kNamespace2 = "http://colorexchangeformat.com/v2";

// The elements of CxF2 that say what those of CxF3 do. Colors stand in their object itself, and each set of colors
// states its illuminant and observer.
constexpr std::array<std::pair<std::string_view, std::string_view>, 7> kNamesOfCxf2 = {
    {{"ColorSet", "ObjectCollection"},
     {"Color", "Object"},
     {"ColorSpaceCIELab", "ColorCIELab"},
     {"ColorSpaceCIEXYZ", "ColorCIEXYZ"},
     {"ColorSpaceSpecificationSpectrumTristimulus", "TristimulusSpec"},
     {"IlluminationOptions", "TristimulusSpec"},
     {"FieldOfView", "Observer"}}};

// A word of CxF3 for what CxF2 calls Illuminant_D50 or FieldOfView_2_Degree.
std::string_view without_prefix(std::string_view word) {
  for (const std::string_view prefix : {"Illuminant_", "FieldOfView_"})
    if (word.starts_with(prefix)) word.remove_prefix(prefix.size());
  return word;
}

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
    path_.emplace_back(local_name(tag));
    text_.clear();
    const auto attribute = [&](std::string_view name) -> std::string {
      for (const XmlAttribute& a : tag.attributes)
        if (a.name == name && a.space.empty()) return std::string(a.value);
      return "";
    };
    if (is_cxf2_ && path_.back() == "ObjectCollection") {
      set_ = fmt::format("set {}", ++sets_);
      if (pass_ == Pass::kSpecifications) specification_ = &specifications_[set_];
    }
    if (in("ObjectCollection", "Object")) {
      ++objects_seen_;
      std::string& own_name = object_.emplace().paint.name;
      const std::string name = attribute(is_cxf2_ ? "ColorName" : "Name");
      own_name = name.empty() ? attribute("Id") : name;
      if (own_name.empty()) {
        own_name = fmt::format("line {}", tag.line);
        remarks_.note("objects with neither Name nor Id are called by their line", own_name);
      }
    } else if (in("ColorValues", path_.back()) && object_) {
      const auto kind = kind_of(path_.back());
      if (!kind) {
        if (std::ranges::find(object_->unread, path_.back()) == object_->unread.end())
          object_->unread.push_back(path_.back());
        return {};
      }
      constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();
      color_ = {.kind = *kind,
                .specification = is_cxf2_ ? set_ : attribute("ColorSpecification"),
                .lab = {kMissing, kMissing, kMissing},
                .xyz = {kMissing, kMissing, kMissing}};
      chroma_ = hue_deg_ = kMissing;
      if (const std::string first = attribute("StartWL"); !first.empty()) {
        GONIO_ASSIGN(color_.first_nm, number("StartWL", first));
      }
      if (const std::string step = attribute("Increment"); !step.empty()) {
        GONIO_ASSIGN(color_.step_nm, number("Increment", step));
      }
    } else if (in("CustomSpectrum", "SpectralPoint")) {
      GONIO_ASSIGN(const double nm, number("WL", attribute("WL")));
      color_.nm.push_back(nm);
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
    } else if (in("TristimulusSpec", "CustomIlluminant") && specification_) {
      const std::string name = attribute("Name");
      specification_->condition.illuminant = color::condition_of(name.empty() ? "Custom" : name, 0).illuminant;
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
    if (in("FileInformation", "CreationDate")) file_date_ = content;
    // The first fault of an object is told.
    const auto result = of_object && object_->bad                     ? Result<void>()
                        : of_object && pass_ == Pass::kSpecifications ? survey(content)
                        : of_object                                   ? end_in_object(content)
                        : specification_                              ? end_in_specification(content)
                                                                      : Result<void>();
    if (!result.ok() && keep_going_ && of_object) {
      skipped_.push_back(result.error().message);
      object_->bad = true;
    }
    if (object_ && in("ObjectCollection", "Object")) {
      if (pass_ == Pass::kSpecifications)
        note_spectra();
      else if (!object_->bad)
        objects_.push_back(std::move(*object_));
      object_.reset();
    }
    path_.pop_back();
    return of_object && keep_going_ ? Result<void>() : result;
  }

  // Tells `judge` of all spectra, once every specification is known.
  void judge_spectra(ScaleJudge& judge) const {
    for (const SeenSpectrum& seen : spectra_) {
      const auto found = specifications_.find(*seen.specification);
      if (found == specifications_.end() || found->second.angles.empty()) continue;
      const std::vector<paint::Geometry>& angles = found->second.angles;
      judge.add(names_[seen.object], angles[std::min(seen.number, angles.size() - 1)], {seen.mean}, seen.L);
    }
  }

  bool has_spectra() const { return !spectra_.empty(); }

  // Takes the objects that were read since the last call.
  std::vector<CxfObject> take_objects() { return std::exchange(objects_, {}); }
  std::vector<std::string> take_skipped() { return std::exchange(skipped_, {}); }
  std::size_t objects_seen() const { return objects_seen_; }
  const std::map<std::string, CxfSpecification>& specifications() const { return specifications_; }
  // Gives those without an aspecular angle the one that the options have for them; `remarks` hears of it.
  void place_by(const ImportOptions& options, Remarks& remarks) {
    for (auto& [id, specification] : specifications_) {
      if (!specification.angles.empty() || options.viewings.empty()) continue;
      const auto geometry = geometry_in_words(specification.other, options, remarks);
      if (geometry) specification.angles.push_back(*geometry);
    }
  }
  Remarks& remarks() { return remarks_; }
  const char* format() const { return is_cxf2_ ? "CxF2" : "CxF3"; }

 private:
  bool in(std::string_view parent, std::string_view name) const {
    if (is_cxf2_ && parent == "ColorValues") parent = "Object";
    return path_.size() >= 2 && path_.back() == name && path_[path_.size() - 2] == parent;
  }
  // The name in CxF3 of an element; "" for one of another vocabulary.
  std::string local_name(const XmlTag& tag) const {
    if (tag.space != (is_cxf2_ ? kNamespace2 : kNamespace)) return "";
    for (const auto& [old, name] : kNamesOfCxf2)
      if (is_cxf2_ && tag.name == old) return std::string(name);
    return std::string(tag.name);
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

  Result<void> check_root(const XmlTag& tag) {
    if (tag.name == "CxF" && tag.space == kNamespace) return {};
    if (tag.name == "CxF" && tag.space == kNamespace2) {
      is_cxf2_ = true;
      return {};
    }
    if (lower(tag.name) == "cxf")
      return error(tag.space.empty()
                       ? fmt::format("is CxF without a namespace, as versions before CxF3 are: export CxF3, "
                                     "whose namespace is {}",
                                     kNamespace)
                       : fmt::format("is CxF of another version (\"{}\"): export CxF3", tag.space));
    return error(fmt::format("begins with <{}>, not with <CxF>: this is no CxF file", tag.name));
  }

  void own_tag(const std::string& name, const std::string& value) {
    CxfObject& object = *object_;
    if (name == "paint") object.joined = value;
    if (name == "code") object.paint.code = value;
    if (name == "date") object.date = value;
    if (name == "class") object.paint.paint_class = paint::paint_class_of(value).value_or(paint::PaintClass::kUnknown);
  }

  static std::optional<CxfColor::Kind> kind_of(std::string_view element) {
    if (element == "ColorCIELab" || element == "ColorCIELCh") return CxfColor::Kind::kLab;
    if (element == "ColorCIEXYZ") return CxfColor::Kind::kXyz;
    if (element == "ReflectanceSpectrum" || element == "CustomSpectrum") return CxfColor::Kind::kSpectrum;
    return std::nullopt;
  }

  // The first pass reads values to judge their scale. What is wrong with an object is told by the second.
  Result<void> survey(const std::string& content) {
    if (!end_in_object(content).ok()) object_->bad = true;
    return {};
  }

  // Keeps the means of the object's spectra, with the L* beside them.
  void note_spectra() {
    if (object_->bad) return;
    std::map<std::string, std::size_t> numbers;  // per specification
    for (const CxfColor& color : object_->colors) {
      if (color.kind != CxfColor::Kind::kSpectrum) continue;
      double sum = 0;
      for (const double value : color.spectrum) sum += value;
      std::optional<double> L;
      for (const CxfColor& other : object_->colors)
        if (other.kind == CxfColor::Kind::kLab && other.specification == color.specification) L = other.lab.L;
      spectra_.push_back({names_.size(), &*names_of_specifications_.insert(color.specification).first,
                          numbers[color.specification]++, sum / static_cast<double>(color.spectrum.size()), L});
    }
    if (!numbers.empty()) names_.push_back(object_->joined.empty() ? object_->paint.name : object_->joined);
  }

  Result<void> end_in_object(const std::string& content) {
    CxfObject& object = *object_;
    // An object that was made with the file tells no date of a reading.
    if (in("Object", "CreationDate") && content != file_date_) object.date = content;
    if (in("ColorCIELab", "L")) return take(color_.lab.L, "L", content);
    if (in("ColorCIELab", "A")) return take(color_.lab.a, "A", content);
    if (in("ColorCIELab", "B")) return take(color_.lab.b, "B", content);
    if (in("ColorCIELCh", "L")) return take(color_.lab.L, "L", content);
    if (in("ColorCIELCh", "C")) return take(chroma_, "C", content);
    if (in("ColorCIELCh", "H")) return take(hue_deg_, "H", content);
    if (in("ColorValues", "ColorCIELab") && std::isnan(color_.lab.L + color_.lab.a + color_.lab.b))
      return error("a Lab lacks one of L, A and B: write all three");
    if (in("ColorValues", "ColorCIELCh") && std::isnan(color_.lab.L + chroma_ + hue_deg_))
      return error("an LCh lacks one of L, C and H: write all three");
    if (in("ColorValues", "ColorCIEXYZ") && std::isnan(color_.xyz.X + color_.xyz.Y + color_.xyz.Z))
      return error("an XYZ lacks one of X, Y and Z: write all three");
    if (in("ColorValues", "ColorCIELCh")) {
      color_.lab.a = chroma_ * std::cos(hue_deg_ * kDegree);
      color_.lab.b = chroma_ * std::sin(hue_deg_ * kDegree);
      object.colors.push_back(color_);
    }
    if (in("ColorValues", "ColorCIELab") || in("ColorValues", "ColorCIELCh"))
      if (const auto checked = check_lab(color_.lab); !checked.ok()) return error(checked.error().message);
    if (in("ColorValues", "ColorCIELab")) object.colors.push_back(color_);
    if (in("ColorCIEXYZ", "X")) return take(color_.xyz.X, "X", content);
    if (in("ColorCIEXYZ", "Y")) return take(color_.xyz.Y, "Y", content);
    if (in("ColorCIEXYZ", "Z")) return take(color_.xyz.Z, "Z", content);
    if (in("ColorValues", "ColorCIEXYZ")) object.colors.push_back(color_);
    if (in("CustomSpectrum", "SpectralPoint")) {
      GONIO_ASSIGN(const double value, number("SpectralPoint", content));
      color_.spectrum.push_back(value);
    }
    if (in("ColorValues", "CustomSpectrum")) {
      if (color_.spectrum.size() < 2) return error("CustomSpectrum has fewer than two points: leave it out");
      if (color_.nm.front() > color_.nm.back()) std::ranges::reverse(color_.nm), std::ranges::reverse(color_.spectrum);
      object.colors.push_back(color_);
    }
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

  Result<void> end_in_specification(const std::string& text) {
    const std::string content(is_cxf2_ ? without_prefix(text) : text);
    CxfSpecification& specification = *specification_;
    if (in("TristimulusSpec", "Illuminant"))
      specification.condition.illuminant =
          color::condition_of(content == "Custom" && !custom_illuminant_.empty() ? custom_illuminant_ : content, 0)
              .illuminant;
    if (in("TristimulusSpec", "Observer")) {
      specification.condition.observer_deg = observer_of(content);
      if (observer_of(content) == 0) specification.remarks.push_back(unheard("Observer", content));
    }
    if (in("BRDFAngle", "IlluminationAngle")) return take(angle_.incidence_deg, "IlluminationAngle", content);
    if (in("BRDFAngle", "Aspecular")) return take(angle_.aspecular_deg, "Aspecular", content);
    if (in("BRDFAngle", "Azimuth")) {
      GONIO_TRY(take(angle_.azimuth_deg, "Azimuth", content));
      angle_.out_of_plane = angle_.azimuth_deg != 0;
    }
    if (in("MultiAngle", "BRDFAngle")) {
      GONIO_ASSIGN(const paint::Geometry angle, noted_angle());
      if (const auto noted = paint::parse_geometry(notation_); noted.ok() && !(*noted == angle))
        specification.remarks.push_back(
            fmt::format("the Notation \"{}\" stands beside the angles of {}, which were taken", shown(notation_),
                        paint::geometry_name(angle)));
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
    if (in("Device", "SerialNumber")) specification.serial = content;
    const bool is_filtered = in("Device", "DeviceFilter") && content != "Filter_None";
    const bool is_polarized = in("Device", "DevicePolarization") && (content == "true" || content == "1");
    // M0 and M1 differ where a paint glows in ultraviolet light; M2 and M3 stand for filters. [ISO 13655:2017]
    const bool is_lit_otherwise =
        in("Device", "DeviceIllumination") && (content.starts_with("M2") || content.starts_with("M3"));
    if (is_filtered || is_polarized || is_lit_otherwise)
      specification.remarks.push_back(unheard(path_.back(), content));
    if (in("MeasurementSpec", "MeasurementType") && (content.ends_with("ransmittance") || content.ends_with("missive")))
      specification.unlike_reflectance = content;
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
  bool own_tags_ = false, is_cxf2_ = false;
  std::string set_;  // of the colors of CxF2: the specification that is open
  int sets_ = 0;

  CxfColor color_;
  double chroma_ = 0, hue_deg_ = 0, measurement_deg_ = 0;
  std::string gloss_method_, custom_illuminant_, notation_, file_date_;
  paint::Geometry angle_;
  CxfSpecification* specification_ = nullptr;  // the one that is open

  std::optional<CxfObject> object_;  // the one that is open
  std::vector<CxfObject> objects_;
  std::size_t objects_seen_ = 0;
  std::map<std::string, CxfSpecification> specifications_;
  // The first pass keeps a few bytes of each spectrum, which suffice to judge its scale.
  struct SeenSpectrum {
    std::size_t object;
    const std::string* specification;
    std::size_t number;  // of the object's spectra under this specification
    double mean;
    std::optional<double> L;
  };
  std::vector<SeenSpectrum> spectra_;
  std::vector<std::string> names_;  // of objects with spectra
  std::set<std::string> names_of_specifications_;
  Remarks remarks_;
  std::vector<std::string> skipped_;
};

}  // namespace

// The name of the root element decides. Comments and the declaration may stand before it, and it may have a prefix;
// versions before CxF3 write it in capitals too.
bool looks_cxf(std::string_view head) {
  for (std::size_t at = 0; (at = head.find('<', at)) != std::string_view::npos; ++at) {
    std::string_view name = head.substr(at + 1);
    if (name.starts_with('?') || name.starts_with('!')) continue;
    name = name.substr(0, name.find_first_of(" \t\r\n/>"));
    return lower(name.substr(name.find(':') + 1)) == "cxf";
  }
  return false;
}

struct CxfReader::State {
  State(InputFile input, const ImportOptions& wanted)
      : options(wanted),
        specifications(input.name(), Pass::kSpecifications, wanted.keep_going),
        objects(input.name(), Pass::kObjects, wanted.keep_going),
        resolver(specifications.specifications(), objects.remarks(), options),
        stream(std::move(input), objects) {}

  Result<void> read_on() {
    const auto more = stream.advance();
    ended = !more.ok() || !*more;
    if (!more.ok()) return more.error();
    for (CxfObject& object : objects.take_objects()) resolver.add(std::move(object));
    for (std::string& message : objects.take_skipped()) skipped.push_back(std::move(message));
    if (!ended) return {};
    resolver.finish();
    resolver.note_scale();
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
  const std::string name = first.name();
  XmlStream stream(std::move(first), state->specifications);
  GONIO_TRY(stream.finish());
  state->specifications.place_by(state->options, state->objects.remarks());
  ScaleJudge judge;
  state->specifications.judge_spectra(judge);
  const auto unit =
      judge.unit_of_format(state->specifications.format(), Scale::kFactor, options.scale, state->objects.remarks());
  if (!unit.ok()) return input_error("{}: {}", name, unit.error().message);
  state->resolver.set_unit(*unit, state->specifications.has_spectra());
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
