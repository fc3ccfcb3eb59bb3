// SPDX-License-Identifier: BSD-3-Clause
#include "step/contacts.h"

#include <gtest/gtest.h>

#include <cmath>

#include "scene/infinity.h"
#include "step/constants.h"

namespace curtain {
namespace {

constexpr double kStep = 0.01, kLink = 0.05;

Contact pushing() {
  Contact contact;
  contact.obstacle = 0;
  contact.push = 1.0;
  contact.curved = true;
  contact.asked = 0.004;
  contact.leans = true;
  return contact;
}

TEST(LongestStep, IsUnboundedWhereNothingMoves) {
  EXPECT_EQ(longestStep({}, kStep, kLink), kInfinity);
  EXPECT_EQ(longestStep({pushing()}, kStep, kLink), kInfinity);
}

TEST(LongestStep, OfWhatStaysGoesByTheLinkAndOfWhatArrivesByTheDistanceKept) {
  Contact contact = pushing();
  contact.surface_velocity = Vec3(0.0, 3.0, 4.0);
  EXPECT_DOUBLE_EQ(longestStep({contact}, kStep, kLink), kMaxSurfaceMotion * kLink / 5.0);
  contact.leans = false;
  EXPECT_DOUBLE_EQ(longestStep({contact}, kStep, kLink), 0.004 / 5.0);
  contact.curved = false;  // comes out of what it is inside of
  EXPECT_DOUBLE_EQ(longestStep({contact}, kStep, kLink), kMaxSurfaceMotion * kLink / 5.0);
}

TEST(LongestStep, LetsNormalsTurnByALittle) {
  Contact contact = pushing();
  constexpr double kAngle = 0.5;
  contact.level = Vec3(std::sin(kAngle), 0.0, std::cos(kAngle));
  EXPECT_NEAR(longestStep({contact}, kStep, kLink), kStep * kMaxTurn / kAngle, 0.02 * kStep);
}

TEST(LongestStep, IsNoMatterOfWhatDoesNotPushNorOfTheClothItself) {
  Contact contact = pushing();
  contact.surface_velocity = Vec3(0.0, 3.0, 4.0);
  contact.push = 0.0;
  EXPECT_EQ(longestStep({contact}, kStep, kLink), kInfinity);
  contact.push = 1.0;
  contact.obstacle = Contact::kCloth;
  EXPECT_EQ(longestStep({contact}, kStep, kLink), kInfinity);
}

TEST(ContactRows, CountWhatLacksMoreThanItsRoomAsMoreThanTheTolerance) {
  constexpr double kTolerance = 1e-4, kLacks = 1e-5;
  Field3 position;
  position.assign(1, 0.0);
  Contact contact = pushing();
  contact.weight[0] = contact.mobility = 1.0;
  contact.offset = kLacks;
  Contacts contacts{contact};
  ContactRows rows(kLink);
  rows.show(&contacts);
  EXPECT_DOUBLE_EQ(rows.residual(position, true, kTolerance), kLacks);
  contacts[0].room = 2.0 * kLacks;
  EXPECT_DOUBLE_EQ(rows.residual(position, true, kTolerance), 0.5 * kTolerance);
  contacts[0].room = 0.5 * kLacks;
  EXPECT_DOUBLE_EQ(rows.residual(position, true, kTolerance), 2.0 * kTolerance);
  position.z[0] = 2.0 * kLacks;  // the other way it has room enough
  EXPECT_DOUBLE_EQ(rows.residual(position, true, kTolerance), kLacks);
}

}  // namespace
}  // namespace curtain
