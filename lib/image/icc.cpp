// Little CMS evaluates the profile in single precision, without bounds, so that colors outside of a gamut stay as they
// are. The rendering intent is relative colorimetric, without black point compensation: the light is what the medium
// sends back relative to its own white.
//
// The float pipeline of Little CMS 2.14 takes 170 to 320 ns a pixel for a matrix profile. Such a profile is additive,
// since each signal passes its own curve and a matrix follows. Therefore the curve of each channel is tabulated once,
// at 4097 signals, and a pixel is the sum of three look-ups times their colors: 13 ns. A picture with a table profile
// passes Little CMS pixel by pixel.
#include "image/icc.h"

#include <lcms2.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <memory>
#include <numbers>
#include <span>
#include <vector>

#include "base/parallel.h"
#include "color/color.h"

namespace goniochrome::image {

namespace {

constexpr color::Xyz kD50{0.9642, 1, 0.8249};  // the white of the profile connection space, ICC.1:2010 6.3.4.3
constexpr int kTableSteps = 4096;
constexpr std::size_t kConvertedRows = 16;

struct CloseProfile {
  void operator()(void* profile) const { cmsCloseProfile(profile); }
};
struct DeleteTransform {
  void operator()(void* transform) const { cmsDeleteTransform(transform); }
};
using Profile = std::unique_ptr<void, CloseProfile>;
using Transform = std::unique_ptr<void, DeleteTransform>;

// True if each signal passes a curve and a matrix follows. Tables come first where a profile has both.
bool is_additive(const Profile& profile) {
  if (cmsGetColorSpace(profile.get()) == cmsSigCmykData) return false;
  constexpr cmsTagSignature kTables[] = {cmsSigAToB0Tag, cmsSigAToB1Tag, cmsSigAToB2Tag, cmsSigDToB0Tag,
                                         cmsSigDToB1Tag, cmsSigDToB2Tag, cmsSigDToB3Tag};
  return std::ranges::none_of(kTables, [&](cmsTagSignature tag) { return cmsIsTag(profile.get(), tag); });
}

// From signals to the working space. `channels` is 1, 3 or 4.
class SignalsToLight {
 public:
  SignalsToLight(Transform to_pcs, std::size_t channels) : to_pcs_(std::move(to_pcs)), channels_(channels) {
    const color::Xyz white = color::xyz_d65_from_rgb({1, 1, 1});
    const color::Xyz axes[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (int k = 0; k < 3; ++k) columns_[k] = color::rgb_from_xyz_d65(adapted(axes[k], kD50, white));
  }
  std::size_t channels() const { return channels_; }

  // Writes three numbers to `light` for each group of channels() signals, which are changed.
  void operator()(std::span<float> signals, float* light) const {
    if (channels_ == 4)
      for (float& signal : signals) signal *= 100;  // Little CMS takes percents of ink
    const std::size_t count = signals.size() / channels_;
    cmsDoTransform(to_pcs_.get(), signals.data(), light, static_cast<cmsUInt32Number>(count));
    for (std::size_t i = 0; i < count; ++i, light += 3) {
      const color::Rgb rgb = static_cast<double>(light[0]) * columns_[0] + static_cast<double>(light[1]) * columns_[1] +
                             static_cast<double>(light[2]) * columns_[2];
      for (int c = 0; c < 3; ++c) light[c] = static_cast<float>(rgb[c]);
    }
  }

 private:
  Transform to_pcs_;
  std::size_t channels_;
  std::array<color::Rgb, 3> columns_;  // of the matrix from XYZ relative to D50 to the working space
};

// A channel of an additive profile adds this to the light of black: a curve, tabulated at evenly spaced signals, times
// a color.
struct ProfileChannel {
  std::vector<float> curve;
  std::array<float, 3> color{};

  float value(float signal) const {
    const float place = std::clamp(signal, 0.0F, 1.0F) * kTableSteps;
    const int i = std::min(static_cast<int>(place), kTableSteps - 1);
    return curve[i] + (place - static_cast<float>(i)) * (curve[i + 1] - curve[i]);
  }
};

// Takes light at evenly spaced signals, three numbers each: the number that changes most gives the curve, and the place
// where it changes most gives the color.
ProfileChannel channel_of(const std::vector<float>& light) {
  const auto change = [&](std::size_t i) { return light[i] - light[i % 3]; };
  std::size_t most = 0;
  for (std::size_t i = 0; i < light.size(); ++i)
    if (std::abs(change(i)) > std::abs(change(most))) most = i;
  ProfileChannel channel;
  channel.curve.resize(light.size() / 3);
  if (change(most) == 0) return channel;
  for (std::size_t k = 0; k < 3; ++k) channel.color[k] = change(most - most % 3 + k);
  for (std::size_t i = 0; i < channel.curve.size(); ++i) channel.curve[i] = change(3 * i + most % 3) / change(most);
  return channel;
}

template <std::size_t kChannels>
struct AdditiveLight {
  std::array<ProfileChannel, kChannels> channels;
  std::array<float, 3> black{};

  explicit AdditiveLight(const SignalsToLight& to_light) {
    for (std::size_t c = 0; c < kChannels; ++c) {
      std::vector<float> signals(kChannels * (kTableSteps + 1), 0.0F), light(3 * (kTableSteps + 1));
      for (std::size_t i = 0; i <= kTableSteps; ++i)
        signals[i * kChannels + c] = static_cast<float>(i) / static_cast<float>(kTableSteps);
      to_light(signals, light.data());
      std::copy_n(light.begin(), 3, black.begin());
      channels[c] = channel_of(light);
    }
  }

  // Writes the light of one pixel, whose signals stand `step` apart.
  void operator()(const float* signals, std::size_t step, float* light) const {
    std::array<float, 3> sum = black;
    for (std::size_t c = 0; c < kChannels; ++c) {
      const float value = channels[c].value(signals[c * step]);
      for (int k = 0; k < 3; ++k) sum[k] += value * channels[c].color[k];
    }
    std::copy_n(sum.begin(), 3, light);
  }
};

// Calls row(signals, light) for each row of the image.
template <class Row>
Image rows_converted(const Image& from, const Row& row) {
  const auto width = static_cast<std::size_t>(from.width), channels = static_cast<std::size_t>(from.channels);
  Image to = even_image(from.width, from.height, 3);
  parallel_for(static_cast<std::size_t>(from.height), kConvertedRows, [&](std::size_t begin, std::size_t end) {
    for (std::size_t y = begin; y < end; ++y) row(&from.data[y * width * channels], &to.data[y * width * 3]);
  });
  return to;
}

// The signals of a gray image stand for all channels of the profile.
std::size_t signal_step(const Image& image) {
  return color_channels(image) == 1 ? 0 : 1;
}

template <std::size_t kChannels>
Image through_curves(const Image& from, const SignalsToLight& to_light) {
  const AdditiveLight<kChannels> light_of(to_light);
  const std::size_t step = signal_step(from);
  return rows_converted(from, [&](const float* signals, float* light) {
    for (int x = 0; x < from.width; ++x, signals += from.channels, light += 3) light_of(signals, step, light);
  });
}

Image pixel_by_pixel(const Image& from, const SignalsToLight& to_light) {
  const std::size_t step = signal_step(from);
  return rows_converted(from, [&](const float* pixel, float* light) {
    std::vector<float> signals;
    for (int x = 0; x < from.width; ++x, pixel += from.channels)
      for (std::size_t c = 0; c < to_light.channels(); ++c) signals.push_back(pixel[c * step]);
    to_light(signals, light);
  });
}

Image converted(const Image& from, const Profile& profile, const SignalsToLight& to_light, bool whole_numbers) {
  if (!is_additive(profile) || !whole_numbers) return pixel_by_pixel(from, to_light);
  return to_light.channels() == 1 ? through_curves<1>(from, to_light) : through_curves<3>(from, to_light);
}

const char* pixels_name(int channels) {
  return channels == 1 ? "gray" : channels == 3 ? "RGB" : "CMYK";
}

// Colors to the inks of a printer and back.
class InkRoundTrip {
 public:
  InkRoundTrip(const Profile& profile, bool is_cmyk)
      : lab_(cmsCreateLab4Profile(nullptr)),
        to_inks_(cmsCreateTransform(lab_.get(), TYPE_Lab_DBL, profile.get(), is_cmyk ? TYPE_CMYK_DBL : TYPE_RGB_DBL,
                                    INTENT_RELATIVE_COLORIMETRIC, cmsFLAGS_NOOPTIMIZE)),
        to_lab_(cmsCreateTransform(profile.get(), is_cmyk ? TYPE_CMYK_DBL : TYPE_RGB_DBL, lab_.get(), TYPE_Lab_DBL,
                                   INTENT_RELATIVE_COLORIMETRIC, cmsFLAGS_NOOPTIMIZE)) {}
  bool ok() const { return to_inks_ && to_lab_; }

  // True if a color relative to D65 comes back.
  bool shows(const color::Lab& lab) const {
    const color::Xyz d65 = color::xyz_d65_from_rgb({1, 1, 1});
    const color::Lab wanted = color::lab_from_xyz(color::adapted(color::xyz_from_lab(lab, d65), d65, kD50), kD50);
    const cmsCIELab asked = {wanted.L, wanted.a, wanted.b};
    double inks[4] = {};
    cmsCIELab back;
    cmsDoTransform(to_inks_.get(), &asked, inks, 1);
    cmsDoTransform(to_lab_.get(), inks, &back, 1);
    return color::delta_e_76(wanted, {back.L, back.a, back.b}) <= kPrinted_de76;
  }

 private:
  static constexpr double kPrinted_de76 = 1.5;  // tables of 8 and 16 bits err by less
  Profile lab_;
  Transform to_inks_, to_lab_;
};

// The last number on the way from one that holds to one that does not, to a thousandth of the way.
template <class Holds>
double last_of(double inside, double outside, const Holds& holds) {
  for (int step = 0; step < 10; ++step) {
    const double middle = 0.5 * (inside + outside);
    (holds(middle) ? inside : outside) = middle;
  }
  return inside;
}

}  // namespace

Result<color::PrintGamut> print_gamut(const std::string& bytes, const std::string& name) {
  const Profile profile(cmsOpenProfileFromMem(bytes.data(), static_cast<cmsUInt32Number>(bytes.size())));
  if (!profile) return input_error("{}: it is no ICC profile: name the profile of a printer", name);
  const cmsColorSpaceSignature space = cmsGetColorSpace(profile.get());
  const bool is_printer = cmsGetDeviceClass(profile.get()) == cmsSigOutputClass &&
                          (space == cmsSigCmykData || space == cmsSigRgbData) &&
                          cmsIsIntentSupported(profile.get(), INTENT_RELATIVE_COLORIMETRIC, LCMS_USED_AS_OUTPUT) != 0;
  const InkRoundTrip inks(profile, space == cmsSigCmykData);
  if (!is_printer || !inks.ok())
    return input_error("{}: it is no profile of a printer with inks of RGB or CMYK: name one of the class prtr", name);
  color::PrintGamut gamut;
  gamut.name = name;
  const auto is_gray = [&](double lightness) { return inks.shows({lightness, 0, 0}); };
  if (!is_gray(50)) return input_error("{}: it prints no gray: name another profile", name);
  constexpr double kInside = 0.5;  // so that the tolerance is not used up where rows of chromas end
  gamut.darkest = last_of(50, 0, is_gray) + kInside;
  gamut.lightest = last_of(50, 100, is_gray) - kInside;
  for (int i = 0; i < color::PrintGamut::kLightnesses; ++i)
    for (int j = 0; j < color::PrintGamut::kHues; ++j) {
      const double share = 1.0 * i / (color::PrintGamut::kLightnesses - 1),
                   hue = 2 * std::numbers::pi * j / color::PrintGamut::kHues;
      const double lightness = std::lerp(gamut.darkest, gamut.lightest, share);
      gamut.chroma.push_back(last_of(0, 160, [&](double chroma) {
        return inks.shows({lightness, chroma * std::cos(hue), chroma * std::sin(hue)});
      }));
    }
  return Result(std::move(gamut));
}

int color_channels(const Image& image) {
  const auto& names = image.channel_names;
  constexpr const char* kInks[] = {"C", "M", "Y", "K"};
  if (names.size() >= 4 && std::equal(std::begin(kInks), std::end(kInks), names.begin())) return 4;
  return image.channels < 3 ? 1 : 3;
}

Result<Image> image_through_icc(const Image& image, const std::string& bytes, const std::string& name,
                                bool whole_numbers) {
  const auto damaged = [&] { return input_error("{}: its ICC profile is damaged: convert the image to sRGB", name); };
  const Profile profile(cmsOpenProfileFromMem(bytes.data(), static_cast<cmsUInt32Number>(bytes.size())));
  if (!profile || bytes.size() < 20) return damaged();
  const std::string space = bytes.substr(16, 4);
  const cmsColorSpaceSignature signature = cmsGetColorSpace(profile.get());
  const int channels = signature == cmsSigGrayData   ? 1
                       : signature == cmsSigRgbData  ? 3
                       : signature == cmsSigCmykData ? 4
                                                     : 0;
  if (channels == 0) {
    if (!std::ranges::all_of(space, [](unsigned char c) { return std::isprint(c); })) return damaged();
    return input_error("{}: its ICC profile is for {}: convert the image to sRGB", name, space);
  }
  const int pixels = color_channels(image);
  if (pixels != channels && !(pixels == 1 && channels == 3))
    return input_error("{}: its ICC profile is for {} and its pixels are read as {}: convert the image to sRGB", name,
                       pixels_name(channels), pixels_name(pixels));
  constexpr cmsUInt32Number kFormats[] = {0, TYPE_GRAY_FLT, 0, TYPE_RGB_FLT, TYPE_CMYK_FLT};
  const Profile pcs(cmsCreateXYZProfile());
  Transform transform(cmsCreateTransform(profile.get(), kFormats[channels], pcs.get(), TYPE_XYZ_FLT,
                                         INTENT_RELATIVE_COLORIMETRIC, cmsFLAGS_NOCACHE));  // rows run side by side
  if (!transform) return damaged();
  Image light = converted(image, profile, SignalsToLight(std::move(transform), static_cast<std::size_t>(channels)),
                          whole_numbers);
  if (!std::ranges::all_of(light.data, [](float v) { return std::isfinite(v); })) return damaged();
  return light;
}

}  // namespace goniochrome::image
