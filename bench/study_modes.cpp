// SPDX-License-Identifier: BSD-3-Clause
//
// Small oscillations: the frequencies of the first five modes against test/truth/modes_frequencies.csv. The cloth is
// released straight at a small angle, which moves all modes at once; the motion is projected on each mode's shape
// (modes_shapes.csv; with equal masses the shapes are orthogonal). What is left is q'' + 2 c q' + omega^2 q = 0, whose
// samples obey q(n+s) = 2 b cos(omega s dt) q(n) - b^2 q(n-s), b = e^(-c s dt): least squares over the whole run.
#include <cmath>

#include "bench/chain.h"
#include "bench/line_up.h"
#include "bench/measure.h"
#include "bench/rivals/rivals.h"
#include "bench/studies.h"
#include "bench/table.h"
#include "curtain_sim/scene.h"
#include "truth_table.h"

namespace curtain_bench {
namespace {

constexpr int kRods = 43;
constexpr int kModes = 5;
constexpr double kAngle = 1e-3;  // [rad] the frequencies of a pendulum go down by angle^2 / 16, here 6e-8

struct Mode {
  double frequency = 0.0;     // [rad/s]
  std::vector<double> shape;  // a node each, the support first
};

std::vector<Mode> modesOfTruth() {
  std::vector<Mode> modes(kModes);
  const std::string rods = std::to_string(kRods);
  for (const auto& row : curtain_test::readTruth("modes_frequencies.csv")) {
    const auto mode = static_cast<std::size_t>(std::stoi(row.at("mode")) - 1);
    if (row.at("N") == rods && mode < kModes) modes[mode].frequency = std::stod(row.at("omega_rad_s(L=2,g=9.81)"));
  }
  for (const auto& row : curtain_test::readTruth("modes_shapes.csv")) {
    const auto mode = static_cast<std::size_t>(std::stoi(row.at("mode")) - 1);
    if (row.at("N") == rods && mode < kModes) modes[mode].shape.push_back(std::stod(row.at("x_over_x_tip")));
  }
  return modes;
}

struct Oscillation {
  double frequency = std::nan("");  // [rad/s]
  double decay = std::nan("");      // c [1/s]
};

// The stride is a quarter period (or five of them), where the cosine is steepest; `expected` tells which.
Oscillation fit(const std::vector<double>& q, double expected, double dt, int quarters) {
  const double pi = std::acos(-1.0);
  const auto stride = static_cast<std::size_t>(std::lround(quarters * 0.5 * pi / (expected * dt)));
  // Normal equations of q(n+s) = p q(n) + r q(n-s).
  double aa = 0.0, ab = 0.0, bb = 0.0, ay = 0.0, by = 0.0;
  for (std::size_t n = stride; n + stride < q.size(); ++n) {
    const double a = q[n], b = q[n - stride], y = q[n + stride];
    aa += a * a;
    ab += a * b;
    bb += b * b;
    ay += a * y;
    by += b * y;
  }
  const double determinant = aa * bb - ab * ab;
  const double p = (ay * bb - by * ab) / determinant, r = (by * aa - ay * ab) / determinant;
  Oscillation found;
  if (!(r < 0.0)) return found;  // no oscillation: damped away
  const double kept = std::sqrt(-r);
  const double cosine = 0.5 * p / kept;
  if (!(std::abs(cosine) < 1.0)) return found;
  // The angle omega s dt lies within a quarter turn of quarters * pi / 2; acos gives it in [0, pi].
  const double turn = std::acos(cosine);
  const double base = 0.5 * pi * (quarters - 1);  // whole turns: quarters = 1, 5, …
  const double time = static_cast<double>(stride) * dt;
  found.frequency = (base + turn) / time;
  found.decay = -std::log(kept) / time;
  return found;
}

void measure(const Entry& entry, const curtain::Scene& scene, const ClothStart& start, const std::vector<Mode>& modes,
             int seconds, Table& table) {
  const auto contestant = entry.make(scene, start);
  std::vector<std::vector<double>> q(kModes);
  run(start, *contestant, 60 * seconds, 60.0, [&](int, const Contestant&, const Points& positions) {
    for (std::size_t m = 0; m < kModes; ++m) {
      double sum = 0.0;
      for (int i = 1; i <= kRods; ++i) {
        sum += modes[m].shape[static_cast<std::size_t>(i)] * positions.y[static_cast<std::size_t>(i * start.columns)];
      }
      q[m].push_back(sum);
    }
  });
  for (std::size_t m = 0; m < kModes; ++m) {
    // A quarter period tells decay and a rough frequency; five quarters, the frequency, if the rough one leaves no
    // doubt.
    const Oscillation rough = fit(q[m], modes[m].frequency, start.frame_seconds, 1);
    const bool near = std::abs(rough.frequency / modes[m].frequency - 1.0) < 0.1;
    const Oscillation fine = near ? fit(q[m], modes[m].frequency, start.frame_seconds, 5) : rough;
    const Oscillation& best = std::isfinite(fine.frequency) ? fine : rough;
    table.row({entry.method, entry.setting, number(static_cast<int>(m) + 1), number(modes[m].frequency, 8),
               number(best.frequency, 8), number(best.frequency / modes[m].frequency - 1.0), number(best.decay)});
  }
}

std::vector<Entry> entriesOfModes() {
  std::vector<Entry> entries = ourEntries({2, 8});
  const auto add = [&entries](const char* method, const char* setting, auto make) {
    entries.push_back({method, setting, make, true});
  };
  using curtain::Scene;
  add("symplectic Euler", "substeps 64; dt*omega 1.8; dashpot 0.05", [](const Scene&, const ClothStart& start) {
    return makeSymplecticEuler(start, {64, 1.8, 0.05});
  });
  add("Runge-Kutta 4", "substeps 64; dt*omega 2.4", [](const Scene&, const ClothStart& start) {
    return makeRungeKutta(start, {64, 2.4, 0.0});
  });
  add("Baraff-Witkin", "substeps 8; stiffness 10000 N/m; tolerance 1e-08", [](const Scene&, const ClothStart& start) {
    return makeBaraffWitkin(start, {8, 1e4, 1e-8, 400});
  });
  add("XPBD", "substeps 64; iterations 1; compliance 0 m/N", [](const Scene&, const ClothStart& start) {
    return makeXpbd(start, {64, 1, 0.0});
  });
  if (bulletInstalled()) {
    add("btSoftBody", "substeps 16; piterations 3; viterations 0", [](const Scene&, const ClothStart& start) {
      return makeBullet(start, {16, 3, 0});
    });
  }
  return entries;
}

}  // namespace

void studyModes(const Options& options) {
  curtain::Scene scene = chainScene(kRods, kAngle);
  scene.cloth.columns = 2;
  scene.solver.stretch_tolerance = 1e-10;  // the modes are smaller than what 1e-3 would let pass
  const ClothStart start = clothStart(scene);
  const std::vector<Mode> modes = modesOfTruth();
  Table table(options.folder, "modes.csv",
              {"method", "setting", "mode", "omega_exact", "omega", "relative_error", "decay_per_s"});
  for (const Entry& entry : entriesOfModes()) {
    measure(entry, scene, start, modes, options.quick ? 10 : 30, table);
  }
}

}  // namespace curtain_bench
