// SPDX-License-Identifier: BSD-3-Clause
//
// Parts of a cloth that are of other fabrics: a patch over all of it is a cloth of that fabric, to the bit; over a part
// it acts on its nodes alone, in closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "curtain_sim/scene_yaml.h"
#include "parts/wind/wind_source.h"
#include "simulator/scenes.h"
#include "simulator/strips.h"
#include "testing.h"

namespace curtain_test {
namespace {

using namespace curtain;

// Hangs by its corners, aslant, in a gusty wind, and touches itself.
Scene clothInWind(bool relative) {
  Scene scene = flatScene(9, 8);
  scene.hang.tilt = 0.9;
  scene.pins.kind = PinKind::kTopCorners;
  scene.contact.self = true;
  if (relative) scene.air.law = AirLaw::kRelative;
  WindParams fan = fanAt({0.4, -1.0, 0.6}, 0.8);
  fan.pressure = 5.0;
  fan.unsteadiness = 3.0;
  scene.wind.push_back(fan);
  return scene;
}

TEST(Patches, OverAllOfTheClothAreItsFabric) {
  const std::map<std::string, std::function<void(ClothParams&, PatchParams&)>> fabrics = {
      {"density", [](ClothParams& cloth, PatchParams& patch) { patch.surface_density = cloth.surface_density = 0.45; }},
      {"porosity", [](ClothParams& cloth, PatchParams& patch) { patch.porosity = cloth.porosity = 0.4; }},
      {"shear", [](ClothParams& cloth, PatchParams& patch) { patch.shear = cloth.shear = 35.0; }},
      {"warp", [](ClothParams& cloth, PatchParams& patch) { patch.bending_warp = cloth.bending_warp = 2e-4; }},
      {"weft", [](ClothParams& cloth, PatchParams& patch) { patch.bending_weft = cloth.bending_weft = 3e-4; }},
      {"bias", [](ClothParams& cloth, PatchParams& patch) { patch.bending_bias = cloth.bending_bias = 4e-4; }},
      {"hysteresis",
       [](ClothParams& cloth, PatchParams& patch) {
         patch.bending_warp = cloth.bending_warp = 2e-4;
         patch.bending_hysteresis = cloth.bending_hysteresis = 5e-3;
       }},
      {"push", [](ClothParams& cloth, PatchParams& patch) {
         patch.shear = cloth.shear = 35.0;
         patch.bending_weft = cloth.bending_weft = 3e-4;
       }}};
  for (const bool relative : {false, true}) {
    for (const auto& [name, make] : fabrics) {
      Scene whole = clothInWind(relative);
      Scene patched = whole;
      PatchParams patch;
      make(whole.cloth, patch);
      patched.cloth.patches = {patch};
      Simulator a(whole), b(patched), plain(clothInWind(relative));
      for (int frame = 0; frame < 30; ++frame) {
        a.step();
        b.step();
        plain.step();
        ASSERT_EQ(a.stateHash(), b.stateHash()) << name << (relative ? ", relative air" : "") << ", frame " << frame;
      }
      EXPECT_NE(a.stateHash(), plain.stateHash()) << name << ": has no effect";
    }
  }
}

TEST(Patches, ActOnTheirNodesAndLaterOnesHold) {
  Scene scene = flatScene(7, 6);
  PatchParams rows, block;
  rows.rows = {2, 4};
  rows.surface_density = 0.5;
  rows.porosity = 1.0;
  block.rows = {4, 5};
  block.columns = {1, 3};
  block.surface_density = 0.7;
  scene.cloth.patches = {rows, block};
  ASSERT_TRUE(validate(scene).empty()) << describe(validate(scene));
  const ClothPattern pattern = makePattern(scene);
  const auto isIn = [](int at, int first, int last) { return at >= first && at <= last; };
  WindParams wind = fanAt({0.5, -1.0, 0.5}, 10.0);
  wind.half_angle = 0.0;
  wind.pressure = 4.0;
  WindSource source(wind, pattern, Layers(scene), 1);
  const Field3 position = makeInitialState(scene, pattern).position;
  Field3 normals, force;
  for (Field3* const field : {&normals, &force}) field->assign(pattern.grid.size(), 0.0);
  nodeAreaVectors(pattern.grid, position, normals);
  source.find(pattern.grid, position, {Vec3::Constant(-9.0), Vec3::Constant(9.0)});
  source.addForces(pattern, position, normals, 0.0, force);
  for (int i = 0; i < 7; ++i) {
    for (int j = 0; j < 6; ++j) {
      const std::size_t n = pattern.grid.index(i, j);
      const bool in_block = isIn(i, 4, 5) && isIn(j, 1, 3), in_rows = isIn(i, 2, 4);
      const double density = in_block ? 0.7 : in_rows ? 0.5 : scene.cloth.surface_density;
      EXPECT_DOUBLE_EQ(pattern.mass[n], density * pattern.area[n]) << i << ", " << j;
      // The block gives no porosity: there it is that of the rows where these are, too.
      EXPECT_EQ(force.at(n).norm() > 0.0, !in_rows) << i << ", " << j;
    }
  }
}

// A cantilever of two rigidities: at a small angle the moment w (L - x)^2 / 2 of its weight bends each part by M / B,
// so its tip drops by w / 8 ((L^4 - (L - a)^4) / B_1 + (L - a)^4 / B_2), a being where the joints of the second one
// begin, half a link before its first node. Large angles lower that by less than the square of the drop over the
// length.
TEST(Patches, BendAsBeamsOfTwoRigidities) {
  for (const bool along_warp : {true, false}) {
    for (const double ratio : {0.25, 4.0}) {
      Strip strip;
      strip.along_warp = along_warp;
      strip.rods = 20;
      strip.rigidity = 4.0;
      Scene scene = stripScene(strip);
      const int first = 1 + strip.rods / 2;  // the clamp ends at node 1
      PatchParams patch;
      (along_warp ? patch.rows : patch.columns) = {first, strip.rods + 1};
      (along_warp ? patch.bending_warp : patch.bending_weft) = ratio * strip.rigidity;
      scene.cloth.patches = {patch};
      scene.solver.method = Method::kLeapfrog;
      scene.solver.substeps = 400;  // short ones: no joint gives way
      scene.solver.max_substeps = 10000;
      scene.solver.stretch_tolerance = 1e-8;
      const double rod = strip.length / strip.rods, rest = strip.length - (first - 1.5) * rod;
      const double weight = strip.density * kGravity;
      const double exact =
          weight / 8.0 / strip.rigidity * (std::pow(strip.length, 4) - std::pow(rest, 4) + std::pow(rest, 4) / ratio);
      const double found = sinkToRest(strip, scene).drop;
      std::printf("%s, %g times as stiff: drop %.5f m, linear theory %.5f m\n", along_warp ? "warp" : "weft", ratio,
                  found, exact);
      EXPECT_NEAR(found / exact, 1.0, exact * exact + rod * rod / (strip.length * strip.length)) << ratio;
    }
  }
}

TEST(Patches, CoverThoseBelowThem) {
  ClothParams cloth = flatScene(6, 5).cloth;
  PatchParams corner, rows, all;
  corner.rows = {1, 2};
  corner.columns = {0, 1};
  corner.shear = 5.0;
  rows.rows = {0, 3};
  rows.porosity = 0.5;
  addPatch(corner, cloth);
  addPatch(rows, cloth);
  ASSERT_EQ(cloth.patches.size(), 1U) << "the corner is covered";
  EXPECT_EQ(cloth.patches[0].porosity, 0.5);
  addPatch(corner, cloth);
  EXPECT_EQ(cloth.patches.size(), 2U);
  addPatch(all, cloth);
  EXPECT_TRUE(cloth.patches.empty()) << "nothing is given";
}

TEST(Patches, TakeTheirFabricFromAMaterialAndWhatIsGivenWins) {
  const SceneReading reading = readSceneText(
      "cloth: {rows: 6, columns: 5, shear: 7.0, patches: [{material: velvet, porosity: 0.5}, {rows: [0, 1], shear: "
      "3.0}]}\n"
      "layers: [{name: back, cloth: {rows: 6, columns: 4, patches: [{columns: [0, 3], material: linen}]},\n"
      "          hang: {from: [0, 1, 2], to: [1, 1, 2]}}]\n");
  ASSERT_TRUE(reading.problems.empty()) << describe(reading.problems);
  Scene velvet;
  applyMaterial(Material::kVelvet, velvet);
  const Layers layers(reading.scene);
  EXPECT_EQ(layers.fabricAt(5, 0).surface_density, velvet.cloth.surface_density);
  EXPECT_EQ(layers.fabricAt(5, 0).shear, velvet.cloth.shear);
  EXPECT_EQ(layers.fabricAt(5, 0).porosity, 0.5);
  EXPECT_EQ(layers.fabricAt(1, 0).shear, 3.0);
  EXPECT_EQ(layers.fabricAt(1, 0).bending_warp, velvet.cloth.bending_warp);
  Scene linen;
  applyMaterial(Material::kLinen, linen);
  EXPECT_EQ(layers.fabricAt(2, 8).bending_weft, linen.cloth.bending_weft);
  EXPECT_EQ(reading.scene.contact.friction, Scene().contact.friction) << "is of all contact";
}

// The cloth of docs/materials.md, for a second.
TEST(Patches, TheExampleOfThePageRuns) {
  const SceneReading reading = readSceneText(exampleOf("docs/materials.md"));
  ASSERT_TRUE(reading.problems.empty()) << describe(reading.problems);
  Simulator simulator(reading.scene);
  run(simulator, 60);
  Scene canvas;
  applyMaterial(Material::kCanvas, canvas);
  EXPECT_NEAR(simulator.mass({42, 7}) / simulator.mass({5, 7}), canvas.cloth.surface_density / 0.1, 1e-12);
}

}  // namespace
}  // namespace curtain_test
