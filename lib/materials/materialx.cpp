// MaterialX: a graph of BSDF nodes, which any renderer with the library of physically based nodes of MaterialX 1.38 or
// later shows. The base is a diffuse node and a few microfacet lobes of one color each; it lies under dielectric nodes
// that are the coat.
//
// A lobe of GGX is f = F D G/(4 cos_i cos_o), which grows toward grazing angles, and a cosine lobe does not. The
// reflectance F of a node generalized_schlick_bsdf makes up for most of that where it falls from 1 to 0 as
// 1 - sqrt(1 - c), c = cos(theta_d), which is near c^2. So each roughness is offered twice, with F = 1 and with this F.
//
// About its mirror direction a cosine lobe is round, and one of GGX is not: beside the plane of the viewer it is
// narrower, by about the cosine of the viewer. So each roughness is offered twice again: as it is, and wider by
// 1/cosine beside the plane. Its tangent is the view direction, and its roughness depends on the cosine, by nodes of
// the graph. Last, each tint may change with the cosine, as t0 + t1 c^2 + t2 (1 - c)^2. Least squares with non-negative
// weights chooses among all of these.
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

constexpr std::array kAlphas = {0.03, 0.05, 0.08, 0.11, 0.16, 0.22, 0.3, 0.42, 0.6, 1.0};
constexpr double kFallingExponent = 0.5, kLeastCosine = 0.05;  // at which a lobe is no longer widened

// What a node reflects for a reflectance F of its facets, relative to a single reflection: light that facets send to
// each other is given back.
double compensation(double all, double fresnel) {
  return 1 + fresnel * (1 - all) / all;
}

// What a tint is made of: 1, c^2 and (1 - c)^2 of the cosine of the viewer.
constexpr std::size_t kTintParts = 3;
std::array<double, kTintParts> tint_parts(double cosine) {
  return {1, cosine * cosine, (1 - cosine) * (1 - cosine)};
}

struct LobeNode {
  double alpha;
  bool falling, widened;
  std::array<color::Rgb, kTintParts> tints = {};  // Rec.709

  // f of the node before its tint, 1/sr, as MaterialX defines it: the facets have two roughnesses, along the viewer's
  // plane and beside it, and the masking and the compensation have their geometric mean.
  double value(const Vec3& light, const Vec3& view) const {
    const double beside = widened ? std::min(1.0, alpha / std::max(view.z, kLeastCosine)) : alpha;
    const double mean = std::sqrt(alpha * beside), plane = std::hypot(view.x, view.y);
    const Vec3 half = normalized(light + view), x = plane > 0 ? Vec3{view.x / plane, view.y / plane, 0} : Vec3{1, 0, 0};
    const double along = dot(half, x) / alpha, across = (half.y * x.x - half.x * x.y) / beside;
    const double fresnel = falling ? 1 - std::pow(1 - half_cosine(light, view), kFallingExponent) : 1;
    const double d = along * along + across * across + half.z * half.z;
    const double facets = 1 / (kPi * alpha * beside * d * d);
    return fresnel * facets * ggx_masking(mean, light, view) *
           compensation(quick_facet_albedo(mean, view.z).all, fresnel);
  }

  color::Rgb tint(double cosine) const {
    const auto parts = tint_parts(cosine);
    color::Rgb sum;
    for (std::size_t k = 0; k < kTintParts; ++k) sum += parts[k] * tints[k];
    return sum;
  }
  // The largest channel that the tint reaches: between its ends it hangs below a line.
  double brightest() const {
    const color::Rgb grazing = tint(0), facing = tint(1);
    return std::max({grazing.x, grazing.y, grazing.z, facing.x, facing.y, facing.z});
  }
};

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
  for (const LobeNode& lobe : graph.lobes) base += lobe.value(light, view) * lobe.tint(view.z);
  return coat.left * base + color::Rgb{coat.reflected, coat.reflected, coat.reflected};
}

// All lobe nodes that a graph may have, and what each is at the directions of fit_samples(), sample by sample.
struct Offered {
  std::vector<LobeNode> nodes;
  std::vector<double> values;
};

const Offered& offered(const std::vector<FitSample>& samples) {
  static const Offered all = [&] {
    Offered list;
    for (const bool widened : {false, true})
      for (const bool falling : {false, true})
        for (const double alpha : kAlphas) list.nodes.push_back({alpha, falling, widened});
    for (const FitSample& sample : samples)
      for (const LobeNode& node : list.nodes) list.values.push_back(node.value(sample.light, sample.view));
    return list;
  }();
  return all;
}

// The base under its coats: the diffuse node and every part of the tint of every lobe node, weighed for each channel by
// least squares. An error counts by what it makes of the lightness.
void fit_base(const paint::LobeFit& lobes, const CoatModel& coats, Graph& graph) {
  const std::vector<FitSample> samples = fit_samples(lobes);
  const auto& [offers, values] = offered(samples);
  std::vector<LobeNode> nodes = offers;
  const int rows = static_cast<int>(samples.size()), columns = static_cast<int>(kTintParts * nodes.size()) + 1;
  math::Matrix m(rows, columns);
  std::array<std::vector<double>, 3> b;
  for (int row = 0; row < rows; ++row) {
    const FitSample& sample = samples[static_cast<std::size_t>(row)];
    const CoatModel::Seen coat = coats.at(sample.light, sample.view);
    constexpr double kDarkest = 0.003;  // L* of 3: below, differences are of the instruments
    const double luminance = kPi * color::xyz_d65_from_rgb(sample.f).Y;
    const double weight = std::sqrt(sample.weight) * std::pow(std::max(luminance, kDarkest), -2.0 / 3);
    m(row, 0) = weight * coat.left / kPi;
    const auto parts = tint_parts(sample.view.z);
    for (int c = 1; c < columns; ++c) {
      const auto place = static_cast<std::size_t>(c - 1);
      m(row, c) = weight * coat.left * parts[place % kTintParts] *
                  values[static_cast<std::size_t>(row) * nodes.size() + place / kTintParts];
    }
    const color::Rgb target = color::rec709_from_rec2020(sample.f);
    for (int c = 0; c < 3; ++c) b[c].push_back(weight * (target[c] - coat.reflected));
  }
  for (int c = 0; c < 3; ++c) {
    const std::vector<double> x = math::nnls(m, b[c]).x;
    graph.diffuse[c] = x[0];
    for (std::size_t k = 0; k + 1 < x.size(); ++k) nodes[k / kTintParts].tints[k % kTintParts][c] = x[k + 1];
  }
  constexpr double kLeast = 1e-5;
  for (const LobeNode& node : nodes)
    if (node.brightest() > kLeast) graph.lobes.push_back(node);
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
  void text(const char* name, const std::string& value) { this->value(name, "string", value); }
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

// The nodes that lobes of one graph share: the view direction, its cosine, and the parts of tints.
struct ViewNodes {
  std::string tangent, cosine;
  std::array<std::string, kTintParts> parts;
};

ViewNodes write_view(Document& document) {
  const auto of_two = [&](const char* kind, const char* what, const char* type, const std::string& a,
                          const std::string& b) {
    const std::string name = document.begin(kind, what, type);
    document.link("in1", type, a);
    document.link("in2", type, b);
    document.end();
    return name;
  };
  const auto in_world = [&](const char* kind, const char* what) {
    const std::string name = document.begin(kind, what, "vector3");
    document.text("space", "world");
    document.end();
    return name;
  };
  const std::string view = in_world("viewdirection", "view"), normal = in_world("normal", "normal");
  ViewNodes nodes;
  nodes.tangent = document.begin("add", "tangent", "vector3");
  document.link("in1", "vector3", view);
  document.value("in2", "vector3", "0.0007, 0.0011, 0.0005");  // along the normal, the view direction is no tangent
  document.end();
  const std::string signed_cosine = document.begin("dotproduct", "signed_cosine", "float");
  document.link("in1", "vector3", view);
  document.link("in2", "vector3", normal);
  document.end();
  nodes.cosine = document.begin("absval", "cosine", "float");
  document.link("in", "float", signed_cosine);
  document.end();
  nodes.parts[1] = of_two("multiply", "facing", "float", nodes.cosine, nodes.cosine);
  const std::string rest = document.begin("subtract", "rest", "float");
  document.value("in1", "float", "1");
  document.link("in2", "float", nodes.cosine);
  document.end();
  nodes.parts[2] = of_two("multiply", "grazing", "float", rest, rest);
  return nodes;
}

// alpha along the view direction, and alpha/cosine beside it.
std::string write_widened_roughness(Document& document, const ViewNodes& view, const std::string& what, double alpha) {
  const std::string cosine = document.begin("max", what + "_cosine", "float");
  document.link("in1", "float", view.cosine);
  document.value("in2", "float", number(kLeastCosine));
  document.end();
  const std::string wide = document.begin("divide", what + "_wide", "float");
  document.value("in1", "float", number(alpha));
  document.link("in2", "float", cosine);
  document.end();
  const std::string most = document.begin("min", what + "_beside", "float");
  document.link("in1", "float", wide);
  document.value("in2", "float", "1");
  document.end();
  const std::string both = document.begin("combine2", what + "_roughness", "vector2");
  document.value("in1", "float", number(alpha));
  document.link("in2", "float", most);
  document.end();
  return both;
}

// The sum of the parts of a tint that are not 0. Empty: the tint is the same for every viewer.
std::string write_tint(Document& document, const ViewNodes& view, const std::string& what, const LobeNode& lobe,
                       double scale) {
  std::string sum;
  for (std::size_t k = 1; k < kTintParts; ++k) {
    if (lobe.tints[k] == color::Rgb{}) continue;
    const std::string part = document.begin("multiply", what + "_part" + std::to_string(k), "color3");
    document.value("in1", "color3", numbers(scale * lobe.tints[k]));
    document.link("in2", "float", view.parts[k]);
    document.end();
    const std::string before = sum;
    sum = document.begin("add", what + "_sum" + std::to_string(k), "color3");
    document.link("in1", "color3", part);
    if (before.empty())
      document.value("in2", "color3", numbers(scale * lobe.tints[0]));
    else
      document.link("in2", "color3", before);
    document.end();
  }
  return sum;
}

// One lobe with its tint, which a node multiply cuts to 1: a stronger lobe is shared among several.
std::vector<std::string> write_lobe(Document& document, const ViewNodes& view, const LobeNode& lobe,
                                    std::size_t number_of) {
  const std::string what = "lobe" + std::to_string(number_of);
  const std::string roughness =
      lobe.widened ? write_widened_roughness(document, view, what, lobe.alpha) : std::string();
  const std::string node = document.begin("generalized_schlick_bsdf", what);
  document.value("color0", "color3", "1, 1, 1");
  document.value("color90", "color3", lobe.falling ? "0, 0, 0" : "1, 1, 1");
  document.value("exponent", "float", number(kFallingExponent));
  if (lobe.widened) {
    document.link("roughness", "vector2", roughness);
    document.link("tangent", "vector3", view.tangent);
  } else {
    document.value("roughness", "vector2", number(lobe.alpha) + ", " + number(lobe.alpha));
  }
  document.end();
  const int copies = std::max(1, static_cast<int>(std::ceil(lobe.brightest())));
  const std::string tint = write_tint(document, view, what, lobe, 1.0 / copies);
  std::vector<std::string> tinted;
  for (int i = 1; i <= copies; ++i) {
    tinted.push_back(document.begin("multiply", what + "_tint" + (copies > 1 ? std::to_string(i) : "")));
    document.link("in1", "BSDF", node);
    if (tint.empty())
      document.value("in2", "color3", numbers((1.0 / copies) * lobe.tints[0]));
    else
      document.link("in2", "color3", tint);
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
  const ViewNodes view = graph.lobes.empty() ? ViewNodes() : write_view(document);
  for (std::size_t k = 0; k < graph.lobes.size(); ++k)
    for (const std::string& tinted : write_lobe(document, view, graph.lobes[k], k + 1))
      join("add", "in1", tinted, "in2");
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
