// SPDX-License-Identifier: BSD-3-Clause
//
// Cloth that is put where no cloth can be.
#include <cmath>

#include "stress/torture.h"

namespace curtain_test {
namespace {

using namespace curtain;

// The state is put once, and the torture is what comes of it.
template <typename Put>
Torture startWith(const Put& put) {
  Torture torture;
  torture.scene = tortureScene();
  torture.seconds = 1.0;
  torture.begin = [put](Simulator& simulator) {
    Random random(11);
    std::vector<Vec3> positions, velocities;
    simulator.copyPositions(positions);
    velocities.assign(positions.size(), Vec3::Zero());
    for (int i = 0; i < simulator.rows(); ++i) {
      for (int j = 0; j < simulator.columns(); ++j) {
        const auto n = static_cast<std::size_t>(i * simulator.columns() + j);
        if (!simulator.pinned({i, j})) put(i, j, random, positions[n], velocities[n]);
      }
    }
    simulator.setState(positions, velocities);
  };
  return torture;
}

Torture anywhere(double size, double speed) {
  Torture torture = startWith([=](int, int, Random& random, Vec3& position, Vec3& velocity) {
    position = random.inBox(size);
    velocity = random.inBox(speed);
  });
  torture.stretch_during = std::numeric_limits<double>::infinity();  // it starts with links that long
  torture.energy_gain = std::numeric_limits<double>::infinity();     // which are brought to their lengths by force
  return torture;
}

Torture inOnePlace() {
  Torture torture = startWith([](int, int, Random&, Vec3& position, Vec3&) { position = Vec3(0.5, 0.0, 1.5); });
  torture.stretch_during = std::numeric_limits<double>::infinity();
  torture.energy_gain = std::numeric_limits<double>::infinity();
  return torture;
}

// Every column's nodes where the pin is: rods of no length at all.
Torture atThePins() {
  Torture torture = startWith([](int, int j, Random&, Vec3& position, Vec3&) { position = Vec3(j / 9.0, 0.0, 2.0); });
  torture.stretch_during = std::numeric_limits<double>::infinity();
  torture.energy_gain = std::numeric_limits<double>::infinity();
  return torture;
}

// Exactly upright rods would stand for ever.
constexpr double kAside = 1e-3;  // [m]

// Rods down and up again by turns: all reversed, nodes of every second row in one place.
Torture folded() {
  return startWith([](int i, int j, Random&, Vec3& position, Vec3&) {
    position = Vec3(j / 9.0, kAside * (i % 3), 2.0 - (i % 2) / 11.0);
  });
}

// Upwards from the pins, upside down: as unstable as can be.
Torture onItsHead() {
  return startWith(
      [](int i, int j, Random&, Vec3& position, Vec3&) { position = Vec3(j / 9.0, kAside * i, 2.0 + i / 11.0); });
}

Torture inOneHalf() {
  return startWith([](int i, int j, Random&, Vec3& position, Vec3&) {
    const int down = i <= 6 ? i : 12 - i;  // the lower half folded up behind the upper one
    position = Vec3(j / 9.0, i <= 6 ? 0.0 : 1e-6, 2.0 - down / 11.0);
  });
}

Torture tooFast(double speed) {
  return startWith([=](int, int, Random& random, Vec3&, Vec3& velocity) { velocity = random.inBox(speed); });
}

Torture farAway(double far) {
  Torture torture;
  torture.scene = tortureScene();
  torture.scene.hang.tilt = 0.8;
  torture.scene.hang.from.x() += far;
  torture.scene.hang.to.x() += far;
  torture.scene.hang.from.y() -= far;
  torture.scene.hang.to.y() -= far;
  return torture;
}

Torture seed(std::uint64_t number) {
  Random random(number);
  Torture torture;
  const int rows = 2 + static_cast<int>(random.between(0.0, 14.0));
  const int columns = 3 + static_cast<int>(random.between(0.0, 14.0));
  torture.scene = tortureScene(rows, columns);
  torture.scene.cloth.closed = random.between(0.0, 1.0) < 0.3;
  torture.scene.cloth.height = random.between(0.2, 3.0);
  torture.scene.cloth.width = random.between(0.2, 3.0);
  if (torture.scene.cloth.closed) {
    torture.scene.hang.from = Vec3(0.0, 0.0, 2.0);
  } else {
    torture.scene.hang.to =
        torture.scene.hang.from + torture.scene.cloth.width * random.between(0.3, 0.98) * Vec3::UnitX();
  }
  torture.scene.hang.tilt = torture.scene.cloth.closed ? 0.0 : random.between(-2.0, 2.0);
  const PinKind kinds[] = {PinKind::kTop, PinKind::kTopCorners, PinKind::kLeft};
  torture.scene.pins.kind =
      torture.scene.cloth.closed ? PinKind::kTop : kinds[static_cast<int>(random.between(0.0, 3.0))];
  torture.torment = [](Simulator& simulator, int frame, Random& any) {
    if (frame % 30 != 0) return;
    WindParams wind;
    wind.id = "any";
    wind.direction = any.direction();
    wind.position = Vec3(0.0, 0.0, 1.5) - 2.0 * wind.direction;
    wind.radius = any.between(0.2, 2.0);
    wind.pressure = any.between(0.0, 50.0);
    wind.unsteadiness = any.between(0.0, 10.0);
    simulator.setWind(wind);
  };
  torture.end = [](Simulator& simulator) { simulator.clearWinds(); };
  return torture;
}

}  // namespace

void addStartTortures(std::vector<TortureCase>& cases) {
  cases.push_back({"nodes within 1 m", "anywhere, and 1 m/s fast", [] { return anywhere(1.0, 1.0); }});
  cases.push_back({"nodes within 1 km", "anywhere, and 1 km/s fast", [] { return anywhere(1e3, 1e3); }});
  cases.push_back({"nodes within 1e6 km", "anywhere, and 1e6 km/s fast", [] { return anywhere(1e9, 1e9); }});
  cases.push_back({"nodes in one place", "all but the pins", inOnePlace});
  cases.push_back({"rods of no length", "every column at its pin", atThePins});
  cases.push_back({"rods reversed", "down and up by turns", folded});
  cases.push_back({"folded in half", "the lower half up behind the upper one", inOneHalf});
  cases.push_back({"on its head", "straight up from the pins", onItsHead});
  cases.push_back({"100 m/s", "every node into another direction", [] { return tooFast(100.0); }});
  cases.push_back({"1e6 m/s", "every node into another direction", [] { return tooFast(1e6); }});
  cases.push_back({"1000 km away", "from the origin", [] { return farAway(1e6); }});
  for (std::uint64_t number = 1; number <= 20; ++number) {
    cases.push_back({"seed " + std::to_string(number), "cloth, pins and winds at random", [=] { return seed(number); },
                     number <= 5, number <= 5});
  }
}

}  // namespace curtain_test
