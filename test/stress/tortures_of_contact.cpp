// SPDX-License-Identifier: BSD-3-Clause
//
// Obstacles and the cloth itself.
#include <algorithm>
#include <cmath>

#include "stress/torture.h"

namespace curtain_test {
namespace {

using namespace curtain;

Pose poseOf(const Vec3& position, double angle = 0.0, const Vec3& axis = Vec3::UnitZ()) {
  Pose pose;
  pose.position = position;
  pose.orientation = Eigen::Quaterniond(Eigen::AngleAxisd(angle, axis));
  return pose;
}

Torture withObstacle(ShapeKind shape, bool self) {
  Torture torture;
  torture.scene = tortureScene();
  torture.scene.contact.self = self;
  ObstacleParams obstacle;
  obstacle.name = "it";
  obstacle.shape = shape;
  obstacle.radius = 0.2;
  obstacle.length = 0.4;
  obstacle.size = Vec3(0.6, 0.1, 0.3);
  obstacle.pose = poseOf(Vec3(0.5, -1.0, 1.4));
  torture.scene.obstacles.push_back(obstacle);
  torture.end = [](Simulator& simulator) { simulator.setObstaclePresent(0, false); };
  // What is jammed between an obstacle and its pins gives by its links.
  torture.stretch_during = 1e-2;
  return torture;
}

Torture ballThrough(double speed, bool self) {
  Torture torture = withObstacle(ShapeKind::kSphere, self);
  torture.torment = [=](Simulator& simulator, int frame, Random&) {
    simulator.setObstaclePose(
        0, poseOf(Vec3(0.5, std::remainder(-1.0 + speed * (frame + 1) / 60.0, 2.0), 1.4)),
        std::remainder(-1.0 + speed * (frame + 1) / 60.0, 2.0) < std::remainder(-1.0 + speed * frame / 60.0, 2.0));
  };
  return torture;
}

Torture spinningBar(double per_second) {
  Torture torture = withObstacle(ShapeKind::kBox, false);
  // Poses more than half a turn apart would mean the shorter way round.
  const double rate = std::max(60.0, 6.0 * per_second);
  torture.scene.solver.frame_rate = rate;
  const auto turned = [](double turns) { return poseOf(Vec3(0.5, 0.12, 1.4), 2.0 * kPi * turns, Vec3::UnitX()); };
  torture.begin = [=](Simulator& simulator) { simulator.setObstaclePose(0, turned(0.0), true); };  // clear of the cloth
  torture.torment = [=](Simulator& simulator, int frame, Random&) {
    simulator.setObstaclePose(0, turned(per_second * (frame + 1) / rate), false);
  };
  return torture;
}

Torture straightRowBeside() {
  Torture torture = withObstacle(ShapeKind::kSphere, false);
  torture.scene.pins.kind = PinKind::kTopCorners;
  torture.scene.hang.to.x() = 1.0;
  torture.scene.obstacles[0].pose = poseOf(Vec3(0.5, 0.21, 1.6));
  torture.recovers = false;
  torture.stretch_during = 2e-3;
  torture.energy_gain = slackGain(1e-3);  // see straightRow
  return torture;
}

Torture teleports(ShapeKind shape, bool self) {
  Torture torture = withObstacle(shape, self);
  torture.torment = [](Simulator& simulator, int frame, Random& random) {
    if (frame % 5 != 0) return;
    simulator.setObstaclePose(
        0, poseOf(Vec3(0.5, 0.0, 1.5) + random.inBox(0.5), random.between(0.0, 6.0), random.direction()), true);
  };
  torture.stretch_during = std::numeric_limits<double>::infinity();  // it appears in the cloth
  torture.energy_gain = std::numeric_limits<double>::infinity();
  torture.recovers = !self;  // it may be left in a tangle that its friction holds
  return torture;
}

Torture crumple() {
  Torture torture;
  torture.scene = tortureScene(16, 16);
  torture.scene.contact.self = true;
  torture.torment = [](Simulator& simulator, int frame, Random& random) {
    const double share = 0.5 + 0.4 * std::cos(0.2 * frame);
    for (int j = 0; j < simulator.columns(); ++j) {
      simulator.movePin({0, j}, Vec3(0.5 + share * (j / 15.0 - 0.5), 0.0, 2.0));
    }
    WindParams wind;
    wind.id = "any";
    wind.direction = random.direction();
    wind.position = Vec3(0.5, 0.0, 1.5) - wind.direction;
    wind.radius = 1.0;
    wind.pressure = 20.0;
    if (frame % 10 == 0) simulator.setWind(wind);
  };
  torture.end = [](Simulator& simulator) {
    simulator.clearWinds();
    for (int j = 0; j < simulator.columns(); ++j) simulator.movePin({0, j}, Vec3(j / 15.0, 0.0, 2.0));
  };
  return torture;
}

Torture freeFallOnto(ShapeKind shape) {
  Torture torture = withObstacle(shape, true);
  torture.scene.pins.kind = PinKind::kNone;
  torture.scene.obstacles[0].pose = poseOf(Vec3(0.5, 0.0, 0.5));
  if (shape == ShapeKind::kPlane) torture.scene.obstacles[0].pose = poseOf(Vec3::Zero());
  torture.recovers = false;
  return torture;
}

}  // namespace

void addContactTortures(std::vector<TortureCase>& cases) {
  cases.push_back({"ball at 5 m/s", "through the cloth, again and again", [] { return ballThrough(5.0, false); }});
  cases.push_back({"ball at 100 m/s", "", [] { return ballThrough(100.0, false); }});
  cases.push_back({"ball at 5 m/s with self-contact", "", [] { return ballThrough(5.0, true); }});
  cases.push_back({"bar at 1 rev/s", "beside the cloth, into it", [] { return spinningBar(1.0); }});
  cases.push_back({"bar at 50 rev/s", "", [] { return spinningBar(50.0); }});
  cases.push_back({"straight row by a ball", "1 cm off its plane", straightRowBeside});
  cases.push_back(
      {"ball that appears", "anywhere, every fifth frame", [] { return teleports(ShapeKind::kSphere, false); }});
  cases.push_back({"box that appears", "anywhere, every fifth frame, self-contact",
                   [] { return teleports(ShapeKind::kBox, true); }});
  cases.push_back({"crumpled", "rail gathered and spread, winds from everywhere, self-contact", crumple});
  cases.push_back({"dropped on a box", "self-contact", [] { return freeFallOnto(ShapeKind::kBox); }});
  cases.push_back({"dropped on a plane", "self-contact", [] { return freeFallOnto(ShapeKind::kPlane); }});
}

}  // namespace curtain_test
