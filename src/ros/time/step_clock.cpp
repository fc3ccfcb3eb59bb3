// SPDX-License-Identifier: BSD-3-Clause
#include "ros/time/step_clock.h"

#include <cmath>

namespace curtain_ros {

namespace {
// A frame is due this much early [ns]: clocks that tick in frames, written as floating-point seconds, come a
// nanosecond short, and would otherwise be a whole tick late now and then.
constexpr std::int64_t kRounding = 1000;
}  // namespace

StepClock::StepClock(double frame_rate, int max_catch_up) : period_(1e9 / frame_rate), max_catch_up_(max_catch_up) {}

StepClock::Due StepClock::update(std::int64_t now) {
  Due due;
  if (!started_ || now < last_) {
    due.restarted = started_;
    started_ = true;
    start_ = now;
    last_ = now;
    frame_ = 0;
    return due;
  }
  last_ = now;

  // The quotient may be off by one where it rounds; the grid's own times decide.
  auto latest = static_cast<std::int64_t>(std::floor(static_cast<double>(now - start_) / period_));
  while (timeOf(latest + 1) <= now + kRounding) ++latest;
  while (latest > 0 && timeOf(latest) > now + kRounding) --latest;

  const std::int64_t late = latest - frame_;
  if (late > max_catch_up_) {
    const std::int64_t dropped = late - max_catch_up_;
    dropped_ += static_cast<std::uint64_t>(dropped);
    frame_ += dropped;
    due.frames = max_catch_up_;
  } else if (late > 0) {
    due.frames = static_cast<int>(late);
  }
  return due;
}

std::int64_t StepClock::take() { return timeOf(++frame_); }

std::int64_t StepClock::timeOf(std::int64_t frame) const {
  return start_ + std::llround(static_cast<double>(frame) * period_);
}

}  // namespace curtain_ros
