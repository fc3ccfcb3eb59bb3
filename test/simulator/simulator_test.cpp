// SPDX-License-Identifier: BSD-3-Clause
//
// The simulator as a whole: it conserves what it must and repeats itself to the bit.
#include "curtain_sim/simulator.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "simulator/scenes.h"

namespace curtain {
namespace {

using curtain_test::run;
using curtain_test::sceneOf;
using curtain_test::shippedScene;

TEST(Simulator, RefusesABadSceneNamingEveryProblem) {
  Scene scene = sceneOf(1, 5);
  scene.cloth.height = -1.0;
  try {
    const Simulator simulator(scene);
    FAIL() << "accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("cloth.rows"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("cloth.height"), std::string::npos) << error.what();
  }
}

// Leapfrog is exact for a constant force: z = -g t^2 / 2 to rounding, a few ulps a substep of a number of size 10.
TEST(Simulator, AFreeSheetFallsFreely) {
  Scene scene = sceneOf(8, 7);
  scene.pins.kind = PinKind::kNone;
  scene.hang.tilt = 0.3;
  Simulator simulator(scene);
  std::vector<Vec3> start, end, velocity;
  simulator.copyPositions(start);
  run(simulator, 60);
  simulator.copyPositions(end);
  simulator.copyVelocities(velocity);
  for (std::size_t n = 0; n < start.size(); ++n) {
    EXPECT_LT((end[n] - start[n] - Vec3(0.0, 0.0, -0.5 * 9.81)).norm(), 1e-11);
    EXPECT_LT((velocity[n] - Vec3(0.0, 0.0, -9.81)).norm(), 1e-11);
  }
}

// A free cloth in still air keeps its momentum: forces between nodes come in pairs. The wind's push is taken back out
// by comparing with the sum of the forces it reports; rounding only.
TEST(Simulator, AFreeClothKeepsItsMomentum) {
  Scene scene = sceneOf(12, 9);
  scene.pins.kind = PinKind::kNone;
  scene.gravity = Vec3::Zero();
  DragParams pull;
  pull.id = "pull";
  pull.node = NodeIndex{3, 2};
  pull.force = Vec3(0.02, 0.05, -0.01);
  pull.end = 0.25;
  scene.drag.push_back(pull);
  Simulator simulator(scene);
  run(simulator, 90);
  std::vector<Vec3> velocity;
  simulator.copyVelocities(velocity);
  Vec3 momentum = Vec3::Zero();
  for (int i = 0; i < 12; ++i) {
    for (int j = 0; j < 9; ++j) {
      momentum += simulator.mass({i, j}) * velocity[static_cast<std::size_t>(i * 9 + j)];
    }
  }
  // The force acted for 0.25 s, up to the substep in which it ended (at most 1/60 s).
  EXPECT_NEAR(momentum.norm() / (0.25 * pull.force.norm()), 1.0, 1.0 / 15.0);
  EXPECT_LT(momentum.cross(pull.force).norm(), 1e-12);
}

// A symplectic scheme has no drift of energy: over 20 s of undamped swing at 8 substeps it only wavers with the square
// of the step. Scale: the energy that goes to and fro, m g L (1 - cos 45) / 2.
TEST(Simulator, UndampedSwingKeepsItsEnergy) {
  Scene scene = readSceneFile(std::string(CURTAIN_SOURCE_DIR) + "/test/scenes/swing.yaml").scene;
  scene.cloth.columns = 2;
  scene.solver.substeps = 8;
  Simulator simulator(scene);
  const double start = simulator.energy().potential;
  run(simulator, 1200);
  const Energy end = simulator.energy();
  const double scale = 0.4 * 9.81 * 2.0 * (1.0 - std::cos(0.785)) / 2.0;
  std::printf("energy drift over 20 s: %.2e of the swing's energy\n", (end.kinetic + end.potential - start) / scale);
  EXPECT_LT(std::abs(end.kinetic + end.potential - start), 1e-3 * scale);
}

TEST(Simulator, RepeatsItselfToTheBit) {
  for (const char* name : {"curtain", "flag", "skirt", "parachute", "sheet"}) {
    const Scene scene = shippedScene(name);
    Simulator first(scene), second(scene);
    run(first, 40);
    run(second, 40);
    EXPECT_EQ(first.stateHash(), second.stateHash()) << name;
    second.reset();
    EXPECT_NE(first.stateHash(), second.stateHash()) << name;
    run(second, 40);
    EXPECT_EQ(first.stateHash(), second.stateHash()) << name << " after reset";
    Scene other = scene;
    other.solver.seed += 1;
    Simulator third(other);
    run(third, 40);
    EXPECT_NE(first.stateHash(), third.stateHash()) << name << ": the seed changes nothing";
  }
}

TEST(Simulator, ReadingTheStateDoesNotChangeTheMotion) {
  Simulator read(shippedScene("curtain")), unread(shippedScene("curtain"));
  std::vector<Vec3> out;
  FineMesh mesh;
  for (int frame = 0; frame < 30; ++frame) {
    read.step();
    unread.step();
    read.copyVelocities(out);
    read.copyForces(out);
    read.copyFineMesh(mesh);
    read.energy();
  }
  EXPECT_EQ(read.stateHash(), unread.stateHash());
}

// A scene that is its own mirror image moves like it. The rows' solves run from left to right, so only rounding
// differs. The strings' corrections are made in single precision: 6e-8 of moves of at most a hundredth of a link (4e-11
// m), in some 100 substeps, growing by e a tenth of a second at most (the fastest free motion) over the half second
// looked at: 6e-8 m.
TEST(Simulator, KeepsMirrorSymmetry) {
  Scene scene = sceneOf(20, 15);
  scene.hang.from = Vec3(-0.4, 0.0, 2.2);
  scene.hang.to = Vec3(0.4, 0.0, 2.2);
  WindParams wind;
  wind.id = "fan";
  wind.position = Vec3(0.0, -1.0, 1.2);
  wind.direction = Vec3::UnitY();
  wind.half_angle = 0.2;
  wind.pressure = 20.0;
  scene.wind.push_back(wind);
  Simulator simulator(scene);
  run(simulator, 30);
  double worst = 0.0;
  for (int i = 0; i < 20; ++i) {
    for (int j = 0; j < 15; ++j) {
      const Vec3 here = simulator.position({i, j});
      const Vec3 there = simulator.position({i, 14 - j});
      worst = std::max(worst, (here - Vec3(-there.x(), there.y(), there.z())).norm());
    }
  }
  EXPECT_LT(worst, 1e-7);
  EXPECT_GT(simulator.position({19, 7}).y(), 0.05);
}

// What the tolerance leaves over must not become motion: a sheet dropped from its corners never has more energy than at
// first (gravity is counted in it; what its snaps take out hides small rises from frame to frame). Bound: what a
// stretch of 1e-3 in the whole cloth is worth, m g L / 1000.
TEST(Simulator, ADroppedSheetNeverHasMoreEnergyThanAtFirst) {
  for (const int n : {5, 8, 12, 20, 30}) {
    for (const double turn : {0.0, -0.01, 0.01}) {  // one motion may be good by luck
      Scene scene = sceneOf(n, n);
      scene.cloth.height = 1.0;
      scene.hang.from = Vec3::Zero();
      scene.hang.to = Vec3(0.9, 0.0, 0.0);
      scene.hang.tilt = 1.5707963267948966 + turn;
      scene.pins.kind = PinKind::kTopCorners;
      Simulator simulator(scene);
      const double start = simulator.energy().potential;
      for (int frame = 0; frame < 180; ++frame) {
        simulator.step();
        const Energy energy = simulator.energy();
        ASSERT_LT(energy.kinetic + energy.potential - start, 0.2 * 9.81 * 1e-3) << n << " rows, frame " << frame;
      }
      EXPECT_EQ(simulator.statistics().unsettled, 0) << n << " rows";
    }
  }
}

// At rest the spring pulls with stiffness times way, whatever the substeps: its force is the one that holds the cloth.
TEST(Simulator, ASpringHoldsWithItsStiffness) {
  Vec3 first = Vec3::Zero();
  for (const int substeps : {1, 16, 64}) {
    Scene scene = sceneOf(12, 12);
    scene.cloth.height = 1.0;
    scene.air.inside = scene.air.border = scene.air.corner = 1.0;
    scene.solver.substeps = substeps;
    DragParams hand;
    hand.id = "hand";
    hand.node = NodeIndex{11, 6};
    hand.target = Vec3(0.5, -0.5, 1.4);
    hand.stiffness = 20.0;
    scene.drag.push_back(hand);
    Simulator simulator(scene);
    run(simulator, 900);
    // Means over two seconds: the node trembles by what the tolerance leaves over, and its damping answers that.
    Vec3 way = Vec3::Zero(), pull = Vec3::Zero();
    std::vector<Vec3> force;
    for (int frame = 0; frame < 120; ++frame) {
      simulator.step();
      simulator.copyForces(force);
      way += (*hand.target - simulator.position({11, 6})) / 120.0;
      // The node's own weight is in the force too.
      pull += (force[11 * 12 + 6] + Vec3(0.0, 0.0, 9.81 * simulator.mass({11, 6}))) / 120.0;
    }
    std::printf("substeps %d: %.4f N, stiffness times way %.4f N\n", substeps, pull.norm(),
                hand.stiffness * way.norm());
    EXPECT_NEAR(pull.norm(), hand.stiffness * way.norm(), 0.05 * hand.stiffness * way.norm()) << substeps;
    EXPECT_GT(hand.stiffness * way.norm(), 0.1);
    // And the place does not depend on the substeps, but for the links' tolerance of 1 mm in the metre.
    if (substeps == 1) first = simulator.position({11, 6});
    EXPECT_LT((simulator.position({11, 6}) - first).norm(), 2e-3) << substeps;
  }
}

// Of forces beyond all numbers no more acts than the links bear; when they are over the cloth goes on.
TEST(Simulator, AForceBeyondNumbersIsSurvived) {
  Scene scene = sceneOf(10, 8);
  DragParams blow;
  blow.id = "blow";
  blow.node = NodeIndex{9, 4};
  blow.force = Vec3(0.0, 1e100, 0.0);
  blow.start = 0.1;
  blow.end = 0.11;
  scene.drag.push_back(blow);
  Simulator simulator(scene);
  double cut = 0.0;
  for (int frame = 0; frame < 12; ++frame) {
    const std::int64_t last_resort = simulator.statistics().last_resort_substeps;
    simulator.step();
    cut += simulator.statistics().momentum_cut_last;
    EXPECT_EQ(simulator.statistics().quality >= FrameQuality::kBounded,
              simulator.statistics().last_resort_substeps > last_resort);
  }
  EXPECT_GT(simulator.statistics().last_resort_substeps, 0);
  EXPECT_GT(simulator.statistics().momentum_cut, 1e90);
  EXPECT_NEAR(cut / simulator.statistics().momentum_cut, 1.0, 1e-12);
  EXPECT_LE(simulator.statistics().weft_stretch_max, scene.solver.stretch_tolerance);
  EXPECT_LE(simulator.statistics().warp_stretch_max, scene.solver.stretch_tolerance);
  DragParams pull;
  pull.id = "pull";
  pull.node = NodeIndex{9, 0};
  pull.force = Vec3(0.0, 0.5, 0.0);
  simulator.clearDrags();
  ASSERT_TRUE(simulator.setDrag(pull).empty());
  run(simulator, 30);
  EXPECT_TRUE(simulator.statistics().finite);
  EXPECT_TRUE(std::isfinite(simulator.energy().kinetic));
  EXPECT_GT(simulator.position({9, 0}).y(), 0.01);
}

// The least-step safety net: at one substep a frame the leapfrog solve of a tall cloth fails, is done again with
// smaller steps, and is counted.
TEST(Simulator, ASubstepThatFailsIsDoneAgainSmaller) {
  Scene scene = readSceneFile(std::string(CURTAIN_SOURCE_DIR) + "/test/scenes/swing.yaml").scene;
  scene.cloth.rows = 100;
  scene.cloth.columns = 3;
  scene.solver.method = Method::kLeapfrog;  // auto makes nodes heavier instead
  scene.solver.substeps = 1;
  Simulator simulator(scene);
  run(simulator, 60);
  EXPECT_GT(simulator.statistics().rejected, 0);
  EXPECT_TRUE(simulator.statistics().finite);
  EXPECT_LE(simulator.statistics().warp_stretch_max, 1e-3);
}

// The implicit scheme is stable at any step: 200 rows at one substep a frame (dt * omega about 9) only lose energy.
TEST(Simulator, ImplicitIsStableFarBeyondTheLeapfrogLimit) {
  Scene scene = readSceneFile(std::string(CURTAIN_SOURCE_DIR) + "/test/scenes/swing.yaml").scene;
  scene.cloth.rows = 200;
  scene.cloth.columns = 3;
  scene.solver.method = Method::kImplicit;
  scene.solver.substeps = 1;
  Simulator simulator(scene);
  double last = simulator.energy().potential;
  for (int frame = 0; frame < 300; ++frame) {
    simulator.step();
    const Energy energy = simulator.energy();
    // It may waver by the tolerance's share of the potential energy, no more.
    ASSERT_LT(energy.kinetic + energy.potential, last + 1e-3 * 0.4 * 9.81 * 2.0) << "frame " << frame;
    last = energy.kinetic + energy.potential;
  }
}

// At the cap of substeps auto has heavier nodes rather than a step too large for them: links hold, and it needs no last
// resort.
TEST(Simulator, AtTheCapAutoHoldsWithHeavierNodes) {
  Scene scene = readSceneFile(std::string(CURTAIN_SOURCE_DIR) + "/test/scenes/swing.yaml").scene;
  scene.cloth.rows = 200;
  scene.cloth.columns = 3;
  scene.solver.max_substeps = 4;
  Simulator simulator(scene);
  run(simulator, 60);
  EXPECT_EQ(simulator.statistics().last_resort_substeps, 0);
  EXPECT_TRUE(simulator.statistics().finite);
  EXPECT_LE(simulator.statistics().warp_stretch_max, 1e-3);
}

}  // namespace
}  // namespace curtain
