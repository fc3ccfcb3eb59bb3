// SPDX-License-Identifier: BSD-3-Clause
//
// A scene and its mirror image move as mirror images. A mirror that stands along an axis changes signs and nothing
// else: sums and products of the same numbers in the same order, so the motions are the same to the last bit, however
// chaotic they are. (A mesh's lookup grid begins at one of its sides: meshes only come as near as a turned one does,
// see rigid_motion_test.cpp.)
#include <gtest/gtest.h>

#include <string>

#include "properties/kinds.h"
#include "properties/seeds.h"
#include "properties/similarity.h"

namespace curtain {
namespace {

using namespace curtain_test;

class Mirror : public ::testing::TestWithParam<std::tuple<Kind, Method>> {};

TEST_P(Mirror, ImageMovesAsTheImageOfTheMotion) {
  const auto& [kind, method] = GetParam();
  constexpr int kFrames = 40;
  int contacts = 0;
  for (const std::uint64_t seed : seeds(2, {11, 14})) {
    Scene scene = randomScene(seed, kind.wanted);
    scene.solver.method = method;
    const Motion motion = record(scene, kFrames);
    for (const Across across : {Across::kX, Across::kY}) {
      Similarity mirror;
      mirror.mirror = across;
      const Motion image = seenBack(mirror, record(seen(mirror, scene), kFrames));
      EXPECT_EQ(firstDifference(motion, image), -1) << (across == Across::kX ? "across x, " : "across y, ")
                                                    << repeat(seed) << "; apart by " << farthestApart(motion, image);
    }
    EXPECT_GT(farthestGone(motion), 0.05) << repeat(seed);
    contacts += motion.statistics.contacts_max;
  }
  if (kind.touches) {
    EXPECT_GT(contacts, 0) << "nothing ever touched";
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, Mirror,
                         ::testing::Combine(::testing::Values(slack(), taut(), obstacles(), selfContact()),
                                            kEveryMethod),
                         nameOfKind);

}  // namespace
}  // namespace curtain
