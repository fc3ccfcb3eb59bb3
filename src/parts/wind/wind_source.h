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

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "cloth/cloth.h"
#include "curtain_sim/scene.h"
#include "parts/wind/gust_noise.h"

namespace curtain {

class WindSource {
 public:
  /// wind must be valid (validate()).
  WindSource(const WindParams& wind, const ClothPattern& pattern, const Layers& layers, std::uint64_t seed);

  const WindParams& params() const { return wind_; }
  bool blowsAt(double time) const { return time >= wind_.start && time < wind_.end && strength_ > 0.0; }

  /// The point is inside the cone and in front of the disc.
  bool reachesPoint(const Vec3& point) const noexcept;

  /// False: it reaches no point of the box. Takes constant time.
  bool mayReach(const Eigen::AlignedBox3d& box) const noexcept;

  /// Finds the nodes in its reach; `bounds` contains all nodes.
  void find(const Grid& grid, const Field3& position, const Eigen::AlignedBox3d& bounds) noexcept;
  /// Whether the last find() found any, and any in this row.
  bool reaches() const noexcept { return reaches_; }
  bool reachesRow(int row) const noexcept { return reaches_ && rows_[static_cast<std::size_t>(row)] != 0; }
  /// The force depends on the direction of the normals.
  bool readsNormals() const noexcept { return steady_; }

  /// Adds the force on the found nodes [N]. area_vectors: from nodeAreaVectors(), read in reached rows if
  /// readsNormals().
  void addForces(const ClothPattern& pattern, const Field3& position, const Field3& area_vectors, double time,
                 Field3& force) noexcept;

  /// In place of the force, for AirLaw::kRelative: adds the velocity of the source's air at the found nodes [m/s],
  /// which has the dynamic pressure of Eqs. (2)(3): 1/2 rho |u|^2 = p. So has each component of the gusts.
  void addVelocities(const ClothPattern& pattern, const Field3& position, double time, double density,
                     Field3& velocity) noexcept;
  /// Largest speed of its air, without gusts [m/s].
  double topSpeed(const ClothPattern& pattern, double density) const noexcept;

  /// Share of its wind that the cloth at this node lets through.
  double passes(std::size_t node) const noexcept { return 1.0 - pores_[node]; }

  /// Share of the wind that obstacles and other cloths leave each node [0..1], shape [grid.size()], read by find();
  /// WindParams::shadow.
  Field& shade() noexcept { return shade_; }
  /// An obstacle or another cloth may be in the cone; else all of shade() is 1 and not read.
  bool shaded() const noexcept { return shaded_; }
  void setShaded(bool shaded) noexcept { shaded_ = shaded; }
  /// Two directions across the axis and each other, 0 and 1.
  Vec3 across(int direction) const noexcept { return direction == 0 ? across_ : axis_.cross(across_); }
  /// Where the air that reaches this point has passed the disc: B, or for a point behind it the point's projection.
  Vec3 origin(const Vec3& point) const noexcept;

 private:
  struct Direction {
    double x, y, z;  // unit d
    double along;    // cosine between d and the axis
  };
  // Geometry of the air flow. Loops over nodes use a copy, which stores to nodes cannot alias; without branches its
  // functions vectorise.
  struct Cone {
    double ox, oy, oz;                   // centre of the disc [m]
    double ax, ay, az;                   // axis
    double radius, apex_distance;        // [m]; no apex: 0, parallel wind
    double distance_weight, per_length;  // of the reference length [1/m]
    double of_place, of_axis;            // the line AC = of_place * (C from the centre) + of_axis * axis
    Direction directionAt(double x, double y, double z) const noexcept;
    double distanceFactorAt(double x, double y, double z) const noexcept;
    double ringShareAt(double x, double y, double z) const noexcept;
  };
  bool findInRow(const Grid& grid, int i, const Field3& position) noexcept;
  void formRingInRow(const Grid& grid, int i, const Field3& position) noexcept;
  void addSteady(const ClothPattern& pattern, int i, const Field3& position, const Field3& area_vectors,
                 Field3& force) const noexcept;
  void addGusts(const ClothPattern& pattern, int i, Field3& force) noexcept;
  void addSteadyVelocities(const ClothPattern& pattern, int i, const Field3& position, double per_pressure,
                           Field3& velocity) const noexcept;
  void addGustVelocities(const Grid& grid, int i, double per_pressure, Field3& velocity) noexcept;

  WindParams wind_;
  Vec3 axis_;
  Cone cone_;
  Field pores_;            // by node, 1 - c_mu mu
  double widening_ = 0.0;  // of the cone's radius along its axis; 0 = parallel wind
  double strength_;        // sum of pressure, node force and gusts; 0: the source is still
  bool steady_;            // it has more than gusts
  GustNoise gusts_;
  Field distance_factor_;           // of Eq. (3), of every node, from the last find(); 0 where nothing is reached
  Field gust_row_;                  // scratch: a component of the gusts along a row
  std::vector<std::uint8_t> rows_;  // rows with a node in reach, from the last find() whose box was reached
  bool reaches_ = false;
  Vec3 across_;
  Field shade_;  // empty: no shadow is asked for
  bool shaded_ = false;
};

}  // namespace curtain
