// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/rest.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "cloth/wide.h"

namespace curtain {
namespace {

// A column that stays in place this long rests [s]. A pendulum of 2 m stays as slow at its turning point within 0.13 of
// its amplitude.
constexpr double kWindow = 0.5;
// Pauses between looks at the cloth [kPauseUnit]: unequal, since a motion in step with them would seem to rest.
constexpr std::array<int, 4> kPauses = {7, 9, 5, 11};
constexpr double kPauseUnit = 1.0 / 60.0;
constexpr double kLongestFrame = 1.0 / 20.0;
// A column is measured only if its sampled nodes are slower than this many times rest_speed: far from 1, since contact
// jitters without moving the cloth.
constexpr double kMeasureSpeed = 50.0;
// Jitter of cloth in contact, in link tolerances: the solve may leave nodes anywhere within them. Up to 5 were seen in
// half a second (a sheet on a ball).
constexpr double kJitter = 8.0;
// After its neighbours have woken it, a column does not sleep alone for this long [s], and twice as long each time.
constexpr double kAloneAgain = 2.0, kLongestPause = 64.0;
// Lowest frequency of a hanging chain of length L: 1.2024 sqrt(g / L) (half the first zero of the Bessel function J0).
constexpr double kLowestFrequency = 1.2024;
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

}  // namespace

Rest::Rest(const ClothPattern& pattern, double frame_length, double thickness, double stretch_tolerance)
    : pattern_(pattern),
      frame_length_(frame_length),
      margin_(2.0 * thickness),
      jitter_(kJitter * stretch_tolerance * shortestLink(pattern)),
      asleep_(pattern.grid.columns),
      disturbed_(pattern.grid.columns),
      quiet_(pattern.grid.columns),
      touching_(pattern.grid.columns),
      still_(static_cast<std::size_t>(pattern.grid.columns), 0),
      since_(static_cast<std::size_t>(pattern.grid.columns), kNone),
      alone_from_(static_cast<std::size_t>(pattern.grid.columns), 0.0),
      alone_pause_(static_cast<std::size_t>(pattern.grid.columns), kAloneAgain),
      farthest_(static_cast<std::size_t>(pattern.grid.stride), 0.0),
      box_(static_cast<std::size_t>(pattern.grid.columns)) {
  place_.assign(pattern.grid.size(), 0.0);
}

void Rest::takeStretchTolerance(double tolerance) noexcept { jitter_ = kJitter * tolerance * shortestLink(pattern_); }

// A swing of this speed has an amplitude of speed / omega. Overdamped cloth as far from rest is slower, by omega m / c.
void Rest::setLimits(double speed, double gravity, double damping_per_mass, double height) noexcept {
  const double omega = kLowestFrequency * std::sqrt(gravity / height);
  const double slower = damping_per_mass > omega ? omega / damping_per_mass : 1.0;
  // Longer frames say too little of the motion between them.
  const bool can_rest = gravity > 0.0 && frame_length_ <= kLongestFrame;
  radius_ = can_rest ? speed * slower * kWindow : 0.0;
}

void Rest::forget() noexcept {
  asleep_.clear();
  disturbed_.clear();
  std::fill(since_.begin(), since_.end(), kNone);
  std::fill(alone_from_.begin(), alone_from_.end(), 0.0);
  std::fill(alone_pause_.begin(), alone_pause_.end(), kAloneAgain);
  due_in_ = 1;
  turn_ = 0;
  wakes_ = 0;
  pressed_ = false;
  watches_ = false;
  swept_.setEmpty();
}

// Whether a look is due.
bool Rest::due() noexcept {
  if (radius_ <= 0.0 || --due_in_ > 0) return false;
  due_in_ = std::max(1, static_cast<int>(std::lround(kPauses[turn_] * kPauseUnit / frame_length_)));
  turn_ = (turn_ + 1) % kPauses.size();
  return true;
}

// Samples three nodes a column; mostly that is all there is to do.
bool Rest::anyStill(const Field3& velocity) noexcept {
  const Grid& grid = pattern_.grid;
  const double limit = kMeasureSpeed * radius_ / kWindow;
  bool any = false;
  for (int j = 0; j < grid.columns; ++j) {
    bool still = !asleep_.has(j);
    for (const int i : {grid.rows - 1, grid.rows / 2, grid.rows / 4}) {
      still = still && velocity.at(grid.index(i, j)).squaredNorm() <= limit * limit;
    }
    still_[static_cast<std::size_t>(j)] = still ? 1 : 0;
    if (!still) since_[static_cast<std::size_t>(j)] = kNone;
    any = any || still;
  }
  return any;
}

// Measures how far the nodes of every column are from their place. A cord's end, which may be a load that swings,
// counts as a node of the column that it is stored in.
CURTAIN_WIDE void Rest::measure(const Field3& position) noexcept {
  const Grid& grid = pattern_.grid;
  double* const farthest = farthest_.data();
  std::fill(farthest_.begin(), farthest_.end(), 0.0);
  for (int i = 0; i < grid.allRows(); ++i) {
    const std::size_t row = grid.row(i);
    const ConstFieldView p(position, row), place(place_, row);
#pragma omp simd
    for (int j = 0; j < grid.columns; ++j) {
      const double dx = p.x[j] - place.x[j], dy = p.y[j] - place.y[j], dz = p.z[j] - place.z[j];
      const double square = dx * dx + dy * dy + dz * dz;
      farthest[j] = farthest[j] > square ? farthest[j] : square;
    }
  }
}

void Rest::takePlace(int column, const Field3& position, double time) noexcept {
  for (int i = 0; i < pattern_.grid.allRows(); ++i) {
    const std::size_t n = pattern_.grid.index(i, column);
    place_.set(n, position.at(n));
  }
  since_[static_cast<std::size_t>(column)] = time;
}

bool Rest::quiet(int column, const Field3& position, double time) noexcept {
  const auto at = static_cast<std::size_t>(column);
  if (still_[at] == 0) return false;
  if (std::isnan(since_[at]) || !(farthest_[at] <= allowed_ * allowed_)) {
    takePlace(column, position, time);
    return false;
  }
  if (time - since_[at] < kWindow) return false;
  if (swept_.isEmpty() || !swept_.intersects(boxOf(column, position))) return true;
  since_[at] = kNone;
  return false;
}

void Rest::markTouching(const Contacts* contacts) noexcept {
  touching_.clear();
  if (contacts == nullptr) return;
  const auto stride = static_cast<std::uint32_t>(pattern_.grid.stride);
  for (const Contact& contact : *contacts) {
    if (!contact.pushes()) continue;
    for (int k = 0; k < contact.nodes; ++k) {
      touching_.add(static_cast<int>(contact.node[static_cast<std::size_t>(k)] % stride));
    }
  }
}

bool Rest::look(const ClothState& state, double time, const ColumnSet& kept_awake, const Contacts* contacts,
                bool by_column) noexcept {
  const int columns = pattern_.grid.columns;
  markTouching(contacts);
  allowed_ = touching_.empty() ? radius_ : std::max(radius_, jitter_);
  quiet_.clear();
  if (anyStill(state.velocity)) {
    measure(state.position);
    for (int j = 0; j < columns; ++j) {
      if (quiet(j, state.position, time) && !kept_awake.has(j)) quiet_.add(j);
    }
  }
  swept_.setEmpty();
  watches_ = std::any_of(since_.begin(), since_.end(), [](double since) { return !std::isnan(since); });
  if (quiet_.empty()) return false;
  const bool all = quiet_.count() + asleep_.count() == columns;
  const int before = asleep_.count();
  for (int j = 0; j < columns && (all || by_column); ++j) {
    // A column that presses on something sleeps only with the whole cloth: others still need its push.
    const bool alone = !touching_.has(j) && time >= alone_from_[static_cast<std::size_t>(j)];
    if (quiet_.has(j) && (all || alone)) asleep_.add(j);
  }
  if (asleep_.count() == before) return false;
  pressed_ = all && !touching_.empty();
  fallAsleep(state.position);
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

void Rest::fallAsleep(const Field3& position) noexcept {
  all_.setEmpty();
  disturbed_.clear();
  for (int j = 0; j < pattern_.grid.columns; ++j) {
    if (!asleep_.has(j)) continue;
    box_[static_cast<std::size_t>(j)] = boxOf(j, position);
    all_.extend(box_[static_cast<std::size_t>(j)]);
  }
}

void Rest::approachedBy(ObstacleSet& obstacles) noexcept {
  if (!obstacles.anyMoved()) return;
  obstacles.setSubstep(0.0, 1.0);
  for (int index = 0; index < obstacles.count(); ++index) {
    if (!obstacles.moved(index)) continue;
    Eigen::AlignedBox3d box = obstacles.leftBox(index);  // where it jumped away from
    if (obstacles.present(index)) box.extend(obstacles.sweptBounds(index));
    swept_.extend(box);
    if (asleep_.empty() || !box.intersects(all_)) continue;
    for (int j = 0; j < pattern_.grid.columns; ++j) {
      if (asleep_.has(j) && box.intersects(box_[static_cast<std::size_t>(j)])) disturbed_.add(j);
    }
  }
}

// Wakes the marked columns and the sleeping runs that they belong to; calls woken(column) for each.
template <typename Woken>
bool Rest::wakeRuns(const ColumnSet& marked, const Woken& woken) noexcept {
  const int columns = pattern_.grid.columns;
  const int before = asleep_.count();
  const auto wakeOne = [&](int j) {
    asleep_.remove(j);
    woken(j);
  };
  for (int j = 0; j < columns; ++j) {
    if (!(pressed_ || marked.has(j)) || !asleep_.has(j)) continue;
    wakeOne(j);
    for (const int way : {-1, 1}) {
      for (int k = j + way;; k += way) {
        if (pattern_.grid.closed) k = (k + columns) % columns;
        if (k < 0 || k >= columns || !asleep_.has(k)) break;
        wakeOne(k);
      }
    }
  }
  if (asleep_.count() == before) return false;
  pressed_ = false;
  ++wakes_;
  return true;
}

bool Rest::wake() noexcept {
  if (disturbed_.empty()) return false;
  for (int j = 0; j < pattern_.grid.columns; ++j) {
    if (!disturbed_.has(j)) continue;
    since_[static_cast<std::size_t>(j)] = kNone;
    alone_pause_[static_cast<std::size_t>(j)] = kAloneAgain;
  }
  const bool woke = wakeRuns(disturbed_, [&](int j) { since_[static_cast<std::size_t>(j)] = kNone; });
  disturbed_.clear();
  return woke;
}

bool Rest::wakeFor(const ColumnSet& pulled, double time) noexcept {
  return wakeRuns(pulled, [&](int j) {
    double& pause = alone_pause_[static_cast<std::size_t>(j)];
    alone_from_[static_cast<std::size_t>(j)] = time + pause;
    pause = std::min(2.0 * pause, kLongestPause);
  });
}

}  // namespace curtain
