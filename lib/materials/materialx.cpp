// MaterialX: a graph of BSDF nodes, which any renderer with the library of physically based nodes of MaterialX 1.38 or
// later shows. The base is a diffuse node and a few microfacet lobes of one color each; it lies under dielectric nodes
// that are the coat.
//
// A lobe of GGX is f = F D G/(4 cos_i cos_o), which grows toward grazing angles, and a cosine lobe does not. The
// reflectance F of a node generalized_schlick_bsdf makes up for most of that where it falls from 1 to 0 as
// 1 - sqrt(1 - c), c = cos(theta_d), which is near c^2. So each roughness is offered twice, with F = 1 and with this F,
// and least squares with non-negative weights chooses.
#include <algorithm>
#include <array>
#include <cmath>

#include "base/angles.h"
#include "base/text.h"
#include "brdf/lobe_model.h"
#include "materials/internal/ggx.h"
#include "materials/internal/shown.h"
#include "math/least_squares.h"

namespace goniochrome::materials {

namespace {

constexpr std::array kAlphas = {0.06, 0.1, 0.16, 0.25, 0.35, 0.5, 0.7, 1.0};
constexpr double kFallingExponent = 0.5;

// facet_albedo() of one roughness over the cosine of the viewer.
class AlbedoTable {
 public:
  explicit AlbedoTable(double alpha) {
    for (std::size_t i = 0; i < table_.size(); ++i)
      table_[i] = facet_albedo(alpha, static_cast<double>(i) / static_cast<double>(table_.size() - 1));
  }
  FacetAlbedo at(double cosine) const {
    const double x = std::clamp(cosine, 0.0, 1.0) * static_cast<double>(table_.size() - 1);
    const std::size_t i = std::min(static_cast<std::size_t>(x), table_.size() - 2);
    const double t = x - static_cast<double>(i);
    return {std::lerp(table_[i].all, table_[i + 1].all, t), std::lerp(table_[i].grazing, table_[i + 1].grazing, t)};
  }

 private:
  std::array<FacetAlbedo, 49> table_{};
};

const AlbedoTable& albedo_of(std::size_t alpha) {
  static const std::vector<AlbedoTable> tables(kAlphas.begin(), kAlphas.end());
  return tables[alpha];
}

// What a node reflects for a reflectance F of its facets, relative to a single reflection: light that facets send to
// each other is given back.
double compensation(double all, double fresnel) {
  return 1 + fresnel * (1 - all) / all;
}

struct LobeNode {
  std::size_t alpha;
  bool falling;
  color::Rgb tint;  // Rec.709

  // f of the node before its tint, 1/sr.
  double value(const Vec3& light, const Vec3& view) const {
    const double fresnel = falling ? 1 - std::pow(1 - half_cosine(light, view), kFallingExponent) : 1;
    return fresnel * ggx(kAlphas[alpha], light, view) * compensation(albedo_of(alpha).at(view.z).all, fresnel);
  }
};

struct CoatNode {
  double weight, alpha, index;
};

struct Graph {
  color::Rgb diffuse;  // Rec.709, of the light
  std::vector<LobeNode> lobes;
  std::vector<CoatNode> coats;  // from the outside inward
  bool layered = true;          // coats take light from what is below them
};

// The coats as their nodes show them: what they reflect, and what they leave to the base. The layer node takes away
// what the node above reflects to the viewer of even light.
class CoatModel {
 public:
  explicit CoatModel(const Graph& graph) : layered_(graph.layered) {
    for (const CoatNode& coat : graph.coats) coats_.push_back({coat, AlbedoTable(coat.alpha)});
  }
  struct Seen {
    double reflected = 0, left = 1;  // f in 1/sr; 0..1
  };
  Seen at(const Vec3& light, const Vec3& view) const {
    Seen seen;
    for (const auto& [coat, table] : coats_) {
      const FacetAlbedo albedo = table.at(view.z);
      const double normal = (coat.index - 1) / (coat.index + 1), f0 = normal * normal;
      const double fresnel = brdf::fresnel_dielectric(half_cosine(light, view), coat.index);
      const double more = compensation(albedo.all, fresnel);
      // A smooth coat reflects along the mirror direction alone.
      if (coat.alpha > 0) seen.reflected += seen.left * coat.weight * fresnel * more * ggx(coat.alpha, light, view);
      if (layered_) seen.left *= 1 - coat.weight * more * (f0 * (albedo.all - albedo.grazing) + albedo.grazing);
    }
    return seen;
  }

 private:
  struct Coat {
    CoatNode node;
    AlbedoTable table;
  };
  std::vector<Coat> coats_;
  bool layered_;
};

color::Rgb seen(const Graph& graph, const CoatModel& coats, const Vec3& light, const Vec3& view) {
  const CoatModel::Seen coat = coats.at(light, view);
  color::Rgb base = (1 / kPi) * graph.diffuse;
  for (const LobeNode& lobe : graph.lobes) base += lobe.value(light, view) * lobe.tint;
  return coat.left * base + color::Rgb{coat.reflected, coat.reflected, coat.reflected};
}

// The base under its coats: the diffuse node and every lobe node, weighed for each channel by least squares. An error
// counts by what it makes of the lightness.
void fit_base(const paint::LobeFit& lobes, const CoatModel& coats, Graph& graph) {
  std::vector<LobeNode> nodes;
  for (const bool falling : {false, true})
    for (std::size_t a = 0; a < kAlphas.size(); ++a) nodes.push_back({a, falling, {}});
  const std::vector<FitSample> samples = fit_samples(lobes);
  const int rows = static_cast<int>(samples.size()), columns = static_cast<int>(nodes.size()) + 1;
  math::Matrix m(rows, columns);
  std::array<std::vector<double>, 3> b;
  for (int row = 0; row < rows; ++row) {
    const FitSample& sample = samples[static_cast<std::size_t>(row)];
    const CoatModel::Seen coat = coats.at(sample.light, sample.view);
    constexpr double kDarkest = 0.003;  // L* of 3: below, differences are of the instruments
    const double luminance = kPi * color::xyz_d65_from_rgb(sample.f).Y;
    const double weight = std::sqrt(sample.weight) * std::pow(std::max(luminance, kDarkest), -2.0 / 3);
    m(row, 0) = weight * coat.left / kPi;
    for (int c = 1; c < columns; ++c)
      m(row, c) = weight * coat.left * nodes[static_cast<std::size_t>(c) - 1].value(sample.light, sample.view);
    const color::Rgb target = color::rec709_from_rec2020(sample.f);
    for (int c = 0; c < 3; ++c) b[c].push_back(weight * (target[c] - coat.reflected));
  }
  for (int c = 0; c < 3; ++c) {
    const std::vector<double> x = math::nnls(m, b[c]).x;
    graph.diffuse[c] = x[0];
    for (std::size_t k = 0; k < nodes.size(); ++k) nodes[k].tint[c] = x[k + 1];
  }
  constexpr double kLeast = 1e-5;
  for (const LobeNode& node : nodes)
    if (std::max({node.tint.x, node.tint.y, node.tint.z}) > kLeast) graph.lobes.push_back(node);
}

std::string number(double value) {
  return fmt::format("{:.6g}", value);
}
std::string numbers(const color::Rgb& rgb) {
  return number(rgb.x) + ", " + number(rgb.y) + ", " + number(rgb.z);
}

// The text of the document. Names of nodes begin with that of the material, so that several documents can be joined.
class Document {
 public:
  explicit Document(const Naming& naming) : naming_(naming) {
    text_ = "<?xml version=\"1.0\"?>\n<materialx version=\"1.38\" colorspace=\"lin_rec709\" doc=\"" +
            xml_escaped(naming.provenance) + "\">\n";
  }
  // Begins a node; returns its name.
  std::string begin(const std::string& kind, const std::string& what, const std::string& type = "BSDF") {
    kind_ = kind;
    const std::string name = naming_.identifier + "_" + what;
    open(name, type, "");
    return name;
  }
  void open(const std::string& name, const std::string& type, const std::string& more) {
    text_ += "  <" + kind_ + " name=\"" + name + "\" type=\"" + type + "\"" + more + ">\n";
  }
  void value(const char* name, const char* type, const std::string& value) {
    text_ += fmt::format("    <input name=\"{}\" type=\"{}\" value=\"{}\" />\n", name, type, value);
  }
  void link(const char* name, const char* type, const std::string& node) {
    text_ += fmt::format("    <input name=\"{}\" type=\"{}\" nodename=\"{}\" />\n", name, type, node);
  }
  void end() { text_ += "  </" + kind_ + ">\n"; }

  std::string finish(const std::string& surface) {
    kind_ = "surfacematerial";
    open(naming_.identifier, "material", " uiname=\"" + xml_escaped(naming_.display) + "\"");
    link("surfaceshader", "surfaceshader", surface);
    end();
    return text_ + "</materialx>\n";
  }

 private:
  const Naming& naming_;
  std::string text_, kind_;
};

// One lobe with its tint, which a node multiply cuts to 1: a stronger lobe is shared among several.
std::vector<std::string> write_lobe(Document& document, const LobeNode& lobe, std::size_t number_of) {
  const std::string what = "lobe" + std::to_string(number_of);
  const std::string node = document.begin("generalized_schlick_bsdf", what);
  document.value("color0", "color3", "1, 1, 1");
  document.value("color90", "color3", lobe.falling ? "0, 0, 0" : "1, 1, 1");
  document.value("exponent", "float", number(kFallingExponent));
  document.value("roughness", "vector2", number(kAlphas[lobe.alpha]) + ", " + number(kAlphas[lobe.alpha]));
  document.end();
  const int copies = std::max(1, static_cast<int>(std::ceil(std::max({lobe.tint.x, lobe.tint.y, lobe.tint.z}))));
  std::vector<std::string> tinted;
  for (int i = 1; i <= copies; ++i) {
    tinted.push_back(document.begin("multiply", what + "_tint" + (copies > 1 ? std::to_string(i) : "")));
    document.link("in1", "BSDF", node);
    document.value("in2", "color3", numbers((1.0 / copies) * lobe.tint));
    document.end();
  }
  return tinted;
}

std::string written(const Graph& graph, const Naming& naming) {
  Document document(naming);
  std::string top = document.begin("oren_nayar_diffuse_bsdf", "diffuse");
  document.value("color", "color3", numbers(graph.diffuse));
  document.end();
  std::size_t sums = 0;
  const auto join = [&](const char* kind, const char* first, const std::string& node, const char* second) {
    const std::string name = document.begin(kind, std::string(kind) + std::to_string(++sums));
    document.link(first, "BSDF", node);
    document.link(second, "BSDF", top);
    document.end();
    top = name;
  };
  for (std::size_t k = 0; k < graph.lobes.size(); ++k)
    for (const std::string& tinted : write_lobe(document, graph.lobes[k], k + 1)) join("add", "in1", tinted, "in2");
  for (std::size_t k = graph.coats.size(); k-- > 0;) {
    const CoatNode& coat = graph.coats[k];
    const std::string node = document.begin("dielectric_bsdf", "coat" + std::to_string(k + 1));
    document.value("weight", "float", number(coat.weight));
    document.value("ior", "float", number(coat.index));
    document.value("roughness", "vector2", number(coat.alpha) + ", " + number(coat.alpha));
    document.end();
    if (graph.layered)
      join("layer", "top", node, "base");
    else
      join("add", "in1", node, "in2");
  }
  const std::string surface = document.begin("surface", "surface", "surfaceshader");
  document.link("bsdf", "BSDF", top);
  document.end();
  return document.finish(surface);
}

Result<Material> materialx_material(const paint::Paint& fitted, const Naming& naming) {
  GONIO_ASSIGN(const paint::Paint paint, exported(fitted));
  const paint::LobeFit& lobes = *paint.lobes;
  Graph graph;
  graph.layered = lobes.coat_index > paint::kNoCoat;
  const CoatGloss gloss = coat_gloss(lobes);
  const double index = brdf::mirror_index(lobes.coat_index);
  if (gloss.mirror > 0) graph.coats.push_back({gloss.mirror, 0, index});
  if (gloss.satin > 0) graph.coats.push_back({gloss.satin, gloss.satin_alpha, index});
  const CoatModel coats(graph);
  fit_base(lobes, coats, graph);
  const auto target = [&](const Vec3& light, const Vec3& view) {
    return color::rec2020_from_rec709(seen(graph, coats, light, view));
  };
  return Material{written(graph, naming), shown(paint, target)};
}

}  // namespace

const Target kMaterialX = {"materialx", ".mtlx",
                           "a graph of MaterialX: a diffuse node and lobes under a coat, for programs of films and USD",
                           materialx_material};

}  // namespace goniochrome::materials
