// SPDX-License-Identifier: BSD-3-Clause
//
// Cords: one-sided links |x_end - x_node| <= length from nodes of the cloth to ends, which are points beside it: of
// lines, fixed or loads, and of tie-backs, whose loops are cords to one point that are all as long as the loop reaches.
// Ends have rows of their own below the cloth's in every field (Grid::end_rows), with mass and weight but no air.
#pragma once

#include <cstddef>
#include <vector>

#include "cloth/field.h"

namespace curtain {

struct ClothPattern;

struct Cord {
  std::size_t node = 0;  ///< of the cloth
  std::size_t end = 0;   ///< in CordsPattern::ends
  double length = 0.0;   ///< [m]; a loop's: its radius
};

struct CordEnd {
  std::size_t node = 0;             ///< in the fields
  std::size_t first = 0, last = 0;  ///< its cords: [first, last)
  Vec3 start = Vec3::Zero();        ///< [m]
  bool load = false;                ///< it moves freely
};

/// A tie-back.
struct LoopPattern {
  std::size_t end = 0;  ///< in CordsPattern::ends
  double radius = 0.0;  ///< that it shrinks to [m]
  double speed = 0.0;   ///< at which it does [m/s]
  bool closed = false;  ///< at the start
};

struct CordsPattern {
  std::vector<Cord> cords;         ///< end by end
  std::vector<CordEnd> ends;       ///< of the scene's lines, then of its tie-backs
  std::vector<LoopPattern> loops;  ///< the tie-backs

  bool empty() const { return cords.empty(); }
};

/// Makes room for the ends of a validated scene.
void addEndRows(const Scene& scene, Grid& grid);
/// Lengths and ends from where the cloth starts; masses of the loads.
void fillCords(const Scene& scene, ClothPattern& pattern);

/// How far a loop must reach for all of its nodes to be within it, and not less than its radius [m].
double reachOf(const CordsPattern& cords, std::size_t loop, const Field3& position);

/// What of the lengths of lines and the places of tie-backs does not fit where the cloth starts.
std::vector<Problem> problemsAtStart(const Scene& scene, const ClothPattern& pattern);

}  // namespace curtain
