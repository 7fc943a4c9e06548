// Paints that the tests of this room export.
#pragma once

#include "paint/paint.h"

namespace goniochrome::materials {

inline paint::Paint paint_for_test(const char* name, const color::Rgb& diffuse, std::vector<paint::Lobe> lobes,
                                   double coat_index) {
  paint::Paint paint;
  paint.name = name;
  paint::LobeFit fit;
  fit.basis = fit.method = "stated";
  fit.coat_index = coat_index;
  fit.diffuse = diffuse;
  fit.lobes = std::move(lobes);
  paint.lobes = fit;
  return paint;
}

// A bluish silver whose color leaves toward the flop, under a smooth coat.
inline paint::Paint silver_for_test() {
  return paint_for_test("silver", {0.02, 0.022, 0.028},
                        {{6, {0.10, 0.11, 0.13}, {}},
                         {20, {0.25, 0.26, 0.27}, {}},
                         {70, {0.4, 0.4, 0.4}, {}},
                         {paint::kMirrorExponent, {}, {1, 1, 1}}},
                        1.5);
}

inline paint::Paint white_for_test() {
  return paint_for_test("white", {0.3, 0.3, 0.29}, {{paint::kMirrorExponent, {}, {1, 1, 1}}}, 1.5);
}

// A dark green whose coat is half matt.
inline paint::Paint satin_for_test() {
  return paint_for_test("satin", {0.008, 0.02, 0.01}, {{20, {0.01, 0.02, 0.01}, {}}, {250, {}, {1.2, 1.2, 1.2}}}, 1.5);
}

// Black glass of index 1.5.
inline paint::Paint mirror_for_test() {
  return paint_for_test("mirror", {1e-4, 1e-4, 1e-4}, {{paint::kMirrorExponent, {}, {1, 1, 1}}}, 1.5);
}

}  // namespace goniochrome::materials
