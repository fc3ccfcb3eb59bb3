// SPDX-License-Identifier: BSD-3-Clause
#include "parts/bending/bending.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "cloth/wide.h"
#include "step/constants.h"

namespace curtain {
namespace {

double stiffestOf(const ClothPattern& pattern, const BendingLines& warp, const BendingLines& weft) {
  double stiffest = 0.0;
  for (std::size_t n = 0; n < pattern.grid.size(); ++n) {
    const double bound = (warp.bend() ? warp.bound[n] : 0.0) + (weft.bend() ? weft.bound[n] : 0.0);
    stiffest = std::max(stiffest, pattern.inverse_mass[n] * bound);
  }
  return stiffest;
}

int rowBlocks(const Grid& grid) { return (grid.rows + kLane - 1) / kLane; }

void clear(Field3& field) noexcept {
  for (Field* one : {&field.x, &field.y, &field.z}) std::fill(one->begin(), one->end(), 0.0);
}

// What acts on the ends of cords, which do not bend.
void copyEnds(const Grid& grid, const Field3& force, Field3& sum) noexcept {
  const auto from = static_cast<std::ptrdiff_t>(grid.row(grid.rows));
  const auto copy = [from](const Field& f, Field& to) { std::copy(f.begin() + from, f.end(), to.begin() + from); };
  copy(force.x, sum.x);
  copy(force.y, sum.y);
  copy(force.z, sum.z);
}

}  // namespace

Bending::Bending(const ClothPattern& pattern, const Workers& workers)
    : pattern_(pattern),
      workers_(workers),
      warp_(warpLines(pattern)),
      weft_(weftLines(pattern)),
      warp_rest_(pattern, true),
      weft_rest_(pattern, false),
      stiffest_(stiffestOf(pattern, warp_, weft_)) {
  if (!any()) return;
  const std::size_t size = pattern.grid.size();
  for (Field* give : {&warp_give_, &weft_give_}) give->assign(size, 0.0);
  for (Field3* field : {&sum_, &ahead_, &no_force_, &shears_.q, &shears_.spared}) field->assign(size, 0.0);
  scratch_.assign(pattern.grid);
  if (!warp_rest_.any() && !weft_rest_.any()) return;
  for (Field3* field : {&couples_, &moved_}) field->assign(size, 0.0);
}

void Bending::pinsChanged() noexcept {
  fillWarpLines(pattern_, warp_);
  fillWeftLines(pattern_, weft_);
  warp_rest_.pinsChanged();
  weft_rest_.pinsChanged();
  stiffest_ = stiffestOf(pattern_, warp_, weft_);
}

void Bending::begin(const NodeInertia& inertia, const Field& inverse, double scale, bool explicit_links) noexcept {
  if (!any()) return;
  const NodeInertia::Tensions& tensions = inertia.tensions();
  const double size = std::abs(scale);
  const double all = explicit_links ? kStablePhase * kStablePhase : kElasticBackward;
  const double limit = std::max(all - size * inertia.elastic(), std::min(all, kMinForElastic));
  const double per_load = explicit_links && tensions.scale != 0.0 ? 2.0 * size / std::abs(tensions.scale) : 0.0;
  gives_ = size * stiffest_ + per_load * tensions.heaviest > limit;
  if (gives_) setGive(inertia, inverse, size, per_load, limit);
}

// Both directions share what the step bears: halves, or what the other one leaves.
CURTAIN_WIDE void Bending::setGive(const NodeInertia& inertia, const Field& inverse, double scale, double per_load,
                                   double limit) noexcept {
  const double* const w = inverse.data();
  const double* const load = inertia.tensions().load.data();
  const double least = per_load > 0.0 ? kMinForElastic : limit;
  const auto give = [&](const BendingLines& lines, const BendingLines& other, Field& out) {
    const double* const own = lines.bound.data();
    const double* const others = other.bend() ? other.bound.data() : own;
    const double counts = other.bend() ? 1.0 : 0.0;
#pragma omp simd
    for (std::size_t n = 0; n < out.size(); ++n) {
      const double left = limit - per_load * load[n] * w[n];
      const double all = left > least ? left : least;  // of the step's limit, in m / scale
      const double without = all - counts * scale * w[n] * others[n], half = 0.5 * all;
      const double share = without > half ? without : half;
      const double stiff = scale * w[n] * own[n];
      out[n] = stiff > share ? scale * w[n] * (1.0 / share - 1.0 / stiff) : 0.0;
    }
  };
  if (warp_.bend()) give(warp_, weft_, warp_give_);
  if (weft_.bend()) give(weft_, warp_, weft_give_);
}

// sum = force - A x. Blocks of lines are independent; the weft follows the warp.
void Bending::addStraight(const Field3& force, const Field3& position, Field3& sum) noexcept {
  const Grid& grid = pattern_.grid;
  if (warp_.bend() && !gives_) {
    workers_.run(warpBlockCount(grid), [&](int block) { bendWarp(grid, warp_, force, position, block, sum); });
    copyEnds(grid, force, sum);
  } else {
    sum = force;
    if (warp_.bend()) addWarpGiving(position, sum);
  }
  if (!weft_.bend()) return;
  if (gives_) return addWeftGiving(position, true, sum);
  workers_.run(rowBlocks(grid), [&](int block) { bendWeft(grid, weft_, position, block, shears_, sum); });
}

void Bending::addWarpGiving(const Field3& position, Field3& sum) noexcept {
  const Grid& grid = pattern_.grid;
  workers_.run(warpBlockCount(grid),
               [&](int block) { bendWarpGiving(grid, warp_, warp_give_, position, block, scratch_, sum); });
}

void Bending::addWeftGiving(const Field3& position, bool spares, Field3& sum) noexcept {
  const Grid& grid = pattern_.grid;
  workers_.run(rowBlocks(grid), [&](int block) {
    bendWeftGiving(grid, weft_, weft_give_, position, block, scratch_, spares, shears_, sum);
  });
}

// Rest curvature of a direction, with the energy V at y = x - D A x: the force is (1 - A D) g, g = -V'(y). add: adds
// -A x of that direction. Returns V.
template <typename Add>
double Bending::addCouples(const RestCurvature& rest, const Field& give, const Add& add, const Field3& position,
                           Field3& force) noexcept {
  moved_ = position;
  if (gives_) {
    clear(couples_);
    add(position, couples_);
    for (std::size_t n = 0; n < give.size(); ++n) moved_.add(n, give[n] * couples_.at(n));
  }
  clear(couples_);
  const double energy = rest.addTo(moved_, couples_);
  for (std::size_t n = 0; n < give.size(); ++n) force.add(n, couples_.at(n));
  if (!gives_) return energy;
  for (std::size_t n = 0; n < give.size(); ++n) moved_.set(n, give[n] * couples_.at(n));
  add(moved_, force);
  return energy;
}

double Bending::addCurved(const Field3& position, Field3& force) noexcept {
  double energy = 0.0;
  if (warp_rest_.any()) {
    const auto warp = [this](const Field3& x, Field3& out) { addWarpGiving(x, out); };
    energy += addCouples(warp_rest_, warp_give_, warp, position, force);
  }
  if (weft_rest_.any()) {
    const auto weft = [this](const Field3& x, Field3& out) { addWeftGiving(x, false, out); };
    energy += addCouples(weft_rest_, weft_give_, weft, position, force);
  }
  return energy;
}

const Field3& Bending::addTo(const Field3& force, const Field3& position) noexcept {
  addStraight(force, position, sum_);
  addCurved(position, sum_);
  return sum_;
}

const Field3& Bending::addAhead(const SubstepStart& start, const Field& inverse) noexcept {
  setAhead(start, inverse, ahead_);
  return addTo(start.force, ahead_);
}

// Half the work of the last force over the cloth's extent: of forces that are homogeneous in the positions.
double Bending::halfWork(const Field3& outer, const Field3& position) const noexcept {
  return 0.5 *
         ((weft_.bend() ? workOfSpared(pattern_.grid, shears_.spared, position) : 0.0) - workOf(sum_, outer, position));
}

double Bending::energyAfter(const Field3& outer, const Field3& position) const noexcept {
  return halfWork(outer, position) + warp_rest_.constant() + weft_rest_.constant();
}

const Field3& Bending::forceAt(const Field3& position, double& energy) noexcept {
  addStraight(no_force_, position, sum_);
  energy = halfWork(no_force_, position);
  energy += addCurved(position, sum_);
  return sum_;
}

// Summed by lanes: the order does not depend on the register width. From the first node, which is nearer than the
// origin.
CURTAIN_WIDE double workOf(const Field3& with, const Field3& without, const Field3& position) noexcept {
  std::array<double, kLane> sums{};
  const auto add = [&](const Field& f, const Field& g, const Field& x) {
    const double *const a = f.data(), *const b = g.data(), *const at = x.data();
    const double origin = x.front();
    for (std::size_t n = 0; n < x.size(); n += kLane) {
#pragma omp simd
      for (std::size_t j = 0; j < kLane; ++j) sums[j] += (a[n + j] - b[n + j]) * (at[n + j] - origin);
    }
  };
  add(with.x, without.x, position.x);
  add(with.y, without.y, position.y);
  add(with.z, without.z, position.z);
  return std::accumulate(sums.begin(), sums.end(), 0.0);
}

bool Bending::explain(const ClothState&, double, Plan& plan) const {
  plan.push_back({"bending", any(),
                  !any()   ? "bending_warp and bending_weft are 0"
                  : gives_ ? "where lines are stiffer than the substeps bear, nodes give way"
                           : "explicit: substeps bear all of its stiffness"});
  return false;
}

}  // namespace curtain
