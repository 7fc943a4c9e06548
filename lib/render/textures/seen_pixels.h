// The values of textures in pixels, before any light falls on it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "render/effects.h"
#include "render/textures/sbrdf_kernel.h"

namespace goniochrome::render {

// The textures in a band of rows of a picture: the points of each texture or level together, and for each the texels
// that it shows.
struct SeenBand {
  struct Point {
    std::uint32_t place = 0;  // its number among the places
    std::uint32_t end = 0;    // of its texels, which begin where those of the point before end
  };
  struct Bin {
    std::size_t texture = 0;
    int level = 0;
    std::vector<Point> points;
    std::vector<TexelShare> texels;  // those of each point sorted by shape
  };
  std::vector<Bin> bins;
  std::vector<float> bare;  // of each pixel, the part of the paint that is seen; empty where that is all or nothing

  Bin& bin(std::size_t texture, int level);
  void clear();  // but for the memory that it takes
  std::size_t bytes() const;
};

// The textures in the pixels of a view. From the second picture of a view on it is kept, as far as there is room, so
// that a picture in other light takes no more than the shading of the texels. Most views are drawn once, and keeping
// what they show would take time and memory for nothing.
class SeenPixels {
 public:
  // To be asked for bands of a view, of which there are so many; forgets them if they were made for anything else.
  void begin(std::uint64_t layer, const Effects& effects, double scale, std::size_t bands);
  // One band, made by see(band) if it is not known. Different ones may be asked for on many threads.
  template <class See>
  const SeenBand& band(std::size_t number, const See& see) {
    if (known_[number] == 0) see(bands_[number]), known_[number] = 1;
    return bands_[number];
  }
  // A band was shaded. Of a view that is seen again it is kept if all would fit in the bytes that there are for them if
  // they were as large.
  void done(std::size_t number) {
    if (!again_ || bands_[number].bytes() * bands_.size() > most_bytes_) bands_[number] = {}, known_[number] = 0;
  }
  // True if other pictures of the view may ask for what is seen in this one, with other pixels wanted.
  bool keeps() const { return again_; }
  void set_most_bytes(std::size_t most) { most_bytes_ = most; }
  // The view is another one.
  void forget() { forgotten_ = true; }

 private:
  struct Key {
    std::uint64_t layer = 0;
    bool texture = false, filter = false;
    std::uint32_t lobes = 0;
    double scale = 0;
    bool operator==(const Key&) const = default;
  };
  Key key_;
  std::vector<SeenBand> bands_;
  std::vector<char> known_;
  std::size_t most_bytes_ = 0;
  bool again_ = false, forgotten_ = false;
};

}  // namespace goniochrome::render
