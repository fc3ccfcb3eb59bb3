// SPDX-License-Identifier: BSD-3-Clause
//
// Whether the clock makes frames, or ~step does: a pause, and the frames that callers ask for in it. Callers take
// turns, frame by frame: one that asked for many, and may have died since, holds up nobody.
#pragma once

#include <cstdint>
#include <deque>
#include <future>
#include <string>

#include "curtain_sim/Step.h"

namespace curtain_ros {

/// Most frames of a request.
constexpr std::uint32_t kMaxFrames = 100000;

/// Simulation thread only.
class LockStep {
 public:
  using Answer = curtain_sim::Step::Response;

  explicit LockStep(bool paused) : paused_(paused) {}

  bool paused() const { return paused_; }
  /// Going on ends what was asked for.
  void setPaused(bool paused);

  /// Asks for so many frames. The answer comes when they are made, or at once if that can't be.
  std::future<Answer> ask(std::uint32_t frames);

  /// There are frames to be made now.
  bool asked() const { return !requests_.empty(); }
  /// The next one is its caller's last.
  bool lastOfRequest() const { return asked() && requests_.front().left == 1; }
  /// One of them was made. frame, simulated_time, stamp: of it.
  void made(const Answer& frame);

  /// Answers all callers that what they asked for is not made.
  void end(const std::string& why);

 private:
  struct Request {
    std::uint32_t frames = 0;  // asked for
    std::uint32_t left = 0;    // to be made
    Answer last;               // frame that was made
    std::promise<Answer> answer;
  };

  bool paused_;
  std::deque<Request> requests_;  // the first one's turn is next
};

}  // namespace curtain_ros
