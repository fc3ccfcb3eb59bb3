// SPDX-License-Identifier: BSD-3-Clause
#include "sensing/sensor_view.h"

#include "sensing/hashed_random.h"
#include "sensing/range_noise.h"

namespace curtain {

SensorView::SensorView(const Simulator& simulator, const FlatCloth& flat, const SensorParams& params)
    : flat_(flat), params_(params), caster_(simulator, params.porosity) {}

void SensorView::render(const Moment& moment, const Pose& sensor) {
  caster_.place(moment, sensor);
  const RayRange range{static_cast<float>(params_.min_range), static_cast<float>(params_.max_range)};
  caster_.cast(rays_, range, randomKey(params_.seed, moment.frame, Purpose::kPore), hits_);
  const RangeReadings readings(params_, moment.frame);
  readings_.resize(hits_.size());
  for (std::size_t ray = 0; ray < hits_.size(); ++ray) readings_[ray] = readings.read(ray, direction(ray), hits_[ray]);
}

void SensorView::labels(std::vector<std::uint16_t>& out) const {
  out.resize(hits_.size());
  for (std::size_t ray = 0; ray < hits_.size(); ++ray) out[ray] = hits_[ray].label;
}

void SensorView::nodes(std::vector<std::int32_t>& out) const {
  out.resize(hits_.size());
  for (std::size_t ray = 0; ray < hits_.size(); ++ray) {
    const RayHit& hit = hits_[ray];
    out[ray] = hit.triangle >= 0 ? flat_.nearestNode(flat_.place(hit.triangle, hit.b1, hit.b2)) : -1;
  }
}

void SensorView::points(const Moment& moment, std::vector<CloudPoint>& out) const {
  out.assign(hits_.size(), CloudPoint());
  for (std::size_t ray = 0; ray < hits_.size(); ++ray) {
    const float reading = readings_[ray];
    if (!(reading == reading)) continue;
    const RayHit& hit = hits_[ray];
    CloudPoint& point = out[ray];
    point.setPosition(direction(ray) * reading);
    const Eigen::Vector3f normal = hit.normal.normalized();
    point.setNormal(normal.dot(direction(ray)) > 0.0F ? Eigen::Vector3f(-normal) : normal);
    if (hit.triangle == RayHit::kObstacle) continue;
    const ClothPlace place = flat_.place(hit.triangle, hit.b1, hit.b2);
    const Eigen::Vector2d flat = flat_.coordinates(place);
    point.node = flat_.nearestNode(place);
    point.u = static_cast<float>(flat.x());
    point.v = static_cast<float>(flat.y());
    point.speed = static_cast<float>(flat_.velocity(place, moment.velocities).norm());
  }
}

}  // namespace curtain
