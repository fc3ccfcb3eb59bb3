// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "cloth/cloth.h"
#include "scene/heading.h"
#include "scene/shares.h"

namespace curtain {
namespace {

double factor(const std::vector<double>& factors, int i) {
  return factors.empty() ? 1.0 : factors[static_cast<std::size_t>(i)];
}

void fillRestLengths(const ClothParams& cloth, ClothPattern& pattern) {
  const Grid& grid = pattern.grid;
  const std::vector<double> rods = shareOut(cloth.height, cloth.row_spacing, grid.rows - 1);
  for (int i = 1; i < grid.rows; ++i) {
    const double rod = rods[static_cast<std::size_t>(i - 1)];
    for (int j = 0; j < grid.columns; ++j) {
      pattern.warp_coordinate[grid.index(i, j)] = pattern.warp_coordinate[grid.index(i - 1, j)] + rod;
      pattern.warp_rest[grid.index(i, j)] = rod;
    }
  }
  for (int i = 0; i < grid.rows; ++i) {
    const double down = pattern.warp_coordinate[grid.index(i, 0)] / cloth.height;
    const std::vector<double> links = shareOut(rowWidth(cloth, down), cloth.column_spacing, grid.linkCount());
    for (int j = 1; j < grid.columns; ++j) pattern.weft_rest[grid.index(i, j)] = links[static_cast<std::size_t>(j - 1)];
    if (grid.closed) pattern.weft_rest[grid.index(i, 0)] = links.back();
  }
  for (std::size_t n = 0; n < grid.size(); ++n) {
    pattern.warp_per_square[n] = 1.0 / (pattern.warp_rest[n] * pattern.warp_rest[n]);
    pattern.weft_per_square[n] = 1.0 / (pattern.weft_rest[n] * pattern.weft_rest[n]);
  }
  for (int i = 0; i < grid.rows && !grid.slit_row.empty(); ++i) {
    for (int j = 0; j < grid.columns; ++j) {
      if (!grid.hasLink(i, j)) pattern.weft_per_square[grid.index(i, j)] = 0.0;
    }
  }
  pattern.weft_coordinate.assign(static_cast<std::size_t>(grid.columns), 0.0);
  for (int j = 1; j < grid.columns; ++j) {
    const auto column = static_cast<std::size_t>(j);
    pattern.weft_coordinate[column] = pattern.weft_coordinate[column - 1] + pattern.weft_rest[column];
  }
}

// Half the rest lengths at the node along the weft.
double nodeWidth(const ClothPattern& pattern, int i, int j) {
  const Grid& grid = pattern.grid;
  double along_weft = 0.0;
  const int right = j + 1 < grid.columns ? j + 1 : 0;
  if (grid.hasLink(i, j)) along_weft += 0.5 * pattern.weft_rest[grid.index(i, j)];
  if (grid.hasLink(i, right)) along_weft += 0.5 * pattern.weft_rest[grid.index(i, right)];
  return along_weft;
}

// Half the rest lengths at the node along the warp, times those along the weft.
double nodeArea(const ClothPattern& pattern, int i, int j) {
  const Grid& grid = pattern.grid;
  double along_warp = 0.0;
  if (i > 0) along_warp += 0.5 * pattern.warp_rest[grid.index(i, j)];
  if (i + 1 < grid.rows) along_warp += 0.5 * pattern.warp_rest[grid.index(i + 1, j)];
  return along_warp * nodeWidth(pattern, i, j);
}

void fillMasses(const ClothParams& cloth, ClothPattern& pattern) {
  const Grid& grid = pattern.grid;
  double total_area = 0.0;
  for (int i = 0; i < grid.rows; ++i) {
    for (int j = 0; j < grid.columns; ++j) total_area += pattern.area[grid.index(i, j)] = nodeArea(pattern, i, j);
  }
  for (int i = 0; i < grid.rows; ++i) {
    for (int j = 0; j < grid.columns; ++j) {
      const std::size_t node = grid.index(i, j);
      const double density = fabricAt(cloth, i, j).surface_density;
      const double base = cloth.lumping == Lumping::kUniform
                              ? density * total_area / static_cast<double>(grid.nodeCount())
                              : density * pattern.area[node];
      pattern.mass[node] = base * factor(cloth.row_mass, i) * factor(cloth.column_mass, j);
    }
  }
}

void addHem(const HemParams& hem, ClothPattern& pattern) {
  const int bottom = pattern.grid.rows - 1;
  for (int j = 0; j < pattern.grid.columns; ++j) {
    double& mass = pattern.mass[pattern.grid.index(bottom, j)];
    mass += hem.line_density * nodeWidth(pattern, bottom, j);
    if (!hem.weights.empty()) mass += hem.weights[static_cast<std::size_t>(j)];
  }
}

void invertMasses(ClothPattern& pattern) {
  const Grid& grid = pattern.grid;
  for (int i = 0; i < grid.rows; ++i) {
    for (std::size_t n = grid.index(i, 0); n < grid.index(i, grid.columns); ++n)
      pattern.inverse_mass[n] = 1.0 / pattern.mass[n];
  }
}

// All of the top row, or what hangs by a heading.
std::vector<NodeIndex> hungNodes(const Scene& scene) {
  std::vector<NodeIndex> nodes;
  if (isPleated(scene.hang)) {
    for (const int column : headingColumns(scene.hang, edgeLinks(scene.cloth))) nodes.push_back({0, column});
    return nodes;
  }
  for (int column = 0; column < scene.cloth.columns; ++column) nodes.push_back({0, column});
  return nodes;
}

std::vector<NodeIndex> pinnedNodes(const Scene& scene) {
  std::vector<NodeIndex> nodes;
  switch (scene.pins.kind) {
    case PinKind::kTop:
      if (scene.rail.path.empty()) return hungNodes(scene);
      break;
    case PinKind::kLeft:
      for (int i = 0; i < scene.cloth.rows; ++i) nodes.push_back({i, 0});
      break;
    case PinKind::kTopCorners:
      nodes = {{0, 0}, {0, scene.cloth.columns - 1}};
      break;
    case PinKind::kList:
      nodes = scene.pins.nodes;
      break;
    case PinKind::kNone:
      break;
  }
  return nodes;
}

// Pinned carriers are fastened to the rail.
void fillRail(const Scene& scene, ClothPattern& pattern) {
  if (scene.rail.path.empty()) return;
  RailPattern& rail = pattern.rails.emplace_back();
  rail.path = RailPath(scene.rail.path);
  rail.layout = RailLayout(scene);
  rail.columns = RailLayout::columnsOf(scene);
  rail.friction = scene.rail.carriers.friction;
  rail.gap = scene.rail.carriers.gap;
  for (const int column : rail.columns) {
    const std::size_t node = pattern.grid.index(0, column);
    rail.fastened.push_back(pattern.pinned[node]);
    pattern.pinned[node] = kGuided;
    pattern.guided.push_back(node);
    pattern.mass[node] += scene.rail.carriers.mass;
    pattern.inverse_mass[node] = 0.0;
  }
}

// Pleats that are pressed in turn at rest as they do at the start. The weft's turn is about the way down, the angles
// are about the way up (rest_curvature.h).
void pressPleats(const Scene& scene, ClothPattern& pattern) {
  if (!isPleated(scene.hang) || !(scene.hang.pressed > 0.0)) return;
  const Grid& grid = pattern.grid;
  const std::vector<double> angles =
      headingAngles(scene.hang, pleatLinks(scene.cloth), (scene.hang.to - scene.hang.from).norm());
  pattern.weft_rest_turn.assign(grid.size(), 0.0);
  for (int i = 0; i < grid.rows && pattern.warp_coordinate[grid.index(i, 0)] <= scene.hang.pressed; ++i) {
    for (int j = 1; j + 1 < grid.columns; ++j) {
      const auto link = static_cast<std::size_t>(j);
      if (grid.hasLink(i, j) && grid.hasLink(i, j + 1))
        pattern.weft_rest_turn[grid.index(i, j)] = angles[link - 1] - angles[link];
    }
  }
}

// Fields of the grid's size with what padding and missing links have.
void clear(ClothPattern& pattern) {
  const std::size_t size = pattern.grid.size();
  for (Field* const field :
       {&pattern.warp_rest, &pattern.weft_rest, &pattern.warp_per_square, &pattern.weft_per_square})
    field->assign(size, 1.0);
  for (Field* const field :
       {&pattern.cell, &pattern.area, &pattern.mass, &pattern.inverse_mass, &pattern.warp_coordinate})
    field->assign(size, 0.0);
  pattern.pinned.assign(size, 0);
}

// Puts the pattern of one cloth into that of all, from a column on.
void addLayer(const ClothPattern& layer, std::size_t number, int first, ClothPattern& pattern) {
  const Grid &grid = pattern.grid, &from = layer.grid;
  const auto copy = [&](const auto& source, auto& target) {
    for (int i = 0; i < from.rows && !source.empty(); ++i)
      std::copy_n(&source[from.index(i, 0)], from.columns, &target[grid.index(i, first)]);
  };
  copy(layer.warp_rest, pattern.warp_rest);
  copy(layer.weft_rest, pattern.weft_rest);
  copy(layer.warp_per_square, pattern.warp_per_square);
  copy(layer.weft_per_square, pattern.weft_per_square);
  copy(layer.warp_coordinate, pattern.warp_coordinate);
  copy(layer.cell, pattern.cell);
  copy(layer.area, pattern.area);
  copy(layer.mass, pattern.mass);
  copy(layer.inverse_mass, pattern.inverse_mass);
  copy(layer.pinned, pattern.pinned);
  if (!layer.weft_rest_turn.empty()) pattern.weft_rest_turn.resize(grid.size(), 0.0);
  copy(layer.weft_rest_turn, pattern.weft_rest_turn);
  for (int i = 0; i < grid.rows && first > 0; ++i) {  // cut off from the cloth before it
    pattern.weft_rest[grid.index(i, first)] = layer.weft_rest[from.index(i, 1)];
    pattern.weft_per_square[grid.index(i, first)] = 0.0;
  }
  for (const std::size_t node : layer.guided) pattern.guided.push_back(node + static_cast<std::size_t>(first));
  for (RailPattern rail : layer.rails) {
    rail.layer = number;
    for (int& column : rail.columns) column += first;
    pattern.rails.push_back(std::move(rail));
  }
  pattern.layer.resize(static_cast<std::size_t>(first + from.columns), static_cast<int>(number));
  const double along = first > 0 ? pattern.weft_coordinate.back() + layer.weft_rest[1] : 0.0;
  for (const double place : layer.weft_coordinate) pattern.weft_coordinate.push_back(along + place);
}

}  // namespace

Grid makeGrid(const ClothParams& cloth) {
  Grid grid(cloth.rows, cloth.columns, cloth.closed);
  if (!cloth.slits.empty()) grid.slit_row.assign(static_cast<std::size_t>(cloth.columns), cloth.rows);
  for (const SlitParams& slit : cloth.slits)
    grid.slit_row[static_cast<std::size_t>((slit.column + 1) % cloth.columns)] = slit.from_row;
  return grid;
}

Vec3 RailPattern::freedomOf(std::size_t carrier, double place) const {
  return fastened[carrier] != 0 ? Vec3::Zero() : path.at(place).tangent;
}

ClothPattern makeLayerPattern(const Scene& scene) {
  ClothPattern pattern;
  pattern.grid = makeGrid(scene.cloth);
  clear(pattern);
  forEachCell(pattern.grid, [&](int i, int j, int) { pattern.cell[pattern.grid.index(i, j)] = 1.0; });
  fillRestLengths(scene.cloth, pattern);
  fillMasses(scene.cloth, pattern);
  addHem(scene.hem, pattern);
  invertMasses(pattern);
  for (const NodeIndex& node : pinnedNodes(scene)) {
    pattern.pinned[pattern.grid.index(node)] = kPinned;
    pattern.inverse_mass[pattern.grid.index(node)] = 0.0;
  }
  fillRail(scene, pattern);
  pressPleats(scene, pattern);
  return pattern;
}

ClothPattern makePattern(const Scene& scene) {
  ClothPattern pattern;
  pattern.grid = makeGrid(wholeCloth(scene));
  addEndRows(scene, pattern.grid);
  clear(pattern);
  const Layers layers(scene);
  for (std::size_t k = 0; k < layers.size(); ++k)
    addLayer(makeLayerPattern(layerScene(scene, k)), k, layers[k].first, pattern);
  fillBending(layers, pattern);
  fillCords(scene, pattern);
  pattern.scene_pins = pattern.pinned;
  return pattern;
}

void pinBeside(const std::vector<std::uint8_t>& held, const Layers& layers, ClothPattern& pattern) noexcept {
  const Grid& grid = pattern.grid;
  for (int i = 0; i < grid.rows; ++i) {
    for (std::size_t n = grid.index(i, 0); n < grid.index(i, grid.columns); ++n) {
      if (pattern.scene_pins[n] == kGuided) pattern.pinned[n] = held[n] == kHeld ? kHeld : kGuided;
      if (pattern.scene_pins[n] != kFree) continue;
      pattern.pinned[n] = held[n];
      pattern.inverse_mass[n] = held[n] == kPinned ? 0.0 : 1.0 / pattern.mass[n];
    }
  }
  fillBending(layers, pattern);
}

double lightestCorner(const ClothPattern& pattern, int row, int right, int left) {
  const Grid& grid = pattern.grid;
  double lightest = std::numeric_limits<double>::infinity();
  for (const std::size_t n :
       {grid.index(row, left), grid.index(row, right), grid.index(row + 1, left), grid.index(row + 1, right)})
    lightest = std::min(lightest, pattern.mass[n] / pattern.area[n]);
  return lightest;
}

double shortestLink(const ClothPattern& pattern) {
  double shortest = std::numeric_limits<double>::infinity();
  forEachLink(pattern, [&](std::size_t, std::size_t, double rest, bool) { shortest = std::min(shortest, rest); });
  return shortest;
}

}  // namespace curtain
