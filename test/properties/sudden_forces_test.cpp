// SPDX-License-Identifier: BSD-3-Clause
//
// A curtain before a thin plate, and a wind, a gravity, a pull or a jerk at its pins that sets in between two substeps:
// nothing that was known of the motion before tells where the cloth goes. It must not pass through the plate.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "curtain_sim/simulator.h"
#include "properties/random_scenes.h"
#include "properties/seeds.h"

namespace curtain {
namespace {

using namespace curtain_test;

enum class Cause { kWind, kGravity, kPull, kJerk };
constexpr double kHuge = 200.0;  // edge of a plate that no cloth gets around [m]

struct SuddenForce {
  Scene scene;
  Cause cause = Cause::kWind;
  int quiet = 0;                // frames before
  Vec3 gravity = Vec3::Zero();  // from then on [m/s^2]
  Vec3 jerk = Vec3::Zero();     // velocity of the pins, for some frames [m/s]
  int jerk_frames = 0;
  int frames = 0;
  double face = 0.0;    // near face of the plate: y [m]
  bool around = false;  // the cloth may get around the plate's edges
};

// The cloth hangs in the plane y = 0, the plate stands before it, in +y.
SuddenForce randomBlow(std::uint64_t seed) {
  RandomScenes random(seed);
  SuddenForce blow;
  const int most = random.chance(0.1) ? 40 : 16;
  Scene& scene = blow.scene;
  scene =
      flatScene(random.integer(2, most), random.integer(2, most), random.between(0.5, 2.0), random.between(0.5, 2.0));
  scene.hang.to = scene.hang.from + Vec3(random.between(0.6, 1.0) * scene.cloth.width, 0.0, 0.0);
  scene.cloth.surface_density = random.chance(0.5) ? 0.05 : random.between(0.05, 0.5);
  const double pins = random.between(0.0, 1.0);
  scene.pins.kind = pins < 0.6   ? PinKind::kTop
                    : pins < 0.8 ? PinKind::kTopCorners
                    : pins < 0.9 ? PinKind::kLeft
                                 : PinKind::kNone;
  scene.contact.self = random.chance(0.15);
  scene.contact.friction = random.between(0.0, 0.6);
  scene.solver.frame_rate = std::exp(random.between(std::log(10.0), std::log(240.0)));
  scene.solver.rest_speed = random.chance(0.5) ? 0.0 : 1e-4;
  scene.solver.threads = 1;
  const double frame = 1.0 / scene.solver.frame_rate;

  ObstacleParams plate;
  plate.name = "plate";
  plate.shape = ShapeKind::kBox;
  const double thickness = random.between(0.005, 0.01), gap = std::exp(random.between(std::log(0.02), std::log(0.8)));
  blow.around = random.chance(0.2);
  const double edge = blow.around ? random.between(0.2, 1.5) : kHuge;
  plate.size = Vec3(edge, thickness, edge);
  blow.face = gap;
  plate.pose.position = Vec3(0.5 * scene.cloth.width, gap + 0.5 * thickness, 0.5 * scene.cloth.height);
  scene.obstacles.push_back(plate);

  const bool hung = scene.pins.kind != PinKind::kNone;
  blow.cause = static_cast<Cause>(random.integer(0, hung ? 3 : 2));
  blow.quiet = random.integer(2, 20);
  const double start = (blow.quiet + random.between(0.0, 1.0)) * frame;
  const Vec3 ahead = (Vec3(0.0, 1.0, 0.0) + 0.3 * random.random().inBox(1.0)).normalized();
  blow.gravity = scene.gravity;
  switch (blow.cause) {
    case Cause::kWind: {
      WindParams wind;
      wind.id = "squall";
      wind.position = Vec3(0.5, -5.0, 0.5);
      wind.direction = ahead;
      wind.radius = 100.0;
      wind.pressure = std::exp(random.between(std::log(50.0), std::log(1e4)));
      wind.reference_length = 1e3;
      wind.start = start;
      scene.wind.push_back(wind);
      break;
    }
    case Cause::kGravity:
      blow.gravity = std::exp(random.between(std::log(10.0), std::log(1e3))) * ahead;
      break;
    case Cause::kPull: {
      DragParams pull;
      pull.id = "pull";
      pull.node = NodeIndex{scene.cloth.rows - 1,
                            random.integer(scene.pins.kind == PinKind::kLeft ? 1 : 0, scene.cloth.columns - 1)};
      pull.force = std::exp(random.between(std::log(1.0), std::log(1e3))) * ahead;
      pull.start = start;
      pull.end = start + random.between(0.01, 0.3);
      scene.drag.push_back(pull);
      break;
    }
    case Cause::kJerk: {
      const double way = random.between(-kPi, kPi);
      blow.jerk = random.between(5.0, 50.0) * Vec3(std::cos(way), 0.0, std::sin(way));
      blow.jerk_frames = std::clamp(static_cast<int>(0.1 / frame), 1, 5);
      scene.wind.push_back({});  // a breeze takes what is jerked to the plate
      scene.wind.back().id = "breeze";
      scene.wind.back().position = Vec3(0.5, -5.0, 0.5);
      scene.wind.back().direction = ahead;
      scene.wind.back().radius = 100.0;
      scene.wind.back().pressure = random.between(1.0, 50.0);
      scene.wind.back().reference_length = 1e3;
      break;
    }
  }
  blow.frames = blow.quiet + 1 + std::clamp(static_cast<int>(0.4 / frame), 4, 40);
  return blow;
}

// What went wrong, or nothing.
std::string passes(const SuddenForce& blow) {
  Simulator simulator(blow.scene);
  std::vector<NodeIndex> pins;
  for (int i = 0; i < simulator.rows(); ++i) {
    for (int j = 0; j < simulator.columns(); ++j) {
      if (simulator.pinned({i, j})) pins.push_back({i, j});
    }
  }
  for (int frame = 0; frame < blow.frames; ++frame) {
    if (frame == blow.quiet) simulator.setGravity(blow.gravity);
    if (frame >= blow.quiet && frame < blow.quiet + blow.jerk_frames) {
      for (const NodeIndex pin : pins)
        simulator.movePin(pin, simulator.position(pin) + blow.jerk / blow.scene.solver.frame_rate);
    }
    simulator.step();
    const Statistics& statistics = simulator.statistics();
    const bool torn = std::max(statistics.warp_stretch_max, statistics.weft_stretch_max) > 0.1;
    const std::string when = " in frame " + std::to_string(frame) + (torn ? ", links are torn" : "");
    const Piercings pierced = simulator.piercings(0);
    if (pierced.nodes + pierced.edges + pierced.faces > 0) {
      return std::to_string(pierced.nodes) + " nodes, " + std::to_string(pierced.edges) + " edges, " +
             std::to_string(pierced.faces) + " faces pierced" + when;
    }
    int through = 0;
    for (int i = 0; i < simulator.rows() && !blow.around; ++i) {
      for (int j = 0; j < simulator.columns(); ++j) through += simulator.position({i, j}).y() > blow.face ? 1 : 0;
    }
    if (through > 0) return std::to_string(through) + " nodes are beyond the plate" + when;
  }
  return "";
}

TEST(SuddenForces, TakeNoCurtainThroughAThinPlate) {
  int held = 0, torn = 0;
  const std::vector<std::uint64_t> all = seeds(20);
  for (const std::uint64_t seed : all) {
    const SuddenForce blow = randomBlow(seed);
    const std::string wrong = passes(blow);
    held += wrong.empty() ? 1 : 0;
    torn += wrong.find("torn") != std::string::npos ? 1 : 0;
    EXPECT_EQ(wrong, "") << repeat(seed) << ", cause " << static_cast<int>(blow.cause);
  }
  RecordProperty("held", held);
  RecordProperty("torn", torn);
}

}  // namespace
}  // namespace curtain
