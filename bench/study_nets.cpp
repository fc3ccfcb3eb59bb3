// SPDX-License-Identifier: BSD-3-Clause
//
// Two-corner nets settle under damping; their potential energy is held against the least there is (net_exact.csv). A
// method whose links give way rests below it.
#include <cmath>

#include "bench/line_up.h"
#include "bench/measure.h"
#include "bench/rivals/rivals.h"
#include "bench/studies.h"
#include "bench/table.h"
#include "curtain_sim/scene.h"
#include "truth_table.h"

namespace curtain_bench {
namespace {

// The table's nets, hung by two corners or by a hook at every third column: 1 m x 1 m, 1 kg in equal node masses.
// Damping: c_r = 1 m/s of Eq. (4) is 1.2 / s at 1 kg/m^2.
constexpr double kDamping = 1.2;

curtain::Scene netScene(int n, double span, bool hooks) {
  curtain::Scene scene;
  scene.cloth.rows = scene.cloth.columns = n;
  scene.cloth.height = scene.cloth.width = 1.0;
  scene.cloth.surface_density = 1.0;
  scene.cloth.lumping = curtain::Lumping::kUniform;
  scene.hang.from = curtain::Vec3::Zero();
  scene.hang.to = curtain::Vec3(span, 0.0, 0.0);
  scene.pins.kind = curtain::PinKind::kTopCorners;
  if (hooks) {
    scene.pins.kind = curtain::PinKind::kList;
    for (int column = 0; column < n; column += 3) scene.pins.nodes.push_back({0, column});
  }
  scene.air.inside = scene.air.border = scene.air.corner = 1.0;
  return scene;
}

std::vector<Entry> entriesOfNets(bool quick) {
  std::vector<Entry> entries;
  for (const std::string& method : curtain::methodNames()) entries.push_back(ourEntry(method, 0));
  const auto add = [&entries](const char* method, const char* setting, auto make) {
    entries.push_back({method, setting, make, true});
  };
  using curtain::Scene;
  add("XPBD", "substeps 64; iterations 1; compliance 0 m/N", [](const Scene&, const ClothStart& start) {
    return makeXpbd(start, {64, 1, 0.0});
  });
  if (quick) return entries;
  add("PBD", "substeps 8; iterations 30", [](const Scene&, const ClothStart& start) {
    return makePbd(start, {8, 30, 0.0});
  });
  add("Baraff-Witkin", "substeps 8; stiffness 100000 N/m; tolerance 0.0001", [](const Scene&, const ClothStart& start) {
    return makeBaraffWitkin(start, {8, 1e5, 1e-4, 400});
  });
  add("symplectic Euler", "substeps 128; dt*omega 1; dashpot 0.05", [](const Scene&, const ClothStart& start) {
    return makeSymplecticEuler(start, {128, 1.0, 0.05});
  });
  return entries;
}

}  // namespace

void studyNets(const Options& options) {
  constexpr int kFrames = 900;
  Table table(
      options.folder, "nets.csv",
      {"case", "n", "D", "method", "setting", "energy_J", "exact_J", "relative_error", "stretch", "ms_per_frame"});
  for (const auto& row : curtain_test::readTruth("net_exact.csv")) {
    const int n = std::stoi(row.at("n"));
    const bool hooks = row.at("case") == "hooks3";
    if (options.quick && (hooks || n > 5)) continue;
    const double exact = std::stod(row.at("E_min_J (1 kg, 1 m x 1 m, g 9.81)"));
    const curtain::Scene scene = netScene(n, std::stod(row.at("D")), hooks);
    const ClothStart start = clothStart(scene, kDamping);
    for (const Entry& entry : entriesOfNets(options.quick)) {
      const auto contestant = entry.make(scene, start);
      const Run made = run(start, *contestant, kFrames, 20.0);
      const double energy = made.sound ? gravityEnergy(start, made.end) : std::nan("");
      table.row({row.at("case"), number(n), row.at("D"), entry.method, entry.setting, number(energy, 8),
                 number(exact, 8), number((energy - exact) / -exact),
                 number(made.sound ? largestStretch(start, made.end) : std::nan("")), number(made.ms / made.frames)});
    }
  }
}

}  // namespace curtain_bench
