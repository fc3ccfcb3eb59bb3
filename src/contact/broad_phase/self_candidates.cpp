// SPDX-License-Identifier: BSD-3-Clause
#include "contact/broad_phase/self_candidates.h"

#include <algorithm>
#include <limits>

#include "cloth/wide.h"
#include "contact/broad_phase/worker_share.h"

namespace curtain {
namespace {

// Level of the blocks that are proven flat: 8 x 8 quads. Smaller ones cost more, larger ones are flat less often.
constexpr std::size_t kFlatLevel = 3;
// The mean motion is taken over every n-th row.
constexpr int kSampledRows = 4;
// Pairs of quads that are tested together.
constexpr std::size_t kQuadsAtOnce = 1024;
// Padding [floats] behind the arrays, so that vector loads stay inside.
constexpr std::size_t kBeyond = 16;
// Unit roundoff of single precision.
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

struct Floats3 {
  const float *x, *y, *z;
};

// Marks the nodes of a row that are further than the bound from where they were expected, and counts them (in floats,
// so that all lanes have one width).
CURTAIN_WIDE std::size_t markRow(const ConstFieldView& at, const Floats3& expected, const Vec3& origin,
                                 float most_squared, std::size_t count, std::uint8_t* __restrict marks) {
  const ConstFieldView p = at;
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

}  // namespace

SelfCandidates::SelfCandidates(const ClothPattern& pattern, const Workers* workers)
    : grid_(pattern.grid),
      elements_(pattern),
      per_spacing_(pattern),
      hierarchy_(pattern.grid),
      flat_level_(std::min(kFlatLevel, hierarchy_.levels().size() - 1)),
      flat_blocks_(pattern.grid, per_spacing_, hierarchy_.levels()[flat_level_], 1 << flat_level_),
      pairs_(hierarchy_),
      windows_(pattern.grid, per_spacing_, elements_),
      workers_(workers),
      shares_(workers == nullptr ? 1 : static_cast<std::size_t>(workers->shares())) {
  for (MovingNodes* const nodes : {&expected_.nodes, &deviating_.nodes}) {
    nodes->stride = static_cast<std::size_t>(grid_.closed ? Grid::strideFor(grid_.columns + 2) : grid_.stride);
    const std::size_t size = static_cast<std::size_t>(grid_.rows) * nodes->stride + kBeyond;
    for (BoxHierarchy::Floats& component : nodes->start) component.assign(size, 0.0f);
    for (BoxHierarchy::Floats& component : nodes->end) component.assign(size, 0.0f);
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

void SelfCandidates::setMotion(const Field3& start, const Field3& end, Motion& motion) noexcept {
  const auto stride = static_cast<std::size_t>(grid_.stride), columns = static_cast<std::size_t>(grid_.columns);
  MovingNodes& nodes = motion.nodes;
  motion.start = start.at(0);
  const auto copy = [&](const Field& from, double origin, BoxHierarchy::Floats& to) {
    if (!grid_.closed) {
      subtract(from.data(), origin, grid_.row(grid_.rows), to.data());
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
  flat_blocks_.measure(nodes);
  const auto low = [this](int i, int j, int axis) { return flat_blocks_.low(i, j, axis); };
  const auto high = [this](int i, int j, int axis) { return flat_blocks_.high(i, j, axis); };
  hierarchy_.refitFrom(flat_level_, low, high);
  // Two coordinates are rounded once each, and so is their difference, which is at most twice as large; the shift to
  // the origin rounds in double precision.
  motion.rounding = 4.0f * kUnit * flat_blocks_.largest() +
                    1e-15f * static_cast<float>(motion.start.cwiseAbs().cwiseMax(motion.end.cwiseAbs()).maxCoeff());
}

void SelfCandidates::interleaveNodes(const MovingNodes& nodes) noexcept {
  for (std::size_t i = 0; i < static_cast<std::size_t>(grid_.rows); ++i) {
    for (std::size_t j = 0; j < static_cast<std::size_t>(grid_.columns); ++j) {
      const std::size_t from = i * nodes.stride + j, to = i * static_cast<std::size_t>(grid_.stride) + j;
      starts_[to] = {nodes.start[0][from], nodes.start[1][from], nodes.start[2][from], 0.0f};
      ends_[to] = {nodes.end[0][from], nodes.end[1][from], nodes.end[2][from], 0.0f};
    }
  }
}

void SelfCandidates::collect(const Field3& start, const Field3& end, double reach, Candidates& out) noexcept {
  reach_ = reach;
  setMotion(start, end, expected_);
  collectOf(nullptr, expected_, reach, out);
}

// If no node of a pair deviates by more than half the difference of the reaches, the pair was a candidate already.
void SelfCandidates::collectDeviating(const Field3& start, const Field3& end, double reach, Candidates& out) noexcept {
  if (markDeviating(end, 0.5 * (reach_ - reach)) == 0) return;
  setMotion(start, end, deviating_);
  collectOf(&marked_, deviating_, reach, out);
}

// Marks the nodes that end further than `most` [m] from where collect() expected them; returns their number.
std::size_t SelfCandidates::markDeviating(const Field3& end, double most) noexcept {
  const float certain = static_cast<float>(most) - 2.0f * expected_.rounding;
  const float most_squared = certain > 0.0f ? certain * certain * (1.0f - 1e-5f) : -1.0f;
  std::size_t count = 0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(grid_.rows); ++i) {
    const std::size_t n = i * static_cast<std::size_t>(grid_.stride), m = i * expected_.nodes.stride;
    const Floats3 expected{&expected_.nodes.end[0][m], &expected_.nodes.end[1][m], &expected_.nodes.end[2][m]};
    count +=
        markRow({end, n}, expected, expected_.end, most_squared, static_cast<std::size_t>(grid_.columns), &marked_[n]);
  }
  return count;
}

void SelfCandidates::collectOf(const std::vector<std::uint8_t>* marked, const Motion& motion, double reach,
                               Candidates& out) noexcept {
  const float certain = static_cast<float>(reach) * (1.0f + 2.0f * std::numeric_limits<float>::epsilon()),
              rounding = motion.rounding;
  hierarchy_.select(marked);
  const bool bent = flat_blocks_.find(certain, rounding);
  if (!bent && !pairs_.any(certain + rounding, flat_level_)) return;
  hierarchy_.refitBelow(flat_level_, motion.nodes);
  hierarchy_.interleaveBoxes();
  if (bent) {
    hierarchy_.excludeFlat(flat_level_, [this](int i, int j) { return flat_blocks_.isBent(i, j); });
    windows_.find(motion.nodes, hierarchy_, certain, rounding);
  }
  interleaveNodes(motion.nodes);
  const Query query{certain, rounding, bent, &out};
  const auto collect_one = [&](int s) { collectShare(query, s, shares_[static_cast<std::size_t>(s)]); };
  const int count = static_cast<int>(shares_.size());
  if (workers_ != nullptr)
    workers_->run(count, collect_one);
  else
    for (int s = 0; s < count; ++s) collect_one(s);
  for (Share& share : shares_) flush(query, share);
}

void SelfCandidates::collectShare(const Query& query, int index, Share& share) const noexcept {
  const float around = query.reach + query.rounding;
  if (query.bent) {
    windows_.forEachPair(
        swept(), around, static_cast<std::size_t>(index), shares_.size(),
        [&](const FourNodes& nodes) { add(query, nodes, share.vertices, share); },
        [&](const FourNodes& nodes) { add(query, nodes, share.edges, share); });
  }
  pairs_.find(around, query.bent ? 0 : flat_level_, {index, static_cast<int>(shares_.size())},
              [&](std::size_t a, std::size_t b) {
                if (share.quads.size() == share.quads.capacity()) addElements(query, share);
                share.quads.push_back({static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b)});
              });
  addElements(query, share);
  discardSeparated(query, share.vertices);
  discardSeparated(query, share.edges);
}

// Keeps the pairs of quads that the test does not separate.
void SelfCandidates::keepUnseparatedQuads(decltype(&quadsSeparated) separated, const Query& query,
                                          std::vector<QuadPair>& quads) const noexcept {
  const BoxHierarchy::Level& level = hierarchy_.levels().front();
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
    const std::uint32_t apart = separated(some, swept(), query.reach, query.rounding);
    for (std::size_t k = 0; k < count; ++k) {
      if ((apart >> k & 1U) == 0) quads[kept++] = quads[first + k];
    }
  }
  quads.resize(kept);
}

// Tests the collected quads and adds the element pairs of those that remain.
void SelfCandidates::addElements(const Query& query, Share& share) const noexcept {
  keepUnseparatedQuads(quadsSeparated, query, share.quads);
  keepUnseparatedQuads(quadsSeparatedByGilbert, query, share.quads);
  const BoxHierarchy::Level& level = hierarchy_.levels().front();
  for (const QuadPair& pair : share.quads) {
    elements_.forEach(
        level.rowOf(pair.a), level.columnOf(pair.a), level.rowOf(pair.b), level.columnOf(pair.b),
        [&](const FourNodes& nodes) { add(query, nodes, share.vertices, share); },
        [&](const FourNodes& nodes) { add(query, nodes, share.edges, share); });
  }
  share.quads.clear();
}

// A full share tests what it has; if that makes no room, it is flushed to the output. Other workers may flush at the
// same time.
void SelfCandidates::makeRoom(const Query& query, Pairs& pairs, Share& share) const noexcept {
  discardSeparated(query, pairs);
  if (!pairs.isFull()) return;
  discardSeparated(query, share.vertices);
  discardSeparated(query, share.edges);
  const std::lock_guard<std::mutex> alone(making_room_);
  flush(query, share);
}

// Moves the tested pairs to the output.
void SelfCandidates::flush(const Query& query, Share& share) noexcept {
  for (const FourNodes& n : share.vertices.nodes) query.out->add(VertexTriangle{n[0], {n[1], n[2], n[3]}});
  for (const FourNodes& n : share.edges.nodes) query.out->add(EdgeEdge{{n[0], n[1]}, {n[2], n[3]}});
  share.clear();
}

// Tests the pairs from `near` on and keeps those that are not separated.
void SelfCandidates::discardSeparated(const Query& query, Pairs& pairs) const noexcept {
  std::vector<FourNodes>& nodes = pairs.nodes;
  for (std::size_t first = pairs.near; first < nodes.size(); first += kPairsAtOnce) {
    const std::size_t count = std::min(kPairsAtOnce, nodes.size() - first);
    std::array<FourNodes, kPairsAtOnce> some;
    for (std::size_t k = 0; k < kPairsAtOnce; ++k) some[k] = nodes[first + std::min(k, count - 1)];
    const std::uint32_t apart = pairs.separated(some, swept(), query.reach, query.rounding);
    for (std::size_t k = 0; k < count; ++k) {
      if ((apart >> k & 1U) == 0) nodes[pairs.near++] = some[k];
    }
  }
  nodes.resize(pairs.near);
}

}  // namespace curtain
