// SPDX-License-Identifier: BSD-3-Clause
//
// Nothing in the engine knows where it is or which way it looks: a scene that is turned, with its gravity, or shifted,
// by a thousand kilometres as well, moves as it did. (Gusts are made along the world's axes and stay where they are;
// there are none here.)
//
// Tolerance: what a share of rounding comes to. How far a motion goes astray when everything is off by a share is
// measured (growthOf); the share is roundingShare() of the scene's size and place. Where strings pull or something
// touches, corrections are made in single precision, 2^-24 of them each: of the forces, about as much for each of the
// iterations whose errors the next ones do not see, eight at most. Within a tenth of the thickness contact leaves alone
// what it finds, so that much is added. Scenes that amplify a share of 1e-7 to a millimetre are chaotic and left out.
//
// Where strings pull or something touches, a substep is solved until links and contacts are within the scene's
// stretch_tolerance, and there are decisions on the way to that: whether a row is solved for, a block is looked at
// again, an iteration goes on. One that is as near as rounding falls the other way (seed 12, on the last of 30 frames),
// and the two motions are two solutions of the same substep. Their links differ by the tolerance, as if the scene's
// lengths were off by that share, so they may be apart by its growth. Few are: of what is off by 1e-6 of the tolerance,
// by its growth, one in thousands of decisions, a scene makes hundreds. Of 208 pairs with self-contact (240 seeds,
// leapfrog4) 22 were. More than every fourth would be something else. Both turns of a scene share one motion to compare
// with, so 16 scenes are looked at, and none that is chosen.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <string>

#include "properties/growth.h"
#include "properties/kinds.h"
#include "properties/seeds.h"
#include "properties/similarity.h"

namespace curtain {
namespace {

using namespace curtain_test;

constexpr int kMovedFrames = 30;
constexpr double kOff = 1e-7;
constexpr double kChaos = 1e-3;  // [m]
constexpr double kContactSlack = 0.1;

class RigidMotion : public ::testing::TestWithParam<std::tuple<Kind, Method>> {
 protected:
  // A scene that is not chaotic, its motion, and what there is to compare with.
  struct Trial {
    Scene scene;
    Motion motion;
    double growth = 0.0;
    bool fit = false;
    bool rods_alone = false;
  };
  Trial trialOf(std::uint64_t seed) const {
    const auto& [kind, method] = GetParam();
    Trial trial;
    trial.scene = randomScene(seed, kind.wanted);
    trial.scene.solver.method = method;
    trial.motion = record(trial.scene, kMovedFrames);
    trial.growth = growthOf(trial.scene, trial.motion, kOff, seed);
    trial.fit = trial.growth * kOff < kChaos;
    trial.rods_alone =
        kind.wanted.gentle && longestString(trial.scene, trial.motion) < 1.0 - trial.scene.solver.stretch_tolerance;
    return trial;
  }
  double tolerance(const Trial& trial, double size) const {
    const double single = trial.rods_alone ? 0.0 : kSingle;
    const double contact = trial.scene.contact.self ? kContactSlack * trial.scene.contact.thickness : 0.0;
    return trial.growth * (roundingShare(trial.scene, trial.motion, size) + single) + contact;
  }
  void expectSame(const Trial& trial, const Similarity& s, double size, const std::string& what) {
    const double apart = farthestApart(trial.motion, seenBack(s, record(seen(s, trial.scene), kMovedFrames)));
    const bool by_rounding = apart <= tolerance(trial, size);
    ++compared_;
    otherwise_ += by_rounding ? 0 : 1;
    EXPECT_TRUE(by_rounding || !trial.rods_alone) << what << ", growth " << trial.growth << ", apart " << apart;
    EXPECT_LE(apart, tolerance(trial, size) + trial.growth * trial.scene.solver.stretch_tolerance)
        << what << ", growth " << trial.growth;
    if (std::getenv("CURTAIN_PROPERTY_PRINT") != nullptr) {
      std::printf("%s: apart %.1e, tolerance %.1e\n", what.c_str(), apart, tolerance(trial, size));
    }
  }
  void expectFewSolvedOtherwise() const { EXPECT_LE(otherwise_, std::max(1, compared_ / 4)) << "of " << compared_; }

 private:
  int compared_ = 0, otherwise_ = 0;
};

// About any axis, gravity turned as well; and about the vertical, gravity plumb.
TEST_P(RigidMotion, TurnedSceneMovesTurned) {
  int fit = 0, rods_alone = 0;
  for (const std::uint64_t seed : seeds(16)) {
    const Trial trial = trialOf(seed);
    if (!trial.fit) continue;
    ++fit;
    rods_alone += trial.rods_alone ? 1 : 0;
    Random random(seed + 100);
    for (const bool plumb : {false, true}) {
      Similarity s;
      s.turn = Eigen::AngleAxisd(random.between(0.3, 3.0), plumb ? Vec3(Vec3::UnitZ()) : random.direction());
      expectSame(trial, s, 5.0, repeat(seed) + (plumb ? ", about the vertical" : ""));
    }
  }
  expectFewSolvedOtherwise();
  const Kind& kind = std::get<0>(GetParam());
  EXPECT_GT(fit, 0) << "all scenes are chaotic";
  if (kind.wanted.gentle) {
    EXPECT_GT(rods_alone, 0) << "strings pull in all of them";
  }
}

TEST_P(RigidMotion, ShiftedSceneMovesShifted) {
  for (const std::uint64_t seed : seeds(8)) {
    const Trial trial = trialOf(seed);
    if (!trial.fit) continue;
    Random random(seed + 200);
    for (const double size : {1.0, 1e3, 1e6}) {
      Similarity s;
      s.shift = size * random.direction();
      expectSame(trial, s, 5.0 + size, repeat(seed) + ", by " + std::to_string(size) + " m");
    }
  }
  expectFewSolvedOtherwise();
}

INSTANTIATE_TEST_SUITE_P(Scenes, RigidMotion,
                         ::testing::Combine(::testing::Values(slack(), taut(), obstacles(), mesh(), selfContact()),
                                            kEveryMethod),
                         nameOfKind);
INSTANTIATE_TEST_SUITE_P(Fabric, RigidMotion, ::testing::Combine(::testing::Values(fabric()), kMethodsThatBend),
                         nameOfKind);

}  // namespace
}  // namespace curtain
