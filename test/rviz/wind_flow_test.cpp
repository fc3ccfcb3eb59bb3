// SPDX-License-Identifier: BSD-3-Clause
#include "rviz/surface/wind_flow.h"

#include <gtest/gtest.h>

#include <cmath>

namespace curtain_rviz {
namespace {

using curtain::Vec3;

constexpr double kRadius = 0.5, kHalfAngle = 0.3, kPressure = 5.4;  // 1/2 1.2 u^2: 3 m/s

curtain_sim::WindSource fan(double pressure) {
  curtain_sim::WindSource wind;
  wind.pose.position.x = 1.0;
  wind.pose.orientation.z = wind.pose.orientation.w = std::sqrt(0.5);  // blows along +y
  wind.radius = kRadius;
  wind.half_angle = kHalfAngle;
  wind.pressure = pressure;
  return wind;
}

std::vector<FlowVertex> flow(double pressure, double seconds) {
  std::vector<FlowVertex> out;
  addWindFlow(fan(pressure), Vec3(1.2, 2.0, 0.3), seconds, out);
  EXPECT_EQ(out.size() % 3, 0u);
  return out;
}

TEST(WindFlow, StaysInTheConeBetweenTheDiscAndTheCloth) {
  for (const double seconds : {0.0, 0.1, 1.7, 1e4}) {
    double brightest = 0.0;
    for (const FlowVertex& vertex : flow(kPressure, seconds)) {
      const Vec3 from = vertex.position - Vec3(1.0, 0.0, 0.0);
      EXPECT_GE(from.y(), -0.05) << "a dart's head may reach back by its half width";
      EXPECT_LE(from.y(), 2.05);
      EXPECT_LE(std::hypot(from.x(), from.z()), kRadius + from.y() * std::tan(kHalfAngle) + 0.05);
      EXPECT_GE(vertex.alpha, 0.0F);
      EXPECT_LE(vertex.alpha, 1.0F);
      brightest = std::max(brightest, static_cast<double>(vertex.alpha));
    }
    EXPECT_GT(brightest, 0.9);
  }
}

// The tip of the dart is the fifth corner of its six.
TEST(WindFlow, FliesAsFastAsTheAir) {
  const std::vector<FlowVertex> rim = flow(0.0, 0.0), before = flow(kPressure, 0.0), after = flow(kPressure, 0.01);
  ASSERT_GT(before.size(), rim.size());
  EXPECT_EQ(after.size(), before.size());
  int flew = 0;
  for (std::size_t tip = rim.size() + 4; tip < before.size(); tip += 6) {
    const double way = after[tip].position.y() - before[tip].position.y();
    if (way < 0.0) continue;  // that one has begun again
    EXPECT_NEAR(way, 0.03, 1e-9);
    ++flew;
  }
  EXPECT_GT(flew, 20);
}

TEST(WindFlow, BlowsSomeWayWhereTheClothIsBehind) {
  std::vector<FlowVertex> out;
  addWindFlow(fan(kPressure), Vec3(1.0, -3.0, 0.0), 0.0, out);
  double farthest = 0.0;
  for (const FlowVertex& vertex : out) farthest = std::max(farthest, vertex.position.y());
  EXPECT_GT(farthest, 0.4);
  EXPECT_LT(farthest, 0.6);
}

}  // namespace
}  // namespace curtain_rviz
