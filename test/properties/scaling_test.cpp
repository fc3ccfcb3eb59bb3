// SPDX-License-Identifier: BSD-3-Clause
//
// No unit is built in: with lengths, times and masses in other units, every number of the scene accordingly, the motion
// is the same, to the last bit where the units are powers of two. A doll's curtain moves like an airship's. What is an
// exception is named in docs/units.md.
#include <gtest/gtest.h>

#include <string>

#include "properties/kinds.h"
#include "properties/seeds.h"
#include "properties/similarity.h"

namespace curtain {
namespace {

using namespace curtain_test;

constexpr int kScaledFrames = 40;

Similarity units(double length, double time, double mass) {
  Similarity s;
  s.length = length;
  s.time = time;
  s.mass = mass;
  return s;
}

std::string describe(const Similarity& s) {
  return "lengths by " + std::to_string(s.length) + ", times by " + std::to_string(s.time) + ", masses by " +
         std::to_string(s.mass);
}

class Scaling : public ::testing::TestWithParam<std::tuple<Kind, Method>> {};

TEST_P(Scaling, ChangesNoBit) {
  const auto& [kind, method] = GetParam();
  int contacts = 0;
  for (const std::uint64_t seed : seeds(2, {11, 14})) {
    Scene scene = randomScene(seed, kind.wanted);
    scene.solver.method = method;
    const Motion motion = record(scene, kScaledFrames);
    contacts += motion.statistics.contacts_max;
    // A thousandth and a thousand times, with gravity as it is and as it comes.
    for (const Similarity& s : {units(0x1p-10, 0x1p-5, 0x1p-20), units(0x1p10, 0x1p5, 0x1p20),
                                units(0x1p-10, 1.0, 0x1p-4), units(0x1p10, 1.0, 0.5), units(1.0, 0x1p-4, 1.0)}) {
      if (method == Method::kLeapfrog4 && s.time != 1.0) continue;  // takes a second off where a string pulls
      const Scene image = seen(s, scene);
      if (kind.wanted.fabric && !validate(image).empty()) continue;  // stiffer than a scene may be
      const Motion other = seenBack(s, record(image, kScaledFrames));
      EXPECT_EQ(firstDifference(motion, other), -1)
          << describe(s) << "; " << repeat(seed) << "; apart by " << farthestApart(motion, other);
    }
  }
  if (kind.touches) {
    EXPECT_GT(contacts, 0) << "nothing ever touched";
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, Scaling,
                         ::testing::Combine(::testing::Values(slack(), taut(), obstacles(), mesh(), selfContact()),
                                            kEveryMethod),
                         nameOfKind);
INSTANTIATE_TEST_SUITE_P(Fabric, Scaling, ::testing::Combine(::testing::Values(fabric()), kMethodsThatBend),
                         nameOfKind);

// Air by its relative velocity, with gusts: their length scale is a length, their seed none.
TEST(ScalingOfRelativeAir, ChangesNoBit) {
  for (const std::uint64_t seed : seeds(2)) {
    Scene scene = randomScene(seed, slack().wanted);
    scene.air = curtain::AirParams();
    scene.air.law = curtain::AirLaw::kRelative;
    scene.ambient.velocity = Vec3(1.0, 3.0, 0.5);
    scene.ambient.intensity = 0.3;
    scene.ambient.length_scale = 2.0;
    const Motion motion = record(scene, kScaledFrames);
    for (const Similarity& s : {units(0x1p-10, 0x1p-5, 0x1p-20), units(0x1p6, 1.0, 0x1p4), units(1.0, 0x1p-4, 1.0)}) {
      const Motion other = seenBack(s, record(seen(s, scene), kScaledFrames));
      EXPECT_EQ(firstDifference(motion, other), -1) << describe(s) << "; " << repeat(seed);
    }
  }
}

class ScalingOfRest : public ::testing::TestWithParam<Method> {};

// Sleep goes by seconds, but not by metres and kilograms.
TEST_P(ScalingOfRest, OfLengthsAndMassesChangesNoBit) {
  int asleep = 0;
  for (const std::uint64_t seed : seeds(2)) {
    Wanted wanted = slack().wanted;
    wanted.max_nodes = 6;
    Scene scene = randomScene(seed, wanted);
    scene.solver.method = GetParam();
    scene.solver.rest_speed = 3e-3;
    scene.air.inside = scene.air.border = scene.air.corner = 4.0 * scene.cloth.surface_density;
    const Motion motion = record(scene, 300);
    asleep += motion.statistics.asleep ? 1 : 0;
    for (const Similarity& s : {units(0x1p-8, 1.0, 1.0), units(0x1p8, 1.0, 0x1p16)}) {
      const Motion other = seenBack(s, record(seen(s, scene), 300));
      EXPECT_EQ(firstDifference(motion, other), -1) << describe(s) << "; " << repeat(seed);
      EXPECT_EQ(other.statistics.asleep, motion.statistics.asleep);
    }
  }
  EXPECT_GT(asleep, 0) << "nothing ever slept";
}

INSTANTIATE_TEST_SUITE_P(Methods, ScalingOfRest, kEveryMethod, nameOfMethod);

}  // namespace
}  // namespace curtain
