// SPDX-License-Identifier: BSD-3-Clause
//
// Lines and tie-backs in scenes: what is wrong is said once, with where and what is allowed.
#include "scene/scene_testing.h"

namespace curtain {
namespace {

std::string sheetWith(const std::string& entry) { return "cloth: {rows: 4, columns: 9}\n" + entry + "\n"; }
std::string line(const std::string& entry) { return sheetWith("lines: [{id: a, " + entry + "}]"); }
std::string tie(const std::string& entry) { return sheetWith("tie_back: [{id: a, point: [0, 0, 1], " + entry + "}]"); }

TEST(LinesInput, AreReadAndWritten) {
  const Scene scene =
      expectScene(sheetWith("lines: [{id: a, nodes: [[3, 0], [3, 8]], length: 2.0, mass: 0.5},\n"
                            "        {id: b, nodes: [[0, 0]], to: [1, 2, 3]}]\n"
                            "tie_back: [{id: t, row: 2, first_column: 1, last_column: 7, point: [0, 0, 1],\n"
                            "            radius: 0.2, speed: 0.5, closed: false}]"));
  ASSERT_EQ(scene.lines.size(), 2u);
  ASSERT_EQ(scene.lines[0].nodes.size(), 2u);
  EXPECT_EQ(scene.lines[0].nodes[1].column, 8);
  EXPECT_EQ(scene.lines[0].length, 2.0);
  EXPECT_EQ(scene.lines[0].mass, 0.5);
  EXPECT_FALSE(scene.lines[0].to.has_value());
  EXPECT_EQ(*scene.lines[1].to, Vec3(1.0, 2.0, 3.0));
  ASSERT_EQ(scene.tie_back.size(), 1u);
  EXPECT_EQ(scene.tie_back[0].last_column, 7);
  EXPECT_EQ(scene.tie_back[0].radius, 0.2);
  EXPECT_FALSE(scene.tie_back[0].closed);
  EXPECT_EQ(writeScene(readSceneText(writeScene(scene)).scene), writeScene(scene));
}

TEST(LinesInput, NodesThatAreNoneAreNamed) {
  expectProblem(line("to: [0, 0, 0]"), "lines[0].nodes", {"is missing", "a list of [row, column]"});
  expectProblem(line("nodes: [], to: [0, 0, 0]"), "lines[0].nodes", {"1 to 4096 entries", "has 0"});
  expectProblem(line("nodes: [[4, 0]], to: [0, 0, 0]"), "lines[0].nodes[0]", {"row in [0, 3]", "[4, 0]"});
  expectProblem(line("nodes: [[3, 0], [3, 1], [3, 0]], to: [0, 0, 0]"), "lines[0].nodes[2]", {"lines[0].nodes[0]"});
  expectProblem(line("nodes: [[3]], to: [0, 0, 0]"), "lines[0].nodes[0]", {"two integers"});
}

TEST(LinesInput, NeedAnEnd) {
  expectProblem(line("nodes: [[3, 0]]"), "lines[0].to", {"is missing", "or give mass"});
  expectProblem(line("nodes: [[3, 0]], mass: 1.0"), "lines[0].length", {"is missing"});
  expectProblem("gravity: [0, 0, 0]\n" + line("nodes: [[3, 0]], mass: 1.0, length: 1.0"), "lines[0].to",
                {"without gravity"});
  expectProblem(line("nodes: [[3, 0]], mass: 0.0, to: [0, 0, 0]"), "lines[0].mass", {"is 0"});
  expectProblem(line("nodes: [[3, 0]], length: -1.0, to: [0, 0, 0]"), "lines[0].length", {"is -1"});
}

TEST(LinesInput, IdsAreUnique) {
  expectProblem(sheetWith("lines: [{id: a, nodes: [[3, 0]], to: [0, 0, 0]}, {id: a, nodes: [[3, 1]], to: [0, 0, 0]}]"),
                "lines[1].id", {"lines[0]"});
}

TEST(LinesInput, ThePapersSchemeKnowsNone) {
  expectProblem(line("nodes: [[3, 0]], to: [0, 0, 0]") + "solver: {method: paper}", "solver.method", {"lines"});
  expectProblem(tie("row: 1, first_column: 0, last_column: 8") + "solver: {method: paper}", "solver.method",
                {"tie-backs"});
}

TEST(TieBackInput, RowAndColumnsMustBeThere) {
  expectProblem(tie("row: 4, first_column: 0, last_column: 8"), "tie_back[0].row", {"[0, 3]", "is 4"});
  expectProblem(tie("row: 1, first_column: 5, last_column: 4"), "tie_back[0].last_column", {"[5, 8]", "is 4"});
  expectProblem(tie("row: 1, first_column: 9, last_column: 9"), "tie_back[0].first_column", {"[0, 8]", "is 9"});
  expectProblem(tie("row: 1, first_column: 0"), "tie_back[0].last_column", {"is missing"});
  expectProblem(tie("row: 1, first_column: 0, last_column: 8, radius: 0.0"), "tie_back[0].radius", {"0.001"});
  expectProblem(sheetWith("tie_back: [{id: a, row: 1, first_column: 0, last_column: 8}]"), "tie_back[0].point",
                {"is missing"});
}

}  // namespace
}  // namespace curtain
