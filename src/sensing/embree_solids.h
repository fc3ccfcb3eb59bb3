// SPDX-License-Identifier: BSD-3-Clause
//
// Solids as a geometry of Embree's: it asks for their boxes, and for a ray's first hit.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "curtain_sim/scene.h"
#include "sensing/embree.h"
#include "sensing/solid_rays.h"

namespace curtain {

/// A solid obstacle as seen from the sensor, which all rays start from.
class PlacedSolid {
 public:
  /// bounds  of the shape [m], its own frame; infinite for a plane
  PlacedSolid(const ObstacleParams& shape, const Eigen::AlignedBox3d& bounds) : shape_(shape), bounds_(bounds) {}

  /// pose  in the sensor's frame
  void place(bool present, const Eigen::Isometry3d& pose);

  bool present() const { return present_; }
  /// Around it, in the sensor's frame; of a plane: as far as obstacles may be.
  Eigen::AlignedBox3d bounds() const;
  /// Where a ray from the sensor's origin meets it, normal in the sensor's frame.
  std::optional<SolidHit> meet(const Vec3& direction, double nearest) const;

 private:
  ObstacleParams shape_;
  Eigen::AlignedBox3d bounds_;
  bool present_ = false;
  Eigen::Isometry3d pose_ = Eigen::Isometry3d::Identity();
  Vec3 sensor_ = Vec3::Zero();   // in the shape's frame
  Vec3 middle_ = Vec3::Zero();   // of a ball around it, in the sensor's frame
  double radius_squared_ = 0.0;  // of that ball
};

/// A geometry of these solids, which must outlive it and keep their number; commit it after they have moved.
RTCGeometry makeSolidGeometry(RTCDevice device, std::vector<PlacedSolid>& solids);

}  // namespace curtain
