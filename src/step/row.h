// SPDX-License-Identifier: BSD-3-Clause
//
// What constrains the cloth beside its rods and strings: a few nodes, along a direction. Contacts and bounded
// distances make rows for NetSolver, which knows of neither, and take up what it has found.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "cloth/cloth.h"

namespace curtain {

/// A multiplier m of it moves node k by inverse inertia * weight_k * m * direction. The solve looks for the change of m
/// that takes the violation away.
struct Row {
  std::array<std::uint32_t, 4> node{};  ///< in the grid's fields
  std::array<double, 4> weight{};
  int nodes = 0;  ///< how many of the four are used
  Vec3 direction = Vec3::Zero();
  double violation = 0.0;  ///< by how much sum of weight * direction . position is to grow [m], or velocity [m/s]
  double least = -std::numeric_limits<double>::infinity();  ///< lower bound of the change [kg m]
  bool active = true;          ///< takes part from the start; one that does not may join, where the solve allows it
  bool with_rods = false;      ///< what the rods pull back by is taken up together with it: see NetSolver::rodsAnswer()
  double compliance = 0.0;     ///< by how much less it is to grow for each unit of the multiplier [1/kg], >= 0
  double least_damping = 0.0;  ///< Levenberg-Marquardt term over the diagonal, if that is larger than the solve's
  std::uint32_t key = 0;       ///< for its maker
  double change = 0.0;         ///< out: of the multiplier [kg m], or its rate
};

using Rows = std::vector<Row>;

/// One maker's part of all rows.
struct RowRange {
  const Row* first = nullptr;
  const Row* last = nullptr;

  const Row* begin() const noexcept { return first; }
  const Row* end() const noexcept { return last; }
};

}  // namespace curtain
