// SPDX-License-Identifier: BSD-3-Clause
//
// Puts the cloth to sleep and wakes it: tells Rest of all disturbances, and stops what falls asleep.
#pragma once

#include "simulator/motion.h"
#include "simulator/rest.h"

namespace curtain {

class Sleep {
 public:
  /// motion must outlive this.
  explicit Sleep(Motion& motion);

  Rest& rest() noexcept { return rest_; }
  const Rest& rest() const noexcept { return rest_; }
  bool asleep() const noexcept { return rest_.asleep(); }

  /// Before a frame: wakes the cloth if something in it may move it.
  void wakeForFrame();
  void wake();
  /// After a frame with motion.
  void fallAsleep();

  void reset() noexcept { rest_.forget(); }
  /// What it follows from has changed: keys of the scene, pins, what damps.
  void limitsChanged() noexcept;

 private:
  void restChanged();

  Motion& motion_;
  Rest rest_;
};

}  // namespace curtain
