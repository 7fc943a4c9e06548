// The CIE's tables: color-matching functions of both standard observers and illuminants at every 5 nm, and the
// functions at every nm.
#pragma once

#include <array>
#include <cstddef>

namespace goniochrome::color {

struct CieRow {
  double wavelength_nm;
  std::array<double, 3> observer_2;   // CIE 1931
  std::array<double, 3> observer_10;  // CIE 1964
  std::array<double, 3> illuminants;  // D65, D50, A, relative
};

constexpr int kCieRows = 85;
constexpr double kCieStart_nm = 360, kCieEnd_nm = 780, kCieStep_nm = 5;
extern const std::array<CieRow, kCieRows> kCieTable;

struct CieObserver {
  std::array<double, 3> observer_2, observer_10;
};

// At every nm from kCieStart_nm to 780 nm.
constexpr int kCieObserverRows = 421;
extern const std::array<CieObserver, kCieObserverRows> kCieObservers;

// The illuminants of the table above and of the one below, side by side.
constexpr std::array kIlluminantNames = {"D65",    "D50",     "A",        "C",      "D55",    "D75",    "F2",
                                         "F7",     "F11",     "F12",      "LED-B1", "LED-B2", "LED-B3", "LED-B4",
                                         "LED-B5", "LED-BH1", "LED-RGB1", "LED-V1", "LED-V2", "ID50",   "ID65"};

// Further illuminants at the same wavelengths, relative.
constexpr std::size_t kMoreIlluminants = kIlluminantNames.size() - 3;
extern const std::array<std::array<double, kMoreIlluminants>, kCieRows> kMoreIlluminantTable;

}  // namespace goniochrome::color
