// SPDX-License-Identifier: BSD-3-Clause
//
// One solid of every convex shape, by its name.
#pragma once

#include <map>
#include <string>

#include "../../docs/examples/rounded_box.h"
#include "contact/shapes/shapes.h"

namespace curtain_test {

inline const curtain::SphereShape kSphere(0.7);
inline const curtain::BoxShape kBox(curtain::Vec3(1.0, 1.6, 0.6));
inline const curtain::CylinderShape kCylinder(0.5, 1.4);
inline const curtain::CapsuleShape kCapsule(0.4, 1.2);
inline const curtain::PlaneShape kPlane;
inline const curtain::RoundedBoxShape kRoundedBox(curtain::Vec3(1.0, 1.2, 0.8), 0.2);
inline const std::map<std::string, const curtain::ConvexShape*> kSolids = {
    {"sphere", &kSphere},   {"box", &kBox},     {"cylinder", &kCylinder},
    {"capsule", &kCapsule}, {"plane", &kPlane}, {"rounded box", &kRoundedBox}};

}  // namespace curtain_test
