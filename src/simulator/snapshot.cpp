// SPDX-License-Identifier: BSD-3-Clause
#include <new>
#include <stdexcept>

#include "cloth/archive.h"
#include "curtain_sim/scene_yaml.h"
#include "scene/scene_difference.h"
#include "simulator/simulator_impl.h"
#include "simulator/snapshot_format.h"

namespace curtain {
namespace {

// Scene keys that may differ: those that may change come with the snapshot, the bits do not depend on the number of
// threads, and of a mesh the triangles are compared, not the path.
const std::vector<std::string> kAside = {"gravity",
                                         "air",
                                         "contact.friction",
                                         "solver.frame_rate",
                                         "solver.stretch_tolerance",
                                         "solver.position_tolerance",
                                         "solver.budget_ms",
                                         "solver.threads",
                                         "obstacles[].mesh",
                                         "obstacles[].color",
                                         "obstacles[].visible"};

// What a position tolerance takes is there or not from the start: it comes with the snapshot only where both have one.
std::optional<Problem> toleranceOnOneSide(const Scene& ours, const std::string& snapshot) {
  const double theirs = readSceneText(snapshot).scene.solver.position_tolerance;
  if ((ours.solver.position_tolerance > 0.0) == (theirs > 0.0)) return std::nullopt;
  const char* const text = theirs > 0.0 ? "is asked for there, not here" : "is asked for here, not there";
  return Problem{"solver.position_tolerance", text + std::string(": the snapshot is of another scene")};
}

}  // namespace

// Checksum of names, types and counts.
std::uint32_t Simulator::Impl::layout() {
  Archive archive = Archive::describing();
  serialize(archive);
  return checksum(archive.extractWritten());
}

std::string Simulator::snapshot() const {
  Archive archive = Archive::saving();
  impl_->serialize(archive);
  const std::string scene = writeScene(impl_->scene), state = archive.extractWritten();
  return packSnapshot({impl_->layout(), scene, state});
}

std::vector<Problem> Simulator::restore(const std::string& snapshot) {
  SnapshotParts parts;
  if (auto problem = unpackSnapshot(snapshot, parts)) return {*problem};
  std::unique_ptr<Impl> other;  // with the snapshot's cloth, where that is another one
  try {
    const SceneReading theirs = readSceneText(std::string(parts.scene));
    Scene with_theirs = impl_->scene;
    with_theirs.cloth = theirs.scene.cloth;
    for (std::size_t k = 0; k < std::min(with_theirs.layers.size(), theirs.scene.layers.size()); ++k)
      with_theirs.layers[k].cloth = theirs.scene.layers[k].cloth;
    const bool same = writeScene(with_theirs) == writeScene(impl_->scene);
    if (theirs.problems.empty() && !same && impl_->mayBecome(with_theirs)) other = impl_->withCloths(with_theirs);
    Impl& into = other ? *other : *impl_;
    if (auto problem = firstDifference(writeScene(into.scene), std::string(parts.scene), kAside)) {
      return {{problem->key, problem->text + ": the snapshot is of another scene"}};
    }
    if (parts.layout != into.layout()) {
      if (auto problem = toleranceOnOneSide(into.scene, std::string(parts.scene))) return {*problem};
      return {{"snapshot", "holds other things than this program does: it is of another build"}};
    }
    Archive archive = Archive::loading(parts.state);
    into.serialize(archive);
    archive.finishLoading();
    archive.commit();
  } catch (const ArchiveError& error) {
    return {{"snapshot", std::string("is damaged: ") + error.what()}};
  } catch (const std::bad_alloc&) {
    return {{"snapshot", "cannot be restored: there is not enough memory"}};
  } catch (const std::invalid_argument& error) {
    return {{"snapshot", std::string("is damaged: ") + error.what()}};
  }
  if (other) {
    other->revision = impl_->revision;
    other->surface.shareTopology(impl_->surface);
    impl_ = std::move(other);
  }
  impl_->resume();
  return {};
}

}  // namespace curtain
