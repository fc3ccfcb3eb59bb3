// SPDX-License-Identifier: BSD-3-Clause
//
// Cloth that falls asleep and wakes: when nothing moves it, not a frame too late, and without anybody noticing. What it
// does after waking is compared with the same cloth that never sleeps: a frame too late would put it off by a frame's
// way; the places it slept in are off by the radius it may stay within, 5e-5 m, and what grows of that.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <functional>
#include <string>
#include <vector>

#include "curtain_sim/simulator.h"
#include "testing.h"

namespace curtain {
namespace {

using curtain_test::flatScene;

constexpr double kNotLate = 1e-3;  // [m]

// A curtain of 1 m x 1 m, gathered a little, in air that damps what swings within a second. Short substeps: a force
// given from outside acts from half a substep before on what moves (docs/method.md), not on what sleeps.
Scene hanging() {
  Scene scene = flatScene(16, 20);
  scene.hang.from = {0.0, 0.0, 1.2};
  scene.hang.to = {0.9, 0.0, 1.2};
  scene.air.inside = scene.air.border = scene.air.corner = 1.0;
  scene.solver.substeps = 32;
  return scene;
}

Scene sleepless(Scene scene) {
  scene.solver.rest_speed = 0.0;
  return scene;
}

void run(Simulator& simulator, int frames) {
  for (int frame = 0; frame < frames; ++frame) simulator.step();
}

bool sleepsWithin(Simulator& simulator, int frames) {
  for (int frame = 0; frame < frames; ++frame) {
    simulator.step();
    if (simulator.statistics().asleep == simulator.columns()) return true;
  }
  return false;
}

double farthestApart(const Simulator& a, const Simulator& b) {
  std::vector<Vec3> p, q;
  a.copyPositions(p);
  b.copyPositions(q);
  double worst = 0.0;
  for (std::size_t n = 0; n < p.size(); ++n) worst = std::max(worst, (p[n] - q[n]).norm());
  return worst;
}

double farthestMoved(const Simulator& simulator, const std::vector<Vec3>& from) {
  std::vector<Vec3> now;
  simulator.copyPositions(now);
  double worst = 0.0;
  for (std::size_t n = 0; n < now.size(); ++n) worst = std::max(worst, (now[n] - from[n]).norm());
  return worst;
}

ObstacleParams ballAt(const Vec3& position) {
  ObstacleParams ball;
  ball.name = "ball";
  ball.radius = 0.15;
  ball.pose.position = position;
  return ball;
}

WindParams fan(double pressure) {
  WindParams wind;
  wind.id = "fan";
  wind.position = {0.5, -1.0, 0.7};
  wind.direction = Vec3::UnitY();
  wind.radius = 1.0;
  wind.pressure = pressure;
  return wind;
}

DragParams pull(const Vec3& force) {
  DragParams drag;
  drag.id = "hand";
  drag.node = NodeIndex{15, 10};
  drag.force = force;
  return drag;
}

TEST(Sleep, FallsAsleepAndStaysWhereItIs) {
  Simulator simulator(hanging());
  ASSERT_TRUE(sleepsWithin(simulator, 60));
  std::vector<Vec3> place, velocity;
  simulator.copyPositions(place);
  const std::uint64_t revision = simulator.revision(), hash = simulator.stateHash();
  const std::int64_t substeps = simulator.statistics().substeps;
  run(simulator, 100);
  EXPECT_EQ(simulator.revision(), revision);
  EXPECT_EQ(simulator.stateHash(), hash);
  EXPECT_EQ(simulator.statistics().substeps, substeps);
  EXPECT_EQ(simulator.statistics().substeps_last, 0);
  EXPECT_GE(simulator.statistics().asleep_frames, 100);
  EXPECT_EQ(farthestMoved(simulator, place), 0.0);
  EXPECT_EQ(simulator.energy().kinetic, 0.0);
  EXPECT_EQ(simulator.statistics().wakes, 0);
  simulator.copyVelocities(velocity);
  for (const Vec3& v : velocity) EXPECT_EQ(v.norm(), 0.0);
}

TEST(Sleep, NotWhatMovesNorWithoutGravityNorWhenNotWanted) {
  Simulator swing([] {
    Scene scene = flatScene(8, 6);
    scene.hang.tilt = 0.01;
    return scene;
  }());
  Simulator floating([] {
    Scene scene = hanging();
    scene.air.inside = scene.air.border = scene.air.corner = 0.0;
    scene.gravity.setZero();
    return scene;
  }());
  Simulator unwanted(sleepless(hanging()));
  // Frames too far apart to tell a swing from rest.
  Simulator slow([] {
    Scene scene = flatScene(2, 6, 0.0398, 1.0);
    scene.hang.tilt = 0.3;
    scene.solver.frame_rate = 5.0;
    return scene;
  }());
  for (Simulator* simulator : {&swing, &floating, &unwanted, &slow}) {
    run(*simulator, 300);
    EXPECT_EQ(simulator->statistics().asleep, 0);
    EXPECT_EQ(simulator->statistics().asleep_frames, 0);
  }
}

// Overdamped cloth creeps: slow is not at rest.
TEST(Sleep, CreepingClothIsLeftToArrive) {
  Scene scene = hanging();
  scene.hang.to = {1.0, 0.0, 1.2};
  scene.hang.tilt = 0.3;
  scene.air.inside = scene.air.border = scene.air.corner = 40.0;  // c / m = 240 / s: a time constant of 17 s
  Simulator simulator(scene);
  int frame = 0;
  for (; frame < 60 * 600 && simulator.statistics().asleep == 0; ++frame) simulator.step();
  ASSERT_GT(simulator.statistics().asleep, 0);
  const double sine = simulator.position({15, 10}).y() / (1.2 - simulator.position({15, 10}).z());
  // At its resting speed a swing of this size would be 1e-4 / omega = 3e-5 m wide.
  EXPECT_LT(std::abs(sine), 1e-4) << "asleep after " << frame / 60 << " s";
}

struct Cause {
  std::string name;
  std::function<void(Scene&)> prepare;       // the scene
  std::function<void(Simulator&, int)> act;  // called before each frame after it slept; frames since then
  double moves;                              // at least so far within a second [m], or the cause is none
};

std::vector<Cause> causes() {
  const auto nothing = [](Scene&) {};
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
      {"wind that ends", [](Scene& scene) { scene.wind.push_back(fan(3.0)); },
       once([](Simulator& s) { s.removeWind("fan"); }), 0.02},
      {"all winds gone", [](Scene& scene) { scene.wind.push_back(fan(3.0)); },
       once([](Simulator& s) { s.clearWinds(); }), 0.02},
      {"wind that turns", [](Scene& scene) { scene.wind.push_back(fan(3.0)); }, once([](Simulator& s) {
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
      {"drag let go",
       [](Scene& scene) {
         scene.drag.push_back(pull({0.0, 0.05, 0.0}));
       },
       once([](Simulator& s) { s.removeDrag("hand"); }), 0.01},
      {"all drags gone",
       [](Scene& scene) {
         scene.drag.push_back(pull({0.0, 0.05, 0.0}));
       },
       once([](Simulator& s) { s.clearDrags(); }), 0.01},
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
      {"obstacle",
       [](Scene& scene) {
         scene.obstacles.push_back(ballAt({0.5, -1.0, 0.6}));
       },
       [](Simulator& s, int frame) {
         Pose pose;
         pose.position = {0.5, -1.0 + 0.02 * std::min(frame + 1, 50), 0.6};
         s.setObstaclePose(0, pose);
       },
       0.1},
      {"obstacle at 30 m/s",
       [](Scene& scene) {
         scene.obstacles.push_back(ballAt({0.5, -2.0, 0.6}));
       },
       [](Simulator& s, int frame) {
         Pose pose;
         pose.position = {0.5, -2.0 + 0.5 * std::min(frame + 1, 4), 0.6};
         s.setObstaclePose(0, pose);
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
      {"obstacle that appears",
       [](Scene& scene) {
         scene.obstacles.push_back(ballAt({0.5, -0.13, 0.6}));
       },
       [](Simulator& s, int frame) {
         if (frame < 0) s.setObstaclePresent(0, false);
         if (frame == 0) s.setObstaclePresent(0, true);
       },
       0.01},
      {"obstacle that goes",
       [](Scene& scene) {
         scene.obstacles.push_back(ballAt({0.5, -0.1, 0.6}));
       },
       once([](Simulator& s) { s.setObstaclePresent(0, false); }), 0.03},
      {"obstacle that leaves",
       [](Scene& scene) {
         scene.obstacles.push_back(ballAt({0.5, -0.1, 0.6}));
       },
       [](Simulator& s, int frame) {
         Pose pose;
         pose.position = {0.5, -0.1 - 0.05 * std::min(std::max(frame + 1, 0), 20), 0.6};
         s.setObstaclePose(0, pose);
       },
       0.03},
      {"obstacle that is elsewhere at once",
       [](Scene& scene) {
         scene.obstacles.push_back(ballAt({0.5, -0.1, 0.6}));
       },
       once([](Simulator& s) {
         Pose pose;
         pose.position = {30.0, 0.0, 0.6};
         s.setObstaclePose(0, pose, true);
       }),
       0.03},
      {"obstacle that jumps and goes",
       [](Scene& scene) {
         scene.obstacles.push_back(ballAt({0.5, -0.1, 0.6}));
       },
       once([](Simulator& s) {
         Pose pose;
         pose.position = {30.0, 0.0, 0.6};
         s.setObstaclePose(0, pose, true);
         s.setObstaclePresent(0, false);
       }),
       0.03},
      {"scripted obstacle",
       [](Scene& scene) {
         scene.obstacles.push_back(ballAt({0.5, -1.0, 0.6}));
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
  double apart =
      0.0;  // of the two within the first 12 frames; later on small differences have grown, whatever they came from [m]
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
TEST(Sleep, WakesInTimeForEveryCause) {
  constexpr int kDue = 360;  // frames: 6 s
  for (const Cause& cause : causes()) {
    Scene scene = hanging();
    cause.prepare(scene);
    Simulator simulator(scene), reference(sleepless(scene));
    cause.act(simulator, -1);
    cause.act(reference, -1);
    run(simulator, kDue);
    run(reference, kDue);
    EXPECT_EQ(simulator.statistics().asleep, simulator.columns()) << cause.name;
    const Comparison result = compare(cause, simulator, reference);
    EXPECT_LT(result.late, 0.25) << cause.name << ", in frames";
    EXPECT_GT(result.moved, cause.moves) << cause.name;
    EXPECT_GT(simulator.statistics().wakes, 0) << cause.name;
    std::printf("%-24s apart by %.1e m, %.2f frames; moved by %.3f m\n", cause.name.c_str(), result.apart, result.late,
                result.moved);
  }
}

TEST(Sleep, SleepsOnWhenNothingOfItMatters) {
  Scene scene = hanging();
  scene.wind.push_back(fan(3.0));
  scene.drag.push_back(pull({0.0, 0.05, 0.0}));
  scene.obstacles.push_back(ballAt({5.0, 0.0, 0.6}));
  Simulator simulator(scene);
  ASSERT_TRUE(sleepsWithin(simulator, 900));
  const std::int64_t wakes = simulator.statistics().wakes;
  for (int frame = 0; frame < 60; ++frame) {
    WindParams again = fan(3.0);  // the same, from now on
    again.start = simulator.time();
    EXPECT_TRUE(simulator.setWind(again).empty());
    WindParams elsewhere = fan(50.0);
    elsewhere.id = "elsewhere";
    elsewhere.position.z() = 10.0 + 0.1 * frame;
    elsewhere.unsteadiness = 5.0;
    EXPECT_TRUE(simulator.setWind(elsewhere).empty());
    DragParams held = pull({0.0, 0.05, 0.0});
    held.start = simulator.time();
    EXPECT_TRUE(simulator.setDrag(held).empty());
    Pose pose;
    pose.position = {4.0 - 0.01 * frame, 0.0, 0.6};
    simulator.setObstaclePose(0, pose);
    simulator.step();
  }
  EXPECT_EQ(simulator.statistics().asleep, simulator.columns());
  EXPECT_EQ(simulator.statistics().wakes, wakes);
  EXPECT_EQ(simulator.obstaclePose(0).position.x(), 4.0 - 0.01 * 59);
}

// A bad value changes nothing, so nothing has to wake for it.
TEST(Sleep, SleepsOnWhenASourceIsRefused) {
  Scene scene = hanging();
  scene.wind.push_back(fan(3.0));
  scene.drag.push_back(pull({0.0, 0.05, 0.0}));
  Simulator simulator(scene);
  ASSERT_TRUE(sleepsWithin(simulator, 900));
  const std::int64_t wakes = simulator.statistics().wakes;
  EXPECT_FALSE(simulator.setWind(fan(-1.0)).empty());
  DragParams bad = pull({0.0, 0.1, 0.0});
  bad.radius = -1.0;
  EXPECT_FALSE(simulator.setDrag(bad).empty());
  simulator.step();
  EXPECT_EQ(simulator.statistics().asleep, simulator.columns());
  EXPECT_EQ(simulator.statistics().wakes, wakes);
}

TEST(Sleep, GustsKeepItAwakeHoweverWeak) {
  Scene scene = hanging();
  scene.wind.push_back(fan(0.0));
  scene.wind[0].unsteadiness = 1e-6;
  Simulator simulator(scene);
  run(simulator, 300);
  EXPECT_EQ(simulator.statistics().asleep, 0);
}

TEST(Sleep, RestsOnABallAndPressesOn) {
  Scene scene = hanging();
  scene.obstacles.push_back(ballAt({0.5, -0.1, 0.6}));
  Simulator simulator(scene);
  ASSERT_TRUE(sleepsWithin(simulator, 900));
  const Vec3 force = simulator.contactWrench(0).force;
  EXPECT_GT(force.norm(), 1e-3);
  const int contacts = simulator.statistics().contacts;
  run(simulator, 60);
  EXPECT_EQ(simulator.contactWrench(0).force, force);
  EXPECT_EQ(simulator.statistics().contacts, contacts);
}

// Sleeping and waking take energy or leave it: never does any come from nowhere. No force but gravity acts, so between
// frames the total may not rise by more than without sleeping (leapfrog's own wavering, and what links are let out by:
// a share of the tolerance).
TEST(Sleep, GivesNoEnergyAndNoJump) {
  Scene scene = hanging();
  scene.drag.push_back(pull({0.0, 0.1, 0.0}));
  scene.drag[0].end = 0.5;
  const double allowed = 1e-4 * 0.2 * 9.81;  // 1e-4 m g L
  Simulator simulator(scene);
  std::vector<Vec3> before;
  int changes = 0, asleep = 0;
  run(simulator, 31);
  double energy = simulator.energy().kinetic + simulator.energy().potential;
  for (int frame = 0; frame < 900; ++frame) {
    if (frame == 700) {
      DragParams idle = pull(Vec3::Zero());  // wakes it, and that is all it does
      ASSERT_TRUE(simulator.setDrag(idle).empty());
    }
    simulator.copyPositions(before);
    simulator.step();
    const double now = simulator.energy().kinetic + simulator.energy().potential;
    EXPECT_LE(now, energy + allowed) << "frame " << frame;
    energy = std::min(energy, now);
    if (simulator.statistics().asleep == asleep) continue;
    ++changes;
    asleep = simulator.statistics().asleep;
    // What rests moves less than 1e-4 m/s: less than 2e-6 m in a frame; columns that don't rest yet, 50 times that.
    EXPECT_LT(farthestMoved(simulator, before), 50 * 1e-4 / 60.0) << "frame " << frame;
  }
  EXPECT_GE(changes, 3);  // asleep, awake, asleep
}

// One edge of a gathered curtain is led to and fro: what hangs beyond sleeps all the while, and nobody sees it.
TEST(Sleep, ColumnsSleepWhileOthersMove) {
  Scene scene = flatScene(24, 40);
  scene.hang.from = {0.0, 0.0, 1.2};
  scene.hang.to = {0.8, 0.0, 1.2};
  scene.air.inside = scene.air.border = scene.air.corner = 0.5;
  scene.contact.self = true;
  Scene parallel = scene;
  parallel.solver.threads = 2;
  Simulator simulator(scene), reference(sleepless(scene)), threaded(parallel);
  int most = 0, least = 40;
  double apart = 0.0;
  for (int frame = 0; frame < 900; ++frame) {
    DragParams hand;
    hand.id = "hand";
    hand.node = NodeIndex{23, 1};
    hand.target = Vec3(0.02, 0.1 * std::sin(0.05 * frame), 0.2);
    hand.stiffness = 5.0;
    for (Simulator* one : {&simulator, &reference, &threaded}) {
      if (frame > 90 && frame < 600) {
        ASSERT_TRUE(one->setDrag(hand).empty());
      }
      one->step();
    }
    apart = std::max(apart, farthestApart(simulator, reference));
    ASSERT_EQ(simulator.stateHash(), threaded.stateHash()) << "frame " << frame;
    if (frame > 200 && frame < 600) {
      most = std::max(most, simulator.statistics().asleep);
      least = std::min(least, simulator.statistics().asleep);
    }
  }
  std::printf("asleep while one edge moves: %d to %d of 40, apart by at most %.1e m, %d wakes\n", least, most, apart,
              static_cast<int>(simulator.statistics().wakes));
  EXPECT_GE(most, 20);
  EXPECT_LT(most, 40);
  EXPECT_LT(apart, kNotLate);
  EXPECT_EQ(simulator.statistics().asleep, 40) << "when all is over";
}

// The same of a ring: what moves lies on both sides of where its columns begin and end.
TEST(Sleep, ColumnsOfARingSleepWhileOthersMove) {
  Scene scene = curtain_test::ringScene(16, 32, 1.0, 2.0);
  scene.hang.radius = 0.22;
  scene.air.inside = scene.air.border = scene.air.corner = 1.0;
  Simulator simulator(scene), reference(sleepless(scene));
  int most = 0;
  double apart = 0.0;
  for (int frame = 0; frame < 600; ++frame) {
    DragParams hand;
    hand.id = "hand";
    hand.node = NodeIndex{15, 0};
    hand.target = Vec3(0.22, 0.05 * std::sin(0.05 * frame), 1.0);
    hand.stiffness = 5.0;
    for (Simulator* one : {&simulator, &reference}) {
      if (frame > 60) {
        ASSERT_TRUE(one->setDrag(hand).empty());
      }
      one->step();
    }
    apart = std::max(apart, farthestApart(simulator, reference));
    if (frame > 200) most = std::max(most, simulator.statistics().asleep);
  }
  std::printf("asleep of a ring while a node moves: up to %d of 32, apart by at most %.1e m\n", most, apart);
  EXPECT_GE(most, 16);
  EXPECT_LT(most, 32);
  EXPECT_LT(apart, kNotLate);
}

TEST(Sleep, EveryMethodSleepsAndWakes) {
  const Cause pulled{"pull", [](Scene&) {},
                     [](Simulator& s, int frame) {
                       if (frame == 0) s.setDrag(pull({0.0, 0.05, 0.0}));
                     },
                     0.01};
  for (const Method method : {Method::kAuto, Method::kLeapfrog, Method::kLeapfrog4, Method::kBdf2, Method::kImplicit}) {
    for (const double tolerance : {0.0, 1e-3}) {
      Scene scene = hanging();
      scene.solver.method = method;
      scene.solver.position_tolerance = tolerance;
      scene.solver.stretch_tolerance = 1e-5;  // bdf2 and implicit shake taut strings by more than a frame's way at 1e-3
      Simulator simulator(scene), reference(sleepless(scene));
      run(simulator, 90);
      run(reference, 90);
      ASSERT_EQ(simulator.statistics().asleep, simulator.columns()) << toString(method);
      const Comparison result = compare(pulled, simulator, reference);
      EXPECT_LT(result.late, 0.5) << toString(method) << ", tolerance " << tolerance;
      EXPECT_GT(result.moved, pulled.moves) << toString(method);
      simulator.removeDrag("hand");
      EXPECT_TRUE(sleepsWithin(simulator, 900)) << toString(method) << ", tolerance " << tolerance;
    }
  }
}

TEST(Sleep, ResetWakesAndRepeatsToTheBit) {
  Simulator simulator(hanging()), other(hanging());
  run(simulator, 200);
  ASSERT_GT(simulator.statistics().asleep, 0);
  simulator.reset();
  EXPECT_EQ(simulator.statistics().asleep, 0);
  for (int frame = 0; frame < 200; ++frame) {
    simulator.step();
    other.step();
    ASSERT_EQ(simulator.stateHash(), other.stateHash()) << "frame " << frame;
    ASSERT_EQ(simulator.statistics().asleep, other.statistics().asleep);
  }
}

// Cloth that never rests moves as if there were no such thing.
TEST(Sleep, ChangesNoBitOfWhatMoves) {
  Scene scene = flatScene(12, 16);
  scene.hang.tilt = 0.8;
  Simulator simulator(scene), reference(sleepless(scene));
  run(simulator, 240);
  run(reference, 240);
  EXPECT_EQ(simulator.stateHash(), reference.stateHash());
}

// Velocities are half a substep old and made new for who asks: that leaves no trace in columns that sleep either.
TEST(Sleep, IsNotDisturbedByWhoLooks) {
  Scene scene = hanging();
  scene.cloth.columns = 40;
  Simulator simulator(scene), watched(scene);
  std::vector<Vec3> velocities;
  int partly = 0;
  for (int frame = 0; frame < 150; ++frame) {
    for (Simulator* one : {&simulator, &watched}) {
      DragParams drag = pull({0.0, 0.02 + 1e-3 * frame, 0.0});
      drag.node = NodeIndex{15, 38};
      if (frame % 6 == 0) one->setDrag(drag);
      one->step();
    }
    watched.copyVelocities(velocities);
    partly += simulator.statistics().asleep > 0 && simulator.statistics().asleep < 40 ? 1 : 0;
    ASSERT_EQ(simulator.stateHash(), watched.stateHash()) << "frame " << frame;
  }
  EXPECT_GT(partly, 0);
  EXPECT_GT(simulator.statistics().wakes, 0) << "nothing woke: nothing could have been disturbed";
}

}  // namespace
}  // namespace curtain
