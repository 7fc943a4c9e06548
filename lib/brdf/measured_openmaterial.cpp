// Tables of ASAM OpenMATERIAL 3D: JSON, whose brdf.lookupTable has rows of wavelength (m), angle of incidence, exit
// angle, azimuth of the exit from the incidence (rad) and f (1/sr). The azimuth is taken between the directions to
// light and viewer, so that pi is the side of the mirror direction.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "base/angles.h"
#include "base/json.h"
#include "base/text.h"
#include "brdf/internal/measured_formats.h"
#include "brdf/internal/scattered_brdf.h"

namespace goniochrome::brdf {

namespace {

constexpr std::size_t kTableColumns = 5;
using TableRow = std::array<double, kTableColumns>;  // wavelength, incidence, exit, azimuth, f; NaN for null

// Hears the JSON of a table as it is read, without keeping it as a tree.
class TableListener : public nlohmann::json_sax<nlohmann::json> {
 public:
  std::string name, version;
  std::vector<TableRow> rows;
  std::vector<double> wavelengths;  // m, of the list beside the table
  std::string fault;

  bool null() override { return number(std::numeric_limits<double>::quiet_NaN()); }
  bool boolean(bool) override { return in_row() ? fail("holds a truth value where a number stands") : true; }
  bool number_integer(number_integer_t value) override { return number(static_cast<double>(value)); }
  bool number_unsigned(number_unsigned_t value) override { return number(static_cast<double>(value)); }
  bool number_float(number_float_t value, const string_t&) override { return number(value); }
  bool binary(binary_t&) override { return true; }
  bool string(string_t& value) override {
    if (in_row()) return fail("holds a text where a number stands");
    if (objects_ == 2 && section_ == "metadata" && key_ == "name") name = value;
    if (objects_ == 2 && section_ == "metadata" && key_ == "openMaterial3dVersion") version = value;
    return true;
  }
  bool start_object(std::size_t) override { return ++objects_ < kDeepest; }
  bool end_object() override { return --objects_, true; }
  bool key(string_t& value) override {
    if (objects_ == 1) section_ = value;
    key_ = value;
    return true;
  }
  bool start_array(std::size_t) override {
    if (++arrays_ == 2 && is_table()) count_ = 0;
    return arrays_ < kDeepest;
  }
  bool end_array() override {
    const bool ends_row = in_row();
    --arrays_;
    if (!ends_row) return true;
    if (count_ != kTableColumns) return fail(fmt::format("has {} numbers, and {} make a row", count_, kTableColumns));
    rows.push_back(row_);
    return true;
  }
  bool parse_error(std::size_t position, const std::string&, const nlohmann::detail::exception&) override {
    if (fault.empty()) fault = fmt::format("is no whole JSON: it breaks off at byte {}", position);
    return false;
  }

 private:
  static constexpr int kDeepest = 64;

  bool is_table() const { return objects_ == 2 && section_ == "brdf" && key_ == "lookupTable"; }
  bool in_row() const { return is_table() && arrays_ == 2; }
  bool fail(const std::string& why) {
    fault = fmt::format("row {} of lookupTable {}", rows.size() + 1, why);
    return false;
  }
  bool number(double value) {
    if (objects_ == 2 && section_ == "brdf" && key_ == "wavelengths") wavelengths.push_back(value);
    if (!in_row()) return true;
    if (count_ < kTableColumns) row_[count_] = value;
    ++count_;
    return true;
  }

  int objects_ = 0, arrays_ = 0;
  std::string section_, key_;
  TableRow row_{};
  std::size_t count_ = 0;
};

double nanometers(double wavelength_m) {
  return std::round(wavelength_m * 1e12) / 1e3;
}

// A finding where the list of wavelengths, which a file need not have, is another than that of the rows; else "".
std::string contradiction(const std::vector<double>& list_m, const std::map<double, std::size_t>& of_rows) {
  std::string rest;
  std::set<double> listed;
  for (const double wavelength_m : list_m) listed.insert(nanometers(wavelength_m));
  const auto differ = [&](double nm, const char* where) { rest = fmt::format("{} nm stands {}", shortest(nm), where); };
  for (const double nm : listed)
    if (rest.empty() && !of_rows.contains(nm)) differ(nm, "in its list of wavelengths and in no row of its table");
  for (const auto& [nm, none] : of_rows)
    if (rest.empty() && !listed.empty() && !listed.contains(nm))
      differ(nm, "in its table and not in its list of wavelengths");
  return rest.empty() ? "" : rest + ": the table counts";
}

// Error, without the file: a row is out of range.
Result<void> check_row(const TableRow& row, std::size_t number) {
  constexpr double kRounding_rad = 1e-5;
  const auto bad = [&](const char* what, double value, const char* wanted) {
    return input_error("row {} of lookupTable has {} {}: give {}", number, what, shortest(value), wanted);
  };
  if (!(row[0] >= 1e-9 && row[0] <= 0.01716)) return bad("the wavelength", row[0], "meters");
  if (!(row[1] >= 0 && row[1] <= kPi / 2 + kRounding_rad))
    return bad("the incidence", row[1], "radians from the normal");
  if (!(row[2] >= 0 && row[2] <= kPi / 2 + kRounding_rad)) return bad("the exit", row[2], "radians from the normal");
  if (!(std::abs(row[3]) <= 2 * kPi + kRounding_rad)) return bad("the azimuth", row[3], "radians");
  if (!(row[4] >= 0 && row[4] <= 1e12)) return bad("the BRDF", row[4], "0 or more, in 1/sr");
  return {};
}

bool looks_openmaterial(std::string_view path, std::string_view head) {
  const bool is_json = trimmed(head).starts_with('{');
  return is_json && (lower(path).ends_with(".xompt") || head.find("OpenMATERIAL") != std::string_view::npos);
}

Result<MeasuredPointer> read_openmaterial(const std::string& path, std::string_view bytes) {
  TableListener table;
  const bool is_whole = nlohmann::json::sax_parse(bytes, &table);
  if (!is_whole) return input_error("{}: {}", path, table.fault.empty() ? "is nested too deeply" : table.fault);
  if (!table.version.empty() && !table.version.starts_with("1."))
    return input_error("{}: is of OpenMATERIAL 3D {}, and versions 1.x are read: export it as one of these", path,
                       table.version);
  if (table.rows.empty())
    return input_error("{}: has no brdf with a lookupTable: of OpenMATERIAL the tables of BRDFs are read", path);
  MeasuredTraits traits{.format = "openmaterial", .description = table.name, .scattered = true};
  std::map<double, std::size_t> wavelengths;
  std::map<std::array<double, 3>, std::map<double, double>> spectra;  // of the directions, in their order
  std::size_t unknown = 0, repeated = 0;
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const TableRow& row = table.rows[i];
    if (std::ranges::any_of(row, [](double value) { return std::isnan(value); })) {
      ++unknown;
      continue;
    }
    if (const auto checked = check_row(row, i + 1); !checked.ok())
      return input_error("{}: {}", path, checked.error().message);
    const double nm = nanometers(row[0]);
    wavelengths[nm] = 0;
    const auto [kept, is_new] = spectra[{row[1], row[2], row[3]}].try_emplace(nm, row[4]);
    repeated += !is_new && kept->second != row[4];
  }
  if (unknown == table.rows.size()) return input_error("{}: has null in every row of its lookupTable", path);
  table.rows.clear();
  if (wavelengths.size() < 2)
    return input_error("{}: has {} wavelength: a color takes two or more in the visible", path, wavelengths.size());
  for (const auto& [nm, none] : wavelengths) traits.wavelengths_nm.push_back(nm);
  std::vector<ScatteredRow> rows;
  double negative_square = 0;
  for (const auto& [angles, spectrum] : spectra) {
    if (spectrum.size() != wavelengths.size()) continue;
    ScatteredRow row{{direction(angles[0], 0), direction(angles[1], angles[2])}, {}};
    for (const auto& [nm, f] : spectrum) {
      count_sample(f, traits, negative_square);
      row.f.push_back(f);
    }
    rows.push_back(std::move(row));
  }
  const std::size_t partial = spectra.size() - rows.size();
  if (rows.empty())
    return input_error("{}: has no pair of directions with all of its {} wavelengths", path, wavelengths.size());
  if (const std::string differs = contradiction(table.wavelengths, wavelengths); !differs.empty())
    traits.findings.push_back(differs);
  if (repeated > 0)
    traits.findings.push_back(fmt::format(
        "{} rows repeat a wavelength and its directions with another BRDF: the first row counts", repeated));
  if (unknown > 0) traits.findings.push_back(fmt::format("{} rows have null, and were left out", unknown));
  if (partial > 0)
    traits.findings.push_back(fmt::format("{} pairs of directions lack wavelengths, and were left out", partial));
  return scattered_brdf(std::move(traits), std::move(rows));
}

}  // namespace

const MeasuredFormat kOpenMaterial = {looks_openmaterial, read_openmaterial, "OpenMATERIAL .xompt"};

}  // namespace goniochrome::brdf
