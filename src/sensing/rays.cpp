// SPDX-License-Identifier: BSD-3-Clause
#include "sensing/rays.h"

#include <Eigen/Dense>
#include <cmath>
#include <optional>
#include <string>
#include <tuple>

#include "scene/pi.h"
#include "scene/ranges.h"

namespace curtain {
namespace {

using Vec2 = Eigen::Vector2d;

// x' = x (1 + k1 r^2 + k2 r^4 + k3 r^6) + 2 p1 x y + p2 (r^2 + 2 x^2), y' with p1 and p2 the other way round: Brown,
// Close-Range Camera Calibration, 1971. Also how it changes with the point.
Vec2 distort(const std::array<double, 5>& d, const Vec2& p, Eigen::Matrix2d& slope) {
  const auto& [k1, k2, p1, p2, k3] = d;
  const double x = p.x(), y = p.y(), r2 = p.squaredNorm();
  const double radial = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3));
  const double growth = 2.0 * (k1 + r2 * (2.0 * k2 + r2 * 3.0 * k3));  // d radial / d(r^2), times 2
  const double across = x * y * growth + 2.0 * p1 * x + 2.0 * p2 * y;
  slope << radial + x * x * growth + 2.0 * p1 * y + 6.0 * p2 * x, across, across,
      radial + y * y * growth + 6.0 * p1 * y + 2.0 * p2 * x;
  return {x * radial + 2.0 * p1 * x * y + p2 * (r2 + 2.0 * x * x),
          y * radial + p1 * (r2 + 2.0 * y * y) + 2.0 * p2 * x * y};
}

// The point that is distorted to this one, by Newton's method. None where the distortion folds the image over.
std::optional<Vec2> undistort(const std::array<double, 5>& distortion, const Vec2& wanted) {
  constexpr int kMaxSteps = 50;
  constexpr double kExact = 1e-9;  // a millionth of a pixel of the usual focal lengths
  Vec2 point = wanted;
  Eigen::Matrix2d slope;
  for (int step = 0; step < kMaxSteps; ++step) {
    const Vec2 error = distort(distortion, point, slope) - wanted;
    if (!(slope.determinant() > 0.0 && slope.trace() > 0.0)) return std::nullopt;
    if (error.norm() < kExact) return point;
    point -= slope.inverse() * error;
  }
  return std::nullopt;
}

void append(const Vec3& direction, RayGrid& rays) {
  rays.x.push_back(static_cast<float>(direction.x()));
  rays.y.push_back(static_cast<float>(direction.y()));
  rays.z.push_back(static_cast<float>(direction.z()));
}

}  // namespace

std::vector<Problem> checkCamera(const CameraModel& camera) {
  std::vector<Problem> problems;
  const auto require = [&](const char* key, double value, const Range& range) {
    if (!range.contains(value)) problems.push_back({key, "must be " + range.text() + ", is " + formatNumber(value)});
  };
  require("width", camera.width, between(1, 8192));
  require("height", camera.height, between(1, 8192));
  if (problems.empty() && camera.width * camera.height > kMaxRays) {
    problems.push_back({"width", "times height must be at most " + std::to_string(kMaxRays) + ", is " +
                                     std::to_string(camera.width * camera.height)});
  }
  require("fx", camera.fx, between(1e-3, 1e6));
  require("fy", camera.fy, between(1e-3, 1e6));
  require("cx", camera.cx, between(-1e6, 1e6));
  require("cy", camera.cy, between(-1e6, 1e6));
  for (const double number : camera.distortion) require("distortion", number, between(-1e3, 1e3));
  return problems;
}

bool operator==(const CameraModel& a, const CameraModel& b) {
  const auto all = [](const CameraModel& m) {
    return std::tie(m.width, m.height, m.fx, m.fy, m.cx, m.cy, m.distortion);
  };
  return all(a) == all(b);
}

CameraModel cameraModel(const CameraParams& params) {
  CameraModel camera;
  camera.width = params.width;
  camera.height = params.height;
  camera.fx = params.fx;
  camera.fy = params.fy.value_or(params.fx);
  camera.cx = params.cx.value_or(0.5 * (params.width - 1));
  camera.cy = params.cy.value_or(0.5 * (params.height - 1));
  for (std::size_t i = 0; i < params.distortion.size(); ++i) camera.distortion.at(i) = params.distortion[i];
  return camera;
}

RayGrid cameraRays(const CameraModel& camera, std::vector<Problem>& problems) {
  RayGrid rays;
  problems = checkCamera(camera);
  if (!problems.empty()) return rays;
  rays.width = camera.width;
  rays.height = camera.height;
  for (int row = 0; row < camera.height; ++row) {
    for (int column = 0; column < camera.width; ++column) {
      const Vec2 pixel((column - camera.cx) / camera.fx, (row - camera.cy) / camera.fy);
      const std::optional<Vec2> ideal = undistort(camera.distortion, pixel);
      if (!ideal) {
        problems.push_back({"distortion", "has no inverse at the pixel " + std::to_string(column) + ", " +
                                              std::to_string(row) + ": no ray goes there"});
        return rays;
      }
      append(ideal->homogeneous(), rays);
    }
  }
  return rays;
}

RayGrid lidarRays(const LidarParams& lidar) {
  RayGrid rays;
  rays.width = lidar.columns;
  rays.height = lidar.rings;
  for (int ring = 0; ring < lidar.rings; ++ring) {
    const double share = lidar.rings > 1 ? static_cast<double>(ring) / (lidar.rings - 1) : 0.5;
    const double up = lidar.highest + (lidar.lowest - lidar.highest) * share;
    for (int column = 0; column < lidar.columns; ++column) {
      const double round = 2.0 * kPi * column / lidar.columns - kPi;
      append({std::cos(up) * std::cos(round), std::cos(up) * std::sin(round), std::sin(up)}, rays);
    }
  }
  return rays;
}

}  // namespace curtain
