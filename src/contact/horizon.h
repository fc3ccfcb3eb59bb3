// SPDX-License-Identifier: BSD-3-Clause
//
// For how long what was found near stays all there is: nodes are expected to go straight on, and as long as none strays
// from its expected way by more than a slack, what was looked for within reach + 2 slack holds everything within reach.
#pragma once

#include "cloth/cloth.h"

namespace curtain {

class Horizon {
 public:
  explicit Horizon(const Grid& grid) : grid_(grid) {
    start_.assign(grid.size(), 0.0);
    end_.assign(grid.size(), 0.0);
  }

  /// Nodes go from start to predicted within h [s] and on like that for `length` >= h [s]; slack > 0 [m].
  void set(const Field3& start, const Field3& predicted, double h, double length, double slack) noexcept;
  void forget() noexcept { length_ = 0.0; }

  /// Time goes on.
  void advance(double h) noexcept { elapsed_ += h; }
  /// It reaches a substep of h from now.
  bool reaches(double h) const noexcept { return elapsed_ + h <= length_ * (1.0 + 1e-9); }
  /// How far the node that strays most is off its expected way, h from now [m]; infinite when one is not finite.
  double strayed(const Field3& position, double h) const noexcept;

  const Field3& start() const noexcept { return start_; }
  const Field3& end() const noexcept { return end_; }
  double slack() const noexcept { return slack_; }

 private:
  Grid grid_;
  Field3 start_, end_;    // where nodes were, and are expected at the end [m]
  double length_ = 0.0;   // [s]; 0 = there is none
  double elapsed_ = 0.0;  // [s]
  double slack_ = 0.0;    // [m]
};

}  // namespace curtain
