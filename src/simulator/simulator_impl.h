// SPDX-License-Identifier: BSD-3-Clause
//
// What a simulator is made of. simulator.cpp, changes.cpp and api: the public interface; frame.cpp: the order of a
// frame; snapshot.cpp: saving and restoring.
#pragma once

#include <cstdint>
#include <optional>

#include "curtain_sim/simulator.h"
#include "simulator/accuracy/error_control.h"
#include "simulator/closed_frames.h"
#include "simulator/frame_loop.h"
#include "simulator/frame_times.h"
#include "simulator/motion.h"
#include "simulator/sleep.h"
#include "surface/fine_surface.h"

namespace curtain {

struct Simulator::Impl {
  Impl(const Scene& given, const ShapeMaker& make_shape);
  /// Starts with its nodes there, row by row.
  void startAt(const std::vector<Vec3>& positions);
  /// Least distance of one of its cloths (Layers) from an obstacle that is there [m].
  double distanceOf(std::size_t layer, int obstacle) const;
  /// Of the same scene but for its cloths, at its start. Throws std::invalid_argument with what is wrong with it.
  std::unique_ptr<Impl> withCloths(const Scene& changed) const;
  /// Another scene differs by no more than what setCloth() may change.
  bool mayBecome(const Scene& other) const;
  /// Goes on where another one is, whose cloth differs by what may change.
  void continueFrom(Impl& other);

  void reset();
  void step();
  void keysChanged();
  void pinsChanged();
  void driven() noexcept;
  template <typename Change>
  void changePins(const Change& change);
  void serialize(Archive& archive);
  void resume() noexcept;
  std::uint32_t layout();

  Scene scene;           // some keys may change, see Simulator::scene()
  ClothPattern pattern;  // its pins may change (changePins())
  FrameTimes times;
  Motion motion;
  StepControls controls;
  Sleep sleep;
  Budget budget;
  FrameLoop loop;
  std::optional<ErrorControl> errors;  // where a position tolerance is asked for
  ClosedFrames closed;
  FineSurface surface;
  std::uint64_t revision = 0;                 // of the positions of cloth and obstacles
  Field3 total_force;                         // scratch of copyForces()
  std::vector<std::uint8_t> pinned_by_parts;  // scratch of pinsChanged()

 private:
  void sleepThrough();
  double moveThrough(Budget::Clock::time_point begin);
  void endFrame(double share);
  void nextFrame(double share) noexcept;
  void countTime(Budget::Clock::time_point begin);
};

// Between substeps: what parts pin changes by change(). Nodes that were pinned keep the velocity they moved with.
template <typename Change>
void Simulator::Impl::changePins(const Change& change) {
  sleep.wake();
  motion.synchronise();
  change();
  pinsChanged();
  motion.afterPinsChanged();
  controls.both([this](StepControl& control) { control.afterPinsChanged(motion.step); });
  motion.step.account().leaveOpen();
  if (errors) errors->lose();
  ++revision;
}

}  // namespace curtain
