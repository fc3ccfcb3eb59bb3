// SPDX-License-Identifier: BSD-3-Clause
#include "contact/response/self_contacts.h"

#include <algorithm>
#include <cmath>

#include "contact/narrow_phase/closest_points.h"
#include "contact/response/element_contacts.h"
#include "curtain_sim/ccd.h"

namespace curtain {
namespace {

// Capacity for touching or crossing pairs, per node.
constexpr std::size_t kSelfPairsPerNode = 8;

Vec3 mix(const std::array<double, 4>& weight, const std::array<Vec3, 4>& at) {
  return weight[0] * at[0] + weight[1] * at[1] + weight[2] * at[2] + weight[3] * at[3];
}

// Whether the swept boxes of two elements are further apart than reach.
bool boxesApart(bool edges, const std::array<Vec3, 4>& from, const std::array<Vec3, 4>& to, double reach) {
  Vec3 low_a = from[0].cwiseMin(to[0]), high_a = from[0].cwiseMax(to[0]);
  Vec3 low_b = from[3].cwiseMin(to[3]), high_b = from[3].cwiseMax(to[3]);
  const auto extend = [&](std::size_t k, Vec3& low, Vec3& high) {
    low = low.cwiseMin(from[k]).cwiseMin(to[k]);
    high = high.cwiseMax(from[k]).cwiseMax(to[k]);
  };
  extend(2, low_b, high_b);
  if (edges)
    extend(1, low_a, high_a);
  else
    extend(1, low_b, high_b);
  return (low_a - high_b).cwiseMax(low_b - high_a).maxCoeff() > reach;
}

// Bound of how much two elements approach: as much as the two nodes that approach most.
double largestApproach(bool edges, const std::array<Vec3, 4>& from, const std::array<Vec3, 4>& to) {
  std::array<Vec3, 4> move;
  for (std::size_t k = 0; k < 4; ++k) move[k] = to[k] - from[k];
  const std::size_t split = edges ? 2 : 1;
  double worst = 0.0;
  for (std::size_t k = 0; k < split; ++k) {
    for (std::size_t l = split; l < 4; ++l) worst = std::max(worst, (move[k] - move[l]).squaredNorm());
  }
  return std::sqrt(worst);
}

}  // namespace

ClosestPoints closestPoints(bool edges, const std::array<Vec3, 4>& at) noexcept {
  ClosestPoints out;
  if (edges) {
    const SegmentsClosest found = closestOnSegments(at[0], at[1], at[2], at[3]);
    out.weight = {1.0 - found.s, found.s, found.t - 1.0, -found.t};
    out.inside = found.s > 0.0 && found.s < 1.0 && found.t > 0.0 && found.t < 1.0;
  } else {
    const TriangleClosest found = closestOnTriangle(at[0], at[1], at[2], at[3]);
    out.weight = {1.0, -found.weights[0], -found.weights[1], -found.weights[2]};
    out.inside = true;
  }
  // From differences, to avoid cancellation: the weights add up to 0.
  out.apart = out.weight[1] * (at[1] - at[0]) + out.weight[2] * (at[2] - at[0]) + out.weight[3] * (at[3] - at[0]);
  out.distance = out.apart.norm();
  return out;
}

SelfContacts::SelfContacts(const ClothPattern& pattern, double gap, const ContactParams& params)
    : gap_(gap), friction_(params.friction), recovery_speed_(params.recovery_speed) {
  pairs_.reserve(kSelfPairsPerNode * pattern.grid.nodeCount());
  closest_.reserve(kSelfPairsPerNode * pattern.grid.nodeCount());
}

double SelfContacts::offsetAt(double distance, double h) const noexcept {
  return recoveredDistance(distance, gap_, std::min(recovery_speed_ * h, max_recovery_));
}

Contact SelfContacts::makeContact(const PairKey& key, const ClosestPoints& closest) const noexcept {
  Contact contact;
  contact.nodes = 4;
  contact.node = key.node;
  contact.weight = closest.weight;
  contact.normal = contact.level = closest.apart / closest.distance;
  contact.anchor = closest.apart;
  contact.friction = friction_;
  contact.source = key.edges ? 1 : 0;
  return contact;
}

// Collects the wanted pairs. sortPairs() follows: the order of candidates depends on the number of threads. So where
// there is no room for all, the last in the order of keys are dropped, not the last that come.
template <typename Wanted>
void SelfContacts::select(const Candidates& candidates, const Wanted& wanted) noexcept {
  pairs_.clear();
  bool heap = false;
  const auto visit = [&](const PairKey& key) {
    if (!wanted(key) || addWithinRoom(key, pairs_)) return;
    if (!heap) std::make_heap(pairs_.begin(), pairs_.end());
    heap = full_ = true;
    if (!(key < pairs_.front())) return;
    std::pop_heap(pairs_.begin(), pairs_.end());
    pairs_.back() = key;
    std::push_heap(pairs_.begin(), pairs_.end());
  };
  for (const VertexTriangle& c : candidates.vertex_triangles)
    visit({{c.vertex, c.triangle[0], c.triangle[1], c.triangle[2]}, false});
  for (const EdgeEdge& c : candidates.edge_edges) visit({{c.first[0], c.first[1], c.second[0], c.second[1]}, true});
}

void SelfContacts::sortPairs() noexcept {
  std::sort(pairs_.begin(), pairs_.end());
  pairs_.erase(std::unique(pairs_.begin(), pairs_.end()), pairs_.end());
}

// Tested at the start and at the end with exact distances, so that the contacts do not depend on which pairs beyond
// the gap the broad phase happens to name.
bool SelfContacts::touches(const PairKey& key, const Field3& start, const Field3& predicted) const noexcept {
  const std::array<Vec3, 4> from = corners(key, start), to = corners(key, predicted);
  if (boxesApart(key.edges, from, to, gap_)) return false;
  const ClosestPoints closest = closestPoints(key.edges, from);
  // If two edges are closest at an end, a vertex-face pair covers it.
  if (!closest.inside || closest.distance <= 0.0) return false;
  if (closest.apart.dot(mix(closest.weight, to)) >= gap_ * closest.distance) return false;
  return closest.distance <= gap_ || closestPoints(key.edges, to).distance <= gap_;
}

// If a vertex is closest to the border of a triangle and the neighbour triangle there is as near, that one's contact
// suffices: contacts belong to minima of the distance to the surface. Of equal distances the first one stays.
bool SelfContacts::isRedundant(std::size_t k) const noexcept {
  const PairKey& key = pairs_[k];
  const ClosestPoints& closest = closest_[k];
  const auto isOnBorder = [&](std::size_t n) { return closest.weight[n] != 0.0; };
  if (key.edges || (isOnBorder(1) && isOnBorder(2) && isOnBorder(3))) return false;
  const auto tells = [&](std::size_t other) {
    const PairKey& its = pairs_[other];
    const double distance = closest_[other].distance;
    if (its.edges || !(distance > 0.0)) return false;
    if (distance > closest.distance || (distance == closest.distance && other > k)) return false;
    for (std::size_t n = 1; n < 4; ++n) {
      if (isOnBorder(n) && std::find(its.node.begin() + 1, its.node.end(), key.node[n]) == its.node.end()) return false;
    }
    return true;
  };
  // Pairs of one vertex are adjacent.
  for (std::size_t other = k; other-- > 0 && pairs_[other].node[0] == key.node[0];) {
    if (tells(other)) return true;
  }
  for (std::size_t other = k + 1; other < pairs_.size() && pairs_[other].node[0] == key.node[0]; ++other) {
    if (tells(other)) return true;
  }
  return false;
}

void SelfContacts::collect(const Candidates& candidates, const Contacts& last, const Field3& start,
                           const Field3& predicted, double h, Contacts& contacts) noexcept {
  full_ = false;
  select(candidates, [&](const PairKey& key) { return touches(key, start, predicted); });
  for (const Contact& contact : last) {
    if (contact.obstacle == Contact::kCloth) addWithinRoom(PairKey{contact.node, contact.source == 1}, pairs_);
  }
  sortPairs();
  closest_.clear();
  for (const PairKey& key : pairs_) closest_.push_back(closestPoints(key.edges, corners(key, start)));
  for (std::size_t k = 0; k < pairs_.size(); ++k) {
    const PairKey& key = pairs_[k];
    const ClosestPoints& closest = closest_[k];
    if (!closest.inside || closest.distance <= 0.0 || isRedundant(k)) continue;
    Contact contact = makeContact(key, closest);
    contact.offset = offsetAt(closest.distance, h);
    contact.recovery = std::max(0.0, contact.offset - closest.distance);
    addWithinRoom(contact, contacts);
  }
}

// Time of impact, beyond 1 if there is none; distance: at the start [m].
double SelfContacts::crossesAt(const PairKey& key, const std::array<Vec3, 4>& from, const std::array<Vec3, 4>& to,
                               double& distance) const noexcept {
  constexpr double kNever = 2.0;
  if (boxesApart(key.edges, from, to, kMinShare * gap_)) return kNever;
  distance = closestPoints(key.edges, from).distance;
  const double least = std::min(kMinShare * gap_, 0.5 * distance);
  if (distance - largestApproach(key.edges, from, to) > least) return kNever;
  const std::optional<double> time =
      key.edges ? edgeEdgeTimeOfImpact(from[0], from[1], from[2], from[3], to[0], to[1], to[2], to[3], least)
                : vertexTriangleTimeOfImpact(from[0], from[1], from[2], from[3], to[0], to[1], to[2], to[3], least);
  return time.value_or(kNever);
}

void SelfContacts::findCrossings(const Candidates& candidates, const Field3& start, const Field3& end) noexcept {
  full_ = candidates.full;
  select(candidates, [&](const PairKey& key) {
    double distance = 0.0;
    return crossesAt(key, corners(key, start), corners(key, end), distance) <= 1.0;
  });
  sortPairs();
}

int SelfContacts::verify(const Candidates& candidates, const Field3& start, const Field3& end, double h,
                         Contacts& contacts) noexcept {
  findCrossings(candidates, start, end);
  for (const PairKey& key : pairs_) {
    const std::array<Vec3, 4> from = corners(key, start), to = corners(key, end);
    double distance = 0.0;
    const double time = crossesAt(key, from, to, distance);
    // The normal is the direction between them at the time of impact.
    std::array<Vec3, 4> there = from;
    for (std::size_t k = 0; k < 4; ++k) there[k] += time * (to[k] - from[k]);
    ClosestPoints closest = closestPoints(key.edges, there);
    if (!(closest.distance > 0.0)) closest = closestPoints(key.edges, from);
    if (!(closest.distance > 0.0)) continue;
    Contact contact = makeContact(key, closest);
    contact.anchor = mix(closest.weight, from);
    contact.offset = offsetAt(distance, h);
    contact.recovery = std::max(0.0, contact.offset - distance);
    addWithinRoom(contact, contacts);
  }
  return static_cast<int>(pairs_.size());
}

}  // namespace curtain
