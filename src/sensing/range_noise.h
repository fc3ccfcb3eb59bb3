// SPDX-License-Identifier: BSD-3-Clause
//
// From the distance of what a ray meets to the sensor's reading: noise and lost readings, by named models.
#pragma once

#include <cstdint>

#include "sensing/ray_caster.h"
#include "sensing/rays.h"
#include "sensing/sensor_params.h"

namespace curtain {

/// Standard deviation [m] of a reading. For a camera depth is along its axis, for a lidar along the ray.
///   sigma  [m], of gaussian
///   depth  [m], > 0
///   angle  of incidence, between ray and normal [rad], [0..pi/2]
double noiseDeviation(RangeNoise model, double sigma, double depth, double angle);

/// Readings of one frame. Immutable.
class RangeReadings {
 public:
  /// params must outlive this.
  RangeReadings(const SensorParams& params, std::uint64_t frame);

  /// The reading of a ray, as a parameter along it; NaN: none.
  ///   ray        its number
  ///   direction  of the ray
  float read(std::size_t ray, const Eigen::Vector3f& direction, const RayHit& hit) const;

 private:
  const SensorParams& params_;
  std::uint64_t dropout_key_, radius_key_, angle_key_;
};

}  // namespace curtain
