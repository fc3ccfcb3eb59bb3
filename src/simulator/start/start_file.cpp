// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/start/start_file.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <system_error>

#include "curtain_sim/fine_mesh.h"
#include "scene/ranges.h"
#include "simulator/self_crossings.h"

namespace curtain {
namespace {

constexpr double kUnset = std::numeric_limits<double>::quiet_NaN();

[[noreturn]] void fail(const std::string& text) { throw std::invalid_argument(text); }

// Without the carriage return of files that were written elsewhere.
bool readLine(std::istream& in, std::string& line) {
  if (!std::getline(in, line)) return false;
  if (!line.empty() && line.back() == '\r') line.pop_back();
  return true;
}

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> fields;
  std::istringstream in(line);
  for (std::string field; std::getline(in, field, ',');) fields.push_back(field);
  return fields;
}

double numberIn(const std::string& text, const std::string& where) {
  std::istringstream in(text);
  double value = 0.0;
  if (!(in >> value) || in.peek() != std::istringstream::traits_type::eof() || !anywhere().contains(value))
    fail(where + ": must be a number, is '" + text.substr(0, 40) + "'");
  return value;
}

// A table with the columns row, column, x, y and z, among others. What comes later counts.
std::vector<Vec3> readTable(std::istream& in, const ClothParams& cloth) {
  std::string line;
  readLine(in, line);
  const std::vector<std::string> header = split(line);
  const auto columnOf = [&](const char* name) {
    const auto found = std::find(header.begin(), header.end(), name);
    if (found == header.end())
      fail("line 1: must name the columns row, column, x, y and z, has no " + std::string(name));
    return static_cast<std::size_t>(found - header.begin());
  };
  const std::size_t row = columnOf("row"), column = columnOf("column"), x = columnOf("x"), y = columnOf("y"),
                    z = columnOf("z");
  std::vector<Vec3> nodes(static_cast<std::size_t>(cloth.rows) * static_cast<std::size_t>(cloth.columns),
                          Vec3::Constant(kUnset));
  for (int number = 2; readLine(in, line); ++number) {
    if (line.empty()) continue;
    const std::string where = "line " + std::to_string(number);
    const std::vector<std::string> fields = split(line);
    if (fields.size() != header.size())
      fail(where + ": must have " + std::to_string(header.size()) + " fields, has " + std::to_string(fields.size()));
    const double i = numberIn(fields[row], where), j = numberIn(fields[column], where);
    if (!(i >= 0.0 && i < cloth.rows && j >= 0.0 && j < cloth.columns) || i != std::floor(i) || j != std::floor(j))
      fail(where + ": must be a node of the cloth of " + std::to_string(cloth.rows) + " x " +
           std::to_string(cloth.columns) + " nodes, is [" + fields[row] + ", " + fields[column] + "]");
    nodes[static_cast<std::size_t>(i) * static_cast<std::size_t>(cloth.columns) + static_cast<std::size_t>(j)] =
        Vec3(numberIn(fields[x], where), numberIn(fields[y], where), numberIn(fields[z], where));
  }
  const auto missing = std::find_if(nodes.begin(), nodes.end(), [](const Vec3& node) { return std::isnan(node.x()); });
  if (missing != nodes.end()) {
    const auto n = missing - nodes.begin();
    fail("must have every node, has no [" + std::to_string(n / cloth.columns) + ", " +
         std::to_string(n % cloth.columns) + "]");
  }
  return nodes;
}

// Vertices of an ASCII PLY: of the fine mesh, whose first-layer nodes lie a link's rods apart, or these alone.
std::vector<Vec3> readMesh(std::istream& in, const ClothParams& cloth) {
  std::string line, word;
  long vertices = -1;
  bool ascii = false;
  while (readLine(in, line) && line.rfind("end_header", 0) != 0) {
    std::istringstream fields(line);
    fields >> word;
    if (word == "format") {
      fields >> word;
      ascii = word == "ascii";
    } else if (word == "element" && vertices < 0) {
      fields >> word >> vertices;
      if (word != "vertex") vertices = -1;
    }
  }
  if (!ascii || vertices < 0) fail("must be an ASCII PLY with vertices");
  const FineMeshTopology topology = makeFineMeshTopology(cloth);
  const long rows = cloth.rows, all = rows * topology.columns, first = rows * cloth.columns;
  if (vertices != all && vertices != first)
    fail("must have " + std::to_string(first) + " vertices, one for each node, or " + std::to_string(all) +
         ", as the fine mesh of this cloth, has " + std::to_string(vertices));
  const long step = vertices == all ? topology.folds : 1, width = vertices == all ? topology.columns : cloth.columns;
  std::vector<Vec3> nodes;
  for (long n = 0; n < vertices && readLine(in, line); ++n) {
    if ((n % width) % step != 0) continue;
    std::istringstream fields(line);
    std::string x, y, z;
    fields >> x >> y >> z;
    const std::string where = "vertex " + std::to_string(n);
    nodes.emplace_back(numberIn(x, where), numberIn(y, where), numberIn(z, where));
  }
  if (static_cast<long>(nodes.size()) != first) fail("ends before its last vertex");
  return nodes;
}

}  // namespace

std::vector<Vec3> readStartFile(const std::string& path, const ClothParams& cloth) {
  std::ifstream in(path, std::ios::binary);
  std::error_code ignored;  // opening fails too then
  if (std::filesystem::is_directory(path, ignored)) fail("can't open " + path + ": is a folder");
  if (!in) fail("can't open " + path + ": " + std::generic_category().message(errno));
  const std::string ending = std::filesystem::path(path).extension().string();
  try {
    if (ending == ".csv") return readTable(in, cloth);
    if (ending == ".ply") return readMesh(in, cloth);
  } catch (const std::invalid_argument& error) {
    fail(path + ": " + error.what());
  }
  fail(path + ": must end in .csv or .ply");
}

// Files have rounded numbers.
std::string problemOfStart(const Scene& scene, const ClothPattern& pattern, const Field3& position) {
  std::string problem;
  const double most = scene.solver.stretch_tolerance + kTypedRounding;
  const auto stride = static_cast<std::size_t>(pattern.grid.stride);
  const auto textOf = [&](std::size_t n) {
    return "[" + std::to_string(n / stride) + ", " + std::to_string(n % stride) + "]";
  };
  forEachLink(pattern, [&](std::size_t a, std::size_t b, double rest, bool warp) {
    const double length = (position.at(a) - position.at(b)).norm();
    const bool fits = length <= (1.0 + most) * rest && (!warp || length >= (1.0 - most) * rest);
    if (fits || !problem.empty()) return;
    problem = "the link between the nodes " + textOf(std::min(a, b)) + " and " + textOf(std::max(a, b)) + " must be " +
              (warp ? "" : "at most ") + formatNumber(rest) + " m long, is " + formatNumber(length);
  });
  if (!problem.empty() || !scene.contact.self) return problem;
  const std::int64_t crossings = countSelfCrossings(pattern.grid, position);
  return crossings == 0 ? "" : "the cloth goes through itself in " + std::to_string(crossings) + " places";
}

}  // namespace curtain
