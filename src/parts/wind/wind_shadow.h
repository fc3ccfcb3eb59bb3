// SPDX-License-Identifier: BSD-3-Clause
//
// What obstacles leave of a source's wind: WindParams::shadow. The air at a node has come along the line from its place
// on the disc, in the node's cone's direction (WindSource::origin()). Along that line a jet mixes with the air beside
// it within about a tenth of its length (half-angle of free jets and wakes; Pope 2000, Sect. 5.4), so the node is
// reached by a bundle of lines that is so wide at the disc:
//
//     disc |  .  *                 the line to the node, and six around it that start 0.1 |BC| away
//        B *------------C          the node's wind is the share of the seven that no obstacle crosses: none in the core
//          |  .  *                 of a shadow, all outside of it, and sevenths at its edge
//
#pragma once

#include <vector>

#include "obstacles/obstacle_set.h"
#include "parts/wind/layer_shadow.h"
#include "parts/wind/wind_source.h"

namespace curtain {

/// Not thread-safe. Allocates only where there are more obstacles than ever before.
class WindShadow {
 public:
  /// pattern must outlive this.
  explicit WindShadow(const ClothPattern& pattern) : layers_(pattern) {}

  /// Sets the source's shade from the obstacles' poses at the end of the last frame. Does nothing for sources without
  /// WindParams::shadow, and hardly anything where no obstacle is in the cone.
  void cast(const ObstacleSet& obstacles, const Grid& grid, const Field3& position, WindSource& wind);

 private:
  struct InCone {
    const ContactShape* shape;
    Transform place;
    Vec3 centre;    // of a ball around it, world frame [m]
    double radius;  // [m], infinite for a plane
  };
  double shareAt(const Vec3& node, const WindSource& wind) const noexcept;

  std::vector<InCone> in_cone_;
  LayerShadow layers_;
};

/// Whether an obstacle that is there may be in the source's cone, at the end of the last frame or now.
bool mayShade(const ObstacleSet& obstacles, int index, const WindSource& wind) noexcept;

}  // namespace curtain
