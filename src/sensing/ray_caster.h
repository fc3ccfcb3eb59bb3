// SPDX-License-Identifier: BSD-3-Clause
//
// What the rays of a sensor meet first: the cloth's fine mesh, or an obstacle. The search is Embree's (bounding volume
// hierarchies, packets of eight rays), in the sensor's frame, so that single precision is precise near the sensor:
//
//   the cloth        a triangle mesh, its hierarchy built again for each moment: then no result depends on those before
//   solids           sphere, box, cylinder, capsule, plane: met exactly, not as the facets they are drawn with
//   mesh obstacles   a hierarchy each, built once, put where the obstacle is
//
// All on the calling thread: how many there are changes no bit.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "sensing/moment.h"
#include "sensing/rays.h"

namespace curtain {

/// What a ray meets.
struct RayHit {
  static constexpr std::int32_t kNothing = -1;  ///< nothing within the range
  static constexpr std::int32_t kObstacle = -2;
  static constexpr std::uint16_t kBackground = 0, kCloth = 1, kFirstObstacle = 2;

  std::int32_t triangle = kNothing;                  ///< of the fine mesh, or one of the above
  std::uint16_t label = kBackground;                 ///< kBackground, kCloth, kFirstObstacle and its number, or behind
                                                     ///< the obstacles a layer of the scene
  float distance = 0.0F;                             ///< parameter along the ray, in lengths of its direction
  float b1 = 0.0F, b2 = 0.0F;                        ///< weights of the triangle's second and third corner
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();  ///< sensor's frame, of any length and either side
};

/// Parameters between which a ray meets anything, in lengths of its direction.
struct RayRange {
  float nearest, farthest;
};

/// One thread at a time.
class RayCaster {
 public:
  /// Whether this build has Embree; without it none can be made.
  static bool available();

  /// Copies what does not change: the mesh's triangles and the obstacles' shapes. Throws std::runtime_error when Embree
  /// can't be started.
  ///   porosity  [0..1] probability that a sheet of cloth lets a ray through; none: that of its fabric
  RayCaster(const Simulator& simulator, std::optional<double> porosity);
  ~RayCaster();
  RayCaster(const RayCaster&) = delete;
  RayCaster& operator=(const RayCaster&) = delete;

  /// Places everything as it was at a moment, seen from a sensor. Throws std::runtime_error with Embree's words (out of
  /// memory).
  ///   sensor  pose in the world
  void place(const Moment& moment, const Pose& sensor);

  /// Casts all rays; hits: resized to [rays.size()]. Allocates nothing otherwise.
  ///   pore_key  which rays pass is drawn by this and the ray's number
  void cast(const RayGrid& rays, const RayRange& range, std::uint64_t pore_key, std::vector<RayHit>& hits) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace curtain
