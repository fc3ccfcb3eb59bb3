// SPDX-License-Identifier: BSD-3-Clause
//
// Lines and loads: a load on a rope is a pendulum, hangs with its weight, is caught within the tolerance of the links
// and without energy from nowhere; slack lines pull nothing; a parachute sinks at the speed that its drag asks for.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "curtain_sim/simulator.h"
#include "figures.h"
#include "simulator/scenes.h"
#include "testing.h"

namespace curtain {
namespace {

using curtain_test::energyOf;
using curtain_test::flatScene;
using curtain_test::run;
using curtain_test::shippedScene;

constexpr double kG = 9.81;

LineParams lineFrom(const std::vector<NodeIndex>& nodes) {
  LineParams line;
  line.id = "line";
  line.nodes = nodes;
  return line;
}

// Cloth of 1 x 1 m, gathered to 0.9 m, with a load on 1 m of line at each of these hem nodes.
Scene loadScene(const std::vector<NodeIndex>& nodes, double mass) {
  Scene scene = flatScene(12, 16);
  scene.hang.to.x() = 0.9;
  scene.lines.push_back(lineFrom(nodes));
  scene.lines[0].length = 1.0;
  scene.lines[0].mass = mass;
  return scene;
}

double clothMass(const Simulator& simulator) {
  double sum = 0.0;
  for (int i = 0; i < simulator.rows(); ++i) {
    for (int j = 0; j < simulator.columns(); ++j) sum += simulator.mass({i, j});
  }
  return sum;
}

// Angle of a pendulum of length 1 m after `time`, released at `angle` [rad]: Runge-Kutta in steps of 0.1 ms.
double pendulum(double angle, double time) {
  const double h = 1e-4;
  double speed = 0.0;
  const auto rate = [](double a) { return -kG * std::sin(a); };
  for (long left = std::lround(time / h); left > 0; --left) {
    const double a1 = speed, v1 = rate(angle);
    const double a2 = speed + 0.5 * h * v1, v2 = rate(angle + 0.5 * h * a1);
    const double a3 = speed + 0.5 * h * v2, v3 = rate(angle + 0.5 * h * a2);
    const double a4 = speed + h * v3, v4 = rate(angle + h * a3);
    angle += h / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4);
    speed += h / 6.0 * (v1 + 2.0 * v2 + 2.0 * v3 + v4);
  }
  return angle;
}

// Whether the cloth bends or not, a load falls freely until its line is taut, and then hangs with its weight.
TEST(Lines, ALoadHasItsWeightBelowClothThatBends) {
  for (const double rigidity : {0.0, 2e-5}) {
    Scene scene = loadScene({{11, 8}}, 1.0);
    scene.cloth.bending_warp = scene.cloth.bending_weft = rigidity;
    scene.lines[0].to = scene.hang.from + Vec3(0.45, 0.0, -1.5);  // half a metre of slack
    scene.air.inside = scene.air.border = scene.air.corner = 0.2;
    Simulator simulator(scene);
    const double start = simulator.lineEnd("line")->z();
    run(simulator, 15);
    const double fall = 0.5 * kG * 0.25 * 0.25;
    EXPECT_NEAR(start - simulator.lineEnd("line")->z(), fall, 1e-9) << rigidity;
    Simulator restored(scene);
    ASSERT_TRUE(restored.restore(simulator.snapshot()).empty());
    EXPECT_EQ(energyOf(restored), energyOf(simulator)) << rigidity;
    run(simulator, 900);
    EXPECT_NEAR(simulator.linePull("line").z(), kG, 1e-3 * kG) << rigidity;
  }
}

TEST(Lines, ALoadOnARopeIsAPendulum) {
  const double angle = 0.5;
  Scene scene = flatScene(2, 2);
  scene.lines.push_back(lineFrom({{0, 0}}));
  scene.lines[0].mass = 0.3;
  scene.lines[0].to = scene.hang.from + Vec3(0.0, std::sin(angle), -std::cos(angle));
  scene.solver.substeps = 16;
  Simulator simulator(scene);
  run(simulator, 120);
  // Leapfrog's phase error: (h omega)^2 / 24 of omega t = 6.3, here 1.1e-4 of the amplitude.
  const double omega = std::sqrt(kG), h = 1.0 / (60.0 * 16.0);
  const double error = angle * omega * 2.0 * omega * omega * h * h / 24.0;
  const Vec3 from = *simulator.lineEnd("line") - scene.hang.from;
  EXPECT_NEAR(std::atan2(from.y(), -from.z()), pendulum(angle, 2.0), 2.0 * error + 1e-6);
  EXPECT_NEAR(from.norm(), 1.0, 1e-6);
}

TEST(Lines, AHangingLoadPullsWithItsWeight) {
  Simulator simulator(loadScene({{11, 5}}, 0.2));
  run(simulator, 240);
  const Vec3 pull = simulator.linePull("line");
  // At rest the links are left within 1e-4 of half of their tolerance, 3.3e-9 m; twelve of them add up, over g h^2 of
  // substeps of 3 ms: 4e-4 of the weight.
  curtain_test::keepFigure("load on a line, pull off by", std::abs(pull.z() / (0.2 * kG) - 1.0));
  EXPECT_NEAR(pull.z(), 0.2 * kG, 4e-4 * 0.2 * kG);
  EXPECT_LT(pull.head<2>().norm(), 4e-4 * 0.2 * kG);
  EXPECT_TRUE(simulator.statistics().asleep);
}

TEST(Lines, SeveralLinesCarryALoadTogether) {
  Scene scene = loadScene({{11, 0}, {11, 5}, {11, 10}, {11, 15}}, 0.1);
  scene.air.inside = scene.air.border = scene.air.corner = 1.0;
  Simulator simulator(scene);
  run(simulator, 1200);
  std::vector<double> tensions;
  simulator.copyLineTensions("line", tensions);
  ASSERT_EQ(tensions.size(), 4u);
  const Vec3 pull = simulator.linePull("line");
  EXPECT_NEAR(pull.z(), 0.1 * kG, 1e-3 * 0.1 * kG);
  EXPECT_LT(pull.head<2>().norm(), 1e-2 * 0.1 * kG);
}

// Its own weight is 25 times that of the cloth.
TEST(Lines, AHeavyLoadHangsWithoutBouncing) {
  Simulator simulator(loadScene({{11, 0}, {11, 15}}, 5.0));
  run(simulator, 300);
  double lowest = simulator.lineEnd("line")->z(), highest = lowest, weakest = 1e9, strongest = 0.0;
  for (int frame = 0; frame < 120; ++frame) {
    simulator.step();
    const double z = simulator.lineEnd("line")->z(), pull = simulator.linePull("line").z();
    lowest = std::min(lowest, z);
    highest = std::max(highest, z);
    weakest = std::min(weakest, pull);
    strongest = std::max(strongest, pull);
  }
  curtain_test::keepFigure("heavy load on a line, moves by [um]", 1e6 * (highest - lowest));
  curtain_test::keepFigure("heavy load on a line, pull over its weight", weakest / (5.0 * kG));
  curtain_test::keepFigure("heavy load on a line, pull over its weight", strongest / (5.0 * kG));
  EXPECT_LT(highest - lowest, 1e-3);
  EXPECT_GT(weakest, 0.8 * 5.0 * kG);
  EXPECT_LT(strongest, 1.2 * 5.0 * kG);
  EXPECT_EQ(simulator.statistics().last_resort_substeps, 0);
}

TEST(Lines, AFallingLoadIsCaughtWithinTheToleranceAndWithoutEnergyFromNowhere) {
  for (const Method method : {Method::kAuto, Method::kLeapfrog, Method::kImplicit}) {
    SCOPED_TRACE(toString(method));
    Scene scene = loadScene({{11, 4}, {11, 11}}, 0.4);
    scene.lines[0].to = Vec3(0.45, 0.2, -0.2);
    scene.solver.method = method;
    Simulator simulator(scene);
    const double start = energyOf(simulator);
    const double scale = (clothMass(simulator) + 0.4) * kG;  // of a metre
    std::vector<double> tensions;
    double slack_pull = 0.0;
    for (int frame = 0; frame < 300; ++frame) {
      simulator.step();
      simulator.copyLineTensions("line", tensions);
      for (std::size_t k = 0; k < 2; ++k) {
        const double length = (simulator.position(scene.lines[0].nodes[k]) - *simulator.lineEnd("line")).norm();
        EXPECT_LE(length, 1.0 + scene.solver.stretch_tolerance);
        if (length < 0.99) slack_pull = std::max(slack_pull, tensions[k]);
      }
      ASSERT_LE(energyOf(simulator) - start, 0.01 * scale) << "frame " << frame;
    }
    EXPECT_EQ(slack_pull, 0.0);
    EXPECT_LE(simulator.statistics().weft_stretch_max, scene.solver.stretch_tolerance);
    EXPECT_LT(energyOf(simulator) - start, -0.1 * scale) << "it has fallen, and been caught";
  }
}

// In the glide all of the weight, the load's too, is borne by the air on the cloth.
TEST(Lines, AParachuteSinksAsItsDragAsksFor) {
  Scene scene = shippedScene("parachute_load");
  Simulator simulator(scene);
  run(simulator, 12 * 60);
  const double from = simulator.lineEnd("harness")->z(), cloth = clothMass(simulator) * kG;
  double air = 0.0;
  constexpr int kFrames = 120;
  std::vector<Vec3> forces;
  for (int frame = 0; frame < kFrames; ++frame) {
    simulator.step();
    simulator.copyForces(forces);
    for (const Vec3& force : forces) air += force.z() / kFrames;
  }
  air += cloth;
  curtain_test::keepFigure("parachute, force of the air off by", std::abs((cloth + 0.5 * kG) / air - 1.0));
  EXPECT_NEAR(air, cloth + 0.5 * kG, 0.01 * air);
  EXPECT_NEAR((from - simulator.lineEnd("harness")->z()) / 2.0, 2.29, 0.05);
  EXPECT_NEAR(simulator.linePull("harness").z(), 0.5 * kG, 0.02 * 0.5 * kG);
}

TEST(Lines, AFixedEndIsMovedAndPullsTheCloth) {
  Scene scene = flatScene(8, 6);
  scene.lines.push_back(lineFrom({{7, 0}}));
  scene.lines[0].to = Vec3(-0.5, 0.0, 0.0);
  Simulator simulator(scene);
  run(simulator, 60);
  EXPECT_EQ(*simulator.lineEnd("line"), *scene.lines[0].to);
  EXPECT_FALSE(simulator.setLineEnd("other", Vec3::Zero()));
  EXPECT_FALSE(simulator.setLineEnd("line", Vec3(NAN, 0.0, 0.0)));
  EXPECT_FALSE(simulator.lineEnd("other").has_value());
  simulator.countWork(true);
  Vec3 end = *scene.lines[0].to;
  for (int frame = 0; frame < 60; ++frame) {
    end.x() -= 0.005;
    ASSERT_TRUE(simulator.setLineEnd("line", end));
    simulator.step();
    EXPECT_EQ(*simulator.lineEnd("line"), end);
    EXPECT_LE((simulator.position({7, 0}) - end).norm(), 0.5 * (1.0 + scene.solver.stretch_tolerance));
  }
  EXPECT_GT(simulator.work().pins, 0.0);
  EXPECT_LT(simulator.linePull("line").x() * -1.0, 0.0) << "it is drawn back to the cloth";
}

TEST(Lines, NoEndOfALoadIsMoved) {
  Simulator simulator(loadScene({{11, 5}}, 0.2));
  EXPECT_FALSE(simulator.setLineEnd("line", Vec3::Zero()));
}

TEST(Lines, ALoadThatSwingsKeepsTheClothAwake) {
  Scene scene = flatScene(4, 4);
  scene.pins.kind = PinKind::kList;
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) scene.pins.nodes.push_back({i, j});
  }
  scene.lines.push_back(lineFrom({{3, 0}}));
  scene.lines[0].mass = 0.1;
  scene.lines[0].to = Vec3(0.5, 0.0, -0.5);
  Simulator simulator(scene);
  run(simulator, 600);
  EXPECT_EQ(simulator.statistics().asleep_frames, 0);
}

TEST(Lines, ThePapersSchemeRefusesThem) {
  Scene scene = loadScene({{11, 5}}, 0.2);
  scene.solver.method = Method::kPaper;
  ASSERT_EQ(validate(scene).size(), 1u);
  EXPECT_EQ(validate(scene)[0].key, "solver.method");
  EXPECT_THROW(Simulator{scene}, std::invalid_argument);
}

TEST(Lines, LinesThatAreTooShortAtTheStartAreNamed) {
  Scene scene = loadScene({{11, 5}}, 0.2);
  scene.lines[0].to = Vec3(0.5, 0.0, -1.5);
  try {
    const Simulator simulator(scene);
    FAIL() << "it was taken";
  } catch (const std::invalid_argument& problem) {
    const std::string text = problem.what();
    EXPECT_NE(text.find("lines[0].length: must be at least 1.5"), std::string::npos) << text;
    EXPECT_NE(text.find("lines[0].nodes[0]"), std::string::npos) << text;
  }
}

}  // namespace
}  // namespace curtain
