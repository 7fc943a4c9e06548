// The objects of a CxF3 file as they stand, and the paints that become of them.
#pragma once

#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "formats/imported.h"
#include "formats/internal/spectral_rows.h"
#include "paint/paint.h"

namespace goniochrome::formats {

// One value of an object, as it stands: Lab, or what is to become it.
struct CxfColor {
  enum class Kind { kLab, kXyz, kSpectrum };
  Kind kind = Kind::kLab;
  std::string specification = {};
  color::Lab lab = {};
  color::Xyz xyz = {};  // Y = 100 of the perfect diffuser
  std::vector<double> spectrum = {};
  double first_nm = 0, step_nm = 0;  // of the spectrum, where it says so itself
  std::vector<double> nm = {};       // of a spectrum with points of its own
};

struct CxfObject {
  paint::Paint paint;
  std::string joined;  // the paint whose angle this object is: our tag
  std::string date;
  std::vector<CxfColor> colors;
  std::vector<std::string> unread;  // kinds of color values that are not read
  bool bad = false;                 // it had an error that is passed over
};

struct CxfSpecification {
  color::ViewingCondition condition{"", 0};
  std::vector<paint::Geometry> angles;
  std::string other;               // a geometry without aspecular angles
  std::string unlike_reflectance;  // the measurement type, where it is another
  std::string instrument, serial;
  std::vector<std::string> remarks;  // on what it states of its readings
  double first_nm = 0, step_nm = 0;
};

// Turns objects into paints.
class CxfResolver {
 public:
  CxfResolver(const std::map<std::string, CxfSpecification>& specifications, Remarks& remarks,
              const ImportOptions& options)
      : specifications_(specifications), options_(options), remarks_(remarks) {}

  // `unit` makes factors of the values of spectra. `has_spectra` says whether the file has any.
  void set_unit(double unit, bool has_spectra) {
    unit_ = unit;
    xyz_scale_.set(options_.scale, has_spectra);
  }
  void add(CxfObject object);
  void finish();
  // Once the file has ended.
  void note_scale() { xyz_scale_.finish(remarks_); }

  // The paints that are complete, in order.
  std::deque<paint::Paint>& paints() { return paints_; }

 private:
  bool is_sound(CxfColor& color);
  void keep_spectrum(const CxfColor& color, std::size_t n, std::size_t k);
  void place(const CxfColor& color, std::size_t n, std::size_t k);
  color::ViewingCondition stated(const CxfSpecification& specification);
  std::optional<color::Lab> lab_of(const CxfColor& color, const CxfSpecification& specification,
                                   const color::ViewingCondition& condition);

  const std::map<std::string, CxfSpecification>& specifications_;
  const ImportOptions& options_;
  Remarks& remarks_;
  UniqueNames names_;
  double unit_ = 1;
  XyzScale xyz_scale_;
  std::optional<OpenPaint> open_;
  std::string joined_;
  std::vector<std::string> unread_;  // of the open paint
  std::deque<paint::Paint> paints_;
};

}  // namespace goniochrome::formats
