#include "render/maps.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "base/text.h"

namespace goniochrome {

namespace {

// A class holds maps down to this share of its face size.
constexpr double kSmallest = 0.4;

// The lobe's map, or an error with the command that adds it.
Result<const PrefilteredLobe*> lobe_of(const PrefilteredEnvironment& env, double exponent, const Effects& effects) {
  const PrefilteredLobe* lobe = env.lobe(exponent);
  if (lobe != nullptr) return lobe;
  std::string list;
  for (const Effects::LobeUse& use : effects.lobes) list += (list.empty() ? "" : ",") + shortest(use.exponent);
  return input_error(
      "the environment has no lobe of exponent {}, which a paint needs: make it with `prefilter-envmap {} --exponents "
      "{} "
      "-o ENV.env.exr`, or fit the paints to the basis it was made for",
      shortest(exponent), env.source.empty() ? "SOURCE" : env.source, list);
}

CubeMap resized(const CubeMap& map, int size) {
  if (map.size == size) return map;
  CubeMap result(size);
  parallel_for(static_cast<std::size_t>(6 * size), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const int face = static_cast<int>(i) / size, row = static_cast<int>(i) % size;
      for (int column = 0; column < size; ++column) {
        const Vec3 value = bilinear(map, cube_direction(face, column + 0.5, row + 0.5, size));
        for (int c = 0; c < 3; ++c) result.at(face, row, column)[c] = static_cast<float>(value[c]);
      }
    }
  });
  return result;
}

MapClass single(int slot, const CubeMap& map) {
  return {map.size, {slot}, {map}, false};
}

}  // namespace

Result<SceneMaps> scene_maps(const Scene& scene, const Effects& effects) {
  SceneMaps maps;
  if (!effects.environment) return maps;
  const PrefilteredEnvironment& env = *scene.env;
  if (effects.diffuse) maps.diffuse = single(WeightTable::diffuse_slot(), env.diffuse.map);
  struct Member {
    int slot;
    const CubeMap* map;
  };
  std::vector<MapClass> wide;
  std::vector<Member> members;
  for (std::size_t j = 0; j < effects.lobes.size(); ++j) {
    GONIO_ASSIGN(const PrefilteredLobe* lobe, lobe_of(env, effects.lobes[j].exponent, effects));
    if (is_shifted(effects, effects.lobes[j].exponent)) {
      wide.push_back(single(WeightTable::lobe_slot(j), lobe->map));
      wide.back().shifted = true;
      continue;
    }
    members.push_back({WeightTable::lobe_slot(j), &lobe->map});
  }
  std::stable_sort(members.begin(), members.end(),
                   [](const Member& a, const Member& b) { return a.map->size > b.map->size; });
  for (const Member& member : members) {
    if (maps.lobes.empty() || member.map->size < kSmallest * maps.lobes.back().size)
      maps.lobes.push_back({member.map->size, {}, {}});
    MapClass& into = maps.lobes.back();
    into.slots.push_back(member.slot);
    into.maps.push_back(resized(*member.map, into.size));
  }
  std::reverse(maps.lobes.begin(), maps.lobes.end());
  maps.lobes.insert(maps.lobes.begin(), wide.begin(), wide.end());
  if (effects.mirror || effects.background == Background::kEnvironment) {
    if (env.mirror.map.size == 0) {
      return input_error(
          "the environment has no mirror part, which {} needs: make it with a basis that holds <mirror/>",
          effects.mirror ? "a paint with a mirror lobe" : "--background env");
    }
    maps.mirror = single(1 + static_cast<int>(effects.lobes.size()), env.mirror.map);
  }
  return maps;
}

std::vector<float> bordered_face(const CubeMap& map, int face) {
  const int n = map.size, wide = n + 2;
  std::vector<float> texels(static_cast<std::size_t>(wide) * static_cast<std::size_t>(wide) * 3);
  const auto at = [&](int column, int row) {
    return &texels[(static_cast<std::size_t>(row + 1) * wide + column + 1) * 3];
  };
  // The center of a texel beside the face, in the plane of the face, lies less than half a texel from the center of the
  // neighbor's first texel, so the direction finds it.
  const auto across = [&](int column, int row) {
    const CubePosition p = cube_position(cube_direction(face, column + 0.5, row + 0.5, n), n);
    const auto inside = [&](double x) { return std::clamp(static_cast<int>(x), 0, n - 1); };
    std::copy_n(map.at(p.face, inside(p.row), inside(p.column)), 3, at(column, row));
  };
  for (int i = 0; i < n; ++i) {
    std::copy_n(map.at(face, i, 0), 3 * static_cast<std::size_t>(n), at(0, i));
    across(-1, i), across(n, i), across(i, -1), across(i, n);
  }
  for (const int row : {-1, n}) {
    for (const int column : {-1, n}) {
      const int x = std::clamp(column, 0, n - 1), y = std::clamp(row, 0, n - 1);
      for (int c = 0; c < 3; ++c) at(column, row)[c] = (at(x, row)[c] + at(column, y)[c] + at(x, y)[c]) / 3;
    }
  }
  return texels;
}

}  // namespace goniochrome
