// SPDX-License-Identifier: BSD-3-Clause
//
// Checks that lines and tie-backs belong to nodes of the cloth and have an end. Whether their lengths fit is known when
// the cloth is in its place: problemsAtStart() (cloth/cords.h).
#include <algorithm>

#include "scene/checks.h"
#include "scene/ranges.h"

namespace curtain {
namespace {

// Lines of one entry [1]: the weft links of the largest cloth.
constexpr std::size_t kMaxNodes = 4096;

bool isSame(const NodeIndex& a, const NodeIndex& b) { return a.row == b.row && a.column == b.column; }

void checkNodes(const LineParams& line, const ClothParams& cloth, const std::string& key, ProblemLog& log) {
  if (!log.good(key)) return;
  if (line.nodes.empty() || line.nodes.size() > kMaxNodes) {
    log.add(key, "must have 1 to " + std::to_string(kMaxNodes) + " entries [row, column], has " +
                     std::to_string(line.nodes.size()));
    return;
  }
  for (std::size_t i = 0; i < line.nodes.size(); ++i) {
    const std::string node_key = itemKey(key, i);
    checkNodeOnGrid(line.nodes[i], cloth, node_key, log);
    const auto same = [&](const NodeIndex& other) { return isSame(other, line.nodes[i]); };
    const auto here = line.nodes.begin() + static_cast<std::ptrdiff_t>(i);
    const auto first = std::find_if(line.nodes.begin(), here, same);
    if (first == here || !log.good(node_key)) continue;
    log.add(node_key, "must be another node than " +
                          itemKey(key, static_cast<std::size_t>(first - line.nodes.begin())) + ", is the same");
  }
}

void checkEnd(const LineParams& line, const std::string& key, ProblemLog& log) {
  const bool readable = log.good(joinKey(key, "to")) && log.good(joinKey(key, "mass"));
  if (line.to || !readable) return;
  if (!line.mass) {
    log.add(joinKey(key, "to"), "is missing, must be a list of 3 numbers: the fixed end; or give mass: that of a load");
  } else if (!line.length && log.good(joinKey(key, "length"))) {
    log.add(joinKey(key, "length"),
            "is missing, must be " + positive().text() + " where there is no `to`: the load starts as far below");
  }
}

void checkTieBack(const TieBackParams& loop, const ClothParams& cloth, const std::string& key, ProblemLog& log) {
  const auto check = [&](const char* name, int value, int low, int high) {
    if (!log.good(joinKey(key, name)) || (value >= low && value <= high)) return;
    log.add(joinKey(key, name),
            "must be in [" + std::to_string(low) + ", " + std::to_string(high) + "], is " + std::to_string(value));
  };
  if (log.good("cloth.rows")) check("row", loop.row, 0, cloth.rows - 1);
  if (!log.good("cloth.columns")) return;
  check("first_column", loop.first_column, 0, cloth.columns - 1);
  if (log.good(joinKey(key, "first_column")))
    check("last_column", loop.last_column, loop.first_column, cloth.columns - 1);
}

}  // namespace

void checkLines(const Scene& scene, const ClothParams& whole, ProblemLog& log) {
  for (std::size_t i = 0; i < scene.lines.size(); ++i) {
    const std::string key = itemKey("lines", i);
    checkNodes(scene.lines[i], whole, joinKey(key, "nodes"), log);
    checkEnd(scene.lines[i], key, log);
    if (!scene.lines[i].to && scene.lines[i].mass && log.good("gravity") && scene.gravity.isZero())
      log.add(joinKey(key, "to"), "is missing, must be a list of 3 numbers: without gravity no load hangs below");
  }
  for (std::size_t i = 0; i < scene.tie_back.size(); ++i)
    checkTieBack(scene.tie_back[i], whole, itemKey("tie_back", i), log);
  if (scene.solver.method != Method::kPaper || (scene.lines.empty() && scene.tie_back.empty())) return;
  log.add("solver.method", std::string("must not be paper where there are ") +
                               (scene.lines.empty() ? "tie-backs (tie_back)" : "lines") +
                               ": that scheme solves for no cords");
}

}  // namespace curtain
