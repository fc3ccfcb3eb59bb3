// SPDX-License-Identifier: BSD-3-Clause
#include "bench/cost/features.h"

#include <cmath>
#include <memory>
#include <stdexcept>

#include "curtain_sim/scene_yaml.h"

namespace curtain_bench {
namespace {

using curtain::Scene;
using curtain::Vec3;

constexpr double kNever = 1e6;  // [s]

// The cheapest motion there is, against which an idle feature weighs most: gravity alone, 44 x 40 nodes, one thread;
// and nothing of it falls asleep.
Play swing() {
  const auto reading = curtain::readSceneFile(std::string(CURTAIN_SOURCE_DIR) + "/test/scenes/swing.yaml");
  if (!reading.problems.empty()) throw std::runtime_error(curtain::describe(reading.problems));
  Play play{reading.scene, nullptr};
  play.scene.solver.threads = 1;
  play.scene.solver.rest_speed = 0.0;
  return play;
}

Play gathered() {
  Play play = swing();
  play.scene.hang.to = Vec3(0.6, 0.0, 0.0);
  play.scene.hang.tilt = 0.0;
  play.scene.air.inside = play.scene.air.border = play.scene.air.corner = 0.2;
  curtain::WindParams fan;
  fan.id = "fan";
  fan.position = Vec3(0.3, -1.5, -1.0);
  fan.direction = Vec3::UnitY();
  fan.radius = 1.5;
  fan.half_angle = 0.2;
  fan.pressure = 6.0;
  play.scene.wind.push_back(fan);
  return play;
}

// Hangs there, and comes to rest soon.
Play hanging() {
  Play play = swing();
  play.scene.hang.tilt = 0.0;
  play.scene.hang.to = Vec3(0.8, 0.0, 0.0);
  play.scene.air.inside = play.scene.air.border = play.scene.air.corner = 0.5;
  return play;
}

curtain::WindParams fanAt(const Vec3& position, double gusts, const std::string& id = "fan") {
  curtain::WindParams fan;
  fan.id = id;
  fan.position = position;
  fan.direction = Vec3::UnitY();
  fan.radius = 1.0;
  fan.half_angle = 0.1;
  fan.pressure = 5.0;
  fan.unsteadiness = gusts;
  return fan;
}

const Vec3 kBefore(0.5, -3.0, -1.0), kPast(6.0, -3.0, -1.0);  // the cloth, where a fan blows at it or past it

void addBall(Play& play, const Vec3& position, bool mesh = false, const std::string& name = "ball") {
  curtain::ObstacleParams ball;
  ball.name = name;
  ball.radius = 0.3;
  if (mesh) {
    ball.shape = curtain::ShapeKind::kMesh;
    ball.mesh = std::string(CURTAIN_SOURCE_DIR) + "/test/meshes/icosphere.stl";
    ball.scale = Vec3(0.3, 0.3, 0.3);
  }
  ball.pose.position = position;
  play.scene.obstacles.push_back(ball);
}

const Vec3 kInTheWay(0.5, 0.3, -1.6), kBeside(2.2, 0.0, -1.0), kFar(20.0, 0.0, 0.0);

constexpr int kLinks = 30, kRobotFrames = 240;

// Where a link of the robot is, out of reach all around the cloth, in a frame: it moves by 1.5 cm a frame, and turns.
curtain::Pose linkAt(int link, int frame) {
  const double around = 0.21 * link + 0.004 * frame;
  curtain::Pose pose;
  pose.position = Vec3(0.5 + 4.0 * std::cos(around), 4.0 * std::sin(around), 0.1 * link - 2.5);
  pose.orientation = Eigen::AngleAxisd(0.03 * frame, Vec3(0.6, 0.0, 0.8));
  return pose;
}

void addRobot(Play& play, bool moves) {
  for (int link = 0; link < kLinks; ++link) {
    curtain::ObstacleParams box;
    box.name = "link_" + std::to_string(link);
    box.shape = curtain::ShapeKind::kBox;
    box.size = Vec3(0.1, 0.1, 0.3);
    box.pose = linkAt(link, 0);
    play.scene.obstacles.push_back(box);
  }
  if (!moves) return;
  std::vector<curtain::Pose> poses;  // what tf2 would tell is not weighed
  for (int frame = 1; frame <= kRobotFrames; ++frame) {
    for (int link = 0; link < kLinks; ++link) poses.push_back(linkAt(link, frame));
  }
  play.each_frame = [poses, next = std::size_t{0}](curtain::Simulator& simulator) mutable {
    for (int link = 0; link < kLinks; ++link) simulator.setObstaclePose(link, poses.at(next++));
  };
}

void addDrag(Play& play, bool spring, double start) {
  curtain::DragParams hand;
  hand.id = "hand";
  hand.node = curtain::NodeIndex{43, 20};
  hand.force = Vec3(0.0, 0.5, 0.0);
  if (spring) hand.target = Vec3(0.5, 0.0, -1.8);
  hand.radius = 0.1;
  hand.start = start;
  play.scene.drag.push_back(hand);
}

void addHand(Play& play, double start) {
  curtain::HandParams hand;
  hand.grasp.id = "hand";
  hand.grasp.region = curtain::GraspRegion::kNodes;
  hand.grasp.nodes = {{43, 0}};
  hand.start = start;
  hand.end = 2.0 * kNever;
  play.scene.hands.push_back(hand);
}

// A cloth like the first behind it, out of its reach for as long as both swing.
void addLayer(Play& play) {
  const Scene& scene = play.scene;
  curtain::LayerParams layer;
  layer.name = "behind";
  layer.cloth = scene.cloth;
  layer.hang = scene.hang;
  layer.hang.from.y() += 0.5;
  layer.hang.to.y() += 0.5;
  layer.pins = scene.pins;
  play.scene.layers.push_back(layer);
}

// The same two cloths, each simulated by itself.
Play apart() {
  Play play = swing();
  Scene behind = play.scene;
  behind.hang.from.y() += 0.5;
  behind.hang.to.y() += 0.5;
  play.each_frame = [other = std::make_shared<curtain::Simulator>(behind)](curtain::Simulator&) { other->step(); };
  return play;
}

Play layered() {
  Play play = swing();
  addLayer(play);
  return play;
}

void damp(Play& play, double coefficient, double fast_gain) {
  play.scene.air.inside = play.scene.air.border = play.scene.air.corner = coefficient;
  play.scene.air.fast_gain = fast_gain;
}

void movePins(Play& play) {
  play.each_frame = [frame = 0](curtain::Simulator& simulator) mutable {
    ++frame;
    for (int j = 0; j < simulator.columns(); ++j) {
      simulator.movePin({0, j}, {static_cast<double>(j) / (simulator.columns() - 1), 0.005 * frame, 0.0});
    }
  };
}

void makeMesh(Play& play) {
  play.each_frame = [mesh = curtain::FineMesh()](curtain::Simulator& simulator) mutable {
    simulator.copyFineMesh(mesh);
  };
}

void copyState(Play& play) {
  play.each_frame = [values = std::vector<Vec3>()](curtain::Simulator& simulator) mutable {
    simulator.copyPositions(values);
    simulator.copyVelocities(values);
    simulator.copyForces(values);
  };
}

std::vector<Feature> makeFeatures() {
  std::vector<Feature> all;
  const auto add = [&all](const std::string& name, const Play& off, const std::string& idle_is,
                          std::function<void(Play&)> idle, const std::string& active_is,
                          std::function<void(Play&)> active) -> Feature& {
    Feature feature;
    feature.name = name;
    feature.off = off;
    feature.idle_is = idle_is;
    feature.make_idle = std::move(idle);
    feature.active_is = active_is;
    feature.make_active = std::move(active);
    all.push_back(feature);
    return all.back();
  };
  add(
      "wind steady", swing(), "blows past", [](Play& p) { p.scene.wind.push_back(fanAt(kPast, 0.0)); }, "blows at it",
      [](Play& p) { p.scene.wind.push_back(fanAt(kBefore, 0.0)); });
  add(
      "wind gusts", swing(), "starts later",
      [](Play& p) {
        p.scene.wind.push_back(fanAt(kBefore, 4.0));
        p.scene.wind.back().start = kNever;
      },
      "blows at it", [](Play& p) { p.scene.wind.push_back(fanAt(kBefore, 4.0)); });
  add(
      "winds: ten", swing(), "blow past",
      [](Play& p) {
        for (int n = 0; n < 10; ++n) p.scene.wind.push_back(fanAt(kPast + n * Vec3::UnitX(), 4.0, std::to_string(n)));
      },
      "", nullptr);
  add(
      "air damping linear", swing(), "coefficients 0", [](Play& p) { p.scene.air.threshold = 1e3; }, "0.2",
      [](Play& p) {
        damp(p, 0.2, 0.0);
        p.scene.air.threshold = 1e3;
      });
  add(
      "air damping quadratic", swing(), "coefficients 0", [](Play& p) { damp(p, 0.0, 1.0); }, "0.2",
      [](Play& p) { damp(p, 0.2, 1.0); });
  add(
      "drag force", swing(), "starts later", [](Play& p) { addDrag(p, false, kNever); }, "pulls",
      [](Play& p) { addDrag(p, false, 0.0); });
  add(
      "drag spring", swing(), "starts later", [](Play& p) { addDrag(p, true, kNever); }, "pulls",
      [](Play& p) { addDrag(p, true, 0.0); });
  add(
      "hand of the scene", swing(), "takes hold later", [](Play& p) { addHand(p, kNever); }, "holds a corner",
      [](Play& p) { addHand(p, 0.0); });
  add("pins moved", swing(), "", nullptr, "at 0.3 m/s", movePins);
  add(
      "obstacle sphere", swing(), "beside it", [](Play& p) { addBall(p, kBeside); }, "in its way",
      [](Play& p) { addBall(p, kInTheWay); });
  add(
      "obstacle mesh", swing(), "beside it", [](Play& p) { addBall(p, kBeside, true); }, "in its way",
      [](Play& p) { addBall(p, kInTheWay, true); });
  add(
      "obstacles: ten", swing(), "far away",
      [](Play& p) {
        for (int n = 0; n < 10; ++n) addBall(p, kFar + n * Vec3::UnitX(), false, std::to_string(n));
      },
      "nine far away; one in its way",
      [](Play& p) {
        for (int n = 0; n < 9; ++n) addBall(p, kFar + n * Vec3::UnitX(), false, std::to_string(n));
        addBall(p, kInTheWay);
      });
  add(
      "robot: thirty links", swing(), "stand around it", [](Play& p) { addRobot(p, false); }, "", nullptr);
  add(
      "robot: thirty links move", gathered(), "move around it", [](Play& p) { addRobot(p, true); }, "", nullptr);
  // The swing's frame is a fifteenth of a blown curtain's: thirty poses, each taken, joined to the last one by a curve
  // whether or not anything is near, boxed and left again, are 8 % of it, beside what the first obstacle costs.
  // Measured 1.101; before the swing's own frame fell by 31 % the same was 1.070.
  add(
      "robot: thirty links move past a swing", swing(), "move around it", [](Play& p) { addRobot(p, true); }, "",
      nullptr)
      .max_idle = 1.11;
  // That nothing touches must be proved anew of every substep, from nodes in every second row and every row's ends and
  // middle (cloth_flatness.h, 8 % of the swing); where the swing bends too much for that proof, in every twentieth
  // substep, all nodes are looked at (6 %). Measured 1.144.
  add(
      "self-contact", swing(), "the cloth is flat", [](Play& p) { p.scene.contact.self = true; }, "", nullptr)
      .max_idle = 1.16;
  add("self-contact: gathered to 60 %", gathered(), "", nullptr, "on", [](Play& p) { p.scene.contact.self = true; });
  add("layers: each by itself", apart(), "", nullptr, "two cloths in one scene; apart", [](Play& p) {
    p.each_frame = nullptr;
    addLayer(p);
  }).nodes *= 2;
  // That nothing touches is proved of each cloth as of one alone, and by a plane between the two (flat_cloths.h). In
  // every twentieth substep, where the swing bends too much for that, the search looks at all nodes: what is beside the
  // gap in the grid, which is of both cloths, costs more there than one cloth does. Measured 1.760.
  Feature& flat_layers = add(
      "layers: self-contact", layered(), "two flat cloths apart", [](Play& p) { p.scene.contact.self = true; }, "",
      nullptr);
  flat_layers.nodes *= 2;
  flat_layers.max_idle = 1.82;
  add(
      "folds: second layer", swing(), "not looked at", [](Play& p) { p.scene.cloth.folds = 6; },
      "fine mesh every frame",
      [](Play& p) {
        p.scene.cloth.folds = 6;
        makeMesh(p);
      });
  add("position_tolerance", swing(), "", nullptr, "0.1 mm a second",
      [](Play& p) { p.scene.solver.position_tolerance = 1e-4; });
  const auto rests = [](Play& p) { p.scene.solver.rest_speed = curtain::SolverParams().rest_speed; };
  add("rest", swing(), "nothing rests", rests, "", nullptr);
  add("rest: all sleeps", hanging(), "", nullptr, "asleep", rests).warm_up = 90;
  add(
      "budget", swing(), "never reached", [](Play& p) { p.scene.solver.budget_ms = 1e5; }, "", nullptr);
  add(
      "porosity", swing(), "without wind", [](Play& p) { p.scene.cloth.porosity = 0.5; }, "", nullptr);
  add("state copied", swing(), "", nullptr, "positions; velocities; forces", copyState);
  return all;
}

}  // namespace

const char* stateName(FeatureState state) {
  switch (state) {
    case FeatureState::kOff:
      return "off";
    case FeatureState::kIdle:
      return "idle";
    case FeatureState::kActive:
      return "active";
  }
  return "";
}

bool Feature::has(FeatureState state) const {
  return state == FeatureState::kOff || (state == FeatureState::kIdle ? make_idle != nullptr : make_active != nullptr);
}

Play Feature::play(FeatureState state) const {
  Play play = off;
  if (state == FeatureState::kIdle) make_idle(play);
  if (state == FeatureState::kActive) make_active(play);
  return play;
}

const std::vector<Feature>& features() {
  static const std::vector<Feature> all = makeFeatures();
  return all;
}

const Feature& featureOf(const std::string& name) {
  for (const Feature& feature : features()) {
    if (feature.name == name) return feature;
  }
  throw std::invalid_argument("no feature '" + name + "'");
}

}  // namespace curtain_bench
