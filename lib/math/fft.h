// These are Fourier transforms of any length, many at a time: element k of transform j is at [k * lanes + j], so that
// every pass runs over contiguous memory.
#pragma once

#include <cstddef>
#include <vector>

namespace goniochrome::math {

class Fft {
 public:
  explicit Fft(std::size_t length);
  std::size_t length() const { return length_; }

  // X_k = sum over n of x_n exp(sign 2 pi i k n / length), in place and not normalized, for `lanes` transforms (a
  // multiple of 8). `scratch_re` and `scratch_im` hold length * lanes values each.
  void transform(int sign, std::size_t lanes, double* re, double* im, double* scratch_re, double* scratch_im) const;

 private:
  std::size_t length_;
  std::vector<std::size_t> radices_;
  std::vector<double> cosine_, sine_;  // of 2 pi k / length
};

// Complex series side by side, with the memory to transform them.
struct Block {
  std::size_t lanes;
  std::vector<double> re, im, scratch_re, scratch_im;

  Block(std::size_t length, std::size_t n)
      : lanes(n), re(length * n, 0.0), im(length * n, 0.0), scratch_re(length * n), scratch_im(length * n) {}
  void transform(const Fft& fft, int sign) {
    fft.transform(sign, lanes, re.data(), im.data(), scratch_re.data(), scratch_im.data());
  }
};

// The smallest multiple of `multiple` that is at least `least` and has no prime factor above 5 beside its own.
std::size_t fast_length(std::size_t least, std::size_t multiple);

}  // namespace goniochrome::math
