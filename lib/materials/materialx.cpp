// MaterialX: a graph of BSDF nodes, which any renderer with the library of physically based nodes of MaterialX 1.38 or
// later shows. The base is diffuse nodes and microfacet lobes with a tint each; it lies under dielectric nodes that are
// the coat. internal/lobe_graph.h chooses them.
#include <algorithm>
#include <array>
#include <cmath>

#include "base/angles.h"
#include "base/text.h"
#include "materials/internal/lobe_graph.h"
#include "materials/internal/shown.h"

namespace goniochrome::materials {

namespace {

std::string number(double value) {
  return fmt::format("{:.6g}", value);
}
std::string numbers(const color::Rgb& rgb) {
  return number(rgb.x) + ", " + number(rgb.y) + ", " + number(rgb.z);
}

// The text of the document. Names of nodes begin with that of the material, so that several documents can be joined.
class Document {
 public:
  Document(const Naming& naming, ColorSpace space) : naming_(naming) {
    text_ = "<?xml version=\"1.0\"?>\n<materialx version=\"1.38\" colorspace=\"" + std::string(name_of(space)) +
            "\" doc=\"" + xml_escaped(naming.provenance) + "\">\n";
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

  std::string finish(const std::string& surface, const std::optional<paint::Flakes>& flakes) {
    std::string more = " uiname=\"" + xml_escaped(naming_.display) + "\"";
    const auto attribute = [&](const char* name, double value) {
      text_ +=
          fmt::format("  <attributedef name=\"{}_{}\" type=\"float\" attrname=\"{}\" elements=\"surfacematerial\" />\n",
                      naming_.identifier, name, name);
      more += fmt::format(" {}=\"{}\"", name, number(value));
    };
    if (flakes) {
      attribute("flake_diameter_um", flakes->diameter_um);
      attribute("flake_coverage", flakes->coverage);
      attribute("flake_spread_deg", flakes->spread_deg);
    }
    kind_ = "surfacematerial";
    open(naming_.identifier, "material", more);
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
  const std::string rest = document.begin("subtract", "rest", "float");
  document.value("in1", "float", "1");
  document.link("in2", "float", nodes.cosine);
  document.end();
  const std::string facing = of_two("multiply", "facing", "float", nodes.cosine, nodes.cosine);
  const std::string grazing = of_two("multiply", "grazing", "float", rest, rest);
  nodes.parts = {
      of_two("multiply", "part0", "float", facing, nodes.cosine), of_two("multiply", "part1", "float", facing, rest),
      of_two("multiply", "part2", "float", grazing, nodes.cosine), of_two("multiply", "part3", "float", grazing, rest)};
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

// The sum of the parts of a tint that are not 0; empty if all are.
std::string write_tint(Document& document, const ViewNodes& view, const std::string& what, const BaseNode& node,
                       double scale) {
  constexpr std::array<double, kTintParts> kBinomial = {1, 3, 3, 1};
  std::string sum;
  for (std::size_t k = 0; k < kTintParts; ++k) {
    if (node.tints[k] == color::Rgb{}) continue;
    const std::string part = document.begin("multiply", what + "_part" + std::to_string(k), "color3");
    document.value("in1", "color3", numbers(scale * kBinomial[k] * node.tints[k]));
    document.link("in2", "float", view.parts[k]);
    document.end();
    const std::string before = sum;
    sum = part;
    if (before.empty()) continue;
    sum = document.begin("add", what + "_sum" + std::to_string(k), "color3");
    document.link("in1", "color3", part);
    document.link("in2", "color3", before);
    document.end();
  }
  return sum;
}

// One node with its tint, which a node multiply cuts to 1: a stronger one is shared among several.
std::vector<std::string> write_node(Document& document, const ViewNodes& view, const BaseNode& base,
                                    std::size_t number_of) {
  const bool lobe = base.kind == BaseNode::Kind::kLobe;
  const std::string what = (lobe ? "lobe" : "diffuse") + std::to_string(number_of);
  const std::string roughness =
      base.widened ? write_widened_roughness(document, view, what, base.alpha) : std::string();
  std::string node;
  if (lobe) {
    node = document.begin("generalized_schlick_bsdf", what);
    document.value("color0", "color3", numbers(base.facets.color0 * color::Rgb{1, 1, 1}));
    document.value("color90", "color3", numbers(base.facets.color90 * color::Rgb{1, 1, 1}));
    document.value("exponent", "float", number(base.facets.exponent));
    if (base.widened) {
      document.link("roughness", "vector2", roughness);
      document.link("tangent", "vector3", view.tangent);
    } else {
      document.value("roughness", "vector2", number(base.alpha) + ", " + number(base.alpha));
    }
  } else {
    const bool burley = base.kind == BaseNode::Kind::kBurley;
    node = document.begin(burley ? "burley_diffuse_bsdf" : "oren_nayar_diffuse_bsdf", what);
    document.value("color", "color3", "1, 1, 1");
    document.value("roughness", "float", "0");
  }
  document.end();
  const int copies = std::max(1, static_cast<int>(std::ceil(base.brightest())));
  const std::string tint = write_tint(document, view, what, base, 1.0 / copies);
  std::vector<std::string> tinted;
  for (int i = 1; i <= copies; ++i) {
    tinted.push_back(document.begin("multiply", what + "_tint" + (copies > 1 ? std::to_string(i) : "")));
    document.link("in1", "BSDF", node);
    if (tint.empty())
      document.value("in2", "color3", "0, 0, 0");
    else
      document.link("in2", "color3", tint);
    document.end();
  }
  return tinted;
}

std::string materialx_text(const LobeGraph& graph, const std::optional<paint::Flakes>& flakes, const Naming& naming) {
  Document document(naming, graph.space);
  std::string top;
  std::size_t sums = 0;
  const auto join = [&](const char* kind, const char* first, const std::string& node, const char* second) {
    if (top.empty()) {
      top = node;
      return;
    }
    const std::string name = document.begin(kind, std::string(kind) + std::to_string(++sums));
    document.link(first, "BSDF", node);
    document.link(second, "BSDF", top);
    document.end();
    top = name;
  };
  const ViewNodes view = write_view(document);
  for (std::size_t k = 0; k < graph.base.size(); ++k)
    for (const std::string& tinted : write_node(document, view, graph.base[k], k + 1))
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
  return document.finish(surface, flakes);
}

Result<Material> materialx_material(const paint::Paint& fitted, const Naming& naming) {
  GONIO_ASSIGN(const paint::Paint paint, exported(fitted));
  const LobeGraph graph = nearest_graph(paint);
  return Material{materialx_text(graph, paint.flakes, naming), shown(paint, seen_of(graph))};
}

}  // namespace

const Target kMaterialX = {"materialx",
                           ".mtlx",
                           "a graph of MaterialX: a diffuse node and lobes under a coat, for programs of films and USD",
                           materialx_material,
                           nullptr,
                           16,
                           true};

}  // namespace goniochrome::materials
