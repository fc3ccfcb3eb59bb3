// SPDX-License-Identifier: BSD-3-Clause
//
// Floor 0: statistics of a simulator, as plain structs filled by the floors above.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <limits>

namespace curtain {

/// The stages of a frame, in their order (as in the loop of Cheng 2000, Sect. 1.3).
enum class Stage { kForces, kPredict, kWarp, kWeft, kContact, kFinish, kEstimate, kStageCount };
/// Number of stages.
constexpr int kStageCount = static_cast<int>(Stage::kStageCount);
/// Its name in the statistics of curtain_batch, e.g. "forces".
const char* stageName(Stage stage);

/// How a frame was made, from best to worst: that of its worst substep.
enum class FrameQuality : std::uint8_t {
  kResolved,   ///< by the method, links and contacts within their tolerances; or the cloth slept
  kHurried,    ///< solver.budget_ms lengthened a substep, or ended a substep or the frame early
  kUnsettled,  ///< a substep ended above solver.stretch_tolerance
  kBounded,    ///< a substep by the last resort: motion was cut so that links hold (docs/method.md)
  kStopped     ///< in such a substep the cloth stayed where it was
};
/// Number of qualities.
constexpr int kFrameQualityCount = 5;
/// Its name in Python's statistics, e.g. "resolved".
const char* toString(FrameQuality quality);

/// Counters since construction or reset(); where it says so, values of the last frame.
struct Statistics {
  std::int64_t frames = 0;                ///< frames made
  double time = 0.0;                      ///< simulated time [s]
  std::int64_t substeps = 0;              ///< accepted, all frames
  int substeps_last = 0;                  ///< in the last frame
  std::int64_t sweeps = 0;                ///< warp/weft/contact sweeps, all frames
  int sweeps_last = 0;                    ///< in the last frame
  std::int64_t rejected = 0;              ///< substeps repeated with half the step
  std::int64_t last_resort_substeps = 0;  ///< substeps made by the last resort (docs/method.md)
  std::int64_t unsettled = 0;             ///< substeps that ended above stretch_tolerance
  std::int64_t asleep_frames = 0;         ///< frames in which the cloth slept
  std::int64_t wakes = 0;                 ///< times that it woke
  bool asleep = false;                    ///< it sleeps now
  // What solver.budget_ms has cost, in the order in which it is given up.
  std::int64_t estimates_skipped = 0;              ///< frames without the reference run of position_tolerance
  std::int64_t longer_substeps = 0;                ///< substeps longer than the tensions ask for
  std::int64_t unfinished_substeps = 0;            ///< substeps that ended before their links had converged
  std::int64_t shortened_frames = 0;               ///< frames that ended early
  double lost_time = 0.0;                          ///< motion that these left out [s]
  std::int64_t late_frames = 0;                    ///< frames that took longer than the budget all the same
  std::int64_t stops = 0;                          ///< last resort substeps in which the cloth stayed where it was
  int stops_last = 0;                              ///< in the last frame: the cloth stands, but is not at rest
  double momentum_cut = 0.0;                       ///< by the last resort, sum over nodes and substeps [N s]
  double momentum_cut_last = 0.0;                  ///< of it, in the last frame [N s]
  FrameQuality quality = FrameQuality::kResolved;  ///< of the last frame
  double obstacles_waited = 0.0;                   ///< delay of obstacles where the cloth could not give way [s]
  double warp_stretch = 0.0;          ///< largest relative overlength of a warp rod at the last frame's end
  double weft_stretch = 0.0;          ///< the same of a weft link
  double warp_compression = 0.0;      ///< largest relative underlength of a warp rod, last frame's end
  double warp_stretch_max = 0.0;      ///< the largest at any frame's end
  double weft_stretch_max = 0.0;      ///< the same for weft links
  double warp_compression_max = 0.0;  ///< the same for underlength of warp rods
  int contacts = 0;                   ///< contacts that push on an obstacle or the cloth itself at the last frame's end
  int contacts_max = 0;               ///< the most at any frame's end
  double penetration_max = 0.0;       ///< deepest penetration of a node into an obstacle at any frame's end [m]
  double step_seconds = 0.0;          ///< computing time of the last frame [s]
  double step_seconds_max = 0.0;      ///< of the longest frame [s]
  double step_seconds_sum = 0.0;      ///< of all frames [s]
  std::array<double, kStageCount> stage_seconds{};  ///< computing time by stage, all frames [s]
  double opening = 0.0;         ///< present place of the master carriers, as rail.opening; 0 without a rail
  double drive_force = 0.0;     ///< of the rail's drive on all masters, mean over the last frame [N]
  double position_error = 0.0;  ///< estimate per simulated second [m], RMS; 0: no solver.position_tolerance
  bool finite = true;           ///< the state holds no NaN or infinity
};

/// Parts of the cloth that are inside an obstacle or go through it.
struct Piercings {
  int nodes = 0;  ///< deeper than the tolerance
  int edges = 0;  ///< warp, weft and the quads' diagonals
  int faces = 0;  ///< triangles, two a quad
};

/// Where the cloth is nearest to an obstacle, or deepest in it; in world axes.
struct ObstacleDistance {
  double distance = std::numeric_limits<double>::infinity();  ///< [m], negative inside; infinite: there is no obstacle
  Eigen::Vector3d on_cloth = Eigen::Vector3d::Zero();         ///< [m]
  Eigen::Vector3d on_obstacle = Eigen::Vector3d::Zero();      ///< nearest to it on the obstacle's surface [m]
};

/// Contact force and torque of the cloth on an obstacle, pressure and friction, in world axes.
struct ContactWrench {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   ///< [N]
  Eigen::Vector3d torque = Eigen::Vector3d::Zero();  ///< about the origin of the obstacle's moving frame [N m]
  int contacts = 0;                                  ///< that pushed at the frame's end
  /// Time that the frame's forces acted for [s]: force times it is the momentum given to the obstacle. Near a frame's
  /// length, and not equal to it where substeps change their length: forces act from the middle of one to that of the
  /// next.
  double time = 0.0;
};

/// A place where the cloth presses on an obstacle, in world axes.
struct ContactForce {
  int obstacle = 0;                                    ///< index in the scene
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< of the cloth there [m]
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();    ///< unit, out of the obstacle
  double normal_force = 0.0;                           ///< > 0: the cloth presses on it against the normal [N]
  Eigen::Vector3d friction = Eigen::Vector3d::Zero();  ///< of the cloth on the obstacle, across the normal [N]
};

/// Work on the cloth since Simulator::countWork(), all in J. The sum
///     kinetic - (gravity + elastic + forces + drive + pins + obstacles)
/// is minus what damping, friction, carriers that stop and links that snap taut have dissipated, so but for the
/// scheme's error it never rises.
struct Work {
  double gravity = 0.0;     ///< decrease of the gravitational potential energy
  double elastic = 0.0;     ///< work of elastic forces: decrease of their energy, with what is dissipated
  double dissipated = 0.0;  ///< of that, by friction within the fabric
  double forces = 0.0;      ///< work of winds and drags
  double drive = 0.0;       ///< work of the drive on a rail's carriers, and of tie-backs that close
  double pins = 0.0;  ///< work of moved pins; unknown to Method::kPaper, and where links are drawn straight between
                      ///< two pins, since their tensions are not unique then
  double obstacles = 0.0;  ///< work of moving obstacles
  double kinetic = 0.0;    ///< increase of the kinetic energy
};

/// Energy of the cloth; the gravitational potential is zero at the world's origin.
struct Energy {
  double kinetic = 0.0;    ///< [J], of nodes whose position is not prescribed
  double potential = 0.0;  ///< [J]
};

}  // namespace curtain
