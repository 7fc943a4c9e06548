// The light that each lobe of a basis gathers at every visible point, with shadows and bounced light: what a picture is
// linear in. goniochrome-transport(7), "TRANSPORT".
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "color/color.h"
#include "render/path/lobe_columns.h"
#include "render/path/lobe_point.h"

namespace goniochrome::render {

// The paints while bounced light was traced: of each group, by column.
struct WornPaints {
  PaintGroups groups;
  std::vector<std::vector<color::Rgb>> weights;
  std::vector<paint::Anisotropy> brushed;  // of each part of the mesh: its lobes are those of such a surface
  // The index of the coat that the base is lit through, for each part of the mesh, then for the floor. The light of a
  // paint under another coat is that of brdf::under_coat().
  std::vector<double> coats;
  std::vector<color::Rgb> emission;  // radiance of each part of the mesh by itself, whatever it wears
  bool has_floor = false;            // as the part after the mesh's
  // True if that floor shows the environment. Its weights are 1 in the diffuse column and 0 elsewhere, for any paint.
  bool floor_is_projected = false;

  bool is_projected(int part) const { return floor_is_projected && part == static_cast<int>(brushed.size()); }
  // The class of the bounced light that such a floor shows, which came to the mesh before.
  std::size_t floor_class() const { return groups.at(groups.of_part.back(), PaintGroups::kDeeper); }
};

// Visible points evenly spread over the picture, at which bounced light is known by pairs of columns: they tell how
// bounced light follows a change of paint, and by how much scaling it to first order errs.
struct BounceProbe {
  std::uint32_t point = 0;          // of LobeTransport::places
  std::vector<float> once, deeper;  // as LobePoint::Pairs, channels last
};

// Light by column and channel, of weight 1, for the visible points row by row: the mean over those samples of a pixel
// that show the part that its center shows, from the same side. Points of a floor that shows the environment have the
// diffuse column alone, and no classes; all others are points with lobes.
struct LobeTransport {
  int width = 0, height = 0;
  LobeColumns columns;
  std::vector<std::uint32_t> places;                // y width + x, ascending
  std::vector<int> part;                            // of each point
  std::vector<std::uint32_t> with_lobes;            // number of each point among those with lobes
  std::vector<std::vector<float>> direct, bounced;  // by column: R G B of the points that have it; empty: not read
  std::vector<std::vector<float>> classes;  // by class of PaintGroups: R G B of bounced light, as the picture shows it
  WornPaints worn;
  std::vector<float> noise_de00;    // of each point, the largest over the columns: see LobeTransportRequest
  std::vector<BounceProbe> probes;  // those that see a surface
  int probed = 0;                   // all of them
  double white_luminance = 1;       // of the scene's diffuse white, in the unit that the light is kept in
  double unit = 1;                  // that unit, as radiance
  int bounces = 0;
  int samples = 1;  // of a pixel, as sample_shifts() has them

  // Makes room for the light of the points, all 0, in the diffuse column and those wanted; without a list, in all.
  // Bounced light and its classes have none without bounces.
  void make_room(const std::vector<bool>& wanted = {});

  std::array<int, 2> pixel(std::size_t point) const {
    return {static_cast<int>(places[point]) % width, static_cast<int>(places[point]) / width};
  }
  bool has_lobes(std::size_t point) const { return !worn.is_projected(part[point]); }
  // The points that have a column: all of them, or those with lobes.
  std::vector<std::uint32_t> points_of(std::size_t column) const;
  // Where the light of a point begins in a column, if it has that column.
  std::optional<std::size_t> at(std::size_t point, std::size_t column) const {
    if (direct[column].empty() || (column != LobeColumns::diffuse() && !has_lobes(point))) return std::nullopt;
    return 3 * (column == LobeColumns::diffuse() ? point : with_lobes[point]);
  }
  color::Rgb light(std::size_t point, std::size_t column, bool with_bounced = true) const {
    const auto i = at(point, column);
    if (!i) return {};
    const color::Rgb sum = vec3(&direct[column][*i]);
    return with_bounced && bounces > 0 ? sum + vec3(&bounced[column][*i]) : sum;
  }
};

}  // namespace goniochrome::render
