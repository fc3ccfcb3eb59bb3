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
#include "drawn/scene_maker.h"
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

/// Small cloth with some of everything.
inline curtain::Scene randomScene(Random& random) {
  for (;;) {
    std::optional<curtain::Scene> scene = makeScene(random, Manner::kEveryday, 14);
    if (!scene) continue;
    for (curtain::ObstacleParams& obstacle : scene->obstacles) obstacle.mesh = resolveTestMesh(obstacle.mesh);
    scene->solver.threads = random.integer(1, 2);
    if (random.chance(0.3)) scene->solver.max_substeps = random.integer(16, 128);
    if (mayBegin(*scene)) return *scene;
  }
}

inline curtain::Vec3 nearCloth(Random& random, const curtain::Simulator& simulator, double far) {
  return simulator.position({simulator.rows() / 2, simulator.columns() / 2}) + random.inBox(far);
}

template <typename Source>
Source randomSource(Random& random, const std::string& key, const std::string& id,
                    const curtain::Simulator& simulator) {
  Source source;
  SceneMaker(random, Manner::kEveryday).make(key, source);
  source.id = id;
  source.start += simulator.time();
  source.end += source.start;
  return source;
}

inline curtain::WindParams randomWind(Random& random, const std::string& id, const curtain::Simulator& simulator) {
  auto wind = randomSource<curtain::WindParams>(random, "wind[]", id, simulator);
  wind.direction = random.direction();
  wind.position = nearCloth(random, simulator, 0.3) - wind.direction;
  return wind;
}

inline curtain::DragParams randomDrag(Random& random, const std::string& id, const curtain::Simulator& simulator) {
  auto drag = randomSource<curtain::DragParams>(random, "drag[]", id, simulator);
  drag.path.clear();
  drag.node.reset();
  drag.point.reset();
  if (random.oneIn(2))
    drag.node = curtain::NodeIndex{random.integer(0, simulator.rows() - 1), random.integer(0, simulator.columns() - 1)};
  else
    drag.point = nearCloth(random, simulator, 0.5);
  if (drag.target) drag.target = nearCloth(random, simulator, 0.7);
  return drag;
}

inline curtain::Pose randomPose(Random& random, const curtain::Simulator& simulator) {
  return {nearCloth(random, simulator, 0.5),
          curtain::Rotation(Eigen::AngleAxisd(random.between(0.0, 3.0), random.direction()))};
}

/// A hand near a node, of any kind that the method knows.
inline curtain::GraspParams randomGrasp(Random& random, const std::string& id, const curtain::Simulator& simulator) {
  const double size = simulator.scene().cloth.height;
  const curtain::NodeIndex node{random.integer(0, simulator.rows() - 1), random.integer(0, simulator.columns() - 1)};
  curtain::GraspParams grasp;
  grasp.id = id;
  grasp.frame.position = simulator.position(node) + random.inBox(0.02 * size);
  grasp.frame.orientation = Eigen::AngleAxisd(random.between(0.0, 3.0), random.direction());
  grasp.region = random.chance(0.7) ? curtain::GraspRegion::kSphere : curtain::GraspRegion::kBox;
  grasp.radius = random.between(0.03, 0.2) * size;
  grasp.size = curtain::Vec3::Constant(grasp.radius);
  if (simulator.scene().solver.method == curtain::Method::kPaper) return grasp;
  if (random.chance(0.3)) grasp.stiffness = std::exp(random.between(0.0, 9.0));
  if (random.chance(0.3)) grasp.pinch_force = std::exp(random.between(-3.0, 3.0));
  if (random.chance(0.5)) grasp.break_force = std::exp(random.between(-1.0, 4.0));
  return grasp;
}

/// Hands take hold, move and let go.
inline void moveHands(curtain::Simulator& simulator, Random& random, double often) {
  const std::string id = "hand" + std::to_string(random.integer(1, 3));
  if (random.chance(0.5 * often)) simulator.setGrasp(randomGrasp(random, id, simulator));
  if (random.chance(0.1 * often)) simulator.releaseGrasp(id);
  for (const std::string& hand : simulator.grasps()) {
    const curtain::GraspState state = *simulator.graspState(hand);
    if (state.nodes.empty() || random.chance(0.3)) continue;
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
    while (random.chance(often)) {
      const std::string id = std::to_string(random.integer(1, 2));
      const int obstacle = simulator.obstacleCount() > 0 ? random.integer(0, simulator.obstacleCount() - 1) : -1;
      switch (random.integer(0, 10)) {
        case 0:
          EXPECT_TRUE(simulator.setWind(randomWind(random, "wind" + id, simulator)).empty());
          break;
        case 1:
          simulator.removeWind("wind" + id);
          break;
        case 2:
          EXPECT_TRUE(simulator.setDrag(randomDrag(random, "drag" + id, simulator)).empty());
          break;
        case 3:
          simulator.removeDrag("drag" + id);
          break;
        case 4:
          simulator.setGravity(random.chance(0.2) ? Vec3(Vec3::Zero())
                                                  : Vec3(Vec3(0.0, 0.0, -9.0) + random.inBox(2.0)));
          break;
        case 5: {
          curtain::AirParams air = simulator.scene().air;
          if (air.law == curtain::AirLaw::kRelative)
            air.normal_drag = random.between(0.0, 2.0);
          else
            air.inside = air.border = random.between(0.0, 2.0);
          EXPECT_TRUE(simulator.setAir(air).empty());
          break;
        }
        case 6:
        case 7:
          if (obstacle < 0) break;
          simulator.setObstaclePose(obstacle, randomPose(random, simulator), random.chance(0.3));
          break;
        case 8:
          if (obstacle < 0) break;
          if (!simulator.obstaclePresent(obstacle))
            simulator.setObstaclePose(obstacle, randomPose(random, simulator), true);
          simulator.setObstaclePresent(obstacle, !simulator.obstaclePresent(obstacle));
          break;
        default: {
          const curtain::NodeIndex node{0, random.integer(0, simulator.columns() - 1)};
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
