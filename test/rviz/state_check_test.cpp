// SPDX-License-Identifier: BSD-3-Clause
//
// Messages of any content are judged, never drawn when they are wrong: what passes can be made a surface of.
#include "rviz/surface/state_check.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <random>

#include "rviz/state_of.h"
#include "rviz/surface/curtain_surface.h"
#include "rviz/surface/layers.h"

namespace curtain_rviz {
namespace {

using curtain_sim::CurtainState;
using curtain_test::blownCloth;
using curtain_test::loadsOf;
using curtain_test::stateOf;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinite = std::numeric_limits<float>::infinity();

TEST(StateCheck, WhatTheNodeSendsIsSound) {
  for (const bool closed : {false, true}) {
    const curtain::Simulator simulator = blownCloth(closed);
    for (const bool folds : {false, true}) EXPECT_EQ(whatIsWrong(stateOf(simulator, folds)), "");
    EXPECT_EQ(whatIsWrong(loadsOf(simulator), stateOf(simulator)), "");
  }
}

struct Fault {
  const char* field;  // that the text must name
  std::function<void(CurtainState&)> make;
};

TEST(StateCheck, EveryFaultIsNamed) {
  const std::vector<Fault> faults = {
      {"rows", [](CurtainState& s) { s.rows = 1; }},
      {"rows", [](CurtainState& s) { s.rows = 0; }},
      {"columns", [](CurtainState& s) { s.columns = 1; }},
      {"rows", [](CurtainState& s) { s.rows = s.columns = 0xFFFFFFFFU; }},
      {"rows", [](CurtainState& s) { s.rows = 0x80000001U; }},
      {"positions", [](CurtainState& s) { s.columns = 8; }},
      {"folds", [](CurtainState& s) { s.folds = 0; }},
      {"folds", [](CurtainState& s) { s.folds = 65; }},
      {"positions", [](CurtainState& s) { s.positions.pop_back(); }},
      {"positions", [](CurtainState& s) { s.positions.clear(); }},
      {"positions", [](CurtainState& s) { s.positions[7] = kNan; }},
      {"positions", [](CurtainState& s) { s.positions[7] = -kInfinite; }},
      {"velocities", [](CurtainState& s) { s.velocities.push_back(0.0F); }},
      {"velocities", [](CurtainState& s) { s.velocities[0] = kInfinite; }},
      {"warp_rest", [](CurtainState& s) { s.warp_rest.clear(); }},
      {"warp_rest", [](CurtainState& s) { s.warp_rest[0] = 0.0F; }},
      {"weft_rest", [](CurtainState& s) { s.weft_rest.pop_back(); }},
      {"weft_rest", [](CurtainState& s) { s.weft_rest[3] = -1.0F; }},
      {"weft_rest", [](CurtainState& s) { s.weft_rest[3] = kNan; }},
      {"weft_rest", [](CurtainState& s) { s.closed = true; }},
      {"slit_columns", [](CurtainState& s) { s.slit_columns = {2}; }},
      {"slit_columns", [](CurtainState& s) { s.slit_columns.assign(7, 2), s.slit_rows.assign(7, 0); }},
      {"slit_columns", [](CurtainState& s) { s.slit_columns = {6}, s.slit_rows = {0}; }},
      {"slit_rows", [](CurtainState& s) { s.slit_columns = {2}, s.slit_rows = {8}; }},
      {"fold_nodes", [](CurtainState& s) { s.fold_nodes.resize(3); }},
      {"fold_nodes", [](CurtainState& s) { s.fold_nodes.assign(3 * 8 * 6 * 3, kNan); }},
      {"winds", [](CurtainState& s) { s.winds[0].pressure = std::numeric_limits<double>::quiet_NaN(); }},
      {"winds", [](CurtainState& s) { s.winds[0].radius = 0.0; }},
      {"winds", [](CurtainState& s) { s.winds[0].half_angle = 1.6; }},
      {"winds", [](CurtainState& s) { s.winds[0].pose.orientation = {}; }},
      {"winds", [](CurtainState& s) { s.winds[0].pose.position.x = std::numeric_limits<double>::infinity(); }},
  };
  const CurtainState sound = stateOf(blownCloth(false));
  ASSERT_EQ(sound.winds.size(), 1u);
  for (std::size_t i = 0; i < faults.size(); ++i) {
    CurtainState state = sound;
    faults[i].make(state);
    EXPECT_NE(whatIsWrong(state).find(faults[i].field), std::string::npos) << i << ": '" << whatIsWrong(state) << "'";
  }
}

TEST(StateCheck, LoadsMustBeOfTheState) {
  const curtain::Simulator simulator = blownCloth(false);
  const CurtainState state = stateOf(simulator);
  curtain_sim::Loads loads = loadsOf(simulator);
  loads.weft_tension.pop_back();
  EXPECT_NE(whatIsWrong(loads, state).find("weft_tension"), std::string::npos);
  loads = loadsOf(simulator);
  loads.warp_tension[1] = kNan;
  EXPECT_NE(whatIsWrong(loads, state).find("warp_tension"), std::string::npos);
  loads = loadsOf(simulator);
  loads.contact_forces.clear();
  EXPECT_NE(whatIsWrong(loads, state).find("contact_forces"), std::string::npos);
  loads = loadsOf(simulator);
  std::swap(loads.rows, loads.columns);
  EXPECT_NE(whatIsWrong(loads, state), "");
}

// Whatever passes gives finite vertices: random numbers in random places, sizes that are off by a little.
TEST(StateCheck, WhatPassesCanBeDrawn) {
  std::mt19937 bits(7);
  const auto below = [&](std::size_t n) { return static_cast<std::size_t>(bits() % n); };
  const std::vector<float> odd = {0.0F, -0.0F, 1e-38F, 1e-9F, 1.0F, -1.0F, 1e9F, -1e9F, 1e30F, kNan, kInfinite};
  const curtain::Simulator open = blownCloth(false), ring = blownCloth(true);
  int passed = 0;
  for (int run = 0; run < 3000; ++run) {
    CurtainState state = stateOf(run % 2 == 0 ? ring : open, run % 3 == 0);
    for (std::size_t change = below(3); change > 0; --change) {
      std::vector<float>* const arrays[] = {&state.positions, &state.velocities, &state.warp_rest, &state.weft_rest,
                                            &state.fold_nodes};
      std::vector<float>& array = *arrays[below(5)];
      if (below(8) == 0) array.resize(below(2 * array.size() + 2));
      if (!array.empty()) array[below(array.size())] = odd[below(odd.size())];
    }
    if (below(10) == 0) state.folds = static_cast<std::uint32_t>(below(70));
    if (!whatIsWrong(state).empty()) continue;
    ++passed;
    CurtainSurface surface;
    surface.update(state);
    for (const SurfaceVertex& vertex : surface.vertices()) {
      for (const float x : vertex.position) ASSERT_TRUE(std::isfinite(x));
      for (const float x : vertex.normal) ASSERT_TRUE(std::isfinite(x));
      ASSERT_TRUE(std::isfinite(vertex.hollow));
    }
    std::vector<float> values;
    for (const Layer layer : {Layer::kSpeed, Layer::kStrain}) {
      valuesOf(layer, state, nullptr, values);
      for (const float value : values) ASSERT_TRUE(std::isfinite(value) && value >= 0.0F);
    }
  }
  EXPECT_GT(passed, 500);
}

}  // namespace
}  // namespace curtain_rviz
