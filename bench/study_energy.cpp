// SPDX-License-Identifier: BSD-3-Clause
//
// Energy of the undamped swing over a minute. Drift is (E(t) - E(0)) / (E(0) - E(rest)): E of motion, gravity and
// springs, E(rest) = -m g L / 2 of the cloth that hangs straight down; so 0 is none and -1 is all that can be lost.
#include <cmath>

#include "bench/chain.h"
#include "bench/line_up.h"
#include "bench/measure.h"
#include "bench/rivals/rivals.h"
#include "bench/studies.h"
#include "bench/table.h"
#include "curtain_sim/scene.h"

namespace curtain_bench {
namespace {

// Potential energy of the cloth straight down, zero at the support.
double restEnergy(const ClothStart& start) {
  double energy = 0.0;
  for (int i = 0; i < start.rows; ++i) {
    for (int j = 0; j < start.columns; ++j) {
      const auto n = static_cast<std::size_t>(i * start.columns + j);
      energy += start.mass[n] * start.gravity[2] * i * start.warp_rest;  // gravity is negative
    }
  }
  return energy;
}

// Rivals at settings of their fronts in the swing; 8 substeps where they are stable with it.
std::vector<Entry> entriesOfEnergy() {
  std::vector<Entry> entries;
  for (const std::string& method : curtain::methodNames()) entries.push_back(ourEntry(method, 8));
  const auto add = [&entries](const char* method, const char* setting, auto make) {
    entries.push_back({method, setting, make, true});
  };
  using curtain::Scene;
  add("symplectic Euler", "substeps 8; dt*omega 1.5; dashpot 0", [](const Scene&, const ClothStart& start) {
    return makeSymplecticEuler(start, {8, 1.5, 0.0});
  });
  add("symplectic Euler", "substeps 64; dt*omega 1.5; dashpot 0", [](const Scene&, const ClothStart& start) {
    return makeSymplecticEuler(start, {64, 1.5, 0.0});
  });
  add("Runge-Kutta 4", "substeps 64; dt*omega 1.8", [](const Scene&, const ClothStart& start) {
    return makeRungeKutta(start, {64, 1.8, 0.0});
  });
  add("Baraff-Witkin", "substeps 8; stiffness 1000 N/m; tolerance 0.0001", [](const Scene&, const ClothStart& start) {
    return makeBaraffWitkin(start, {8, 1e3, 1e-4, 400});
  });
  add("XPBD", "substeps 8; iterations 10; compliance 0 m/N", [](const Scene&, const ClothStart& start) {
    return makeXpbd(start, {8, 10, 0.0});
  });
  add("XPBD", "substeps 64; iterations 1; compliance 0 m/N", [](const Scene&, const ClothStart& start) {
    return makeXpbd(start, {64, 1, 0.0});
  });
  if (bulletInstalled()) {
    add("btSoftBody", "substeps 8; piterations 10; viterations 0", [](const Scene&, const ClothStart& start) {
      return makeBullet(start, {8, 10, 0});
    });
  }
  return entries;
}

}  // namespace

void studyEnergy(const Options& options) {
  curtain::Scene scene = chainScene(43, 0.25 * 3.14159265358979323846);
  scene.cloth.columns = 4;  // columns do not feel each other
  const ClothStart start = clothStart(scene);
  const double first = gravityEnergy(start, start.positions);
  const double scale = first - restEnergy(start);
  const int seconds = options.quick ? 20 : 60;
  Table table(options.folder, "energy.csv", {"method", "setting", "t_s", "drift"});
  for (const Entry& entry : entriesOfEnergy()) {
    const auto contestant = entry.make(scene, start);
    run(start, *contestant, 60 * seconds, 60.0, [&](int frame, const Contestant& now, const Points&) {
      if (frame % 60 != 0) return;
      table.row({entry.method, entry.setting, number(frame / 60), number((totalEnergy(start, now) - first) / scale)});
    });
  }
}

}  // namespace curtain_bench
