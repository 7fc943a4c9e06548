// Measured BRDFs in the file formats of the laboratories that measured them: MERL tables, Cornell spectra, NVIDIA
// MBSDF, RGL tensor files and tables of OpenMATERIAL. This header tells what a file says at a pair of directions, how
// far it can be trusted, and what a multi-angle instrument would have read. goniochrome-fitting(7), "MEASURED BRDFS".
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "base/vec3.h"
#include "color/color.h"
#include "color/spectrum.h"
#include "paint/geometry.h"

namespace goniochrome::brdf {

// Statements of the file about itself and its samples.
struct MeasuredTraits {
  std::string format = {};       // merl | cornell | mbsdf | rgl | openmaterial
  std::string description = {};  // the file's own words, or empty
  std::vector<double> wavelengths_nm =
      {};                   // one per channel; empty: linear Rec.709 RGB, seen under D65 by the 2 deg observer
  std::size_t samples = 0;  // numbers in the file that are values of f
  std::size_t negative = 0, zero = 0;      // of these
  double negative_rms = 0;                 // 1/sr, of the negative ones, where they are noise and not a mark
  bool symmetric = false;                  // the format stores f(a,b) and f(b,a) in one place
  bool noisy = false;                      // of RGB: values below 0 are noise, and no colors outside of Rec.709
  bool scattered = false;                  // the file lists directions, which samples() returns; else it is a grid
  std::vector<std::string> findings = {};  // oddities worth a warning
};

// f at one pair of directions.
struct MeasuredValue {
  std::vector<double> f = {};  // 1/sr per channel; noise may have left it negative
  double gap_deg = 0;          // widest step between the samples it was interpolated from; 0 where a sample stands
  double outside_deg = 0;      // how far outside the measured directions; the nearest sample was taken
  bool measured = true;        // false: the file has nothing there, f is 0
};

class MeasuredBrdf {
 public:
  virtual ~MeasuredBrdf() = default;
  const MeasuredTraits& traits() const { return traits_; }

  // f for unit directions above the surface (z > 0) in the frame of the sample. All formats here are isotropic, and a
  // pair and its mirror image get the same value.
  virtual MeasuredValue value(const Vec3& to_light, const Vec3& to_viewer) const = 0;

  // Pairs of directions at which to ask for reciprocity: a fixed set spread over both hemispheres, to 75 deg from the
  // normal and at least 15 deg from specular.
  virtual std::vector<paint::DirectionPair> probes() const;

  // Pairs of directions to fit a model to: the measured ones where the file holds scattered ones. Else lights at 0, 10,
  // ..., 70 deg from the normal and, for each, views to 80 deg from the normal on cones about its mirror direction,
  // dense near it, one side of the plane of incidence.
  virtual std::vector<paint::DirectionPair> samples() const;

 protected:
  explicit MeasuredBrdf(MeasuredTraits traits) : traits_(std::move(traits)) {}

 private:
  MeasuredTraits traits_;
};

// The names of these formats with the endings of their files, for help and messages: "MERL .binary, ... and Cornell
// .brdf".
std::string measured_formats();

// True if a file that begins with `head` (200 bytes are enough) is one of these formats; Cornell's text is told by its
// name's ending `.brdf`.
bool looks_measured(std::string_view path, std::string_view head);

// Reads a file of any of these formats, which are told apart by content. Errors name file, line or field. `bytes` are
// the whole content of a file that errors call `name`.
Result<std::unique_ptr<MeasuredBrdf>> read_measured(const std::string& path);
Result<std::unique_ptr<MeasuredBrdf>> read_measured(const std::string& name, std::string_view bytes);

// How far the data can be trusted.
struct MeasuredChecks {
  double negative_share = 0, zero_share = 0;  // of all samples
  double reciprocity_error = 0;               // median of |f(a,b) - f(b,a)| over their mean size, 0..2
  double reciprocity_if_f_cos = 0;            // the same had the file held f cos(theta_o)
  std::string values;      // "f" | "f_cos": what reciprocity speaks for | "symmetric": the format cannot tell
  double noise_floor = 0;  // reflectance factor below which a reading is noise
  double albedo_45 = 0;    // reflectance for light at 45 deg, without 10 deg about specular
  std::vector<std::string> warnings;
};
// The warnings tell how much of what an observer sees the spectra leave out.
MeasuredChecks checks(const MeasuredBrdf& brdf, const color::ViewingCondition& condition = {"D65", 2});

// Takes noise off reflectance factors in the channels of a file, and returns whether there was any: values below 0 of a
// spectrum, or of a noisy file. In other files RGB below 0 is a color outside of Rec.709, such as a deep yellow.
bool take_off_noise(const MeasuredTraits& traits, std::vector<double>& factors);

// XYZ (Y = 1: perfect diffuser) of reflectance factors in the channels of a file, and the white it is relative to.
class ChannelColorimeter {
 public:
  // Error: an illuminant or observer the data cannot be seen under (RGB knows D65/2 alone).
  static Result<ChannelColorimeter> make(const MeasuredTraits& traits, const color::ViewingCondition& condition);
  color::Xyz xyz(const std::vector<double>& reflectance) const;
  color::Xyz white() const { return meter_ ? meter_->white() : xyz({1, 1, 1}); }
  double held_share() const { return meter_ ? meter_->held_share() : 0; }

 private:
  std::optional<color::SpectralColorimeter> meter_;
};

// A reading of a multi-angle instrument.
struct MeasuredReading {
  paint::Geometry geometry;
  color::Lab lab;
  std::vector<double> factors = {};     // reflectance factors per channel of the file, without noise
  double gap_deg = 0, outside_deg = 0;  // of the value it came from
  bool negative = false;                // take_off_noise() found some
  bool noise = false;                   // Y is below the noise floor
};

struct MeasuredColor {
  color::ViewingCondition condition;
  double held_share = 0;  // of X, Y or Z from beyond the spectrum's ends (color/spectrum.h)
  std::vector<MeasuredReading> readings;
  std::vector<paint::Geometry> unmeasured;  // geometries the file has nothing for
};

struct MeasuredColorOptions {
  std::vector<paint::Geometry> geometries;
  color::ViewingCondition condition;
  double aperture_deg = 0;  // full angle of the detector's cone, averaged over; 0: one direction
  double noise_floor = 0;   // of checks()
};

// Lab at each geometry. Error: an illuminant or observer the data cannot be seen under (RGB knows D65/2 alone), or a
// geometry with a direction below the surface.
Result<MeasuredColor> measured_color(const MeasuredBrdf& brdf, const MeasuredColorOptions& options);

}  // namespace goniochrome::brdf
