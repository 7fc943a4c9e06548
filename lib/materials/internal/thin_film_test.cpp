#include "materials/internal/thin_film.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace goniochrome::materials::thin_film_test {
namespace {

// Waves of a film that is much thicker than light is coherent do not interfere: what is left is the series of
// reflectances between two surfaces, R + T^2 r / (1 - R r).
TEST(ThinFilm, AThickFilmReflectsWhatItsSurfacesDo) {
  for (const double base : {0.02, 0.2, 0.6}) {
    const double index = 1.7, root = std::sqrt(base + 1e-4), under = (1 + root) / (1 - root);
    const double outer = std::pow((index - 1) / (index + 1), 2), inner = std::pow((under - index) / (under + index), 2);
    const double expected = outer + (1 - outer) * (1 - outer) * inner / (1 - outer * inner);
    const color::Rgb thick = film_reflectance(index, 1e5, {base, base, base}, 1);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(thick[c], expected, 1e-9);
  }
}

// At half a wave of green light in the film both surfaces of a film with a lower index than its base reflect in
// opposite phase a quarter of a wave away: green is brightest with 550 nm / (2 n), and darkest with half of that.
TEST(ThinFilm, HalfAWaveIsBrightAndAQuarterIsDark) {
  const double index = 1.3;
  const color::Rgb base{0.2, 0.2, 0.2};  // an index of 2.6
  const double half = film_reflectance(index, 550 / (2 * index), base, 1).y,
               quarter = film_reflectance(index, 550 / (4 * index), base, 1).y,
               thick = film_reflectance(index, 1e5, base, 1).y;
  EXPECT_GT(half, thick + 0.03);
  EXPECT_LT(quarter, thick - 0.03);
}

TEST(ThinFilm, ReflectsAllAtGrazingAngles) {
  const color::Rgb grazing = film_reflectance(1.5, 300, {0.1, 0.2, 0.3}, 0);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(grazing[c], 1, 1e-3);
}

}  // namespace
}  // namespace goniochrome::materials::thin_film_test
