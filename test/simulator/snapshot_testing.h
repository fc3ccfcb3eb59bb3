// SPDX-License-Identifier: BSD-3-Clause
//
// Simulators that are compared frame by frame, and random scenes with random things done to them from outside.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "curtain_sim/simulator.h"
#include "testing.h"

namespace curtain_test {

/// What is done from outside before this frame.
using Deeds = std::function<void(curtain::Simulator&, int frame)>;

inline void doNothing(curtain::Simulator&, int) {}

inline void run(curtain::Simulator& simulator, const Deeds& deeds, int from, int to) {
  for (int frame = from; frame < to; ++frame) {
    deeds(simulator, frame);
    simulator.step();
  }
}

inline bool sameBits(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }

/// Every statistic but computing times.
inline void expectSameStatistics(const curtain::Statistics& a, const curtain::Statistics& b) {
  // A new one is to be compared here, or it is a computing time; and to be serialized in snapshots.
  static_assert(sizeof(curtain::Statistics) == 368, "statistics have changed");
  EXPECT_EQ(a.frames, b.frames);
  EXPECT_EQ(a.time, b.time);
  EXPECT_EQ(a.substeps, b.substeps);
  EXPECT_EQ(a.substeps_last, b.substeps_last);
  EXPECT_EQ(a.sweeps, b.sweeps);
  EXPECT_EQ(a.sweeps_last, b.sweeps_last);
  EXPECT_EQ(a.rejected, b.rejected);
  EXPECT_EQ(a.last_resort_substeps, b.last_resort_substeps);
  EXPECT_EQ(a.unsettled, b.unsettled);
  EXPECT_EQ(a.asleep_frames, b.asleep_frames);
  EXPECT_EQ(a.wakes, b.wakes);
  EXPECT_EQ(a.asleep, b.asleep);
  EXPECT_EQ(a.estimates_skipped, b.estimates_skipped);
  EXPECT_EQ(a.longer_substeps, b.longer_substeps);
  EXPECT_EQ(a.unfinished_substeps, b.unfinished_substeps);
  EXPECT_EQ(a.shortened_frames, b.shortened_frames);
  EXPECT_EQ(a.lost_time, b.lost_time);
  EXPECT_EQ(a.late_frames, b.late_frames);
  EXPECT_EQ(a.stops, b.stops);
  EXPECT_EQ(a.stops_last, b.stops_last);
  EXPECT_EQ(a.momentum_cut, b.momentum_cut);
  EXPECT_EQ(a.momentum_cut_last, b.momentum_cut_last);
  EXPECT_EQ(a.quality, b.quality);
  EXPECT_EQ(a.obstacles_waited, b.obstacles_waited);
  EXPECT_TRUE(sameBits(a.warp_stretch, b.warp_stretch));
  EXPECT_TRUE(sameBits(a.weft_stretch, b.weft_stretch));
  EXPECT_TRUE(sameBits(a.warp_compression, b.warp_compression));
  EXPECT_TRUE(sameBits(a.warp_stretch_max, b.warp_stretch_max));
  EXPECT_TRUE(sameBits(a.weft_stretch_max, b.weft_stretch_max));
  EXPECT_TRUE(sameBits(a.warp_compression_max, b.warp_compression_max));
  EXPECT_EQ(a.contacts, b.contacts);
  EXPECT_EQ(a.contacts_max, b.contacts_max);
  EXPECT_EQ(a.penetration_max, b.penetration_max);
  EXPECT_EQ(a.opening, b.opening);
  EXPECT_EQ(a.drive_force, b.drive_force);
  EXPECT_EQ(a.position_error, b.position_error);
  EXPECT_EQ(a.finite, b.finite);
}

/// What a simulator tells of itself, apart from statistics.
struct Reading {
  std::vector<curtain::Vec3> positions, velocities, forces, fine;
  std::string plan;
  double kinetic, potential;
  std::vector<curtain::Vec3> wrenches;
  std::vector<std::string> sources;
  std::vector<double> obstacles;
  std::vector<curtain::Vec3> pulls;

  explicit Reading(const curtain::Simulator& of) {
    curtain::Plan entries = of.plan();
    entries.erase(
        std::remove_if(entries.begin(), entries.end(), [](const auto& entry) { return entry.stage == "threads"; }),
        entries.end());
    plan = describe(entries);
    of.copyPositions(positions);
    of.copyVelocities(velocities);
    of.copyForces(forces);
    curtain::FineMesh mesh;
    of.copyFineMesh(mesh);
    fine = mesh.positions;
    kinetic = of.energy().kinetic;
    potential = of.energy().potential;
    for (int n = 0; n < of.obstacleCount(); ++n) {
      const curtain::ContactWrench wrench = of.contactWrench(n);
      wrenches.insert(wrenches.end(), {wrench.force, wrench.torque});
      const curtain::Pose& pose = of.obstaclePose(n);
      obstacles.insert(obstacles.end(), {pose.position.x(), pose.position.y(), pose.position.z(), pose.orientation.x(),
                                         pose.orientation.y(), pose.orientation.z(), pose.orientation.w(),
                                         of.obstaclePresent(n) ? 1.0 : 0.0, static_cast<double>(wrench.contacts)});
    }
    for (const curtain::WindParams& wind : of.winds()) sources.push_back(wind.id + std::to_string(wind.pressure));
    for (const curtain::DragParams& drag : of.drags()) sources.push_back(drag.id + std::to_string(drag.force.norm()));
    for (const std::string& id : of.grasps()) {
      const curtain::GraspState state = *of.graspState(id);
      sources.push_back(id + std::to_string(state.nodes.size()) + " " + std::to_string(static_cast<int>(state.end)));
      pulls.insert(pulls.end(), {state.force, state.torque, curtain::Vec3::Constant(state.slipped)});
    }
    const curtain::Vec3 gravity = of.scene().gravity;
    obstacles.insert(obstacles.end(), {gravity.x(), gravity.y(), gravity.z(), of.scene().air.inside, of.time()});
  }
};

inline void expectSameReading(const curtain::Simulator& a, const curtain::Simulator& b) {
  const Reading p(a), q(b);
  EXPECT_EQ(p.positions, q.positions);
  EXPECT_EQ(p.velocities, q.velocities);
  EXPECT_EQ(p.forces, q.forces);
  EXPECT_EQ(p.fine, q.fine);
  EXPECT_EQ(p.plan, q.plan);
  EXPECT_EQ(p.kinetic, q.kinetic);
  EXPECT_EQ(p.potential, q.potential);
  EXPECT_EQ(p.wrenches, q.wrenches);
  EXPECT_EQ(p.sources, q.sources);
  EXPECT_EQ(p.pulls, q.pulls);
  EXPECT_EQ(p.obstacles, q.obstacles);
}

inline void restoreOrFail(curtain::Simulator& simulator, const std::string& snapshot) {
  const std::vector<curtain::Problem> problems = simulator.restore(snapshot);
  ASSERT_TRUE(problems.empty()) << describe(problems);
}

/// A simulator that is saved after so many frames, and what is to be done in the next one is known, goes on as one that
/// never was; and so do one restored afresh and one that had another life before. The one that was saved is looked at
/// all the time.
struct Life {
  Deeds deeds = doNothing;
  Deeds other = doNothing;  ///< of the life before
  int saved_at = 20;
  int end = 40;
  int other_frames = 15;
};

inline void expectContinues(const curtain::Scene& scene, const Life& life, const curtain::Scene& restored_scene) {
  using curtain::Simulator;
  Simulator never_saved(scene), saved(scene), restored(restored_scene), lived(restored_scene);
  const auto live = [&](Simulator& simulator) {
    run(simulator, life.deeds, 0, life.saved_at);
    life.deeds(simulator, life.saved_at);
  };
  live(never_saved);
  live(saved);
  run(lived, life.other, 0, life.other_frames);
  const std::uint64_t revision = lived.revision();
  const std::string snapshot = saved.snapshot();
  ASSERT_TRUE(saved.statistics().finite);
  ASSERT_NO_FATAL_FAILURE(restoreOrFail(restored, snapshot));
  ASSERT_NO_FATAL_FAILURE(restoreOrFail(lived, snapshot));
  EXPECT_NE(lived.revision(), revision);
  expectSameStatistics(saved.statistics(), restored.statistics());
  const std::string once_more = restored.snapshot();
  for (int frame = life.saved_at; frame < life.end; ++frame) {
    for (Simulator* simulator : {&never_saved, &saved, &restored, &lived}) {
      if (frame > life.saved_at) life.deeds(*simulator, frame);
      simulator->step();
    }
    ASSERT_EQ(never_saved.stateHash(), saved.stateHash()) << "saving or looking has changed frame " << frame;
    ASSERT_EQ(saved.stateHash(), restored.stateHash()) << "restored afresh, frame " << frame;
    ASSERT_EQ(saved.stateHash(), lived.stateHash()) << "restored after another life, frame " << frame;
    for (const Simulator* simulator : {&saved, &restored, &lived}) {
      expectSameStatistics(never_saved.statistics(), simulator->statistics());
    }
    ASSERT_FALSE(testing::Test::HasFailure()) << "statistics of frame " << frame;
    const Reading look(saved);
  }
  // Readers, of the state at the end and of that restored.
  expectSameReading(never_saved, restored);
  expectSameReading(never_saved, lived);
  Simulator then(scene);
  live(then);
  for (Simulator* simulator : {&restored, &lived}) {
    ASSERT_NO_FATAL_FAILURE(restoreOrFail(*simulator, once_more));
    expectSameReading(then, *simulator);
  }
}

inline void expectContinues(const curtain::Scene& scene, const Life& life) { expectContinues(scene, life, scene); }

/// Whole numbers from [low, high].
inline int pick(Random& random, int low, int high) {
  return low + static_cast<int>(random.between(0.0, 1.0) * (high - low + 1));
}
inline bool chance(Random& random, double share) { return random.between(0.0, 1.0) < share; }

inline curtain::WindParams randomWind(Random& random, const std::string& id, double start) {
  curtain::WindParams wind;
  wind.id = id;
  wind.position = curtain::Vec3(0.5, chance(random, 0.5) ? -1.0 : 1.0, 1.5) + random.inBox(0.3);
  wind.direction = curtain::Vec3(0.5, 0.0, 1.5) + random.inBox(0.3) - wind.position;
  wind.radius = random.between(0.1, 1.5);
  wind.half_angle = chance(random, 0.5) ? 0.0 : random.between(0.0, 0.5);
  wind.pressure = chance(random, 0.8) ? random.between(0.0, 30.0) : 0.0;
  wind.unsteadiness = chance(random, 0.5) ? random.between(0.0, 10.0) : 0.0;
  wind.correlation_time = random.between(0.02, 0.5);
  wind.start = start + (chance(random, 0.5) ? 0.0 : random.between(0.0, 0.3));
  if (chance(random, 0.4)) wind.end = wind.start + random.between(0.05, 0.5);
  return wind;
}

inline curtain::DragParams randomDrag(Random& random, const std::string& id, double start,
                                      const curtain::ClothParams& cloth) {
  curtain::DragParams drag;
  drag.id = id;
  if (chance(random, 0.5))
    drag.node = curtain::NodeIndex{pick(random, 0, cloth.rows - 1), pick(random, 0, cloth.columns - 1)};
  else
    drag.point = curtain::Vec3(0.5, 0.0, 1.5) + random.inBox(0.5);
  if (chance(random, 0.5))
    drag.force = random.inBox(1.0);
  else
    drag.target = curtain::Vec3(0.5, 0.0, 1.5) + random.inBox(0.7);
  drag.radius = chance(random, 0.5) ? 0.0 : random.between(0.0, 0.4);
  drag.start = start + (chance(random, 0.5) ? 0.0 : random.between(0.0, 0.3));
  if (chance(random, 0.4)) drag.end = drag.start + random.between(0.05, 0.5);
  return drag;
}

inline curtain::Pose randomPose(Random& random) {
  curtain::Pose pose;
  pose.position = curtain::Vec3(0.5, 0.0, 1.5) + random.inBox(0.5);
  pose.orientation = Eigen::AngleAxisd(random.between(0.0, 3.0), random.direction());
  return pose;
}

inline curtain::ObstacleParams randomObstacle(Random& random, const std::string& name) {
  using curtain::ShapeKind;
  curtain::ObstacleParams obstacle;
  obstacle.name = name;
  obstacle.pose = randomPose(random);
  obstacle.shape = static_cast<ShapeKind>(pick(random, 0, 5));
  obstacle.radius = random.between(0.05, 0.25);
  obstacle.length = random.between(0.1, 0.5);
  obstacle.size = curtain::Vec3::Constant(0.3) + random.inBox(0.15);
  if (obstacle.shape == ShapeKind::kMesh) {
    const char* const mesh = chance(random, 0.5) ? "cube_quads" : "l_prism";
    obstacle.mesh = std::string(CURTAIN_SOURCE_DIR) + "/test/meshes/" + mesh + ".obj";
    obstacle.scale = curtain::Vec3::Constant(random.between(0.1, 0.4));
  }
  if (obstacle.shape == ShapeKind::kPlane) {
    obstacle.pose.position.z() = random.between(0.8, 1.4);
    obstacle.pose.orientation.setIdentity();
  }
  if (chance(random, 0.4)) {
    obstacle.motion = {{0.0, obstacle.pose}, {random.between(0.2, 0.6), randomPose(random)}, {1.0, randomPose(random)}};
  }
  return obstacle;
}

/// Small cloth 1 m x 1 m or so, hung at a height of 2 m, with some of everything.
inline curtain::Scene randomScene(Random& random) {
  using namespace curtain;
  Scene scene = flatScene(pick(random, 2, 18), pick(random, 3, 20));
  scene.cloth.closed = chance(random, 0.2);
  scene.hang.from = {0.0, 0.0, 2.0};
  scene.hang.to = {scene.cloth.closed || chance(random, 0.3) ? 1.0 : random.between(0.5, 0.98), 0.0, 2.0};
  scene.hang.tilt = scene.cloth.closed ? 0.0 : chance(random, 0.3) ? 0.0 : random.between(0.0, 1.5);
  scene.pins.kind =
      chance(random, 0.7) ? PinKind::kTop : static_cast<PinKind>(pick(random, 0, scene.cloth.closed ? 0 : 3));
  if (chance(random, 0.6)) scene.air.inside = scene.air.border = scene.air.corner = random.between(0.0, 3.0);
  for (int n = pick(random, -1, 2); n > 0; --n)
    scene.wind.push_back(randomWind(random, "wind" + std::to_string(n), 0.0));
  for (int n = pick(random, -1, 2); n > 0; --n) {
    scene.drag.push_back(randomDrag(random, "drag" + std::to_string(n), 0.0, scene.cloth));
  }
  for (int n = pick(random, -1, 2); n > 0; --n)
    scene.obstacles.push_back(randomObstacle(random, "thing" + std::to_string(n)));
  scene.contact.self = chance(random, 0.5);
  scene.contact.thickness = random.between(0.002, 0.02);
  scene.contact.friction = chance(random, 0.7) ? random.between(0.0, 1.0) : 0.0;
  scene.solver.method = chance(random, 0.5) ? Method::kAuto : static_cast<Method>(pick(random, 0, 5));
  if (chance(random, 0.3)) scene.solver.substeps = pick(random, 1, 12);
  if (chance(random, 0.25)) scene.solver.position_tolerance = random.between(1e-4, 1e-2);
  if (chance(random, 0.3)) scene.solver.rest_speed = random.between(0.01, 1.0);
  scene.solver.threads = pick(random, 1, 2);
  scene.solver.max_substeps = pick(random, 16, 128);
  scene.solver.frame_rate = chance(random, 0.7) ? 60.0 : random.between(20.0, 120.0);
  return scene;
}

/// A hand near a node, of any kind that the method knows.
inline curtain::GraspParams randomGrasp(Random& random, const std::string& id, const curtain::Simulator& simulator) {
  const double size = simulator.scene().cloth.height;
  const curtain::NodeIndex node{pick(random, 0, simulator.rows() - 1), pick(random, 0, simulator.columns() - 1)};
  curtain::GraspParams grasp;
  grasp.id = id;
  grasp.frame.position = simulator.position(node) + random.inBox(0.02 * size);
  grasp.frame.orientation = Eigen::AngleAxisd(random.between(0.0, 3.0), random.direction());
  grasp.region = chance(random, 0.7) ? curtain::GraspRegion::kSphere : curtain::GraspRegion::kBox;
  grasp.radius = random.between(0.03, 0.2) * size;
  grasp.size = curtain::Vec3::Constant(grasp.radius);
  if (simulator.scene().solver.method == curtain::Method::kPaper) return grasp;
  if (chance(random, 0.3)) grasp.stiffness = std::exp(random.between(0.0, 9.0));
  if (chance(random, 0.3)) grasp.pinch_force = std::exp(random.between(-3.0, 3.0));
  if (chance(random, 0.5)) grasp.break_force = std::exp(random.between(-1.0, 4.0));
  return grasp;
}

/// Hands take hold, move and let go.
inline void moveHands(curtain::Simulator& simulator, Random& random, double often) {
  const std::string id = "hand" + std::to_string(pick(random, 1, 3));
  if (chance(random, 0.5 * often)) simulator.setGrasp(randomGrasp(random, id, simulator));
  if (chance(random, 0.1 * often)) simulator.releaseGrasp(id);
  for (const std::string& hand : simulator.grasps()) {
    const curtain::GraspState state = *simulator.graspState(hand);
    if (state.nodes.empty() || chance(random, 0.3)) continue;
    curtain::Pose pose;
    pose.position = simulator.position(state.nodes.front()) + random.inBox(0.03);
    pose.orientation = Eigen::AngleAxisd(random.between(-0.2, 0.2), random.direction());
    simulator.moveGrasp(hand, pose);
  }
}

/// Now and then something from outside; the same for the same seed and frame, whoever it is done to.
inline Deeds randomDeeds(std::uint64_t seed, double often) {
  return [=](curtain::Simulator& simulator, int frame) {
    using curtain::Vec3;
    Random random(seed * 1000003U + static_cast<std::uint64_t>(frame));
    const double now = simulator.time();
    while (chance(random, often)) {
      const std::string id = std::to_string(pick(random, 1, 2));
      const int obstacle = simulator.obstacleCount() > 0 ? pick(random, 0, simulator.obstacleCount() - 1) : -1;
      switch (pick(random, 0, 10)) {
        case 0:
          EXPECT_TRUE(simulator.setWind(randomWind(random, "wind" + id, now)).empty());
          break;
        case 1:
          simulator.removeWind("wind" + id);
          break;
        case 2:
          EXPECT_TRUE(simulator.setDrag(randomDrag(random, "drag" + id, now, simulator.scene().cloth)).empty());
          break;
        case 3:
          simulator.removeDrag("drag" + id);
          break;
        case 4:
          simulator.setGravity(chance(random, 0.2) ? Vec3(Vec3::Zero())
                                                   : Vec3(Vec3(0.0, 0.0, -9.0) + random.inBox(2.0)));
          break;
        case 5: {
          curtain::AirParams air = simulator.scene().air;
          air.inside = air.border = random.between(0.0, 2.0);
          EXPECT_TRUE(simulator.setAir(air).empty());
          break;
        }
        case 6:
        case 7:
          if (obstacle < 0) break;
          simulator.setObstaclePose(obstacle, randomPose(random), chance(random, 0.3));
          break;
        case 8:
          if (obstacle < 0) break;
          if (!simulator.obstaclePresent(obstacle)) simulator.setObstaclePose(obstacle, randomPose(random), true);
          simulator.setObstaclePresent(obstacle, !simulator.obstaclePresent(obstacle));
          break;
        default: {
          const curtain::NodeIndex node{0, pick(random, 0, simulator.columns() - 1)};
          simulator.movePin(node, simulator.position(node) + random.inBox(0.05));
        }
      }
    }
    // By dice of their own: the rest stays as it was before there were hands.
    Random hands(seed * 1000003U + static_cast<std::uint64_t>(frame) + (std::uint64_t{1} << 60U));
    if (seed % 2 == 0) moveHands(simulator, hands, often);
  };
}

}  // namespace curtain_test
