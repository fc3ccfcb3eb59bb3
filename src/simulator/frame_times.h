// SPDX-License-Identifier: BSD-3-Clause
//
// Which frame it is, when it begins and how long it is.
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
  /// When the present frame begins and ends [s].
  double begin() const noexcept { return timeOf(frame_); }
  double end() const noexcept { return timeOf(frame_ + 1); }
  /// Time of the motion [s]; less than begin() where frames ended early.
  double madeTime() const noexcept { return made_time_; }

  void move(double seconds) noexcept { made_time_ += seconds; }
  void next() noexcept { ++frame_; }
  void setRate(double rate) noexcept;
  void reset() noexcept;
  void carry(Archive& archive);

 private:
  // Whole frames from where they last changed their length, so that rounding does not add up.
  double timeOf(std::int64_t frame) const noexcept { return since_time_ + static_cast<double>(frame - since_frame_) * length(); }

  double& rate_;
  std::int64_t frame_ = 0;
  std::int64_t since_frame_ = 0;  // frames have been as long as now since this one
  double since_time_ = 0.0;       // and since this time [s]
  double made_time_ = 0.0;
};

inline void FrameTimes::setRate(double rate) noexcept {
  since_time_ = begin();
  since_frame_ = frame_;
  rate_ = rate;
}

inline void FrameTimes::reset() noexcept {
  frame_ = since_frame_ = 0;
  since_time_ = made_time_ = 0.0;
}

}  // namespace curtain
