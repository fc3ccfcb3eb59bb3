// SPDX-License-Identifier: BSD-3-Clause
//
// What a camera or a lidar sees of a moment: a reading for each of its rays, and the points these make.
#pragma once

#include <vector>

#include "sensing/cloud_point.h"
#include "sensing/flat_cloth.h"
#include "sensing/moment.h"
#include "sensing/ray_caster.h"
#include "sensing/rays.h"
#include "sensing/sensor_params.h"

namespace curtain {

/// One thread at a time. Same moment, pose, rays and seed: same bits.
class SensorView {
 public:
  /// flat must outlive this. Throws std::runtime_error when Embree can't be started.
  SensorView(const Simulator& simulator, const FlatCloth& flat, const SensorParams& params);

  /// Its rays, before the first render().
  void setRays(RayGrid rays) { rays_ = std::move(rays); }
  const RayGrid& rays() const { return rays_; }

  /// Looks at a moment. Throws std::runtime_error when there is not enough memory.
  ///   sensor  pose in the world
  void render(const Moment& moment, const Pose& sensor);

  /// Of the last render(), by ray: depth of a camera, distance of a lidar [m]; NaN: none.
  const std::vector<float>& readings() const { return readings_; }

  /// What each ray of the last render() met first, whether it gave a reading or not: RayHit::label. out: resized
  void labels(std::vector<std::uint16_t>& out) const;
  /// The nearest node on the flat cloth, row * columns + column, or -1: it met no cloth. out: resized
  void nodes(std::vector<std::int32_t>& out) const;

  /// The points of the last render(), by ray, in the sensor's frame, with normals towards the sensor. out: resized
  void points(const Moment& moment, std::vector<CloudPoint>& out) const;

 private:
  Eigen::Vector3f direction(std::size_t ray) const { return {rays_.x[ray], rays_.y[ray], rays_.z[ray]}; }

  const FlatCloth& flat_;
  SensorParams params_;
  RayCaster caster_;
  RayGrid rays_;
  std::vector<RayHit> hits_;
  std::vector<float> readings_;
};

}  // namespace curtain
