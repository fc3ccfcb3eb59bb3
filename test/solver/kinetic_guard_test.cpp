// SPDX-License-Identifier: BSD-3-Clause
//
// What a substep may have of kinetic energy.
#include "solver/kinetic_guard.h"

#include <gtest/gtest.h>

#include <cmath>

#include "testing.h"

namespace curtain {
namespace {

using namespace curtain_test;

constexpr double kStep = 0.01;

// Cloth that moves at 1 m/s along x, with no forces.
struct Moving {
  explicit Moving(PinKind pins = PinKind::kNone)
      : scene(sceneOf(pins)), pattern(makePattern(scene)), state(makeInitialState(scene, pattern)), inertia(pattern), guard(pattern, inertia, 1e-6, 0.1) {
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
  SubstepStart start() const { return {state, force, nullptr, nullptr, kStep, kStep}; }
  /// Where the nodes are when they went at `factor` of their speed.
  Field3 end(double factor) const {
    Field3 end = state.position;
    for (std::size_t n = 0; n < pattern.grid.size(); ++n) end.add(n, factor * kStep * state.velocity.at(n));
    return end;
  }

  Scene scene;
  ClothPattern pattern;
  ClothState state;
  Field3 force;
  NodeInertia inertia;
  KineticGuard guard;
};

TEST(KineticGuard, FindsWhatASubstepHasGained) {
  const Moving cloth;
  const auto look = [&](double energy) { return cloth.guard.look(cloth.start(), cloth.end(std::sqrt(energy)), 0.0); };
  EXPECT_FALSE(std::isfinite(look(0.5).most));
  EXPECT_FALSE(std::isfinite(look(1.0).most));
  EXPECT_NEAR(look(1.2).most, cloth.guard.most(cloth.state.velocity, 0.0), 64.0 * kEps);
  EXPECT_TRUE(look(1.2).jumps);
}

// Pins that go by at the cloth's speed: seen from them it may turn round, and go at three times that.
TEST(KineticGuard, PinsMayPutEnergyIn) {
  Moving cloth(PinKind::kTop);
  const double alone = cloth.guard.most(cloth.start(), cloth.end(1.0), 0.0);
  double pinned = 0.0, free = 0.0;
  for (std::size_t n = 0; n < cloth.pattern.grid.size(); ++n) {
    (cloth.pattern.inverse_mass[n] > 0.0 ? free : pinned) += cloth.pattern.mass[n];
    if (cloth.pattern.inverse_mass[n] <= 0.0) cloth.state.velocity.set(n, Vec3::UnitX());
  }
  EXPECT_NEAR(alone, free, 16.0 * kEps * free);
  EXPECT_NEAR(cloth.guard.most(cloth.start(), cloth.end(1.0), 0.0), 9.0 * free, 64.0 * 9.0 * kEps * free);
}

TEST(KineticGuard, SlowsFreeNodesDownAndNotPins) {
  Moving cloth(PinKind::kTop);
  const std::size_t pin = cloth.pattern.grid.index(0, 2), node = cloth.pattern.grid.index(3, 2);
  cloth.state.velocity.set(pin, Vec3::UnitY());
  Field3 velocity = cloth.state.velocity;
  cloth.guard.bound(1e9, velocity);
  EXPECT_EQ(velocity.at(node), cloth.state.velocity.at(node));
  double free = 0.0;
  for (std::size_t n = 0; n < cloth.pattern.grid.size(); ++n) free += cloth.pattern.inverse_mass[n] > 0.0 ? cloth.pattern.mass[n] : 0.0;
  cloth.guard.bound(0.25 * free, velocity);
  EXPECT_NEAR(velocity.at(node).x(), 0.5, 64.0 * kEps);
  EXPECT_EQ(velocity.at(pin), Vec3(Vec3::UnitY()));
}

}  // namespace
}  // namespace curtain
