// SPDX-License-Identifier: BSD-3-Clause
#include "contact/self_contacts.h"

#include <algorithm>
#include <cmath>

#include "contact/closest_points.h"
#include "curtain_sim/ccd.h"

namespace curtain {
namespace {

// Never nearer than this share of the gap, on the whole way.
constexpr double kLeastShare = 0.02;
// What is nearer than the gap at the start of a substep is let out at this speed [m/s], and not at all within this share of
// the gap: a contact at rest must not be shaken by what the solve left over.
constexpr double kGapRecoverySpeed = 0.1;
constexpr double kSlack = 0.1;

std::array<Vec3, 4> corners(const NearPair& pair, const Field3& position) {
  return {position.at(pair.key.node[0]), position.at(pair.key.node[1]), position.at(pair.key.node[2]), position.at(pair.key.node[3])};
}

Vec3 mix(const std::array<double, 4>& weight, const NearPair& pair, const Field3& value) {
  return weight[0] * value.at(pair.key.node[0]) + weight[1] * value.at(pair.key.node[1]) + weight[2] * value.at(pair.key.node[2]) +
         weight[3] * value.at(pair.key.node[3]);
}

// By how much two elements may come nearer when their nodes move from a to b: no more than the two nodes that approach most.
double largestApproach(const NearPair& pair, const Field3& a, const Field3& b) {
  std::array<Vec3, 4> move;
  for (std::size_t k = 0; k < 4; ++k) move[k] = b.at(pair.key.node[k]) - a.at(pair.key.node[k]);
  const std::size_t split = pair.key.edges ? 2 : 1;
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
  // From differences, whose rounding is that of near things: the weights add up to 0.
  out.apart = out.weight[1] * (at[1] - at[0]) + out.weight[2] * (at[2] - at[0]) + out.weight[3] * (at[3] - at[0]);
  out.distance = out.apart.norm();
  return out;
}

SelfContacts::SelfContacts(const ClothPattern& pattern, double gap, double friction)
    : pattern_(pattern), gap_(gap), friction_(friction) {
  near_.reserve(8 * pattern.grid.nodeCount());
  pushed_.reserve(4 * pattern.grid.nodeCount());
}

void SelfContacts::renew(const Candidates& candidates, const Field3& start, const Field3& end, double slack) noexcept {
  pushed_.clear();
  for (const NearPair& pair : near_) {
    if (pair.push > 0.0) pushed_.push_back(pair);
  }
  table_.clear(pushed_.size());
  for (std::uint32_t n = 0; n < pushed_.size(); ++n) table_.insert(pushed_[n].key, n);
  near_.clear();
  const auto take = [&](const PairKey& key) {
    NearPair pair{key};
    const double nearest = closestPoints(key.edges, corners(pair, start)).distance - largestApproach(pair, start, end);
    if (nearest > gap_ + 2.0 * slack) return;
    const std::uint32_t old = table_.find(key);
    if (old != PairTable::kNone) {
      pair.push = pushed_[old].push;
      pair.slide = pushed_[old].slide;
    }
    near_.push_back(pair);
  };
  for (const VertexTriangle& c : candidates.vertex_triangles) {
    take({{c.vertex, c.triangle[0], c.triangle[1], c.triangle[2]}, false});
  }
  for (const EdgeEdge& c : candidates.edge_edges) take({{c.first[0], c.first[1], c.second[0], c.second[1]}, true});
}

void SelfContacts::carryOver(const Field3& start, Contacts& contacts) noexcept {
  table_.clear(contacts.size());
  for (std::uint32_t n = 0; n < contacts.size(); ++n) {
    Contact& contact = contacts[n];
    if (contact.obstacle != Contact::kCloth) continue;
    contact.source = kNoPair;
    table_.insert({contact.node, contact.weight[1] > 0.0}, n);
  }
  for (std::uint32_t n = 0; n < near_.size(); ++n) {
    near_[n].distance = closestPoints(near_[n].key.edges, corners(near_[n], start)).distance;
    const std::uint32_t contact = table_.find(near_[n].key);
    if (contact != PairTable::kNone) contacts[contact].source = n;
  }
}

double SelfContacts::offsetAt(double distance, double h) const noexcept {
  if (distance >= gap_) return gap_;
  const double kept = (1.0 - kSlack) * gap_;
  return distance >= kept ? distance : std::min(kept, distance + kGapRecoverySpeed * h);
}

Contact SelfContacts::makeContact(const NearPair& pair, std::uint32_t source, const ClosestPoints& closest) const noexcept {
  Contact contact;
  contact.nodes = 4;
  contact.node = pair.key.node;
  contact.weight = closest.weight;
  contact.normal = closest.apart / closest.distance;
  contact.carried = closest.apart;
  contact.friction = friction_;
  contact.source = source;
  return contact;
}

void SelfContacts::collect(const Field3& start, const Field3& predicted, double h, Contacts& contacts) noexcept {
  for (std::uint32_t n = 0; n < near_.size(); ++n) {
    NearPair& pair = near_[n];
    const ClosestPoints closest = closestPoints(pair.key.edges, corners(pair, start));
    pair.distance = closest.distance;
    // Where two edges are closest at an end of one, the vertex there and the faces at the other one are a pair as well.
    if (!closest.inside || closest.distance <= 0.0) continue;
    const double then = closest.apart.dot(mix(closest.weight, pair, predicted)) / closest.distance;
    if (then >= gap_ && pair.push == 0.0) continue;
    Contact contact = makeContact(pair, n, closest);
    contact.offset = offsetAt(closest.distance, h);
    contact.push = pair.push;
    contact.slide = pair.slide;
    contacts.push_back(contact);
  }
}

// The time of impact, beyond 1 when there is none.
double SelfContacts::crossesAt(const NearPair& pair, const Field3& start, const Field3& end) const noexcept {
  const double least = std::min(kLeastShare * gap_, 0.5 * pair.distance);
  if (pair.distance - largestApproach(pair, start, end) > least) return 2.0;
  const std::array<Vec3, 4> a = corners(pair, start), b = corners(pair, end);
  const std::optional<double> time =
      pair.key.edges ? edgeEdgeTimeOfImpact(a[0], a[1], a[2], a[3], b[0], b[1], b[2], b[3], least)
                 : vertexTriangleTimeOfImpact(a[0], a[1], a[2], a[3], b[0], b[1], b[2], b[3], least);
  return time.value_or(2.0);
}

int SelfContacts::verify(const Field3& start, const Field3& end, double h, Contacts& contacts) noexcept {
  int added = 0;
  for (std::uint32_t n = 0; n < near_.size(); ++n) {
    const NearPair& pair = near_[n];
    const double time = crossesAt(pair, start, end);
    if (time > 1.0) continue;
    ++added;
    // Held along the way between them where they meet.
    std::array<Vec3, 4> at = corners(pair, start);
    const std::array<Vec3, 4> to = corners(pair, end);
    for (std::size_t k = 0; k < 4; ++k) at[k] += time * (to[k] - at[k]);
    ClosestPoints closest = closestPoints(pair.key.edges, at);
    if (!(closest.distance > 0.0)) closest = closestPoints(pair.key.edges, corners(pair, start));
    if (!(closest.distance > 0.0)) continue;
    Contact contact = makeContact(pair, n, closest);
    contact.carried = mix(closest.weight, pair, start);
    contact.offset = offsetAt(pair.distance, h);
    contacts.push_back(contact);
  }
  return added;
}

void SelfContacts::remember(const Contacts& contacts) noexcept {
  for (NearPair& pair : near_) {
    pair.push = 0.0;
    pair.slide = Vec3::Zero();
  }
  for (const Contact& contact : contacts) {
    if (contact.obstacle != Contact::kCloth || contact.source == kNoPair) continue;
    near_[contact.source].push = contact.push;
    near_[contact.source].slide = contact.slide;
  }
}

}  // namespace curtain
