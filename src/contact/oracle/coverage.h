// SPDX-License-Identifier: BSD-3-Clause
//
// How much of an obstacle the cloth hides from somebody far away, and whether it hides a point. On demand.
#pragma once

#include "cloth/cloth.h"
#include "obstacles/contact_shape.h"
#include "obstacles/obstacle_set.h"

namespace curtain {

/// Share of an obstacle's silhouette [0..1], as seen along parallel lines, that the first layer's mesh is in front of:
/// sampled at 128 x 128 points of the rectangle around it, so known to about a hundredth. NaN: it has no silhouette (a
/// plane).
///   place     the obstacle's frame in the world
///   position  of the nodes [m], world frame; padding nodes are ignored
///   from      direction towards who looks, any length > 0
/// Allocates; thread-safe.
double coveredShare(const ContactShape& shape, const Transform& place, const Grid& grid, const Field3& position,
                    const Vec3& from);

/// Whether the first layer's mesh is between a point and who looks at it from far away. from: direction towards that
/// one, any length > 0. Allocates; thread-safe.
bool hidesPoint(const Grid& grid, const Field3& position, const Vec3& point, const Vec3& from);

}  // namespace curtain
