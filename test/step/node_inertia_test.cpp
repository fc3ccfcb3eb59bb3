// SPDX-License-Identifier: BSD-3-Clause
//
// How nodes answer an impulse: by their masses, less where air damps them, as if heavier where tensions would make them
// swing too fast, not at all where they are held.
#include "step/node_inertia.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "testing.h"

namespace curtain {
namespace {

constexpr double kInertiaStep = 1e-3;

// Nodes of equal mass; the first row is pinned.
struct Nodes {
  Nodes() {
    Scene scene = curtain_test::flatScene(4, 3);
    scene.cloth.lumping = Lumping::kUniform;
    pattern = makePattern(scene);
    inertia.emplace(pattern);
    mass = pattern.mass[node];
  }
  void set(double max_phase, bool implicit = false) {
    inertia->set(forces, kInertiaStep, kInertiaStep * kInertiaStep, max_phase, implicit);
  }
  // One node's links carry so many times its mass in a last substep of the same length.
  void load(double masses) {
    NodeInertia::Tensions& tensions = inertia->tensions();
    tensions.load[node] = masses * mass;
    tensions.heaviest = masses;
    tensions.scale = kInertiaStep * kInertiaStep;
  }

  ClothPattern pattern;
  std::size_t node = Grid(4, 3, false).index(2, 1), other = Grid(4, 3, false).index(3, 1);
  double mass = 0.0;
  NodeForces forces;
  std::optional<NodeInertia> inertia;
};

TEST(NodeInertia, WithoutAirAndTensionsItIsTheMasses) {
  Nodes nodes;
  nodes.set(1.9);
  EXPECT_TRUE(nodes.inertia->massesAlone());
  EXPECT_EQ(nodes.inertia->keep(), nullptr);
  EXPECT_EQ(nodes.inertia->inverse()[nodes.node], 1.0 / nodes.mass);
  EXPECT_EQ(nodes.inertia->inverse()[nodes.pattern.grid.index(0, 1)], 0.0);
}

TEST(NodeInertia, AirTakesAShareOfImpulseAndVelocity) {
  Nodes nodes;
  nodes.forces.has_damping = true;
  nodes.forces.damping.assign(nodes.pattern.grid.size(), 2.0 * nodes.mass / kInertiaStep);  // z = 2
  nodes.set(0.0);
  EXPECT_DOUBLE_EQ((*nodes.inertia->keep())[nodes.node], 1.0 / 5.0);
  EXPECT_DOUBLE_EQ(nodes.inertia->inverse()[nodes.node], 2.0 / 5.0 / nodes.mass);
  nodes.set(0.0, true);
  EXPECT_DOUBLE_EQ((*nodes.inertia->keep())[nodes.node], 1.0 / 3.0);
  EXPECT_DOUBLE_EQ(nodes.inertia->inverse()[nodes.node], 1.0 / 3.0 / nodes.mass);
}

// omega^2 = 2 load / (m h^2): a phase of sqrt(8) with four masses on it; eight times as heavy it is one.
TEST(NodeInertia, ANodeThatSwingsTooFastIsHeavierUntilItsPhaseIsTheOneAllowed) {
  Nodes nodes;
  nodes.load(4.0);
  EXPECT_DOUBLE_EQ(nodes.inertia->omegaSquared() * kInertiaStep * kInertiaStep, 8.0);
  nodes.set(1.0);
  EXPECT_DOUBLE_EQ(nodes.inertia->inverse()[nodes.node], 0.125 / nodes.mass);
  EXPECT_EQ(nodes.inertia->inverse()[nodes.other], 1.0 / nodes.mass);
  nodes.set(4.0);
  EXPECT_TRUE(nodes.inertia->massesAlone());
}

// Nine nodes are not pinned.
TEST(NodeInertia, NoNodeIsHeavierThanAllOfTheCloth) {
  Nodes nodes;
  nodes.load(1e6);
  nodes.set(1.0);
  EXPECT_DOUBLE_EQ(nodes.inertia->inverse()[nodes.node], 1.0 / (9.0 * nodes.mass));
}

TEST(NodeInertia, AStepForAPhaseIsLongerWhereFewNodesMayBeHeavier) {
  Nodes nodes;
  EXPECT_TRUE(std::isinf(nodes.inertia->stepForPhase(1.0, 0.0)));
  nodes.load(5.0);
  EXPECT_DOUBLE_EQ(nodes.inertia->stepForPhase(1.0, 0.0), kInertiaStep / std::sqrt(10.0));
  // A third of the nine free nodes' mass: the one may weigh four times as much, and the step be twice as long.
  const double step = nodes.inertia->stepForPhase(1.0, 1.0 / 3.0);
  const double longest = 2.0 * kInertiaStep / std::sqrt(10.0);
  EXPECT_LE(step, longest * (1.0 + 1e-12));
  EXPECT_GE(step, longest * std::exp2(-1.0 / 64.0));  // the weight to within 2^(1/32)
}

}  // namespace
}  // namespace curtain
