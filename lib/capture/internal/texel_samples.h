// The data of one texel in the photographs, as the fit of its lobes sees it.
#pragma once

#include <Eigen/Core>

#include "base/vec3.h"
#include "color/color.h"

namespace goniochrome::capture {

enum class Use : unsigned char {
  kValue,       // the value counts
  kLowerBound,  // the photograph is saturated here: the surface is as bright as this or brighter
  kNone,        // black, held out, or the light or the camera is below the surface
};

// Photographs by row. A lobe is a function of four products of the directions: with the axes as a symmetric matrix
// even I + odd (cos 2a, sin 2a; sin 2a, -cos 2a) in the plane of the surface and 1 along the normal, the base of its
// power is even * along + odd cos 2a * split + odd sin 2a * skew + up.
// goniochrome-surfaces(7), "SPATIALLY VARYING SURFACES".
struct TexelSamples {
  Eigen::ArrayXd along, split, skew, up;
  Eigen::ArrayXd cosine;    // of the light
  Eigen::ArrayX3d value;    // BRDF times that cosine, working space, 1/sr
  Eigen::ArrayXd rounding;  // standard deviation of the value that the rounding of the file makes
  Eigen::Array<Use, Eigen::Dynamic, 1> use;

  Eigen::Index count() const { return cosine.size(); }

  void resize(Eigen::Index photographs) {
    for (Eigen::ArrayXd* a : {&along, &split, &skew, &up, &cosine, &rounding}) a->setZero(photographs);
    value.setZero(photographs, 3);
    use.setConstant(photographs, Use::kNone);
  }

  // Sets the directions of a photograph, unit vectors in the frame of the texel. Error: false, and the photograph stays
  // unused, where one of them is below the surface.
  bool aim(Eigen::Index i, const Vec3& to_light, const Vec3& to_camera) {
    constexpr double kHorizon = 0.02;  // nearer to it, a tilt of a degree changes the light by more than its half
    if (!(to_light.z > kHorizon && to_camera.z > kHorizon)) return false;
    along[i] = to_light.x * to_camera.x + to_light.y * to_camera.y;
    split[i] = to_light.x * to_camera.x - to_light.y * to_camera.y;
    skew[i] = to_light.x * to_camera.y + to_light.y * to_camera.x;
    up[i] = to_light.z * to_camera.z;
    cosine[i] = to_light.z;
    return true;
  }
};

}  // namespace goniochrome::capture
