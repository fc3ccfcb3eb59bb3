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
// What is nearer than the gap at the start of a substep is let out slowly, and not at all within this share of the gap: a
// contact at rest must not be shaken by what the solve left over.
constexpr double kSlack = 0.1;

Vec3 mix(const std::array<double, 4>& weight, const std::array<Vec3, 4>& at) {
  return weight[0] * at[0] + weight[1] * at[1] + weight[2] * at[2] + weight[3] * at[3];
}

// Whether the boxes around the ways of two elements are further apart than reach.
bool boxesApart(bool edges, const std::array<Vec3, 4>& from, const std::array<Vec3, 4>& to, double reach) {
  Vec3 low_a = from[0].cwiseMin(to[0]), high_a = from[0].cwiseMax(to[0]);
  Vec3 low_b = from[3].cwiseMin(to[3]), high_b = from[3].cwiseMax(to[3]);
  const auto extend = [&](std::size_t k, Vec3& low, Vec3& high) {
    low = low.cwiseMin(from[k]).cwiseMin(to[k]);
    high = high.cwiseMax(from[k]).cwiseMax(to[k]);
  };
  extend(2, low_b, high_b);
  if (edges) extend(1, low_a, high_a);
  else extend(1, low_b, high_b);
  return (low_a - high_b).cwiseMax(low_b - high_a).maxCoeff() > reach;
}

// By how much two elements may come nearer on the way: no more than the two nodes that approach most.
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
  // From differences, whose rounding is that of near things: the weights add up to 0.
  out.apart = out.weight[1] * (at[1] - at[0]) + out.weight[2] * (at[2] - at[0]) + out.weight[3] * (at[3] - at[0]);
  out.distance = out.apart.norm();
  return out;
}

SelfContacts::SelfContacts(const ClothPattern& pattern, double gap, const ContactParams& params)
    : gap_(gap), friction_(params.friction), recovery_speed_(params.recovery_speed) {
  near_.reserve(8 * pattern.grid.nodeCount());
  table_.clear(8 * pattern.grid.nodeCount());
  pushed_.reserve(4 * pattern.grid.nodeCount());
}

void SelfContacts::renew(const Candidates& candidates, Contacts& contacts) noexcept {
  pushed_.clear();
  for (const NearPair& pair : near_) {
    if (pair.push > 0.0) pushed_.push_back(pair);
  }
  table_.clear(pushed_.size() + contacts.size());
  for (std::uint32_t n = 0; n < pushed_.size(); ++n) table_.insert(pushed_[n].key, n);
  near_.clear();
  for (const VertexTriangle& c : candidates.vertex_triangles) {
    near_.push_back({{{c.vertex, c.triangle[0], c.triangle[1], c.triangle[2]}, false}});
  }
  for (const EdgeEdge& c : candidates.edge_edges) {
    near_.push_back({{{c.first[0], c.first[1], c.second[0], c.second[1]}, true}});
  }
  if (!pushed_.empty()) {
    for (NearPair& pair : near_) {
      const std::uint32_t old = table_.find(pair.key);
      if (old == PairTable::kNone) continue;
      pair.push = pushed_[old].push;
      pair.slide = pushed_[old].slide;
    }
  }
  table_.clear(contacts.size());
  for (std::uint32_t n = 0; n < contacts.size(); ++n) {
    Contact& contact = contacts[n];
    if (contact.obstacle != Contact::kCloth) continue;
    contact.source = kNoPair;
    table_.insert({contact.node, contact.weight[1] > 0.0}, n);
  }
  for (std::uint32_t n = 0; n < near_.size() && !contacts.empty(); ++n) {
    const std::uint32_t contact = table_.find(near_[n].key);
    if (contact != PairTable::kNone) contacts[contact].source = n;
  }
}

double SelfContacts::offsetAt(double distance, double h) const noexcept {
  if (distance >= gap_) return gap_;
  const double kept = (1.0 - kSlack) * gap_;
  return distance >= kept ? distance : std::min(kept, distance + recovery_speed_ * h);
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
    const std::array<Vec3, 4> from = corners(pair, start), to = corners(pair, predicted);
    if (pair.push == 0.0 && boxesApart(pair.key.edges, from, to, gap_)) continue;
    const ClosestPoints closest = closestPoints(pair.key.edges, from);
    // Where two edges are closest at an end of one, the vertex there and the faces at the other one are a pair as well.
    if (!closest.inside || closest.distance <= 0.0) continue;
    const double then = closest.apart.dot(mix(closest.weight, to)) / closest.distance;
    if (then >= gap_ && pair.push == 0.0) continue;
    Contact contact = makeContact(pair, n, closest);
    contact.offset = offsetAt(closest.distance, h);
    contact.push = pair.push;
    contact.slide = pair.slide;
    contacts.push_back(contact);
  }
}

// The time of impact, beyond 1 when there is none; distance: at the start.
double SelfContacts::crossesAt(const NearPair& pair, const std::array<Vec3, 4>& from, const std::array<Vec3, 4>& to,
                               double& distance) const noexcept {
  constexpr double kNever = 2.0;
  if (boxesApart(pair.key.edges, from, to, kLeastShare * gap_)) return kNever;
  distance = closestPoints(pair.key.edges, from).distance;
  const double least = std::min(kLeastShare * gap_, 0.5 * distance);
  if (distance - largestApproach(pair.key.edges, from, to) > least) return kNever;
  const std::optional<double> time =
      pair.key.edges
          ? edgeEdgeTimeOfImpact(from[0], from[1], from[2], from[3], to[0], to[1], to[2], to[3], least)
          : vertexTriangleTimeOfImpact(from[0], from[1], from[2], from[3], to[0], to[1], to[2], to[3], least);
  return time.value_or(kNever);
}

int SelfContacts::verify(const Field3& start, const Field3& end, double h, Contacts& contacts) noexcept {
  int added = 0;
  for (std::uint32_t n = 0; n < near_.size(); ++n) {
    const NearPair& pair = near_[n];
    const std::array<Vec3, 4> from = corners(pair, start), to = corners(pair, end);
    double distance = 0.0;
    const double time = crossesAt(pair, from, to, distance);
    if (time > 1.0) continue;
    ++added;
    // Held along the way between them where they meet.
    std::array<Vec3, 4> there = from;
    for (std::size_t k = 0; k < 4; ++k) there[k] += time * (to[k] - from[k]);
    ClosestPoints closest = closestPoints(pair.key.edges, there);
    if (!(closest.distance > 0.0)) closest = closestPoints(pair.key.edges, from);
    if (!(closest.distance > 0.0)) continue;
    Contact contact = makeContact(pair, n, closest);
    contact.carried = mix(closest.weight, from);
    contact.offset = offsetAt(distance, h);
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
