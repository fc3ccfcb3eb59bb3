// SPDX-License-Identifier: BSD-3-Clause
//
// Which frames are due. Frames lie on a fixed grid of times, start + k / frame_rate; a late node makes up for at most
// max_catch_up of them at once, the rest is dropped and counted. A clock that jumps back starts a new grid. Knows no
// ROS: times come in as nanoseconds, of any clock.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace curtain_ros {

/// Not thread-safe.
class StepClock {
 public:
  /// frame_rate    [1/s], > 0
  /// max_catch_up  frames made at once at most, >= 1
  StepClock(double frame_rate, int max_catch_up) : period_(1e9 / frame_rate), max_catch_up_(max_catch_up) {}

  struct Due {
    int frames = 0;          ///< to be made now, each to be followed by advance()
    bool restarted = false;  ///< the clock jumped back: a new run starts now
  };

  /// now  [ns]; the first call starts the grid, its first frame is due one period later.
  Due update(std::int64_t now) {
    if (startsAt(now)) return start(now);
    const std::int64_t late = lateAt(now);
    const std::int64_t made = std::min<std::int64_t>(late, max_catch_up_);
    dropped_ += static_cast<std::uint64_t>(late - made);
    frame_ += late - made;
    return {static_cast<int>(made), false};
  }

  /// The same in a pause: frames that are due are left out, and not counted. frames: 1 if there were any.
  Due pass(std::int64_t now) {
    if (startsAt(now)) return start(now);
    const std::int64_t late = lateAt(now);
    frame_ += late;
    return {late > 0 ? 1 : 0, false};
  }

  /// Changes the frames' length: the next one is due one period after the last, or after the last update().
  void setRate(double frame_rate) {
    start_ = std::max<std::int64_t>(last_, next() - std::llround(period_));
    frame_ = 0;
    period_ = 1e9 / frame_rate;
  }

  /// Goes on to the next frame of the grid; its time [ns].
  std::int64_t advance() {
    const std::int64_t time = next();
    ++frame_;
    return time;
  }

  /// Time of the next frame [ns].
  std::int64_t next() const { return start_ + std::llround(static_cast<double>(frame_ + 1) * period_); }

  /// Frames left out since construction.
  std::uint64_t dropped() const { return dropped_; }

 private:
  // Frames are due this much early [ns]: clocks that tick in frames, written as floating-point seconds, come a
  // nanosecond short, and would otherwise be a whole tick late now and then.
  static constexpr std::int64_t kRounding = 1000;

  bool startsAt(std::int64_t now) const { return !started_ || now < last_; }
  Due start(std::int64_t now) {
    const Due due = {0, started_};
    started_ = true;
    start_ = last_ = now;
    frame_ = 0;
    return due;
  }
  // Frames that are due and not taken yet.
  std::int64_t lateAt(std::int64_t now) {
    last_ = now;
    const auto latest = static_cast<std::int64_t>(std::floor(static_cast<double>(now + kRounding - start_) / period_));
    return std::max<std::int64_t>(latest - frame_, 0);
  }

  double period_;  // [ns]
  int max_catch_up_;
  bool started_ = false;
  std::int64_t start_ = 0;  // [ns]
  std::int64_t last_ = 0;   // [ns]
  std::int64_t frame_ = 0;  // last frame taken or dropped
  std::uint64_t dropped_ = 0;
};

}  // namespace curtain_ros
