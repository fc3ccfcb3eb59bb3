// SPDX-License-Identifier: BSD-3-Clause
//
// Error bound of a drawn strip. p = 0 … k counts the nodes of its folds, U and L are the fine folds, u and l the drawn
// ones, straight between their joints; surfaces are compared at equal p and equal share of the distance down. Three
// steps from the fine strip to the drawn one, each with its largest deviation:
//
//   the fine triangles, their corners moved to u and l   max |U - u|, |L - l|
//   the ruled surface between u and l                    |v'| / 4
//   the drawn triangles                                  w |v'| / 4
//
// v = u - l; v' is its change from one p to the next, the twist of the strip; w is the base of the widest triangle, in
// rods. (A triangle with its base from p to p' on one fold and its corner at q on the other deviates from the ruled
// surface by at most s (1 - s) |p' - q| |v'|.)
#include "curtain_sim/mesh_reducer.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace curtain {
namespace {

// Share of a strip's tolerance for each of its folds. The rest is for the twist, which is as large where folds of
// different detail meet; with more, detail would spread along the folds to where it is not needed.
constexpr double kFoldShare = 0.45;

}  // namespace

MeshReducer::MeshReducer(const FineMeshTopology& topology)
    : topology_(topology),
      links_(topology.closed ? topology.columns / topology.folds : (topology.columns - 1) / topology.folds) {
  for (int rods = topology.folds;; rods = (rods + 1) / 2) {
    Joints joints;
    for (int q = 0; q <= rods; ++q) joints.push_back((2 * q * topology.folds + rods) / (2 * rods));  // to the nearest
    levels_.insert(levels_.begin(), joints);
    if (rods == 1) break;
  }
  const std::size_t count = static_cast<std::size_t>(topology.rows) * static_cast<std::size_t>(links_);
  strip_tolerance_.resize(count);
  level_.resize(count);
  error_.resize(count);
  doubtful_.resize(count);
  triangles_.reserve(topology.triangles.size());
}

const MeshReducer::Triangles& MeshReducer::reduce(const FineMesh& mesh, const MeshDetail& detail) {
  const bool exact = !(detail.tolerance > 0.0) && !(detail.viewer && detail.viewer_tolerance > 0.0);
  if (exact || topology_.folds == 1) return topology_.triangles;
  mesh_ = &mesh;
  setTolerances(detail);
  chooseLevels();
  refineStrips();
  triangles_.clear();
  for (int row = 0; row + 1 < topology_.rows; ++row) {
    for (int link = 0; link < links_; ++link) drawStrip(row, link);
  }
  return triangles_;
}

std::size_t MeshReducer::fold(int row, int link) const { return static_cast<std::size_t>(row * links_ + link); }

std::uint32_t MeshReducer::index(int row, int link, int p) const {
  return static_cast<std::uint32_t>(row * topology_.columns + (link * topology_.folds + p) % topology_.columns);
}

const Vec3& MeshReducer::node(int row, int link, int p) const { return mesh_->positions[index(row, link, p)]; }

void MeshReducer::setTolerances(const MeshDetail& detail) {
  if (!detail.viewer) {
    std::fill(strip_tolerance_.begin(), strip_tolerance_.end(), detail.tolerance);
    return;
  }
  for (int link = 0; link < links_; ++link) {
    Eigen::AlignedBox3d above;
    for (int row = 0; row < topology_.rows; ++row) {
      Eigen::AlignedBox3d box;
      for (int p = 0; p <= topology_.folds; ++p) box.extend(node(row, link, p));
      if (row > 0) {
        const double distance = box.merged(above).exteriorDistance(*detail.viewer);
        strip_tolerance_[fold(row - 1, link)] = std::max(detail.tolerance, detail.viewer_tolerance * distance);
      }
      above = box;
    }
  }
}

void MeshReducer::chooseLevels() {
  for (int row = 0; row < topology_.rows; ++row) {
    for (int link = 0; link < links_; ++link) {
      double allowed = std::numeric_limits<double>::infinity();
      if (row > 0) allowed = strip_tolerance_[fold(row - 1, link)];
      if (row + 1 < topology_.rows) allowed = std::min(allowed, strip_tolerance_[fold(row, link)]);
      allowed *= kFoldShare;
      const std::size_t at = fold(row, link);
      for (level_[at] = 0;; ++level_[at]) {
        error_[at] = foldError(row, link, level_[at], allowed);
        if (error_[at] <= allowed) break;
      }
    }
  }
}

// Strips that deviate too much get the detail of their finer fold, or more. It ends: a strip between two full folds is
// the fine one.
void MeshReducer::refineStrips() {
  std::fill(doubtful_.begin(), doubtful_.end(), char{1});
  for (bool changed = true; changed;) {
    changed = false;
    for (int row = 0; row + 1 < topology_.rows; ++row) {
      for (int link = 0; link < links_; ++link) {
        const std::size_t upper = fold(row, link);
        const std::size_t lower = fold(row + 1, link);
        while (doubtful_[upper] != 0) {
          doubtful_[upper] = 0;
          if (stripError(row, link) <= strip_tolerance_[upper]) break;
          const std::size_t coarsest = std::min(level_[upper], level_[lower]);
          for (const int each : {row, row + 1}) {
            const std::size_t at = fold(each, link);
            if (level_[at] != coarsest) continue;
            error_[at] = foldError(each, link, ++level_[at], std::numeric_limits<double>::infinity());
            doubtful_[at] = 1;
            if (each > 0) doubtful_[fold(each - 1, link)] = 1;
            changed = true;
          }
        }
      }
    }
  }
}

// Largest deviation of a node from the drawn fold; may stop early once it exceeds `enough`.
double MeshReducer::foldError(int row, int link, std::size_t level, double enough) const {
  const Joints& joints = levels_[level];
  double largest = 0.0;
  for (std::size_t n = 0; n + 1 < joints.size() && largest <= enough; ++n) {
    const Vec3& first = node(row, link, joints[n]);
    const Vec3 rod = (node(row, link, joints[n + 1]) - first) / (joints[n + 1] - joints[n]);
    for (int p = joints[n] + 1; p < joints[n + 1]; ++p) {
      largest = std::max(largest, (node(row, link, p) - first - (p - joints[n]) * rod).norm());
    }
  }
  return largest;
}

double MeshReducer::stripError(int row, int link) const {
  const Joints& upper = levels_[level_[fold(row, link)]];
  const Joints& lower = levels_[level_[fold(row + 1, link)]];
  if (&upper == &lower && &upper == &levels_.back()) return 0.0;
  int widest = 1;
  double twist = 0.0;  // squared
  std::size_t u = 0, l = 0;
  while (u + 1 < upper.size()) {  // over the intervals without a joint inside
    const int upper_width = upper[u + 1] - upper[u];
    const int lower_width = lower[l + 1] - lower[l];
    const Vec3 change = (node(row, link, upper[u + 1]) - node(row, link, upper[u])) / upper_width -
                        (node(row + 1, link, lower[l + 1]) - node(row + 1, link, lower[l])) / lower_width;
    twist = std::max(twist, change.squaredNorm());
    widest = std::max({widest, upper_width, lower_width});
    const int end = std::min(upper[u + 1], lower[l + 1]);
    u += upper[u + 1] == end;
    l += lower[l + 1] == end;
  }
  return std::max(error_[fold(row, link)], error_[fold(row + 1, link)]) + 0.25 * (1 + widest) * std::sqrt(twist);
}

void MeshReducer::drawStrip(int row, int link) {
  if (!hasStrip(topology_, row, link)) return;
  const Joints& upper = levels_[level_[fold(row, link)]];
  const Joints& lower = levels_[level_[fold(row + 1, link)]];
  std::size_t u = 0, l = 0;
  while (u + 1 < upper.size() || l + 1 < lower.size()) {
    const std::uint32_t up = index(row, link, upper[u]);
    const std::uint32_t down = index(row + 1, link, lower[l]);
    if (l + 1 == lower.size() || (u + 1 < upper.size() && upper[u + 1] <= lower[l + 1])) {
      triangles_.push_back({up, down, index(row, link, upper[++u])});
    } else {
      triangles_.push_back({up, down, index(row + 1, link, lower[++l])});
    }
  }
}

}  // namespace curtain
