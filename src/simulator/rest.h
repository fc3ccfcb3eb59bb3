// SPDX-License-Identifier: BSD-3-Clause
//
// Whether the cloth sleeps. It falls asleep when all of it has stayed in one place for a while, and wakes before
// anything could move it: a part (Part::wakes()), an obstacle on its way (approachedBy()), a change by the user. Parts
// may keep it awake. Without gravity it does not sleep, since nothing brings it to rest.
// Times are those of the motion, which may be slower than the clock (solver.budget_ms).
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <vector>

#include "cloth/cloth.h"
#include "obstacles/obstacle_set.h"

namespace curtain {

class Rest {
 public:
  /// Both must outlive this.
  Rest(const Scene& scene, const ClothPattern& pattern);

  /// Updates what depends on the scene. damping_per_mass: the largest of any node [1/s]: overdamped cloth creeps back
  /// to rest, so it must be slower.
  void setLimits(double damping_per_mass) noexcept;

  /// Whether the cloth may rest at all.
  bool can() const noexcept { return radius_ > 0.0; }
  bool asleep() const noexcept { return asleep_; }
  /// It sleeps, or may soon: disturb() must be called.
  bool watches() const noexcept { return asleep_ || !std::isnan(since_); }
  /// Something is about to move the cloth: it starts resting again, and the next wake() wakes it.
  void disturb() noexcept {
    disturbed_ = true;
    since_ = kNone;
  }

  /// Disturbs cloth near obstacles that have moved since the last frame or will in this one. Sets the obstacles'
  /// substep to the whole frame.
  void approachedBy(ObstacleSet& obstacles) noexcept;

  /// Wakes the cloth if it was disturbed. True: it slept.
  bool wake() noexcept;

  /// To be called after each frame with motion; true: it is time to check().
  bool due() noexcept;
  /// Puts cloth at rest to sleep. kept_awake: by a part; touches: a contact pushed in the last substep. True: it
  /// fell asleep.
  bool check(const ClothState& state, double time, bool kept_awake, bool touches) noexcept;

  void forget() noexcept;

  std::int64_t wakes() const noexcept { return wakes_; }
  /// Counts on from there.
  void countOn(std::int64_t wakes) noexcept { wakes_ = wakes; }

  void serialize(Archive& archive);

 private:
  static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

  bool isSlow(const Field3& velocity) const noexcept;
  bool isInPlace(const Field3& position) const noexcept;
  bool rests(const ClothState& state, double time) noexcept;
  Eigen::AlignedBox3d boxOf(int column, const Field3& position) const noexcept;
  void setBoxes(const Field3& position) noexcept;
  bool isNear(const Eigen::AlignedBox3d& box) const noexcept;

  const Scene& scene_;
  const ClothPattern& pattern_;
  double margin_;         // around the cloth, for obstacles [m]
  double radius_ = 0.0;   // that nodes of resting cloth stay within [m]; 0: it never rests
  double jitter_ = 0.0;   // the same for cloth in contact [m]
  double allowed_ = 0.0;  // the radius used in this look [m]
  int due_in_ = 1;        // frames
  std::size_t turn_ = 0;
  bool asleep_ = false, disturbed_ = false;
  double since_ = kNone;  // time since which the cloth has been in place [s]; NaN: it has no place
  Field3 place_;
  std::vector<Eigen::AlignedBox3d> box_;  // of sleeping cloth's columns, with margin
  Eigen::AlignedBox3d all_;               // of all of them
  Eigen::AlignedBox3d swept_;             // by obstacles since the last look
  std::int64_t wakes_ = 0;
};

}  // namespace curtain
