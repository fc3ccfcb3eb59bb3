// SPDX-License-Identifier: BSD-3-Clause
//
// Snapshots: what is restored goes on as what was saved, to the bit.
#include "simulator/snapshot_testing.h"

#include <gtest/gtest.h>

namespace curtain {
namespace {

using curtain_test::expectContinues;
using curtain_test::flatScene;
using curtain_test::Life;

TEST(Snapshot, GoesOnByTheBits) {
  Scene scene = flatScene(12, 10);
  scene.hang.to.x() = 0.7;
  scene.hang.tilt = 0.5;
  for (const Method method : {Method::kAuto, Method::kLeapfrog, Method::kLeapfrog4, Method::kBdf2, Method::kImplicit, Method::kPaper}) {
    SCOPED_TRACE(toString(method));
    scene.solver.method = method;
    ASSERT_NO_FATAL_FAILURE(expectContinues(scene, Life()));
  }
}

}  // namespace
}  // namespace curtain
