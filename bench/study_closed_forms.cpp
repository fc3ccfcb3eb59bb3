// SPDX-License-Identifier: BSD-3-Clause
//
// Contact and friction against closed forms: what a frame takes, and how far off the answer is.
//
//   scarf     slides off a bar without friction                       half of what hangs lower on one side grows as
//   cosh Atwood    a strap over such a bar, loads of 75 and 50 g           the same slope     a sheet that slides on a
//   plane, 30 degrees, mu 0.3      g (sin - mu cos) t^2 / 2 belt      a sheet on a belt that speeds up with 0.45 g, mu
//   0.5    goes with it capstan   a strap over a bar, mu 0.3, 50 g on one end             holds e^(mu pi) times that
//   (Euler 1769)
#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "bench/measure.h"
#include "bench/studies.h"
#include "bench/table.h"
#include "curtain_sim/simulator.h"
#include "over_a_bar.h"

namespace curtain_bench {
namespace {

using curtain::Scene;
using curtain::Simulator;
using curtain::Vec3;
using curtain_test::bearable;
using curtain_test::layOver;
using curtain_test::massOfRow;
using curtain_test::Strap;
using curtain_test::strapScene;

// What a setting of the solver gives for a problem.
struct Answer {
  double error = 0.0;     // relative, but of the belt [m]
  double frame_ms = 0.0;  // median
};
using Setting = std::function<void(curtain::SolverParams&)>;

double frames(Simulator& simulator, int count, std::vector<double>& milliseconds) {
  for (int frame = 0; frame < count; ++frame) {
    simulator.step();
    milliseconds.push_back(1e3 * simulator.statistics().step_seconds);
  }
  return simulator.time();
}

// x'' = g (M1 - M2 + 2 q x) / (M1 + M2 + m), q being the strap's mass over its length and m all of it, so
// x = ((M1 - M2) / (2 q) + x0) (cosh(w t) - 1), x0 by how much further the left end hangs at the start, halved.
Answer sinks(const Strap& strap, const Setting& setting) {
  Scene scene = strapScene(strap);
  setting(scene.solver);
  Simulator simulator(scene);
  const double half = 0.5 * (strap.left - layOver(simulator, strap));
  double all = 0.0;
  for (int row = 0; row < strap.rows; ++row) all += massOfRow(simulator, row);
  const double more = massOfRow(simulator, 0) - massOfRow(simulator, strap.rows - 1);
  const double before = simulator.position({0, 0}).z();
  std::vector<double> ms;
  const double time = frames(simulator, 24, ms);
  const double grows = std::sqrt(2.0 * Strap::kPerLength * scene.gravity.norm() / all);
  const double expected = (more / (2.0 * Strap::kPerLength) + half) * (std::cosh(grows * time) - 1.0);
  return {std::abs((before - simulator.position({0, 0}).z()) / expected - 1.0), median(ms)};
}

// A square of cloth that lies on a wide floor.
Scene sheetOnFloor(double friction) {
  Scene scene;
  scene.cloth.rows = scene.cloth.columns = 13;
  scene.cloth.height = scene.cloth.width = 0.3;
  scene.hang.from = Vec3(-0.15, 0.15, scene.contact.thickness);
  scene.hang.to = Vec3(0.15, 0.15, scene.contact.thickness);
  scene.hang.tilt = 0.5 * curtain::kPi;
  scene.pins.kind = curtain::PinKind::kNone;
  scene.air.inside = scene.air.border = scene.air.corner = 0.0;
  curtain::ObstacleParams floor;
  floor.name = "floor";
  floor.shape = curtain::ShapeKind::kBox;
  floor.size = Vec3(1000.0, 2.0, 0.2);
  floor.pose.position = Vec3(0.0, 0.0, -0.1);
  floor.friction = friction;
  scene.obstacles.push_back(floor);
  return scene;
}

double middle(const Simulator& simulator) {
  std::vector<Vec3> nodes;
  simulator.copyPositions(nodes);
  double sum = 0.0;
  for (const Vec3& node : nodes) sum += node.x();
  return sum / static_cast<double>(nodes.size());
}

Answer slides(const Setting& setting) {
  constexpr double kFriction = 0.3, kTilt = curtain::kPi / 6.0;
  Scene scene = sheetOnFloor(kFriction);
  setting(scene.solver);
  const double gravity = scene.gravity.norm();
  scene.gravity = gravity * Vec3(std::sin(kTilt), 0.0, -std::cos(kTilt));
  Simulator simulator(scene);
  std::vector<double> ms;
  const double before = middle(simulator), time = frames(simulator, 30, ms);
  const double expected = 0.5 * gravity * (std::sin(kTilt) - kFriction * std::cos(kTilt)) * time * time;
  return {std::abs((middle(simulator) - before) / expected - 1.0), median(ms)};
}

Answer isTakenAlong(const Setting& setting) {
  Scene scene = sheetOnFloor(0.5);
  setting(scene.solver);
  scene.obstacles[0].acceleration = Vec3(0.45 * scene.gravity.norm(), 0.0, 0.0);
  Simulator simulator(scene);
  std::vector<double> ms;
  frames(simulator, 180, ms);
  return {std::abs(middle(simulator) - simulator.obstaclePose(0).position.x()), median(ms)};
}

// The largest load that sinks in a second by less than a twentieth of what a load 3 % larger has the might to, over
// what the strap holds: halved nine times between 0.5 and 1.5.
Answer holds(const Setting& setting) {
  constexpr double kFriction = 0.3, kLight = 0.05;
  Strap strap;
  strap.rows = 124;
  strap.last_load = kLight;
  const double limit =
      bearable(strap, kFriction, kLight + Strap::kPerLength * strap.right) - Strap::kPerLength * strap.left;
  std::vector<double> ms;
  double low = 0.5, high = 1.5;
  for (int halving = 0; halving < 9; ++halving) {
    const double load = 0.5 * (low + high);
    strap.first_load = load * limit;
    Scene scene = strapScene(strap);
    scene.obstacles[0].friction = kFriction;
    setting(scene.solver);
    Simulator simulator(scene);
    layOver(simulator, strap);
    const double before = simulator.position({0, 0}).z();
    frames(simulator, 60, ms);
    const double might = 0.5 * scene.gravity.norm() * 0.03 / 2.03;
    (before - simulator.position({0, 0}).z() < 0.05 * might ? low : high) = load;
  }
  return {std::abs(0.5 * (low + high) - 1.0), median(ms)};
}

}  // namespace

void studyClosedForms(const Options& options) {
  Strap scarf, atwood;
  scarf.left = 0.35;
  scarf.right = 0.25;
  atwood.first_load = 0.075;
  atwood.last_load = 0.05;
  const std::vector<std::pair<std::string, std::function<Answer(const Setting&)>>> problems = {
      {"scarf", [&](const Setting& setting) { return sinks(scarf, setting); }},
      {"Atwood", [&](const Setting& setting) { return sinks(atwood, setting); }},
      {"slope", slides},
      {"belt", isTakenAlong},
      {"capstan", holds}};
  Table table(options.folder, "closed_forms.csv", {"problem", "method", "substeps", "ms_median", "error"});
  const int most = options.quick ? 4 : 32;
  for (const auto& [problem, answer] : problems) {
    for (const curtain::Method method : {curtain::Method::kAuto, curtain::Method::kImplicit}) {
      for (int substeps = 0; substeps <= most; substeps = std::max(1, 2 * substeps)) {
        if (substeps == 0 && method != curtain::Method::kAuto) continue;
        const Answer found = answer([&](curtain::SolverParams& solver) {
          solver.method = method;
          solver.substeps = substeps;
          solver.threads = 1;
          solver.rest_speed = 0.0;
        });
        table.row({problem, toString(method), substeps == 0 ? "auto" : number(substeps), number(found.frame_ms),
                   number(found.error)});
      }
    }
  }
}

}  // namespace curtain_bench
