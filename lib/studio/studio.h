// Requests of a page for the design of paints to the library, and answers, as JSON, so that the same arithmetic serves
// a browser, where it runs as WebAssembly, and the tools. A page computes no color by itself.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/json.h"
#include "render/effects.h"

namespace goniochrome::studio {

// The effects that a page draws: everything that a paint of this basis can call for in the light of an environment from
// which `spots` bright spots are cut. Lamps, textures, color maps and brushed surfaces are not drawn.
render::Effects page_effects(const std::vector<double>& exponents, bool mirror, std::size_t spots);

// How colored light and paint multiply in a page: as in pictures of render-osmesa, unless it is told otherwise.
color::ReflectionOperator page_operator();

// A session of one page. A request is an object whose member "do" names one of these:
//   load        basis{name, exponents[], mirror}, paints[], print{}, which may be absent: the members of
//               color::PrintGamut. Must come first. With attached true, attached() holds the
//               content of a library::LibraryIndex in the place of paints[]. Answers paints, the size of the library,
//               and geometries[] of geometry and angle.
//   edit        paint, edit{}: the moves of paint-edit, by the names of its options without dashes; numbers are numbers
//               and colors are lists. Answers paint, dropped[], clipped[], skipped[].
//   fit         paint, extent: fits it as fit-paint does by default, and fills weights(). Answers lobes and the report,
//               and highlight, the angle where the highlight of a lamp of that extent falls to half.
//   flakes      paint, lamps[] of radii: fills list kFlakes and answers per_m2 and most[], as render::PageFlakes has
//               them; per_m2 is 0 where the paint states no flakes.
//   describe    paint: its curve, readings, average color, metrics and the colors of a screen.
//   variations  paint, of ("face", "flop", "travel", "gloss"), step: answers list[] of name, edit and paint.
//   nearest     paint, metric ("de76", "de00"), count: answers list[] of place, name, code, distance and differences,
//               and colorsnap's verdicts outside and off_radial, and hue_travel and matched_hue_travel (degrees from
//               face to flop; null where there is none).
//   write       paint, as ("xml", "csv", "cxf"), file, lobes (true: with its lobes), version and command of its
//               history, created (date and time, for CxF).
//   color       lab[]: answers css, the color on a screen.
//   at          paint, angle: answers lab, chroma, hue and css of its curve at that aspecular angle.
//   gloss       edge, extent, meter: answers units, the gloss whose highlight falls to half at that angle.
//   dropper     signals[] of an sRGB picture: answers lab, css, and gloss by contrast.
//   gradient    from, to, count: answers list[] of the paints that paint-edit --gradient puts between them.
//   filter      text, classes[], ranges[] of metric, low and high, order: answers count, and fills list kFiltered.
//   rows        places[]: answers list[] of name, code, class and colors[].
//   cloud       geometry: answers count, and fills the lists kCloud (three floats each), kCloudColors and kCloudPaints.
//   open        name: reads that file. Answers kind ("paints", "mesh", "basis" or "light") and what internal/opening.h
//               lists; numbers fill kNumbers.
//   light       name, basis{} as in "load": filters that picture of light by the lobes of the basis. Answers
//               environment{} and remarks[]; numbers fill kNumbers, and progress() hears how far it is.
//   view        view, parts[] of name and material, mirrors (whether the finishes of parts that nobody paints mirror),
//               operator[27]: attached() holds a view as render::packed_view() makes it, which has that number from now
//               on. Answers width and height.
//   show        view, paint, small: fits the paint and fills list kPicture with the view in that paint, radiance as R G
//   B
//               A of each pixel from the upper left; of fewer pixels where small is true. Answers width, height, scaled
//               (whether bounced light was traced in other paints), bounced_de00_p95 (what scaling it errs by),
//               trace_again (whether that is more than render-osmesa takes) and coat_changed.
// Colors that an answer has as css, and cloud colors, are those of the request's "screen": "srgb", where it says
// nothing, or "display-p3"; so is screen{} of "describe". An answer that holds "error" tells in a sentence what was
// wrong with the request.
class Studio {
 public:
  Studio();
  Studio(Studio&&) noexcept;
  ~Studio();

  Json answer(const Json& request);

  // The row of weights of the paint that was fitted last, as render::WeightTable has it.
  const std::vector<float>& weights() const;

  // The lists that answers fill, in the machine's own number format: floats of weights, tilts, clouds and pictures,
  // else 32-bit whole numbers.
  enum class List { kWeights, kFiltered, kCloud, kCloudColors, kCloudPaints, kTilts, kPicture, kNumbers, kFlakes };
  std::span<const std::byte> list(List which) const;

  // Bytes for "load" or "view", which takes them.
  std::string& attached();

  // Called during "light" with the part of the work that is done.
  std::function<void(double)>& progress();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace goniochrome::studio
