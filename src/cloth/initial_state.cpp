// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <numeric>

#include "cloth/cloth.h"
#include "cloth/folded_start.h"
#include "scene/fan.h"
#include "scene/heading.h"
#include "scene/pi.h"
#include "scene/ring_start.h"
#include "scene/shares.h"
#include "scene/strips.h"

namespace curtain {
namespace {

// Axes of the flat cloth: along the hung edge, down the warp (turned by tilt).
struct HangFrame {
  Vec3 along;
  Vec3 down;
};

HangFrame hangFrame(const HangParams& hang) {
  HangFrame frame;
  frame.along = (hang.to - hang.from).normalized();
  Vec3 normal = frame.along.cross(Vec3::UnitZ());
  // A hung edge that runs up or down leaves the normal open: any horizontal one will do.
  normal = normal.norm() > 1e-9 ? Vec3(normal.normalized()) : Vec3::UnitX();
  const Vec3 plumb = frame.along.cross(normal);
  frame.down = std::cos(hang.tilt) * plumb + std::sin(hang.tilt) * normal;
  return frame;
}

// Where columns hang [m]: along the edge, and in front of the line hang.from -> hang.to (towards along x down).
struct HungColumns {
  Field along;
  Field front;
};

// Overlapping strips hang on two lines, as far apart as cloth is thick on both: they touch each other when they swing.
HungColumns hungColumns(const Scene& scene, const ClothPattern& pattern) {
  HungColumns hung{pattern.weft_coordinate, Field(pattern.weft_coordinate.size(), 0.0)};
  if (!scene.hang.overlap) return hung;
  const std::vector<double> widths = edgeWidths(scene);
  std::partial_sum(widths.begin(), widths.end(), hung.along.begin() + 1);
  const std::vector<int> strips = stripNumbers(scene.cloth);
  for (std::size_t j = 0; j < strips.size(); ++j)
    hung.front[j] = strips[j] % 2 == 0 ? scene.contact.thickness : -scene.contact.thickness;
  return hung;
}

// As wide as the hung edge all the way down, or as a fan (scene/fan.h).
void placeFlat(const Scene& scene, const ClothPattern& pattern, Field3& position) {
  const Grid& grid = pattern.grid;
  const HangFrame frame = hangFrame(scene.hang);
  // Laid cloth (hang.start.over) hangs nowhere, and may have no fan along this line.
  const double span = std::min((scene.hang.to - scene.hang.from).norm(), longestEdge(scene));
  const double hem = startingHem(scene, span).value_or(span);
  const Vec3 middle = 0.5 * (scene.hang.from + scene.hang.to);
  const Vec3 to_front = frame.along.cross(frame.down);
  const HungColumns hung = hungColumns(scene, pattern);
  const double top_width = hung.along.back();
  for (int j = 0; j < grid.columns; ++j) {
    const double share = hung.along[static_cast<std::size_t>(j)] / top_width - 0.5;
    const double lean = share * (span - hem) / scene.cloth.height, upright = std::sqrt(1.0 - lean * lean);
    const Vec3 line = middle + hung.front[static_cast<std::size_t>(j)] * to_front;
    for (int i = 0; i < grid.rows; ++i) {
      const double depth = pattern.warp_coordinate[grid.index(i, j)];
      position.set(grid.index(i, j), line + (share * span - depth * lean) * frame.along + depth * upright * frame.down);
    }
  }
}

// Each row lies as the pleats have the top edge in plan; the rods hang straight down.
void placePleated(const Scene& scene, const ClothPattern& pattern, Field3& position) {
  const Grid& grid = pattern.grid;
  const HangFrame frame = hangFrame(scene.hang);
  const Vec3 across = frame.along.cross(frame.down);
  const std::vector<double> links = pleatLinks(scene.cloth);
  const std::vector<double> angles = headingAngles(scene.hang, links, (scene.hang.to - scene.hang.from).norm());
  Vec3 top = scene.hang.from;
  for (int j = 0; j < grid.columns; ++j) {
    if (j > 0) {
      const auto link = static_cast<std::size_t>(j - 1);
      top += links[link] * (std::cos(angles[link]) * frame.along + std::sin(angles[link]) * across);
    }
    for (int i = 0; i < grid.rows; ++i)
      position.set(grid.index(i, j), top + pattern.warp_coordinate[grid.index(i, j)] * frame.down);
  }
}

// Closed cloth starts as a cone around the vertical through hang.from; outside = the side of positive normals.
void placeRing(const Scene& scene, const ClothPattern& pattern, Field3& position) {
  const Grid& grid = pattern.grid;
  const double radius = hungRadius(scene);
  for (int i = 0; i < grid.rows; ++i) {
    const double along = pattern.warp_coordinate[grid.index(i, 0)];
    const double ring = radius + along * std::sin(scene.hang.tilt);
    const double height = -along * std::cos(scene.hang.tilt);
    for (int j = 0; j < grid.columns; ++j) {
      const double angle = 2.0 * kPi * pattern.weft_coordinate[static_cast<std::size_t>(j)] / scene.cloth.width;
      position.set(grid.index(i, j), scene.hang.from + Vec3(ring * std::cos(angle), ring * std::sin(angle), height));
    }
  }
}

// One cloth, of a scene that has no other.
void placeLayer(const Scene& scene, const ClothPattern& pattern, Field3& position) {
  const bool on_rail = !pattern.rails.empty(), folds = weftsPush(scene.cloth);
  if (on_rail) {
    placeOnRail(pattern, pattern.rails.front().layout.placesFor(scene.rail.opening), !folds, position);
  } else if (scene.cloth.closed) {
    placeRing(scene, pattern, position);
  } else if (isPleated(scene.hang)) {
    placePleated(scene, pattern, position);
  } else {
    placeFlat(scene, pattern, position);
  }
  // Pleats are folds already, and overlapping strips leave each other no room for any.
  if (!folds || isPleated(scene.hang) || scene.hang.overlap) return;
  foldStart(scene, pattern, on_rail || scene.cloth.closed ? Vec3(-Vec3::UnitZ()) : hangFrame(scene.hang).down,
            position);
}

}  // namespace

void placeCloth(const Scene& scene, const ClothPattern& pattern, Field3& position) {
  const Layers layers(scene);
  for (std::size_t k = 0; k < layers.size(); ++k) {
    Scene one = layerScene(scene, k);
    const ClothPattern own = makeLayerPattern(one);
    one.cloth = prevailingFabric(one.cloth);
    Field3 placed;
    placed.assign(own.grid.size(), 0.0);
    placeLayer(one, own, placed);
    for (int i = 0; i < own.grid.rows; ++i) {
      for (int j = 0; j < own.grid.columns; ++j)
        position.set(pattern.grid.index(i, layers[k].first + j), placed.at(own.grid.index(i, j)));
    }
  }
}

ClothState makeInitialState(const Scene& scene, const ClothPattern& pattern) {
  const Grid& grid = pattern.grid;
  ClothState state;
  state.position.assign(grid.size(), 0.0);
  state.velocity.assign(grid.size(), 0.0);
  for (const RailPattern& rail : pattern.rails) {
    const RailParams& params = rail.layer == 0 ? scene.rail : scene.layers[rail.layer - 1].rail;
    const std::vector<double> places = rail.layout.placesFor(params.opening);
    state.place.insert(state.place.end(), places.begin(), places.end());
  }
  placeCloth(scene, pattern, state.position);
  for (const CordEnd& end : pattern.cords.ends) state.position.set(end.node, end.start);
  for (std::size_t k = 0; k < pattern.cords.loops.size(); ++k)
    state.reach.push_back(reachOf(pattern.cords, k, state.position));
  // Padding hangs plumb with rods of length 1 (its rest length), so that no kernel meets a zero there.
  for (int i = 0; i < grid.rows; ++i) {
    for (int j = grid.columns; j < grid.stride; ++j) state.position.set(grid.index(i, j), Vec3(0.0, 0.0, -i));
  }
  return state;
}

}  // namespace curtain
