// SPDX-License-Identifier: BSD-3-Clause
//
// Winds, drags, damping and gravity that jump.
#include <cmath>
#include <limits>

#include "stress/torture.h"

namespace curtain_test {
namespace {

using namespace curtain;

WindParams gale(double pressure) {
  WindParams wind;
  wind.id = "gale";
  wind.position = Vec3(0.5, -1.0, 1.5);
  wind.direction = Vec3(0.0, 1.0, 0.1);
  wind.radius = 2.0;
  wind.pressure = pressure;
  return wind;
}

Torture windOnAndOff(double pressure) {
  Torture torture;
  torture.scene = tortureScene();
  torture.torment = [=](Simulator& simulator, int frame, Random&) {
    simulator.setWind(gale(frame % 2 == 0 ? pressure : 0.0));
  };
  torture.end = [](Simulator& simulator) { simulator.clearWinds(); };
  return torture;
}

Torture windOfAnyPressure() {
  Torture torture = windOnAndOff(0.0);
  torture.torment = [](Simulator& simulator, int, Random& random) {
    WindParams wind = gale(std::pow(10.0, random.between(-2.0, 5.0)));
    wind.direction = random.direction();
    wind.position = Vec3(0.5, 0.0, 1.5) - wind.direction;
    wind.unsteadiness = wind.pressure * random.between(0.0, 1.0);
    simulator.setWind(wind);
  };
  return torture;
}

Torture jerk(double newton, bool once) {
  Torture torture;
  torture.scene = tortureScene();
  torture.torment = [=](Simulator& simulator, int frame, Random& random) {
    DragParams drag;
    drag.id = "hand";
    drag.node = NodeIndex{11, 4};
    drag.force = newton * (once ? Vec3(0.0, 1.0, 0.0) : random.direction());
    if (frame % 60 == 10 || (!once && frame % 7 == 0))
      simulator.setDrag(drag);
    else
      simulator.clearDrags();
  };
  torture.end = [](Simulator& simulator) { simulator.clearDrags(); };
  return torture;
}

Torture springFromAfar() {
  Torture torture;
  torture.scene = tortureScene();
  torture.torment = [](Simulator& simulator, int, Random& random) {
    DragParams drag;
    drag.id = "hand";
    drag.node = NodeIndex{11, 4};
    drag.target = random.inBox(100.0);
    drag.stiffness = 1e6;
    drag.max_force = 1e6;
    simulator.setDrag(drag);
  };
  torture.end = [](Simulator& simulator) { simulator.clearDrags(); };
  return torture;
}

Torture inAir(double coefficient) {
  Torture torture;
  // What the engine lets be (kTooMuch in keep_energy.cpp), and as much below the start again, where leapfrog's energy
  // wavers to.
  torture.energy_gain = 5e-2;
  torture.seconds = coefficient > 0.0 ? 3.0 : 60.0;
  torture.scene = tortureScene();
  torture.scene.hang.tilt = 1.2;
  torture.scene.hang.to.x() = 0.8;
  torture.scene.air.inside = torture.scene.air.border = torture.scene.air.corner = coefficient;
  torture.scene.air.fast_gain = coefficient > 0.0 ? 1.0 : 0.0;
  torture.recovers = coefficient > 0.0 && coefficient < 10.0;
  return torture;
}

Torture jerkInAir(double coefficient) {
  Torture torture = jerk(1e3, false);
  torture.scene.air.inside = torture.scene.air.border = torture.scene.air.corner = coefficient;
  return torture;
}

Torture airThatChanges() {
  Torture torture = inAir(1.0);
  torture.torment = [](Simulator& simulator, int, Random& random) {
    AirParams air = simulator.scene().air;
    air.inside = air.border = air.corner = std::pow(10.0, random.between(-3.0, 6.0));
    simulator.setAir(air);
  };
  torture.end = [](Simulator& simulator) {
    AirParams air = simulator.scene().air;
    air.inside = air.border = air.corner = 1.0;
    simulator.setAir(air);
  };
  return torture;
}

Torture gravityFlips(double strength, int frames) {
  Torture torture;
  torture.gravity_changes = true;
  torture.scene = tortureScene();
  torture.torment = [=](Simulator& simulator, int frame, Random& random) {
    if (frame % frames == 0)
      simulator.setGravity(strength * (random.between(0.0, 1.0) < 0.5
                                           ? random.direction()
                                           : Vec3(0.0, 0.0, (frame / frames) % 2 == 0 ? 1.0 : -1.0)));
  };
  torture.end = [](Simulator& simulator) { simulator.setGravity(Vec3(0.0, 0.0, -9.81)); };
  return torture;
}

constexpr double kTiny = 1e-310;

Torture denormals() {
  Torture torture;
  torture.scene = tortureScene();
  torture.scene.gravity = Vec3(kTiny, -kTiny, -kTiny);
  torture.begin = [](Simulator& simulator) {
    std::vector<Vec3> positions, velocities;
    simulator.copyPositions(positions);
    velocities.assign(positions.size(), Vec3(kTiny, kTiny, -kTiny));
    simulator.setState(positions, velocities);
  };
  torture.torment = [](Simulator& simulator, int, Random& random) {
    simulator.setWind(gale(kTiny));
    DragParams drag;
    drag.id = "hand";
    drag.node = NodeIndex{11, 4};
    drag.force = kTiny * random.direction();
    simulator.setDrag(drag);
  };
  torture.recovers = false;
  return torture;
}

// The same beside numbers of every day.
Torture denormalsInASwing() {
  Torture torture = denormals();
  torture.scene.gravity = Vec3(kTiny, -kTiny, -9.81);
  torture.scene.hang.tilt = 0.8;
  torture.end = [](Simulator& simulator) {
    simulator.clearWinds();
    simulator.clearDrags();
  };
  torture.recovers = true;
  return torture;
}

}  // namespace

void addForceTortures(std::vector<TortureCase>& cases) {
  cases.push_back({"wind 0 / 1 kPa", "on and off every frame", [] { return windOnAndOff(1e3); }});
  cases.push_back({"wind 0 / 100 kPa", "on and off every frame", [] { return windOnAndOff(1e5); }});
  cases.push_back({"wind of any pressure", "0.01 Pa to 100 kPa, another direction every frame", windOfAnyPressure});
  cases.push_back({"drag of 1 kN", "for a frame, once a second", [] { return jerk(1e3, true); }});
  cases.push_back({"drag of 1 MN", "for a frame, once a second", [] { return jerk(1e6, true); }});
  cases.push_back({"drags of 1 MN", "in any direction, every seventh frame", [] { return jerk(1e6, false); }});
  cases.push_back({"spring from afar", "1 MN/m, its target jumps by 100 m every frame", springFromAfar});
  cases.push_back({"no air", "a whip for a minute", [] { return inAir(0.0); }});
  cases.push_back({"air 1e3", "coefficient of Eq. (4), growing with the speed", [] { return inAir(1e3); }});
  cases.push_back({"air 1e6", "", [] { return inAir(1e6); }});
  cases.push_back({"drags of 1 kN in air 1e6", "in any direction, every seventh frame", [] { return jerkInAir(1e6); }});
  cases.push_back({"air that changes", "1e-3 to 1e6, every frame", airThatChanges});
  cases.push_back({"gravity flips", "every tenth frame, up, down or anywhere", [] { return gravityFlips(9.81, 10); }});
  cases.push_back({"gravity flips by 1000 g", "every frame", [] { return gravityFlips(9810.0, 1); }});
  cases.push_back({"denormal forces", "gravity, wind, drag and velocities of 1e-310", denormals});
  cases.push_back({"denormals in a swing", "the same beside weight", denormalsInASwing});
}

}  // namespace curtain_test
