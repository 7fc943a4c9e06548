// Paints in CxF3 (ISO 17972-1), and what CxF2 says of them, whose colors have no geometry. Such a file lists objects
// and their colors, and each color refers to a specification of illuminant, observer and geometry. A paint is an
// object; each of its angles has a specification of its own, which is a MultiAngle with one BRDFAngle.
// goniochrome-paint(5).
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/file.h"
#include "base/result.h"
#include "formats/imported.h"
#include "paint/paint.h"

namespace goniochrome::formats {

// True if a file that begins with `head` is CxF.
bool looks_cxf(std::string_view head);

// Reads objects with CIELAB, CIELCh or reflectance spectra at angles, paint by paint. Spectra are integrated under the
// illuminant and observer of their specification, or else of the options. One value under a specification of several
// angles stands for all of them. What cannot be placed is left out with a warning.
//
// The specifications stand at the end of the file. It is read a first time for them, and a second time for the objects,
// so that a library of any size passes in constant memory.
class CxfReader {
 public:
  // Reads the specifications. Error: the file is no CxF3, is no XML, or has a specification that cannot be read; with
  // file and line.
  static Result<CxfReader> open(InputFile input, const ImportOptions& options);
  CxfReader(CxfReader&&) noexcept;
  ~CxfReader();

  // The next paint, or nothing at the end. An error names file and line. Where the options say so, it loses one object,
  // and next() goes on behind it; otherwise it is final.
  Result<std::optional<paint::Paint>> next();

  // Warnings about parts that were left out or assumed so far.
  std::vector<std::string> warnings() const;

 private:
  struct State;
  explicit CxfReader(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

// All paints of a file.
Result<ImportedPaints> read_cxf(InputFile input, const ImportOptions& options);

// Writes each paint as it comes.
class CxfWriter {
 public:
  struct Info {
    std::string creator, description;   // who made the file, and how
    std::string created;                // date and time as in 2026-11-21T10:00:00Z
    bool one_object_per_angle = false;  // for programs that read only the first Lab of an object
  };
  static Result<CxfWriter> begin(OutputFile file, const Info& info);
  // A tag `curve` names the geometries `from_curve`. A reading with a spectrum is written with it. Error: a paint
  // without readings, or an L* below 0, which CxF3 does not allow.
  Result<void> write(const paint::Paint& paint, const std::vector<paint::Geometry>& from_curve = {});
  Result<void> finish();
  // Which spectra CxF3 does not allow, and were left out.
  std::vector<std::string> warnings() const { return remarks_.lines(); }

 private:
  struct Specification {
    color::ViewingCondition condition;
    std::string instrument, serial;
    paint::Geometry geometry;
    double from_nm = 0, step_nm = 0;  // of the spectra; 0 where there are none
    friend bool operator==(const Specification&, const Specification&) = default;
  };
  CxfWriter(OutputFile file, Info info) : file_(std::move(file)), info_(std::move(info)) {}
  std::size_t number_of(const Specification& specification);
  std::string color_values(const paint::Measurement& measurement, const paint::LabReading& row);
  void note_spectra_left_out(const paint::Paint& paint);
  std::string object(const paint::Paint& paint, const std::vector<paint::LabReading>& rows, const std::string& part,
                     bool first, const std::string& curve);

  OutputFile file_;
  Info info_;
  std::vector<Specification> specifications_;  // in the order of first use; a library has few
  std::size_t objects_ = 0;
  Remarks remarks_;
};

}  // namespace goniochrome::formats
