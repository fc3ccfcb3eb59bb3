// SPDX-License-Identifier: BSD-3-Clause
//
// What contact keeps from substep to substep saves time and nothing else: without it the same contacts come, to the
// bit.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "cloth/cloth.h"
#include "contact/cloth_contact.h"
#include "testing.h"

namespace curtain {
namespace {

using namespace curtain_test;

constexpr int kSubsteps = 150;
constexpr double kSubstep = 0.005;  // [s]
const SubstepOutcome kMade = [] {
  SubstepOutcome outcome;
  outcome.kick = kSubstep;
  outcome.scale = 1e-5;
  return outcome;
}();

struct Case {
  const char* name;
  bool self, obstacles, closed;
};

Scene sceneOf(const Case& of, std::uint64_t seed) {
  Random random(seed);
  Scene scene = of.closed ? ringScene(9, 12, 0.6, 0.9) : flatScene(12, 11, 0.8, 0.8);
  if (of.self && !of.closed) scene.hang.to = scene.hang.from + Vec3(0.25, 0.0, 0.0);
  scene.contact.self = of.self;
  scene.contact.thickness = 0.008;
  if (!of.obstacles) return scene;
  const ShapeKind shapes[] = {ShapeKind::kSphere, ShapeKind::kBox, ShapeKind::kCylinder, ShapeKind::kCapsule,
                              ShapeKind::kPlane};
  const auto add = [&](ShapeKind shape) -> ObstacleParams& {
    ObstacleParams obstacle;
    obstacle.name = "obstacle" + std::to_string(scene.obstacles.size());
    obstacle.shape = shape;
    obstacle.pose.position = scene.hang.from - Vec3(-0.2, 0.0, 0.4) + random.inBox(0.3);
    obstacle.pose.orientation = Eigen::Quaterniond(Eigen::AngleAxisd(random.between(0.0, 3.0), random.direction()));
    scene.obstacles.push_back(obstacle);
    return scene.obstacles.back();
  };
  for (const ShapeKind shape : shapes) {
    ObstacleParams& obstacle = add(shape);
    if (shape == ShapeKind::kBox)
      obstacle.size = Vec3(0.3, 0.01, 0.3);
    else if (shape != ShapeKind::kPlane)
      obstacle.radius = 0.08;
    if (shape == ShapeKind::kCylinder || shape == ShapeKind::kCapsule) obstacle.length = 0.3;
  }
  for (const char* const mesh : {"icosphere.stl", "l_prism.obj", "square_open.obj"}) {
    ObstacleParams& obstacle = add(ShapeKind::kMesh);
    obstacle.mesh = std::string(CURTAIN_SOURCE_DIR "/test/meshes/") + mesh;
    obstacle.scale = Vec3::Constant(0.2);
  }
  return scene;
}

// Contact of a cloth, whose caches it can do without.
struct Finder {
  Finder(const Scene& scene, const ClothPattern& pattern)
      : obstacles(scene, shapesBy(resolveMeshUrl)), contact(pattern, scene.contact, obstacles, 1e-3, alone) {}
  const Workers alone{1};
  ObstacleSet obstacles;
  ClothContact contact;
};

void expectSame(const Contacts& one, const Contacts& other, const std::string& when) {
  ASSERT_EQ(one.size(), other.size()) << when;
  for (std::size_t n = 0; n < one.size(); ++n) {
    const Contact &a = one[n], &b = other[n];
    EXPECT_TRUE(a.node == b.node && a.nodes == b.nodes && a.obstacle == b.obstacle && a.source == b.source) << when;
    EXPECT_TRUE(a.weight == b.weight && a.normal == b.normal && a.offset == b.offset && a.anchor == b.anchor) << when;
    EXPECT_TRUE(a.friction == b.friction && a.surface_velocity == b.surface_velocity) << when;
    EXPECT_TRUE(a.push == b.push && a.slide == b.slide) << when;
    if (::testing::Test::HasFailure()) return;
  }
}

// Drifts, trembles, now and then jerks; goes through obstacles and itself.
Field3 moved(const ClothPattern& pattern, const Field3& from, const Vec3& drift, double tremble, Random& random) {
  Field3 to = from;
  for (int i = 0; i < pattern.grid.rows; ++i) {
    for (int j = 0; j < pattern.grid.columns; ++j) {
      const std::size_t n = pattern.grid.index(i, j);
      if (pattern.inverse_mass[n] > 0.0) to.add(n, drift + random.inBox(tremble));
    }
  }
  return to;
}

class ContactCaches : public ::testing::TestWithParam<Case> {};

TEST_P(ContactCaches, ChangeNoBit) {
  std::size_t contacts = 0, crossings = 0;
  for (const std::uint64_t seed : {1, 2, 3}) {
    const Scene scene = sceneOf(GetParam(), seed);
    const ClothPattern pattern = makePattern(scene);
    Finder keeps(scene, pattern), forgets(scene, pattern);
    Random random(seed + 100), pushes(seed + 200), pauses(seed + 300);
    Field3 start = makeInitialState(scene, pattern).position;
    for (int k = 0; k < kSubsteps; ++k) {
      const std::string when = "seed " + std::to_string(seed) + ", substep " + std::to_string(k);
      const double size = k % 50 < 25 ? 0.0002 : 0.003;
      const Vec3 drift = size * Vec3(std::sin(0.1 * k), std::cos(0.13 * k), std::sin(0.07 * k));
      const Field3 predicted = moved(pattern, start, drift, size, random);
      Field3 end = moved(pattern, predicted, Vec3::Zero(), 0.3 * size, random);
      for (int jerked = k % 5 == 0 ? 3 : 0; jerked > 0; --jerked) {
        const std::size_t n =
            pattern.grid.index((k + 3 * jerked) % pattern.grid.rows, (2 * k + jerked) % pattern.grid.columns);
        if (pattern.inverse_mass[n] > 0.0) end.add(n, random.inBox(0.02));
      }
      const double turn = 0.002 * (k % 40 < 20 ? 1.0 : 0.0);
      for (Finder* const finder : {&keeps, &forgets}) {
        for (int n = 0; n < finder->obstacles.count(); ++n) {
          Pose pose = finder->obstacles.target(n);
          pose.position += turn * Vec3(1.0, -0.5, 0.5);
          pose.orientation = Eigen::Quaterniond(Eigen::AngleAxisd(turn, Vec3::UnitX())) * pose.orientation;
          finder->obstacles.setPose(n, pose, false);
        }
        finder->obstacles.beginFrame(kSubstep * k);
        finder->obstacles.setSubstep(0.0, 1.0);
      }
      const auto forget = [&] {
        if (pauses.between(0.0, 1.0) < 0.7) forgets.contact.clearCaches();
      };
      forget();
      Contacts& kept = keeps.contact.begin(start, predicted, kSubstep, ContactFinder::ForcesAct::kAtStart);
      Contacts& found = forgets.contact.begin(start, predicted, kSubstep, ContactFinder::ForcesAct::kAtStart);
      expectSame(kept, found, when + ", begun");
      contacts += kept.size();
      const std::size_t begun = kept.size();
      forget();
      const auto verdict = keeps.contact.verify(start, end, false);
      EXPECT_EQ(verdict, forgets.contact.verify(start, end, false)) << when;
      expectSame(kept, found, when + ", verified");
      if (HasFailure()) return;
      crossings += kept.size() - begun;
      for (std::size_t n = 0; n < kept.size(); ++n) {
        kept[n].push = found[n].push = std::max(0.0, pushes.between(-1.0, 1.0));
        kept[n].slide = found[n].slide = pushes.inBox(0.1);
      }
      // Some substeps are made again.
      if (k % 7 != 3) {
        for (Finder* const finder : {&keeps, &forgets}) finder->contact.afterSubstep(true, kMade, end);
        start = end;
      }
      for (Finder* const finder : {&keeps, &forgets}) finder->obstacles.endFrame();
    }
  }
  EXPECT_GT(contacts, 1000u);
  EXPECT_GT(crossings, 10u);
}

// A solve that goes on ends elsewhere than where the cloth was seen to be flat.
TEST(ContactCachesOfFlatCloth, AreOfWhereTheSubstepEnds) {
  Scene scene = flatScene(12, 11, 0.8, 0.8);
  scene.contact.self = true;
  scene.contact.thickness = 0.008;
  const ClothPattern pattern = makePattern(scene);
  const Field3 flat = makeInitialState(scene, pattern).position;
  Field3 turned = flat, folded = flat;  // by 1 rad about the top row; half of it back on the rest
  const double top = scene.hang.from.z(), middle = flat.at(pattern.grid.index(6, 0)).z();
  for (int i = 0; i < pattern.grid.rows; ++i) {
    for (int j = 0; j < pattern.grid.columns; ++j) {
      const std::size_t n = pattern.grid.index(i, j);
      const Vec3 at = flat.at(n);
      const double down = top - at.z(), over = std::max(0.0, middle - at.z());
      turned.set(n, {at.x(), at.y() + down * std::sin(1.0), top - down * std::cos(1.0)});
      folded.set(n, {at.x(), at.y() + over * std::sin(0.05), std::max(at.z(), middle) + over * std::cos(0.05)});
    }
  }
  Finder keeps(scene, pattern), forgets(scene, pattern);
  for (Finder* const finder : {&keeps, &forgets}) {
    finder->contact.begin(flat, flat, kSubstep, ContactFinder::ForcesAct::kAtStart);
    finder->contact.verify(flat, flat, true);
    finder->contact.afterSubstep(true, kMade, flat);
    finder->contact.begin(flat, turned, kSubstep, ContactFinder::ForcesAct::kAtStart);
    finder->contact.verify(flat, turned, true);
    finder->contact.verify(flat, folded, true);
    finder->contact.afterSubstep(true, kMade, folded);
  }
  forgets.contact.clearCaches();
  const Contacts& found = forgets.contact.begin(folded, folded, kSubstep, ContactFinder::ForcesAct::kAtStart);
  EXPECT_GT(found.size(), 10u);
  expectSame(keeps.contact.begin(folded, folded, kSubstep, ContactFinder::ForcesAct::kAtStart), found, "folded");
}

INSTANTIATE_TEST_SUITE_P(Cases, ContactCaches,
                         ::testing::Values(Case{"Obstacles", false, true, false}, Case{"Self", true, false, false},
                                           Case{"Both", true, true, false}, Case{"Closed", true, true, true}),
                         [](const auto& one) { return std::string(one.param.name); });

}  // namespace
}  // namespace curtain
