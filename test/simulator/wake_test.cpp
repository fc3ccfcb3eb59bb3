// SPDX-License-Identifier: BSD-3-Clause
//
// Cloth that sleeps wakes for every cause, not a frame too late. What it does after waking is compared with the same
// cloth that never sleeps: a frame too late would put it off by a frame's way; the places it slept in are off by the
// radius it may stay within, 5e-5 m, and what grows of that.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <functional>
#include <string>
#include <vector>

#include "figures.h"
#include "simulator/sleeping_cloth.h"

namespace curtain {
namespace {

using namespace curtain_test;

struct Cause {
  std::string name;
  std::function<void(Scene&)> prepare;       // the scene
  std::function<void(Simulator&, int)> act;  // called before each frame after it slept; frames since then
  double moves;                              // at least so far within a second [m], or the cause is none
};

void place(Simulator& simulator, const Vec3& obstacle, bool jump = false) {
  Pose pose;
  pose.position = obstacle;
  simulator.setObstaclePose(0, pose, jump);
}

std::vector<Cause> causes() {
  const auto nothing = [](Scene&) {};
  const auto blown = [](Scene& scene) { scene.wind.push_back(fan(3.0)); };
  const auto pulled = [](Scene& scene) { scene.drag.push_back(pull({0.0, 0.05, 0.0})); };
  const auto withBall = [](const Vec3& place) {
    return [place](Scene& scene) { scene.obstacles.push_back(smallBallAt(place)); };
  };
  const auto once = [](auto call) {
    return [call](Simulator& simulator, int frame) {
      if (frame == 0) call(simulator);
    };
  };
  return {
      {"wind from now on", nothing, once([](Simulator& s) { s.setWind(fan(3.0)); }), 0.02},
      {"gusts", nothing, once([](Simulator& s) {
         WindParams wind = fan(0.0);
         wind.unsteadiness = 3.0;
         s.setWind(wind);
       }),
       0.005},
      {"wind that ends", blown, once([](Simulator& s) { s.removeWind("fan"); }), 0.02},
      {"all winds gone", blown, once([](Simulator& s) { s.clearWinds(); }), 0.02},
      {"wind that turns", blown, once([](Simulator& s) {
         WindParams wind = fan(3.0);
         wind.direction = {0.0, 1.0, 0.5};
         s.setWind(wind);
       }),
       0.003},
      {"scripted wind",
       [](Scene& scene) {
         scene.wind.push_back(fan(3.0));
         scene.wind[0].start = 6.005;
       },
       [](Simulator&, int) {}, 0.02},
      {"scripted wind's end",
       [](Scene& scene) {
         scene.wind.push_back(fan(3.0));
         scene.wind[0].end = 6.005;
       },
       [](Simulator&, int) {}, 0.02},
      {"drag", nothing, once([](Simulator& s) {
         s.setDrag(pull({0.0, 0.05, 0.0}));
       }),
       0.01},
      {"drag by a point", nothing, once([](Simulator& s) {
         DragParams drag = pull({0.0, 0.05, 0.0});
         drag.node.reset();
         drag.point = Vec3(0.5, 0.0, 0.2);
         s.setDrag(drag);
       }),
       0.01},
      {"drag let go", pulled, once([](Simulator& s) { s.removeDrag("hand"); }), 0.01},
      {"all drags gone", pulled, once([](Simulator& s) { s.clearDrags(); }), 0.01},
      {"scripted drag",
       [](Scene& scene) {
         scene.drag.push_back(pull({0.0, 0.05, 0.0}));
         scene.drag[0].start = 6.01;
       },
       [](Simulator&, int) {}, 0.01},
      {"pin", nothing,
       [](Simulator& s, int frame) {
         if (frame >= 0) s.movePin({0, 19}, Vec3(0.9 - 0.01 * std::min(frame + 1, 10), 0.0, 1.2));
       },
       0.05},
      {"obstacle", withBall({0.5, -1.0, 0.6}),
       [](Simulator& s, int frame) {
         place(s, {0.5, -1.0 + 0.02 * std::min(frame + 1, 50), 0.6});
       },
       0.1},
      {"obstacle at 30 m/s", withBall({0.5, -2.0, 0.6}),
       [](Simulator& s, int frame) {
         place(s, {0.5, -2.0 + 0.5 * std::min(frame + 1, 4), 0.6});
       },
       0.1},
      {"bar that turns",
       [](Scene& scene) {
         ObstacleParams bar;
         bar.name = "bar";
         bar.shape = ShapeKind::kBox;
         bar.size = {1.2, 0.05, 0.05};
         bar.pose.position = {0.5, -0.4, 0.6};
         scene.obstacles.push_back(bar);
       },
       [](Simulator& s, int frame) {
         Pose pose;
         pose.position = {0.5, -0.4, 0.6};
         pose.orientation = Eigen::AngleAxisd(0.1 * std::min(frame + 1, 30), Vec3::UnitZ());
         s.setObstaclePose(0, pose);
       },
       0.05},
      {"obstacle that appears", withBall({0.5, -0.13, 0.6}),
       [](Simulator& s, int frame) {
         if (frame < 0) s.setObstaclePresent(0, false);
         if (frame == 0) s.setObstaclePresent(0, true);
       },
       0.01},
      {"obstacle that goes", withBall({0.5, -0.1, 0.6}), once([](Simulator& s) { s.setObstaclePresent(0, false); }),
       0.03},
      {"obstacle that leaves", withBall({0.5, -0.1, 0.6}),
       [](Simulator& s, int frame) {
         place(s, {0.5, -0.1 - 0.05 * std::min(std::max(frame + 1, 0), 20), 0.6});
       },
       0.03},
      {"obstacle that is elsewhere at once", withBall({0.5, -0.1, 0.6}), once([](Simulator& s) {
         place(s, {30.0, 0.0, 0.6}, true);
       }),
       0.03},
      {"obstacle that jumps and goes", withBall({0.5, -0.1, 0.6}), once([](Simulator& s) {
         place(s, {30.0, 0.0, 0.6}, true);
         s.setObstaclePresent(0, false);
       }),
       0.03},
      {"scripted obstacle",
       [](Scene& scene) {
         scene.obstacles.push_back(smallBallAt({0.5, -1.0, 0.6}));
         scene.obstacles[0].motion = {{6.0, scene.obstacles[0].pose}, {6.5, scene.obstacles[0].pose}};
         scene.obstacles[0].motion[1].pose.position.y() = 0.0;
       },
       [](Simulator&, int) {}, 0.05},
      {"gravity", nothing, once([](Simulator& s) {
         s.setGravity({0.0, 1.0, -9.81});
       }),
       0.05},
  };
}

struct Comparison {
  // Of the two within the first 12 frames; later on small differences have grown, whatever they came from [m].
  double apart = 0.0;
  double late = 0.0;   // the same, over the way that the other goes in a frame
  double moved = 0.0;  // within a second [m]
};

// A second of both from now on.
Comparison compare(const Cause& cause, Simulator& simulator, Simulator& reference) {
  Comparison result;
  std::vector<Vec3> place, before;
  simulator.copyPositions(place);
  double way = 0.0;
  for (int frame = 0; frame < 60; ++frame) {
    cause.act(simulator, frame);
    cause.act(reference, frame);
    reference.copyPositions(before);
    simulator.step();
    reference.step();
    result.moved = std::max(result.moved, farthestMoved(simulator, place));
    way = std::max(way, farthestMoved(reference, before));
    if (frame >= 12) continue;
    result.apart = std::max(result.apart, farthestApart(simulator, reference));
    if (way > 1e-3) result.late = std::max(result.late, result.apart / way);
  }
  return result;
}

// Until it is due the cloth sleeps; from then on it moves with the one that never slept.
TEST(Wake, InTimeForEveryCause) {
  constexpr int kDue = 360;  // frames: 6 s
  for (const Cause& cause : causes()) {
    Scene scene = hanging();
    cause.prepare(scene);
    Simulator simulator(scene), reference(sleepless(scene));
    cause.act(simulator, -1);
    cause.act(reference, -1);
    run(simulator, kDue);
    run(reference, kDue);
    EXPECT_TRUE(simulator.statistics().asleep) << cause.name;
    const Comparison result = compare(cause, simulator, reference);
    curtain_test::keepFigure("woken cloth, late by frames", result.late);
    EXPECT_LT(result.late, 0.25) << cause.name << ", in frames";
    EXPECT_GT(result.moved, cause.moves) << cause.name;
    EXPECT_GT(simulator.statistics().wakes, 0) << cause.name;
    std::printf("%-24s apart by %.1e m, %.2f frames; moved by %.3f m\n", cause.name.c_str(), result.apart, result.late,
                result.moved);
  }
}

TEST(Wake, WithEveryMethod) {
  const Cause pulled{"pull", [](Scene&) {},
                     [](Simulator& s, int frame) {
                       if (frame == 0) s.setDrag(pull({0.0, 0.05, 0.0}));
                     },
                     0.01};
  for (const Method method : {Method::kAuto, Method::kLeapfrog, Method::kLeapfrog4, Method::kImplicit}) {
    for (const double tolerance : {0.0, 1e-3}) {
      Scene scene = hanging();
      scene.solver.method = method;
      scene.solver.position_tolerance = tolerance;
      scene.solver.stretch_tolerance = 1e-5;  // implicit shakes taut strings by more than a frame's way at 1e-3
      Simulator simulator(scene), reference(sleepless(scene));
      run(simulator, 90);
      run(reference, 90);
      ASSERT_TRUE(simulator.statistics().asleep) << toString(method);
      const Comparison result = compare(pulled, simulator, reference);
      EXPECT_LT(result.late, 0.5) << toString(method) << ", tolerance " << tolerance;
      EXPECT_GT(result.moved, pulled.moves) << toString(method);
      simulator.removeDrag("hand");
      EXPECT_TRUE(sleepsWithin(simulator, 900)) << toString(method) << ", tolerance " << tolerance;
    }
  }
}

TEST(Wake, ResetWakesAndRepeatsToTheBit) {
  Simulator simulator(hanging()), other(hanging());
  run(simulator, 200);
  ASSERT_TRUE(simulator.statistics().asleep);
  simulator.reset();
  EXPECT_FALSE(simulator.statistics().asleep);
  for (int frame = 0; frame < 200; ++frame) {
    simulator.step();
    other.step();
    ASSERT_EQ(simulator.stateHash(), other.stateHash()) << "frame " << frame;
    ASSERT_EQ(simulator.statistics().asleep, other.statistics().asleep);
  }
}

}  // namespace
}  // namespace curtain
