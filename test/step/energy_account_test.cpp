// SPDX-License-Identifier: BSD-3-Clause
//
// What a substep may have of kinetic energy.
#include "step/energy_account.h"

#include <gtest/gtest.h>

#include <cmath>

#include "step/contacts.h"
#include "testing.h"

namespace curtain {
namespace {

using namespace curtain_test;

constexpr double kAccountStep = 0.01;
constexpr Scheme::Rules kRules = {false, false, 0.5};  // leapfrog's

// Cloth that moves at 1 m/s along x, with no forces.
struct Moving {
  explicit Moving(PinKind pins = PinKind::kNone)
      : scene(sceneOf(pins)),
        pattern(makePattern(scene)),
        state(makeInitialState(scene, pattern)),
        inertia(pattern),
        account(pattern, inertia, 1e-6, 0.1) {
    force.assign(pattern.grid.size(), 0.0);
    for (std::size_t n = 0; n < pattern.grid.size(); ++n) {
      if (pattern.inverse_mass[n] > 0.0) state.velocity.set(n, Vec3::UnitX());
    }
  }
  static Scene sceneOf(PinKind pins) {
    Scene scene = flatScene(5, 6);
    scene.pins.kind = pins;
    return scene;
  }
  SubstepStart start() const { return {state, force, nullptr, nullptr, kAccountStep, kAccountStep}; }
  /// Where the nodes are when they went at `factor` of their speed.
  Field3 end(double factor) const {
    Field3 end = state.position;
    for (std::size_t n = 0; n < pattern.grid.size(); ++n) end.add(n, factor * kAccountStep * state.velocity.at(n));
    return end;
  }

  double freeMass() const {
    double free = 0.0;
    for (std::size_t n = 0; n < pattern.grid.size(); ++n) free += pattern.inverse_mass[n] > 0.0 ? pattern.mass[n] : 0.0;
    return free;
  }

  Scene scene;
  ClothPattern pattern;
  ClothState state;
  Field3 force;
  NodeInertia inertia;
  EnergyAccount account;
};

TEST(EnergyAccount, FindsWhatASubstepHasGained) {
  const Moving cloth;
  const auto look = [&](double energy) {
    return cloth.account.entryOf(kRules, cloth.start(), cloth.end(std::sqrt(energy)), {}, 0.0);
  };
  EXPECT_FALSE(std::isfinite(look(0.5).most));
  EXPECT_FALSE(std::isfinite(look(1.0).most));
  EXPECT_NEAR(look(1.2).most, cloth.account.most(cloth.state.velocity, 0.0), 64.0 * kEps);
  EXPECT_GT(look(1.2).made, 0.0);
}

// What links take is held as far as they can hold it, and given back once.
TEST(EnergyAccount, LinksGiveBackWhatTheyHold) {
  Moving cloth;
  const double free = cloth.freeMass();
  const auto substep = [&](double energy, double can_hold) {
    const EnergyAccount::Entry entry =
        cloth.account.entryOf(kRules, cloth.start(), cloth.end(std::sqrt(energy)), {}, can_hold);
    cloth.account.setHeld(entry.held);
    return entry;
  };
  EXPECT_NEAR(substep(0.8, 0.3 * free).held, 0.2 * free, 64.0 * kEps * free);
  EXPECT_NEAR(substep(0.8, 0.3 * free).held, 0.3 * free, 64.0 * kEps * free);  // more is lost
  EXPECT_FALSE(std::isfinite(substep(1.2, 0.3 * free).most));
  EXPECT_NEAR(cloth.account.held(), 0.1 * free, 64.0 * kEps * free);
  const EnergyAccount::Entry made = substep(1.2, 0.3 * free);
  EXPECT_NEAR(made.most, 1.1 * free, 64.0 * kEps * free);
  EXPECT_GT(made.made, 0.0);
  EXPECT_EQ(made.held, 0.0);
}

// What moves may take what links seem to: they hold nothing of it.
TEST(EnergyAccount, PinsThatMoveTakeForThemselves) {
  Moving cloth(PinKind::kTopCorners);
  cloth.state.velocity.set(cloth.pattern.grid.index(0, 0), Vec3::UnitY());
  EXPECT_EQ(cloth.account.entryOf(kRules, cloth.start(), cloth.end(0.5), {}, cloth.freeMass()).held, 0.0);
}

// Two pins that go apart at the cloth's speed: seen from one it may turn round, and go at three times that.
TEST(EnergyAccount, PinsThatMoveApartMayPutEnergyIn) {
  Moving cloth(PinKind::kTopCorners);
  const double free = cloth.freeMass();
  const Grid& grid = cloth.pattern.grid;
  EXPECT_NEAR(cloth.account.most(kRules, cloth.start(), cloth.end(1.0), {}), free, 16.0 * kEps * free);
  cloth.state.velocity.set(grid.index(0, 0), Vec3::UnitY());
  cloth.state.velocity.set(grid.index(0, grid.columns - 1), -Vec3::UnitY());
  EXPECT_NEAR(cloth.account.most(kRules, cloth.start(), cloth.end(1.0), {}), 9.0 * free, 64.0 * 9.0 * kEps * free);
}

// Pins that all move alike are the frame that energy is seen from: cloth that goes with them has none.
TEST(EnergyAccount, PinsThatMoveAlikePutNoneIn) {
  Moving cloth(PinKind::kTop);
  for (int j = 0; j < cloth.pattern.grid.columns; ++j)
    cloth.state.velocity.set(cloth.pattern.grid.index(0, j), Vec3::UnitX());
  const double free = cloth.freeMass();
  EXPECT_NEAR(cloth.account.most(kRules, cloth.start(), cloth.end(1.0), {}), 0.0, 16.0 * kEps * free);
  EXPECT_GT(cloth.account.entryOf(kRules, cloth.start(), cloth.end(1.5), {}, 0.0).made, 0.0);
  EXPECT_GT(cloth.account.entryOf(kRules, cloth.start(), cloth.end(0.5), {}, 0.0).made, 0.0);
}

// A force that holds the cloth up: cloth at rest that goes against it, or with it further than it drives, has got that
// from nowhere.
TEST(EnergyAccount, ForcesPutInTheirWork) {
  Moving cloth;
  const Field3 moving = cloth.state.velocity;
  cloth.state.velocity.assign(cloth.pattern.grid.size(), 0.0);
  for (std::size_t n = 0; n < cloth.pattern.grid.size(); ++n)
    cloth.force.set(n, cloth.pattern.mass[n] / kAccountStep * moving.at(n));
  const auto look = [&](double speed) {
    Field3 end = cloth.state.position;
    for (std::size_t n = 0; n < cloth.pattern.grid.size(); ++n) end.add(n, speed * kAccountStep * moving.at(n));
    return cloth.account.entryOf(kRules, cloth.start(), end, {}, 0.0);
  };
  EXPECT_EQ(look(1.0).made, 0.0);  // m v^2 / 2 = F v / 2 over the step
  EXPECT_EQ(look(0.5).made, 0.0);
  EXPECT_GT(look(1.1).made, 0.0);
  EXPECT_GT(look(-0.5).made, 0.0);
}

TEST(EnergyAccount, SlowsFreeNodesDownAndNotPins) {
  Moving cloth(PinKind::kTop);
  const std::size_t pin = cloth.pattern.grid.index(0, 2), node = cloth.pattern.grid.index(3, 2);
  Field3 velocity = cloth.state.velocity;
  cloth.account.bound(1e9, velocity);
  EXPECT_EQ(velocity.at(node), cloth.state.velocity.at(node));
  cloth.account.bound(0.25 * cloth.freeMass(), velocity);
  EXPECT_NEAR(velocity.at(node).x(), 0.5, 64.0 * kEps);
  EXPECT_EQ(velocity.at(pin), Vec3(Vec3::Zero()));
}

// What links that can't hold pull is beyond all measure; and cloth at rest beside pins that move is slowed down by
// nothing.
TEST(EnergyAccount, BoundsWhatIsBeyondMeasure) {
  Moving cloth;
  const double most = 0.25 * cloth.freeMass();
  Field3 velocity = cloth.state.velocity;
  for (std::size_t n = 0; n < cloth.pattern.grid.size(); ++n) velocity.set(n, 1e12 * velocity.at(n));
  cloth.account.bound(most, velocity);
  EXPECT_NEAR(velocity.at(cloth.pattern.grid.index(3, 2)).x(), 0.5, 64.0 * kEps);
  Moving beside(PinKind::kTop);
  Field3 resting = beside.state.velocity;
  resting.assign(beside.pattern.grid.size(), 0.0);
  for (int j = 0; j < beside.pattern.grid.columns; ++j) resting.set(beside.pattern.grid.index(0, j), Vec3::UnitX());
  beside.account.bound(0.0, resting);
  EXPECT_EQ(resting.at(beside.pattern.grid.index(3, 2)), Vec3(Vec3::Zero()));
}

// What is too deep comes out within the step: that counts as what drives it, unless nothing pushes.
TEST(Contacts, DrivePointsOutOfWhereTheyWere) {
  Contact contact;
  contact.recovery = 2e-3;
  EXPECT_EQ(fastestDrive({contact}, kAccountStep), 0.0);
  contact.push = 1.0;
  EXPECT_EQ(fastestDrive({contact}, kAccountStep), 2e-3 / kAccountStep);
}

}  // namespace
}  // namespace curtain
