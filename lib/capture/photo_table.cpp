#include "capture/photo_table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <optional>

#include "base/angles.h"
#include "base/csv_records.h"
#include "base/text.h"

namespace goniochrome::capture {

namespace {

constexpr std::array<const char*, 19> kColumns = {
    "image",     "light_x",        "light_y",         "light_z",   "camera_x",  "camera_y",  "camera_z",
    "exposure",  "light_distance", "camera_distance", "corner1_x", "corner1_y", "corner2_x", "corner2_y",
    "corner3_x", "corner3_y",      "corner4_x",       "corner4_y", "k1"};
enum Column { kImage, kLight, kCamera = 4, kExposure = 7, kLightDistance, kCameraDistance, kCorners, kLens = 18 };

// Where each of kColumns stands in a row; none for one that is not there.
using Places = std::array<std::optional<std::size_t>, kColumns.size()>;

Result<Places> places_of(const std::vector<std::string>& header, const std::string& where) {
  Places places;
  for (std::size_t i = 0; i < header.size(); ++i) {
    const std::string name = lower(trimmed(header[i]));
    const auto known = std::ranges::find(kColumns, name);
    if (known == kColumns.end())
      return input_error(
          "{}: the column \"{}\" is not known: there are image, light_x, light_y, light_z, camera_x, "
          "camera_y, camera_z, exposure, light_distance, camera_distance, corner1_x, corner1_y to corner4_y and k1",
          where, shown(name));
    auto& place = places[static_cast<std::size_t>(known - kColumns.begin())];
    if (place) return input_error("{}: the column {} is there twice: leave one out", where, name);
    place = i;
  }
  for (std::size_t k = 0; k < kLightDistance; ++k)
    if (!places[k])
      return input_error(
          "{}: the column {} is missing: the first row names image, light_x, light_y, light_z, camera_x, "
          "camera_y, camera_z and exposure",
          where, kColumns[k]);
  for (std::size_t k = kCorners; k < kLens; ++k)
    if (places[k].has_value() != places[kCorners].has_value())
      return input_error("{}: there are some columns of corners: give corner1_x and corner1_y to corner4_y, or none",
                         where);
  if (places[kLens] && !places[kCorners])
    return input_error("{}: k1 is for photographs with corners: give corner1_x and corner1_y to corner4_y", where);
  return places;
}

class Row {
 public:
  Row(const std::vector<std::string>& cells, const Places& places, std::string where)
      : cells_(cells), places_(places), where_(std::move(where)) {}

  std::string_view text(std::size_t column) const { return trimmed(cells_[*places_[column]]); }

  Result<double> number(std::size_t column) const {
    const auto value = number_in_cell(text(column));
    if (!value)
      return input_error("{}: {} is \"{}\": write a number with a decimal point", where_, kColumns[column],
                         shown(text(column)));
    return *value;
  }

  Result<Station> station(std::size_t first, std::size_t distance) const {
    Station station;
    for (int k = 0; k < 3; ++k) {
      GONIO_ASSIGN(station.where[k], number(first + static_cast<std::size_t>(k)));
    }
    if (!places_[distance] || text(distance).empty()) return station;
    const double size = length(station.where);
    if (!(size > 0))
      return input_error("{}: {}, {} and {} are 0, which is no direction", where_, kColumns[first], kColumns[first + 1],
                         kColumns[first + 2]);
    station.where = (1 / size) * station.where;
    const std::string far = lower(text(distance));
    if (far == "inf" || far == "infinity") {
      station.parallel = true;
      return station;
    }
    GONIO_ASSIGN(const double length, number(distance));
    if (!(length > 0))
      return input_error("{}: {} is {}: give a length above 0, or inf for parallel rays", where_, kColumns[distance],
                         shortest(length));
    station.where = length * station.where;
    return station;
  }

  // Nothing where the row has no corners.
  Result<std::optional<Corners>> corners() const {
    std::optional<Corners> corners;
    if (!places_[kCorners]) return corners;
    std::size_t empty = 0;
    for (std::size_t k = kCorners; k < kLens; ++k) empty += text(k).empty();
    if (empty == kLens - kCorners) return corners;
    corners.emplace();
    for (std::size_t k = 0; k < corners->at.size(); ++k) {
      GONIO_ASSIGN(corners->at[k].x, number(kCorners + 2 * k));
      GONIO_ASSIGN(corners->at[k].y, number(kCorners + 2 * k + 1));
    }
    if (!places_[kLens] || text(kLens).empty()) return corners;
    GONIO_ASSIGN(corners->k1, number(kLens));
    constexpr double kMost = 0.3;  // from 1/3 on, a lens folds the corners of its picture in
    if (!(std::abs(corners->k1) <= kMost))
      return input_error("{}: k1 is {}: give a number from -.3 to .3", where_, shortest(corners->k1));
    return corners;
  }

 private:
  const std::vector<std::string>& cells_;
  const Places& places_;
  std::string where_;
};

Result<Photo> photo_of(const Row& row, const std::string& where, const std::filesystem::path& folder) {
  Photo photo;
  if (row.text(kImage).empty()) return input_error("{}: image is empty: name a file", where);
  photo.image = (folder / std::string(row.text(kImage))).string();
  GONIO_ASSIGN(photo.light, row.station(kLight, kLightDistance));
  GONIO_ASSIGN(photo.camera, row.station(kCamera, kCameraDistance));
  GONIO_ASSIGN(photo.exposure, row.number(kExposure));
  if (!(photo.exposure > 0))
    return input_error(
        "{}: exposure is {}: give the linear value, above 0, of a white matte surface that faces a light "
        "at distance 1",
        where, shortest(photo.exposure));
  GONIO_ASSIGN(photo.corners, row.corners());
  return photo;
}

}  // namespace

Result<PhotoTable> read_photo_table(const std::string& path) {
  GONIO_ASSIGN(InputFile input, InputFile::open(path));
  GONIO_ASSIGN(const std::vector<TableRow> rows, table_rows(CsvRecords(std::move(input)), true));
  PhotoTable table{path, {}};
  const std::filesystem::path folder = path == "-" ? "" : std::filesystem::path(path).parent_path();
  std::optional<Places> places;
  std::size_t columns = 0;
  for (const auto& [line, cells] : rows) {
    const std::string where = fmt::format("{}:{}", path, line);
    if (!places) {
      GONIO_ASSIGN(places, places_of(cells, where));
      columns = cells.size();
      continue;
    }
    if (cells.size() != columns)
      return input_error("{}: {} cells, but the first row names {} columns", where, cells.size(), columns);
    GONIO_ASSIGN(Photo photo, photo_of(Row(cells, *places, where), where, folder));
    photo.line = line;
    table.photos.push_back(std::move(photo));
  }
  if (!places) return input_error("{}: is empty: the first row names the columns", path);
  if (table.photos.empty()) return input_error("{}: names no photograph: give a row for each", path);
  return table;
}

namespace {

// The distance from the origin to the convex hull of points in the plane, 0 inside, by the directions from which all of
// them lie on one side: exact to a step of two degrees.
double distance_to_hull(const std::vector<Vec3>& points) {
  double most = 0;
  for (int step = 0; step < 180; ++step) {
    const double angle = step * kPi / 90, c = std::cos(angle), s = std::sin(angle);
    double least = std::numeric_limits<double>::infinity();
    for (const Vec3& p : points) least = std::min(least, c * p.x + s * p.y);
    most = std::max(most, least);
  }
  return most;
}

// The plane of the surface is z = 0 for any place of a lamp above it, so that no texel matters for that.
Result<void> above(const Station& station, const char* what, const Photo& photo, const std::string& table) {
  if (station.where.z > 0) return {};
  return input_error(
      "{}:{}: the {} is below the surface ({}_z is not above 0): the surface is z = 0, and z grows toward its front",
      table, photo.line, what, what);
}

}  // namespace

Result<void> check_stations(const PhotoTable& table, double width, double height, int least) {
  for (const Photo& photo : table.photos) {
    GONIO_TRY(above(photo.light, "light", photo, table.path));
    GONIO_TRY(above(photo.camera, "camera", photo, table.path));
  }
  const auto count = static_cast<int>(table.photos.size());
  if (count < least)
    return input_error(
        "{}: {} photographs to fit are too few for this many lobes: give at least {}, or fewer --lobes or "
        "--holdout",
        table.path, count, least);
  // The half vectors at places all over the surface: the highlight is where they are the normal.
  double nearest = std::numeric_limits<double>::infinity();
  double lights_apart = 0;
  constexpr int kPlaces = 9;  // along each side
  for (int column = 0; column < kPlaces; ++column)
    for (int row = 0; row < kPlaces; ++row) {
      const Vec3 at = {(column / (kPlaces - 1.0) - 0.5) * width, (row / (kPlaces - 1.0) - 0.5) * height, 0};
      std::vector<Vec3> halves;
      const Vec3 first = table.photos.front().light.direction(at);
      for (const Photo& photo : table.photos) {
        const Vec3 light = photo.light.direction(at);
        const Vec3 half = light + photo.camera.direction(at);
        halves.push_back(normalized(half));
        lights_apart = std::max(lights_apart, length(light - first));
      }
      nearest = std::min(nearest, distance_to_hull(halves));
    }
  constexpr double kMostBeside = 0.08, kLeastApart = 0.17;  // 5 and 10 degrees
  if (nearest > kMostBeside)
    return input_error(
        "{}: all photographs see the surface from one side of its highlight, {:.0f} degrees or more beside it: add "
        "some "
        "in which the light is opposite to the camera, or beyond",
        table.path, std::asin(std::min(nearest, 1.0)) / kDegree);
  if (lights_apart < kLeastApart)
    return input_error("{}: all lights are within {:.0f} degrees of each other: move the light between photographs",
                       table.path, lights_apart / kDegree);
  return {};
}

}  // namespace goniochrome::capture
