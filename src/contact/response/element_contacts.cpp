// SPDX-License-Identifier: BSD-3-Clause
//
// Faces and edges of the cloth against one obstacle: round shapes by the nearest point of a face; boxes and meshes by
// edges against edges and faces against corners. The normal is the direction between the closest points at the start,
// or at the time of impact for those that come from afar.
#include "contact/response/element_contacts.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "contact/narrow_phase/closest_points.h"
#include "contact/narrow_phase/element_pairs.h"
#include "curtain_sim/ccd.h"
#include "obstacles/convex_shape.h"
#include "scene/infinity.h"

namespace curtain {
namespace {

using Corners = std::array<Vec3, 3>;

// A face's nearest point is its own where it is nearer than its edges' by this share of the core.
constexpr double kNearer = 1e-3;

Corners startOf(const ObstacleCandidates& candidates, const std::array<std::uint32_t, 3>& node) {
  return {candidates.startOf(node[0]), candidates.startOf(node[1]), candidates.startOf(node[2])};
}
Corners endOf(const ObstacleCandidates& candidates, const std::array<std::uint32_t, 3>& node) {
  return {candidates.endOf(node[0]), candidates.endOf(node[1]), candidates.endOf(node[2])};
}
Corners between(const Corners& a, const Corners& b, double share) {
  return {Vec3(a[0] + share * (b[0] - a[0])), Vec3(a[1] + share * (b[1] - a[1])), Vec3(a[2] + share * (b[2] - a[2]))};
}
Vec3 mix(const std::array<double, 3>& weight, const Corners& at) {
  return weight[0] * at[0] + weight[1] * at[1] + weight[2] * at[2];
}
double longestDisplacement(const Corners& a, const Corners& b) {
  return std::sqrt(std::max({(b[0] - a[0]).squaredNorm(), (b[1] - a[1]).squaredNorm(), (b[2] - a[2]).squaredNorm()}));
}

// A node of it starts inside: it may cross anything on the way out, and the node's own contact takes it out.
bool startsInside(const std::array<std::uint32_t, 3>& node, std::size_t nodes, const ObstacleCandidates& candidates) {
  for (std::size_t k = 0; k < nodes; ++k) {
    if (candidates.isInside(node[k])) return true;
  }
  return false;
}

// Key of the feature, for the order of contacts.
std::uint32_t sourceOf(const FeaturePair& pair) { return 2 * pair.feature + (pair.edges ? 1 : 0); }

// A point of an element that was at `at`, after `share` of the substep, when it was `surface` from the obstacle.
ContactPoint contactPoint(const MeshTriangle& node, int nodes, const std::array<double, 3>& weight,
                          const SurfacePoint& surface, const Corners& start, const Corners& at, double share) {
  ContactPoint point;
  point.node = node;
  point.weight = weight;
  point.nodes = nodes;
  point.share = share;
  point.start = mix(weight, start);
  point.touch = mix(weight, at);
  point.normal = surface.normal;
  point.height = point.normal.dot(point.touch) - surface.distance;
  return point;
}

ContactPoint contactPoint(const MeshTriangle& face, const ElementPoint& nearest, const Corners& start,
                          const Corners& at, double share) {
  return contactPoint(face, 3, nearest.weights, nearest.surface, start, at, share);
}

// Closest points of an edge or a face of the cloth and a feature of the mesh.
struct PairPoint {
  std::array<double, 3> weight{};
  Vec3 apart = Vec3::Zero();  // from the feature to the cloth [m]
  double distance = 0.0;
  bool inside = true;  // not at an end of an edge, which other pairs cover
};

// The ends of the feature, the nearer one to the element's first node first: a mirror keeps that, and numbers them
// otherwise.
std::array<Vec3, 2> endsOf(const FeaturePair& pair, const ObstacleFeatures& features, const Corners& at) {
  const auto& [c, d] = features.edges()[pair.feature].ends;
  if ((d - at[0]).squaredNorm() < (c - at[0]).squaredNorm()) return {d, c};
  return {c, d};
}

PairPoint closest(const FeaturePair& pair, const ObstacleFeatures& features, const Corners& at) {
  PairPoint point;
  if (pair.edges) {
    const auto [c, d] = endsOf(pair, features, at);
    const SegmentsClosest found = closestOnSegments(at[0], at[1], c, d);
    point.weight = {1.0 - found.s, found.s, 0.0};
    point.inside = found.s > 0.0 && found.s < 1.0 && found.t > 0.0 && found.t < 1.0;
    point.apart = mix(point.weight, at) - c - found.t * (d - c);
  } else {
    const Vec3& corner = features.vertices()[pair.feature].position;
    const TriangleClosest found = closestOnTriangle(corner, at[0], at[1], at[2]);
    point.weight = {found.weights[0], found.weights[1], found.weights[2]};
    point.apart = mix(point.weight, at) - corner;
    point.inside = found.weights.maxCoeff() < 1.0;
  }
  point.distance = point.apart.norm();
  return point;
}

std::optional<double> impact(const FeaturePair& pair, const ObstacleFeatures& features, const Corners& a,
                             const Corners& b, double distance) {
  if (pair.edges) {
    const auto [c, d] = endsOf(pair, features, a);
    return edgeEdgeTimeOfImpact(a[0], a[1], c, d, b[0], b[1], c, d, distance);
  }
  const Vec3& corner = features.vertices()[pair.feature].position;
  return vertexTriangleTimeOfImpact(corner, a[0], a[1], a[2], corner, b[0], b[1], b[2], distance);
}

// Whether the whole motion is further than `distance` above the feature's plane: cheaper than closest points, and true
// of most pairs.
bool staysAbove(const FeaturePair& pair, const ObstacleFeatures& features, const Corners& start, const Corners& end,
                double distance) {
  const Vec3& outward = pair.edges ? features.edges()[pair.feature].outward : features.vertices()[pair.feature].outward;
  const Vec3& at = pair.edges ? features.edges()[pair.feature].ends[0] : features.vertices()[pair.feature].position;
  const double bound = outward.dot(at) + distance;
  for (std::size_t k = 0; k < (pair.edges ? 2U : 3U); ++k) {
    if (!(outward.dot(start[k]) > bound && outward.dot(end[k]) > bound)) return false;
  }
  return true;
}

// The closest point of the cloth is inside the solid.
bool isInside(const FeaturePair& pair, const ObstacleCandidates& candidates, const PairPoint& point, const Corners& at,
              SurfacePoint& surface) {
  const ObstacleFeatures& features = *candidates.shape().features();
  if (!features.closed()) return false;
  const Vec3& outward = pair.edges ? features.edges()[pair.feature].outward : features.vertices()[pair.feature].outward;
  if (point.apart.dot(outward) > 0.0) return false;
  const Vec3 p = mix(point.weight, at);
  return candidates.shape().query(p, p, 0.0, surface) && surface.distance < 0.0;
}

ContactPoint contactPoint(const FeaturePair& pair, const PairPoint& closest, const Corners& start, const Corners& at,
                          double share) {
  const SurfacePoint surface{closest.distance, closest.apart / closest.distance};
  return contactPoint(pair.node, pair.edges ? 2 : 3, closest.weight, surface, start, at, share);
}

void add(const ObstacleSubstep& substep, const ClothPattern& pattern, ContactPoint& point, double distance, double kept,
         std::uint32_t source, Contacts& contacts) {
  point.keep(distance, kept, substep);
  Contact contact;
  contact.source = source;
  // A contact of a single node is left to the node.
  if (makeContact(substep, pattern, point, contact) && contact.nodes > 1) addWithinRoom(contact, contacts);
}

void add(const ObstacleSubstep& substep, const ClothPattern& pattern, ContactPoint& point, double distance, double kept,
         std::uint32_t source, std::vector<Crossing>& crossings) {
  point.keep(distance, kept, substep);
  Crossing crossing{point.node, point.nodes, {}};
  crossing.contact.source = source;
  if (makeContact(substep, pattern, point, crossing.contact)) addWithinRoom(crossing, crossings);
}

// An element that touches, or will: its point, where it was then, when, and how far it was at the start.
struct Touching {
  ElementPoint nearest;
  Corners at;
  double share;
  double distance;
};

// nearest(corners, reach, out) and impact(start, end): of the element. first: where it is nearest at the start; null:
// not within the thickness then.
template <typename Nearest, typename Impact>
bool touches(const ObstacleCandidates& candidates, const Corners& start, const Corners& end, const ElementPoint* first,
             const Nearest& nearest, const Impact& impact, Touching& out) {
  const double listed = candidates.elementReach();
  ElementPoint then;
  if (first != nullptr && (first->surface.distance <= listed || nearest(end, listed, then))) {
    const Vec3& normal = first->surface.normal;
    const double height = normal.dot(mix(first->weights, end) - mix(first->weights, start)) + first->surface.distance;
    out = {*first, start, 0.0, first->surface.distance};
    return height <= listed;
  }
  const std::optional<double> time = impact(start, end);
  if (!time) return false;
  out.at = between(start, end, *time);
  out.share = *time;
  out.distance = candidates.thickness();
  return nearest(out.at, listed, out.nearest);
}

}  // namespace

// Where an edge of the obstacle lies along a face, the face has no nearest point: one end of the line or the other is
// nearer. Both are on edges of the face, whose nearest points are distinct. So edges have their own contacts, and a
// face has one where it is nearer than they are: at a corner, or a small sphere.
void collectFaces(const ObstacleSubstep& substep, const ClothPattern& pattern, ObstacleCandidates& candidates,
                  std::vector<PenetratingFace>& penetrating, Contacts& contacts) noexcept {
  const ConvexShape& shape = *candidates.shape().convex();
  const double core = candidates.core();
  const auto on_face = [&](const Corners& at, double reach, ElementPoint& out) {
    return shape.nearestOnTriangle(at, reach, out);
  };
  const auto on_edge = [&](const Corners& at, double reach, ElementPoint& out) {
    return shape.nearestOnEdge({at[0], at[1]}, reach, out);
  };
  for (const ObstacleCandidates::Face& face : candidates.faces()) {
    if (startsInside(face.node, 3, candidates)) continue;
    const Corners start = startOf(candidates, face.node), end = endOf(candidates, face.node);
    ElementPoint nearest;
    const bool close = shape.nearestOnTriangle(start, candidates.thickness(), nearest);
    if (close) candidates.facePlane(face) = {mix(nearest.weights, start), nearest.surface};
    if (close && nearest.surface.distance < 0.0) {
      addWithinRoom(PenetratingFace{face.node, nearest}, penetrating);
      continue;
    }
    Touching of_face;
    const auto impact = [&](const Corners& a, const Corners& b) { return shape.timeOfImpact(a, b, core); };
    if (!touches(candidates, start, end, close ? &nearest : nullptr, on_face, impact, of_face)) continue;
    double nearest_edge = kInfinity;
    for (std::size_t k = 0; k < 3; ++k) {
      // The same of both faces of an edge.
      const auto [a, b] = std::minmax(face.node[k], face.node[(k + 1) % 3]);
      const MeshTriangle edge{a, b, b};
      const Corners from = startOf(candidates, edge), to = endOf(candidates, edge);
      ElementPoint first;
      const bool near = on_edge(from, candidates.thickness(), first);
      const auto hits = [&](const Corners& p, const Corners& q) {
        return shape.timeOfImpact(std::array<Vec3, 2>{p[0], p[1]}, std::array<Vec3, 2>{q[0], q[1]}, core);
      };
      Touching of_edge;
      if (!touches(candidates, from, to, near ? &first : nullptr, on_edge, hits, of_edge)) continue;
      nearest_edge = std::min(nearest_edge, of_edge.nearest.surface.distance);
      ContactPoint point =
          contactPoint(edge, 2, of_edge.nearest.weights, of_edge.nearest.surface, from, of_edge.at, of_edge.share);
      point.curved = true;
      add(substep, pattern, point, of_edge.distance, core, 0, contacts);
    }
    if (!(of_face.nearest.surface.distance < nearest_edge - kNearer * (core - substep.moving.padding))) continue;
    ContactPoint point = contactPoint(face.node, of_face.nearest, start, of_face.at, of_face.share);
    point.curved = true;
    add(substep, pattern, point, of_face.distance, core, 0, contacts);
  }
}

void relinearise(const ContactShape& shape, const Transform& place, const Field3& position, Contact& contact) noexcept {
  Corners at;
  for (std::size_t k = 0; k < 3; ++k)
    at[k] = place.toLocal(position.at(contact.node[std::min(k, static_cast<std::size_t>(contact.nodes) - 1)]));
  if (shape.features() != nullptr) {
    const FeaturePair pair{{}, contact.source / 2, contact.source % 2 != 0};
    const PairPoint point = closest(pair, *shape.features(), at);
    if (point.distance > 0.0) contact.turnTo(place.rotation * (point.apart / point.distance), point.distance, position);
    return;
  }
  ElementPoint nearest;
  const bool found = contact.nodes == 2 ? shape.convex()->nearestOnEdge({at[0], at[1]}, kInfinity, nearest)
                                        : shape.convex()->nearestOnTriangle(at, kInfinity, nearest);
  if (found) contact.turnTo(place.rotation * nearest.surface.normal, nearest.surface.distance, position);
}

void collectPenetratingFaces(const ObstacleSubstep& substep, const ClothPattern& pattern,
                             const ObstacleCandidates& candidates, const ExitDirection& exit,
                             const std::vector<PenetratingFace>& penetrating, Contacts& contacts) noexcept {
  const double listed = candidates.elementReach();
  for (const PenetratingFace& face : penetrating) {
    const Corners start = startOf(candidates, face.node), end = endOf(candidates, face.node);
    ElementPoint point_inside = face.deepest;
    point_inside.surface = exit.exitSurface(mix(face.deepest.weights, start), face.deepest.surface);
    ContactPoint point = contactPoint(face.node, point_inside, start, start, 0.0);
    if (point.normal.dot(mix(point.weight, end)) - point.height > listed) continue;
    add(substep, pattern, point, point_inside.surface.distance, candidates.core(), 0, contacts);
  }
}

void crossingFaces(const ObstacleSubstep& substep, const ClothPattern& pattern, const ObstacleCandidates& candidates,
                   std::vector<Crossing>& crossings) noexcept {
  const ConvexShape& shape = *candidates.shape().convex();
  for (const ObstacleCandidates::Face& face : candidates.faces()) {
    if (startsInside(face.node, 3, candidates)) continue;
    const Corners start = startOf(candidates, face.node), end = endOf(candidates, face.node);
    ElementPoint nearest;
    const bool close = shape.nearestOnTriangle(start, candidates.thickness(), nearest);
    const double distance = close ? nearest.surface.distance : candidates.thickness();
    if (distance <= 0.0) continue;
    const std::optional<double> time = shape.timeOfImpact(start, end, candidates.least(distance));
    if (!time) continue;
    const Corners at = between(start, end, *time);
    if (!shape.nearestOnTriangle(at, kInfinity, nearest)) continue;
    ContactPoint point = contactPoint(face.node, nearest, start, at, *time);
    point.curved = true;
    add(substep, pattern, point, distance, candidates.core(), 0, crossings);
  }
}

void collectPairs(const ObstacleSubstep& substep, const ClothPattern& pattern, const ObstacleCandidates& candidates,
                  Contacts& contacts) noexcept {
  const ObstacleFeatures& features = *candidates.shape().features();
  const double listed = candidates.elementReach();
  for (const FeaturePair& pair : candidates.pairs()) {
    if (startsInside(pair.node, pair.edges ? 2 : 3, candidates)) continue;
    const Corners start = startOf(candidates, pair.node), end = endOf(candidates, pair.node);
    if (staysAbove(pair, features, start, end, listed)) continue;
    const PairPoint first = closest(pair, features, start);
    if (first.distance - longestDisplacement(start, end) > listed) continue;
    const bool close = first.distance <= listed ||
                       (first.distance <= candidates.thickness() && closest(pair, features, end).distance <= listed);
    if (!close) {
      const std::optional<double> time = impact(pair, features, start, end, candidates.core());
      if (!time) continue;
      const Corners at = between(start, end, *time);
      const PairPoint there = closest(pair, features, at);
      if (!there.inside || !(there.distance > 0.0) || there.distance > listed) continue;
      ContactPoint point = contactPoint(pair, there, start, at, *time);
      point.curved = true;
      add(substep, pattern, point, candidates.thickness(), candidates.core(), sourceOf(pair), contacts);
      continue;
    }
    if (!first.inside || !(first.distance > 0.0)) continue;
    ContactPoint point = contactPoint(pair, first, start, start, 0.0);
    point.curved = true;
    SurfacePoint surface;
    double distance = first.distance;
    if (isInside(pair, candidates, first, start, surface)) {
      distance = surface.distance;
      point.normal = surface.normal;
      point.height = surface.normal.dot(point.touch) - distance;
    } else if (point.normal.dot(mix(point.weight, end)) - point.height > listed) {
      continue;
    }
    add(substep, pattern, point, distance, candidates.core(), sourceOf(pair), contacts);
  }
}

void crossingPairs(const ObstacleSubstep& substep, const ClothPattern& pattern, const ObstacleCandidates& candidates,
                   std::vector<Crossing>& crossings) noexcept {
  const ObstacleFeatures& features = *candidates.shape().features();
  const double most = candidates.least();
  for (const FeaturePair& pair : candidates.pairs()) {
    if (startsInside(pair.node, pair.edges ? 2 : 3, candidates)) continue;
    const Corners start = startOf(candidates, pair.node), end = endOf(candidates, pair.node);
    if (staysAbove(pair, features, start, end, most)) continue;
    const PairPoint first = closest(pair, features, start);
    const double least = candidates.least(first.distance);
    if (first.distance - longestDisplacement(start, end) > least || !(first.distance > 0.0)) continue;
    const std::optional<double> time = impact(pair, features, start, end, least);
    SurfacePoint surface;
    if (!time || isInside(pair, candidates, first, start, surface)) continue;
    const Corners at = between(start, end, *time);
    const PairPoint there = closest(pair, features, at);
    ContactPoint point = there.distance > 0.0 ? contactPoint(pair, there, start, at, *time)
                                              : contactPoint(pair, first, start, start, 0.0);
    point.curved = true;
    add(substep, pattern, point, first.distance, candidates.core(), sourceOf(pair), crossings);
  }
}

}  // namespace curtain
