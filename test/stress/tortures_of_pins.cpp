// SPDX-License-Identifier: BSD-3-Clause
//
// Pins that go where no hand would take them.
#include <algorithm>
#include <cmath>

#include "stress/torture.h"

namespace curtain_test {
namespace {

using namespace curtain;

Vec3 placeOfPin(const Scene& scene, int column) {
  const double share = static_cast<double>(column) / (scene.cloth.columns - 1);
  return scene.hang.from + share * (scene.hang.to - scene.hang.from);
}

// Moves all pins of the top row: place(column, its place at the start).
template <typename Place>
void movePins(Simulator& simulator, const Place& place) {
  for (int j = 0; j < simulator.columns(); ++j) {
    if (simulator.pinned({0, j})) simulator.movePin({0, j}, place(j, placeOfPin(simulator.scene(), j)));
  }
}

void bringHome(Simulator& simulator) {
  movePins(simulator, [](int, const Vec3& home) { return home; });
}

Torture jump(double way) {
  Torture torture;
  torture.scene = tortureScene();
  torture.torment = [=](Simulator& simulator, int frame, Random& random) {
    if (frame % 20 != 0) return;
    const Vec3 jump = way * random.direction();
    movePins(simulator, [&](int, const Vec3& home) { return home + jump; });
  };
  torture.end = bringHome;
  return torture;
}

// About the vertical through the middle, all pins as one rail.
Torture spin(double per_second) {
  Torture torture;
  torture.scene = tortureScene();
  const double rate = std::max(60.0, 12.0 * per_second);  // pins go straight from frame to frame: by 30 degrees at most
  torture.scene.solver.frame_rate = rate;
  torture.torment = [=](Simulator& simulator, int frame, Random&) {
    const double angle = 2.0 * kPi * per_second * (frame + 1) / rate;
    movePins(simulator, [&](int, const Vec3& home) {
      const double arm = home.x() - 0.5;
      return Vec3(0.5 + arm * std::cos(angle), arm * std::sin(angle), home.z());
    });
  };
  torture.end = bringHome;
  return torture;
}

Torture vibrate(double way) {
  Torture torture;
  torture.scene = tortureScene();
  torture.torment = [=](Simulator& simulator, int frame, Random&) {
    movePins(simulator,
             [&](int, const Vec3& home) { return Vec3(home + Vec3(0.0, way, way) * (frame % 2 == 0 ? 1.0 : -1.0)); });
  };
  torture.end = bringHome;
  return torture;
}

Torture everyPinForItself() {
  Torture torture;
  torture.scene = tortureScene();
  torture.torment = [](Simulator& simulator, int, Random& random) {
    movePins(simulator, [&](int, const Vec3& home) { return Vec3(home + random.inBox(0.05)); });
  };
  torture.end = bringHome;
  torture.stretch_during = 0.05 * 2.0 * std::sqrt(3.0) * 9.0;  // of links between pins, which nothing can help
  torture.energy_gain = std::numeric_limits<double>::infinity();
  return torture;
}

// Further apart than the cloth is wide: links must be longer by so much.
Torture pullApart(double share) {
  Torture torture;
  torture.scene = tortureScene();
  torture.scene.pins.kind = PinKind::kTopCorners;
  torture.scene.hang.to.x() = 0.9;
  torture.torment = [=](Simulator& simulator, int frame, Random&) {
    const double width = frame < 60 ? 0.9 + (share - 0.9) * (frame + 1) / 60.0 : share;
    simulator.movePin({0, 9}, Vec3(width, 0.0, 2.0));
  };
  torture.end = [](Simulator& simulator) { simulator.movePin({0, 9}, Vec3(0.9, 0.0, 2.0)); };
  return torture;
}

Torture pulledApart(double share) {
  Torture torture = pullApart(share);
  torture.stretch_during = 2.0 * (share - 1.0);
  torture.energy_gain = std::numeric_limits<double>::infinity();  // links that can't hold pull by no known force
  return torture;
}

Torture straightRow(int rows, int columns, double share) {
  Torture torture;
  torture.scene = tortureScene(rows, columns);
  torture.scene.pins.kind = PinKind::kTopCorners;
  torture.scene.hang.to.x() = share;
  torture.recovers = false;
  torture.energy_gain = slackGain(1e-3);
  return torture;
}

// What makes other code of it: something else to look for, pins that go by a nanometre.
Torture straightRowThatTouchesItself() {
  Torture torture = straightRow(12, 10, 1.0);
  torture.scene.contact.self = true;
  return torture;
}

Torture straightRowOfTremblingPins(double way) {
  Torture torture = straightRow(12, 10, 1.0);
  torture.torment = [=](Simulator& simulator, int frame, Random&) {
    movePins(simulator,
             [&](int, const Vec3& home) { return Vec3(home + Vec3(0.0, frame % 2 == 0 ? way : -way, 0.0)); });
  };
  return torture;
}

Torture drawnStraight() {
  Torture torture = straightRow(12, 10, 0.99);
  torture.torment = [](Simulator& simulator, int frame, Random&) {
    const double width = std::min(1.0, 0.99 + 0.01 * frame / 60.0) + (frame % 2 == 0 ? 1e-6 : -1e-6);
    simulator.movePin({0, 9}, Vec3(width, 0.0, 2.0));
  };
  torture.kinetic = torture.energy_gain;
  torture.energy_gain = std::numeric_limits<double>::infinity();
  return torture;
}

Torture allPinned() {
  Torture torture;
  torture.scene = tortureScene(4, 4);
  torture.scene.pins.kind = PinKind::kList;
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) torture.scene.pins.nodes.push_back({i, j});
  }
  return torture;
}

Torture notPinned() {
  Torture torture;
  torture.scene = tortureScene();
  torture.scene.pins.kind = PinKind::kNone;
  torture.scene.hang.tilt = 1.0;
  torture.scene.hang.to.x() = 0.8;
  torture.recovers = false;
  return torture;
}

}  // namespace

void addPinTortures(std::vector<TortureCase>& cases) {
  cases.push_back(
      {"pins jump by 1 m", "all together, three times a second, each within a frame", [] { return jump(1.0); }});
  cases.push_back({"pins jump by 100 m", "", [] { return jump(100.0); }});
  cases.push_back({"rail at 1 rev/s", "about its middle", [] { return spin(1.0); }});
  cases.push_back({"rail at 50 rev/s", "ends at 157 m/s", [] { return spin(50.0); }});
  cases.push_back({"pins vibrate", "by 5 cm, to and fro every frame", [] { return vibrate(0.05); }});
  cases.push_back({"every pin for itself", "by up to 5 cm from its place, every frame", everyPinForItself});
  cases.push_back(
      {"pulled apart by 1 %", "corners further apart than the cloth is wide", [] { return pulledApart(1.01); }});
  cases.push_back({"pulled apart by half", "", [] { return pulledApart(1.5); }});
  cases.push_back({"straight row", "corners exactly as far apart as the cloth is wide, 12 x 10",
                   [] { return straightRow(12, 10, 1.0); }});
  cases.push_back({"straight row of 5 x 5", "", [] { return straightRow(5, 5, 1.0); }});
  cases.push_back({"nearly straight row", "0.9999 of the width", [] { return straightRow(12, 10, 0.9999); }});
  cases.push_back({"straight row and self-contact", "nothing touches", straightRowThatTouchesItself});
  cases.push_back({"straight row of trembling pins", "by 1e-9 m", [] { return straightRowOfTremblingPins(1e-9); }});
  cases.push_back({"straight row of shaking pins", "by 1e-5 m", [] { return straightRowOfTremblingPins(1e-5); }});
  cases.push_back({"drawn straight", "at 1 cm/s, and on by 1e-6 m", drawnStraight});
  cases.push_back({"all pinned", "nothing can move", allPinned});
  cases.push_back({"nothing pinned", "free fall in air", notPinned});
}

}  // namespace curtain_test
