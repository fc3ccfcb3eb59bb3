// SPDX-License-Identifier: BSD-3-Clause
//
// Floor 5: which frames are due. Frames lie on a fixed grid of times, start + k / frame_rate; a late node makes
// up for at most max_catch_up of them at once, the rest is dropped and counted. A clock that jumps back starts
// a new grid. Knows no ROS: times come in as nanoseconds, of any clock.
#pragma once

#include <cstdint>

namespace curtain_ros {

/// Not thread-safe.
class StepClock {
 public:
  /// frame_rate    [1/s], > 0
  /// max_catch_up  frames made at once at most, >= 1
  StepClock(double frame_rate, int max_catch_up);

  struct Due {
    int frames = 0;          ///< to be made now, each to be fetched with take()
    bool restarted = false;  ///< the clock jumped back: a new run starts now
  };

  /// now  [ns]; the first call starts the grid, its first frame is due one period later.
  Due update(std::int64_t now);

  /// Takes the next frame off the grid and returns its time [ns].
  std::int64_t take();

  /// Time of the next frame [ns].
  std::int64_t next() const { return timeOf(frame_ + 1); }

  /// Frames left out since construction.
  std::uint64_t dropped() const { return dropped_; }

 private:
  std::int64_t timeOf(std::int64_t frame) const;

  double period_;  // [ns]
  int max_catch_up_;
  bool started_ = false;
  std::int64_t start_ = 0;  // [ns]
  std::int64_t last_ = 0;   // [ns]
  std::int64_t frame_ = 0;  // last frame taken or dropped
  std::uint64_t dropped_ = 0;
};

}  // namespace curtain_ros
