// SPDX-License-Identifier: BSD-3-Clause
#include "sensing/cloth_sampler.h"

#include <algorithm>
#include <cmath>

#include "sensing/hashed_random.h"

namespace curtain {

// The triangles' areas are laid end to end and cut into as many equal strata as there are points; each has one point at
// random. So every triangle has its share to within one point at either end (stratified sampling, Cook 1986).
ClothSampler::ClothSampler(const FlatCloth& flat, double density, std::uint64_t seed) : flat_(flat) {
  const double total = flat.area();
  const auto count = static_cast<std::size_t>(std::llround(total * density));
  const std::uint64_t along = randomKey(seed, 0, Purpose::kPlace);
  const std::uint64_t across = randomKey(seed, 0, Purpose::kPlaceAcross);
  spots_.reserve(count);
  int triangle = 0;
  double begin = 0.0, area = flat.area(0);
  for (std::size_t n = 0; n < count; ++n) {
    const double at = total * (static_cast<double>(n) + hashedUniform(along, n)) / static_cast<double>(count);
    while (at > begin + area && triangle + 1 < flat.triangleCount()) {
      begin += area;
      area = flat.area(++triangle);
    }
    // Uniform in a triangle from two uniform numbers: Osada, Funkhouser, Chazelle, Dobkin, Shape Distributions, 2002,
    // Eq. (1). How far along its stratum a point lies says nothing of where in the triangle, but for large triangles,
    // where it spreads the points as well.
    const double root = std::sqrt(std::clamp((at - begin) / area, 0.0, 1.0));
    const double turn = hashedUniform(across, n);
    Spot spot{triangle, root * (1.0 - turn), root * turn, {}, 0.0F, 0.0F, 0};
    spot.place = flat.place(triangle, spot.b1, spot.b2);
    spot.u = static_cast<float>(flat.coordinates(spot.place).x());
    spot.v = static_cast<float>(flat.coordinates(spot.place).y());
    spot.node = flat.nearestNode(spot.place);
    spots_.push_back(spot);
  }
}

void ClothSampler::sample(const Moment& moment, std::vector<CloudPoint>& out) const {
  out.resize(spots_.size());
  const std::vector<Vec3>& corner = moment.mesh.positions;
  for (std::size_t n = 0; n < spots_.size(); ++n) {
    const Spot& spot = spots_[n];
    const auto& corners = flat_.topology().triangles[static_cast<std::size_t>(spot.triangle)];
    const Vec3& origin = corner[corners[0]];
    const Vec3 one = corner[corners[1]] - origin, other = corner[corners[2]] - origin;
    CloudPoint& point = out[n];
    point.setPosition((origin + spot.b1 * one + spot.b2 * other).cast<float>());
    point.setNormal(one.cross(other).stableNormalized().cast<float>());
    point.node = spot.node;
    point.u = spot.u;
    point.v = spot.v;
    point.speed = static_cast<float>(flat_.velocity(spot.place, moment.velocities).norm());
  }
}

}  // namespace curtain
