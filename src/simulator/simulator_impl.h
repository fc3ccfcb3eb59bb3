// SPDX-License-Identifier: BSD-3-Clause
//
// What a simulator is made of, each part with one duty, and how they are wired. simulator.cpp: what users call;
// frame.cpp: the order in which the parts act in a frame; snapshot.cpp: what is kept of them and comes back.
#pragma once

#include <cstdint>
#include <optional>

#include "curtain_sim/simulator.h"
#include "simulator/energy_guard.h"
#include "simulator/error_control.h"
#include "simulator/fine_surface.h"
#include "simulator/frame_loop.h"
#include "simulator/frame_times.h"
#include "simulator/motion.h"
#include "simulator/pin_moves.h"
#include "simulator/sleep.h"

namespace curtain {

struct Simulator::Impl {
  Impl(const Scene& given, const MeshResolver& resolve);

  void reset();
  void step();
  void takeGravity() noexcept;
  void takeFrame() noexcept;
  void carry(Archive& archive);
  void resume() noexcept;
  std::uint32_t layout();

  Scene scene;  // gravity, air and the frame rate may change
  const ClothPattern pattern;
  FrameTimes times;
  Motion motion;
  StepControls controls;
  Sleep sleep;
  Budget budget;
  FrameLoop loop;
  std::optional<ErrorControl> errors;  // where a position tolerance is asked for
  EnergyGuard guard;
  PinMoves pins;
  FineSurface surface;
  std::uint64_t revision = 0;  // of the cloth's and the obstacles' places
  Field3 total_force;          // room for what copyForces() adds up

 private:
  void sleepThrough();
  double moveThrough(Budget::Clock::time_point begin);
  void endFrame(double share);
  void nextFrame(double share) noexcept;
  void countTime(Budget::Clock::time_point begin);
};

}  // namespace curtain
