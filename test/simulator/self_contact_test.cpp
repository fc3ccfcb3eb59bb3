// SPDX-License-Identifier: BSD-3-Clause
//
// Cloth never goes through itself: crumpled, gathered and blown, twisted; judged by brute force at every frame. And
// what its contacts leave alone: momentum, and which way is left.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "curtain_sim/simulator.h"
#include "figures.h"
#include "testing.h"

namespace curtain {
namespace {

using curtain_test::fanAt;
using curtain_test::flatScene;
using curtain_test::kPi;

Scene clothOf44x40() {
  Scene scene = flatScene(44, 40, 2.0, 1.0);
  scene.contact.self = true;
  return scene;
}

// What every frame must show; says what the worst ones were.
class Watch {
 public:
  explicit Watch(const Scene& scene) : tolerance_(scene.solver.stretch_tolerance) {}
  void look(const Simulator& simulator) {
    const Statistics& now = simulator.statistics();
    ASSERT_TRUE(now.finite) << "frame " << now.frames;
    ASSERT_EQ(simulator.selfCrossings(), 0) << "frame " << now.frames;
    ASSERT_LE(std::max(now.warp_stretch, now.weft_stretch), tolerance_) << "frame " << now.frames;
    ASSERT_LE(now.warp_compression, tolerance_) << "frame " << now.frames;
    max_contacts_ = std::max(max_contacts_, now.contacts);
  }
  int maxContacts() const { return max_contacts_; }
  static void report(const char* name, const Simulator& simulator) {
    const Statistics& s = simulator.statistics();
    std::printf("%s: %.2f substeps a frame, %lld rejected, %lld unsettled\n", name,
                static_cast<double>(s.substeps) / static_cast<double>(s.frames), static_cast<long long>(s.rejected),
                static_cast<long long>(s.unsettled));
  }

 private:
  double tolerance_;
  int max_contacts_ = 0;
};

TEST(SelfContact, ASheetThatFallsOnTheFloorCrumplesWithoutACrossing) {
  Scene scene = clothOf44x40();
  scene.pins.kind = PinKind::kNone;
  scene.air.inside = scene.air.border = scene.air.corner = 0.1;
  WindParams draught;
  draught.id = "draught";
  draught.position = {0.5, -1.5, 1.0};
  draught.direction = Vec3::UnitY();
  draught.radius = 2.0;
  draught.pressure = draught.unsteadiness = 0.5;
  scene.wind.push_back(draught);
  ObstacleParams floor;
  floor.name = "floor";
  floor.shape = ShapeKind::kPlane;
  floor.friction = 0.4;
  scene.obstacles.push_back(floor);
  Simulator simulator(scene);
  Watch watch(scene);
  for (int frame = 0; frame < 100; ++frame) {
    simulator.step();
    ASSERT_NO_FATAL_FAILURE(watch.look(simulator));
  }
  EXPECT_GT(watch.maxContacts(), 1000) << "it is no heap";
  Watch::report("crumpled", simulator);
}

TEST(SelfContact, ACurtainGatheredToAQuarterAndBlownNeverCrossesItself) {
  Scene scene = clothOf44x40();
  scene.hang.to = scene.hang.from + Vec3(0.25, 0.0, 0.0);
  scene.air.inside = scene.air.border = scene.air.corner = 0.2;
  WindParams fan = fanAt({0.1, -1.5, 1.2}, 1.5);
  fan.half_angle = 0.2;
  fan.pressure = 6.0;
  fan.unsteadiness = 4.0;
  scene.wind.push_back(fan);
  Simulator simulator(scene);
  Watch watch(scene);
  for (int frame = 0; frame < 90; ++frame) {
    simulator.step();
    ASSERT_NO_FATAL_FAILURE(watch.look(simulator));
  }
  EXPECT_GT(watch.maxContacts(), 50);
  Watch::report("gathered", simulator);
}

// Both corners go round their middle five times in five seconds.
TEST(SelfContact, ASheetSpunByItsCornersNeverCrossesItself) {
  constexpr int kNodes = 20;
  Scene scene = flatScene(kNodes, kNodes);
  scene.hang.from = {-0.4, 0.0, 2.0};
  scene.hang.to = {0.4, 0.0, 2.0};
  scene.pins.kind = PinKind::kTopCorners;
  scene.contact.self = true;
  scene.air.inside = scene.air.border = 0.3;
  Simulator simulator(scene);
  Watch watch(scene);
  for (int frame = 1; frame <= 330; ++frame) {
    const double angle = 2.0 * kPi * std::min(5.0, frame / 60.0);
    const Vec3 corner(0.4 * std::cos(angle), 0.4 * std::sin(angle), 2.0);
    ASSERT_TRUE(simulator.movePin({0, 0}, {-corner.x(), -corner.y(), 2.0}));
    ASSERT_TRUE(simulator.movePin({0, kNodes - 1}, corner));
    simulator.step();
    ASSERT_NO_FATAL_FAILURE(watch.look(simulator));
  }
  EXPECT_GT(watch.maxContacts(), 5);
  Watch::report("spun", simulator);
}

// Gathered to a rope, held by both ends, wrung by five turns while the ends come closer.
TEST(SelfContact, ASheetWrungToARopeNeverCrossesItself) {
  constexpr int kNodes = 20;
  constexpr double kRadius = 0.02;
  Scene scene = flatScene(kNodes, kNodes);
  scene.hang.from = {-kRadius, 0.0, 2.0};
  scene.hang.to = {kRadius, 0.0, 2.0};
  scene.pins.kind = PinKind::kList;
  scene.pins.nodes = {{0, 0}, {0, kNodes - 1}, {kNodes - 1, 0}, {kNodes - 1, kNodes - 1}};
  scene.contact.self = true;
  scene.air.inside = scene.air.border = 0.3;
  Simulator simulator(scene);
  Watch watch(scene);
  for (int frame = 1; frame <= 330; ++frame) {
    const double done = std::min(1.0, frame / 300.0);
    const double angle = 10.0 * kPi * done;
    const double height = 1.0 + 0.35 * done;
    const Vec3 corner(kRadius * std::cos(angle), kRadius * std::sin(angle), height);
    ASSERT_TRUE(simulator.movePin({kNodes - 1, 0}, {-corner.x(), -corner.y(), height}));
    ASSERT_TRUE(simulator.movePin({kNodes - 1, kNodes - 1}, corner));
    simulator.step();
    ASSERT_NO_FATAL_FAILURE(watch.look(simulator));
  }
  EXPECT_GT(watch.maxContacts(), 200);
  Watch::report("wrung", simulator);
}

// A free sheet whose two halves are thrown at each other.
Scene thrownHalves(double friction) {
  Scene scene = flatScene(12, 24, 0.5, 1.0);
  scene.hang.from = {-0.5, 0.0, 0.2};
  scene.hang.to = {0.5, 0.0, 0.2};
  scene.pins.kind = PinKind::kNone;
  scene.gravity = Vec3::Zero();
  scene.contact.self = true;
  scene.contact.friction = friction;
  for (int side = 0; side < 2; ++side) {
    for (int row = 0; row < scene.cloth.rows; ++row) {
      DragParams drag;
      drag.id = std::to_string(side) + "," + std::to_string(row);
      drag.node = NodeIndex{row, side * (scene.cloth.columns - 1)};
      drag.force = {side == 0 ? 0.03 : -0.03, 0.012, side == 0 ? -0.003 : 0.003};
      drag.end = 0.1;
      scene.drag.push_back(drag);
    }
  }
  return scene;
}

struct Sums {
  Vec3 linear = Vec3::Zero(), angular = Vec3::Zero();
  double linear_size = 0.0, angular_size = 0.0;  // sums of the nodes' magnitudes
};

Sums sumsOf(const Simulator& simulator) {
  std::vector<Vec3> position, velocity;
  simulator.copyPositions(position);
  simulator.copyVelocities(velocity);
  Sums sums;
  for (std::size_t n = 0; n < position.size(); ++n) {
    const int columns = simulator.columns();
    const Vec3 p = simulator.mass({static_cast<int>(n) / columns, static_cast<int>(n) % columns}) * velocity[n];
    sums.linear += p;
    sums.angular += position[n].cross(p);
    sums.linear_size += p.norm();
    sums.angular_size += position[n].norm() * p.norm();
  }
  return sums;
}

TEST(SelfContact, KeepsMomentumAndAngularMomentum) {
  for (const double friction : {0.0, 0.3}) {
    Simulator simulator(thrownHalves(friction));
    Sums start;
    int contacts = 0;
    double off = 0.0;
    for (int frame = 1; frame <= 60; ++frame) {
      simulator.step();
      contacts = std::max(contacts, simulator.statistics().contacts);
      if (frame == 7) start = sumsOf(simulator);  // the hands have let go
      if (frame <= 7) continue;
      const Sums now = sumsOf(simulator);
      const double linear = (now.linear - start.linear).norm() / start.linear_size;
      const double angular = (now.angular - start.angular).norm() / start.angular_size;
      off = std::max({off, linear, angular});
      ASSERT_LE(linear, 1e-9) << "frame " << frame;
      ASSERT_LE(angular, 1e-9) << "frame " << frame;
    }
    curtain_test::keepFigure("momentum of colliding halves, off by", off);
    EXPECT_GT(contacts, 20) << "the halves never met";
    EXPECT_GT(start.angular.norm(), 1e-3 * start.angular_size) << "nothing turns";
  }
}

// Seen in a mirror that leaves the grid alone: every sum and product is the same but for signs.
TEST(SelfContact, KeepsMirrorSymmetry) {
  const Scene scene = thrownHalves(0.3);
  Scene mirrored = scene;
  for (DragParams& drag : mirrored.drag) drag.force.y() = -drag.force.y();
  Simulator one(scene), other(mirrored);
  std::vector<Vec3> a, b;
  int contacts = 0;
  for (int frame = 1; frame <= 40; ++frame) {
    one.step();
    other.step();
    contacts = std::max(contacts, one.statistics().contacts);
    one.copyPositions(a);
    other.copyPositions(b);
    for (std::size_t n = 0; n < a.size(); ++n) {
      ASSERT_LE((a[n] - Vec3(b[n].x(), -b[n].y(), b[n].z())).norm(), 1e-9) << "frame " << frame << ", node " << n;
    }
  }
  EXPECT_GT(contacts, 20);
}

}  // namespace
}  // namespace curtain
