// Parts that all targets share: the paint as a function of two directions, the directions at which a target is fitted
// to it, and the comparison of both.
#pragma once

#include <functional>
#include <vector>

#include "base/vec3.h"
#include "color/color.h"
#include "materials/material.h"

namespace goniochrome::materials {

// f in 1/sr in the working space for unit directions in the frame whose z is the normal.
using Reflection = std::function<color::Rgb(const Vec3& to_light, const Vec3& to_viewer)>;

// The unit direction at those angles.
Vec3 direction(double polar_rad, double azimuth_rad);

// The paint with gloss weights that hold at 45 deg, where those of a paint with a gloss reading hold at the angle of
// its first reading. All functions below take such a paint. Error: it has no lobes.
Result<paint::Paint> exported(paint::Paint paint);

// Compares the target with the lobes at compared_geometries(), and with the readings of the paint that are 10 deg or
// more off the mirror direction. A color of the target below 0 in some channel is shown as it is.
Shown shown(const paint::Paint& paint, const Reflection& target);

// One pair of directions at which a target is fitted, with its share of the sum of squares.
struct FitSample {
  Vec3 light, view;
  double weight;
  color::Rgb f;  // of the paint
};

// Pairs whose weights become half of all, and compared_geometries() with the other half.
std::vector<FitSample> with_geometries(std::vector<FitSample> samples);
// Pairs with what a paint reflects at each.
std::vector<FitSample> reflected(std::vector<FitSample> samples, const paint::LobeFit& lobes);

// The pairs for a paint: compared_geometries() with half of the weight, the other half on a grid over both hemispheres
// to 70 deg from the normal and at least 13 deg off the mirror direction.
std::vector<FitSample> fit_samples(const paint::LobeFit& lobes);

// The gloss of a coat besides its mirror image: the weight of the mirror, 0 to 1, in Fresnel's reflectance of the coat,
// and the satin lobes as one of a GGX of that roughness, alpha.
struct CoatGloss {
  double mirror = 0, satin = 0, satin_alpha = 0;
};
CoatGloss coat_gloss(const paint::LobeFit& lobes);

}  // namespace goniochrome::materials
