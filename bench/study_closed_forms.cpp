// SPDX-License-Identifier: BSD-3-Clause
//
// Contact and friction against closed forms: what a frame takes, and how far off the answer is, ours and the rivals
// that know solids.
//
//   scarf     slides off a bar without friction; half of what hangs lower on one side grows as cosh
//   Atwood    a strap over such a bar, loads of 75 and 50 g: the same
//   slope     a sheet that slides on a plane, 30 degrees, mu 0.3: g (sin - mu cos) t^2 / 2
//   belt      a sheet on a belt that speeds up with 0.45 g, mu 0.5, goes with it
//   capstan   a strap over a bar, mu 0.3, 50 g on one end: holds e^(mu pi) times that (Euler 1769)
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "bench/line_up.h"
#include "bench/measure.h"
#include "bench/rivals/rivals.h"
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
using curtain_test::Strap;
using curtain_test::strapScene;

constexpr double kBudget = 20.0;  // [s] of computing, for one run

// A scene for us, and the same for the others.
struct Problem {
  Scene scene;
  ClothStart start;
};

// What a setting gives for a problem.
struct Answer {
  double error = std::nan("");     // relative, but of the belt [m]
  double frame_ms = std::nan("");  // median
};

Points pointsOf(const Simulator& simulator) {
  std::vector<Vec3> nodes;
  simulator.copyPositions(nodes);
  Points points;
  points.resize(nodes.size());
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    points.x[n] = nodes[n].x();
    points.y[n] = nodes[n].y();
    points.z[n] = nodes[n].z();
  }
  return points;
}

Solid solidOf(const Scene& scene, Solid::Shape shape, double friction) {
  Solid solid;
  solid.shape = shape;
  solid.margin = scene.contact.thickness;
  solid.friction = friction;
  return solid;
}

Run made(const Problem& problem, const Entry& entry, int frames) {
  const std::unique_ptr<Contestant> contestant = entry.make(problem.scene, problem.start);
  return run(problem.start, *contestant, frames, kBudget);
}

bool isWhole(const Run& run) { return run.sound && !run.cut; }

// A strap laid over the bar, whose axis is at 1 m.
Problem overTheBar(const Strap& strap, double friction, double& half) {
  Problem problem;
  problem.scene = strapScene(strap);
  problem.scene.obstacles[0].friction = friction;
  Scene bare = problem.scene;
  bare.obstacles.clear();
  problem.start = clothStart(bare);
  Simulator simulator(problem.scene);
  half = 0.5 * (strap.left - layOver(simulator, strap));
  problem.start.positions = pointsOf(simulator);
  problem.start.solid = solidOf(problem.scene, Solid::Shape::kBar, friction);
  problem.start.solid.radius = strap.radius;
  problem.start.solid.at = [](double) { return Solid::Place{0.0, 0.0, 1.0}; };
  return problem;
}

double sunk(const Problem& problem, const Run& run) { return problem.start.positions.z[0] - run.end.z[0]; }

// x'' = g (M1 - M2 + 2 q x) / (M1 + M2 + m), q being the strap's mass over its length and m all of it, so
// x = ((M1 - M2) / (2 q) + x0) (cosh(w t) - 1), x0 by how much further the left end hangs at the start, halved.
Answer sinks(const Strap& strap, const Entry& entry) {
  constexpr int kFrames = 24;
  double half = 0.0;
  const Problem problem = overTheBar(strap, 0.0, half);
  const Run run = made(problem, entry, kFrames);
  if (!isWhole(run)) return {};
  double all = 0.0;
  for (const double mass : problem.start.mass) all += mass;
  const std::size_t nodes = problem.start.count();
  const double more =
      problem.start.mass[0] + problem.start.mass[1] - problem.start.mass[nodes - 2] - problem.start.mass[nodes - 1];
  const double grows = std::sqrt(2.0 * Strap::kPerLength * problem.scene.gravity.norm() / all);
  const double time = kFrames * problem.start.frame_seconds;
  const double expected = (more / (2.0 * Strap::kPerLength) + half) * (std::cosh(grows * time) - 1.0);
  return {std::abs(sunk(problem, run) / expected - 1.0), run.frame_median};
}

// A square of cloth that lies on a wide floor.
Problem onTheFloor(double friction) {
  Problem problem;
  Scene& scene = problem.scene;
  scene.cloth.rows = scene.cloth.columns = 13;
  scene.cloth.height = scene.cloth.width = 0.3;
  scene.hang.from = Vec3(-0.15, 0.15, scene.contact.thickness);
  scene.hang.to = Vec3(0.15, 0.15, scene.contact.thickness);
  scene.hang.tilt = 0.5 * curtain::kPi;
  scene.pins.kind = curtain::PinKind::kNone;
  scene.air.inside = scene.air.border = scene.air.corner = 0.0;
  problem.start = clothStart(scene);
  problem.start.solid = solidOf(scene, Solid::Shape::kFloor, friction);
  problem.start.solid.at = [](double) { return Solid::Place{0.0, 0.0, 0.0}; };
  curtain::ObstacleParams floor;
  floor.name = "floor";
  floor.shape = curtain::ShapeKind::kBox;
  floor.size = Vec3(1000.0, 2.0, 0.2);
  floor.pose.position = Vec3(0.0, 0.0, -0.1);
  floor.friction = friction;
  scene.obstacles.push_back(floor);
  return problem;
}

double middle(const Points& points) {
  double sum = 0.0;
  for (const double x : points.x) sum += x;
  return sum / static_cast<double>(points.x.size());
}

Answer slides(const Entry& entry) {
  constexpr double kFriction = 0.3, kTilt = curtain::kPi / 6.0;
  constexpr int kFrames = 30;
  Problem problem = onTheFloor(kFriction);
  const double gravity = problem.scene.gravity.norm();
  problem.scene.gravity = gravity * Vec3(std::sin(kTilt), 0.0, -std::cos(kTilt));
  problem.start.gravity = {problem.scene.gravity.x(), 0.0, problem.scene.gravity.z()};
  const Run run = made(problem, entry, kFrames);
  if (!isWhole(run)) return {};
  const double time = kFrames * problem.start.frame_seconds;
  const double expected = 0.5 * gravity * (std::sin(kTilt) - kFriction * std::cos(kTilt)) * time * time;
  return {std::abs((middle(run.end) - middle(problem.start.positions)) / expected - 1.0), run.frame_median};
}

Answer isTakenAlong(const Entry& entry) {
  constexpr int kFrames = 180;
  Problem problem = onTheFloor(0.5);
  const double faster = 0.45 * problem.scene.gravity.norm();
  problem.scene.obstacles[0].acceleration = Vec3(faster, 0.0, 0.0);
  problem.start.solid.at = [faster](double time) { return Solid::Place{0.5 * faster * time * time, 0.0, 0.0}; };
  const Run run = made(problem, entry, kFrames);
  if (!isWhole(run)) return {};
  const double goes = problem.start.solid.at(kFrames * problem.start.frame_seconds)[0];
  return {std::abs(middle(run.end) - middle(problem.start.positions) - goes), run.frame_median};
}

// The largest load that sinks in a second by less than a twentieth of what a load 3 % larger has the might to, over
// what the strap holds: halved nine times between 0.5 and 1.5.
Answer holds(const Entry& entry) {
  constexpr double kFriction = 0.3, kLight = 0.05;
  Strap strap;
  strap.rows = 124;
  strap.last_load = kLight;
  const double limit =
      bearable(strap, kFriction, kLight + Strap::kPerLength * strap.right) - Strap::kPerLength * strap.left;
  std::vector<double> ms;
  double low = 0.5, high = 1.5, half = 0.0;
  for (int halving = 0; halving < 9; ++halving) {
    const double load = 0.5 * (low + high);
    strap.first_load = load * limit;
    const Problem problem = overTheBar(strap, kFriction, half);
    const Run run = made(problem, entry, 60);
    if (!isWhole(run)) return {};
    ms.push_back(run.frame_median);
    const double might = 0.5 * problem.scene.gravity.norm() * 0.03 / 2.03;
    (sunk(problem, run) < 0.05 * might ? low : high) = load;
  }
  return {std::abs(0.5 * (low + high) - 1.0), median(ms)};
}

Entry ours(curtain::Method method, int substeps) {
  Entry entry = ourEntry(toString(method), substeps);
  entry.make = [method, substeps](const Scene& given, const ClothStart& start) {
    Scene scene = given;
    scene.solver.method = method;
    scene.solver.substeps = substeps;
    scene.solver.threads = 1;
    scene.solver.rest_speed = 0.0;
    return makeOurs(scene, start);
  };
  return entry;
}

std::vector<Entry> line(bool quick) {
  std::vector<Entry> entries;
  for (const curtain::Method method : {curtain::Method::kAuto, curtain::Method::kImplicit}) {
    if (quick && method == curtain::Method::kImplicit) continue;
    entries.push_back(ours(method, 0));
    for (int substeps = 1; substeps <= (quick ? 4 : 32); substeps *= 2) entries.push_back(ours(method, substeps));
  }
  const int most = quick ? 64 : 1024;
  for (int substeps = 1; substeps <= std::min(most, 256); substeps *= 4) {
    for (const int iterations : {1, 4, 16, 64}) {
      if (substeps * iterations > most) continue;
      const std::string setting = "substeps " + std::to_string(substeps) + "; iterations " + std::to_string(iterations);
      const PositionSettings position{substeps, iterations, 0.0};
      const BulletSettings bullet{substeps, iterations, 0};
      entries.push_back(
          {"PBD", setting, [=](const Scene&, const ClothStart& start) { return makePbd(start, position); }, true});
      entries.push_back(
          {"XPBD", setting, [=](const Scene&, const ClothStart& start) { return makeXpbd(start, position); }, true});
      if (!bulletInstalled() || substeps > 64) continue;
      entries.push_back({"btSoftBody",
                         "substeps " + std::to_string(substeps) + "; piterations " + std::to_string(iterations),
                         [=](const Scene&, const ClothStart& start) { return makeBullet(start, bullet); }, false});
    }
  }
  return entries;
}

}  // namespace

void studyClosedForms(const Options& options) {
  Strap scarf, atwood;
  scarf.left = 0.35;
  scarf.right = 0.25;
  atwood.first_load = 0.075;
  atwood.last_load = 0.05;
  const std::vector<std::pair<std::string, std::function<Answer(const Entry&)>>> problems = {
      {"scarf", [&](const Entry& entry) { return sinks(scarf, entry); }},
      {"Atwood", [&](const Entry& entry) { return sinks(atwood, entry); }},
      {"slope", slides},
      {"belt", isTakenAlong},
      {"capstan", holds}};
  Table table(options.folder, "closed_forms.csv", {"problem", "method", "setting", "ms_median", "error"});
  const std::vector<Entry> entries = line(options.quick);
  for (const auto& [problem, answer] : problems) {
    for (const Entry& entry : entries) {
      const Answer found = answer(entry);
      table.row({problem, entry.method, entry.setting, number(found.frame_ms), number(found.error)});
    }
    std::fprintf(stderr, "closed_forms %s done\n", problem.c_str());
  }
}

}  // namespace curtain_bench
