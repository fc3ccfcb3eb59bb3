// SPDX-License-Identifier: BSD-3-Clause
//
// When an output is sent, counted in frames: rates are of simulated time.
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>

namespace curtain_ros {

/// Picks frames at a lower rate.
class RateDivider {
 public:
  /// rate [1/s]; 0, and anything above the frame rate: every frame.
  RateDivider(double rate, double frame_rate) : share_(rate > 0.0 ? rate / frame_rate : 1.0) {}

  /// Changes the rates; the phase stays.
  void setRate(double rate, double frame_rate) { share_ = rate > 0.0 ? rate / frame_rate : 1.0; }

  /// To be called each frame. True: this one.
  bool tick() {
    phase_ += share_;
    if (phase_ < 1.0 - 1e-9) return false;
    phase_ = phase_ < 2.0 ? phase_ - 1.0 : 0.0;
    return true;
  }

 private:
  double share_;
  double phase_ = 1.0;  // the first frame is one
};

/// When an output is sent: at its rate while what it shows changes, at its rest rate while that does not, and to a new
/// subscriber at once. A mesh of 20 000 triangles at 20 Hz takes 6 % of a core, a state of 1760 nodes at 60 Hz 1 %,
/// most of it in roscpp and the kernel: too much for a curtain that hangs still.
class Pace {
 public:
  /// Rates [1/s]; 0: every frame. A rest rate of 0: the same as rate.
  Pace(double rate, double rest_rate, double frame_rate)
      : rate_(rate, frame_rate), rest_frames_(restFrames(rest_rate, frame_rate)) {}

  /// Changes the rates.
  void setRates(double rate, double rest_rate, double frame_rate) {
    rate_.setRate(rate, frame_rate);
    rest_frames_ = restFrames(rest_rate, frame_rate);
  }

  /// To be called each frame.
  void tick() {
    due_ = rate_.tick() || due_;
    ++frames_since_sent_;
  }

  /// The next one is due at once, as for a new subscriber, whatever was sent.
  void hurry() {
    due_ = true;
    sent_.reset();
  }

  /// Whether the output is due, for that many subscribers. True once: then the next frame at its rate is.
  bool due(std::uint32_t subscribers) {
    if (subscribers > subscribers_) sent_.reset();
    subscribers_ = subscribers;
    const bool due = due_;
    due_ = false;
    return due && subscribers > 0;
  }

  /// Whether these subscribers lack this picture. Tells of new ones once.
  bool lacks(std::uint64_t picture, std::uint32_t subscribers) {
    if (subscribers > subscribers_) sent_.reset();
    subscribers_ = subscribers;
    return subscribers > 0 && sent_ != picture;
  }

  /// Whether a due output is to be sent. picture: a number that changes whenever what it shows may have changed.
  bool send(std::uint64_t picture) {
    if (sent_ == picture && frames_since_sent_ < rest_frames_) return false;
    sent_ = picture;
    frames_since_sent_ = 0;
    return true;
  }

 private:
  static long restFrames(double rate, double frame_rate) { return rate > 0.0 ? std::lround(frame_rate / rate) : 0; }

  RateDivider rate_;
  long rest_frames_;
  long frames_since_sent_ = 0;
  bool due_ = false;
  std::uint32_t subscribers_ = 0;
  std::optional<std::uint64_t> sent_;
};

}  // namespace curtain_ros
