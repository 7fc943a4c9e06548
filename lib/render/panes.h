// Clear glass that is seen through: its reflectance, its transmission, and the surfaces behind it.
// goniochrome-coats(7), "PANES".
#pragma once

#include <vector>

#include "paint/paint.h"
#include "rays/ray_scene.h"
#include "render/gbuffer.h"
#include "render/scene.h"

namespace goniochrome::render {

// The part of light that a clear pane of glass (index brdf::kCoatIndex) reflects at a cosine of incidence, 0..1: that
// of both of its faces and of all reflections between them. What it does not reflect passes straight on.
double pane_reflectance(double cosine);

// A pane as the engines shade it: a mirror of that reflectance, and nothing else.
paint::LobeFit pane_finish();

// True if a part of the scene is a pane, and if any part is one.
bool is_pane(const Scene& scene, std::size_t part);
bool has_panes(const Scene& scene);

// A rectangle of a picture, with what is seen there through a number of panes.
struct BehindPanes {
  int x = 0, y = 0;           // of its left upper pixel in the picture
  Gbuffer gbuffer;            // of its pixels, with triangles
  std::vector<float> passed;  // of each pixel: the part of light that the panes before it let through; 0: none is there
};

// Surfaces behind one pane, behind two, and so on, until no pixel shows a pane, or less than kLeastPassed is let
// through. `whole` has the mesh of the scene with its panes, and `front` has triangles.
std::vector<BehindPanes> behind_panes(const rays::RayScene& whole, const Scene& scene, const Gbuffer& front);
constexpr float kLeastPassed = 1e-3F;

// The next point on the ray behind this one of a pane, and what the pane lets through.
struct PassedPane {
  rays::Hit hit;
  float passed = 0;
};
PassedPane through_pane(const rays::RayScene& whole, const rays::Spot& pane, const rays::Float3& direction);

}  // namespace goniochrome::render
