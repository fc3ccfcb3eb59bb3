// SPDX-License-Identifier: BSD-3-Clause
//
// The cone wind source of Cheng 2000, Sect. 2.2.2, Eqs. (2)(3).
//
//            .|          A  apex of the cone, radius / tan(half_angle) behind the disc
//         .   |          O  centre of the disc, a its axis
//   A - - - - O---> a    C  a node; B where the line AC meets the disc's plane; d = C - B
//         .   |B .
//            .|     . C
#pragma once

#include "cloth/cloth.h"
#include "curtain_sim/scene.h"
#include "forces/gust_noise.h"

namespace curtain {

/// What the air of one source does at one place.
struct WindAtPoint {
  bool reached = false;         ///< inside the cone and before the disc
  Vec3 direction = Vec3::Zero();  ///< unit d
  double along_axis = 0.0;      ///< cosine between d and the axis (0 only where nothing is reached)
  double distance_factor = 0.0;  ///< 1 / (c_d (1 + |d|^2)), |d|^2 in units of 1 m^2
};

class WindSource {
 public:
  /// wind must be valid (validate()).
  WindSource(const WindParams& wind, const ClothPattern& pattern, double porosity, std::uint64_t seed);

  const WindParams& params() const { return wind_; }
  bool blowsAt(double time) const { return time >= wind_.start && time < wind_.end && strength_ > 0.0; }

  WindAtPoint at(const Vec3& point) const noexcept;

  /// Adds the source's force on every node [N]. area_vectors as nodeAreaVectors gives them.
  void addForces(const ClothPattern& pattern, const Field3& position, const Field3& area_vectors, double time,
                 Field3& force) noexcept;

 private:
  // One place, without a branch, so that loops over nodes widen.
  struct Sample {
    double dx, dy, dz;  // unit d
    double along;       // cosine between d and the axis
    double distance_factor;  // of Eq. (3); 0 where nothing is reached
  };
  Sample sample(double x, double y, double z) const noexcept;
  void addGusts(const ClothPattern& pattern, double time, Field3& force) noexcept;

  WindParams wind_;
  Vec3 axis_;
  Vec3 apex_ = Vec3::Zero();
  double apex_distance_ = 0.0;  // [m]; 0 = parallel wind
  double porosity_factor_;      // 1 - c_mu mu
  double strength_;             // of everything it does; 0 = the source is there but still
  GustNoise gusts_;
  Field distance_factor_;  // of every node, from the last call of addForces
  Field gust_row_;         // scratch: a component of the gusts along a row
};

}  // namespace curtain
