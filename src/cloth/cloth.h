// SPDX-License-Identifier: BSD-3-Clause
//
// The cloth of Cheng 2000, Sect. 1.1: a grid of nodes with rest lengths, areas and masses (ClothPattern, constant) and
// its motion (ClothState).
#pragma once

#include <cstdint>
#include <vector>

#include "cloth/cords.h"
#include "cloth/field.h"
#include "curtain_sim/scene.h"
#include "scene/layers.h"
#include "scene/rail_layout.h"
#include "scene/rail_path.h"

namespace curtain {

class Archive;

/// What a node of ClothPattern::pinned is.
enum : std::uint8_t {
  kFree = 0,
  kPinned = 1,  ///< its position is prescribed
  kGuided = 2,  ///< a part of the solver says where it may be: a pin that moves, for all others
  kHeld = 3,  ///< links keep it where a part moves it: it has no inertia in a solve, but is no pin for what touches it
};

/// A rail and its carriers, which are nodes of the top row, in their order on it.
struct RailPattern {
  std::size_t layer = 0;  ///< of the scene's cloths (Layers)
  RailPath path;
  RailLayout layout;
  std::vector<int> columns;
  std::vector<std::uint8_t> fastened;  ///< by carrier: it stays where it starts
  double friction = 0.0;               ///< Coulomb coefficient
  double gap = 0.0;                    ///< least distance of neighbours [m]

  std::size_t size() const { return columns.size(); }
  /// Where a carrier at a place can go: the tangent there; zero: it is fastened.
  Vec3 freedomOf(std::size_t carrier, double place) const;
};

/// The part of a cloth that does not move. Constant but for what follows from its pins (pinBeside()).
struct ClothPattern {
  Grid grid;
  Field warp_rest;  ///< rest length of the rod from node (i-1, j) to (i, j) [m]; row 0 and padding: 1
  Field weft_rest;  ///< rest length of the link from node (i, j-1) to (i, j) [m]; closed: column 0 closes the ring
  Field warp_per_square;  ///< 1 / warp_rest^2 [1/m^2]
  Field weft_per_square;  ///< 1 / weft_rest^2 [1/m^2]; cut links: 0, so that they are never too long
  Field cell;             ///< share of the cell below a node, on its left, that is cloth: 1; 0: there is no cell
  Field area;             ///< the node's share of the cloth [m^2]
  Field mass;             ///< [kg], with its carrier's; padding: 0
  Field inverse_mass;     ///< [1/kg]; pinned, carriers and padding: 0
  std::vector<std::uint8_t> pinned;
  std::vector<std::uint8_t> scene_pins;  ///< the same without what parts pin beside it; constant
  std::vector<std::size_t> guided;       ///< nodes that are kGuided, in order
  std::vector<RailPattern> rails;        ///< in the order of their columns
  CordsPattern cords;
  /// Bending stiffness of the warp line through the node, and of the weft line [N m]: E = k (1 - cos(turn)) for the
  /// turn between the node's two links. 0 at the lines' ends, and where both links are held fast. Empty: limp.
  Field warp_bending, weft_bending;
  /// Turn of the line at the node where nothing bends it [rad], within (-pi/2, pi/2): of the warp about the weft's
  /// direction there, of the weft about the warp's. Empty: straight.
  Field warp_rest_turn, weft_rest_turn;
  Field warp_coordinate;   ///< of each node, length along its warp from the hung edge [m]
  Field weft_coordinate;   ///< of each column, length along the weft of the top row [m], shape [columns]; counted on
                           ///< from cloth to cloth, a link apart
  std::vector<int> layer;  ///< of each column, the number of its cloth (Layers), shape [columns]

  /// Whether there is a node, or an end, at an index of a Field.
  bool isThere(std::size_t n) const { return mass[n] > 0.0 || pinned[n] != kFree; }
  /// It moves by what acts on it.
  bool canMove(std::size_t n) const { return inverse_mass[n] > 0.0 && pinned[n] != kHeld; }
  bool isPinned(NodeIndex node) const { return pinned[grid.index(node)] == kPinned; }
};

/// The moving part of a cloth. Velocities may lag behind: leapfrog keeps them half a substep older than positions.
struct ClothState {
  Field3 position;            ///< [m]
  Field3 velocity;            ///< [m/s], at the time of the positions minus velocity_age
  double velocity_age = 0.0;  ///< [s], >= 0 between substeps
  std::vector<double> place;  ///< of all carriers along their rails [m]; their velocity is along them
  std::vector<double> reach;  ///< of the tie-backs: how far from its point a closed one lets its nodes be [m]

  void serialize(Archive& archive);
};

/// The stiffness of either direction's lines from the bending rigidities [N m] (ClothPattern::warp_bending).
void fillBending(const Layers& layers, ClothPattern& pattern);

/// Lengths that a joint's turn stands for, of either direction's lines [m], shapes [grid.size()]; its stiffness is
/// rigidity width / length.
void fillTurningLengths(const ClothPattern& pattern, Field& warp, Field& weft) noexcept;

/// Pins these nodes beside those of the scene, and frees all others; inverse masses and bending follow. Whoever keeps
/// something that depends on them must update it: Simulator::Impl::pinsChanged() tells all of them.
///   held  by node, kFree or how it is held; read where scene_pins has kFree, and kHeld where it has kGuided
void pinBeside(const std::vector<std::uint8_t>& held, const Layers& layers, ClothPattern& pattern) noexcept;

/// Rest lengths, masses, pins and bending of a validated scene.
ClothPattern makePattern(const Scene& scene);
/// Of one cloth, of a scene that has no other, without bending and cords.
ClothPattern makeLayerPattern(const Scene& scene);
/// Its shape, with the slits.
Grid makeGrid(const ClothParams& cloth);

/// The cloth of a validated scene at rest at scene.hang, or on the rail.
ClothState makeInitialState(const Scene& scene, const ClothPattern& pattern);

/// Places the nodes of the cloth at the start, but not the ends of its cords.
void placeCloth(const Scene& scene, const ClothPattern& pattern, Field3& position);

/// Positions of one cloth on its rail, with its carriers at these places [m]. hangs_through: between carriers the top
/// row stands out and hangs through, by the length that it has; else it is straight there, its links shorter.
void placeOnRail(const ClothPattern& pattern, const std::vector<double>& places, bool hangs_through, Field3& position);

/// Calls visit(node, other, rest length [m], is a rod) for every link, row by row; it is stored at `node`.
template <typename Visit>
void forEachLink(const ClothPattern& pattern, const Visit& visit) {
  const Grid& grid = pattern.grid;
  for (int i = 0; i < grid.rows; ++i) {
    for (int j = 0; j < grid.columns; ++j) {
      const std::size_t n = grid.index(i, j);
      if (i > 0) visit(n, grid.index(i - 1, j), pattern.warp_rest[n], true);
      if (grid.hasLink(i, j)) visit(n, grid.index(i, j > 0 ? j - 1 : grid.columns - 1), pattern.weft_rest[n], false);
    }
  }
}

/// Rest length of the shortest rod or weft link [m].
double shortestLink(const ClothPattern& pattern);

/// Calls visit(row, column on the right, column on the left) for all cells.
template <typename Visit>
void forEachCell(const Grid& grid, const Visit& visit) {
  for (int i = 0; i + 1 < grid.rows; ++i) {
    for (int j = grid.closed ? 0 : 1; j < grid.columns; ++j) {
      if (grid.hasQuad(i, j)) visit(i, j, j > 0 ? j - 1 : grid.columns - 1);
    }
  }
}

/// A value of the fabric of each cell, by the node at its top right: the mean of its corners'. value(Fabric): double.
template <typename Value>
Field perCell(const Grid& grid, const Layers& layers, const Value& value) {
  Field out(grid.size(), 0.0);
  const auto at = [&](int i, int j) { return value(layers.fabricAt(i, j)); };
  forEachCell(grid, [&](int i, int j, int left) {
    out[grid.index(i, j)] = 0.25 * ((at(i, left) + at(i, j)) + (at(i + 1, left) + at(i + 1, j)));
  });
  return out;
}

/// Least mass for each area of cloth at the corners of a cell [kg/m^2]; arguments as forEachCell() has them.
double lightestCorner(const ClothPattern& pattern, int row, int right, int left);

/// Area-weighted normals of the nodes: the sum, over the faces at a node, of the corner triangles' area vectors
/// [m^2], not normalised; out has the grid's size. Cheng 2000, Sect. 2.2.2 (mean of the normals of the faces).
void nodeAreaVectors(const Grid& grid, const Field3& position, Field3& out) noexcept;
/// Of one row.
void nodeAreaVectors(const Grid& grid, int row, const Field3& position, Field3& out) noexcept;

}  // namespace curtain
