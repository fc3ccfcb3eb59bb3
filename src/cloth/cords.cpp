// SPDX-License-Identifier: BSD-3-Clause
#include "cloth/cords.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "cloth/cloth.h"
#include "scene/problem_log.h"
#include "scene/ranges.h"

namespace curtain {
namespace {

// As far below the mean of the nodes as lines of this length let it.
Vec3 placeOfLoad(const LineParams& line, const Vec3& gravity, const std::vector<Vec3>& nodes) {
  if (line.to) return *line.to;
  Vec3 mean = Vec3::Zero();
  for (const Vec3& node : nodes) mean += node / static_cast<double>(nodes.size());
  const Vec3 down = gravity.normalized();
  const double length = line.length.value_or(0.0);
  double depth = length;
  for (const Vec3& node : nodes) {
    // |mean + t down - node| = length, the larger t.
    const Vec3 off = mean - node;
    const double along = off.dot(down);
    depth = std::min(depth, -along + std::sqrt(std::max(0.0, along * along - off.squaredNorm() + length * length)));
  }
  return mean + depth * down;
}

void addCord(std::size_t node, double length, CordsPattern& cords) {
  cords.cords.push_back({node, cords.ends.size() - 1, length});
  cords.ends.back().last = cords.cords.size();
}

// A line that is too short for its distance by its rounding is as long as that.
void addLine(const LineParams& line, const Vec3& gravity, const Field3& position, ClothPattern& pattern) {
  CordsPattern& cords = pattern.cords;
  std::vector<Vec3> nodes;
  for (const NodeIndex& node : line.nodes) nodes.push_back(position.at(pattern.grid.index(node)));
  const std::size_t end = pattern.grid.end(cords.ends.size());
  cords.ends.push_back({end, cords.cords.size(), 0, placeOfLoad(line, gravity, nodes), line.mass.has_value()});
  for (std::size_t i = 0; i < nodes.size(); ++i)
    addCord(pattern.grid.index(line.nodes[i]),
            std::max(line.length.value_or(0.0), (cords.ends.back().start - nodes[i]).norm()), cords);
  if (line.mass) {
    pattern.mass[end] = *line.mass;
    pattern.inverse_mass[end] = 1.0 / *line.mass;
  } else {
    pattern.pinned[end] = kPinned;
  }
}

// Where a column of a loop hangs from a pin, its rods bound how far a node gets: visit(pinned node, length of the rods
// [m], distance of the pin from the loop's point [m]) for each; true ends it.
template <typename Visit>
void forEachPinAbove(const TieBackParams& loop, const ClothPattern& pattern, const Field3& position,
                     const Visit& visit) {
  for (int j = loop.first_column; j <= loop.last_column; ++j) {
    for (int i = 0; i < pattern.grid.rows; ++i) {
      if (!pattern.isPinned({i, j})) continue;
      const double rods = std::abs(pattern.warp_coordinate[pattern.grid.index(loop.row, j)] -
                                   pattern.warp_coordinate[pattern.grid.index(i, j)]);
      if (visit(NodeIndex{i, j}, rods, (loop.point - position.at(pattern.grid.index(i, j))).norm())) return;
    }
  }
}

// A point that is out of the cloth's reach by its rounding makes the loop as much wider.
void addTieBack(const TieBackParams& loop, const Field3& position, ClothPattern& pattern) {
  CordsPattern& cords = pattern.cords;
  double radius = loop.radius;
  forEachPinAbove(loop, pattern, position, [&](const NodeIndex&, double rods, double apart) {
    radius = std::max(radius, apart - rods);
    return false;
  });
  const std::size_t end = pattern.grid.end(cords.ends.size());
  cords.loops.push_back({cords.ends.size(), radius, loop.speed, loop.closed});
  cords.ends.push_back({end, cords.cords.size(), 0, loop.point, false});
  for (int j = loop.first_column; j <= loop.last_column; ++j) addCord(pattern.grid.index(loop.row, j), radius, cords);
  pattern.pinned[end] = kPinned;
}

void checkLine(const LineParams& line, const std::string& key, const CordEnd& end, const CordsPattern& cords,
               const Field3& position, std::vector<Problem>& problems) {
  for (std::size_t c = end.first; c < end.last; ++c) {
    const double apart = (end.start - position.at(cords.cords[c].node)).norm();
    const std::string node = itemKey(joinKey(key, "nodes"), c - end.first);
    if (!line.length && !(apart >= kSmallest)) {
      problems.push_back({node, "must not start where its line ends, unless lines[].length is given"});
      return;
    }
    if (!line.length || apart <= *line.length * (1.0 + kTypedRounding)) continue;
    problems.push_back({joinKey(key, "length"), "must be at least " + formatNumber(apart) + ", the distance of " +
                                                    node + " from the end at the start, is " +
                                                    formatNumber(*line.length)});
    return;
  }
}

void checkTieBack(const TieBackParams& loop, const std::string& key, const ClothPattern& pattern,
                  const Field3& position, std::vector<Problem>& problems) {
  forEachPinAbove(loop, pattern, position, [&](const NodeIndex& pin, double rods, double apart) {
    const double reach = rods + loop.radius;
    if (apart <= reach * (1.0 + kTypedRounding)) return false;
    problems.push_back({joinKey(key, "point"), "must be within the cloth's reach: it is " + formatNumber(apart) +
                                                   " m from the pinned node [" + std::to_string(pin.row) + ", " +
                                                   std::to_string(pin.column) + "], rods and radius are " +
                                                   formatNumber(reach) + " m long"});
    return true;
  });
}

Field3 startOf(const Scene& scene, const ClothPattern& pattern) {
  Field3 position;
  position.assign(pattern.grid.size(), 0.0);
  placeCloth(scene, pattern, position);
  return position;
}

}  // namespace

void addEndRows(const Scene& scene, Grid& grid) {
  const auto ends = static_cast<int>(scene.lines.size() + scene.tie_back.size());
  grid.end_rows = (ends + grid.columns - 1) / grid.columns;
}

void fillCords(const Scene& scene, ClothPattern& pattern) {
  if (scene.lines.empty() && scene.tie_back.empty()) return;
  const Field3 position = startOf(scene, pattern);
  for (const LineParams& line : scene.lines) addLine(line, scene.gravity, position, pattern);
  for (const TieBackParams& loop : scene.tie_back) addTieBack(loop, position, pattern);
}

double reachOf(const CordsPattern& cords, std::size_t loop, const Field3& position) {
  const CordEnd& end = cords.ends[cords.loops[loop].end];
  double reach = cords.loops[loop].radius;
  for (std::size_t c = end.first; c < end.last; ++c)
    reach = std::max(reach, (position.at(end.node) - position.at(cords.cords[c].node)).norm());
  return reach;
}

std::vector<Problem> problemsAtStart(const Scene& scene, const ClothPattern& pattern) {
  std::vector<Problem> problems;
  const CordsPattern& cords = pattern.cords;
  if (cords.empty()) return problems;
  const Field3 position = startOf(scene, pattern);
  for (std::size_t i = 0; i < scene.lines.size(); ++i)
    checkLine(scene.lines[i], itemKey("lines", i), cords.ends[i], cords, position, problems);
  for (std::size_t i = 0; i < scene.tie_back.size(); ++i)
    checkTieBack(scene.tie_back[i], itemKey("tie_back", i), pattern, position, problems);
  return problems;
}

}  // namespace curtain
