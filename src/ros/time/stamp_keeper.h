// SPDX-License-Identifier: BSD-3-Clause
//
// Stamps for frames that the monotonic clock paces. ROS time is the monotonic time plus an offset, measured at each
// frame by reading both clocks; a reading during which the thread was held up is not used. Stamps rise from frame to
// frame, unless the computer's clock was set back by more than kSetBack. Knows no ROS: times come in as nanoseconds.
#pragma once

#include <algorithm>
#include <cstdint>

namespace curtain_ros {

/// Not thread-safe.
class StampKeeper {
 public:
  /// ROS time - monotonic time [ns], and the time that reading them took [ns].
  struct Offset {
    std::int64_t value = 0;
    std::int64_t duration = 0;
  };

  /// The stamp [ns, ROS time] of a frame at a monotonic time [ns].
  std::int64_t stamp(std::int64_t time, const Offset& offset) {
    if (last_ == 0 || offset.duration <= kGoodReading) offset_ = offset.value;
    const std::int64_t stamp = time + offset_;
    const bool set_back = last_ - stamp > kSetBack;
    set_back_ += set_back ? 1U : 0U;
    last_ = set_back ? stamp : std::max(stamp, last_ + kMinStep);
    return last_;
  }

  /// Times that the clock was set back.
  std::uint32_t setBack() const { return set_back_; }

 private:
  static constexpr std::int64_t kGoodReading = 100'000;  // [ns]; usual: 100
  static constexpr std::int64_t kMinStep = 1'000;        // [ns]
  static constexpr std::int64_t kSetBack = 500'000'000;  // [ns] below that NTP slews a clock and does not set it

  std::int64_t offset_ = 0;
  std::int64_t last_ = 0;  // 0: none yet
  std::uint32_t set_back_ = 0;
};

}  // namespace curtain_ros
