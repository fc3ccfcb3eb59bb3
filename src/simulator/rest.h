// SPDX-License-Identifier: BSD-3-Clause
//
// Which columns of the cloth sleep. A column falls asleep when it has stayed in one place for a while; it wakes, and
// with it all that sleep side by side with it, before whatever could move it acts:
//
//   a wind that reaches it, or a drag, begins, ends, changes      ForceField marks it (disturbed())
//   an obstacle moves, comes or goes near it                      approachedBy()
//   a pin is moved; gravity or air change                         disturbAll()
//   its neighbours pull at it, or touch it                        the solver finds that (HeldColumns), and makes the
//                                                                 substep again with it awake
//
// Gusts that reach a column keep it awake; without gravity nothing brings cloth to rest, so nothing sleeps. Time is
// that of the motion, which may be slower than the clock (solver.budget_ms).
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
  /// frame_length [s]; thickness: of contact [m]; stretch_tolerance: of the links. pattern must outlive this.
  Rest(const ClothPattern& pattern, double frame_length, double thickness, double stretch_tolerance);

  /// speed            of columns that rest [m/s], >= 0; 0: none ever does
  /// gravity          its size [m/s^2]
  /// damping_per_mass the strongest of any node [1/s]: cloth that creeps back to rest must be slower than that
  void setLimits(double speed, double gravity, double damping_per_mass, double height) noexcept;

  /// Frames are so long from now on [s]. setLimits() must follow.
  void takeFrame(double length) noexcept { frame_length_ = length; }

  /// Something may rest at all.
  bool can() const noexcept { return radius_ > 0.0; }
  const ColumnSet& asleep() const noexcept { return asleep_; }
  /// Something sleeps, or may soon: what moves columns must be marked.
  bool watches() const noexcept { return watches_ || !asleep_.empty(); }
  /// Columns that something is about to move; wake() takes them.
  ColumnSet& disturbed() noexcept { return disturbed_; }
  void disturbAll() noexcept { disturbed_.addAll(); }

  /// Marks the columns near obstacles that have moved since the last frame, or will in this one. Sets the obstacles'
  /// substep to the whole frame.
  void approachedBy(ObstacleSet& obstacles) noexcept;

  /// Wakes what is marked, and what sleeps side by side with it; what is marked and awake must keep to a place anew.
  /// True: somebody woke.
  bool wake() noexcept;
  /// The same of columns that their neighbours pull at, at this time [s]: they keep to their places still, but for a
  /// while they sleep only with all the cloth.
  bool wakeFor(const ColumnSet& pulled, double time) noexcept;

  /// To be called after each frame in which something moved; true: it is time to look().
  bool due() noexcept;
  /// Looks for columns that rest. kept_awake: those that gusts reach; contacts: of the last substep, or null;
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
  double margin_;         // round the cloth, for obstacles [m]
  double radius_ = 0.0;   // that nodes of a resting column stay within [m]; 0: nothing ever rests
  double jitter_;         // what nodes of cloth that touches something go to and fro by, for all that it rests [m]
  double allowed_ = 0.0;  // the radius of this look [m]
  int due_in_ = 1;        // frames
  std::size_t turn_ = 0;
  ColumnSet asleep_, disturbed_, quiet_, touching_;
  bool pressed_ = false;             // the cloth sleeps all of it, and touches something: it wakes all of it
  std::vector<std::uint8_t> still_;  // by column: slow enough to look closer
  std::vector<double> since_;        // by column: since when it has been at its place [s]; NaN: it has none
  std::vector<double> alone_from_;   // by column: when it may sleep while others move [s]
  std::vector<double> alone_pause_;  // by column: how long it may not, the next time its neighbours wake it [s]
  std::vector<double> farthest_;     // by column (padded): square of the largest distance of a node from it [m^2]
  Field3 place_;
  std::vector<Eigen::AlignedBox3d> box_;  // of columns asleep, with margin
  Eigen::AlignedBox3d all_;               // of all of them
  Eigen::AlignedBox3d swept_;             // by obstacles since the last look
  bool watches_ = false;                  // a column has a place
  std::int64_t wakes_ = 0;
};

}  // namespace curtain
