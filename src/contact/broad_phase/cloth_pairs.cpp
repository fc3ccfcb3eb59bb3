// SPDX-License-Identifier: BSD-3-Clause
#include "contact/broad_phase/cloth_pairs.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cloth/wide.h"

namespace curtain {
namespace {

// Floats beyond the end of an array that whole vectors may read.
constexpr std::size_t kBeyond = 16;
// Largest error of a number rounded to single precision, relative to it.
constexpr float kUnit = 0.5f * std::numeric_limits<float>::epsilon();

// Returns the largest magnitude.
CURTAIN_WIDE float copyRow(const double* __restrict from, double origin, std::size_t count, float* __restrict to) {
  float largest = 0.0f;
#pragma omp simd reduction(max : largest)
  for (std::size_t j = 0; j < count; ++j) {
    const auto value = static_cast<float>(from[j] - origin);
    const float size = value < 0.0f ? -value : value;
    to[j] = value;
    largest = largest > size ? largest : size;
  }
  return largest;
}

CURTAIN_WIDE double sumOfDifferences(const double* __restrict from, const double* __restrict to, std::size_t count) {
  double sum = 0.0;
#pragma omp simd reduction(+ : sum)
  for (std::size_t j = 0; j < count; ++j) sum += to[j] - from[j];
  return sum;
}

// Those of pairs that do not stay apart go to take().
template <typename StayApart, typename Take>
void dropApart(const std::vector<FourNodes>& pairs, const StayApart& stay_apart, const Take& take) noexcept {
  for (std::size_t first = 0; first < pairs.size(); first += kPairsAtOnce) {
    const std::size_t count = std::min(kPairsAtOnce, pairs.size() - first);
    std::array<FourNodes, kPairsAtOnce> some;
    for (std::size_t k = 0; k < kPairsAtOnce; ++k) some[k] = pairs[first + std::min(k, count - 1)];
    const std::uint32_t apart = stay_apart(some);
    for (std::size_t k = 0; k < count; ++k) {
      if ((apart >> k & 1U) == 0) take(some[k]);
    }
  }
}

}  // namespace

ClothPairs::ClothPairs(const ClothPattern& pattern)
    : grid_(pattern.grid), elements_(pattern), pyramid_(pattern.grid), pairs_(pyramid_), windows_(pattern, elements_) {
  nodes_.stride = static_cast<std::size_t>(grid_.closed ? Grid::strideFor(grid_.columns + 2) : grid_.stride);
  for (std::array<BlockPyramid::Floats, 3>* const instant : {&nodes_.start, &nodes_.end}) {
    for (BlockPyramid::Floats& component : *instant) component.assign(static_cast<std::size_t>(grid_.rows) * nodes_.stride + kBeyond, 0.0f);
  }
  starts_.assign(grid_.size(), Eigen::Array4f::Zero());
  ends_ = starts_;
  quad_looks_.assign(pyramid_.size(), 0);
  quad_ways_.resize(pyramid_.size());
  // Those of neighbours, and of two quads more.
  vertices_.reserve(kRoomPerNode * grid_.nodeCount());
  edges_.reserve(kRoomPerNode * grid_.nodeCount());
}

void ClothPairs::take(const Field3& start, const Field3& end) noexcept {
  const auto stride = static_cast<std::size_t>(grid_.stride), columns = static_cast<std::size_t>(grid_.columns);
  const Vec3 origin = start.at(0);
  float largest = 0.0f;
  double furthest = origin.cwiseAbs().maxCoeff();
  const auto component = [&](const Field& from, const Field& to, Eigen::Index axis) {
    const auto at = static_cast<std::size_t>(axis);
    double motion = 0.0;
    for (int i = 0; i < grid_.rows; ++i) motion += sumOfDifferences(&from[grid_.row(i)], &to[grid_.row(i)], columns);
    motion /= static_cast<double>(grid_.nodeCount());
    furthest = std::max(furthest, std::abs(origin[axis] + motion));
    for (std::size_t i = 0; i < static_cast<std::size_t>(grid_.rows); ++i) {
      float *const start_row = &nodes_.start[at][i * nodes_.stride], *const end_row = &nodes_.end[at][i * nodes_.stride];
      largest = std::max(largest, copyRow(&from[i * stride], origin[axis], columns, start_row));
      largest = std::max(largest, copyRow(&to[i * stride], origin[axis] + motion, columns, end_row));
      if (!grid_.closed) continue;
      std::copy(start_row, start_row + 2, start_row + columns);
      std::copy(end_row, end_row + 2, end_row + columns);
    }
  };
  component(start.x, end.x, 0);
  component(start.y, end.y, 1);
  component(start.z, end.z, 2);
  // Each of two coordinates is rounded once, and so is their difference, which is at most twice as large; the step to the origin rounds in
  // double precision.
  rounding_ = 4.0f * kUnit * largest + 1e-15f * static_cast<float>(furthest);
  for (std::size_t i = 0; i < static_cast<std::size_t>(grid_.rows); ++i) {
    for (std::size_t j = 0; j < columns; ++j) {
      const std::size_t from = i * nodes_.stride + j, to = i * stride + j;
      starts_[to] = {nodes_.start[0][from], nodes_.start[1][from], nodes_.start[2][from], 0.0f};
      ends_[to] = {nodes_.end[0][from], nodes_.end[1][from], nodes_.end[2][from], 0.0f};
    }
  }
}

void ClothPairs::collect(const Field3& start, const Field3& end, double reach, Candidates& out) noexcept {
  pyramid_.wantAll();
  collectWanted(start, end, reach, out);
}

void ClothPairs::collectOf(const std::vector<std::uint8_t>& marked, const Field3& start, const Field3& end, double reach, Candidates& out) noexcept {
  pyramid_.want(marked);
  collectWanted(start, end, reach, out);
}

void ClothPairs::collectWanted(const Field3& start, const Field3& end, double reach, Candidates& out) noexcept {
  take(start, end);
  ++look_;
  pyramid_.refit(nodes_);
  const float certain = static_cast<float>(reach) * (1.0f + 2.0f * std::numeric_limits<float>::epsilon());
  vertices_.clear();
  edges_.clear();
  windows_.find(nodes_, pyramid_, certain, rounding_);
  windows_.forEachPair([this](const FourNodes& nodes) { vertices_.push_back(nodes); }, [this](const FourNodes& nodes) { edges_.push_back(nodes); });
  if (!pairs_.find(certain + rounding_)) out.full = true;
  collectQuads(certain, out);
  dropApart(certain, out);
}

const QuadWays& ClothPairs::quadWays(std::uint32_t quad) noexcept {
  if (quad_looks_[quad] != look_) {
    quad_looks_[quad] = look_;
    const BlockPyramid::Level& quads = pyramid_.levels().front();
    quad_ways_[quad].fill(quadElements(grid_, quads.rowOf(quad), quads.columnOf(quad)).corners, {starts_.data(), ends_.data()});
  }
  return quad_ways_[quad];
}

void ClothPairs::collectQuads(float reach, Candidates& out) noexcept {
  const BlockPyramid::Level& quads = pyramid_.levels().front();
  for (const BlockPairs::Pair& pair : pairs_.found()) {
    if (quadWays(pair.a).staysApart(quadWays(pair.b), reach, rounding_)) continue;
    constexpr std::size_t kMostOfTwoQuads = 32;
    if (std::max(vertices_.size(), edges_.size()) + kMostOfTwoQuads > vertices_.capacity()) dropApart(reach, out);
    elements_.forEach(quads.rowOf(pair.a), quads.columnOf(pair.a), quads.rowOf(pair.b), quads.columnOf(pair.b),
                      [this](const FourNodes& nodes) { vertices_.push_back(nodes); }, [this](const FourNodes& nodes) { edges_.push_back(nodes); });
  }
}

void ClothPairs::dropApart(float reach, Candidates& out) noexcept {
  const NodeWays ways{starts_.data(), ends_.data()};
  curtain::dropApart(vertices_, [&](const auto& some) { return vertexStaysApart(some, ways, reach, rounding_); },
                     [&](const FourNodes& n) { out.add(VertexTriangle{n[0], {n[1], n[2], n[3]}}); });
  curtain::dropApart(edges_, [&](const auto& some) { return edgesStayApart(some, ways, reach, rounding_); },
                     [&](const FourNodes& n) { out.add(EdgeEdge{{n[0], n[1]}, {n[2], n[3]}}); });
  vertices_.clear();
  edges_.clear();
}

}  // namespace curtain
