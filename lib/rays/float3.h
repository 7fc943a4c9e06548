// Three floats: points and directions of the tracing kernels, where doubles would halve the speed.
#pragma once

#include <cmath>

#include "base/angles.h"
#include "base/vec3.h"

namespace goniochrome::rays {

inline constexpr float kFloatPi = static_cast<float>(kPi), kInversePi = 1 / kFloatPi;

struct Float3 {
  float x = 0, y = 0, z = 0;
};

constexpr Float3 operator+(const Float3& a, const Float3& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
constexpr Float3 operator-(const Float3& a, const Float3& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
constexpr Float3 operator-(const Float3& a) {
  return {-a.x, -a.y, -a.z};
}
constexpr Float3 operator*(float s, const Float3& a) {
  return {s * a.x, s * a.y, s * a.z};
}
constexpr float dot(const Float3& a, const Float3& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
constexpr Float3 cross(const Float3& a, const Float3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline float length(const Float3& a) {
  return std::sqrt(dot(a, a));
}
inline Float3 normalized(const Float3& a) {
  return (1.0F / length(a)) * a;
}
inline Float3 float3(const Vec3& a) {
  return {static_cast<float>(a.x), static_cast<float>(a.y), static_cast<float>(a.z)};
}
inline Vec3 vec3(const Float3& a) {
  return {a.x, a.y, a.z};
}

// Two unit vectors that complete a unit vector z to a right-handed frame (x, y, z). They jump at z = (0, 0, -1) alone.
// The formula divides by 1 + |z.z|, so that nothing cancels.
struct Frame {
  Float3 x, y;
};
inline Frame frame_about(const Float3& z) {
  const float sign = z.z < 0 ? -1.0F : 1.0F, a = -1 / (sign + z.z), b = z.x * z.y * a;
  return {{1 + sign * z.x * z.x * a, sign * b, -sign * z.x}, {b, sign + z.y * z.y * a, -z.y}};
}

}  // namespace goniochrome::rays
