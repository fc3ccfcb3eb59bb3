// SPDX-License-Identifier: BSD-3-Clause
//
// Text where a number is wanted: what is wholly a number is that number, judged as one; the rest is refused. Where text
// is wanted nothing becomes a number.
#include <clocale>
#include <limits>
#include <locale>

#include "scene/scene_testing.h"

namespace curtain {
namespace {

std::string sceneWith(const std::string& text) { return smallScene() + text + "\n"; }
std::string clothWith(const std::string& text) { return "cloth: {rows: 4, columns: 3, " + text + "}\n"; }
std::string windWith(const std::string& text) { return sceneWith("wind: [{id: fan, " + text + "}]"); }

// To YAML 1.1 these are texts: numbers as Python and others print them, and what is in quotes.
TEST(NumberText, TextThatIsWhollyANumberIsThatNumber) {
  const auto force = [](const std::string& text) {
    return expectScene(std::string(smallScene()) + "drag: [{id: a, node: [0, 0], force: [0, 0, " + text + "]}]")
        .drag.at(0)
        .force.z();
  };
  EXPECT_EQ(force("3e-06"), 3e-6);
  EXPECT_EQ(force("1E5"), 1e5);
  EXPECT_EQ(force("1.0e6"), 1e6);
  EXPECT_EQ(force("-.5"), -0.5);
  EXPECT_EQ(force("+.5"), 0.5);
  EXPECT_EQ(force("'.5'"), 0.5);
  EXPECT_EQ(force("'5.'"), 5.0);
  EXPECT_EQ(force("'-5.e-1'"), -0.5);
  EXPECT_EQ(force("'1.0e-6'"), 1e-6);
  EXPECT_EQ(force("\"1e-6\""), 1e-6);
  EXPECT_EQ(force("!!str 2.5"), 2.5);
  EXPECT_EQ(force("'007'"), 7.0);
  EXPECT_EQ(force("08"), 8.0);  // no octal number
  EXPECT_EQ(force("'0.1000000000000000055511151231257827'"), 0.1);
  const Scene scene = expectScene(
      "cloth: {rows: '4', columns: \"3\", height: '2', row_mass: ['1e0', 2, 3e0, 4], slits: []}\n"
      "pins: [['0', '1']]\nsolver: {substeps: '7', seed: '18446744073709551615', threads: 'auto'}\n"
      "obstacles: [{name: a, shape: mesh, mesh: a.stl, scale: '1e-3', friction: 5e-1, orientation: ['0', 0, 0, 1e0]}]");
  EXPECT_EQ(scene.cloth.rows, 4);
  EXPECT_EQ(scene.cloth.columns, 3);
  EXPECT_EQ(scene.cloth.row_mass, (std::vector<double>{1.0, 2.0, 3.0, 4.0}));
  EXPECT_EQ(scene.pins.nodes.at(0).column, 1);
  EXPECT_EQ(scene.solver.substeps, 7);
  EXPECT_EQ(scene.solver.seed, std::numeric_limits<std::uint64_t>::max());
  EXPECT_EQ(scene.solver.threads, 0);
  EXPECT_EQ(scene.obstacles.at(0).scale, Vec3::Constant(1e-3));
  EXPECT_EQ(scene.obstacles[0].friction, 0.5);
}

TEST(NumberText, TextThatLooksLikeANumberStaysTextWhereTextIsWanted) {
  const Scene scene =
      expectScene(std::string(smallScene()) + "wind: [{id: '12'}, {id: 1e3}, {id: '1e3 '}, {id: \"0x10\"}]");
  EXPECT_EQ(scene.wind.at(0).id, "12");
  EXPECT_EQ(scene.wind.at(1).id, "1e3");
  EXPECT_EQ(scene.wind.at(2).id, "1e3 ");
  EXPECT_EQ(scene.wind.at(3).id, "0x10");
}

// A decimal comma of the program's locale changes nothing.
TEST(NumberText, NumbersDoNotDependOnTheLocale) {
  const std::string before = std::setlocale(LC_ALL, nullptr);
  const std::locale global;
  struct Comma : std::numpunct<char> {
    char do_decimal_point() const override { return ','; }
  };
  std::locale::global(std::locale(std::locale::classic(), new Comma));
  std::setlocale(LC_NUMERIC, "de_DE.UTF-8");  // where it is installed
  const SceneReading reading = readSceneText("cloth: {rows: '4', columns: 3, height: '2.5', width: 15e-1}");
  const std::vector<Problem> comma = readSceneText("cloth: {rows: 4, columns: 3, height: '2,5'}").problems;
  std::locale::global(global);
  std::setlocale(LC_ALL, before.c_str());
  ASSERT_TRUE(reading.problems.empty()) << describe(reading.problems);
  EXPECT_EQ(reading.scene.cloth.height, 2.5);
  EXPECT_EQ(reading.scene.cloth.width, 1.5);
  EXPECT_EQ(comma.size(), 1u);
}

TEST(NumberText, TextThatIsNotWhollyANumberIsNamed) {
  const std::string key = "solver.stretch_tolerance";
  const auto tolerance = [](const std::string& value) {
    return sceneWith("solver: {stretch_tolerance: " + value + "}");
  };
  for (const char* text :
       {"",    " ",   " 1e-6", "1e-6 ",    "1 e-6", "1e -6", "0x10",  "0x1p-3", "1,5", "1.0.0",
        "1e",  "1e+", "e5",    ".",        "-",     "+",     "--1",   "+-1",    ".e1", "nan",
        "NaN", "inf", "-inf",  "infinity", "1_000", "1:30",  "1e-6f", "0b1",    "１",  "1\xC2\xA0"}) {
    expectProblem(tolerance('"' + std::string(text) + '"'), key,
                  {"a number in [1e-12, 0.1], is the text \"" + std::string(text) + '"'});
  }
  expectProblem(tolerance("1e-6 m"), key, {"is the text \"1e-6 m\"", "write the number alone, in SI units"});
  expectProblem(tolerance("2 mm"), key, {"is the text \"2 mm\"", "write the number alone, in SI units"});
  expectProblem(tolerance("1e-3m"), key, {"is the text \"1e-3m\"", "write the number alone, in SI units"});
  expectProblem(tolerance("small"), key, {"a number in [1e-12, 0.1], is the text \"small\""});
  expectProblem(tolerance("yes"), key, {"a number in [1e-12, 0.1], is yes"});
  expectProblem(tolerance("0x10"), key, {"is the text \"0x10\""});
  expectProblem(tolerance("1.5_0"), key, {"is the text \"1.5_0\""});
  expectProblem(tolerance("!mine 1.0e-6"), key, {"is the text \"1.0e-6\""});
  expectProblem(windWith("end: inf"), "wind[0].end",
                {"a number in [-1000000000, 1000000000000] or .inf", "is the text \"inf\"", "write .inf"});
  expectProblem(windWith("end: '.inf'"), "wind[0].end", {"write .inf without quotes"});
  expectProblem(tolerance("'.nan'"), key, {"is the text \".nan\""});
}

// Ranges and whole numbers are as those of numbers without quotes.
TEST(NumberText, TextThatIsANumberIsJudgedAsOne) {
  expectProblem(sceneWith("solver: {stretch_tolerance: '2e-1'}"), "solver.stretch_tolerance",
                {"a number in [1e-12, 0.1], is 0.2"});
  expectProblem(clothWith("height: '1e999'"), "cloth.height", {"a number in [1e-09, 1000000000], is .inf"});
  const std::string range = "must be an integer in [2, 4096], is ";
  for (const char* text : {"7.6", "7.0", "1e3", "99999999999999999999999"}) {
    expectProblem("cloth: {rows: '" + std::string(text) + "', columns: 3}", "cloth.rows", {range + text});
  }
  expectProblem("cloth: {rows: 1.0e+3, columns: 3}", "cloth.rows", {range + "1.0e+3"});
  expectProblem("cloth: {rows: '1', columns: 3}", "cloth.rows", {range + "1"});
  expectProblem("cloth: {rows: '4 rows', columns: 3}", "cloth.rows", {range + "the text \"4 rows\""});
  expectProblem(sceneWith("solver: {substeps: '0'}"), "solver.substeps", {"auto or an integer in [1, 10000], is 0"});
  expectProblem(sceneWith("solver: {seed: '-1'}"), "solver.seed", {"an integer in [0, 18446744073709551615], is -1"});
  expectProblem(sceneWith("pins: [['0', '1.5']]"), "pins[0][1]", {"an integer, is 1.5"});
}

}  // namespace
}  // namespace curtain
