#include "materials/internal/documents.h"

#include <string_view>

#include "base/text.h"

namespace goniochrome::materials {

namespace {

std::string joined(const std::vector<double>& values) {
  return goniochrome::joined(values, ", ", [](double value) { return fmt::format("{:.6g}", value); });
}

}  // namespace

std::string mtlx_of_shader(const char* kind, const char* version, const ShaderInputs& inputs, const Naming& naming) {
  std::string text = fmt::format(
      "<?xml version=\"1.0\"?>\n<materialx version=\"{}\" colorspace=\"lin_rec709\" doc=\"{}\">\n"
      "  <{} name=\"{}_surface\" type=\"surfaceshader\">\n",
      version, xml_escaped(naming.provenance), kind, naming.identifier);
  for (const auto& [name, values] : inputs) {
    text += fmt::format("    <input name=\"{}\" type=\"{}\" value=\"{}\" />\n", name,
                        values.size() == 1 ? "float" : "color3", joined(values));
  }
  return text + fmt::format(
                    "  </{}>\n  <surfacematerial name=\"{}\" type=\"material\" uiname=\"{}\">\n"
                    "    <input name=\"surfaceshader\" type=\"surfaceshader\" nodename=\"{}_surface\" />\n"
                    "  </surfacematerial>\n</materialx>\n",
                    kind, naming.identifier, xml_escaped(naming.display), naming.identifier);
}

std::string usda_of_shader(const char* id, const char* terminal, const std::string& more, const ShaderInputs& inputs,
                           const Naming& naming) {
  const bool materialx = std::string_view(terminal).starts_with("mtlx");
  std::string lines = more;
  for (const auto& [name, values] : inputs)
    lines += values.size() == 1 ? fmt::format("        float inputs:{} = {}\n", name, joined(values))
                                : fmt::format("        color3f inputs:{} = ({})\n", name, joined(values));
  return fmt::format(
      "#usda 1.0\n"
      "(\n    defaultPrim = \"{0}\"\n    doc = {1}\n    metersPerUnit = 1\n    upAxis = \"Y\"\n)\n\n"
      "def Material \"{0}\" (\n{6}    displayName = {2}\n)\n{{\n{7}"
      "    token outputs:{3}.connect = </{0}/surface.outputs:{8}>\n\n"
      "    def Shader \"surface\"\n    {{\n"
      "        uniform token info:id = \"{4}\"\n{5}"
      "        token outputs:{8}\n    }}\n}}\n",
      naming.identifier, quoted(naming.provenance), quoted(naming.display), terminal, id, lines,
      materialx ? "    prepend apiSchemas = [\"MaterialXConfigAPI\"]\n" : "",
      materialx ? "    uniform string config:mtlx:version = \"1.39\"\n" : "", materialx ? "out" : "surface");
}

std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    result += c == '\n' || c == '\r' || c == '\t' ? ' ' : c;
  }
  return result + "\"";
}

}  // namespace goniochrome::materials
