// SPDX-License-Identifier: BSD-3-Clause
//
// Measures the computing time of the stages of a frame.
#pragma once

#include <array>
#include <chrono>

#include "curtain_sim/statistics.h"

namespace curtain {

class Archive;

class StageClock {
 public:
  using Clock = std::chrono::steady_clock;

  /// Adds the time since the last call (or start()) to this stage.
  void lap(Stage stage) noexcept {
    const auto now = Clock::now();
    seconds_[static_cast<std::size_t>(stage)] += std::chrono::duration<double>(now - last_).count();
    last_ = now;
  }
  void start() noexcept { last_ = Clock::now(); }
  /// Sets when the measured work must be over; max: no limit.
  void setDeadline(Clock::time_point deadline) noexcept { deadline_ = deadline; }
  /// The deadline had passed at the last lap().
  bool late() const noexcept { return last_ >= deadline_; }
  void reset() noexcept { seconds_.fill(0.0); }
  const std::array<double, kStageCount>& seconds() const noexcept { return seconds_; }
  void serialize(Archive& archive);

 private:
  Clock::time_point last_ = Clock::now();
  Clock::time_point deadline_ = Clock::time_point::max();
  std::array<double, kStageCount> seconds_{};
};

}  // namespace curtain
