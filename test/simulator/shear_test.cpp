// SPDX-License-Identifier: BSD-3-Clause
//
// Cloth that resists shear: it hangs in folds where limp cloth collapses, keeps
// its energy, and no step is too long.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "curtain_sim/plan.h"
#include "curtain_sim/simulator.h"
#include "figures.h"
#include "scene/pi.h"
#include "testing.h"

namespace curtain {
namespace {

using curtain_test::kPi;

// 1.5 m of cloth gathered to 0.9 m, hung by every third node, blown for 1.5 s.
Scene gatheredScene(double shear) {
  Scene scene = curtain_test::flatScene(20, 31, 1.2, 1.5);
  scene.cloth.surface_density = 0.2;
  scene.cloth.bending_warp = scene.cloth.bending_weft = 1e-5;
  scene.cloth.shear = shear;
  scene.hang.from = Vec3(0.0, 0.0, 2.2);
  scene.hang.to = Vec3(0.9, 0.0, 2.2);
  scene.pins.kind = PinKind::kList;
  for (int j = 0; j < 31; j += 3) scene.pins.nodes.push_back({0, j});
  scene.air.inside = scene.air.border = scene.air.corner = 0.3;
  scene.contact.self = true;
  WindParams fan = curtain_test::fanAt({0.45, -1.5, 1.6}, 1.5);
  fan.half_angle = 0.2;
  fan.pressure = 5.0;
  fan.unsteadiness = 3.0;
  fan.end = 1.5;
  scene.wind = {fan};
  return scene;
}

// Depth of folds: what nodes are off the vertical plane through the ends of the
// hung edge, RMS, below the first folds.
double depthOf(const Simulator& simulator) {
  double squares = 0.0;
  int count = 0;
  for (int i = 5; i < simulator.rows(); ++i) {
    double mean = 0.0;
    for (int j = 0; j < simulator.columns(); ++j) mean += simulator.position({i, j}).y() / simulator.columns();
    for (int j = 0; j < simulator.columns(); ++j, ++count)
      squares += std::pow(simulator.position({i, j}).y() - mean, 2);
  }
  return std::sqrt(squares / count);
}

// Mean length of the weft links, over that at rest.
double weftsOf(const Simulator& simulator) {
  const double rest = simulator.scene().cloth.width / (simulator.columns() - 1);
  double sum = 0.0;
  for (int i = 0; i < simulator.rows(); ++i) {
    for (int j = 1; j < simulator.columns(); ++j)
      sum += (simulator.position({i, j}) - simulator.position({i, j - 1})).norm() / rest;
  }
  return sum / (simulator.rows() * (simulator.columns() - 1));
}

TEST(Shear, GatheredClothHangsInFolds) {
  for (const Method method : {Method::kAuto, Method::kImplicit}) {
    Scene scene = gatheredScene(10.0);
    scene.solver.method = method;
    Simulator simulator(scene);
    for (int frame = 0; frame < 240; ++frame) simulator.step();
    EXPECT_GT(depthOf(simulator), 0.02) << toString(method);  // 2 mm without, some 30 mm with
    EXPECT_GT(weftsOf(simulator), 0.98) << toString(method);
    EXPECT_EQ(simulator.selfCrossings(), 0) << toString(method);
    EXPECT_EQ(simulator.statistics().last_resort_substeps, 0) << toString(method);
  }
  Simulator limp(gatheredScene(0.0));
  for (int frame = 0; frame < 240; ++frame) limp.step();
  EXPECT_LT(depthOf(limp), 0.01);
}

// Energy at the start that the cloth could move by [J]: that of what bends. For
// rods hang plumb, and columns between pins are let down by shear to where that
// costs as much as their weight gains, and has taken half of it.
double freeEnergy(const Simulator& simulator) {
  const ClothParams& cloth = simulator.scene().cloth;
  const double top = simulator.scene().hang.from.z();
  double energy = simulator.energy().potential;
  for (int i = 0; i < simulator.rows(); ++i) {
    const double plumb = top - cloth.height * i / (simulator.rows() - 1);
    for (int j = 0; j < simulator.columns(); ++j)
      energy -= simulator.mass({i, j}) * 9.81 * (plumb - 0.5 * (top - simulator.position({0, j}).z()));
  }
  return energy;
}

// It starts in folds, whose wefts are as long as they are. Laid flat these
// would have pi^2 B / l^2 of each square metre's shortening; of a
// sine-generated curve with 3 links a fold bending is 0.13 of that.
TEST(Shear, GatheredClothStartsAtRest) {
  Scene scene = gatheredScene(10.0);
  scene.wind.clear();
  Simulator simulator(scene);
  EXPECT_GT(depthOf(simulator), 0.02);
  EXPECT_GT(weftsOf(simulator), 1.0 - 1e-9);
  EXPECT_EQ(simulator.selfCrossings(), 0);
  const double free = freeEnergy(simulator);
  const double link = 1.5 / 30.0, push = kPi * kPi * 1e-5 / (link * link);
  EXPECT_LT(free, 0.25 * push * (1.0 - 0.6) * 1.2 * 1.5);
  for (int frame = 0; frame < 60; ++frame) {
    simulator.step();
    ASSERT_LT(simulator.energy().kinetic, free) << "frame " << frame;
  }
  for (int frame = 60; frame < 600 && !simulator.statistics().asleep; ++frame) simulator.step();
  curtain_test::keepFigure("gathered cloth with shear, asleep after [s]", simulator.time());
  curtain_test::keepFigure("gathered cloth with shear, folds at rest [mm]", 1e3 * depthOf(simulator));
  EXPECT_TRUE(simulator.statistics().asleep);
  EXPECT_GT(depthOf(simulator), 0.02);
  EXPECT_GT(weftsOf(simulator), 0.98);
  EXPECT_EQ(simulator.statistics().wakes, 0);
}

// Of any fullness, hung by columns with 0.2 m of cloth between them at most:
// nothing crosses, and it moves by no more than the energy of its folds. Wider
// pieces are too heavy for their wefts' push, and sink between the pins.
TEST(Shear, RandomGatheredClothStartsAtRest) {
  curtain_test::Random random(46);
  for (int trial = 0; trial < 12; ++trial) {
    SCOPED_TRACE(trial);
    const int rows = static_cast<int>(random.between(8.0, 30.0)),
              columns = static_cast<int>(random.between(24.0, 48.0));
    const double height = random.between(0.8, 2.0), width = random.between(0.8, 1.2);
    Scene scene = curtain_test::flatScene(rows, columns, height, width);
    scene.cloth.surface_density = random.between(0.1, 0.4);
    scene.cloth.bending_warp = scene.cloth.bending_weft = std::pow(10.0, random.between(-5.5, -4.0));
    scene.cloth.shear = random.between(3.0, 50.0);
    scene.hang.to.x() = width * random.between(0.4, 0.95);
    scene.air.inside = scene.air.border = scene.air.corner = 0.3;
    scene.contact.self = true;
    scene.pins.kind = PinKind::kList;
    const int every = static_cast<int>(random.between(2.0, 5.0));
    for (int j = 0; j < columns; j += every) scene.pins.nodes.push_back({0, j});
    scene.pins.nodes.push_back({0, columns - 1});
    Simulator simulator(scene);
    EXPECT_EQ(simulator.selfCrossings(), 0);
    EXPECT_LT(1.0 - weftsOf(simulator), 0.5 * (1.0 - scene.hang.to.x() / width)) << "laid flat it is all of that";
    const double free = freeEnergy(simulator);
    for (int frame = 0; frame < 60; ++frame) {
      simulator.step();
      ASSERT_LT(simulator.energy().kinetic, free) << "frame " << frame;
    }
    EXPECT_EQ(simulator.selfCrossings(), 0);
    EXPECT_EQ(simulator.statistics().last_resort_substeps, 0);
  }
}

// Tensions of mass-scaled nodes take less of a step than without; what they
// leave shear is all that it needs. Were it softer in some of the substeps,
// cloth that hangs would shake.
TEST(Shear, IsAsStiffBesideScaledMasses) {
  Scene scene = curtain_test::flatScene(60, 24, 2.0, 0.5);
  scene.cloth.surface_density = 0.2;
  scene.cloth.bending_warp = scene.cloth.bending_weft = 1e-5;
  scene.cloth.shear = 10.0;
  scene.pins.kind = PinKind::kTopCorners;
  scene.hang.to.x() = 0.4;
  Simulator simulator(scene);
  for (int frame = 0; frame < 60; ++frame) {
    simulator.step();
    ASSERT_EQ(describe(simulator.plan()).find("bear a part"), std::string::npos) << "frame " << frame;
  }
}

// A sheet that is let go, hung by its upper corners: weight, shear and bending
// alone.
Scene swingScene() {
  Scene scene = curtain_test::flatScene(16, 17, 1.0, 1.0);
  scene.cloth.bending_warp = scene.cloth.bending_weft = 1e-5;
  scene.cloth.shear = 30.0;
  scene.hang.to.x() = 0.9;  // a straight row between two pins is another matter
  scene.hang.tilt = 1.0;
  scene.pins.kind = PinKind::kTopCorners;
  return scene;
}

// Leapfrog's energy wavers, by 1e-2 m g H at most before what is above the
// start is taken out.
TEST(Shear, MakesNoEnergy) {
  Simulator simulator(swingScene());
  double mass = 0.0;
  for (int i = 0; i < 16; ++i) {
    for (int j = 0; j < 17; ++j) mass += simulator.mass({i, j});
  }
  const auto energy = [&] { return simulator.energy().kinetic + simulator.energy().potential; };
  const double start = energy(), allowed = 1e-2 * mass * 9.81;
  for (int frame = 0; frame < 300; ++frame) {
    simulator.step();
    ASSERT_LT(energy(), start + allowed) << "frame " << frame;
  }
  EXPECT_EQ(simulator.statistics().last_resort_substeps, 0);
}

// A sheet that hangs by its corners, where nodes are mass-scaled: it trembled at 50 mm/s while the substeps bore more
// or less of its stiffness by their tensions.
TEST(Shear, ComesToRest) {
  Scene scene = swingScene();
  scene.cloth.rows = 20;
  scene.cloth.columns = 21;
  scene.hang.tilt = 0.3;
  scene.cloth.shear = 10.0;
  scene.cloth.bending_bias = 1e-5;  // without twist it has two shapes of rest, 0.2 mJ apart
  scene.air.inside = scene.air.border = scene.air.corner = 1.0;
  scene.solver.rest_speed = 0.0;
  scene.solver.stretch_tolerance = 1e-5;
  Simulator simulator(scene);
  scene.solver.substeps = 64;
  Simulator fine(scene);
  for (int frame = 0; frame < 1200; ++frame) {
    simulator.step();
    fine.step();
  }
  EXPECT_LT(simulator.energy().kinetic, 1e-9 * 0.2 * 9.81);
  // And nowhere else than with shorter steps: links of 5 cm keep their lengths to 5e-7 m.
  double off = 0.0;
  for (int i = 0; i < 20; ++i) {
    for (int j = 0; j < 21; ++j) off = std::max(off, (simulator.position({i, j}) - fine.position({i, j})).norm());
  }
  EXPECT_LT(off, 1e-6);
}

// Its works close: what is left over is what links that snap taut take, which is never negative.
TEST(Shear, IsInTheBooks) {
  Simulator simulator(swingScene());
  simulator.countWork(true);
  for (int frame = 0; frame < 20; ++frame) simulator.step();
  const Work work = simulator.work();
  EXPECT_NE(work.elastic, 0.0);
  EXPECT_EQ(work.forces, 0.0);
  EXPECT_LE(work.kinetic - work.gravity - work.elastic, 1e-2 * std::abs(work.gravity));
}

// Fixed substeps that are too long for it are divided; where even the most are,
// it is no stiffer than they bear.
TEST(Shear, IsStableInAnyStep) {
  for (const double rigidity : {100.0, 1e5}) {
    for (const Method method : {Method::kLeapfrog, Method::kImplicit, Method::kAuto}) {
      Scene scene = swingScene();
      scene.cloth.shear = rigidity;
      scene.solver.method = method;
      scene.solver.substeps = 2;
      Simulator simulator(scene);
      const auto energy = [&] { return simulator.energy().kinetic + simulator.energy().potential; };
      const double start = energy();
      for (int frame = 0; frame < 60; ++frame) {
        simulator.step();
        ASSERT_LT(energy(), start + 1e-2 * 0.2 * 9.81) << toString(method) << ", frame " << frame;
      }
      EXPECT_EQ(simulator.statistics().last_resort_substeps, 0) << toString(method);
      const std::string plan = describe(simulator.plan());
      EXPECT_EQ(plan.find("of which the substeps bear a part") != std::string::npos, rigidity > 1e3) << plan;
    }
  }
}

// A strip of weft, clamped at one end and pressed at the other: 0.4 m of 20 links. Where its end is [m], and how long
// its links are, over their rest.
struct PressedStrip {
  Vec3 end;
  double wefts;
};

PressedStrip press(double load, double shear) {
  Scene scene = curtain_test::flatScene(2, 22, 0.1, 0.42);
  scene.cloth.bending_weft = 1e-2;
  scene.cloth.shear = shear;
  scene.cloth.surface_density = 0.1;
  scene.hang.from = Vec3(-0.02, 0.0, 0.0);
  scene.hang.to = Vec3(0.4, 0.0, 0.0);
  scene.gravity = Vec3::Zero();
  scene.pins.kind = PinKind::kList;
  scene.pins.nodes = {{0, 0}, {1, 0}, {0, 1}, {1, 1}};
  scene.air.inside = scene.air.border = scene.air.corner = 1.0;
  scene.solver.rest_speed = 0.0;
  for (const int row : {0, 1}) {
    DragParams drag;
    drag.id = std::to_string(row);
    drag.node = {row, 21};
    drag.force = Vec3(-0.5 * load, 5e-4 * load, 0.0);  // a thousandth aside, which says to which side it buckles
    scene.drag.push_back(drag);
  }
  Simulator simulator(scene);
  for (int frame = 0; frame < 900; ++frame) simulator.step();
  double sum = 0.0;
  for (int j = 2; j < 22; ++j) sum += (simulator.position({0, j}) - simulator.position({0, j - 1})).norm();
  return {simulator.position({0, 21}), sum / 0.4};
}

// pi^2 B w / (4 L^2) is its own Euler load. Below it stays straight but for the side load, which the press magnifies by
// 1 / (1 - 0.9); at 1.152 of it the elastica's end is at 0.741 L and 0.593 L (Timoshenko, Gere, Theory of Elastic
// Stability, 1961, Table 2-4). 20 links are a continuum to (pi / 40)^2 / 3, the side load is worth a thousandth or two.
// Without push its links shorten, under any load.
TEST(WeftPush, CarriesAStripUpToItsOwnEulerLoad) {
  const double euler = kPi * kPi * 1e-2 * 0.1 / (4.0 * 0.4 * 0.4);
  const PressedStrip below = press(0.9 * euler, 100.0), beyond = press(1.152 * euler, 100.0),
                     slack = press(0.5 * euler, 0.0);
  EXPECT_NEAR(below.end.x(), 0.4, 1e-3 * 0.4);
  EXPECT_NEAR(below.end.y(), 0.0, 0.02 * 0.4);
  EXPECT_NEAR(below.wefts, 1.0, 1e-4);
  EXPECT_NEAR(beyond.end.x(), 0.741 * 0.4, 0.01 * 0.4);
  EXPECT_NEAR(beyond.end.y(), 0.593 * 0.4, 0.01 * 0.4);
  EXPECT_NEAR(beyond.wefts, 1.0, 1e-4);
  EXPECT_LT(slack.wefts, 0.7);
}

TEST(Shear, HasTheSameBitsWithAnyThreads) {
  std::vector<std::uint64_t> hashes;
  for (const int threads : {1, 2, 3}) {
    Scene scene = gatheredScene(10.0);
    scene.solver.threads = threads;
    Simulator simulator(scene);
    for (int frame = 0; frame < 30; ++frame) simulator.step();
    hashes.push_back(simulator.stateHash());
  }
  EXPECT_EQ(hashes[0], hashes[1]);
  EXPECT_EQ(hashes[0], hashes[2]);
}

}  // namespace
}  // namespace curtain
