// SPDX-License-Identifier: BSD-3-Clause
//
// What contact costs: scenes of 44 x 40 nodes with and without it, made frame by frame in turns on one core.
#include <algorithm>
#include <chrono>
#include <cmath>

#include "bench/measure.h"
#include "bench/studies.h"
#include "bench/table.h"
#include "curtain_sim/simulator.h"

namespace curtain_bench {
namespace {

using curtain::ObstacleParams;
using curtain::Scene;
using curtain::Vec3;

Scene curtainOf(double gathered, double tilt) {
  Scene scene;
  scene.cloth.rows = 44;
  scene.cloth.columns = 40;
  scene.hang.from = {0.0, 0.0, 2.1};
  scene.hang.to = {gathered, 0.0, 2.1};
  scene.hang.tilt = tilt;
  scene.solver.threads = 1;
  scene.solver.rest_speed = 0.0;  // without contact some would sleep
  return scene;
}

Scene blown(Scene scene) {
  scene.air.inside = scene.air.border = scene.air.corner = 0.2;
  curtain::WindParams fan;
  fan.id = "fan";
  fan.position = {0.3, -1.5, 1.2};
  fan.direction = Vec3::UnitY();
  fan.radius = 1.5;
  fan.half_angle = 0.2;
  fan.pressure = 6.0;
  fan.unsteadiness = 4.0;
  scene.wind.push_back(fan);
  return scene;
}

ObstacleParams ballAt(const Vec3& position) {
  ObstacleParams ball;
  ball.name = "ball";
  ball.radius = 0.3;
  ball.pose.position = position;
  return ball;
}

Scene with(Scene scene, const ObstacleParams& obstacle) {
  scene.obstacles.push_back(obstacle);
  return scene;
}

Scene touchingItself(Scene scene) {
  scene.contact.self = true;
  return scene;
}

Scene dampedBy(Scene scene, double air) {
  scene.air.inside = scene.air.border = scene.air.corner = air;
  return scene;
}

Scene falling() {
  Scene scene = dampedBy(curtainOf(1.0, 0.0), 0.3);
  scene.pins.kind = curtain::PinKind::kNone;
  ObstacleParams floor;
  floor.name = "floor";
  floor.shape = curtain::ShapeKind::kPlane;
  return with(scene, floor);
}

// The medians of one run's frames from `first` on [ms], without and with.
void compare(const std::string& name, const Scene& without, const Scene& with_it, int first, int last, int repeats,
             Table& table) {
  std::vector<double> off, on, ratio;
  double worst = 0.0;
  for (int repeat = 0; repeat < repeats; ++repeat) {
    curtain::Simulator a(without), b(with_it);
    std::vector<double> frames_a, frames_b;
    for (int frame = 0; frame < last; ++frame) {
      a.step();
      b.step();
      if (frame < first) continue;
      frames_a.push_back(1e3 * a.statistics().step_seconds);
      frames_b.push_back(1e3 * b.statistics().step_seconds);
      worst = std::max(worst, frames_b.back());
    }
    off.push_back(median(frames_a));
    on.push_back(median(frames_b));
    ratio.push_back(on.back() / off.back());
  }
  table.row({name, number(*std::min_element(off.begin(), off.end())), number(*std::min_element(on.begin(), on.end())),
             number(*std::min_element(on.begin(), on.end()) - *std::min_element(off.begin(), off.end())),
             number(*std::min_element(ratio.begin(), ratio.end())), number(median(ratio)), number(worst)});
}

}  // namespace

void studyContact(const Options& options) {
  Table table(options.folder, "contact.csv",
              {"scene", "ms_without", "ms_with", "ms_added", "ratio_min", "ratio_median", "ms_longest"});
  const int repeats = options.quick ? 1 : options.repeats;
  const int frames = options.quick ? 60 : 240;
  const Scene swing = curtainOf(1.0, 0.7);
  compare("obstacle out of reach", swing, with(swing, ballAt({20.0, 0.0, 0.0})), 0, frames, repeats, table);
  compare("obstacle beside", swing, with(swing, ballAt({2.2, 0.0, 1.0})), 0, frames, repeats, table);
  const Scene hanging = dampedBy(curtainOf(0.8, 0.0), 0.5);
  compare("ball in it", hanging, with(hanging, ballAt({0.4, -0.2, 1.1})), 60, 60 + frames, repeats, table);
  compare("flat (itself)", swing, touchingItself(swing), 0, frames, repeats, table);
  const Scene gathered = blown(curtainOf(0.6, 0.0));
  compare("gathered to 60 % (itself)", gathered, touchingItself(gathered), 0, frames, repeats, table);
  compare("heap on the floor (itself)", falling(), touchingItself(falling()), 120, options.quick ? 140 : 240, options.quick ? 1 : 2,
          table);
}

}  // namespace curtain_bench
