// SPDX-License-Identifier: BSD-3-Clause
//
// Simulators that are compared frame by frame, and random scenes with random things done to them from outside.
#pragma once

#include <gtest/gtest.h>

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
  // A new one is to be compared here, or it is a computing time; and to be carried by snapshots.
  static_assert(sizeof(curtain::Statistics) == 312, "statistics have changed");
  EXPECT_EQ(a.frames, b.frames);
  EXPECT_EQ(a.time, b.time);
  EXPECT_EQ(a.substeps, b.substeps);
  EXPECT_EQ(a.substeps_last, b.substeps_last);
  EXPECT_EQ(a.sweeps, b.sweeps);
  EXPECT_EQ(a.sweeps_last, b.sweeps_last);
  EXPECT_EQ(a.rejected, b.rejected);
  EXPECT_EQ(a.implicit, b.implicit);
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
  EXPECT_TRUE(sameBits(a.warp_stretch, b.warp_stretch));
  EXPECT_TRUE(sameBits(a.weft_stretch, b.weft_stretch));
  EXPECT_TRUE(sameBits(a.warp_compression, b.warp_compression));
  EXPECT_TRUE(sameBits(a.warp_stretch_max, b.warp_stretch_max));
  EXPECT_TRUE(sameBits(a.weft_stretch_max, b.weft_stretch_max));
  EXPECT_TRUE(sameBits(a.warp_compression_max, b.warp_compression_max));
  EXPECT_EQ(a.contacts, b.contacts);
  EXPECT_EQ(a.contacts_max, b.contacts_max);
  EXPECT_EQ(a.penetration_max, b.penetration_max);
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

  explicit Reading(const curtain::Simulator& of) : plan(describe(of.plan())) {
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
  EXPECT_EQ(p.obstacles, q.obstacles);
}

inline void restoreOrFail(curtain::Simulator& simulator, const std::string& snapshot) {
  const std::vector<curtain::Problem> problems = simulator.restore(snapshot);
  ASSERT_TRUE(problems.empty()) << describe(problems);
}

/// Two simulators go on side by side; stops at the first difference.
inline void expectSameMotion(curtain::Simulator& a, curtain::Simulator& b, const Deeds& deeds, int from, int to) {
  ASSERT_EQ(a.stateHash(), b.stateHash()) << "before frame " << from;
  for (int frame = from; frame < to; ++frame) {
    run(a, deeds, frame, frame + 1);
    run(b, deeds, frame, frame + 1);
    ASSERT_EQ(a.stateHash(), b.stateHash()) << "frame " << frame;
    expectSameStatistics(a.statistics(), b.statistics());
    ASSERT_FALSE(testing::Test::HasFailure()) << "frame " << frame;
  }
}

/// A simulator that is saved after so many frames goes on as one that never was, and so do one restored afresh and one that had
/// another life before.
struct Life {
  Deeds deeds = doNothing;
  Deeds other = doNothing;  ///< deeds of the life before
  int saved_at = 20;
  int end = 40;
  int other_frames = 15;
};

inline void expectContinues(const curtain::Scene& scene, const Life& life) {
  curtain::Simulator never_saved(scene), saved(scene), restored(scene), lived(scene);
  run(never_saved, life.deeds, 0, life.saved_at);
  run(saved, life.deeds, 0, life.saved_at);
  run(lived, life.other, 0, life.other_frames);
  const std::uint64_t revision = lived.revision();
  const std::string snapshot = saved.snapshot();
  ASSERT_NO_FATAL_FAILURE(restoreOrFail(restored, snapshot));
  ASSERT_NO_FATAL_FAILURE(restoreOrFail(lived, snapshot));
  EXPECT_NE(lived.revision(), revision);
  EXPECT_EQ(restored.snapshot() == snapshot, true) << "what was restored is saved as it was";
  expectSameStatistics(saved.statistics(), restored.statistics());
  {
    SCOPED_TRACE("saved");
    ASSERT_NO_FATAL_FAILURE(expectSameMotion(never_saved, saved, life.deeds, life.saved_at, life.end));
  }
  curtain::Simulator again(scene);
  run(again, life.deeds, 0, life.saved_at);
  {
    SCOPED_TRACE("restored");
    ASSERT_NO_FATAL_FAILURE(expectSameMotion(again, restored, life.deeds, life.saved_at, life.end));
    expectSameReading(again, restored);
  }
  SCOPED_TRACE("lived");
  curtain::Simulator reader(scene);
  ASSERT_NO_FATAL_FAILURE(restoreOrFail(reader, snapshot));
  expectSameReading(reader, lived);
  curtain::Simulator once_more(scene);
  run(once_more, life.deeds, 0, life.saved_at);
  expectSameReading(once_more, reader);
  curtain::Simulator quiet(scene);
  ASSERT_NO_FATAL_FAILURE(restoreOrFail(quiet, snapshot));
  ASSERT_NO_FATAL_FAILURE(expectSameMotion(quiet, lived, life.deeds, life.saved_at, life.end));
}

}  // namespace curtain_test
