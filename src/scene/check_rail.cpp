// SPDX-License-Identifier: BSD-3-Clause
//
// Checks that a rail's curve, its carriers and the cloth fit together.
#include <algorithm>
#include <cmath>

#include "scene/checks.h"
#include "scene/rail_layout.h"
#include "scene/rail_path.h"
#include "scene/ranges.h"

namespace curtain {
namespace {

// Steepest rail, as the sine of its slope (60 degrees): columns that hang from it need room beside each other.
constexpr double kSteepest = 0.87;
// Sharpest corner, as the cosine of its turn (120 degrees): the cloth on both sides of it would touch.
constexpr double kSharpest = -0.5;
// An arc is looked at in so many places.
constexpr int kSamples = 8;

bool checkPath(const std::vector<RailPiece>& pieces, ProblemLog& log) {
  if (pieces.size() < 2) {
    log.add("rail.path", "must have at least 2 entries, has 1");
    return false;
  }
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const std::string text = RailPath::problemOf(pieces, i);
    if (text.empty()) continue;
    log.add(itemKey("rail.path", i), text);
    return false;
  }
  const RailPath path(pieces);
  Vec3 before = Vec3::Zero();
  for (std::size_t i = 1; i < pieces.size(); ++i) {
    const RailPath piece({pieces[i - 1].centre ? RailPiece{pieces[i - 1].to, {}} : pieces[i - 1], pieces[i]});
    if (before.dot(piece.at(0.0).tangent) < kSharpest * (1.0 + kTypedRounding)) {
      log.add(itemKey("rail.path", i), "must not turn by more than 120 degrees from the piece before it");
      return false;
    }
    for (int k = 0; k <= kSamples; ++k) {
      if (std::abs(piece.at(piece.length() * k / kSamples).tangent.z()) <= kSteepest) continue;
      log.add(itemKey("rail.path", i), "must not be steeper than 60 degrees");
      return false;
    }
    before = piece.at(piece.length()).tangent;
  }
  return true;
}

bool checkColumns(const Scene& scene, ProblemLog& log) {
  const std::vector<int>& columns = scene.rail.carriers.columns;
  const int last = scene.cloth.columns - 1;
  if (columns.empty()) return true;
  const bool sorted = std::adjacent_find(columns.begin(), columns.end(), std::greater_equal<>()) == columns.end();
  if (sorted && columns.size() >= 2 && columns.front() == 0 && columns.back() == last) return true;
  log.add("rail.carriers.columns", "must increase from 0 to the last column, " + std::to_string(last));
  return false;
}

bool checkMasters(const Scene& scene, const std::vector<int>& columns, ProblemLog& log) {
  const std::vector<int>& masters = scene.rail.masters;
  std::vector<std::ptrdiff_t> at;
  for (std::size_t i = 0; i < masters.size(); ++i) {
    at.push_back(std::find(columns.begin(), columns.end(), masters[i]) - columns.begin());
    if (at[i] < static_cast<std::ptrdiff_t>(columns.size())) continue;
    log.add(itemKey("rail.masters", i), "must be the column of a carrier, is " + std::to_string(masters[i]));
    return false;
  }
  if (masters.size() < 2 || (masters.size() == 2 && at[1] == at[0] + 1)) return true;
  log.add("rail.masters", "must be one carrier's column, or those of two neighbouring carriers, increasing");
  return false;
}

// Neighbouring carriers must fit on the cloth between them, and all of them on the rail.
void checkFit(const Scene& scene, const std::vector<int>& columns, ProblemLog& log) {
  const double gap = scene.rail.carriers.gap;
  const std::vector<double> cloth = RailLayout::clothBetween(scene, columns);
  for (std::size_t k = 0; k < cloth.size(); ++k) {
    if (gap < cloth[k]) continue;
    log.add("rail.carriers.gap", "must be less than the cloth between carriers, is " + formatNumber(gap) +
                                     " m: between columns " + std::to_string(columns[k]) + " and " +
                                     std::to_string(columns[k + 1]) + " are " + formatNumber(cloth[k]) + " m of cloth");
    return;
  }
  const double length = RailPath(scene.rail.path).length();
  for (const RailLayout::Half& half : RailLayout::halvesOf(scene.rail, columns, cloth, length)) {
    if (half.narrowest < half.widest) continue;
    log.add("rail.path", "must be longer than its carriers' gaps: " + std::to_string(half.end - half.first) +
                             " carriers take " + formatNumber(half.narrowest) + " m, and have " +
                             formatNumber(half.widest) + " m of it");
    return;
  }
}

}  // namespace

void checkRail(const Scene& scene, ProblemLog& log) {
  if (scene.rail.path.empty() || !log.good("rail") || !log.good("cloth")) return;
  if (scene.solver.method == Method::kPaper)
    log.add("solver.method", "must not be paper where there is a rail: that scheme knows no carriers");
  const bool path_is_good = checkPath(scene.rail.path, log);
  if (scene.cloth.closed) log.add("cloth.closed", "must be false where there is a rail");
  if (scene.cloth.hem_width && *scene.cloth.hem_width < scene.cloth.width * (1.0 - kTypedRounding)) {
    log.add("cloth.hem_width", "must not be less than cloth.width = " + formatNumber(scene.cloth.width) +
                                   " where there is a rail, is " + formatNumber(*scene.cloth.hem_width));
  }
  if (!log.good("cloth") || !path_is_good || !checkColumns(scene, log)) return;
  const std::vector<int> columns = RailLayout::columnsOf(scene);
  if (checkMasters(scene, columns, log)) checkFit(scene, columns, log);
}

}  // namespace curtain
