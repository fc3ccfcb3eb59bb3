// SPDX-License-Identifier: BSD-3-Clause
//
// Number, begin and length of the present frame.
#pragma once

#include <cstdint>

namespace curtain {

class Archive;

class FrameTimes {
 public:
  /// rate: the scene's frames a second, > 0; must outlive this.
  explicit FrameTimes(double& rate) : rate_(rate) {}

  double length() const noexcept { return 1.0 / rate_; }  ///< [s]
  double rate() const noexcept { return rate_; }          ///< [1/s]
  std::int64_t frame() const noexcept { return frame_; }
  double begin() const noexcept { return timeOf(frame_); }    ///< of the present frame [s]
  double end() const noexcept { return timeOf(frame_ + 1); }  ///< of the present frame [s]
  /// Time of the motion [s]; less than begin() when frames ended early.
  double madeTime() const noexcept { return made_time_; }

  /// share: of the present frame that was made, [0, 1].
  void next(double share) noexcept {
    made_time_ += share * length();
    ++frame_;
  }
  void setRate(double rate) noexcept {
    since_ = {frame_, begin()};
    rate_ = rate;
  }
  void reset() noexcept {
    frame_ = 0;
    made_time_ = 0.0;
    since_ = {};
  }
  void serialize(Archive& archive);

 private:
  // Counts from the last change of length, so that rounding does not add up.
  double timeOf(std::int64_t frame) const noexcept {
    return since_.time + static_cast<double>(frame - since_.frame) * length();
  }

  double& rate_;
  std::int64_t frame_ = 0;
  double made_time_ = 0.0;
  struct {
    std::int64_t frame = 0;
    double time = 0.0;  // [s]
  } since_;             // the last change of length
};

}  // namespace curtain
