// SPDX-License-Identifier: BSD-3-Clause
//
// The parts of a simulator. simulator.cpp: the public interface; frame.cpp: the order of the parts in a frame;
// snapshot.cpp: saving and restoring them.
#pragma once

#include <cstdint>
#include <optional>

#include "cloth/pin_moves.h"
#include "curtain_sim/simulator.h"
#include "parts/rail/opening.h"
#include "simulator/accuracy/error_control.h"
#include "simulator/energy_guard.h"
#include "simulator/frame_loop.h"
#include "simulator/frame_times.h"
#include "simulator/motion.h"
#include "simulator/sleep.h"
#include "surface/fine_surface.h"

namespace curtain {

struct Simulator::Impl {
  Impl(const Scene& given, const MeshResolver& resolve);

  void reset();
  void step();
  void takeGravity() noexcept;
  void takeFrame() noexcept;
  void takeFriction() noexcept;
  void takeStretchTolerance() noexcept;
  void takePositionTolerance() noexcept;
  void takeBudget() noexcept;
  void takePins();
  void driven() noexcept;
  template <typename Change>
  void repin(const Change& change);
  void carry(Archive& archive);
  void resume() noexcept;
  std::uint32_t layout();

  Scene scene;           // some keys may change, see Simulator::scene()
  ClothPattern pattern;  // its pins may change (repin())
  FrameTimes times;
  Motion motion;
  Opening opening;
  StepControls controls;
  Sleep sleep;
  Budget budget;
  FrameLoop loop;
  std::optional<ErrorControl> errors;  // where a position tolerance is asked for
  EnergyGuard guard;
  Grasps& grasps;  // of motion
  PinMoves pins;
  FineSurface surface;
  std::uint64_t revision = 0;  // of the positions of cloth and obstacles
  Field3 total_force;          // scratch of copyForces()

 private:
  void endGrasps(double share);
  void sleepThrough();
  double moveThrough(Budget::Clock::time_point begin);
  void endFrame(double share);
  void nextFrame(double share) noexcept;
  void countTime(Budget::Clock::time_point begin);
};

// Between substeps: what hands hold changes by change(). Nodes that were pinned keep the velocity they moved with.
template <typename Change>
void Simulator::Impl::repin(const Change& change) {
  sleep.wake();
  motion.synchronise();
  change();
  takePins();
  motion.repinned();
  controls.repinned(motion.exact);
  guard.forget();
  if (errors) errors->lose();
  ++revision;
}

}  // namespace curtain
