// SPDX-License-Identifier: BSD-3-Clause
//
// Frames of any length, and many of them.
#include <cmath>

#include "stress/torture.h"

namespace curtain_test {
namespace {

using namespace curtain;

// A gusty wind onto the middle, so that something goes on.
void addBreeze(Scene& scene) {
  WindParams wind;
  wind.id = "breeze";
  wind.position = Vec3(0.5, -1.0, 1.3);
  wind.direction = Vec3::UnitY();
  wind.radius = 1.0;
  wind.half_angle = 0.2;
  wind.pressure = 3.0;
  wind.unsteadiness = 2.0;
  scene.wind.push_back(wind);
}

Torture inBreeze() {
  Torture torture;
  torture.scene = tortureScene();
  torture.scene.hang.tilt = 0.8;
  addBreeze(torture.scene);
  torture.end = [](Simulator& simulator) { simulator.clearWinds(); };
  return torture;
}

Torture atRate(double rate) {
  Torture torture = inBreeze();
  torture.scene.solver.frame_rate = rate;
  return torture;
}

Torture atAnyRate() {
  Torture torture = inBreeze();
  torture.seconds = 10.0;
  torture.torment = [](Simulator& simulator, int, Random& random) {
    simulator.setFrameRate(std::exp(random.between(std::log(5.0), std::log(1000.0))));
  };
  torture.end = [](Simulator& simulator) {
    simulator.clearWinds();
    simulator.setFrameRate(60.0);
  };
  return torture;
}

Torture atTwoRates() {
  Torture torture = atAnyRate();
  torture.torment = [](Simulator& simulator, int frame, Random&) {
    simulator.setFrameRate(frame % 2 == 0 ? 5.0 : 1000.0);
  };
  return torture;
}

// With all that looks at the frame's length: moving pins, a ball on its way, cloth on cloth.
Torture gatheredAtAnyRate() {
  Torture torture = atAnyRate();
  torture.seconds = 4.0;
  torture.scene.contact.self = true;
  torture.scene.hang.to.x() = 0.6;
  ObstacleParams ball;
  ball.name = "ball";
  ball.radius = 0.15;
  torture.scene.obstacles.push_back(ball);
  const auto rates = torture.torment;
  torture.torment = [rates](Simulator& simulator, int frame, Random& random) {
    rates(simulator, frame, random);
    const double time = simulator.time();
    Pose pose;
    pose.position = Vec3(0.3, 0.6 * std::cos(4.0 * time), 1.4);
    simulator.setObstaclePose(0, pose, frame == 0);
    const double width = 0.6 + 0.1 * std::sin(3.0 * time);
    for (int j = 0; j < simulator.columns(); ++j)
      simulator.movePin({0, j}, Vec3(width * j / (simulator.columns() - 1), 0.0, 2.0));
  };
  torture.end = [end = torture.end](Simulator& simulator) {
    end(simulator);
    simulator.setObstaclePresent(0, false);
  };
  torture.recovers = false;       // gathered cloth lies in folds of any kind
  torture.stretch_during = 1e-2;  // as in tortures_of_contact.cpp
  return torture;
}

Torture forAMillionFrames() {
  Torture torture = inBreeze();
  torture.seconds = 1e6 / 60.0;
  return torture;
}

}  // namespace

void addStepTortures(std::vector<TortureCase>& cases) {
  cases.push_back(
      {"frames of 1/1000 s", "swinging in a gusty wind, 1000 frames a second", [] { return atRate(1000.0); }});
  cases.push_back({"frames of 1/5 s", "the same, 5 frames a second", [] { return atRate(5.0); }});
  cases.push_back({"frames of 1 s", "the same, a frame a second", [] { return atRate(1.0); }});
  cases.push_back({"frames of any length", "1/1000 to 1/5 s, another one every frame", atAnyRate});
  cases.push_back({"frames of two lengths", "1/5 and 1/1000 s by turns", atTwoRates});
  cases.push_back(
      {"frames of any length and contact", "gathered, its rail moves, a ball swings through it", gatheredAtAnyRate});
  cases.push_back({"a million frames", "4.6 simulated hours of gusts", forAMillionFrames, false, false});
}

}  // namespace curtain_test
