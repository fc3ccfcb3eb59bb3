// SPDX-License-Identifier: BSD-3-Clause
//
// A wind source on a cloth that stands still.
#pragma once

#include "parts/wind/wind_source.h"
#include "testing.h"

namespace curtain_test {

using curtain::ClothParams;
using curtain::ClothPattern;
using curtain::Field3;
using curtain::Scene;
using curtain::Vec3;
using curtain::WindParams;
using curtain::WindSource;

/// Cloth of a pattern's columns and of this porosity.
inline ClothParams porous(const ClothPattern& pattern, double porosity) {
  ClothParams cloth;
  cloth.rows = pattern.grid.rows;
  cloth.columns = pattern.grid.columns;
  cloth.porosity = porosity;
  return cloth;
}

struct WindyCloth {
  explicit WindyCloth(const Scene& scene)
      : pattern(makePattern(scene)), position(makeInitialState(scene, pattern).position) {
    renew();
  }
  void renew() {
    normals.assign(pattern.grid.size(), 0.0);
    nodeAreaVectors(pattern.grid, position, normals);
  }
  Field3 push(WindSource& source, double time = 0.0) const {
    Field3 force;
    force.assign(pattern.grid.size(), 0.0);
    Eigen::AlignedBox3d bounds;
    for (int i = 0; i < pattern.grid.rows; ++i) {
      for (int j = 0; j < pattern.grid.columns; ++j) bounds.extend(position.at(pattern.grid.index(i, j)));
    }
    source.find(pattern.grid, position, bounds);
    source.addForces(pattern, position, normals, time, force);
    return force;
  }
  Field3 push(const WindParams& wind, double porosity = 0.0) const {
    WindSource source(wind, pattern, porous(pattern, porosity), 1);
    return push(source);
  }
  Vec3 total(const WindParams& wind) const {
    const Field3 force = push(wind);
    Vec3 sum = Vec3::Zero();
    for (std::size_t n = 0; n < pattern.grid.size(); ++n) sum += force.at(n);
    return sum;
  }
  ClothPattern pattern;
  Field3 position, normals;
};

inline WindParams randomWind(Random& random) {
  WindParams wind;
  wind.id = "fan";
  wind.position = random.inBox(1.0);
  wind.direction = random.between(0.1, 10.0) * random.direction();
  wind.radius = random.between(0.3, 1.5);
  wind.half_angle = random.between(0.0, 1.0) < 0.2 ? 0.0 : random.between(0.02, 1.5);
  wind.pressure = random.between(0.0, 20.0);
  wind.node_force = random.between(0.0, 1.0);
  wind.porosity_weight = random.between(0.0, 1.0);
  wind.distance_weight = random.between(0.1, 3.0);
  wind.reference_length = random.between(0.3, 3.0);
  return wind;
}

}  // namespace curtain_test
