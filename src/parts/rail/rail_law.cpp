// SPDX-License-Identifier: BSD-3-Clause
#include "parts/rail/rail_law.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace curtain {

RailLaw::RailLaw(std::size_t carriers, double gap, double length)
    : gap_(gap),
      most_(std::max(0.0, length - gap * static_cast<double>(carriers > 0 ? carriers - 1 : 0))),
      pool_(carriers) {
  kinks_.reserve(2 * carriers);
}

// The u at which the derivative of the terms of rows [first, end) changes its sign. It is M u - sum m w + (bounds of
// the kinks below u) - (bounds of those above).
double RailLaw::minimum(const RailRow* rows, std::size_t first, std::size_t end) noexcept {
  double mass = 0.0, moment = 0.0;
  kinks_.clear();
  for (std::size_t i = first; i < end; ++i) {
    const RailRow& row = rows[i];
    mass += row.mass;
    moment += row.mass * (row.wish - shift(i));
    for (const RailPull* pull : {&row.friction, &row.drive}) {
      if (pull->bound > 0.0) kinks_.push_back({pull->at - shift(i), pull->bound});
    }
  }
  std::sort(kinks_.begin(), kinks_.end(), [](const Kink& a, const Kink& b) { return a.at < b.at; });
  double below = 0.0;
  for (std::size_t k = 0; k < kinks_.size(); ++k) {
    // Summed again, since a bound may be infinite.
    double above = 0.0;
    for (std::size_t n = k; n < kinks_.size(); ++n) above += kinks_[n].bound;
    const double u = (moment - below + above) / mass;
    if (u < kinks_[k].at) return u;
    const double after = mass * kinks_[k].at - moment + below + kinks_[k].bound - (above - kinks_[k].bound);
    if (after >= 0.0 || kinks_[k].bound == std::numeric_limits<double>::infinity()) return kinks_[k].at;
    below += kinks_[k].bound;
  }
  return (moment - below) / mass;
}

void RailLaw::solve(RailRow* rows) noexcept {
  pools_ = 0;
  for (std::size_t i = 0; i < pool_.size(); ++i) {
    Pool pool{i, i + 1, minimum(rows, i, i + 1)};
    while (pools_ > 0 && pool_[pools_ - 1].u > pool.u) {
      pool.first = pool_[--pools_].first;
      pool.u = minimum(rows, pool.first, pool.end);
    }
    pool_[pools_++] = pool;
  }
  for (std::size_t p = 0; p < pools_; ++p) {
    pool_[p].u = std::clamp(pool_[p].u, 0.0, most_);
    settle(pool_[p], rows);
    share(pool_[p], rows);
  }
}

void RailLaw::settle(const Pool& pool, RailRow* rows) const noexcept {
  const bool stopped = pool.u == 0.0 || pool.u == most_;
  bool stays = stopped;
  for (std::size_t i = pool.first; i < pool.end; ++i) {
    RailRow& row = rows[i];
    row.place = pool.u + shift(i);
    for (const RailPull* pull : {&row.friction, &row.drive}) {
      if (!(pull->bound > 0.0) || pull->at - shift(i) != pool.u) continue;
      stays = true;
      row.place = pull->at;  // without the rounding of the shift: what stays, stays to the bit
    }
  }
  for (std::size_t i = pool.first; i < pool.end; ++i) rows[i].stays = stays;
}

// Divides the force on a run among friction and drive: friction does what it can before the drive does anything.
void RailLaw::share(const Pool& pool, RailRow* rows) const noexcept {
  double needed = 0.0, rubs = 0.0;  // multiplier that has not been found a source for; bound of friction at rest
  for (std::size_t i = pool.first; i < pool.end; ++i) {
    RailRow& row = rows[i];
    needed += row.mass * (row.place - row.wish);
    const double slips = row.place - row.friction.at, lacks = row.drive.at - row.place;
    if (slips == 0.0)
      rubs += row.friction.bound;
    else
      needed += std::copysign(row.friction.bound, slips);
    row.drawn = 0.0;
    if (lacks == 0.0 || !(row.drive.bound > 0.0)) continue;
    row.drawn = std::copysign(row.drive.bound, lacks);
    needed -= row.drawn;
  }
  needed = std::copysign(std::max(0.0, std::abs(needed) - rubs), needed);
  for (std::size_t i = pool.first; i < pool.end; ++i) {
    RailRow& row = rows[i];
    if (!(row.drive.bound > 0.0) || row.drive.at != row.place) continue;
    row.drawn = std::clamp(needed, -row.drive.bound, row.drive.bound);
    needed -= row.drawn;
  }
}

}  // namespace curtain
