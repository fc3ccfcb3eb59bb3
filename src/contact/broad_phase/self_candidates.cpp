// SPDX-License-Identifier: BSD-3-Clause
#include "contact/broad_phase/self_candidates.h"

#include <algorithm>
#include <limits>

namespace curtain {
namespace {

// Pairs of quads that are tested together, and found pairs of elements that a worker keeps to itself.
constexpr std::size_t kQuadsAtOnce = 1024, kFoundAtOnce = 1024;
// Gilbert's steps: few for all pairs of quads, more for the rest. Still more separate hardly any.
constexpr int kFirstSteps = 2, kSteps = 4;
// Room for the element pairs of a cluster.
constexpr std::size_t kMaxLocalPairs = 128;

// Elements of a quad, by new numbers of its nodes.
template <typename NumberOf>
QuadElements renumbered(QuadElements quad, const NumberOf& number_of) {
  const auto renumber = [&](auto& nodes) { std::transform(nodes.begin(), nodes.end(), nodes.begin(), number_of); };
  renumber(quad.corners);
  renumber(quad.vertices);
  for (MeshTriangle& triangle : quad.triangles) renumber(triangle);
  for (MeshEdge& edge : quad.edges) renumber(edge);
  return quad;
}

}  // namespace

SelfCandidates::SelfCandidates(const ClothPattern& pattern, const Workers* workers)
    : nodes_(pattern.grid),
      grid_(nodes_.grid()),
      in_field_(grid_.row(grid_.rows), 0),
      immovable_(in_field_.size(), 0),
      per_spacing_(pattern),
      flat_(grid_, per_spacing_),
      high_(std::min(2, grid_.rows - 1)),
      wide_(std::min(2, grid_.linkCount())),
      gaps_(grid_, wide_),
      patches_(grid_, gaps_),
      workers_(workers),
      shares_(workers == nullptr ? 1 : static_cast<std::size_t>(workers->shares())) {
  for (int i = 0; i < grid_.rows; ++i) {
    for (int j = 0; j < grid_.stride; ++j)
      in_field_[grid_.index(i, j)] = static_cast<std::uint32_t>(pattern.grid.index(i, j % grid_.columns));
  }
  pinsChanged(pattern);
  makeKinds();
  for (Share& share : shares_) {
    share.quads.reserve(kQuadsAtOnce);
    share.near.reserve(kFoundAtOnce);
    share.count.fill(0);
    for (std::size_t kind = 0; kind < kKinds; ++kind) share.clusters[kind].size = kind < kWhere ? 9 : 8;
  }
}

void SelfCandidates::pinsChanged(const ClothPattern& pattern) noexcept {
  for (std::size_t n = 0; n < immovable_.size(); ++n) immovable_[n] = pattern.inverse_mass[in_field_[n]] == 0.0 ? 1 : 0;
}

// Nodes of a window are numbered row by row, three a row, those of two quads one after the other.
void SelfCandidates::makeKinds() {
  const auto adderTo = [](std::vector<LocalPair>& pairs) {
    return [&pairs](const std::array<std::uint32_t, 4>& n) {
      const auto number = [&](std::size_t k) { return static_cast<std::uint8_t>(n[k]); };
      pairs.push_back({number(0), number(1), number(2), number(3)});
    };
  };
  const auto quadOf = [](std::size_t where, int high, int wide, int row, int column, std::uint32_t a_row,
                         std::uint32_t first) {
    const Grid grid(high + (where < 2 ? 2 : 1), wide + (where % 2 == 0 ? 2 : 1), false);
    const auto stride = static_cast<std::uint32_t>(grid.stride);
    return renumbered(quadElements(grid, row, column),
                      [&](std::uint32_t n) { return first + n / stride * a_row + n % stride; });
  };
  for (std::size_t where = 0; where < kWhere; ++where) {
    Kind& kind = kinds_[where];
    for (int p = 0; p < high_ * wide_; ++p) {
      for (int q = p; q < high_ * wide_; ++q) {
        // Pairs of quads shared by several windows belong to the first one.
        if ((p / wide_ > 0 && where < 2) || (std::min(p % wide_, q % wide_) > 0 && where % 2 == 0)) continue;
        forEachElementPair(quadOf(where, high_, wide_, p / wide_, p % wide_, 3, 0),
                           quadOf(where, high_, wide_, q / wide_, q % wide_, 3, 0), adderTo(kind.vertices),
                           adderTo(kind.edges));
      }
    }
  }
  for (std::size_t one = 0; one < kWhere; ++one) {
    for (std::size_t other = 0; other < kWhere; ++other) {
      Kind& kind = kinds_[kWhere + one * kWhere + other];
      forEachElementPair(quadOf(one, 1, 1, 0, 0, 2, 0), quadOf(other, 1, 1, 0, 0, 2, 4), adderTo(kind.vertices),
                         adderTo(kind.edges));
    }
  }
}

// Of a window of quads.
std::size_t SelfCandidates::whereIs(int row, int column, int high, int wide) const noexcept {
  const bool last = !grid_.closed && (column + wide + 1 == grid_.columns || gaps_.at(column + wide));
  return (row + high + 1 == grid_.rows ? 2U : 0U) + (last ? 1U : 0U);
}

void SelfCandidates::collect(const Field3& start, const Field3& end, double reach, Candidates& out) noexcept {
  nodes_.set(start, end);
  reach_ = reach;
  collectOf(reach, 0.0, out);
}

// What ends so that no two nodes of it are further from where they were expected, seen from each other, than the
// difference of the reaches, was a candidate already.
void SelfCandidates::collectDeviating(const Field3& end, double reach, Candidates& out) noexcept {
  nodes_.setEnd(end);
  if (patches_.measureDeviations(nodes_) >= reach_ - reach) collectOf(reach, reach_ - reach, out);
}

void SelfCandidates::collectOf(double reach, double deviation, Candidates& out) noexcept {
  for (int row = 0; row < flat_.rows(); ++row) flat_.measureRow(nodes_, row);
  nodes_.setLargest(flat_.largest());
  patches_.sort(flat_);
  const float certain = static_cast<float>(reach) * (1.0f + 2.0f * std::numeric_limits<float>::epsilon());
  const Query query{
      {nodes_.nodes().data(), certain, nodes_.rounding()}, static_cast<float>(deviation) * (1.0f - 1e-6f), &out};
  if (flat_.find(certain, nodes_.rounding()) && onlyNeighboursMeet(query)) return;
  nodes_.interleave();
  forEachBlock(flat_.rows(), [&](int row) { patches_.fitRow(nodes_, row); });
  forEachBlock(static_cast<int>(shares_.size()), [&](int share) {
    collectShare(query, static_cast<std::size_t>(share), shares_[static_cast<std::size_t>(share)]);
  });
  for (Share& share : shares_) flush(query, share);
  if (!out.full) return;  // else which were dropped depends on the number of threads
  out.vertex_triangles.clear();
  out.edge_edges.clear();
}

// Patches meet themselves and their neighbours, whose boxes have nodes in common: does none meet another?
bool SelfCandidates::onlyNeighboursMeet(const Query& query) const noexcept {
  if (gaps_.any()) return false;  // neighbours across a gap need not meet
  const int rows = flat_.rows(), columns = flat_.columns();
  const int across = grid_.closed && columns > 2 ? columns : columns - 1;  // pairs side by side in a row
  int more = rows * (columns + across) + (rows - 1) * (columns + 2 * across);
  patches_.forEachPair(query.motion.reach + query.motion.rounding, 0, 1, [&](int, int) { --more; });
  return more == 0;
}

template <typename Block>
void SelfCandidates::forEachBlock(int count, const Block& block) const {
  if (workers_ != nullptr)
    workers_->run(count, block);
  else
    for (int k = 0; k < count; ++k) block(k);
}

// Whether patches, or windows in them, may hold what was not found last.
bool SelfCandidates::isWanted(const Query& query, int a, int b) const noexcept {
  return query.most == 0.0f || patches_.deviate(a, b, query.most);
}

FlatNodes SelfCandidates::flatNodes(const Query& query, int row, int column) const noexcept {
  const std::size_t node = grid_.index(row, column);
  const auto& start = nodes_.start();
  const auto& end = nodes_.end();
  return {static_cast<std::size_t>(grid_.stride),
          {{&start[0][node], &start[1][node], &start[2][node]}, {&end[0][node], &end[1][node], &end[2][node]}},
          &per_spacing_.u[static_cast<std::size_t>(column)],
          &per_spacing_.v[static_cast<std::size_t>(row)],
          query.motion.reach,
          query.motion.rounding};
}

void SelfCandidates::collectShare(const Query& query, std::size_t index, Share& share) const noexcept {
  addWindows(query, index, share);
  const float around = query.motion.reach + query.motion.rounding;
  patches_.forEachPair(around, index, shares_.size(), [&](int a, int b) {
    if (flat_.areFlat(a, b) || !isWanted(query, a, b)) return;
    patches_.forEachQuadPair(a, b, around, [&](std::uint32_t p, std::uint32_t q) {
      if (share.quads.size() == kQuadsAtOnce) testQuads(query, share);
      share.quads.push_back({p, q});
    });
  });
  testQuads(query, share);
  for (std::size_t kind = 0; kind < kKinds; ++kind) testClusters(query, kind, share);
}

// Those that are not proven flat.
void SelfCandidates::addWindows(const Query& query, std::size_t index, Share& share) const noexcept {
  const int rows = grid_.rows - high_, columns = grid_.closed ? grid_.columns : grid_.columns - wide_;
  const auto is_done = [&](int i, int j) {
    const int patch = patches_.patchAt(i, std::min(j, columns - 1));
    return flat_.isFlat(patch) || !isWanted(query, patch, patch);
  };
  for (int i = static_cast<int>(index); i < rows; i += static_cast<int>(shares_.size())) {
    for (int j = 0; j < columns; j += 2 * Patches::kAlong) {
      if (is_done(i, j) && is_done(i, j + Patches::kAlong)) continue;
      const std::uint32_t all = columns - j < 8 ? (1U << (columns - j)) - 1U : 0xFFU;
      for (std::uint32_t bent = ~flatWindows(flatNodes(query, i, j), high_, wide_) & all; bent != 0; bent &= bent - 1) {
        const int column = j + __builtin_ctz(bent);
        if (gaps_.at(column) || gaps_.at(column + wide_ - 1)) continue;
        const auto node_of = [&](std::uint32_t k) {
          const auto n = static_cast<int>(k);
          return static_cast<std::uint32_t>(grid_.index(i + std::min(n / 3, high_), column + std::min(n % 3, wide_)));
        };
        addCluster(query, whereIs(i, column, high_, wide_), node_of, share);
      }
    }
  }
}

void SelfCandidates::testQuads(const Query& query, Share& share) const noexcept {
  keepUnseparated(query, kFirstSteps, share.quads);
  keepUnseparated(query, kSteps, share.quads);
  for (const TwoQuads& pair : share.quads) addQuads(query, pair, share);
  share.quads.clear();
}

void SelfCandidates::keepUnseparated(const Query& query, int steps, std::vector<TwoQuads>& quads) const noexcept {
  std::size_t kept = 0;
  for (std::size_t first = 0; first < quads.size(); first += kPairsAtOnce) {
    const std::size_t count = std::min(kPairsAtOnce, quads.size() - first);
    std::array<TwoQuads, kPairsAtOnce> some;
    for (std::size_t k = 0; k < kPairsAtOnce; ++k) some[k] = quads[first + std::min(k, count - 1)];
    const std::uint32_t apart = quadsSeparated(some, query.motion, static_cast<std::size_t>(grid_.stride), steps);
    for (std::size_t k = 0; k < count; ++k) {
      if ((apart >> k & 1U) == 0) quads[kept++] = some[k];
    }
  }
  quads.resize(kept);
}

void SelfCandidates::addQuads(const Query& query, TwoQuads pair, Share& share) const noexcept {
  const auto stride = static_cast<std::uint32_t>(grid_.stride);
  if (pair.other < pair.one) std::swap(pair.one, pair.other);  // contacts are rounded by which is first
  const auto where = [&](std::uint32_t quad) {
    return whereIs(static_cast<int>(quad / stride), static_cast<int>(quad % stride), 1, 1);
  };
  const std::size_t kind = kWhere + where(pair.one) * kWhere + where(pair.other);
  const auto node_of = [&](std::uint32_t k) { return (k < 4 ? pair.one : pair.other) + k % 2 + k % 4 / 2 * stride; };
  addCluster(query, kind, node_of, share);
}

template <typename NodeOf>
void SelfCandidates::addCluster(const Query& query, std::size_t kind, const NodeOf& node_of,
                                Share& share) const noexcept {
  Clusters& clusters = share.clusters[kind];
  const std::size_t at = share.count[kind]++;
  for (std::size_t k = 0; k < clusters.size; ++k) clusters.nodes[k][at] = node_of(static_cast<std::uint32_t>(k));
  if (at + 1 == kPairsAtOnce) testClusters(query, kind, share);
}

void SelfCandidates::testClusters(const Query& query, std::size_t kind, Share& share) const noexcept {
  Clusters& clusters = share.clusters[kind];
  const std::size_t count = share.count[kind];
  if (count == 0) return;
  for (auto& nodes : clusters.nodes)
    std::fill(nodes.begin() + static_cast<std::ptrdiff_t>(count), nodes.end(), nodes[0]);
  share.count[kind] = 0;
  const auto& [vertices, edges] = kinds_[kind];
  std::array<std::uint8_t, kMaxLocalPairs> near;
  findNear(clusters, query.motion, vertices, edges, near.data());
  for (std::size_t l = 0; l < vertices.size() + edges.size(); ++l) {
    const bool is_edge = l >= vertices.size();
    const LocalPair& pair = is_edge ? edges[l - vertices.size()] : vertices[l];
    for (std::uint32_t bits = near[l] & ((1U << count) - 1U); bits != 0; bits &= bits - 1) {
      const auto k = static_cast<std::size_t>(__builtin_ctz(bits));
      const auto node = [&](std::size_t n) { return clusters.nodes[pair[n]][k]; };
      name(query, is_edge, {node(0), node(1), node(2), node(3)}, share);
    }
  }
}

void SelfCandidates::name(const Query& query, bool edges, const std::array<std::uint32_t, 4>& nodes,
                          Share& share) const noexcept {
  const auto is_immovable = [&](std::uint32_t node) { return immovable_[node] != 0; };
  if (std::all_of(nodes.begin(), nodes.end(), is_immovable) || !isCloth(edges, nodes)) return;
  if (std::max(share.near.vertex_triangles.size(), share.near.edge_edges.size()) == kFoundAtOnce)
    makeRoom(query, share);
  const auto field = [&](std::size_t n) { return in_field_[nodes[n]]; };
  if (edges)
    share.near.add(EdgeEdge{{field(0), field(1)}, {field(2), field(3)}});
  else
    share.near.add(VertexTriangle{field(0), {field(1), field(2), field(3)}});
}

// Whether no slit takes the elements away.
bool SelfCandidates::isCloth(bool edges, const std::array<std::uint32_t, 4>& nodes) const noexcept {
  if (grid_.slit_row.empty()) return true;
  const auto row = [&](std::size_t n) { return static_cast<int>(nodes[n]) / grid_.stride; };
  const auto column = [&](std::size_t n) { return static_cast<int>(nodes[n]) % grid_.stride; };
  // The first node of a triangle is in its quad's upper row, that of a diagonal the quad's upper right one.
  if (!edges) return grid_.hasQuad(row(1), std::max({column(1), column(2), column(3)}) % grid_.columns);
  const auto is_edge = [&](std::size_t n) {
    if (column(n) == column(n + 1)) return true;
    if (row(n) == row(n + 1)) return grid_.hasLink(row(n), column(n + 1) % grid_.columns);
    return grid_.hasQuad(row(n), column(n) % grid_.columns);
  };
  return is_edge(0) && is_edge(2);
}

// Other workers may flush at the same time.
void SelfCandidates::makeRoom(const Query& query, Share& share) const noexcept {
  const std::lock_guard<std::mutex> alone(making_room_);
  flush(query, share);
}

void SelfCandidates::flush(const Query& query, Share& share) noexcept {
  for (const VertexTriangle& pair : share.near.vertex_triangles) query.out->add(pair);
  for (const EdgeEdge& pair : share.near.edge_edges) query.out->add(pair);
  share.near.clear();
}

}  // namespace curtain
