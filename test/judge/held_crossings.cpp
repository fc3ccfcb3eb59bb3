// SPDX-License-Identifier: BSD-3-Clause
#include "judge/held_crossings.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <vector>

#include "cloth/cloth.h"
#include "cloth/coarse_mesh.h"

namespace curtain_test {
namespace {

using namespace curtain;

double volume(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) { return (b - a).cross(c - a).dot(d - a); }

bool passes(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& c) {
  if (volume(a, b, c, p) * volume(a, b, c, q) >= 0.0) return false;
  const double sides[] = {volume(p, q, a, b), volume(p, q, b, c), volume(p, q, c, a)};
  const auto positive = [](double side) { return side > 0.0; };
  const auto negative = [](double side) { return side < 0.0; };
  return std::all_of(std::begin(sides), std::end(sides), positive) ||
         std::all_of(std::begin(sides), std::end(sides), negative);
}

}  // namespace

bool heldPartsCross(const Simulator& simulator) {
  const Grid grid = makeGrid(wholeCloth(simulator.scene()));
  Field3 position;
  position.assign(grid.size(), 0.0);
  std::vector<int> held(grid.size(), 0);
  for (int i = 0; i < grid.rows; ++i) {
    for (int j = 0; j < grid.columns; ++j) {
      position.set(grid.index(i, j), simulator.position({i, j}));
      held[grid.index(i, j)] = simulator.pinned({i, j}) ? 1 : 0;
    }
  }
  for (const NodeIndex& carrier : simulator.carriers()) held[grid.index(carrier)] = 1;
  const CoarseMesh mesh = makeCoarseMesh(grid);
  for (const MeshEdge& edge : mesh.edges) {
    const int of_edge = held[edge[0]] + held[edge[1]];
    if (of_edge == 0) continue;
    for (const MeshTriangle& face : mesh.triangles) {
      if (of_edge + held[face[0]] + held[face[1]] + held[face[2]] < 4) continue;
      const bool shares =
          std::any_of(face.begin(), face.end(), [&](std::uint32_t n) { return n == edge[0] || n == edge[1]; });
      if (!shares && passes(position.at(edge[0]), position.at(edge[1]), position.at(face[0]), position.at(face[1]),
                            position.at(face[2])))
        return true;
    }
  }
  return false;
}

}  // namespace curtain_test
