// SPDX-License-Identifier: BSD-3-Clause
//
// The computing time of a frame, where it is limited (solver.budget_ms). What is given up, in this order:
//
//   1 the error's estimate   the companion of position_tolerance stays at home for this frame
//   2 short substeps         fewer and longer ones than the tensions ask for; nodes are heavier, so nothing blows up
//   3 time                   the frame ends before a substep that there is no time for: the cloth moves slower than the
//                            clock; obstacles and pins go on from where they had got to
//   4 the last sweeps        a substep whose time is over is taken with links up to 8 times further off than their
//                            tolerance
//
// Further off, or through something, nothing is taken: the cloth stands still for a frame and tries with a shorter
// substep; but not for more than some frames in a row, then a substep may take what it needs.
#pragma once

#include <chrono>

namespace curtain {

class Archive;

class Budget {
 public:
  using Clock = std::chrono::steady_clock;

  explicit Budget(double milliseconds) : seconds_(1e-3 * milliseconds) {}

  /// Of computing time [s].
  static double secondsSince(Clock::time_point begin) {
    return std::chrono::duration<double>(Clock::now() - begin).count();
  }

  bool any() const noexcept { return seconds_ > 0.0; }
  void forget() noexcept;

  void beginFrame(Clock::time_point begin) noexcept;
  /// There is time for the companion as well as for the frame, as far as the last ones tell.
  bool affordsCompanion() const noexcept;
  void companionTook(double seconds) noexcept { companion_ = follow(companion_, seconds); }

  /// Substeps that there is time for now, >= 1.
  int affordable(Clock::time_point now) const noexcept;
  /// When a substep must be over. The far future: this one may take what it needs.
  Clock::time_point substepEnds() const noexcept;
  /// made: it was taken. One that was not, begun late in the frame, tells nothing of what they take.
  void substepTook(double seconds, bool made) noexcept {
    if (made || !moved_) substep_ = follow(substep_, seconds);
    moved_ = moved_ || made;
  }

  /// There is no time for one more.
  bool over(Clock::time_point now) const noexcept;
  /// share: of the frame that was made; tail_begin: when what comes after its substeps began.
  void endFrame(double share, Clock::time_point tail_begin, Clock::time_point end) noexcept;
  /// Nothing of this frame has been made yet.
  bool fresh() const noexcept { return !moved_; }
  double seconds() const noexcept { return seconds_; }

  void carry(Archive& archive);

 private:
  // Follows what things take; the first one says it all.
  static double follow(double mean, double value) noexcept { return mean > 0.0 ? 0.8 * mean + 0.2 * value : value; }
  bool patient() const noexcept;

  double seconds_;
  double substep_ = 0.0, companion_ = 0.0, tail_ = 0.0, frame_ = 0.0;  // what they take [s]
  int stalled_ = 0;                                                    // frames in a row without any motion
  bool moved_ = false;                                                 // a substep of this frame has been made
  Clock::time_point begin_, end_;
};

}  // namespace curtain
