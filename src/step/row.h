// SPDX-License-Identifier: BSD-3-Clause
//
// What constrains the cloth beside its rods and strings: a few nodes, along a direction. NetSolver knows
// the rows alone, Constraints who makes them: bounded distances and contacts.
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
  double least = -std::numeric_limits<double>::infinity();  ///< lower bound of the change [kg m]; rates: none
  bool active = true;        ///< takes part from the start; one that does not may join, where the solve allows it
  double compliance = 0.0;   ///< by how much less it is to grow for each unit of the multiplier [1/kg], >= 0
  double min_damping = 0.0;  ///< Levenberg-Marquardt term over the diagonal, if that is larger than the solve's
  std::uint32_t key = 0;     ///< for its maker
  double change = 0.0;       ///< out: of the multiplier [kg m], or its rate
};

using Rows = std::vector<Row>;

/// Who constrains the cloth so. Keeps the multipliers, for whose changes Constraints solves, of all makers at once. Not
/// thread-safe. Allocates in addRows() and saveIterate() alone, for more rows than were expected.
class RowMaker {
 public:
  virtual ~RowMaker() = default;

  /// Adds a row for each constraint that takes part, or may join, at these positions; rates: that acted in the last
  /// substep, for these velocities.
  virtual void addRows(const Field3& value, bool rates, Rows& rows) const = 0;
  /// Adds a share of what was found for its rows to the multipliers, within their bounds, where nodes have been
  /// moved by the whole share; moves them back from what is beyond.
  virtual void applyChange(const Rows& rows, double share, const Field& inverse, Field3& position) noexcept = 0;
  /// Moves velocities by what was found for its rows.
  virtual void moveBy(const Rows& rows, const Field& inverse, Field3& velocity) noexcept = 0;
  /// Adds the squares of its violations, over a typical link's length.
  virtual void addSquares(const Field3& position, double& sum) const noexcept = 0;
  /// Largest rate of a violation, over a typical link's length [1/s].
  virtual double measureRates(const Field3& velocity) noexcept = 0;
  /// Moves velocities by what its constraints acted with in the last substep, times share.
  virtual void spread(double share, const Field& inverse, Field3& velocity) const noexcept = 0;
  /// The multipliers to return to when a sweep made things worse.
  virtual void saveIterate() = 0;
  virtual void restoreIterate() noexcept = 0;

  std::size_t first_row = 0, end_row = 0;  ///< its own among all, as they were added
};

}  // namespace curtain
