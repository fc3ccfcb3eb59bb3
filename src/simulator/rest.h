// SPDX-License-Identifier: BSD-3-Clause
//
// Which columns of the cloth sleep. A column falls asleep when it has stayed in one place for a while. It wakes, with
// its whole run of sleeping columns, before anything could move it:
//
//   a wind that reaches it, or a drag, begins, ends, changes      ForceField marks it (disturbed())
//   an obstacle moves, comes or goes near it                      approachedBy()
//   a pin is moved; gravity or air change                         disturbAll()
//   its neighbours pull at it, or touch it                        the solver detects it (HeldColumns) and the substep
//   is
//                                                                 repeated with it awake
//
// Gusts keep the columns they reach awake. Without gravity nothing sleeps, since nothing brings the cloth to rest.
// Times are those of the motion, which may be slower than the clock (solver.budget_ms).
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "cloth/cloth.h"
#include "cloth/column_set.h"
#include "contact/shapes/obstacle_set.h"
#include "solver/contacts.h"

namespace curtain {

class Rest {
 public:
  /// frame_length [s]; thickness: of contact [m]; stretch_tolerance: of links. pattern must outlive this.
  Rest(const ClothPattern& pattern, double frame_length, double thickness, double stretch_tolerance);

  /// speed             below which columns rest [m/s], >= 0; 0: none ever does
  /// gravity           its magnitude [m/s^2]
  /// damping_per_mass  the largest of any node [1/s]: overdamped cloth creeps back to rest, so it must be slower
  void setLimits(double speed, double gravity, double damping_per_mass, double height) noexcept;

  void takeStretchTolerance(double tolerance) noexcept;

  /// Sets the length of the next frames [s]. setLimits() must follow.
  void takeFrame(double length) noexcept { frame_length_ = length; }

  /// Whether anything may rest at all.
  bool can() const noexcept { return radius_ > 0.0; }
  const ColumnSet& asleep() const noexcept { return asleep_; }
  /// Something sleeps, or may soon: disturbances must be marked.
  bool watches() const noexcept { return watches_ || !asleep_.empty(); }
  /// Columns that something is about to move, for wake().
  ColumnSet& disturbed() noexcept { return disturbed_; }
  void disturbAll() noexcept { disturbed_.addAll(); }

  /// Marks the columns near obstacles that have moved since the last frame or will in this one. Sets the obstacles'
  /// substep to the whole frame.
  void approachedBy(ObstacleSet& obstacles) noexcept;

  /// Wakes the marked columns and their runs; marked columns that are awake start resting anew. True: some woke.
  bool wake() noexcept;
  /// The same for columns that their neighbours pull at, at this time [s]; they keep their place, but do not sleep
  /// alone for a while.
  bool wakeFor(const ColumnSet& pulled, double time) noexcept;

  /// To be called after each frame with motion; true: it is time to look().
  bool due() noexcept;
  /// Puts resting columns to sleep. kept_awake: those that gusts reach; contacts: of the last substep, or null;
  /// by_column: columns may sleep while others move. True: some fell asleep.
  bool look(const ClothState& state, double time, const ColumnSet& kept_awake, const Contacts* contacts,
            bool by_column) noexcept;

  void forget() noexcept;

  std::int64_t wakes() const noexcept { return wakes_; }

  void carry(Archive& archive);

 private:
  bool anyStill(const Field3& velocity) noexcept;
  void measure(const Field3& position) noexcept;
  bool quiet(int column, const Field3& position, double time) noexcept;
  Eigen::AlignedBox3d boxOf(int column, const Field3& position) const noexcept;
  void takePlace(int column, const Field3& position, double time) noexcept;
  void markTouching(const Contacts* contacts) noexcept;
  void fallAsleep(const Field3& position) noexcept;
  template <typename Woken>
  bool wakeRuns(const ColumnSet& marked, const Woken& woken) noexcept;

  const ClothPattern& pattern_;
  double frame_length_;
  double margin_;         // around the cloth, for obstacles [m]
  double radius_ = 0.0;   // that nodes of a resting column stay within [m]; 0: nothing rests
  double jitter_;         // the same for cloth in contact [m]
  double allowed_ = 0.0;  // the radius used in this look [m]
  int due_in_ = 1;        // frames
  std::size_t turn_ = 0;
  ColumnSet asleep_, disturbed_, quiet_, touching_;
  bool pressed_ = false;             // all columns sleep in contact: they wake together
  std::vector<std::uint8_t> still_;  // by column: slow enough to look closer
  std::vector<double> since_;        // by column: time since which it has been in place [s]; NaN: it has no place
  std::vector<double> alone_from_;   // by column: time from which it may sleep while others move [s]
  std::vector<double> alone_pause_;  // by column: its next pause without sleeping alone [s]
  std::vector<double> farthest_;     // by column (padded): largest squared distance of a node from its place [m^2]
  Field3 place_;
  std::vector<Eigen::AlignedBox3d> box_;  // of columns asleep, with margin
  Eigen::AlignedBox3d all_;               // of all of them
  Eigen::AlignedBox3d swept_;             // by obstacles since the last look
  bool watches_ = false;                  // a column has a place
  std::int64_t wakes_ = 0;
};

}  // namespace curtain
