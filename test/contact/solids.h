// SPDX-License-Identifier: BSD-3-Clause
//
// One solid of every convex shape, by its name, and where the inside of each is.
#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "../../docs/examples/rounded_box.h"
#include "obstacles/shapes.h"

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

inline bool isInside(const std::string& name, const curtain::Vec3& p) {
  if (name == "sphere") {
    return p.squaredNorm() < 0.49;
  }
  if (name == "box") {
    return std::abs(p.x()) < 0.5 && std::abs(p.y()) < 0.8 && std::abs(p.z()) < 0.3;
  }
  if (name == "rounded box") {
    return (p.cwiseAbs() - curtain::Vec3(0.3, 0.4, 0.2)).cwiseMax(0.0).squaredNorm() < 0.04;
  }
  const double radial_squared = p.x() * p.x() + p.y() * p.y();
  if (name == "cylinder") {
    return radial_squared < 0.25 && std::abs(p.z()) < 0.7;
  }
  const double beyond = std::max(std::abs(p.z()) - 0.6, 0.0);
  return radial_squared + beyond * beyond < 0.16;
}

}  // namespace curtain_test
