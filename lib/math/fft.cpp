#include "math/fft.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "math/fft.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/angles.h"

// FFTW 3.3.10 was measured on 24 transforms that lie side by side as they do here, of lengths from 512 to 4096. With
// the plans of FFTW_ESTIMATE it takes 1.5 to 3.2 times as long as this code. With those of FFTW_MEASURE it takes 0.8
// to 1.6 times as long, but one plan then costs 0.2 to 0.7 s of processor time, as much as one to three maps of degree
// 511, and since the clock chooses between plans, the last bits of the result may change from run to run.
//
// Stockham's self-sorting passes: with `length` = n r split off as s groups, pass r reads x[q + s (p + m k)], k < r,
// m = n/r, and writes y[q + s (r p + j)] = w^(p j) sum over k of x_k exp(sign 2 pi i j k / r), w = exp(sign 2 pi i /
// n).
#ifndef GONIOCHROME_FFT_PASS
#define GONIOCHROME_FFT_PASS
namespace goniochrome::math::fft {
struct Pass {
  std::size_t r, m, run;  // run = s * lanes values lie together
  const double *x_re, *x_im;
  double *y_re, *y_im;
  const double *cosine, *sine;  // twiddles of this n are every `stride`-th of the table, sign applied to the sine
  std::size_t stride;
  double sign;
};
}  // namespace goniochrome::math::fft
#endif

HWY_BEFORE_NAMESPACE();
namespace goniochrome::math {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using fft::Pass;

// x_0 + x_1, and x_0 - x_1 times its twiddle.
void Radix2(const Pass& f) {
  const hn::ScalableTag<double> d;
  for (std::size_t p = 0; p < f.m; ++p) {
    const auto wr = hn::Set(d, f.cosine[p * f.stride]), wi = hn::Set(d, f.sign * f.sine[p * f.stride]);
    const std::size_t a = p * f.run, b = (p + f.m) * f.run, y = 2 * p * f.run;
    for (std::size_t i = 0; i < f.run; i += hn::Lanes(d)) {
      const auto ar = hn::LoadU(d, f.x_re + a + i), ai = hn::LoadU(d, f.x_im + a + i);
      const auto br = hn::LoadU(d, f.x_re + b + i), bi = hn::LoadU(d, f.x_im + b + i);
      hn::StoreU(hn::Add(ar, br), d, f.y_re + y + i);
      hn::StoreU(hn::Add(ai, bi), d, f.y_im + y + i);
      const auto er = hn::Sub(ar, br), ei = hn::Sub(ai, bi);
      hn::StoreU(hn::MulSub(er, wr, hn::Mul(ei, wi)), d, f.y_re + y + f.run + i);
      hn::StoreU(hn::MulAdd(er, wi, hn::Mul(ei, wr)), d, f.y_im + y + f.run + i);
    }
  }
}

// Two layers of sums and differences in registers; a factor of i is a swap of real and imaginary parts. Then the
// twiddles of the outputs 1 to 3.
void Radix4(const Pass& f) {
  const hn::ScalableTag<double> d;
  const auto sign = hn::Set(d, f.sign);
  for (std::size_t p = 0; p < f.m; ++p) {
    const auto w1r = hn::Set(d, f.cosine[p * f.stride]), w1i = hn::Set(d, f.sign * f.sine[p * f.stride]);
    const auto w2r = hn::Set(d, f.cosine[2 * p * f.stride]), w2i = hn::Set(d, f.sign * f.sine[2 * p * f.stride]);
    const auto w3r = hn::Set(d, f.cosine[3 * p * f.stride]), w3i = hn::Set(d, f.sign * f.sine[3 * p * f.stride]);
    const std::size_t a = p * f.run, step = f.m * f.run, y = 4 * p * f.run;
    for (std::size_t i = 0; i < f.run; i += hn::Lanes(d)) {
      const double *xr = f.x_re + a + i, *xi = f.x_im + a + i;
      const auto ar = hn::LoadU(d, xr), ai = hn::LoadU(d, xi);
      const auto br = hn::LoadU(d, xr + step), bi = hn::LoadU(d, xi + step);
      const auto cr = hn::LoadU(d, xr + 2 * step), ci = hn::LoadU(d, xi + 2 * step);
      const auto er = hn::LoadU(d, xr + 3 * step), ei = hn::LoadU(d, xi + 3 * step);
      const auto sr = hn::Add(ar, cr), si = hn::Add(ai, ci), tr = hn::Sub(ar, cr), ti = hn::Sub(ai, ci);
      const auto ur = hn::Add(br, er), ui = hn::Add(bi, ei);
      // i sign (b - e)
      const auto vr = hn::Mul(sign, hn::Sub(ei, bi)), vi = hn::Mul(sign, hn::Sub(br, er));
      double *yr = f.y_re + y + i, *yi = f.y_im + y + i;
      hn::StoreU(hn::Add(sr, ur), d, yr);
      hn::StoreU(hn::Add(si, ui), d, yi);
      const auto store = [&](auto zr, auto zi, auto wr, auto wi, std::size_t j) HWY_ATTR {
        hn::StoreU(hn::MulSub(zr, wr, hn::Mul(zi, wi)), d, yr + j * f.run);
        hn::StoreU(hn::MulAdd(zr, wi, hn::Mul(zi, wr)), d, yi + j * f.run);
      };
      store(hn::Add(tr, vr), hn::Add(ti, vi), w1r, w1i, 1);
      store(hn::Sub(sr, ur), hn::Sub(si, ui), w2r, w2i, 2);
      store(hn::Sub(tr, vr), hn::Sub(ti, vi), w3r, w3i, 3);
    }
  }
}

// A small odd r: the points once through registers, r^2 products with the r-th roots of unity, then the twiddles.
template <std::size_t R>
void OddRadix(const Pass& f) {
  const hn::ScalableTag<double> d;
  for (std::size_t p = 0; p < f.m; ++p)
    for (std::size_t i = 0; i < f.run; i += hn::Lanes(d)) {
      hn::Vec<decltype(d)> xr[R], xi[R];
      for (std::size_t k = 0; k < R; ++k) {
        xr[k] = hn::LoadU(d, f.x_re + (p + f.m * k) * f.run + i);
        xi[k] = hn::LoadU(d, f.x_im + (p + f.m * k) * f.run + i);
      }
      for (std::size_t j = 0; j < R; ++j) {
        auto sum_r = xr[0], sum_i = xi[0];
        for (std::size_t k = 1; k < R; ++k) {
          const std::size_t turn = j * k % R * f.m * f.stride;
          const auto wr = hn::Set(d, f.cosine[turn]), wi = hn::Set(d, f.sign * f.sine[turn]);
          sum_r = hn::MulAdd(xr[k], wr, hn::NegMulAdd(xi[k], wi, sum_r));
          sum_i = hn::MulAdd(xr[k], wi, hn::MulAdd(xi[k], wr, sum_i));
        }
        const auto wr = hn::Set(d, f.cosine[j * p * f.stride]), wi = hn::Set(d, f.sign * f.sine[j * p * f.stride]);
        hn::StoreU(hn::MulSub(sum_r, wr, hn::Mul(sum_i, wi)), d, f.y_re + (R * p + j) * f.run + i);
        hn::StoreU(hn::MulAdd(sum_r, wi, hn::Mul(sum_i, wr)), d, f.y_im + (R * p + j) * f.run + i);
      }
    }
}

// Any other prime: r^2 products a point.
void AnyRadix(const Pass& f) {
  const hn::ScalableTag<double> d;
  for (std::size_t p = 0; p < f.m; ++p)
    for (std::size_t j = 0; j < f.r; ++j)
      for (std::size_t i = 0; i < f.run; i += hn::Lanes(d)) {
        auto sum_r = hn::Zero(d), sum_i = hn::Zero(d);
        for (std::size_t k = 0; k < f.r; ++k) {
          // w^(p j) exp(sign 2 pi i j k / r) = exp(sign 2 pi i j (p + m k) / n)
          const std::size_t turn = j * (p + f.m * k) % (f.r * f.m) * f.stride;
          const auto wr = hn::Set(d, f.cosine[turn]), wi = hn::Set(d, f.sign * f.sine[turn]);
          const auto xr = hn::LoadU(d, f.x_re + (p + f.m * k) * f.run + i);
          const auto xi = hn::LoadU(d, f.x_im + (p + f.m * k) * f.run + i);
          sum_r = hn::MulAdd(xr, wr, hn::NegMulAdd(xi, wi, sum_r));
          sum_i = hn::MulAdd(xr, wi, hn::MulAdd(xi, wr, sum_i));
        }
        hn::StoreU(sum_r, d, f.y_re + (f.r * p + j) * f.run + i);
        hn::StoreU(sum_i, d, f.y_im + (f.r * p + j) * f.run + i);
      }
}

void RunPass(const Pass& f) {
  if (f.r == 4) return Radix4(f);
  if (f.r == 2) return Radix2(f);
  if (f.r == 3) return OddRadix<3>(f);
  if (f.r == 5) return OddRadix<5>(f);
  AnyRadix(f);
}

}  // namespace HWY_NAMESPACE
}  // namespace goniochrome::math
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace goniochrome::math {

HWY_EXPORT(RunPass);

Fft::Fft(std::size_t length) : length_(length), cosine_(length), sine_(length) {
  for (std::size_t k = 0; k < length; ++k) {
    cosine_[k] = std::cos(2 * kPi * static_cast<double>(k) / static_cast<double>(length));
    sine_[k] = std::sin(2 * kPi * static_cast<double>(k) / static_cast<double>(length));
  }
  std::size_t rest = length;
  for (const std::size_t r : {4, 2, 3, 5})
    for (; rest % r == 0; rest /= r) radices_.push_back(r);
  for (std::size_t r = 7; rest > 1; r += 2)
    for (; rest % r == 0; rest /= r) radices_.push_back(r);
}

// One pass for each factor, from one pair of arrays to the other; what ends in the scratch arrays is copied back.
void Fft::transform(int sign, std::size_t lanes, double* re, double* im, double* scratch_re, double* scratch_im) const {
  double *from_re = re, *from_im = im, *to_re = scratch_re, *to_im = scratch_im;
  std::size_t n = length_, s = 1;
  for (const std::size_t r : radices_) {
    const fft::Pass pass = {r,
                            n / r,
                            s * lanes,
                            from_re,
                            from_im,
                            to_re,
                            to_im,
                            cosine_.data(),
                            sine_.data(),
                            s,
                            static_cast<double>(sign)};
    HWY_DYNAMIC_DISPATCH(RunPass)(pass);
    std::swap(from_re, to_re);
    std::swap(from_im, to_im);
    n /= r;
    s *= r;
  }
  if (from_re == re) return;
  std::copy(from_re, from_re + length_ * lanes, re);
  std::copy(from_im, from_im + length_ * lanes, im);
}

std::size_t fast_length(std::size_t least, std::size_t multiple) {
  for (std::size_t n = (least + multiple - 1) / multiple * multiple;; n += multiple) {
    std::size_t rest = n;
    for (const std::size_t r : {2, 3, 5})
      while (rest % r == 0) rest /= r;
    if (rest == 1) return n;
  }
}

}  // namespace goniochrome::math
#endif
