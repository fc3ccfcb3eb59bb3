// SPDX-License-Identifier: BSD-3-Clause
#include "contact/broad_phase/kept_pairs.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

#include "cloth/wide.h"
#include "contact/narrow_phase/staying_apart.h"

namespace curtain {
namespace {

// Looks that the leeway is made for, and its bounds as shares of the reach: below, the pairs that come within reach of it
// are as few as ever; above, they are so many that to go through them costs more than is saved.
constexpr double kLooks = 4.0;
constexpr double kLeastLeeway = 0.05, kMostLeeway = 0.25;
// What is left of the straying that was expected before.
constexpr double kMemory = 0.7;
// The paths are continued to so many times their length: the next substeps go on there.
constexpr double kBeyond = 4.0;
// Rounding of places and ways in double precision, relative to the reach.
constexpr double kSlack = 1e-6;
// Nodes that the times are fitted to: one of so many.
constexpr std::size_t kEvery = 7;
// Up to this share of nodes may stray further than the leeway: their pairs are looked for at every look.
constexpr double kMostMarked = 0.12;

CURTAIN_WIDE void goOn(const double* __restrict start, const double* __restrict end, std::size_t count, double share,
                       double* __restrict from, double* __restrict way, double* __restrict far) {
#pragma omp simd
  for (std::size_t n = 0; n < count; ++n) {
    from[n] = start[n];
    way[n] = share * (end[n] - start[n]);
    far[n] = start[n] + way[n];
  }
}

/// One row of nodes, and where they were expected.
struct Row {
  const double *x, *y, *z;
  const double *from_x, *from_y, *from_z;
  const double *way_x, *way_y, *way_z;
  std::size_t count;
};

// Squares of the distances between nodes and their places at a time, where they exceed what is there already.
CURTAIN_WIDE void raiseDistances(const Row& row, double time, double* __restrict distances) {
  const Row r = row;
#pragma omp simd
  for (std::size_t j = 0; j < r.count; ++j) {
    const double x = r.x[j] - (r.from_x[j] + time * r.way_x[j]);
    const double y = r.y[j] - (r.from_y[j] + time * r.way_y[j]);
    const double z = r.z[j] - (r.from_z[j] + time * r.way_z[j]);
    const double squared = x * x + y * y + z * z;
    distances[j] = squared > distances[j] ? squared : distances[j];
  }
}

}  // namespace

KeptPairs::KeptPairs(const ClothPattern& pattern) : grid_(pattern.grid), tree_(pattern) {
  tree_.reserve(kept_);
  for (Field3* const field : {&from_, &way_, &far_}) field->assign(grid_.size(), 0.0);
  NodeWay still;
  still.start = still.end = Eigen::Array4f::Zero();
  ways_.assign(grid_.size(), still);
  strays_.assign(grid_.size(), 0.0);
  marked_.assign(grid_.size(), 0);
}

void KeptPairs::forget() noexcept {
  kept_.clear();
  reach_ = leeway_ = stray_ = 0.0;
  age_ = 0;
  expects_ = false;
}

void KeptPairs::collect(const Field3& start, const Field3& end, double reach, Candidates& out) noexcept {
  if (expects_) {
    ++age_;
    std::fill(strays_.begin(), strays_.end(), 0.0);
    raiseStrays(start);
    raiseStrays(end);
    if (reach <= reach_) {
      const std::size_t marked = mark(0.5 * (reach_ - reach));
      // Looks for the marked cost more than a descent whose leeway lasts for all.
      if (marked == 0 || (marked <= mostMarked() && kLooks * mostStray() > age_ * kMostLeeway * reach)) {
        if (marked > 0) appendOfMarked(start, end, reach, out);
        appendNear(start, end, reach, out);
        return;
      }
    }
    stray_ = std::max(commonStray(reach) / age_, kMemory * stray_);
  }
  descend(start, end, reach, out);
}

double KeptPairs::leewayFor(double reach) const noexcept {
  const double most = kMostLeeway * reach;
  if (stray_ > most) return 0.0;  // would not last for the next look
  return std::clamp(kLooks * stray_, kLeastLeeway * reach, most);
}

void KeptPairs::descend(const Field3& start, const Field3& end, double reach, Candidates& out) noexcept {
  ++descents_;
  const std::size_t vertices = out.vertex_triangles.size(), edges = out.edge_edges.size();
  leeway_ = expects_ ? leewayFor(reach) : 0.0;
  // Cloth that comes near itself nowhere is descended in less time than straying is measured.
  if (leeway_ == 0.0) {
    tree_.refit(start, end);
    tree_.collectSelf(reach, out);
    reach_ = -1.0;
    expects_ = out.vertex_triangles.size() > vertices || out.edge_edges.size() > edges;
  }
  age_ = 0;
  if (!expects_) return;
  const auto continued = [count = grid_.size()](const Field& p, const Field& q, Field& from, Field& way, Field& far) {
    goOn(p.data(), q.data(), count, kBeyond, from.data(), way.data(), far.data());
  };
  continued(start.x, end.x, from_.x, way_.x, far_.x);
  continued(start.y, end.y, from_.y, way_.y, far_.y);
  continued(start.z, end.z, from_.z, way_.z, far_.z);
  if (leeway_ == 0.0) return;
  std::fill(marked_.begin(), marked_.end(), std::uint8_t{0});
  kept_.clear();
  reach_ = reach;
  tree_.refit(from_, far_);
  tree_.collectSelf(reach * (1.0 + kSlack) + 2.0 * leeway_, kept_);
  if (kept_.full) {  // more than can be kept
    reach_ = -1.0;
    tree_.refit(start, end);
    tree_.collectSelf(reach, out);
    return;
  }
  expects_ = !kept_.vertex_triangles.empty() || !kept_.edge_edges.empty();
  appendNear(start, end, reach, out);
}

// How far nodes are from their expected way, at the time that fits best.
void KeptPairs::raiseStrays(const Field3& position) noexcept {
  double along = 0.0, squared = 0.0;
  for (std::size_t n = 0; n < grid_.size(); n += kEvery) {
    const Vec3 way = way_.at(n);
    along += way.dot(position.at(n) - from_.at(n));
    squared += way.squaredNorm();
  }
  const double time = along > 0.0 ? std::min(along / squared, 1.0) : 0.0;
  for (int i = 0; i < grid_.rows; ++i) {
    const std::size_t n = grid_.index(i, 0);
    raiseDistances({&position.x[n], &position.y[n], &position.z[n], &from_.x[n], &from_.y[n], &from_.z[n], &way_.x[n],
                    &way_.y[n], &way_.z[n], static_cast<std::size_t>(grid_.columns)},
                   time, &strays_[n]);
  }
}

std::size_t KeptPairs::mostMarked() const noexcept {
  return static_cast<std::size_t>(kMostMarked * static_cast<double>(grid_.nodeCount()));
}

// Marks the nodes that strayed further than the leeway and so much more; returns their number.
std::size_t KeptPairs::mark(double more) noexcept {
  const double most = (leeway_ + more) * (leeway_ + more);
  std::size_t count = 0;
  for (std::size_t n = 0; n < grid_.size(); ++n) {
    marked_[n] = strays_[n] > most ? 1 : 0;
    count += marked_[n];
  }
  return count;
}

double KeptPairs::mostStray() const noexcept {
  return std::sqrt(*std::max_element(strays_.begin(), strays_.end()));
}

// What a leeway would have to be for no marks, or where that is too much, for few enough. Leaves the strays in another
// order.
double KeptPairs::commonStray(double reach) noexcept {
  const double most = mostStray();
  if (kLooks * most <= age_ * kMostLeeway * reach) return most;
  const auto at = strays_.end() - 1 - static_cast<std::ptrdiff_t>(mostMarked() / 2);
  std::nth_element(strays_.begin(), at, strays_.end());
  return std::sqrt(*at);
}

// Pairs of the marked are looked for along the ways as they are, and those of unmarked nodes alone are kept ones.
void KeptPairs::appendOfMarked(const Field3& start, const Field3& end, double reach, Candidates& out) noexcept {
  const std::size_t first_vertex = out.vertex_triangles.size(), first_edge = out.edge_edges.size();
  tree_.refit(start, end);
  tree_.collectSelfOf(marked_, reach, out);
  const auto drop = [this](auto& pairs, std::size_t first) {
    const auto kept = [this](const auto& pair) { return !hasMarked(nodesOf(pair)); };
    pairs.erase(std::remove_if(pairs.begin() + static_cast<std::ptrdiff_t>(first), pairs.end(), kept), pairs.end());
  };
  drop(out.vertex_triangles, first_vertex);
  drop(out.edge_edges, first_edge);
}

void KeptPairs::appendNear(const Field3& start, const Field3& end, double reach, Candidates& out) noexcept {
  if (!expects_) return;
  fillWays(start, end);
  const float limit = static_cast<float>(reach) * (1.0f + 2.0f * std::numeric_limits<float>::epsilon()) + rounding_;
  const auto box_of = [this](const auto& element) {
    FloatBox box = ways_[element[0]].box();
    for (std::size_t k = 1; k < element.size(); ++k) box.merge(ways_[element[k]].box());
    return box;
  };
  const auto meet = [&](const auto& pair) {
    if constexpr (std::is_same_v<decltype(pair), const EdgeEdge&>) {
      return box_of(pair.first).meets(box_of(pair.second), limit);
    } else {
      return ways_[pair.vertex].box().meets(box_of(pair.triangle), limit);
    }
  };
  const auto append = [&](const auto& pairs, const auto& stay_apart) {
    for (std::size_t first = 0; first < pairs.size(); first += 4) {
      const std::size_t count = std::min<std::size_t>(4, pairs.size() - first);
      std::array<FourNodes, 4> four;
      for (std::size_t k = 0; k < 4; ++k) four[k] = nodesOf(pairs[first + std::min(k, count - 1)]);
      const std::uint32_t apart = stay_apart(four, ways_.data(), limit, rounding_);
      if (apart == 0xFU) continue;
      for (std::size_t k = 0; k < count; ++k) {
        if ((apart >> k & 1U) == 0 && !hasMarked(four[k]) && meet(pairs[first + k])) out.add(pairs[first + k]);
      }
    }
  };
  append(kept_.vertex_triangles, vertexStaysApart);
  append(kept_.edge_edges, edgesStayApart);
}

void KeptPairs::fillWays(const Field3& start, const Field3& end) noexcept {
  origin_ = start.at(0);
  Eigen::Array4f largest = Eigen::Array4f::Zero();
  for (int i = 0; i < grid_.rows; ++i) {
    for (int j = 0; j < grid_.columns; ++j) {
      const std::size_t n = grid_.index(i, j);
      const Eigen::Vector3f p = (start.at(n) - origin_).cast<float>(), q = (end.at(n) - origin_).cast<float>();
      NodeWay& way = ways_[n];
      way.start.head<3>() = p.array();
      way.end.head<3>() = q.array();
      largest = largest.max(way.start.abs().max(way.end.abs()));
    }
  }
  rounding_ = ClothTree::roundingOf(largest.maxCoeff(), origin_);
}

}  // namespace curtain
