// SPDX-License-Identifier: BSD-3-Clause
#include "sensing/range_noise.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "scene/pi.h"
#include "sensing/hashed_random.h"

namespace curtain {
namespace {

// Cosine of the angle between ray and normal, either side.
double cosineOf(const Eigen::Vector3f& direction, const Eigen::Vector3f& normal) {
  const double lengths = static_cast<double>(direction.norm()) * static_cast<double>(normal.norm());
  return lengths > 0.0 ? std::min(std::abs(static_cast<double>(direction.dot(normal))) / lengths, 1.0) : 0.0;
}

}  // namespace

double noiseDeviation(RangeNoise model, double sigma, double depth, double angle) {
  switch (model) {
    case RangeNoise::kNone:
      return 0.0;
    case RangeNoise::kGaussian:
      // Thrun, Burgard, Fox, Probabilistic Robotics, 2005, Sect. 6.3: p_hit.
      return sigma;
    case RangeNoise::kKhoshelham2012:
      // Khoshelham, Oude Elberink, Accuracy and Resolution of Kinect Depth Data, Sensors 12(2), 2012: random error of
      // structured light grows with the square of the depth, 1.425e-5 Z^2 in centimetres.
      return 1.425e-3 * depth * depth;
    case RangeNoise::kNguyen2012: {
      // Nguyen, Izadi, Lovell, Modeling Kinect Sensor Noise, 3DIMPVT 2012: axial noise, with its hyperbolic part from
      // 60 degrees on.
      const double axial = 0.0012 + 0.0019 * (depth - 0.4) * (depth - 0.4);
      if (angle <= kPi / 3.0) return axial;
      const double aslant = angle / (0.5 * kPi - angle);
      return axial + 0.0001 / std::sqrt(depth) * aslant * aslant;
    }
  }
  return 0.0;
}

RangeReadings::RangeReadings(const SensorParams& params, std::uint64_t frame)
    : params_(params),
      dropout_key_(randomKey(params.seed, frame, Purpose::kDropout)),
      radius_key_(randomKey(params.seed, frame, Purpose::kNoiseRadius)),
      angle_key_(randomKey(params.seed, frame, Purpose::kNoiseAngle)) {}

float RangeReadings::read(std::size_t ray, const Eigen::Vector3f& direction, const RayHit& hit) const {
  constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
  if (hit.triangle == RayHit::kNothing) return kNone;
  // Thrun et al.: p_max, readings that are lost whatever is there.
  if (params_.dropout > 0.0 && hashedUniform(dropout_key_, ray) < params_.dropout) return kNone;
  if (!params_.lambertian && params_.noise == RangeNoise::kNone) return hit.distance;
  const double cosine = cosineOf(direction, hit.normal);
  const double distance = hit.distance;
  // What comes back from a surface that scatters evenly, larger than the beam, is as cos(angle) / range^2 (Jelalian,
  // Laser Radar Systems, 1992); below that of max_range straight on it is lost. On a ray, depths are as distances.
  if (params_.lambertian && distance * distance > cosine * params_.max_range * params_.max_range) return kNone;
  if (params_.noise == RangeNoise::kNone) return hit.distance;
  const double deviation = noiseDeviation(params_.noise, params_.sigma, distance, std::acos(cosine));
  const double reading =
      distance + deviation * normalFrom(hashedUniform(radius_key_, ray), hashedUniform(angle_key_, ray));
  const bool in_range = reading >= params_.min_range && reading <= params_.max_range;  // not NaN either
  return in_range ? static_cast<float>(reading) : kNone;
}

}  // namespace curtain
