// SPDX-License-Identifier: BSD-3-Clause
//
// Puts columns to sleep and wakes them: tells Rest of all disturbances, and the solver and step control which columns
// move.
#pragma once

#include "simulator/motion.h"
#include "simulator/rest.h"
#include "simulator/step_controls.h"

namespace curtain {

class Sleep {
 public:
  /// by_column: columns may sleep while others move. motion and controls must outlive this.
  Sleep(Motion& motion, StepControls& controls, bool by_column);

  Rest& rest() noexcept { return rest_; }
  const Rest& rest() const noexcept { return rest_; }
  /// All of the cloth sleeps.
  bool all() const noexcept { return rest_.asleep().full(); }

  /// Before a frame: wakes the columns that something in it may move.
  void wakeForFrame(bool pins_move);
  /// Wakes the columns that the last attempt at a substep would have moved.
  void wakePulled();
  void wakeAll();
  /// After a frame with motion. as_a_whole: no column alone.
  void fallAsleep(bool as_a_whole);

  void reset();
  /// Gravity, air or the frames' length have changed.
  void takeLimits() noexcept;

 private:
  void takeOver();

  Motion& motion_;
  StepControls& controls_;
  const bool by_column_;
  Rest rest_;
  ColumnSet kept_awake_;  // scratch
};

}  // namespace curtain
