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
  torture.torment = [](Simulator& simulator, int frame, Random&) { simulator.setFrameRate(frame % 2 == 0 ? 5.0 : 1000.0); };
  return torture;
}

Torture forAMillionFrames() {
  Torture torture = inBreeze();
  torture.seconds = 1e6 / 60.0;
  return torture;
}

}  // namespace

void addStepTortures(std::vector<TortureCase>& cases) {
  cases.push_back({"frames of 1/1000 s", "swinging in a gusty wind, 1000 frames a second", [] { return atRate(1000.0); }});
  cases.push_back({"frames of 1/5 s", "the same, 5 frames a second", [] { return atRate(5.0); }});
  cases.push_back({"frames of 1 s", "the same, a frame a second", [] { return atRate(1.0); }});
  cases.push_back({"frames of any length", "1/1000 to 1/5 s, another one every frame", atAnyRate});
  cases.push_back({"frames of two lengths", "1/5 and 1/1000 s by turns", atTwoRates});
  cases.push_back({"a million frames", "4.6 simulated hours of gusts", forAMillionFrames, false, false});
}

}  // namespace curtain_test
