// SPDX-License-Identifier: BSD-3-Clause
//
// Floor 0: what a simulator says of its own work. Plain structs, filled by the floors above.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

namespace curtain {

/// The stages of a frame, in their order (as in the loop of Cheng 2000, Sect. 1.3).
enum class Stage { kForces, kPredict, kWarp, kWeft, kContact, kFinish, kEstimate, kStageCount };
/// How many there are.
constexpr int kStageCount = static_cast<int>(Stage::kStageCount);
/// As in the statistics of curtain_batch, e.g. "forces".
const char* stageName(Stage stage);

/// Counters since construction or reset(); values of the last frame where it says so.
struct Statistics {
  std::int64_t frames = 0;                ///< steps made
  double time = 0.0;                      ///< simulated time [s]
  std::int64_t substeps = 0;              ///< accepted, all frames
  int substeps_last = 0;                  ///< in the last frame
  std::int64_t sweeps = 0;                ///< warp/weft/contact sweeps, all frames
  int sweeps_last = 0;                    ///< in the last frame
  std::int64_t rejected = 0;              ///< substeps done again with half the step
  std::int64_t last_resort_substeps = 0;  ///< whose predicted motion was cut, so that links hold whatever pulls
  std::int64_t unsettled = 0;             ///< substeps that ended above stretch_tolerance
  std::int64_t asleep_frames = 0;         ///< frames in which all of the cloth slept
  std::int64_t wakes = 0;                 ///< times that something of it woke
  int asleep = 0;                         ///< columns that sleep now
  // What solver.budget_ms has cost, in the order in which it is given up.
  std::int64_t estimates_skipped = 0;    ///< frames without the companion that position_tolerance is measured with
  std::int64_t longer_substeps = 0;      ///< substeps longer than the tensions ask for
  std::int64_t unfinished_substeps = 0;  ///< substeps that ended before their links had settled
  std::int64_t shortened_frames = 0;     ///< frames that ended early
  double lost_time = 0.0;                ///< motion left out by these [s]
  std::int64_t late_frames = 0;          ///< frames that took longer than the budget all the same
  std::int64_t stops = 0;                ///< of the last resort, in which the cloth stayed where it was
  double momentum_cut = 0.0;             ///< by the last resort, sum over nodes and substeps [N s]
  double obstacles_waited = 0.0;         ///< motion of obstacles put off, because the cloth could not give way [s]
  double warp_stretch = 0.0;             ///< largest relative overlength of a warp rod at the last frame's end
  double weft_stretch = 0.0;             ///< the same of a weft link
  double warp_compression = 0.0;         ///< largest relative underlength of a warp rod, last frame's end
  double warp_stretch_max = 0.0;         ///< the largest of these at any frame's end
  double weft_stretch_max = 0.0;         ///< the same of weft links
  double warp_compression_max = 0.0;     ///< the same of what rods are too short by
  int contacts = 0;               ///< places that press on an obstacle or on the cloth itself at the last frame's end
  int contacts_max = 0;           ///< the most of them at any frame's end
  double penetration_max = 0.0;   ///< deepest any node was inside an obstacle at any frame's end [m]
  double step_seconds = 0.0;      ///< computing time of the last frame [s]
  double step_seconds_max = 0.0;  ///< of the longest frame [s]
  double step_seconds_sum = 0.0;  ///< of all frames [s]
  std::array<double, kStageCount> stage_seconds{};  ///< computing time by stage, all frames [s]
  double position_error =
      0.0;             ///< estimated, a second of motion adds [m], RMS; 0: solver.position_tolerance not asked for
  bool finite = true;  ///< the state holds no NaN or infinity
};

/// Parts of the cloth that are inside an obstacle or stuck through it.
struct Piercings {
  int nodes = 0;  ///< deeper than the tolerance
  int edges = 0;  ///< warp, weft and the faces' diagonals
  int faces = 0;  ///< halves of faces, cut along their diagonals
};

/// What the cloth exerts on an obstacle by contact, pressure and friction; the world's axes.
struct ContactWrench {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  ///< [N]
  Eigen::Vector3d torque =
      Eigen::Vector3d::Zero();  ///< about the origin of the obstacle's frame, where it was meanwhile [N m]
  int contacts = 0;             ///< that pushed at the frame's end
};

/// What has put energy into the cloth since it was asked for (Simulator::countWork()), all in J. Taken together:
///     kinetic - (gravity + forces + pins + obstacles)
/// is what damping, friction and links that snap taut have taken out, so it never rises but by the scheme's own error.
struct Work {
  double gravity = 0.0;  ///< what the potential energy has fallen by
  double forces = 0.0;   ///< of winds and drags
  double pins = 0.0;     ///< of those that were moved; Method::kPaper does not know, nor does any where links are drawn
                         ///< straight between two pins: what these pull has no one answer then
  double obstacles = 0.0;  ///< that moved
  double kinetic = 0.0;    ///< what the kinetic energy has grown by
};

/// Energy of the cloth; potential is of gravity, zero at the world's origin.
struct Energy {
  double kinetic = 0.0;    ///< [J]
  double potential = 0.0;  ///< [J]
};

}  // namespace curtain
