// SPDX-License-Identifier: BSD-3-Clause
#include "ros/services/lock_step.h"

#include <utility>

namespace curtain_ros {
namespace {

std::string problemOf(std::uint32_t frames, bool paused) {
  if (frames < 1 || frames > kMaxFrames) {
    return "frames: must be an integer in [1, " + std::to_string(kMaxFrames) + "], is " + std::to_string(frames);
  }
  return paused ? "" : "the node is running: pause it first, by ~pause";
}

}  // namespace

void LockStep::setPaused(bool paused) {
  paused_ = paused;
  if (!paused) end("the node was told to go on");
}

std::future<LockStep::Answer> LockStep::ask(std::uint32_t frames) {
  Request request;
  request.frames = request.left = frames;
  std::future<Answer> answer = request.answer.get_future();
  request.last.message = problemOf(frames, paused_);
  if (request.last.message.empty())
    requests_.push_back(std::move(request));
  else
    request.answer.set_value(request.last);
  return answer;
}

void LockStep::made(const Answer& frame) {
  if (!asked()) return;
  Request request = std::move(requests_.front());
  requests_.pop_front();
  request.last = frame;
  --request.left;
  if (request.left > 0) {
    requests_.push_back(std::move(request));
    return;
  }
  request.last.success = true;
  request.answer.set_value(request.last);
}

void LockStep::end(const std::string& why) {
  for (Request& request : requests_) {
    request.last.success = false;
    request.last.message = why + ": " + std::to_string(request.frames - request.left) + " of " +
                           std::to_string(request.frames) + " frames were made";
    request.answer.set_value(request.last);
  }
  requests_.clear();
}

}  // namespace curtain_ros
