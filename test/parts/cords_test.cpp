// SPDX-License-Identifier: BSD-3-Clause
//
// Loops of tie-backs in a substep: those that wait, as all do in the last resort, drive nothing.
#include "parts/cords/cords.h"

#include <gtest/gtest.h>

#include "testing.h"

namespace curtain {
namespace {

TEST(Cords, HaveARateOnlyWhereTheirLoopDraws) {
  Scene scene = curtain_test::flatScene(4, 5, 1.0, 1.0);
  scene.tie_back.emplace_back();
  TieBackParams& loop = scene.tie_back.back();
  loop.id = "tie";
  loop.row = 2;
  loop.last_column = 4;
  loop.point = Vec3(0.0, -1.0, 1.0);
  const ClothPattern pattern = makePattern(scene);
  ClothState state = makeInitialState(scene, pattern);
  Cords cords(pattern);
  std::vector<DistanceRow> rows(cords.count());
  cords.attach(rows.data());
  cords.reset(state);
  const double before = state.reach[0];
  ASSERT_GT(before, loop.radius);
  Field3 force, next = state.position;
  force.assign(pattern.grid.size(), 0.0);
  const SubstepStart start{state, force, nullptr, nullptr, 1e-3, 1e-3};
  for (const bool drives : {false, true}) {
    cords.begin(start, state, pattern.inverse_mass, drives, next);
    cords.commit(start, next, state);
    for (const DistanceRow& row : rows) EXPECT_DOUBLE_EQ(row.rate, drives ? -loop.speed : 0.0);
    EXPECT_EQ(state.reach[0] < before, drives);
  }
}

}  // namespace
}  // namespace curtain
