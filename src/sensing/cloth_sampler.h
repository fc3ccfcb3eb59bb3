// SPDX-License-Identifier: BSD-3-Clause
//
// Points all over the cloth. They are chosen once, on the flat cloth, and go with it: point number n is the same spot
// of the fabric in every cloud.
#pragma once

#include <cstdint>
#include <vector>

#include "sensing/cloud_point.h"
#include "sensing/flat_cloth.h"
#include "sensing/moment.h"

namespace curtain {

/// One thread at a time.
class ClothSampler {
 public:
  /// density  points per m^2 of the flat cloth, > 0; their number is the area times this, rounded
  /// flat must outlive this.
  ClothSampler(const FlatCloth& flat, double density, std::uint64_t seed);

  std::size_t size() const { return spots_.size(); }

  /// The points in the world frame; normals as Simulator's, 0 where a triangle has no area. out: resized
  void sample(const Moment& moment, std::vector<CloudPoint>& out) const;

 private:
  struct Spot {
    int triangle;
    double b1, b2;  // weights of its second and third corner
    ClothPlace place;
    float u, v;
    std::int32_t node;
  };

  const FlatCloth& flat_;
  std::vector<Spot> spots_;
};

}  // namespace curtain
