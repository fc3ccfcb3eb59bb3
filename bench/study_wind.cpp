// SPDX-License-Identifier: BSD-3-Clause
//
// A chain in a uniform wind rests on a straight line (wind_chain.csv, law A: Cheng 2000, Eq. (3), whose force is along
// the wind and goes with cos psi). The disc is so far away that 1 + (|d| / reference_length)^2 varies by 2e-5 over the
// cloth. Ours only: the rivals have no wind.
#include <cmath>

#include "bench/line_up.h"
#include "bench/measure.h"
#include "bench/studies.h"
#include "bench/table.h"
#include "curtain_sim/simulator.h"
#include "truth_table.h"

namespace curtain_bench {
namespace {

constexpr int kRods = 43;

curtain::Scene windScene(double ratio) {
  constexpr double kFar = 1e5;  // [m]
  curtain::Scene scene;
  scene.cloth.rows = kRods + 1;
  scene.cloth.columns = 4;
  scene.cloth.lumping = curtain::Lumping::kUniform;
  scene.hang.from = curtain::Vec3::Zero();
  scene.hang.to = curtain::Vec3(1.0, 0.0, 0.0);
  scene.air.inside = scene.air.border = scene.air.corner = 1.0;
  const double node_mass = curtain::Simulator(scene).mass({1, 1});
  curtain::WindParams wind;
  wind.id = "far";
  wind.position = curtain::Vec3(0.5, -kFar, -1.0);
  wind.direction = curtain::Vec3::UnitY();
  wind.radius = 10.0;
  wind.reference_length = kFar;
  wind.node_force = ratio * node_mass * 9.81 * 2.0;
  scene.wind.push_back(wind);
  return scene;
}

}  // namespace

void studyWind(const Options& options) {
  const int frames = options.quick ? 600 : 1800;
  Table table(options.folder, "wind.csv", {"r", "method", "theta_exact", "theta", "tip_error_over_L", "rest_m_s"});
  for (const auto& row : curtain_test::readTruth("wind_chain.csv")) {
    if (row.at("law") != "A") continue;
    const double ratio = std::stod(row.at("r=f0/mg")), exact = std::stod(row.at("theta_rad"));
    for (const std::string& method : curtain::methodNames()) {
      curtain::Scene scene = windScene(ratio);
      scene.solver.method = *curtain::methodFromName(method);
      curtain::Simulator simulator(scene);
      for (int frame = 0; frame < frames; ++frame) simulator.step();
      const curtain::Vec3 tip = simulator.position({kRods, 1}) / scene.cloth.height;
      std::vector<curtain::Vec3> velocities;
      simulator.copyVelocities(velocities);
      double fastest = 0.0;
      for (const curtain::Vec3& v : velocities) fastest = std::max(fastest, v.norm());
      table.row({number(ratio), method, number(exact), number(std::atan2(tip.y(), -tip.z())),
                 number(std::hypot(tip.y() - std::sin(exact), tip.z() + std::cos(exact))), number(fastest)});
    }
  }
}

}  // namespace curtain_bench
