// SPDX-License-Identifier: BSD-3-Clause
//
// What a snapshot holds of contact: the multipliers of the last accepted substep, and the obstacles' poses. Candidates
// and caches are rebuilt.
#include <limits>

#include "cloth/archive.h"
#include "contact/cloth_contact.h"
#include "scene/fnv1a.h"

namespace curtain {
namespace {

constexpr std::int64_t kCount = 1 << 30;  // well below the largest int

// Of a mesh's geometry: its file may have changed since the snapshot.
std::uint64_t fingerprint(const ShapeTriangles& mesh) {
  Fnv1a bits;
  for (const Vec3& corner : mesh.corners) bits.addBytes(corner.data(), sizeof(double) * 3);
  for (const Eigen::Vector3i& triangle : mesh.triangles) bits.addBytes(triangle.data(), sizeof(int) * 3);
  return bits.hash;
}

void serializeTransform(Archive& archive, const char* name, Transform& transform) {
  archive.group(name, [&] {
    archive.finite("rotation", transform.rotation);
    archive.finite("translation", transform.translation);
  });
}

}  // namespace

void MovingObstacle::serialize(Archive& archive) {
  archive.flag("present", present);
  serializeTransform(archive, "before", before);
  serializeTransform(archive, "after", after);
  archive.numbers("swept", swept_);
}

void ObstacleSet::Item::serialize(Archive& archive) {
  if (shape->convex() == nullptr) {
    archive.same("mesh", fingerprint(shape->triangles()), "the mesh is not the one that it was: its file has changed");
  }
  archive.finite("left", left);
  archive.finite("begin", begin);
  archive.finite("end", end);
  bool follows = scripted;
  archive.atOnce([&] { archive.flag("scripted", follows); });
  archive.require(!follows || script.any(), "there is no motion to follow");
  archive.put(scripted, follows);
  archive.flag("moved", moved);
  archive.within("pace", pace, 0.0, std::numeric_limits<double>::infinity());
  archive.flag("behind", behind);
  archive.part("curve", curve);
  archive.put(stands, false);
}

void ObstacleSet::serialize(Archive& archive) {
  for (int n = 0; n < count(); ++n) moving(n);  // what is saved does not depend on who was asked for
  archive.within("frame_length", frame_length_, 1e-6, 1e3);
  for (Item& item : items_) archive.part("item", item);
  for (MovingObstacle& moving : moving_) archive.part("moving", moving);
  archive.flag("any_moved", any_moved_);
  for (Item& item : items_) {
    archive.put(item.placed, substep_);
    archive.put(item.boxed, false);
    archive.put(item.moves, false);
  }
  archive.put(boxed_, false);
}

void ObstacleContacts::Load::serialize(Archive& archive) {
  archive.numbers("impulse", impulse);
  archive.numbers("angular", angular);
  archive.integer("contacts", contacts, 0, kCount);
}

void ObstacleContacts::serialize(Archive& archive) {
  for (Load& load : loads_) archive.part("load", load);
  archive.number("acted", acted_);
}

// The multipliers and directions of a contact: they warm-start the next substep, and with the last forces advance
// velocities to the time of the positions. The rest is recomputed in every substep.
void ClothContact::serializePushing(Archive& archive, Contact& contact) const {
  for (std::uint32_t& node : contact.node) archive.node("node", node, pattern_.grid);
  for (double& weight : contact.weight) archive.number("weight", weight);
  archive.integer("nodes", contact.nodes, 0, 4);
  archive.integer("obstacle", contact.obstacle, Contact::kCloth, obstacles_.count() - 1);
  archive.integer("other", contact.other, Contact::kCloth, obstacles_.count() - 1);
  archive.integer("source", contact.source, 0, std::numeric_limits<std::uint32_t>::max());
  archive.numbers("normal", contact.normal);
  archive.numbers("level", contact.level);
  archive.numbers("surface_velocity", contact.surface_velocity);
  archive.numbers("end_velocity", contact.end_velocity);
  archive.number("friction", contact.friction);
  archive.number("press", contact.press);
  archive.number("hold", contact.hold);
  archive.number("push", contact.push);
  archive.numbers("slide", contact.slide);
  archive.flag("sticks", contact.sticks);
}

void ClothContact::serialize(Archive& archive) {
  archive.part("touch", obstacle_contacts_);
  archive.flag("taut", taut_);
  archive.list("pushing", last_, [&](Contact& contact) { serializePushing(archive, contact); });
  archive.number("last_scale", last_scale_);
  archive.integer("slippery", frictionless_substeps_, 0, kCount);
}

}  // namespace curtain
