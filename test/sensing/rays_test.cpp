// SPDX-License-Identifier: BSD-3-Clause
//
// Rays go where sensor_msgs/CameraInfo and REP 103 say, and a camera that has none is refused in words.
#include "sensing/rays.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "testing.h"

namespace curtain {
namespace {

CameraModel camera() {
  CameraModel model;
  model.width = 64;
  model.height = 48;
  model.fx = 60.0;
  model.fy = 50.0;
  model.cx = 30.0;
  model.cy = 25.0;
  return model;
}

TEST(Rays, OfACameraGoThroughThePixels) {
  std::vector<Problem> problems;
  const RayGrid rays = cameraRays(camera(), problems);
  ASSERT_TRUE(problems.empty());
  ASSERT_EQ(rays.size(), 64U * 48U);
  const std::size_t pixel = 40 * 64 + 60;
  EXPECT_FLOAT_EQ(rays.x[pixel], 0.5F);
  EXPECT_FLOAT_EQ(rays.y[pixel], 0.3F);
  EXPECT_EQ(rays.z[pixel], 1.0F);
}

// The pixel of a ray, by the formulas of sensor_msgs/CameraInfo for plumb_bob, is the one it was made for: to 1e-9 in
// the plane z = 1, and what single precision takes, 2^-24 of a size up to 1, times 60 pixels.
TEST(Rays, OfADistortedCameraDoSo) {
  CameraModel model = camera();
  model.distortion = {-0.3, 0.1, 0.002, -0.003, -0.02};
  std::vector<Problem> problems;
  const RayGrid rays = cameraRays(model, problems);
  ASSERT_TRUE(problems.empty()) << describe(problems);
  const auto& [k1, k2, p1, p2, k3] = model.distortion;
  double moved = 0.0;
  for (int row = 0; row < model.height; ++row) {
    for (int column = 0; column < model.width; ++column) {
      const auto ray = static_cast<std::size_t>(row * model.width + column);
      const double x = rays.x[ray], y = rays.y[ray], r2 = x * x + y * y;
      const double radial = 1.0 + k1 * r2 + k2 * r2 * r2 + k3 * r2 * r2 * r2;
      const double u = model.fx * (x * radial + 2.0 * p1 * x * y + p2 * (r2 + 2.0 * x * x)) + model.cx;
      const double v = model.fy * (y * radial + p1 * (r2 + 2.0 * y * y) + 2.0 * p2 * x * y) + model.cy;
      ASSERT_NEAR(u, column, 60.0 * (1e-9 + 0x1p-23));
      ASSERT_NEAR(v, row, 60.0 * (1e-9 + 0x1p-23));
      moved = std::max(moved, std::abs(model.fx * x + model.cx - column));
    }
  }
  EXPECT_GT(moved, 1.0) << "or the distortion was not looked at";
}

bool refused(const CameraModel& model, const std::string& key, const std::string& text) {
  std::vector<Problem> problems;
  cameraRays(model, problems);
  return problems.size() == 1 && problems[0].key == key && problems[0].text.find(text) != std::string::npos;
}

TEST(Rays, ABadCameraIsRefusedInWords) {
  CameraModel model = camera();
  model.fx = 0.0;
  EXPECT_TRUE(refused(model, "fx", "must be a number in [0.001, 1000000], is 0"));
  model = camera();
  model.height = 0;
  EXPECT_TRUE(refused(model, "height", "must be a number in [1, 8192], is 0"));
  model = camera();
  model.width = model.height = 8192;
  EXPECT_TRUE(refused(model, "width", "times height must be at most 4194304"));
  model = camera();
  model.cy = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(refused(model, "cy", "must be a number"));
  model = camera();
  model.distortion[0] = -3.0;  // folds over at a third of the image
  EXPECT_TRUE(refused(model, "distortion", "has no inverse at the pixel 0, 0"));
}

TEST(Rays, OfALidarGoRound) {
  LidarParams lidar;
  lidar.rings = 3;
  lidar.columns = 4;
  lidar.lowest = -0.5;
  lidar.highest = 0.1;
  const RayGrid rays = lidarRays(lidar);
  ASSERT_EQ(rays.size(), 12U);
  const auto ray = [&](std::size_t n) { return Vec3(rays.x[n], rays.y[n], rays.z[n]); };
  for (std::size_t n = 0; n < 12; ++n) EXPECT_NEAR(ray(n).norm(), 1.0, 1e-7);
  EXPECT_NEAR(ray(2).x(), std::cos(0.1), 1e-7) << "the third of the highest ring is ahead";
  EXPECT_NEAR(ray(2).z(), std::sin(0.1), 1e-7);
  EXPECT_NEAR(ray(7).y(), std::cos(-0.2), 1e-7) << "the next one to the left";
  EXPECT_NEAR(ray(8).z(), std::sin(-0.5), 1e-7);
}

}  // namespace
}  // namespace curtain
