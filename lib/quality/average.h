// Repeated readings of one paint as their mean, with what they scatter by at each geometry, and the readings that stand
// apart from the others. goniochrome-quality(7), "REPEATED READINGS".
#pragma once

#include <string>
#include <vector>

#include "base/result.h"
#include "paint/paint.h"

namespace goniochrome::quality {

// A reading is an outlier where its distance from the median color, by the CIE 1976 difference in the mean over the
// geometries, is more than kOutlierFactor times the median of these distances, and more than kOutlierFloor. For normal
// scatter in three dimensions that is 4.6 standard deviations, which one reading in 30,000 passes. Fewer than
// kFewestForOutliers readings have none.
inline constexpr double kOutlierFactor = 3, kOutlierFloor = 0.1;
inline constexpr std::size_t kFewestForOutliers = 4;

struct Scatter {
  paint::Geometry geometry;
  std::size_t readings = 0;
  color::Lab deviation;      // standard deviation of L*, a* and b*; 0 of one reading
  double mean_distance = 0;  // of the readings from their mean, CIE 1976
};

struct Outlier {
  std::size_t place = 0;  // among the readings
  double distance = 0, median_distance = 0;
};

struct Average {
  paint::Paint paint;
  std::vector<Scatter> scatter;  // by geometry
  std::vector<Outlier> outliers;
  std::size_t kept = 0;  // readings in the mean
};

// The mean of one or more readings, whose name, code and foreign elements are those of the first. Where all that have a
// geometry have a spectrum of it, at the same wavelengths, the spectra are averaged, and Lab is the color of their
// mean; elsewhere Lab is averaged. Gloss and textures are averaged where all readings have them. The date is the
// span of all dates, and the serial names all instruments. Error, which lacks the
// name: a reading without measurement; different illuminants, observers or instruments.
Result<Average> average(const std::vector<paint::Paint>& readings, bool drop_outliers);

// The name without the " (2)" or " (2026-11-27)" by which readers tell readings of one name apart.
std::string base_name(const std::string& name);

}  // namespace goniochrome::quality
