#include "render/path/view_grid.h"

#include <algorithm>
#include <cmath>

namespace goniochrome::render {

namespace {

// The faces of the cube of directions: the axis, and those along which the face extends.
struct Face {
  Vec3 axis, right, up;
};
const std::array<Face, 6> kFaces = {{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                                     {{-1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                                     {{0, 1, 0}, {0, 0, 1}, {1, 0, 0}},
                                     {{0, -1, 0}, {0, 0, 1}, {1, 0, 0}},
                                     {{0, 0, 1}, {1, 0, 0}, {0, 1, 0}},
                                     {{0, 0, -1}, {1, 0, 0}, {0, 1, 0}}}};

std::size_t face_of(const Vec3& direction) {
  int axis = 0;
  for (int k = 1; k < 3; ++k)
    if (std::abs(direction[k]) > std::abs(direction[axis])) axis = k;
  return static_cast<std::size_t>(2 * axis + (direction[axis] < 0 ? 1 : 0));
}

// The frame about a direction: it turns with the direction, within a face without a jump.
struct TangentFrame {
  Vec3 x, y;
};
TangentFrame frame_of(const Face& face, const Vec3& direction) {
  const Vec3 x = normalized(face.right - dot(face.right, direction) * direction);
  return {x, cross(direction, x)};
}

// The cell of a coordinate of -1..1, and how far within it.
int cell_of(double coordinate, int cells, float& along) {
  const double place = 0.5 * (coordinate + 1) * cells;
  const int cell = std::clamp(static_cast<int>(place), 0, cells - 1);
  along = static_cast<float>(std::clamp(place - cell, 0.0, 1.0));
  return cell;
}

double coordinate_of(std::size_t node, int cells) {
  return 2 * static_cast<double>(node) / cells - 1;
}

// Normals at a right angle to the viewer have nothing to show.
constexpr double kLeastCosine = 1e-3;

// Between nodes light is off by the square of their distance: so many cells at a tolerance of kUsual, by the figures of
// goniochrome-rendering(7), "Sums".
constexpr double kUsual_de00 = 0.5;
constexpr int kViews = 13, kNormals = 23;

}  // namespace

ViewGrid ViewGrid::within(double tolerance_de00) {
  const double finer = std::clamp(std::sqrt(kUsual_de00 / tolerance_de00), 0.5, 1.5);
  return {static_cast<int>(std::lround(kViews * finer)), static_cast<int>(std::lround(kNormals * finer))};
}

// Equal areas of the sphere about the viewer's direction go to a disc, whose radii are then stretched to the square.
ViewGrid::Place ViewGrid::place(const Vec3& normal, const Vec3& to_viewer) const {
  const std::size_t number = face_of(to_viewer);
  const Face& face = kFaces[number];
  const double depth = dot(face.axis, to_viewer);
  Place place;
  const int a = cell_of(dot(face.right, to_viewer) / depth, views_, place.along[0]);
  const int b = cell_of(dot(face.up, to_viewer) / depth, views_, place.along[1]);
  const TangentFrame frame = frame_of(face, to_viewer);
  const double x = dot(normal, frame.x), y = dot(normal, frame.y);
  const double longer = std::max(std::abs(x), std::abs(y));
  const double radius = std::sqrt(std::clamp(1 - dot(normal, to_viewer), 0.0, 1.0));
  const double scale = longer > 0 ? radius / longer : 0;
  const int s = cell_of(scale * x, normals_, place.along[2]), t = cell_of(scale * y, normals_, place.along[3]);
  const std::size_t row = nodes(views_), row_of_normals = nodes(normals_);
  place.node.view =
      static_cast<std::uint32_t>((number * row + static_cast<std::size_t>(b)) * row + static_cast<std::size_t>(a));
  place.node.normal =
      static_cast<std::uint32_t>(static_cast<std::size_t>(t) * row_of_normals + static_cast<std::size_t>(s));
  return place;
}

std::array<ViewGrid::Node, ViewGrid::kCorners> ViewGrid::corners(const Node& cell) const {
  const auto row = static_cast<std::uint32_t>(nodes(views_)),
             row_of_normals = static_cast<std::uint32_t>(nodes(normals_));
  std::array<Node, kCorners> corners;
  for (std::uint32_t c = 0; c < kCorners; ++c)
    corners[c] = {cell.view + (c & 1U) + ((c >> 1) & 1U) * row,
                  cell.normal + ((c >> 2) & 1U) + ((c >> 3) & 1U) * row_of_normals};
  return corners;
}

std::array<float, ViewGrid::kCorners> ViewGrid::weights(const Place& place) {
  std::array<float, kCorners> weights;
  for (std::size_t c = 0; c < kCorners; ++c) {
    weights[c] = 1;
    for (std::size_t k = 0; k < place.along.size(); ++k)
      weights[c] *= ((c >> k) & 1U) != 0 ? place.along[k] : 1 - place.along[k];
  }
  return weights;
}

ViewGrid::Facing ViewGrid::facing(const Node& node) const {
  const std::size_t row = nodes(views_), row_of_normals = nodes(normals_);
  const Face& face = kFaces[node.view / (row * row)];
  const double a = coordinate_of(node.view % row, views_), b = coordinate_of(node.view / row % row, views_);
  const Vec3 to_viewer = normalized(face.axis + a * face.right + b * face.up);
  const TangentFrame frame = frame_of(face, to_viewer);
  const double s = coordinate_of(node.normal % row_of_normals, normals_),
               t = coordinate_of(node.normal / row_of_normals, normals_);
  const double radius = std::max(std::abs(s), std::abs(t));
  const double cosine = std::max(kLeastCosine, 1 - radius * radius), sine = std::sqrt(1 - cosine * cosine);
  if (!(radius > 0)) return {to_viewer, to_viewer};
  const double scale = sine / std::sqrt(s * s + t * t);
  return {cosine * to_viewer + scale * s * frame.x + scale * t * frame.y, to_viewer};
}

NodeValues::NodeValues(const ViewGrid& grid, std::size_t count)
    : grid_(grid), count_(count), views_(grid.view_count()) {}

NodeValues::~NodeValues() {
  for (const std::atomic<View*>& view : views_) {
    const std::unique_ptr<View[]> normals(view.load());
    for (std::size_t k = 0; normals != nullptr && k < grid_.normal_count(); ++k) delete[] normals[k].load();
  }
}

}  // namespace goniochrome::render
