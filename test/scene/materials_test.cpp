// SPDX-License-Identifier: BSD-3-Clause
//
// Materials are what docs/materials.md says, and what a scene gives wins over them.
#include <fstream>
#include <sstream>

#include "scene/names.h"
#include "scene/scene_testing.h"

namespace curtain {
namespace {

Material materialOf(const std::string& name) {
  const auto& names = materialNames();
  const auto found = std::find(names.begin(), names.end(), name);
  return static_cast<Material>(found - names.begin());
}

Scene withMaterial(const std::string& name) {
  Scene scene;
  scene.cloth.rows = scene.cloth.columns = 5;
  applyMaterial(materialOf(name), scene);
  return scene;
}

TEST(Materials, AreWhatTheirPageSays) {
  std::ifstream page(std::string(CURTAIN_SOURCE_DIR) + "/docs/materials.md");
  std::set<std::string> described;
  for (std::string line; std::getline(page, line);) {
    std::vector<std::string> cells;
    std::stringstream row(line);
    for (std::string cell; std::getline(row, cell, '|');) cells.push_back(cell);
    if (cells.size() != 10) continue;
    const std::string name = cells[1].substr(1, cells[1].size() - 2);
    if (materialOf(name) == Material::kNone || materialOf(name) > Material::kParachuteNylon) continue;
    described.insert(name);
    const Scene scene = withMaterial(name);
    EXPECT_EQ(scene.cloth.surface_density, std::stod(cells[2])) << name;
    EXPECT_EQ(scene.cloth.bending_warp, std::stod(cells[3])) << name;
    EXPECT_EQ(scene.cloth.bending_weft, std::stod(cells[4])) << name;
    EXPECT_EQ(scene.cloth.bending_bias, std::stod(cells[5])) << name;
    EXPECT_EQ(scene.cloth.shear, std::stod(cells[6])) << name;
    EXPECT_EQ(scene.cloth.porosity, std::stod(cells[7])) << name;
    EXPECT_EQ(scene.contact.friction, std::stod(cells[8])) << name;
    EXPECT_EQ(scene.contact.thickness, std::stod(cells[9])) << name;
    EXPECT_DOUBLE_EQ(scene.air.inside, 0.585 * (1.0 - scene.cloth.porosity)) << name;
    EXPECT_TRUE(validate(scene).empty()) << describe(validate(scene));
  }
  EXPECT_EQ(described.size() + 1, materialNames().size());  // all but none
}

TEST(Materials, GiveWayToWhatTheSceneGives) {
  const SceneReading reading = readSceneText(
      "contact: {friction: 0.7}\nair: {border: 0.1}\ncloth: {bending_weft: 1.0e-3, rows: 5, columns: 4, material: "
      "velvet}\n");
  EXPECT_TRUE(reading.problems.empty()) << describe(reading.problems);
  const Scene velvet = withMaterial("velvet");
  EXPECT_EQ(reading.scene.cloth.material, Material::kVelvet);
  EXPECT_EQ(reading.scene.cloth.surface_density, velvet.cloth.surface_density);
  EXPECT_EQ(reading.scene.cloth.bending_warp, velvet.cloth.bending_warp);
  EXPECT_EQ(reading.scene.cloth.bending_weft, 1e-3);
  EXPECT_EQ(reading.scene.contact.friction, 0.7);
  EXPECT_EQ(reading.scene.contact.thickness, velvet.contact.thickness);
  EXPECT_EQ(reading.scene.air.inside, velvet.air.inside);
  EXPECT_EQ(reading.scene.air.border, 0.1);
}

TEST(Materials, AreKeptByWritingAndReading) {
  Scene scene = withMaterial("canvas");
  scene.cloth.surface_density = 0.1;  // another one than the material's
  scene.air.corner = 0.0;
  const SceneReading reading = readSceneText(writeScene(scene));
  EXPECT_TRUE(reading.problems.empty()) << describe(reading.problems);
  EXPECT_EQ(writeScene(reading.scene), writeScene(scene));
  EXPECT_EQ(reading.scene.cloth.material, Material::kCanvas);
  EXPECT_EQ(reading.scene.cloth.surface_density, 0.1);
  EXPECT_EQ(reading.scene.air.corner, 0.0);
}

TEST(Materials, UnknownOnesAreRefusedWithTheList) {
  for (const char* const value : {"velvt", "[velvet]", "{}", "7"}) {
    const SceneReading reading = readSceneText(std::string("cloth: {rows: 5, columns: 4, material: ") + value + "}\n");
    ASSERT_EQ(reading.problems.size(), 1u) << value;
    EXPECT_EQ(reading.problems[0].key, "cloth.material");
    EXPECT_NE(reading.problems[0].text.find("parachute_nylon"), std::string::npos) << reading.problems[0].text;
  }
}

TEST(Bending, IsRefusedForThePapersScheme) {
  const SceneReading reading =
      readSceneText("cloth: {rows: 5, columns: 4, bending_warp: 1.0e-5}\nsolver: {method: paper}\n");
  ASSERT_EQ(reading.problems.size(), 1u);
  EXPECT_EQ(reading.problems[0].key, "solver.method");
}

}  // namespace
}  // namespace curtain
