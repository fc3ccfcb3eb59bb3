// SPDX-License-Identifier: BSD-3-Clause
//
// The same curtain and the same ball, ours and Bullet's: time against what links lack and how many nodes are in the
// ball.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "bench/contact_scenes.h"
#include "bench/line_up.h"
#include "bench/measure.h"
#include "bench/rivals/rivals.h"
#include "bench/studies.h"
#include "bench/table.h"

namespace curtain_bench {
namespace {

constexpr int kFrames = 180;

constexpr double kGoes = 1.0;  // [s], from one place to the other
const Solid::Place kFrom = {0.5, -0.5, 1.1}, kTo = {0.5, -0.1, 1.1};

Solid ballOfAll() {
  Solid ball;
  ball.shape = Solid::Shape::kBall;
  ball.radius = 0.3;
  ball.margin = 0.004;
  ball.friction = 0.3;
  ball.at = [](double time) {
    const double share = std::min(1.0, time / kGoes);
    Solid::Place place{};
    for (std::size_t k = 0; k < 3; ++k) place[k] = kFrom[k] + share * (kTo[k] - kFrom[k]);
    return place;
  };
  return ball;
}

curtain::Scene sceneWith(const Solid& solid) {
  curtain::Scene scene = dampedBy(curtainOf(44, 40, 1.0, 0.0), 0.5);
  curtain::ObstacleParams ball = ballAt({kFrom[0], kFrom[1], kFrom[2]}, solid.radius);
  curtain::PoseKey from, to;
  from.pose = ball.pose;
  to.time = kGoes;
  to.pose.position = {kTo[0], kTo[1], kTo[2]};
  ball.motion = {from, to};
  scene.contact.thickness = solid.margin;
  scene.contact.friction = solid.friction;
  return with(scene, ball);
}

struct Inside {
  int nodes = 0;
  double deepest = 0.0;  // [m]
};

Inside insideOf(const Solid& ball, double time, const Points& positions) {
  const Solid::Place at = ball.at(time);
  Solid::Place normal{};
  Inside inside;
  for (std::size_t n = 0; n < positions.x.size(); ++n) {
    const double depth = -ball.distance(at, {positions.x[n], positions.y[n], positions.z[n]}, normal);
    inside.nodes += depth > 0.0;
    inside.deepest = std::max(inside.deepest, depth);
  }
  return inside;
}

void compare(const std::string& method, const std::string& setting, const ClothStart& start,
             const std::function<std::unique_ptr<Contestant>()>& make, int repeats, Table& table) {
  double frame_ms = 1e300;
  Inside most;
  Run made;
  for (int repeat = 0; repeat < repeats; ++repeat) {
    const std::unique_ptr<Contestant> contestant = make();
    made = run(start, *contestant, kFrames, 60.0, [&](int frame, const Contestant&, const Points& positions) {
      const Inside inside = insideOf(start.solid, frame * start.frame_seconds, positions);
      most = {std::max(most.nodes, inside.nodes), std::max(most.deepest, inside.deepest)};
    });
    frame_ms = std::min(frame_ms, made.frame_median);
  }
  table.row({method, setting, number(frame_ms), number(made.frame_max), number(made.stretch), number(most.nodes),
             number(1e3 * most.deepest)});
}

}  // namespace

void studyContactPeers(const Options& options) {
  Table table(options.folder, "contact_peers.csv",
              {"method", "setting", "ms_median", "ms_longest", "stretch", "nodes_inside", "deepest_mm"});
  const int repeats = options.quick ? 1 : std::min(options.repeats, 3);
  const Solid ball = ballOfAll();
  const curtain::Scene scene = sceneWith(ball);
  curtain::Scene bare = scene;
  bare.obstacles.clear();
  ClothStart start = clothStart(bare, 0.5);
  start.solid = ball;
  compare(
      "auto", "default", start, [&] { return makeOurs(scene); }, repeats, table);
  if (!bulletInstalled()) return;
  for (const int substeps : {1, 4, 16, 64}) {
    for (const int iterations : {4, 16, 64}) {
      if (substeps * iterations > 1024) continue;
      const BulletSettings settings{substeps, iterations, 0};
      compare(
          "btSoftBody", "substeps " + std::to_string(substeps) + "; piterations " + std::to_string(iterations), start,
          [&] { return makeBullet(start, settings); }, repeats, table);
    }
  }
}

}  // namespace curtain_bench
