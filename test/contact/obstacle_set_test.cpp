// SPDX-License-Identifier: BSD-3-Clause
//
// The box around all obstacles holds every one that is present in the substep, whatever became of them before:
// obstacles at rest are not looked at anew, and one that is touched from outside must be.
#include "obstacles/obstacle_set.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "cloth/archive.h"
#include "testing.h"

namespace curtain {
namespace {

using namespace curtain_test;

Scene twoSpheres() {
  Scene scene = flatScene(5, 5, 1.0, 1.0);
  for (const char* const name : {"one", "other"}) {
    ObstacleParams sphere;
    sphere.name = name;
    sphere.radius = 0.1;
    sphere.pose.position = Vec3(name == std::string("one") ? 0.0 : 1.0, 0.0, 0.0);
    scene.obstacles.push_back(sphere);
  }
  return scene;
}

Pose poseOf(double x) {
  Pose pose;
  pose.position = Vec3(x, 0.0, 0.0);
  return pose;
}

// The range that all obstacles take in the substep along x. way: of one that moves [m], of which half may be added.
void expectRange(ObstacleSet& set, double low, double high, const std::string& when, double way = 0.0) {
  set.setSubstep(0.0, 1.0);
  Eigen::AlignedBox3d all;
  for (int n = 0; n < set.count(); ++n) {
    if (!set.present(n)) continue;
    all.extend(set.sweptBounds(n));
    EXPECT_TRUE(set.mayMeet(n, set.sweptBounds(n))) << when;
    const std::vector<int>& near = set.near(set.sweptBounds(n));
    EXPECT_EQ(std::count(near.begin(), near.end(), n), 1) << when;
    EXPECT_TRUE(all.contains(set.moving(n).sweptBounds())) << when;
  }
  EXPECT_LE(all.min().x(), low) << when;
  EXPECT_GE(all.min().x(), low - 0.5 * way) << when;
  EXPECT_GE(all.max().x(), high) << when;
  EXPECT_LE(all.max().x(), high + 0.5 * way) << when;
  EXPECT_TRUE(set.sweptBounds().contains(all)) << when;
}

class ObstaclesAtRest : public testing::Test {
 protected:
  void SetUp() override {
    for (int n = 0; n < 2; ++n) expectRange(set_, -0.1, 1.1, "at rest");
  }
  ObstacleSet set_{twoSpheres(), shapesBy(resolveMeshUrl)};
};

TEST_F(ObstaclesAtRest, AreSeenToMove) {
  set_.setPose(1, poseOf(2.0), false);
  set_.beginFrame(0.1);
  expectRange(set_, -0.1, 2.1, "on its way", 1.0);
  set_.endFrame();
  set_.setSubstep(0.0, 1.0);
  EXPECT_EQ(set_.sweptBounds().min().x(), -0.1) << "boxes of what rests are exact";
  EXPECT_EQ(set_.moving(1).sweptBounds().min().x(), 1.9) << "it has arrived";
  set_.setPose(0, poseOf(-3.0), true);
  expectRange(set_, -3.1, 2.1, "put elsewhere");
}

TEST_F(ObstaclesAtRest, AreSeenToComeAndGo) {
  set_.setPresent(1, false);
  expectRange(set_, -0.1, 0.1, "one is gone");
  set_.endFrame();
  expectRange(set_, -0.1, 0.1, "still gone");
  set_.setPresent(1, true);
  expectRange(set_, -0.1, 1.1, "back again");
  set_.setPresent(0, false);
  set_.setPresent(1, false);
  set_.setSubstep(0.0, 1.0);
  EXPECT_TRUE(set_.sweptBounds().isEmpty());
}

// Wherever a turning box is in the frame, it is within its boxes of the frame; and it is placed as asked, whoever was
// asked for before.
TEST(ObstaclesWithMotion, StayWithinTheirBoxesOfTheFrame) {
  Random random(5);
  for (int trial = 0; trial < 200; ++trial) {
    Scene scene = twoSpheres();
    scene.obstacles[1].shape = ShapeKind::kBox;
    scene.obstacles[1].size = Vec3(0.1, 0.4, 1.0);
    ObstacleSet set(scene, shapesBy(resolveMeshUrl));
    const Vec3 begin = scene.obstacles[1].pose.position, way = random.inBox(0.5);
    Pose end;
    end.position = begin + way;
    end.orientation = Eigen::AngleAxisd(random.between(0.0, 3.0), random.direction());
    set.setPose(1, end, false);
    set.beginFrame(0.1);
    set.setSubstep(0.0, 0.1);
    const Eigen::AlignedBox3d coarse = set.sweptBounds(), exact = set.sweptBounds(1);
    for (int k = 1; k < 10; ++k) {
      set.setSubstep(0.1 * k, 0.1 * (k + 1));
      if (k % 3 == 0) continue;
      const MovingObstacle& box = set.moving(1);
      EXPECT_TRUE(exact.contains(box.sweptBounds())) << trial;
      EXPECT_TRUE(coarse.contains(box.sweptBounds())) << trial;
      EXPECT_LT((box.after.translation - begin - 0.1 * (k + 1) * way).norm(), 1e-15);
    }
    set.endFrame();
    EXPECT_LT((set.moving(1).after.translation - end.position).norm(), 1e-15);
  }
}

TEST(ObstaclesWithMotion, AreWhereItLedWhileTheyWereGone) {
  Scene scene = twoSpheres();
  scene.obstacles[1].motion = {{1.0, poseOf(1.0)}, {2.0, poseOf(4.0)}};
  ObstacleSet set(scene, shapesBy(resolveMeshUrl));
  expectRange(set, -0.1, 1.1, "before its motion");
  set.setPresent(1, false);
  for (const double end : {1.5, 2.0, 3.0}) {
    set.beginFrame(end);
    expectRange(set, -0.1, 0.1, "gone");
    set.endFrame();
  }
  set.setPresent(1, true);
  set.beginFrame(4.0);
  expectRange(set, -0.1, 4.1, "back again");
}

TEST_F(ObstaclesAtRest, AreSeenWhereASnapshotHasThem) {
  ObstacleSet elsewhere(twoSpheres(), shapesBy(resolveMeshUrl));
  elsewhere.setPose(1, poseOf(5.0), true);
  elsewhere.endFrame();
  expectRange(elsewhere, -0.1, 5.1, "saved");
  Archive out = Archive::saving();
  elsewhere.serialize(out);
  const std::string bytes = out.extractWritten();
  Archive in = Archive::loading(bytes);
  set_.serialize(in);
  in.finishLoading();
  in.commit();
  expectRange(set_, -0.1, 5.1, "loaded");
  set_.reset();
  expectRange(set_, -0.1, 1.1, "reset");
}

}  // namespace
}  // namespace curtain
