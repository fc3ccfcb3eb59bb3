// SPDX-License-Identifier: BSD-3-Clause
//
// The computing time of a frame, where it is limited (solver.budget_ms). What is given up, in this order:
//
//   1 error estimate    the reference run of position_tolerance skips this frame
//   2 short substeps    substeps longer than the tensions ask for; mass scaling keeps them stable
//   3 time              the frame ends before a substep that there is no time for, so the cloth moves slower than the
//                       clock; obstacles and pins continue from where they are
//   4 last sweeps       a substep whose time is over is accepted when its links are within the tolerance
//
// A substep that is further off, or crosses something, is never accepted: the cloth stops for the frame and tries a
// shorter one. After kMaxStalledFrames such frames in a row a substep may take what it needs.
#pragma once

#include <chrono>

namespace curtain {

class Archive;

class Budget {
 public:
  using Clock = std::chrono::steady_clock;

  explicit Budget(double milliseconds) : seconds_(1e-3 * milliseconds) {}

  /// Computing time since then [s].
  static double secondsSince(Clock::time_point begin) {
    return std::chrono::duration<double>(Clock::now() - begin).count();
  }

  /// Sets the limit; 0: none. Between frames.
  void set(double milliseconds) noexcept { seconds_ = 1e-3 * milliseconds; }
  bool any() const noexcept { return seconds_ > 0.0; }
  void forget() noexcept;

  void beginFrame(Clock::time_point begin) noexcept;
  /// The last frames suggest that there is time for the reference run, too.
  bool affordsCompanion() const noexcept;
  void referenceTook(double seconds) noexcept { reference_ = follow(reference_, seconds); }

  /// Substeps that there is time for, >= 1.
  int affordable(Clock::time_point now) const noexcept;
  /// Deadline of a substep; max: it may take what it needs.
  Clock::time_point substepEnds() const noexcept;
  /// made: it was accepted. A rejected one after others of the frame may have been cut short: it is not counted.
  void substepTook(double seconds, bool made) noexcept {
    if (made || !moved_) substep_ = follow(substep_, seconds);
    moved_ = moved_ || made;
  }

  /// There is no time for another substep.
  bool over(Clock::time_point now) const noexcept;
  /// share: of the frame that was made; tail_begin: end of its substeps.
  void endFrame(double share, Clock::time_point tail_begin, Clock::time_point end) noexcept;
  /// No substep of this frame has been accepted yet.
  bool fresh() const noexcept { return !moved_; }
  double seconds() const noexcept { return seconds_; }

  void serialize(Archive& archive);

 private:
  // Running mean, which starts at the first value.
  static double follow(double mean, double value) noexcept { return mean > 0.0 ? 0.8 * mean + 0.2 * value : value; }
  bool mustMove() const noexcept;

  double seconds_;
  double substep_ = 0.0, reference_ = 0.0, tail_ = 0.0, frame_ = 0.0;  // mean computing times [s]
  int stalled_ = 0;                                                    // frames in a row without motion
  bool moved_ = false;                                                 // a substep of this frame was accepted
  Clock::time_point begin_, end_;
};

}  // namespace curtain
