// SPDX-License-Identifier: BSD-3-Clause
//
// Every mistake one can make in a scene file is reported under its key, with what was given and what is allowed.
#include <yaml-cpp/yaml.h>

#include <algorithm>

#include "scene/scene_testing.h"

namespace curtain {
namespace {

// The scene with one more top-level text after the cloth.
std::string with(const std::string& text) { return smallScene() + text + "\n"; }
std::string cloth(const std::string& text) { return "cloth: {rows: 4, columns: 3, " + text + "}\n"; }
std::string wind(const std::string& text) { return with("wind: [{id: fan, " + text + "}]"); }
std::string drag(const std::string& text) { return with("drag: [{id: hand, " + text + "}]"); }
std::string obstacle(const std::string& text) { return with("obstacles: [{name: thing, " + text + "}]"); }

TEST(BadInput, TextWithoutASceneIsRefused) {
  for (const char* text : {"", "# only a comment\n", "---\n", "~"}) expectProblem(text, "", {"is empty", "map"});
  expectProblem("[1, 2]", "", {"must be a map", "is a list of 2"});
  expectProblem("hello", "", {"must be a map", "is the text \"hello\""});
  expectProblem("cloth: {rows: 4, columns: 3}\n---\ncloth: {rows: 4, columns: 3}\n", "", {"one YAML document", "is 2"});
}

TEST(BadInput, SyntaxErrorsNameLineAndColumn) {
  expectProblem("cloth: {rows: 4, columns: 3}\nwind: [1,\nair: }\n", "", {"line 3, column 6", "not YAML"});
  expectProblem("gravity: *nowhere\n", "", {"line 1", "not YAML"});
}

TEST(BadInput, DeepNestingIsReportedNotACrash) {
  const SceneReading reading = readSceneText(std::string(100000, '['));
  ASSERT_EQ(reading.problems.size(), 1u);
  EXPECT_EQ(reading.problems[0].key, "");
}

TEST(BadInput, FileThatCantBeOpenedIsNamed) {
  for (const std::string path : {"/no/such/folder/scene.yaml", "/tmp"}) {
    const SceneReading reading = readSceneFile(path);
    ASSERT_EQ(reading.problems.size(), 1u);
    EXPECT_EQ(reading.problems[0].key, "");
    EXPECT_NE(reading.problems[0].text.find(path), std::string::npos) << reading.problems[0].text;
  }
}

TEST(BadInput, MissingRowsAndColumnsAreNamed) {
  expectProblem("cloth: {columns: 3}", "cloth.rows", {"is missing", "an integer in [2, 4096]"});
  expectProblem("cloth: {rows: 3}", "cloth.columns", {"is missing", "an integer in [2, 4096]"});
  const std::vector<Problem> problems = readSceneText("gravity: [0, 0, -9.81]").problems;
  ASSERT_EQ(problems.size(), 2u) << describe(problems);
  EXPECT_EQ(problems[0].key, "cloth.rows");
  EXPECT_EQ(problems[1].key, "cloth.columns");
}

TEST(BadInput, IntegersOutOfRangeOrOfAnotherTypeAreNamed) {
  const std::string range = "must be an integer in [2, 4096], is ";
  expectProblem("cloth: {rows: 1, columns: 3}", "cloth.rows", {range + "1"});
  expectProblem("cloth: {rows: 4097, columns: 3}", "cloth.rows", {range + "4097"});
  expectProblem("cloth: {rows: 7.6, columns: 3}", "cloth.rows", {range + "7.6"});
  expectProblem("cloth: {rows: -4, columns: 3}", "cloth.rows", {range + "-4"});
  expectProblem("cloth: {rows: 99999999999999999999999, columns: 3}", "cloth.rows", {range + "99999"});
  expectProblem("cloth: {rows: true, columns: 3}", "cloth.rows", {range + "true"});
  expectProblem("cloth: {rows: [4], columns: 3}", "cloth.rows", {range + "a list of 1"});
  expectProblem("cloth: {rows: , columns: 3}", "cloth.rows", {"an integer in [2, 4096], is empty"});
  expectProblem("cloth: {rows: 010, columns: 3}", "cloth.rows", {range, "octal", "write 10"});
  expectProblem(cloth("folds: 0"), "cloth.folds", {"an integer in [1, 64], is 0"});
  expectProblem(cloth("folds: 65"), "cloth.folds", {"an integer in [1, 64], is 65"});
  expectProblem("cloth: {rows: 4, columns: 2, closed: true}", "cloth.columns", {"an integer in [3, 4096], is 2"});
}

TEST(BadInput, NumbersOutOfRangeAreNamedWithTheirRange) {
  expectProblem(cloth("width: 0.0, hem_width: 1.0"), "cloth.width", {"a number in [1e-09, 1000000000], is 0"});
  expectProblem(cloth("height: -2"), "cloth.height", {"a number in [1e-09, 1000000000], is -2"});
  expectProblem(cloth("height: .inf"), "cloth.height", {"a number in [1e-09, 1000000000], is .inf"});
  expectProblem(cloth("height: .nan"), "cloth.height", {"a number in [1e-09, 1000000000], is .nan"});
  expectProblem(cloth("height: 1.0e+999"), "cloth.height", {"a number in [1e-09, 1000000000], is .inf"});
  expectProblem(cloth("hem_width: 0"), "cloth.hem_width", {"a number in [1e-09, 1000000000], is 0"});
  expectProblem(cloth("surface_density: 0"), "cloth.surface_density", {"a number in [1e-09, 1000000000], is 0"});
  expectProblem(cloth("porosity: 1.5"), "cloth.porosity", {"a number in [0, 1], is 1.5"});
  expectProblem(with("air: {density: -1}"), "air.density", {"a number in [0, 1000000000], is -1"});
  expectProblem(with("air: {threshold: 0}"), "air.threshold", {"a number in [1e-09, 1000000000], is 0"});
  expectProblem(with("air: {fast_gain: .inf}"), "air.fast_gain", {"a number in [0, 1000000000], is .inf"});
  expectProblem(with("contact: {thickness: 0}"), "contact.thickness", {"a number in [1e-09, 1000000000], is 0"});
  expectProblem(with("contact: {friction: 10.5}"), "contact.friction", {"a number in [0, 10], is 10.5"});
  expectProblem(with("contact: {recovery_speed: 0}"), "contact.recovery_speed",
                {"a number in [1e-09, 1000000000], is 0"});
  expectProblem(with("contact: {zone_iterations: 0}"), "contact.zone_iterations", {"an integer in [1, 1000], is 0"});
  expectProblem(with("solver: {frame_rate: 0.5}"), "solver.frame_rate", {"a number in [1, 10000], is 0.5"});
  expectProblem(with("solver: {stretch_tolerance: 0.2}"), "solver.stretch_tolerance", {"is 0.2"});
  expectProblem(with("solver: {max_sweeps: 0}"), "solver.max_sweeps", {"an integer in [1, 10000], is 0"});
  expectProblem(with("solver: {max_substeps: 10001}"), "solver.max_substeps", {"[1, 10000], is 10001"});
  expectProblem(with("hang: {tilt: .nan}"), "hang.tilt", {"a number in [-6.3, 6.3], is .nan"});
  expectProblem(with("hang: {tilt: 45}"), "hang.tilt", {"a number in [-6.3, 6.3], is 45"});  // degrees
}

TEST(BadInput, SubstepsAreAutoOrAWholeNumber) {
  const std::string wanted = "auto or an integer in [1, 10000], is ";
  expectProblem(with("solver: {substeps: 0}"), "solver.substeps", {wanted + "0"});
  expectProblem(with("solver: {substeps: 2.5}"), "solver.substeps", {wanted + "2.5"});
  expectProblem(with("solver: {substeps: many}"), "solver.substeps", {wanted + "the text \"many\""});
  Scene scene = expectScene(smallScene());
  scene.solver.substeps = -1;  // programs can reach what files can't
  ASSERT_EQ(validate(scene).size(), 1u);
  EXPECT_EQ(validate(scene)[0].key, "solver.substeps");
}

TEST(BadInput, SeedIsAWholeNumberOf64Bits) {
  for (const char* seed : {"-1", "1.5", "18446744073709551616", "'1.0'"}) {
    expectProblem(with(std::string("solver: {seed: ") + seed + "}"), "solver.seed",
                  {"an integer in [0, 18446744073709551615]"});
  }
}

TEST(BadInput, AirByRelativeVelocityNamesWhatDoesNotGoWithIt) {
  const std::string law = "air: {law: relative";
  expectProblem(with(law + ", density: 0}"), "air.density", {"must be >= 1e-06 with law relative, is 0"});
  for (const char* const key : {"inside", "border", "corner"}) {
    expectProblem(with(law + ", " + key + ": 0.5}"), std::string("air.") + key,
                  {"must be 0 with law relative", "normal_drag and tangential_drag", "is 0.5"});
  }
  expectProblem(with(law + "}\nsolver: {method: paper}"), "air.law",
                {"continuous or printed with solver.method paper"});
  expectProblem(with("ambient: {velocity: [0, 3, 0]}"), "ambient.velocity",
                {"must be [0, 0, 0] unless air.law is relative"});
  expectProblem(with("ambient: {intensity: 1.5}"), "ambient.intensity", {"a number in [0, 1], is 1.5"});
  expectProblem(with("ambient: {length_scale: 0}"), "ambient.length_scale", {"a number in [0.001, 1000000], is 0"});
  expectProblem(with("ambient: {spectrum: pink}"), "ambient.spectrum", {"von_karman or dryden", "\"pink\""});
  expectProblem(wind("profile: ring"), "wind[0].profile", {"uniform or ring_jet", "\"ring\""});
}

TEST(BadInput, UnknownWordsAreNamedWithTheKnownOnes) {
  expectProblem(cloth("lumping: even"), "cloth.lumping", {"area or uniform, is the text \"even\""});
  expectProblem(cloth("closed: 'true'"), "cloth.closed", {"true or false, is the text \"true\""});
  expectProblem(cloth("closed: '1'"), "cloth.closed", {"true or false, is the text \"1\""});
  expectProblem(cloth("closed: 1"), "cloth.closed", {"true or false, is 1"});
  expectProblem(cloth("closed: maybe"), "cloth.closed", {"true or false, is the text \"maybe\""});
  expectProblem(with("air: {law: 3}"), "air.law", {"continuous, printed or relative, is 3"});
  expectProblem(with("solver: {method: magic}"), "solver.method",
                {"auto, leapfrog, leapfrog4, implicit or paper", "\"magic\""});
  expectProblem(with("solver: {method: bdf2}"), "solver.method",  // a method of earlier versions
                {"auto, leapfrog, leapfrog4, implicit or paper", "\"bdf2\""});
  expectProblem(with("contact: {self: 0}"), "contact.self", {"true or false, is 0"});
  expectProblem(with("wind: [{id: 5}]"), "wind[0].id", {"must be text, is 5", "quotes"});
  expectProblem(with("wind: [{id: on}]"), "wind[0].id", {"must be text, is on", "quotes"});
  expectProblem(with("wind: [{id: ''}]"), "wind[0].id", {"not empty"});
  expectProblem(with("wind: [{radius: 1.0}]"), "wind[0].id", {"is missing", "text"});
}

TEST(BadInput, UnknownKeysAreNamedWithTheLikelyOne) {
  expectProblem(cloth("heigth: 2.0"), "cloth.heigth", {"not a known key", "did you mean height?"});
  expectProblem(with("obstacle: []"), "obstacle", {"did you mean obstacles?"});
  expectProblem(wind("raduis: 2.0"), "wind[0].raduis", {"did you mean radius?"});
  expectProblem(with("contact: {zzzzzz: 1}"), "contact.zzzzzz",
                {"not a known key", "known are thickness, friction, self, recovery_speed, zone_iterations"});
  expectProblem(with("? [1, 2]\n: 3"), "?", {"a key must be text"});
  expectProblem(obstacle("shape: sphere, radius: 1.0, motion: [{time: 0.0, pos: [0, 0, 0]}]"),
                "obstacles[0].motion[0].pos", {"not a known key"});
}

TEST(BadInput, KeysGivenTwiceAreNamedWithTheirLines) {
  expectProblem("cloth:\n  rows: 4\n  columns: 3\n  rows: 5\n", "cloth.rows", {"more than once", "lines 2 and 4"});
  expectProblem(with("gravity: [0, 0, -1]\ngravity: [0, 0, -1]"), "gravity", {"more than once"});
  expectProblem(wind("radius: 1.0, radius: 1.0"), "wind[0].radius", {"more than once"});
}

TEST(BadInput, MapsAndListsDoNotStandForEachOther) {
  expectProblem(with("air: 5"), "air", {"must be a map, is 5"});
  expectProblem(with("hang: [1]"), "hang", {"must be a map, is a list of 1"});
  expectProblem("cloth: 5", "cloth", {"must be a map, is 5"});
  expectProblem(with("wind: {id: fan}"), "wind", {"must be a list, is a map"});
  expectProblem(with("wind:"), "wind", {"must be a list, is empty"});
  expectProblem(with("wind: [5]"), "wind[0]", {"must be a map, is 5"});
  expectProblem(with("drag: [hand]"), "drag[0]", {"must be a map, is the text \"hand\""});
  expectProblem(obstacle("shape: sphere, radius: 1.0, motion: [0.0]"), "obstacles[0].motion[0]", {"must be a map"});
  expectProblem(cloth("row_mass: 2.0"), "cloth.row_mass", {"must be a list of numbers, is 2.0"});
}

TEST(BadInput, VectorsAreThreeFiniteNumbers) {
  expectProblem(with("gravity: -9.81"), "gravity", {"a list of 3 numbers, is -9.81"});
  expectProblem(with("gravity: [0, -9.81]"), "gravity", {"a list of 3 numbers, is a list of 2"});
  expectProblem(with("gravity: [0, 0, down]"), "gravity[2]",
                {"a number in [-1000000000, 1000000000], is the text \"down\""});
  expectProblem(with("gravity: [0, .inf, 0]"), "gravity[1]", {"a number in [-1000000000, 1000000000], is .inf"});
  expectProblem(wind("position: [0, 0, .nan]"), "wind[0].position[2]",
                {"a number in [-1000000000, 1000000000], is .nan"});
  expectProblem(wind("direction: [0, 0.0, 0]"), "wind[0].direction", {"a length > 0", "is [0, 0, 0]"});
  expectProblem(wind("direction: [0, 0.0, 1.0e-200]"), "wind[0].direction", {"a length > 0"});
}

TEST(BadInput, ListsOfTheWrongLengthAreNamed) {
  expectProblem(cloth("row_spacing: [1, 2]"), "cloth.row_spacing", {"3 entries (rows - 1)", "has 2"});
  expectProblem(cloth("column_spacing: [1, 2, 3]"), "cloth.column_spacing", {"2 entries (columns - 1)", "has 3"});
  expectProblem(cloth("closed: true, column_spacing: [1, 2]"), "cloth.column_spacing",
                {"3 entries (columns)", "has 2"});
  expectProblem(cloth("row_mass: [1, 2, 3]"), "cloth.row_mass", {"4 entries (rows)", "has 3"});
  expectProblem(cloth("column_mass: [1]"), "cloth.column_mass", {"3 entries (columns)", "has 1"});
  expectProblem(cloth("row_mass: [1, 2, 0, 1]"), "cloth.row_mass[2]", {"a number in [1e-09, 1000000000], is 0"});
  expectProblem(cloth("row_mass: [1, x, 1, 1]"), "cloth.row_mass[1]",
                {"a number in [1e-09, 1000000000], is the text \"x\""});
}

TEST(BadInput, PinsOutsideTheClothAreNamed) {
  expectProblem(with("pins: bottom"), "pins", {"top, left, top_corners or none, or a list", "\"bottom\""});
  expectProblem(with("pins: 3"), "pins", {"or a list of [row, column], is 3"});
  expectProblem(with("pins: [[0, 0], [4, 0]]"), "pins[1]", {"row in [0, 3] and column in [0, 2], is [4, 0]"});
  expectProblem(with("pins: [[0, 3]]"), "pins[0]", {"column in [0, 2], is [0, 3]"});
  expectProblem(with("pins: [[-1, 0]]"), "pins[0]", {"is [-1, 0]"});
  expectProblem(with("pins: [[0, 0, 0]]"), "pins[0]", {"[row, column], two integers, is a list of 3"});
  expectProblem(with("pins: [0]"), "pins[0]", {"two integers, is 0"});
  expectProblem(with("pins: [[0, 1.5]]"), "pins[0][1]", {"an integer, is 1.5"});
}

TEST(BadInput, SlitsOutsideTheClothAndTwiceAtOnePlaceAreNamed) {
  expectProblem(cloth("slits: 1"), "cloth.slits", {"a list", "is 1"});
  expectProblem(cloth("slits: [x]"), "cloth.slits[0]", {"a column, or a map {column, from_row}", "\"x\""});
  const auto wide = [](const std::string& slits) { return "cloth: {rows: 4, columns: 8, slits: " + slits + "}"; };
  expectProblem(wide("[3, 7]"), "cloth.slits[1].column", {"in [0, 6], is 7"});
  expectProblem(wide("[-1]"), "cloth.slits[0].column", {"in [0, 6], is -1"});
  expectProblem(wide("[{column: 3, from_row: 4}]"), "cloth.slits[0].from_row", {"in [0, 3], is 4"});
  expectProblem(cloth("slits: [{from_row: 1}]"), "cloth.slits[0].column", {"is missing"});
  expectProblem(cloth("slits: [{column: 1, row: 1}]"), "cloth.slits[0].row", {"from_row"});
  expectProblem(wide("[3, {column: 3, from_row: 2}]"), "cloth.slits[1].column",
                {"unique, 3 is taken by cloth.slits[0]"});
  expectProblem(wide("[0]"), "cloth.slits[0].column", {"strips of two columns and more, leaves column 0 alone"});
  expectProblem(wide("[6]"), "cloth.slits[0].column", {"leaves column 7 alone"});
  expectProblem(wide("[4, 3]"), "cloth.slits[1].column", {"leaves column 4 alone"});
  expectProblem("cloth: {rows: 4, columns: 8, closed: true, slits: [7, 0]}", "cloth.slits[0].column",
                {"leaves column 0 alone"});
}

TEST(BadInput, PatchesThatAreNoPartOfTheClothAreNamed) {
  const auto patch = [](const std::string& keys) { return "cloth: {rows: 4, columns: 8, patches: [{" + keys + "}]}"; };
  expectProblem("cloth: {rows: 4, columns: 8, patches: {rows: [0, 1]}}", "cloth.patches", {"a list", "is a map"});
  expectProblem(patch("rows: [1]"), "cloth.patches[0].rows", {"must be [first, last]", "has 1 entries"});
  expectProblem(patch("rows: [2, 1]"), "cloth.patches[0].rows", {"0 <= first <= last <= 3, is [2, 1]"});
  expectProblem(patch("columns: [0, 8]"), "cloth.patches[0].columns", {"0 <= first <= last <= 7, is [0, 8]"});
  expectProblem(patch("columns: [-1, 3]"), "cloth.patches[0].columns[0]", {"[0, 4095]", "is -1"});
  expectProblem(patch("material: tweed"), "cloth.patches[0].material", {"cotton_voile", "tweed"});
  expectProblem(patch("surface_density: 0"), "cloth.patches[0].surface_density", {"[1e-09, ", "is 0"});
  expectProblem(patch("folds: 2"), "cloth.patches[0].folds", {"is not a known key", "rows, columns, material"});
  expectProblem(patch("bending_hysteresis: 0.01"), "cloth.bending_hysteresis", {"must be 0 where bending_warp"});
  expectProblem(patch("bending_warp: 1e-4") + "\nsolver: {method: paper}", "solver.method", {"can't be paper"});
}

TEST(BadInput, HangLineLongerThanTheClothIsWideIsNamed) {
  expectProblem(with("hang: {from: [0, 0, 2], to: [1.1, 0, 2]}"), "hang.to",
                {"no further from hang.from than cloth.width = 1 m", "is 1.1 m away"});
  expectProblem(with("hang: {from: [0, 0, 2], to: [0, 0, 2]}"), "hang.to", {"must differ from hang.from"});
  expectProblem(with("hang: {radius: 0.1}"), "hang.radius", {"closed cloth only", "is 0.1"});
  // Rounding of typed coordinates is no mistake.
  expectScene(with("hang: {from: [0.1, 0, 2], to: [1.1000000000000001, 0, 2]}"));
  expectProblem(with("hang: {from: [0, 0, 2], to: [1.0002, 0, 2]}"), "hang.to", {"1 m", "is 1.0002 m away"});
}

TEST(BadInput, HemThatTapersTooSteeplyIsNamed) {
  const std::string line = "\nhang: {from: [0, 0, 2], to: [7, 0, 2]}";
  const auto cloth = [&](const std::string& hem) {
    return "cloth: {rows: 4, columns: 3, width: 7.0, hem_width: " + hem + "}" + line;
  };
  // Where the hem is w wide in plan, its halves rise by h = 2 - sqrt(4 - (7 - w)^2 / 4) to the sides, and are
  // sqrt(w^2 / 4 + h^2) long: 4.0623 / 2 at least, at w = 3.527.
  expectProblem(cloth("1.0"), "cloth.hem_width", {"must be at least 4.0", "is 1:", "7 m", "2 m high"});
  expectProblem(cloth("4.062"), "cloth.hem_width", {"must be at least 4.06"});
  expectScene(cloth("4.08"));
  // Hung from a line as short as the hem nothing leans; a hem wider than the line does not either.
  expectScene("cloth: {rows: 4, columns: 3, width: 7.0, hem_width: 1.0}");
  expectScene("cloth: {rows: 4, columns: 3, hem_width: 9.0}");
}

TEST(BadInput, RingWiderThanItsWeftIsNamed) {
  // 6 links of 1/6 m: the hexagon's radius is 1/6 m, the circle's 1/(2 pi) = 0.159 m.
  const std::string ring = "cloth: {rows: 5, columns: 6, closed: true";
  expectScene(ring + "}\n");
  expectScene(ring + "}\nhang: {radius: 0.16666666666666}\n");
  expectProblem(ring + "}\nhang: {radius: 0.1667}\n", "hang.radius", {"row 0", "at most 0.1666666666666666"});
  expectProblem(ring + "}\nhang: {tilt: 0.01}\n", "hang.tilt", {"is 0.01", "row 2", "m are allowed"});
  expectProblem(ring + ", hem_width: 0.5}\n", "hang.tilt", {"is 0", "m long"});
  // A hem as much narrower as the cone: r_i shrinks with the weft. sin(tilt) = (0.5 - 1) / (2 pi 2 m).
  expectScene(ring + ", hem_width: 0.5}\nhang: {tilt: -0.0398}\n");
  expectScene(ring + ", hem_width: 2.0}\nhang: {tilt: 0.0796}\n");
  expectProblem(ring + "}\nhang: {tilt: -1.0}\n", "hang.tilt", {"radius > 0", "row 1"});
  expectProblem(ring + "}\nhang: {radius: 0}\n", "hang.radius", {"a number in [1e-09, 1000000000], is 0"});
}

TEST(BadInput, HeadingsThatDoNotFitTheirClothAreRefused) {
  const auto pleated = [](const std::string& of_cloth, const std::string& of_hang) {
    return "cloth: {rows: 4, columns: 19, " + of_cloth + "}\nhang: {from: [0, 0, 2], to: [0.5, 0, 2], " + of_hang +
           "}\n";
  };
  expectScene(pleated("width: 1.0", "heading: pinch"));
  expectScene(pleated("width: 1.0", "heading: pinch, fullness: 2.0"));
  EXPECT_EQ(expectScene(pleated("height: 1.0", "heading: ripple, fullness: 2.5")).cloth.width, 1.25);
  expectProblem(pleated("width: 1.0", "fullness: 1.9"), "hang.fullness", {"cloth.width / |to - from| = 2", "is 1.9"});
  expectProblem(pleated("width: 1.0", "fullness: 3.5"), "hang.fullness", {"[1, 3]", "is 3.5"});
  expectProblem(pleated("width: 1.6", "heading: pencil"), "hang.heading",
                {"more than three times", "is pencil at 3.2"});
  expectProblem(pleated("width: 1.0", "heading: pleated"), "hang.heading",
                {"gathered, pencil, pinch, ripple, eyelets or tabs"});
  expectProblem(pleated("width: 1.0", "heading: ripple, pleats: 5"), "hang.pleats", {"4 weft links", "18 for 5"});
  expectProblem(pleated("width: 1.0", "heading: pinch, pleats: 3"), "hang.pleats", {"9 weft links", "18 for 3"});
  expectProblem(pleated("width: 1.0, hem_width: 1.2", "heading: pencil"), "hang.heading", {"tapered", "is pencil"});
  expectProblem("cloth: {rows: 4, columns: 19, closed: true}\nhang: {heading: ripple}\n", "hang.heading",
                {"closed cloth"});
  expectProblem(pleated("width: 1.0", "heading: pencil, pressed: 0.1"), "hang.pressed", {"bending_weft: 0"});
  expectProblem(pleated("width: 1.0, bending_weft: 1.0e-5", "heading: gathered, pressed: 0.1"), "hang.pressed",
                {"gathered"});
  expectProblem(pleated("width: 1.4, bending_weft: 1.0e-5", "heading: pencil, pressed: 0.1"), "hang.pressed",
                {"80 degrees", "more columns"});
  expectProblem("cloth: {rows: 4, columns: 8}\nhang: {heading: pinch}\n", "hang.heading", {"9 weft links", "7 for 1"});
  expectProblem(pleated("width: 1.0", "tilt: 0.0}\nhem: {weights: [0.1]"), "hem.weights",
                {"19 entries (columns)", "has 1"});
  expectProblem(pleated("width: 1.0", "tilt: 0.0}\nhem: {line_density: -1"), "hem.line_density", {"is -1"});
}

// Two strips of three columns: 0.2 m each, and 0.1 m between them that the overlap takes the place of.
TEST(BadInput, OverlapsThatDoNotFitTheirStripsAreRefused) {
  const auto strips = [](const std::string& of_cloth, const std::string& of_hang) {
    return "cloth: {rows: 4, columns: 6, width: 0.5" + of_cloth + "}\nhang: {from: [0, 0, 2], to: [0.35, 0, 2], " +
           of_hang + "}\n";
  };
  const std::string cut = ", slits: [2]";
  expectScene(strips(cut, "overlap: 0.05"));
  expectScene("cloth: {rows: 4, columns: 6, width: 0.5, slits: [2]}\nhang: {to: [0.4, 0, 2.2], overlap: 0.0}\n");
  expectProblem(strips("", "overlap: 0.05"), "hang.overlap", {"slits from row 0"});
  expectProblem(strips(", slits: [{column: 2, from_row: 1}]", "overlap: 0.05"), "hang.overlap", {"slits from row 0"});
  expectProblem(strips(cut, "overlap: 0.05, heading: pencil, pleats: 1"), "hang.overlap", {"without a heading"});
  expectProblem(strips(cut, "overlap: 0.1"), "hang.overlap", {"half of the narrowest strip's width, 0.1 m", "is 0.1"});
  expectProblem(strips(cut, "overlap: -0.1"), "hang.overlap", {"is -0.1"});
  expectProblem(strips(cut, "overlap: 0.06"), "hang.to", {"overlapping strips reach, 0.34 m", "0.35 m away"});
  expectProblem("cloth: {rows: 3, columns: 6, closed: true, slits: [2, 5]}\nhang: {overlap: 0.01}\n", "hang.overlap",
                {"flat cloth"});
}

TEST(BadInput, RingOfUnevenLinksIsBoundByItsShortOnes) {
  // A long link bulges least: its chord is the shortest for its length, so the short ones decide. 12 m around, links
  // 1, 1, 10: for links of 1/12 of the way around the largest radius is (1/2) / sin(pi / 12) = 1.9319 m.
  const std::string ring = "cloth: {rows: 3, columns: 3, width: 12.0, closed: true, column_spacing: [1, 1, 10]}\n";
  expectScene(ring + "hang: {radius: 1.932}\n");  // but for its rounding
  expectProblem(ring + "hang: {radius: 1.9321}\n", "hang.radius", {"row 0", "link 0", "at most 1 m"});
}

TEST(BadInput, EndsMustComeAfterStarts) {
  expectProblem(wind("start: 2.0, end: 1.0"), "wind[0].end", {"> start = 2, is 1"});
  expectProblem(wind("start: 2.0, end: 2.0"), "wind[0].end", {"> start = 2, is 2"});
  expectProblem(wind("start: .inf"), "wind[0].start", {"a number in [-1000000000, 1000000000], is .inf"});
  expectProblem(wind("end: -.inf"), "wind[0].end", {"or .inf, is -.inf"});
  expectProblem(wind("end: .nan"), "wind[0].end", {"or .inf, is .nan"});
  expectProblem(drag("node: [0, 0], start: 2.0, end: 1.0"), "drag[0].end", {"> start = 2, is 1"});
}

// It could not be written again, and no topic would take it.
TEST(BadInput, TextThatIsNoUtf8IsNamed) {
  for (const std::string bad : {"a\xFF", "\xC0\xAF", "\xE2\x82", "\xED\xA0\x80", "\xF4\x90\x80\x80", "\x80"}) {
    const std::string place = "line 2, column " + std::to_string(bad[0] == 'a' ? 14 : 13);
    expectProblem("cloth: {rows: 4, columns: 3}\nwind: [{id: " + bad + "}]\n", "", {place, "UTF-8"});
    YAML::Node root = YAML::Load(smallScene());  // of parameters
    root["wind"][0]["id"] = bad;
    const SceneReading reading = readScene(root);
    ASSERT_EQ(reading.problems.size(), 1U);
    EXPECT_EQ(reading.problems[0].key, "wind[0].id");
    EXPECT_NE(reading.problems[0].text.find("UTF-8"), std::string::npos) << reading.problems[0].text;
  }
}

TEST(BadInput, CharactersOfUtf8AreTaken) {
  for (const std::string good : {"\xC2\x80", "\xE0\xA0\x80", "\xED\x9F\xBF", "\xF0\x90\x80\x80", "\xF4\x8F\xBF\xBD"})
    EXPECT_EQ(readSceneText(smallScene() + std::string("wind: [{id: \"") + good + "\"}]\n").scene.wind.at(0).id, good);
}

TEST(BadInput, BadWindsAreNamed) {
  expectProblem(wind("radius: 0"), "wind[0].radius", {"a number in [1e-09, 1000000000], is 0"});
  expectProblem(wind("half_angle: 1.6"), "wind[0].half_angle", {"a number in [0, 1.5], is 1.6"});
  expectProblem(wind("pressure: -1"), "wind[0].pressure", {"a number in [0, 1000000000], is -1"});
  expectProblem(wind("node_force: -1"), "wind[0].node_force", {"a number in [0, 1000000000], is -1"});
  expectProblem(wind("porosity_weight: 2"), "wind[0].porosity_weight", {"a number in [0, 1], is 2"});
  expectProblem(wind("distance_weight: 0"), "wind[0].distance_weight", {"a number in [1e-09, 1000000000], is 0"});
  expectProblem(wind("reference_length: 0"), "wind[0].reference_length", {"[1e-06, 1000000]", "is 0"});
  expectProblem(wind("unsteadiness: -1"), "wind[0].unsteadiness", {"[0, 1000000000], is -1"});
  expectProblem(wind("correlation_time: 0"), "wind[0].correlation_time", {"[1e-06, 1000000]", "is 0"});
  expectProblem(wind("correlation_length: 0"), "wind[0].correlation_length", {"[1e-09, 1000000000], is 0"});
  expectProblem(with("wind: [{id: a}, {id: b}, {id: a}]"), "wind[2].id", {"unique", "\"a\" is taken by wind[0]"});
}

TEST(BadInput, BadDragsAreNamed) {
  expectProblem(drag("force: [0, 0, 1]"), "drag[0]", {"exactly one of node and point, gives neither"});
  expectProblem(drag("node: [0, 0], point: [0, 0, 0]"), "drag[0]", {"exactly one of node and point, gives both"});
  expectProblem(drag("node: [4, 0]"), "drag[0].node", {"row in [0, 3]", "is [4, 0]"});
  expectProblem(drag("node: [0, -1]"), "drag[0].node", {"column in [0, 2]", "is [0, -1]"});
  expectProblem(drag("node: 5"), "drag[0].node", {"two integers, is 5"});  // and nothing about "neither"
  expectProblem(drag("node: [0, 0], stiffness: 0"), "drag[0].stiffness", {"[1e-09, 1000000000], is 0"});
  expectProblem(drag("node: [0, 0], max_force: 0"), "drag[0].max_force", {"[1e-09, 1000000000], is 0"});
  expectProblem(drag("node: [0, 0], radius: -1"), "drag[0].radius", {"[0, 1000000000], is -1"});
  expectProblem(drag("node: [0, 0], target: [0, 0]"), "drag[0].target", {"a list of 3 numbers, is a list of 2"});
  expectProblem(with("drag: [{id: a, node: [0, 0]}, {id: a, node: [0, 0]}]"), "drag[1].id", {"taken by drag[0]"});
}

TEST(BadInput, KeysOfAnotherShapeAreNamed) {
  expectProblem(obstacle("shape: cone"), "obstacles[0].shape",
                {"sphere, box, cylinder, capsule, plane or mesh", "is the text \"cone\""});
  expectProblem(obstacle("shape: box, size: [1, 1, 1], radius: 1.0"), "obstacles[0].radius",
                {"does not belong to shape box"});
  expectProblem(obstacle("shape: sphere, radius: 1.0, length: 1.0"), "obstacles[0].length", {"belong to shape sphere"});
  expectProblem(obstacle("shape: sphere, radius: 1.0, size: [1, 1, 1]"), "obstacles[0].size", {"shape sphere"});
  expectProblem(obstacle("shape: plane, mesh: a.stl"), "obstacles[0].mesh", {"belong to shape plane"});
  expectProblem(obstacle("shape: capsule, radius: 1.0, length: 1.0, scale: 1.0"), "obstacles[0].scale", {"capsule"});
  expectProblem(obstacle("shape: mesh, mesh: a.stl, radius: 1.0"), "obstacles[0].radius", {"belong to shape mesh"});
}

TEST(BadInput, MissingSizesOfObstaclesAreNamed) {
  expectProblem(obstacle("shape: sphere"), "obstacles[0].radius", {"is missing", "a number in [1e-09, 1000000000]"});
  expectProblem(obstacle("shape: cylinder, radius: 1.0"), "obstacles[0].length", {"is missing"});
  expectProblem(obstacle("shape: box"), "obstacles[0].size", {"is missing"});
  expectProblem(obstacle("shape: mesh"), "obstacles[0].mesh", {"is missing"});
  expectProblem(obstacle("shape: mesh, mesh: ''"), "obstacles[0].mesh", {"not empty"});
  expectProblem(obstacle("shape: sphere, radius: -1"), "obstacles[0].radius", {"[1e-09, 1000000000], is -1"});
  expectProblem(obstacle("shape: capsule, radius: 1.0, length: 0"), "obstacles[0].length",
                {"[1e-09, 1000000000], is 0"});
  expectProblem(obstacle("shape: box, size: [1, 0, 1]"), "obstacles[0].size[1]", {"[1e-09, 1000000000], is 0"});
  expectProblem(obstacle("shape: mesh, mesh: a.stl, scale: 0.0"), "obstacles[0].scale",
                {"at least 1e-09 in size, is 0"});
  expectProblem(obstacle("shape: mesh, mesh: a.stl, scale: [1, 1, 0]"), "obstacles[0].scale[2]",
                {"at least 1e-09 in size, is 0"});
  expectProblem(obstacle("shape: mesh, mesh: a.stl, scale: .inf"), "obstacles[0].scale",
                {"at least 1e-09 in size, is .inf"});
}

TEST(BadInput, BadPosesAndMotionsOfObstaclesAreNamed) {
  const auto ball = [](const std::string& text) { return obstacle("shape: sphere, radius: 1.0, " + text); };
  const std::string key = "obstacles[0].orientation";
  expectProblem(ball("orientation: [0, 0, 0, 0]"), key, {"unit quaternion", "is [0, 0, 0, 0] (norm 0)"});
  expectProblem(ball("orientation: [0, 0, 0, 1.002]"), key, {"unit quaternion", "norm 1.002"});
  expectProblem(ball("orientation: [0, 0, 1]"), key, {"a list of 4 numbers", "is a list of 3"});
  expectProblem(ball("orientation: [0, 0, 0, .nan]"), key, {"unit quaternion", ".nan"});
  expectProblem(ball("orientation: [0, 0, 0, one]"), key + "[3]", {"is the text \"one\""});
  expectProblem(ball("friction: -1"), "obstacles[0].friction", {"a number in [0, 10], is -1"});
  expectProblem(ball("padding: -0.01"), "obstacles[0].padding", {"a number in [0, ", "is -0.01"});
  expectProblem(ball("friction: .nan"), "obstacles[0].friction", {"a number in [0, 10], is .nan"});
  expectProblem(ball("color: [0.5, 1.5, 0.5]"), "obstacles[0].color[1]", {"a number in [0, 1], is 1.5"});
  expectProblem(ball("color: red"), "obstacles[0].color", {"is the text \"red\""});
  expectProblem(ball("visible: 1"), "obstacles[0].visible", {"true or false"});
  expectProblem(ball("frame: ''"), "obstacles[0].frame", {"not empty"});
  expectProblem(ball("motion: [{time: 0.0}, {time: 1.0}, {time: 1.0}]"), "obstacles[0].motion[2].time",
                {"> the time before it = 1, is 1"});
  for (const char* name : {"velocity", "acceleration", "spin"})
    expectProblem(ball(std::string("motion: [{time: 0.0}], ") + name + ": [0, 0, 1]"),
                  std::string("obstacles[0].") + name, {"beside motion"});
  expectProblem(ball("motion: [{time: 0.0, orientation: [0, 0, 0, 2]}]"), "obstacles[0].motion[0].orientation",
                {"unit quaternion"});
  expectProblem(with("obstacles: [{name: a, shape: plane}, {name: a, shape: plane}]"), "obstacles[1].name",
                {"\"a\" is taken by obstacles[0]"});
}

TEST(BadInput, AllProblemsAreNamedAtOnce) {
  const std::string text =
      "cloth: {rows: 1, columns: x, widht: 2.0}\nair: {density: -1}\nwind: [{id: a, radius: 0}, {id: a}]\n"
      "drag: [{id: hand}]\npins: [[90, 90]]\nsolver: {seed: -3}\n";
  std::vector<std::string> keys;
  for (const Problem& problem : readSceneText(text).problems) keys.push_back(problem.key);
  std::sort(keys.begin(), keys.end());
  // Not the pins: the grid that they would lie on is not known.
  const std::vector<std::string> expected = {"air.density", "cloth.columns", "cloth.rows",     "cloth.widht",
                                             "drag[0]",     "solver.seed",   "wind[0].radius", "wind[1].id"};
  EXPECT_EQ(keys, expected);
}

// A width that can't be read keeps its default; that the line is longer than the default is no news.
TEST(BadInput, WhatOnlyFollowsIsNotReported) {
  expectProblem("cloth: {rows: 4, columns: 3, width: 5.0 m}\nhang: {from: [0, 0, 2], to: [4, 0, 2]}\n", "cloth.width",
                {"write the number alone"});
}

TEST(Describe, OneLineAProblemWithItsSource) {
  const std::vector<Problem> problems = {{"cloth.rows", "is 1"}, {"", "is empty"}};
  EXPECT_EQ(describe(problems, "a.yaml"), "a.yaml: cloth.rows: is 1\na.yaml: is empty");
  EXPECT_EQ(describe(problems), "cloth.rows: is 1\nis empty");
  EXPECT_EQ(describe({}, "a.yaml"), "");
}

}  // namespace
}  // namespace curtain
