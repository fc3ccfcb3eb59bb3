// SPDX-License-Identifier: BSD-3-Clause
#include "bench/contact_scenes.h"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <stdexcept>

namespace curtain_bench {
namespace {

using curtain::ObstacleParams;
using curtain::Scene;
using curtain::Vec3;

// Into the folder for temporary files.
std::string writeBall(const std::string& name, bool bumpy) {
  const std::string path = std::filesystem::temp_directory_path() / name;
  constexpr int kRings = 157, kSegments = 160;
  const double pi = std::acos(-1.0);
  std::ofstream file(path);
  const auto corner = [&](double latitude, double longitude) {
    const double bump =
        bumpy ? 0.03 * std::sin(24.0 * longitude) * std::sin(24.0 * latitude) * std::cos(latitude) : 0.0;
    const double radius = 0.4 * (1.0 + bump);
    file << "v " << radius * std::cos(latitude) * std::cos(longitude) << ' '
         << radius * std::cos(latitude) * std::sin(longitude) << ' ' << radius * std::sin(latitude) << '\n';
  };
  file.precision(17);
  corner(-0.5 * pi, 0.0);
  for (int r = 1; r < kRings; ++r) {
    for (int s = 0; s < kSegments; ++s) corner(pi * (static_cast<double>(r) / kRings - 0.5), 2.0 * pi * s / kSegments);
  }
  corner(0.5 * pi, 0.0);
  const auto at = [](int ring, int s) { return 2 + (ring - 1) * kSegments + s % kSegments; };
  const int top = 2 + (kRings - 1) * kSegments;
  for (int s = 0; s < kSegments; ++s) {
    file << "f 1 " << at(1, s + 1) << ' ' << at(1, s) << '\n';
    for (int r = 1; r + 1 < kRings; ++r) {
      file << "f " << at(r, s) << ' ' << at(r, s + 1) << ' ' << at(r + 1, s + 1) << '\n';
      file << "f " << at(r, s) << ' ' << at(r + 1, s + 1) << ' ' << at(r + 1, s) << '\n';
    }
    file << "f " << at(kRings - 1, s) << ' ' << at(kRings - 1, s + 1) << ' ' << top << '\n';
  }
  if (!file.flush()) throw std::runtime_error("cannot write " + path);
  return path;
}

ObstacleParams shotAt(ObstacleParams obstacle, double speed) {
  curtain::PoseKey from, to;
  from.pose.position = {0.5, -0.5, 1.1};
  to.time = 1.0 / speed;
  to.pose.position = {0.5, 0.5, 1.1};
  obstacle.pose = from.pose;
  obstacle.motion = {from, to};
  return obstacle;
}

}  // namespace

Scene curtainOf(int rows, int columns, double gathered, double tilt) {
  Scene scene;
  scene.cloth.rows = rows;
  scene.cloth.columns = columns;
  scene.hang.from = {0.0, 0.0, 2.1};
  scene.hang.to = {gathered, 0.0, 2.1};
  scene.hang.tilt = tilt;
  scene.solver.threads = 1;
  scene.solver.rest_speed = 0.0;  // without contact some would sleep
  return scene;
}

Scene with(Scene scene, const ObstacleParams& obstacle) {
  scene.obstacles.push_back(obstacle);
  return scene;
}

Scene touchingItself(Scene scene) {
  scene.contact.self = true;
  return scene;
}

Scene dampedBy(Scene scene, double air) {
  scene.air.inside = scene.air.border = scene.air.corner = air;
  return scene;
}

Scene blown(Scene scene) {
  curtain::WindParams fan;
  fan.id = "fan";
  fan.position = {0.3, -1.5, 1.2};
  fan.direction = Vec3::UnitY();
  fan.radius = 1.5;
  fan.half_angle = 0.2;
  fan.pressure = 6.0;
  fan.unsteadiness = 4.0;
  scene.wind.push_back(fan);
  return dampedBy(scene, 0.2);
}

Scene inSteadyWind(Scene scene) {
  curtain::WindParams wind;
  wind.id = "wind";
  wind.position = {0.3, -5.0, 1.2};
  wind.direction = Vec3::UnitY();
  wind.radius = 100.0;
  wind.pressure = 6.0;
  scene.wind.push_back(wind);
  return dampedBy(scene, 0.2);
}

ObstacleParams ballAt(const Vec3& position, double radius) {
  ObstacleParams ball;
  ball.name = "ball";
  ball.radius = radius;
  ball.pose.position = position;
  return ball;
}

ObstacleParams ballThatComes() {
  ObstacleParams ball = ballAt({0.5, -0.5, 1.1});
  curtain::PoseKey from, to;
  from.pose = ball.pose;
  to.time = 1.0;
  to.pose.position = {0.5, -0.1, 1.1};
  ball.motion = {from, to};
  return ball;
}

ObstacleParams swingingBall() {
  ObstacleParams ball = ballAt({0.3, 0.6, 1.2}, 0.15);
  for (int k = 0; k <= 40; ++k) {
    curtain::PoseKey key;
    key.time = k;
    key.pose.position = {0.3, k % 2 == 0 ? 0.6 : -0.2, 1.2};
    ball.motion.push_back(key);
  }
  return ball;
}

ObstacleParams ballShotAt(double speed) { return shotAt(ballAt({0.5, -0.5, 1.1}, 0.15), speed); }

ObstacleParams plateShotAt(double speed) {
  ObstacleParams plate;
  plate.name = "plate";
  plate.shape = curtain::ShapeKind::kBox;
  plate.size = {0.3, 0.3, 0.002};
  return shotAt(plate, speed);
}

Scene falling(int rows, int columns) {
  Scene scene = dampedBy(curtainOf(rows, columns, 1.0, 0.0), 0.3);
  scene.pins.kind = curtain::PinKind::kNone;
  ObstacleParams floor;
  floor.name = "floor";
  floor.shape = curtain::ShapeKind::kPlane;
  return with(scene, floor);
}

Scene draped(int rows, int columns, bool bumpy) {
  Scene scene = dampedBy(curtainOf(rows, columns, 1.0, 0.5 * std::acos(-1.0)), 0.5);
  scene.cloth.height = 1.0;
  scene.hang.from = {-0.5, 0.5, 0.45};
  scene.hang.to = {0.5, 0.5, 0.45};
  scene.pins.kind = curtain::PinKind::kNone;
  scene.solver.rest_speed = Scene().solver.rest_speed;
  ObstacleParams body;
  body.name = "body";
  body.shape = curtain::ShapeKind::kMesh;
  body.mesh = writeBall(bumpy ? "curtain_bench_bumpy.obj" : "curtain_bench_smooth.obj", bumpy);
  return with(scene, body);
}

}  // namespace curtain_bench
