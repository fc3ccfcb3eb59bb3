// SPDX-License-Identifier: BSD-3-Clause
//
// Floor 5: stamps for frames that are paced by the monotonic clock. ROS time is the monotonic time plus an offset,
// which is measured now and then by reading both clocks. Between the two readings the thread may be held up, and then
// the offset is wrong by as long; and somebody may set the computer's clock. Still stamps never go back, but for a
// clock that was set back by more than kSetBack: those follow it, and it is said. Knows no ROS: times come in as
// nanoseconds.
#pragma once

#include <cstdint>

namespace curtain_ros {

/// Not thread-safe.
class StampKeeper {
 public:
  /// Measured: ROS time - monotonic time [ns], and how much it may be off because of the time that the readings took
  /// [ns].
  struct Offset {
    std::int64_t value = 0;
    std::int64_t doubt = 0;
  };

  static constexpr std::int64_t kGoodReading = 100'000;  ///< doubt [ns] of one that is believed; usual: 100 ns

  /// The stamp [ns, ROS time] of a frame at a monotonic time [ns]; times rise from call to call.
  std::int64_t stamp(std::int64_t time, const Offset& offset) {
    const std::int64_t difference = offset.value - offset_;
    const std::int64_t size = difference < 0 ? -difference : difference;
    // What the doubt explains is none of the clock's doing.
    if (!known_ || size > offset.doubt || offset.doubt <= kGoodReading) offset_ = offset.value;
    std::int64_t stamp = time + offset_;
    if (known_ && stamp <= last_) {
      if (last_ - stamp > kSetBack) {
        ++set_back_;
      } else {
        stamp = last_ + kLeastStep;
      }
    }
    known_ = true;
    last_ = stamp;
    return stamp;
  }

  /// Times that the clock was set back.
  std::uint32_t setBack() const { return set_back_; }

 private:
  static constexpr std::int64_t kLeastStep = 1'000;      // [ns]
  static constexpr std::int64_t kSetBack = 500'000'000;  // [ns] clocks that are kept by NTP are slewed below that

  bool known_ = false;
  std::int64_t offset_ = 0;
  std::int64_t last_ = 0;
  std::uint32_t set_back_ = 0;
};

}  // namespace curtain_ros
