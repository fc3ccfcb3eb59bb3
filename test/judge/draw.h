// SPDX-License-Identifier: BSD-3-Clause
//
// Trials for the judge, from a seed: a scene of any keys and sizes, made up by habit (drawn/), and what a user does to
// it meanwhile. The same seed gives the same trial everywhere. It is kept as a YAML file.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "curtain_sim/scene.h"

namespace curtain_test {

/// How hard a trial is.
enum class Kind {
  kEveryday,  ///< hands, winds, balls and frame rates of every day
  kWild,      ///< any force, mass, length, frame rate and pinning that a scene may have
  kSudden     ///< something sets in within a frame before a thin plate
};
const char* kindName(Kind kind);

/// A hand that takes the nodes around one of them, and swings and turns about where it took them.
struct Hand {
  curtain::NodeIndex node;
  double radius = 0.0;                                           ///< [m]
  double from = 0.0, until = 0.0;                                ///< [s]
  curtain::Vec3 swing = curtain::Vec3::Zero();                   ///< amplitude [m]
  double turn = 0.0;                                             ///< amplitude, about the swing's direction [rad]
  double frequency = 0.0;                                        ///< of both [1/s]
  double stiffness = 0.0, pinch_force = 0.0, break_force = 0.0;  ///< of GraspParams; 0: none
};

/// What happens beside the scene's own winds, drags and motions. All pins move as one body, so that links never lack a
/// choice.
struct Happenings {
  curtain::Vec3 pin_swing = curtain::Vec3::Zero();  ///< amplitude of the pins' swing [m]
  double pin_frequency = 0.0;                       ///< of it [1/s]
  curtain::Vec3 pin_jerk = curtain::Vec3::Zero();   ///< pins go by this within one frame [m]
  curtain::Vec3 gravity = curtain::Vec3::Zero();    ///< from `at` on [m/s^2]; zero: as it was
  double other_rate = 0.0;                          ///< frames a second from `at` on; 0: as before
  double opening = -1.0;                            ///< a rail's drive draws to it from `at` on; negative: none
  std::vector<Hand> hands;
  int tie_back = -1;  ///< from `at` on the first one is open (0), closed (1); -1: as it was
  double at = 0.0;    ///< when pins jerk, a drive or a tie-back sets in, and gravity and frame rate change [s]
};

struct Drawn {
  Kind kind = Kind::kEveryday;
  std::uint64_t seed = 0;
  double seconds = 1.0;  ///< simulated time
  curtain::Scene scene;
  Happenings happenings;
};

Drawn draw(Kind kind, std::uint64_t seed);

/// As YAML text, and back; throws std::runtime_error for what is no trial.
std::string write(const Drawn& drawn);
Drawn readTrial(const std::string& text);

}  // namespace curtain_test
