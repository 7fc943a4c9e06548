#include "envmap/remarks.h"

#include "base/text.h"

namespace goniochrome::envmap {

std::vector<std::string> remarks(const Environment& env) {
  std::vector<std::string> lines;
  const std::string& source = env.source();
  if (env.lit_corners())
    lines.push_back(fmt::format(
        "{}: is square and has light in its corners, where an angular probe has none: it was read as an angular probe; "
        "if it is the photograph of a mirror ball, give prefilter-envmap --ball auto",
        source));
  if (const Environment::Counts& n = env.replaced(); n.total() > 0)
    lines.push_back(fmt::format("{}: {} texels set to zero ({} not a number, {} infinite, {} negative)", source,
                                n.total(), n.nan, n.infinite, n.negative));
  if (env.replaced().out_of_gamut > 0)
    lines.push_back(fmt::format("{}: {} texels beyond Rec.2020 clipped to it", source, env.replaced().out_of_gamut));
  return lines;
}

}  // namespace goniochrome::envmap
