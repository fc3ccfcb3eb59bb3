// SPDX-License-Identifier: BSD-3-Clause
//
// What a rail does to its carriers in a substep: friction, drive, gaps between neighbours and stops at its ends. All of
// it together is one convex problem: the places s that minimise
//
//     sum_i  m_i (s_i - w_i)^2 / 2  +  b_i |s_i - c_i|  +  d_i |s_i - t_i|,
//     s_(i+1) - s_i >= gap,  0 <= s_i <= length.
//
// w_i is where carrier i would be without the rail's forces. b_i is the bound of its friction, c_i where it was: it
// stays there until that bound is reached. d_i is the bound of the drive's force, t_i where that draws it to. Both
// bounds are in the multipliers' unit [kg m]: force times h kick. Impacts are inelastic.
//
// With u_i = s_i - i gap the order is u_i <= u_(i+1), which makes it an isotonic regression: solved exactly by pooling
// neighbours that would overtake (Ayer et al. 1955; for convex terms: Best, Chakravarti, Ubhaya 2000), then bounding u.
#pragma once

#include <cstddef>
#include <vector>

namespace curtain {

/// A force towards a place: b |s - at|.
struct RailPull {
  double at = 0.0;     ///< [m]
  double bound = 0.0;  ///< of the force's multiplier [kg m], >= 0; infinite: it stays there
};

/// A carrier of the problem, and of its solution.
struct RailRow {
  double mass = 0.0;   ///< [kg], > 0
  double wish = 0.0;   ///< w [m]
  RailPull friction;   ///< towards where it was
  RailPull drive;      ///< towards where it is drawn
  double place = 0.0;  ///< out: s [m]
  bool stays = false;  ///< out: a small change of the wish does not move it
  double drawn = 0.0;  ///< out: multiplier of the drive's force on it, along s [kg m]
};

/// Not thread-safe. Allocates only in the constructor.
class RailLaw {
 public:
  RailLaw(std::size_t carriers, double gap, double length);

  /// rows: as many as carriers, in their order.
  void solve(RailRow* rows) noexcept;

  /// Calls visit(first, end) for the runs of carriers that touch, of the last solution.
  template <typename Visit>
  void forEachRun(const Visit& visit) const {
    for (std::size_t p = 0; p < pools_; ++p) visit(pool_[p].first, pool_[p].end);
  }

 private:
  // Carriers [first, end) that touch, at u.
  struct Pool {
    std::size_t first, end;
    double u;
  };
  struct Kink {
    double at, bound;
  };
  double minimum(const RailRow* rows, std::size_t first, std::size_t end) noexcept;
  void settle(const Pool& pool, RailRow* rows) const noexcept;
  void share(const Pool& pool, RailRow* rows) const noexcept;
  double shift(std::size_t index) const noexcept { return gap_ * static_cast<double>(index); }

  const double gap_, most_;  // [m]; bound of u
  std::vector<Pool> pool_;
  std::size_t pools_ = 0;
  std::vector<Kink> kinks_;
};

}  // namespace curtain
