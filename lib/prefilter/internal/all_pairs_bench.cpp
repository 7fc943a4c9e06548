#include "prefilter/internal/all_pairs_bench.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "prefilter/internal/all_pairs_bench.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <array>

#if HWY_ARCH_X86
#include <xmmintrin.h>
#endif

#include "base/angles.h"
#include "base/parallel.h"

// Powers by repeated squaring: twelve squares serve every exponent, and each takes a product for each further bit.

#ifndef GONIOCHROME_ALL_PAIRS_TYPES
#define GONIOCHROME_ALL_PAIRS_TYPES
namespace goniochrome::prefilter::all_pairs {
constexpr std::size_t kBits = 12;
struct Texels {
  std::size_t count;
  const float *x, *y, *z, *red, *green, *blue;
};
}  // namespace goniochrome::prefilter::all_pairs
#endif

HWY_BEFORE_NAMESPACE();
namespace goniochrome::prefilter {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using all_pairs::kBits;

// The exponents are given at compile time, so that their powers stay in registers.
template <unsigned... kExponents>
void Sum(const all_pairs::Texels& texels, const float direction[3], float* rgb) {
  const hn::ScalableTag<float> d;
  using V = hn::Vec<decltype(d)>;
  constexpr std::size_t kLobes = sizeof...(kExponents);
  constexpr std::array<unsigned, kLobes> kAll = {kExponents...};
  V sum[3 * kLobes];
  for (V& s : sum) s = hn::Zero(d);
  const auto dx = hn::Set(d, direction[0]), dy = hn::Set(d, direction[1]), dz = hn::Set(d, direction[2]);
  for (std::size_t i = 0; i < texels.count; i += hn::Lanes(d)) {
    const auto t = hn::MulAdd(dx, hn::LoadU(d, texels.x + i),
                              hn::MulAdd(dy, hn::LoadU(d, texels.y + i), hn::Mul(dz, hn::LoadU(d, texels.z + i))));
    V square[kBits];
    square[0] = hn::Max(t, hn::Zero(d));
    for (std::size_t k = 1; k < kBits; ++k) square[k] = hn::Mul(square[k - 1], square[k - 1]);
    const auto red = hn::LoadU(d, texels.red + i), green = hn::LoadU(d, texels.green + i);
    const auto blue = hn::LoadU(d, texels.blue + i);
    for (std::size_t lobe = 0; lobe < kLobes; ++lobe) {
      V power = hn::Set(d, 1.0F);
      bool first = true;
      for (std::size_t k = 0; k < kBits; ++k)
        if ((kAll[lobe] >> k & 1) != 0) {
          power = first ? square[k] : hn::Mul(power, square[k]);
          first = false;
        }
      sum[3 * lobe] = hn::MulAdd(power, red, sum[3 * lobe]);
      sum[3 * lobe + 1] = hn::MulAdd(power, green, sum[3 * lobe + 1]);
      sum[3 * lobe + 2] = hn::MulAdd(power, blue, sum[3 * lobe + 2]);
    }
  }
  for (std::size_t k = 0; k < 3 * kLobes; ++k) rgb[k] = hn::GetLane(hn::SumOfLanes(d, sum[k]));
}

void SumSeven(const all_pairs::Texels& texels, const float direction[3], float* rgb) {
  Sum<1, 6, 20, 70, 250, 900, 3000>(texels, direction, rgb);
}

}  // namespace HWY_NAMESPACE
}  // namespace goniochrome::prefilter
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace goniochrome::prefilter {

HWY_EXPORT(SumSeven);

AllPairs::AllPairs(const envmap::Environment& env) {
  for (int row = 0; row < env.height(); ++row)
    for (int column = 0; column < env.width(); ++column) {
      const Vec3 d = env.direction(column, row);
      const double area = env.solid_angle(column, row);
      const float* rgb = env.radiance(column, row);
      x_.push_back(static_cast<float>(d.x)), y_.push_back(static_cast<float>(d.y)),
          z_.push_back(static_cast<float>(d.z));
      red_.push_back(static_cast<float>(area * rgb[0]));
      green_.push_back(static_cast<float>(area * rgb[1]));
      blue_.push_back(static_cast<float>(area * rgb[2]));
    }
  count_ = (x_.size() + 63) / 64 * 64;
  for (std::vector<float>* v : {&x_, &y_, &z_, &red_, &green_, &blue_}) v->resize(count_, 0.0F);
}

namespace {

// While it lives, this thread takes subnormal numbers as zero: each would cost a hundred cycles.
class FlushSubnormals {
 public:
#if HWY_ARCH_X86
  FlushSubnormals() {
    _mm_setcsr(before_ | 0x8040U);
  }
  ~FlushSubnormals() {
    _mm_setcsr(before_);
  }

 private:
  unsigned before_ = _mm_getcsr();
#endif
};

}  // namespace

std::vector<float> AllPairs::lobes(const std::vector<Vec3>& directions) const {
  const all_pairs::Texels texels = {count_, x_.data(), y_.data(), z_.data(), red_.data(), green_.data(), blue_.data()};
  std::vector<float> values(3 * kExponents.size() * directions.size());
  parallel_for(directions.size(), 8, [&](std::size_t begin, std::size_t end) {
    [[maybe_unused]] const FlushSubnormals flush;
    for (std::size_t i = begin; i < end; ++i) {
      const float d[3] = {static_cast<float>(directions[i].x), static_cast<float>(directions[i].y),
                          static_cast<float>(directions[i].z)};
      float* rgb = &values[3 * kExponents.size() * i];
      HWY_DYNAMIC_DISPATCH(SumSeven)(texels, d, rgb);
      for (std::size_t k = 0; k < 3 * kExponents.size(); ++k)
        rgb[k] *= static_cast<float>((kExponents[k / 3] + 1) / (2 * kPi));
    }
  });
  return values;
}

}  // namespace goniochrome::prefilter
#endif
