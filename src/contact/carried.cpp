// SPDX-License-Identifier: BSD-3-Clause
//
// What a snapshot carries of contact. Lists of what is near are carried though they could be made anew: they last for some
// time, and when they are renewed, and from which points planes were found, changes the last bits of what comes next.
#include <limits>

#include "cloth/archive.h"
#include "contact/cloth_contact.h"
#include "contact/obstacle_features.h"
#include "scene/fnv1a.h"

namespace curtain {
namespace {

constexpr std::int64_t kCount = 1 << 30;           // far from where an int ends
constexpr std::int64_t kMany = std::int64_t{1} << 53;

void carryNodes(Archive& archive, const char* name, const Grid& grid, std::vector<std::uint32_t>& nodes) {
  archive.list(name, nodes, [&](std::uint32_t& node) { archive.node("node", node, grid); });
}

template <std::size_t kNodes>
void carryNodes(Archive& archive, const char* name, const Grid& grid, std::array<std::uint32_t, kNodes>& nodes) {
  for (std::uint32_t& node : nodes) archive.node(name, node, grid);
}

// Of a mesh's corners and triangles: its file may have changed since.
std::uint64_t fingerprint(const ShapeTriangles& mesh) {
  Fnv1a bits;
  for (const Vec3& corner : mesh.corners) bits.addBytes(corner.data(), sizeof(double) * 3);
  for (const Eigen::Vector3i& triangle : mesh.triangles) bits.addBytes(triangle.data(), sizeof(int) * 3);
  return bits.hash;
}

void carryTransform(Archive& archive, const char* name, Transform& transform) {
  archive.group(name, [&] {
    archive.finite("rotation", transform.rotation);
    archive.finite("translation", transform.translation);
  });
}

}  // namespace

void MovingObstacle::carry(Archive& archive) {
  archive.flag("present", present);
  carryTransform(archive, "before", before);
  carryTransform(archive, "after", after);
  archive.numbers("swept", swept_);
}

void ObstacleSet::Item::carry(Archive& archive) {
  if (shape->convex() == nullptr) {
    archive.same("mesh", fingerprint(shape->triangles()), "the mesh is not the one that it was: its file has changed");
  }
  archive.finite("left", left);
  archive.finite("begin", begin);
  archive.finite("end", end);
  bool follows = scripted;
  archive.atOnce([&] { archive.flag("scripted", follows); });
  archive.require(!follows || !motion.empty(), "there is no motion to follow");
  archive.put(scripted, follows);
  archive.flag("moved", moved);
  archive.within("own_way", own_way, 0.0, std::numeric_limits<double>::infinity());
  archive.within("share", share, 0.0, 1.0);
  archive.flag("behind", behind);
  archive.flag("placed", placed);
}

void ObstacleSet::carry(Archive& archive) {
  archive.within("frame_length", frame_length_, 1e-6, 1e3);
  for (Item& item : items_) archive.part("item", item);
  for (MovingObstacle& moving : moving_) archive.part("moving", moving);
}

void NodePlane::carry(Archive& archive) {
  archive.numbers("at", at);
  archive.number("distance", surface.distance);
  archive.numbers("normal", surface.normal);
  archive.integer("kind", kind, 0, static_cast<std::int64_t>(Kind::kFound));
}

// Of the substep alone: where nodes are in it, and which start inside. Of a look alone: how near they may come.
void Vicinity::carry(Archive& archive) {
  const Grid& grid = pattern_.grid;
  archive.number("slack", slack_);
  archive.number("length", length_);
  archive.number("elapsed", elapsed_);
  archive.numbers("from", from_);
  archive.numbers("to", to_);
  const std::size_t planes = archive.list("planes", planes_, [&](NodePlane& plane) { plane.carry(archive); });
  archive.require(planes == planes_.size(), "must have a plane for each node");
  archive.flags("keeps", keeps_);
  archive.flag("outdated", outdated_);
  archive.flags("is_taken", is_taken_);
  carryNodes(archive, "taken", grid, taken_);
  carryNodes(archive, "nodes", grid, nodes_);
  const std::size_t faces =
      archive.list("faces", faces_, [&](MeshTriangle& face) { carryNodes(archive, "node", grid, face); });
  archive.require(faces == 0 || shape_.convex() != nullptr, "must be without faces");
  const ObstacleFeatures* const features = shape_.convex() == nullptr ? shape_.features() : nullptr;
  archive.list("pairs", pairs_, [&](FeaturePair& pair) {
    archive.require(features != nullptr, "must not be");
    carryNodes(archive, "node", grid, pair.node);
    archive.flag("edges", pair.edges);
    const std::size_t count = features == nullptr ? 1 : pair.edges ? features->edges().size() : features->vertices().size();
    archive.integer("feature", pair.feature, 0, static_cast<std::int64_t>(count) - 1);
  });
  archive.put(inside_, std::vector<std::uint8_t>(inside_.size(), 0));
}

void ObstacleContacts::Load::carry(Archive& archive) {
  archive.numbers("impulse", impulse);
  archive.numbers("angular", angular);
  archive.integer("contacts", contacts, 0, kCount);
}

// Who is carried along, and what would cross, is of one substep.
void ObstacleContacts::carry(Archive& archive) {
  archive.part("bounds", bounds_);
  archive.numbers("box", box_);
  archive.number("box_time", box_time_);
  for (Vicinity& vicinity : near_) archive.part("near", vicinity);
  archive.flags("active", active_);
  carryContacts(archive, "last", pattern_.grid, obstacles_.count(), last_);
  for (Load& load : loads_) archive.part("load", load);
  archive.number("loaded_for", loaded_for_);
}

void SelfContacts::carry(Archive& archive, const Grid& grid) {
  archive.list("near", near_, [&](NearPair& pair) {
    carryNodes(archive, "node", grid, pair.key.node);
    archive.flag("edges", pair.key.edges);
    archive.number("push", pair.push);
    archive.numbers("slide", pair.slide);
  });
}

// The tree is refitted before every use; strays and marks are of one look.
void KeptPairs::carry(Archive& archive) {
  archive.list("vertex_triangles", kept_.vertex_triangles, [&](VertexTriangle& pair) {
    archive.node("vertex", pair.vertex, grid_);
    carryNodes(archive, "triangle", grid_, pair.triangle);
  });
  archive.list("edge_edges", kept_.edge_edges, [&](EdgeEdge& pair) {
    carryNodes(archive, "first", grid_, pair.first);
    carryNodes(archive, "second", grid_, pair.second);
  });
  archive.numbers("from", from_);
  archive.numbers("way", way_);
  archive.number("reach", reach_);
  archive.number("leeway", leeway_);
  archive.number("stray", stray_);
  archive.integer("age", age_, 0, kCount);
  archive.flag("expects", expects_);
  archive.integer("descents", descents_, 0, kMany);
}

void TautNet::Slopes::carry(Archive& archive) {
  archive.number("least_u", least_u);
  archive.number("most_u_across", most_u_across);
  archive.number("least_v", least_v);
  archive.number("most_v_across", most_v_across);
}

void TautNet::carry(Archive& archive) {
  archive.numbers("a", a_);
  archive.numbers("b", b_);
  archive.part("last", last_);
  archive.flag("known", known_);
  archive.integer("pause", pause_, 0, kCount);
}

void ClothContact::Known::carry(Archive& archive) {
  archive.flag("taut", taut);
  archive.flag("seen", seen);
}

// Candidates and zones are of one look.
void ClothContact::carry(Archive& archive) {
  archive.part("touch", touch_);
  if (self_wanted_) {
    archive.group("self", [&] { self_.carry(archive, pattern_.grid); });
    archive.part("pairs", pairs_);
    archive.part("net", net_);
  }
  archive.part("started", started_);
  archive.part("ended", ended_);
  archive.flag("flat", flat_);
  archive.flag("looked", looked_);
  carryContacts(archive, "contacts", pattern_.grid, obstacles_.count(), contacts_);
  carryContacts(archive, "last", pattern_.grid, obstacles_.count(), last_);
  archive.number("last_scale", last_scale_);
  archive.integer("slippery", slippery_, 0, kCount);
}

}  // namespace curtain
