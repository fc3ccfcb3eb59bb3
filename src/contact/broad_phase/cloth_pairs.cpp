// SPDX-License-Identifier: BSD-3-Clause
#include "contact/broad_phase/cloth_pairs.h"

#include <algorithm>
#include <limits>

#include "cloth/wide.h"

namespace curtain {
namespace {

// Blocks that are asked whether they are even: of 8 x 8 quads.
constexpr std::size_t kEvenLevel = 3;
// The mean motion is that of one of so many rows.
constexpr int kSampledRows = 4;
// Pairs of quads that wait to be looked at together.
constexpr std::size_t kQuadsAtOnce = 1024;
// Room of a share of a look over its part of all there is room for.
constexpr std::size_t kRoomOverPart = 2;
// Floats beyond the end of an array that whole vectors may read.
constexpr std::size_t kBeyond = 16;
// Largest error of a number rounded to single precision, relative to it.
constexpr float kUnit = 0.5f * std::numeric_limits<float>::epsilon();

CURTAIN_WIDE void subtract(const double* __restrict from, double origin, std::size_t count, float* __restrict to) {
#pragma omp simd
  for (std::size_t j = 0; j < count; ++j) to[j] = static_cast<float>(from[j] - origin);
}

CURTAIN_WIDE double sumOfDifferences(const double* __restrict from, const double* __restrict to, std::size_t count) {
  double sum = 0.0;
#pragma omp simd reduction(+ : sum)
  for (std::size_t j = 0; j < count; ++j) sum += to[j] - from[j];
  return sum;
}

struct Doubles3 {
  const double *x, *y, *z;
};

struct Floats3 {
  const float *x, *y, *z;
};

// Counted in floats, all lanes being of one width.
CURTAIN_WIDE std::size_t markRow(const Doubles3& at, const Floats3& expected, const Vec3& origin, float most_squared,
                                 std::size_t count, std::uint8_t* __restrict marks) {
  const Doubles3 p = at;
  const Floats3 q = expected;
  const double ox = origin.x(), oy = origin.y(), oz = origin.z();
  float marked = 0.0f;
#pragma omp simd reduction(+ : marked)
  for (std::size_t j = 0; j < count; ++j) {
    const float x = static_cast<float>(p.x[j] - ox) - q.x[j], y = static_cast<float>(p.y[j] - oy) - q.y[j],
                z = static_cast<float>(p.z[j] - oz) - q.z[j];
    const float apart = x * x + y * y + z * z > most_squared ? 1.0f : 0.0f;
    marks[j] = apart > 0.0f ? 1 : 0;
    marked += apart;
  }
  return static_cast<std::size_t>(marked);
}

// Leaves those of the pairs from `near` on that do not stay apart.
template <typename StayApart>
void keepNotApart(const StayApart& stay_apart, std::vector<FourNodes>& pairs, std::size_t& near) noexcept {
  for (std::size_t first = near; first < pairs.size(); first += kPairsAtOnce) {
    const std::size_t count = std::min(kPairsAtOnce, pairs.size() - first);
    std::array<FourNodes, kPairsAtOnce> some;
    for (std::size_t k = 0; k < kPairsAtOnce; ++k) some[k] = pairs[first + std::min(k, count - 1)];
    const std::uint32_t apart = stay_apart(some);
    for (std::size_t k = 0; k < count; ++k) {
      if ((apart >> k & 1U) == 0) pairs[near++] = some[k];
    }
  }
  pairs.resize(near);
}

}  // namespace

ClothPairs::ClothPairs(const ClothPattern& pattern, const Workers* workers)
    : grid_(pattern.grid),
      elements_(pattern),
      per_spacing_(pattern),
      pyramid_(pattern.grid),
      even_level_(std::min(kEvenLevel, pyramid_.levels().size() - 1)),
      even_(pattern.grid, per_spacing_, pyramid_.levels()[even_level_], 1 << even_level_),
      pairs_(pyramid_),
      windows_(pattern.grid, per_spacing_, elements_),
      workers_(workers),
      shares_(workers == nullptr ? 1 : static_cast<std::size_t>(workers->shares())) {
  for (MovingNodes* const nodes : {&expected_.nodes, &elsewhere_.nodes}) {
    nodes->stride = static_cast<std::size_t>(grid_.closed ? Grid::strideFor(grid_.columns + 2) : grid_.stride);
    const std::size_t size = static_cast<std::size_t>(grid_.rows) * nodes->stride + kBeyond;
    for (BlockPyramid::Floats& component : nodes->start) component.assign(size, 0.0f);
    for (BlockPyramid::Floats& component : nodes->end) component.assign(size, 0.0f);
  }
  marked_.assign(grid_.size(), 0);
  starts_.assign(grid_.size(), Eigen::Array4f::Zero());
  ends_ = starts_;
  for (Share& share : shares_) {
    share.quads.reserve(kQuadsAtOnce);
    for (Pairs* const pairs : {&share.vertices, &share.edges})
      pairs->nodes.reserve(std::min(shares_.size(), kRoomOverPart) * kRoomPerNode * grid_.nodeCount() / shares_.size());
  }
}

void ClothPairs::take(const Field3& start, const Field3& end, Motion& motion) noexcept {
  const auto stride = static_cast<std::size_t>(grid_.stride), columns = static_cast<std::size_t>(grid_.columns);
  MovingNodes& nodes = motion.nodes;
  motion.start = start.at(0);
  const auto copy = [&](const Field& from, double origin, BlockPyramid::Floats& to) {
    if (!grid_.closed) {
      subtract(from.data(), origin, from.size(), to.data());
      return;
    }
    for (std::size_t i = 0; i < static_cast<std::size_t>(grid_.rows); ++i) {
      float* const row = &to[i * nodes.stride];
      subtract(&from[i * stride], origin, columns, row);
      std::copy(row, row + 2, row + columns);
    }
  };
  const auto component = [&](const Field& from, const Field& to, Eigen::Index axis) {
    double sum = 0.0, sampled = 0.0;
    for (int i = 0; i < grid_.rows; i += kSampledRows) {
      sum += sumOfDifferences(&from[grid_.row(i)], &to[grid_.row(i)], columns);
      sampled += static_cast<double>(columns);
    }
    motion.end[axis] = motion.start[axis] + sum / sampled;
    copy(from, motion.start[axis], nodes.start[static_cast<std::size_t>(axis)]);
    copy(to, motion.end[axis], nodes.end[static_cast<std::size_t>(axis)]);
  };
  component(start.x, end.x, 0);
  component(start.y, end.y, 1);
  component(start.z, end.z, 2);
  even_.measure(nodes);
  const auto low = [this](int i, int j, int axis) { return even_.low(i, j, axis); };
  const auto high = [this](int i, int j, int axis) { return even_.high(i, j, axis); };
  pyramid_.refitFrom(even_level_, low, high);
  // Each of two coordinates is rounded once, and so is their difference, which is at most twice as large; the step to
  // the origin rounds in double precision.
  motion.rounding = 4.0f * kUnit * even_.largest() +
                    1e-15f * static_cast<float>(motion.start.cwiseAbs().cwiseMax(motion.end.cwiseAbs()).maxCoeff());
}

void ClothPairs::placeOneByOne(const MovingNodes& nodes) noexcept {
  for (std::size_t i = 0; i < static_cast<std::size_t>(grid_.rows); ++i) {
    for (std::size_t j = 0; j < static_cast<std::size_t>(grid_.columns); ++j) {
      const std::size_t from = i * nodes.stride + j, to = i * static_cast<std::size_t>(grid_.stride) + j;
      starts_[to] = {nodes.start[0][from], nodes.start[1][from], nodes.start[2][from], 0.0f};
      ends_[to] = {nodes.end[0][from], nodes.end[1][from], nodes.end[2][from], 0.0f};
    }
  }
}

void ClothPairs::collect(const Field3& start, const Field3& end, double reach, Candidates& out) noexcept {
  reach_ = reach;
  take(start, end, expected_);
  collectOf(nullptr, expected_, reach, out);
}

// Where neither of two elements ends further than this from where it was expected to, they were candidates.
void ClothPairs::collectElsewhere(const Field3& start, const Field3& end, double reach, Candidates& out) noexcept {
  if (markElsewhere(end, 0.5 * (reach_ - reach)) == 0) return;
  take(start, end, elsewhere_);
  collectOf(&marked_, elsewhere_, reach, out);
}

// Marks the nodes that end further than that from where they were expected to; returns their number.
std::size_t ClothPairs::markElsewhere(const Field3& end, double most) noexcept {
  const float certain = static_cast<float>(most) - 2.0f * expected_.rounding;
  const float most_squared = certain > 0.0f ? certain * certain * (1.0f - 1e-5f) : -1.0f;
  std::size_t count = 0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(grid_.rows); ++i) {
    const std::size_t n = i * static_cast<std::size_t>(grid_.stride), m = i * expected_.nodes.stride;
    const Floats3 expected{&expected_.nodes.end[0][m], &expected_.nodes.end[1][m], &expected_.nodes.end[2][m]};
    count += markRow({&end.x[n], &end.y[n], &end.z[n]}, expected, expected_.end, most_squared,
                     static_cast<std::size_t>(grid_.columns), &marked_[n]);
  }
  return count;
}

void ClothPairs::collectOf(const std::vector<std::uint8_t>* marked, const Motion& motion, double reach,
                           Candidates& out) noexcept {
  const float certain = static_cast<float>(reach) * (1.0f + 2.0f * std::numeric_limits<float>::epsilon()),
              rounding = motion.rounding;
  pyramid_.select(marked);
  const bool uneven = even_.find(certain, rounding);
  if (!uneven && !pairs_.any(certain + rounding, even_level_)) return;
  pyramid_.refitBelow(even_level_, motion.nodes);
  pyramid_.fillOneByOne();
  if (uneven) {
    pyramid_.leaveOut(even_level_, [this](int i, int j) { return even_.isUneven(i, j); });
    windows_.find(motion.nodes, pyramid_, certain, rounding);
  }
  placeOneByOne(motion.nodes);
  const Look look{certain, rounding, uneven, &out};
  const auto collect_one = [&](int s) { collectShare(look, s, shares_[static_cast<std::size_t>(s)]); };
  const int count = static_cast<int>(shares_.size());
  if (workers_ != nullptr)
    workers_->run(count, collect_one);
  else
    for (int s = 0; s < count; ++s) collect_one(s);
  for (Share& share : shares_) handOver(look, share);
}

void ClothPairs::collectShare(const Look& look, int index, Share& share) const noexcept {
  const float around = look.reach + look.rounding;
  if (look.uneven) {
    windows_.forEachPair(
        ways(), around, static_cast<std::size_t>(index), shares_.size(),
        [&](const FourNodes& nodes) { addVertex(look, nodes, share); },
        [&](const FourNodes& nodes) { addEdge(look, nodes, share); });
  }
  pairs_.find(around, look.uneven ? 0 : even_level_, {index, static_cast<int>(shares_.size())},
              [&](std::size_t a, std::size_t b) {
                if (share.quads.size() == share.quads.capacity()) addElements(look, share);
                share.quads.push_back({static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b)});
              });
  addElements(look, share);
  dropApartVertices(look, share);
  dropApartEdges(look, share);
}

// Leaves the pairs of quads that are not told to stay apart.
void ClothPairs::keepNear(QuadsStayApart stay_apart, const Look& look, std::vector<QuadPair>& quads) const noexcept {
  const BlockPyramid::Level& level = pyramid_.levels().front();
  const auto corners = [&](std::size_t quad) {
    const int i = level.rowOf(quad), j = level.columnOf(quad), right = j + 1 < grid_.columns ? j + 1 : 0;
    const auto node = [&](int row, int column) { return static_cast<std::uint32_t>(grid_.index(row, column)); };
    return FourNodes{node(i, j), node(i, right), node(i + 1, j), node(i + 1, right)};
  };
  std::size_t kept = 0;
  for (std::size_t first = 0; first < quads.size(); first += kPairsAtOnce) {
    const std::size_t count = std::min(kPairsAtOnce, quads.size() - first);
    std::array<TwoQuads, kPairsAtOnce> some;
    for (std::size_t k = 0; k < kPairsAtOnce; ++k) {
      const QuadPair& pair = quads[first + std::min(k, count - 1)];
      some[k] = {corners(pair.a), corners(pair.b)};
    }
    const std::uint32_t apart = stay_apart(some, ways(), look.reach, look.rounding);
    for (std::size_t k = 0; k < count; ++k) {
      if ((apart >> k & 1U) == 0) quads[kept++] = quads[first + k];
    }
  }
  quads.resize(kept);
}

// Of the quads that wait.
void ClothPairs::addElements(const Look& look, Share& share) const noexcept {
  keepNear(quadsStayApart, look, share.quads);
  keepNear(quadsStayApartSomehow, look, share.quads);
  const BlockPyramid::Level& level = pyramid_.levels().front();
  for (const QuadPair& pair : share.quads) {
    elements_.forEach(
        level.rowOf(pair.a), level.columnOf(pair.a), level.rowOf(pair.b), level.columnOf(pair.b),
        [&](const FourNodes& nodes) { addVertex(look, nodes, share); },
        [&](const FourNodes& nodes) { addEdge(look, nodes, share); });
  }
  share.quads.clear();
}

// Where there is no room for more, those that wait are looked at, and what is near goes to where it all goes.
void ClothPairs::addVertex(const Look& look, const FourNodes& nodes, Share& share) const noexcept {
  if (share.vertices.isFull()) dropApartVertices(look, share);
  if (share.vertices.isFull()) makeRoom(look, share);
  share.vertices.nodes.push_back(nodes);
}

void ClothPairs::addEdge(const Look& look, const FourNodes& nodes, Share& share) const noexcept {
  if (share.edges.isFull()) dropApartEdges(look, share);
  if (share.edges.isFull()) makeRoom(look, share);
  share.edges.nodes.push_back(nodes);
}

// While others may do the same.
void ClothPairs::makeRoom(const Look& look, Share& share) const noexcept {
  dropApartVertices(look, share);
  dropApartEdges(look, share);
  const std::lock_guard<std::mutex> alone(making_room_);
  handOver(look, share);
}

// What is near of a share.
void ClothPairs::handOver(const Look& look, Share& share) noexcept {
  for (const FourNodes& n : share.vertices.nodes) look.out->add(VertexTriangle{n[0], {n[1], n[2], n[3]}});
  for (const FourNodes& n : share.edges.nodes) look.out->add(EdgeEdge{{n[0], n[1]}, {n[2], n[3]}});
  share.clear();
}

void ClothPairs::dropApartVertices(const Look& look, Share& share) const noexcept {
  keepNotApart([&](const auto& some) { return vertexStaysApart(some, ways(), look.reach, look.rounding); },
               share.vertices.nodes, share.vertices.near);
}

void ClothPairs::dropApartEdges(const Look& look, Share& share) const noexcept {
  keepNotApart([&](const auto& some) { return edgesStayApart(some, ways(), look.reach, look.rounding); },
               share.edges.nodes, share.edges.near);
}

}  // namespace curtain
