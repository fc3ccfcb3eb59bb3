// SPDX-License-Identifier: BSD-3-Clause
//
// The same curtain and the same ball, ours and Bullet's: time against what links lack and how many nodes are in the
// ball.
#include <algorithm>

#include "bench/contact_scenes.h"
#include "bench/line_up.h"
#include "bench/measure.h"
#include "bench/rivals/rivals.h"
#include "bench/studies.h"
#include "bench/table.h"

namespace curtain_bench {
namespace {

constexpr int kFrames = 180;

void compare(const std::string& method, const std::string& setting, const ClothStart& start,
             const std::function<std::unique_ptr<Contestant>()>& make, int repeats, Table& table) {
  double frame_ms = 1e300;
  Inside most;
  Run made;
  for (int repeat = 0; repeat < repeats; ++repeat) {
    const std::unique_ptr<Contestant> contestant = make();
    made = run(start, *contestant, kFrames, 60.0, [&](int frame, const Contestant&, const Points& positions) {
      const Inside inside = insideOf(start, frame * start.frame_seconds, positions);
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
  const curtain::Scene scene = with(dampedBy(curtainOf(44, 40, 1.0, 0.0), 0.5), ballThatComes());
  curtain::Scene bare = scene;
  bare.obstacles.clear();
  ClothStart start = clothStart(bare, 0.5);
  start.solid = solidOf(scene);
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
