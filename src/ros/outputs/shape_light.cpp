// SPDX-License-Identifier: BSD-3-Clause
#include "ros/outputs/shape_light.h"

#include <algorithm>
#include <cmath>

namespace curtain_ros {

using curtain::Vec3;

namespace {

// Light of a clear day, from before the scene, the left and above; from the sky, and less from the ground. It is added
// up as it is in nature and shown with a gamma of 2, as that on the cloth (src/rviz/cloth_shader.h).
const Vec3 kToLight = Vec3(-0.45, -0.60, 0.75).normalized();
const Vec3 kDirect(0.92, 0.88, 0.82);
const Vec3 kFromAbove(0.46, 0.48, 0.52);
const Vec3 kFromBelow(0.24, 0.23, 0.22);

}  // namespace

std_msgs::ColorRGBA litColour(const Vec3& base, const Vec3& normal) {
  const double from_above = 0.5 + 0.5 * normal.z();
  const Vec3 light =
      kFromBelow + from_above * (kFromAbove - kFromBelow) + std::max(normal.dot(kToLight), 0.0) * kDirect;
  const auto shown = [&](int part) { return static_cast<float>(std::min(base[part] * std::sqrt(light[part]), 1.0)); };
  std_msgs::ColorRGBA colour;
  colour.r = shown(0);
  colour.g = shown(1);
  colour.b = shown(2);
  colour.a = 1.0F;  // less than 1 would stop rviz from writing depth
  return colour;
}

}  // namespace curtain_ros
