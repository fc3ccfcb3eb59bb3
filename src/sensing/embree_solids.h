// SPDX-License-Identifier: BSD-3-Clause
//
// Solids as a geometry of Embree's: it asks for their boxes, and for a ray's first hit.
#pragma once

#include <embree3/rtcore.h>

#include <Eigen/Geometry>
#include <vector>

#include "curtain_sim/scene.h"

namespace curtain {

/// A solid obstacle as seen from the sensor.
struct PlacedSolid {
  ObstacleParams shape;
  Eigen::AlignedBox3d bounds;                              ///< of the shape [m], its own frame; infinite for a plane
  std::size_t obstacle;                                    ///< its number
  bool present = false;                                    ///< else no ray meets it
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();  ///< in the sensor's frame
};

/// A geometry of these solids, which must outlive it and keep their number; commit it after they have moved.
RTCGeometry makeSolidGeometry(RTCDevice device, std::vector<PlacedSolid>& solids);

}  // namespace curtain
