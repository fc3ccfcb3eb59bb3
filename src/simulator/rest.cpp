// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/rest.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "cloth/wide.h"

namespace curtain {
namespace {

// Cloth that stays in place this long rests [s]. A pendulum of 2 m stays as slow at its turning point within 0.13 of
// its amplitude.
constexpr double kWindow = 0.5;
// Pauses between looks at the cloth [kPauseUnit]: unequal, since a motion in step with them would seem to rest.
constexpr std::array<int, 4> kPauses = {7, 9, 5, 11};
constexpr double kPauseUnit = 1.0 / 60.0;
constexpr double kLongestFrame = 1.0 / 20.0;
// The cloth is measured only if its sampled nodes are slower than this many times rest_speed: far from 1, since contact
// jitters without moving it.
constexpr double kMeasureSpeed = 50.0;
// Jitter of cloth in contact, in link tolerances: the solve may leave nodes anywhere within them. Up to 5 were seen in
// half a second (a sheet on a ball).
constexpr double kJitter = 8.0;
// Lowest frequency of a hanging chain of length L: 1.2024 sqrt(g / L) (half the first zero of the Bessel function J0).
constexpr double kLowestFrequency = 1.2024;

}  // namespace

Rest::Rest(const Scene& scene, const ClothPattern& pattern)
    : scene_(scene),
      pattern_(pattern),
      margin_(2.0 * scene.contact.thickness),
      box_(static_cast<std::size_t>(pattern.grid.columns)) {
  place_.assign(pattern.grid.size(), 0.0);
}

// A swing of this speed has an amplitude of speed / omega. Overdamped cloth as far from rest is slower, by omega m / c.
void Rest::setLimits(double damping_per_mass) noexcept {
  const SolverParams& solver = scene_.solver;
  jitter_ = kJitter * solver.stretch_tolerance * shortestLink(pattern_);
  const bool asks = solver.position_tolerance > 0.0;
  const double speed = asks ? std::min(solver.rest_speed, solver.position_tolerance) : solver.rest_speed;
  const double gravity = scene_.gravity.norm(), omega = kLowestFrequency * std::sqrt(gravity / longestWarp(scene_));
  const double slower = damping_per_mass > omega ? omega / damping_per_mass : 1.0;
  // Longer frames say too little of the motion between them.
  const bool can_rest = gravity > 0.0 && 1.0 / solver.frame_rate <= kLongestFrame;
  radius_ = can_rest ? speed * slower * kWindow : 0.0;
}

void Rest::forget() noexcept {
  asleep_ = disturbed_ = false;
  since_ = kNone;
  due_in_ = 1;
  turn_ = 0;
  wakes_ = 0;
  swept_.setEmpty();
}

// Whether a look is due.
bool Rest::due() noexcept {
  if (radius_ <= 0.0 || --due_in_ > 0) return false;
  due_in_ = std::max(1, static_cast<int>(std::lround(kPauses[turn_] * kPauseUnit / (1.0 / scene_.solver.frame_rate))));
  turn_ = (turn_ + 1) % kPauses.size();
  return true;
}

// Samples three nodes a column; mostly that is all there is to do.
bool Rest::isSlow(const Field3& velocity) const noexcept {
  const Grid& grid = pattern_.grid;
  const double limit = kMeasureSpeed * radius_ / kWindow;
  for (const int i : {grid.rows - 1, grid.rows / 2, grid.rows / 4}) {
    for (int j = 0; j < grid.columns; ++j) {
      if (!(velocity.at(grid.index(i, j)).squaredNorm() <= limit * limit)) return false;
    }
  }
  return true;
}

// No node, and no end of a cord, which may be a load that swings, is further from its place than allowed.
CURTAIN_WIDE bool Rest::isInPlace(const Field3& position) const noexcept {
  const Grid& grid = pattern_.grid;
  double farthest = 0.0;  // squared
  for (int i = 0; i < grid.allRows(); ++i) {
    const std::size_t row = grid.row(i);
    const ConstFieldView p(position, row), place(place_, row);
#pragma omp simd reduction(max : farthest)
    for (int j = 0; j < grid.columns; ++j) {
      const double dx = p.x[j] - place.x[j], dy = p.y[j] - place.y[j], dz = p.z[j] - place.z[j];
      const double square = dx * dx + dy * dy + dz * dz;
      farthest = farthest > square ? farthest : square;
    }
  }
  return farthest <= allowed_ * allowed_;
}

bool Rest::rests(const ClothState& state, double time) noexcept {
  if (!isSlow(state.velocity)) {
    since_ = kNone;
    return false;
  }
  if (std::isnan(since_) || !isInPlace(state.position)) {
    place_ = state.position;
    since_ = time;
    return false;
  }
  if (time - since_ < kWindow) return false;
  setBoxes(state.position);
  if (swept_.isEmpty() || !isNear(swept_)) return true;
  since_ = kNone;
  return false;
}

bool Rest::check(const ClothState& state, double time, bool kept_awake, bool touches) noexcept {
  allowed_ = touches ? std::max(radius_, jitter_) : radius_;
  const bool rest = rests(state, time);
  swept_.setEmpty();
  if (!rest || kept_awake) return false;
  asleep_ = true;
  disturbed_ = false;
  return true;
}

Eigen::AlignedBox3d Rest::boxOf(int column, const Field3& position) const noexcept {
  const Grid& grid = pattern_.grid;
  Eigen::AlignedBox3d box;
  for (const int k : {column - 1, column, column + 1}) {  // faces reach to the columns on both sides
    const int at = grid.closed ? (k + grid.columns) % grid.columns : std::clamp(k, 0, grid.columns - 1);
    for (int i = 0; i < grid.rows; ++i) box.extend(position.at(grid.index(i, at)));
  }
  box.min().array() -= margin_ + allowed_;
  box.max().array() += margin_ + allowed_;
  return box;
}

void Rest::setBoxes(const Field3& position) noexcept {
  all_.setEmpty();
  for (int j = 0; j < pattern_.grid.columns; ++j) {
    box_[static_cast<std::size_t>(j)] = boxOf(j, position);
    all_.extend(box_[static_cast<std::size_t>(j)]);
  }
}

bool Rest::isNear(const Eigen::AlignedBox3d& box) const noexcept {
  return box.intersects(all_) && std::any_of(box_.begin(), box_.end(),
                                             [&](const Eigen::AlignedBox3d& column) { return box.intersects(column); });
}

void Rest::approachedBy(ObstacleSet& obstacles) noexcept {
  if (!obstacles.anyMoved()) return;
  obstacles.setSubstep(0.0, 1.0);
  for (int index = 0; index < obstacles.count(); ++index) {
    if (!obstacles.moved(index)) continue;
    Eigen::AlignedBox3d box = obstacles.leftBox(index);  // where it jumped away from
    if (obstacles.present(index)) box.extend(obstacles.sweptBounds(index));
    swept_.extend(box);
    if (asleep_ && isNear(box)) disturb();
  }
}

bool Rest::wake() noexcept {
  const bool wakes = asleep_ && disturbed_;
  disturbed_ = false;
  if (!wakes) return false;
  asleep_ = false;
  ++wakes_;
  return true;
}

}  // namespace curtain
