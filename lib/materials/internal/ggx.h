// The microfacets of GGX [Walter2007] with the height-correlated masking of Smith [Heitz2014], which the models of
// other renderers are made of.
#pragma once

#include "base/vec3.h"

namespace goniochrome::materials {

// Stands for an alpha of 0 where the models are evaluated.
inline constexpr double kSharpestAlpha = 1e-4;

// D G / (4 cos_i cos_o) in 1/sr, for unit directions above the surface and a roughness alpha > 0.
double ggx(double alpha, const Vec3& to_light, const Vec3& to_viewer);

// Its part G / (4 cos_i cos_o).
double ggx_masking(double alpha, const Vec3& to_light, const Vec3& to_viewer);

// The cosine of the angle between either direction and the half vector.
double half_cosine(const Vec3& to_light, const Vec3& to_viewer);

// Schlick's reflectance (1 - c)^5 of a surface that reflects nothing along its normal, and 1 at grazing angles.
double schlick(double cosine);

// The share of even light that such facets of that alpha reflect to a viewer at that cosine, if they reflect all of it,
// and if they reflect schlick(). By quadrature, absolute error 2e-3; alpha = 0 is a mirror.
struct FacetAlbedo {
  double all = 1, grazing = 0;
};
FacetAlbedo facet_albedo(double alpha, double cosine);

// The albedo by look-up, for searches that ask a thousand times; absolute error 5e-3.
FacetAlbedo quick_facet_albedo(double alpha, double cosine);

// Their mean over all viewers in even light, 2 int E(c) c dc, by look-up; absolute error 5e-3.
FacetAlbedo quick_facet_average(double alpha);

}  // namespace goniochrome::materials
