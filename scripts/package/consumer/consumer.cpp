// Fits a paint with the installed library and prints how far the fit is from the paint. The exit status is 1 if that is far.
#include <cstdio>

#include "fit/paint_fit.h"
#include "formats/basis.h"
#include "image/image.h"
#include "render/renderer.h"

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const auto basis = goniochrome::formats::read_basis(argv[1]);
  if (!basis) return 3;
  goniochrome::paint::Paint paint;
  paint.name = "gray";
  goniochrome::paint::Appearance appearance;
  appearance.face = {60, 0, 0};
  appearance.flop = {20, 0, 0};
  appearance.travel_deg = 70;
  paint.appearance = appearance;
  const auto fit = goniochrome::fit::PaintFitter(*basis, {}).fit(paint);
  if (!fit) return 3;
  std::printf("dE00 mean %.3f, renderer %s\n", fit->report.de00_mean,
              goniochrome::render::Renderer::create() ? "works" : "is missing");
  return fit->report.de00_mean < 5 ? 0 : 1;
}
