// SPDX-License-Identifier: BSD-3-Clause
//
// Light on obstacles: what faces the light is brighter. No ROS master needed.
#include "ros/outputs/shape_light.h"

#include <gtest/gtest.h>

namespace curtain_ros {
namespace {

using curtain::Vec3;

TEST(ShapeLight, WhatFacesTheLightIsBrighterAndNothingIsBlackOrTooBright) {
  const Vec3 base(0.2, 0.9, 1.0);
  const auto up = litColour(base, Vec3::UnitZ()), down = litColour(base, -Vec3::UnitZ());
  const auto front = litColour(base, -Vec3::UnitY()), behind = litColour(base, Vec3::UnitY());
  EXPECT_GT(up.r, front.r);
  EXPECT_GT(front.r, behind.r);
  EXPECT_GT(behind.r, down.r);
  for (const auto& colour : {up, down, front, behind}) {
    EXPECT_GT(colour.r, 0.25F * 0.2F);
    EXPECT_LE(colour.b, 1.0F);
    EXPECT_EQ(colour.a, 1.0F);
  }
}

}  // namespace
}  // namespace curtain_ros
