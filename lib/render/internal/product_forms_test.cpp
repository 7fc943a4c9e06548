#include "render/internal/product_forms.h"

#include <gtest/gtest.h>

#include "render/scenes_for_test.h"

namespace goniochrome::render::product_forms_test {
namespace {

// The largest difference of the forms' product from the operator's, over all pairs of colors of 0 and 1 and some
// between.
double error_of(const ProductForms& forms, const color::ReflectionOperator& op) {
  TestNumbers random(3);
  double worst = 0;
  const auto corner = [](int i) { return color::Rgb{i & 1 ? 1.0 : 0.0, i & 2 ? 1.0 : 0.0, i & 4 ? 1.0 : 0.0}; };
  for (int i = 0; i < 264; ++i) {
    const color::Rgb a = i < 64 ? corner(i) : color::Rgb{random(), random(), random()},
                     b = i < 64 ? corner(i / 8) : color::Rgb{random(), random(), random()},
                     wanted = color::reflected(op, a, b);
    color::Rgb got;
    for (int f = 0; f < forms.count; ++f)
      got = got + forms.of(f, a) * forms.of(f, b) * forms.out[static_cast<std::size_t>(f)];
    worst = std::max(worst, length(got - wanted));
  }
  return worst;
}

// Sums of six terms, each below the growth of 1e3 that is let through: 6e3 roundings of 1e-16.
constexpr double kExact = 1e-12;

TEST(ProductForms, FourMakeEveryOperatorInUse) {
  EXPECT_EQ(product_forms(color::component_wise()).count, 3);
  EXPECT_LT(error_of(product_forms(color::component_wise()), color::component_wise()), 1e-15);
  for (const color::ReflectionOperator& base : {color::iso_rgb_operator(), color::working_space_operator(),
                                                color::iso_rec709_operator(), color::fitted_operator()}) {
    EXPECT_EQ(product_forms(base).count, 4);
    EXPECT_LT(error_of(product_forms(base), base), kExact);
    EXPECT_GT(error_of({}, base), 0.05) << "each channel by itself would have been wrong";
    for (const double alpha : {0.01, 0.1, 0.5, 1.0, 1.5}) {
      const auto op = color::with_transfer(base, {alpha, alpha / 2, alpha});
      ASSERT_TRUE(op.ok());
      EXPECT_EQ(product_forms(*op).count, 4) << alpha;
      EXPECT_LT(error_of(product_forms(*op), *op), kExact) << alpha;
    }
  }
}

TEST(ProductForms, MakeOperatorsOfAnyCoefficients) {
  TestNumbers random(7);
  for (int i = 0; i < 100; ++i) {
    color::ReflectionOperator op = color::component_wise();
    for (auto& matrix : op.k)
      for (auto& row : matrix)
        for (double& k : row) k += (i % 10 + 1) * 0.1 * (2 * random() - 1);
    op = color::nearest_coherent(op);
    EXPECT_LT(error_of(product_forms(op), op), kExact) << i;
  }
}

TEST(ProductForms, SixServeAnOperatorThatFourDoNotMake) {
  const color::ReflectionOperator op = five_form_operator();
  ASSERT_EQ(color::nearest_coherent(op).k, op.k);
  const ProductForms forms = product_forms(op);
  EXPECT_EQ(forms.count, 6);
  EXPECT_LT(error_of(forms, op), kExact);
}

}  // namespace
}  // namespace goniochrome::render::product_forms_test
