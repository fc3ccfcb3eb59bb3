// SPDX-License-Identifier: BSD-3-Clause
//
// Serialization of the simulator's own parts; those of lower floors are in src/*/carried.cpp.
#include <algorithm>
#include <cmath>
#include <limits>

#include "cloth/archive_params.h"
#include "scene/infinity.h"
#include "simulator/simulator_impl.h"

namespace curtain {
namespace {

constexpr double kLargestNumber = std::numeric_limits<double>::max();
constexpr double kLeastNumber = std::numeric_limits<double>::min();
constexpr std::int64_t kCount = 1 << 30;  // bound of counters: adding to them can't overflow an int
constexpr std::int64_t kMostCount = std::int64_t{1} << 53;

// A drag with the node that it pulls at.
struct HeldDrag {
  DragParams drag;
  std::optional<NodeIndex> node;
};

void carryStatistics(Archive& archive, Statistics& s) {
  archive.integer("frames", s.frames, 0, kMostCount);
  archive.number("time", s.time);
  archive.integer("substeps", s.substeps, 0, kMostCount);
  archive.integer("substeps_last", s.substeps_last, 0, kCount);
  archive.integer("sweeps", s.sweeps, 0, kMostCount);
  archive.integer("sweeps_last", s.sweeps_last, 0, kCount);
  archive.integer("rejected", s.rejected, 0, kMostCount);
  archive.integer("last_resort_substeps", s.last_resort_substeps, 0, kMostCount);
  archive.integer("unsettled", s.unsettled, 0, kMostCount);
  archive.integer("asleep_frames", s.asleep_frames, 0, kMostCount);
  archive.integer("wakes", s.wakes, 0, kMostCount);
  archive.flag("asleep", s.asleep);
  archive.integer("estimates_skipped", s.estimates_skipped, 0, kMostCount);
  archive.integer("longer_substeps", s.longer_substeps, 0, kMostCount);
  archive.integer("unfinished_substeps", s.unfinished_substeps, 0, kMostCount);
  archive.integer("shortened_frames", s.shortened_frames, 0, kMostCount);
  archive.number("lost_time", s.lost_time);
  archive.integer("late_frames", s.late_frames, 0, kMostCount);
  archive.integer("stops", s.stops, 0, kMostCount);
  archive.integer("stops_last", s.stops_last, 0, kCount);
  archive.number("momentum_cut", s.momentum_cut);
  archive.number("obstacles_waited", s.obstacles_waited);
  archive.number("warp_stretch", s.warp_stretch);
  archive.number("weft_stretch", s.weft_stretch);
  archive.number("warp_compression", s.warp_compression);
  archive.number("warp_stretch_max", s.warp_stretch_max);
  archive.number("weft_stretch_max", s.weft_stretch_max);
  archive.number("warp_compression_max", s.warp_compression_max);
  archive.integer("contacts", s.contacts, 0, kCount);
  archive.integer("contacts_max", s.contacts_max, 0, kCount);
  archive.number("penetration_max", s.penetration_max);
  archive.number("step_seconds", s.step_seconds);
  archive.number("step_seconds_max", s.step_seconds_max);
  archive.number("step_seconds_sum", s.step_seconds_sum);
  for (double& seconds : s.stage_seconds) archive.number("stage_seconds", seconds);
  archive.number("position_error", s.position_error);
  archive.number("opening", s.opening);
  archive.number("drive_force", s.drive_force);
  archive.flag("finite", s.finite);
}

}  // namespace

// Winds follow from their parameters and the time, drags from theirs and the grasped node. The last forces are needed
// for velocities that lag behind the positions.
void ForceField::carry(Archive& archive, AirParams& air) {
  std::vector<WindParams> winds = winds_.params;
  std::vector<HeldDrag> held_drags;
  for (const DragForce& drag : drags_.list) held_drags.push_back({drag.params(), drag.node()});
  AirParams of_then = air;
  archive.atOnce([&] {
    archive.list("winds", winds, [&](WindParams& wind) { carryParams(archive, wind); });
    archive.list("drags", held_drags, [&](HeldDrag& grasp) {
      carryParams(archive, grasp.drag, scene_.cloth);
      archive.optional("holds", grasp.node, NodeIndex(),
                       [&](NodeIndex& node) { archive.node("node", node, pattern_.grid); });
    });
    archive.group("air", [&] { carryParams(archive, of_then); });
  });
  bool more_than_weight = forces_.force == &sum_;
  archive.atOnce([&] { archive.flag("more_than_weight", more_than_weight); });
  archive.numbers("sum", sum_);
  archive.flag("weight_only", forces_.weight_only);
  archive.numbers("gravity", forces_.gravity);
  archive.numbers("damping", forces_.damping);
  archive.flag("has_damping", forces_.has_damping);
  if (!archive.loads()) return;
  Sources<WindSource, WindParams> loaded_winds;
  for (const WindParams& wind : winds)
    loaded_winds.put(WindSource(wind, pattern_, scene_.cloth.porosity, scene_.solver.seed));
  Sources<DragForce, DragParams> loaded_drags;
  for (const HeldDrag& grasp : held_drags) {
    DragForce drag(grasp.drag, pattern_);
    if (grasp.node) drag.grasp(*grasp.node, pattern_);
    loaded_drags.put(std::move(drag));
  }
  archive.put(winds_, std::move(loaded_winds));
  archive.put(drags_, std::move(loaded_drags));
  archive.put(air, of_then);
  archive.put(air_damping_, AirDamping(of_then, pattern_));
  archive.put(relative_air_, RelativeAir(of_then, scene_.cloth.porosity, pattern_));
  archive.put(forces_.force, static_cast<const Field3*>(more_than_weight ? &sum_ : &weight_));
}

// Limits follow from scene, gravity and air; other members are scratch of a look.
void Rest::carry(Archive& archive) {
  archive.within("frame_length", frame_length_, 1e-6, 1e3);
  archive.integer("due_in", due_in_, 1, kCount);
  archive.integer("turn", turn_, 0, 3);
  archive.flag("asleep", asleep_);
  archive.flag("disturbed", disturbed_);
  archive.number("since", since_);
  archive.numbers("place", place_);
  const std::size_t boxes = archive.list("box", box_, [&](Eigen::AlignedBox3d& box) { archive.numbers("of", box); });
  archive.require(boxes == 0 || boxes == box_.size(), "must have a box for each column");
  archive.numbers("all", all_);
  archive.numbers("swept", swept_);
  archive.integer("wakes", wakes_, 0, kMostCount);
}

// Members of the present frame are set by the next one.
void Budget::carry(Archive& archive) {
  archive.within("substep", substep_, 0.0, kLargestNumber);
  archive.within("companion", reference_, 0.0, kLargestNumber);
  archive.within("tail", tail_, 0.0, kLargestNumber);
  archive.within("frame", frame_, 0.0, kLargestNumber);
  archive.integer("stalled", stalled_, 0, kCount);
}

void ErrorEstimate::carry(Archive& archive) {
  archive.within("frame_length", frame_length_, 1e-6, 1e3);
  archive.integer("window", window_, 1, kCount);
  archive.flag("of_stages", of_stages_);
  archive.integer("substeps", substeps_, fewest_, most_);
  archive.integer("frames", frames_, 0, kMostCount);
  archive.integer("compared", compared_, 0, kCount);
  archive.within("steps_sum", steps_sum_, 0.0, kLargestNumber);
  archive.within("companion_sum", reference_sum_, 0.0, kLargestNumber);
  archive.within("now", now_, 0.0, kInfinity);
  archive.within("last_second", last_second_, 0.0, kInfinity);
}

// Names are part of the layout: they stay when members are renamed.
void ErrorControl::Reference::carry(Archive& archive) {
  archive.part("state", at.state);
  archive.part("memory", at.memory);
  archive.integer("substeps", substeps, 0, kCount);
  archive.integer("steps", tally.steps, 0, kCount);
  archive.flag("of_stages", tally.of_stages);
  archive.flag("lost", lost);
  archive.flag("in_finer_steps", in_finer_steps);
}

void ErrorControl::carry(Archive& archive) {
  archive.part("estimate", estimate_);
  archive.part("companion", reference_);
}

void StepControls::carry(Archive& archive) {
  archive.part("control", main);
  archive.integer("plain_frames", plain_frames, 0, kCount);
  archive.part("plain_control", plain);
}

// Ends of lines are no nodes of the cloth, but pins that move as they do.
void PinMoves::carry(Archive& archive, const Grid& grid, const std::function<bool(std::size_t)>& is_pinned) {
  std::vector<std::uint8_t> seen(archive.loads() ? slot_.size() : 0, 0);
  archive.list("pin_moves", moves_, [&](Move& move) {
    archive.node("node", move.node, grid);
    if (archive.loads()) {
      archive.require(is_pinned(move.node), "must be a pinned node");
      archive.require(seen[move.node] == 0, "must name a node once");
      seen[move.node] = 1;
    }
    archive.finite("target", move.target);
    archive.flag("behind", move.behind);
    archive.flag("arrived", move.arrived);
    archive.flag("held", move.held);
  });
}

void Grasps::carryGrasp(Archive& archive, Grasp& grasp) {
  carryParams(archive, grasp.params, scene_.cloth);
  const auto carryPose = [&](const char* name, Pose& pose) {
    archive.finite(name, pose);
    archive.require(std::abs(pose.orientation.norm() - 1.0) <= 1e-3, "must have a unit quaternion");
  };
  carryPose("from", grasp.from);
  carryPose("to", grasp.to);
  archive.integer("taken", grasp.taken, 1, kCount);
  double pull = grasp.springs.pull();
  archive.atOnce([&] { archive.number("pull", pull); });
  archive.list("held", grasp.held, [&](HeldNode& held) {
    archive.node("node", held.node, pattern_.grid);
    archive.require(scene_pins_[held.node] == kFree, "must be a node that nothing else holds");
    archive.finite("place", held.place);
    archive.finite("velocity", held.velocity);
  });
  archive.finite("force", grasp.force);
  archive.finite("torque", grasp.torque);
  archive.within("slipped", grasp.slipped, 0.0, kLargestNumber);
  archive.integer("end", grasp.end, 0, 2);
  archive.require(grasp.holds() == (grasp.end == GraspEnd::kNone), "must hold nodes unless it has ended");
  if (!archive.loads()) return;
  prepare(grasp);
  grasp.springs.setPull(pull);
  for (const HeldNode& held : grasp.held) {
    archive.require(loaded_[held.node] == 0, "must hold nodes that no other holds");
    loaded_[held.node] = grasp.pins ? 2 : 1;
  }
}

void Grasps::carry(Archive& archive) {
  std::vector<std::string> known;
  std::fill(loaded_.begin(), loaded_.end(), std::uint8_t{0});
  archive.list("grasps", list_, [&](Grasp& grasp) {
    carryGrasp(archive, grasp);
    archive.require(std::find(known.begin(), known.end(), grasp.params.id) == known.end(),
                    "must have ids of their own");
    known.push_back(grasp.params.id);
  });
}

void FrameTimes::carry(Archive& archive) {
  archive.integer("frame", frame_, 0, kMostCount);
  archive.within("frame_rate", rate_, 1.0, 10000.0);
  archive.integer("same_since_frame", since_.frame, 0, kMostCount);
  archive.finite("same_since_time", since_.time);
  archive.finite("made_time", made_time_);
}

void EnergyGuard::carry(Archive& archive) {
  archive.optional("most_energy", most_, 0.0, [&](double& energy) { archive.finite("energy", energy); });
}

void Motion::carryVelocities(Archive& archive) {
  archive.numbers("velocities", velocities_);
  archive.flag("velocities_fresh", velocities_fresh_);
}

void EnergyLedger::carry(Archive& archive) {
  archive.finite("gravity", work_.gravity);
  archive.finite("bending", work_.bending);
  archive.finite("forces", work_.forces);
  archive.finite("drive", work_.drive);
  archive.finite("pins", work_.pins);
  archive.finite("obstacles", work_.obstacles);
  archive.finite("kinetic", work_.kinetic);
}

// Not serialized: checkpoints, which are written before they are read; the fine mesh, which has no memory; the
// revision, which belongs to this simulator's users.
void Simulator::Impl::carry(Archive& archive) {
  archive.finite("gravity", scene.gravity);
  archive.within("friction", scene.contact.friction, 0.0, 10.0);
  archive.within("stretch_tolerance", scene.solver.stretch_tolerance, 1e-12, 0.1);
  if (errors) archive.within("position_tolerance", scene.solver.position_tolerance, kLeastNumber, 1.0);
  archive.within("budget_ms", scene.solver.budget_ms, 0.0, 1e6);
  archive.part("state", motion.state);
  archive.group("forces", [&] { motion.forces.carry(archive, scene.air); });
  archive.part("obstacles", motion.obstacles);
  archive.part("contact", motion.contact);
  archive.part("carriers", motion.carriers.memory());
  archive.part("cords", motion.cords);
  archive.part("exact", motion.exact);
  controls.carry(archive);
  archive.part("rest", sleep.rest());
  archive.part("budget", budget);
  if (errors) errors->carry(archive);
  archive.group("hands", [&] { grasps.carry(archive); });
  pins.carry(archive, pattern.grid,
             [this](std::size_t node) { return grasps.scenePins()[node] == kPinned || grasps.willPin(node); });
  archive.part("opening", opening);
  archive.group("statistics", [&] { carryStatistics(archive, motion.statistics); });
  archive.part("clock", motion.clock);
  archive.part("ledger", motion.ledger);
  archive.flag("counts_work", motion.counts_work);
  times.carry(archive);
  guard.carry(archive);
  motion.carryVelocities(archive);
}

// After carry() has loaded: restores what follows from it.
void Simulator::Impl::resume() noexcept {
  grasps.resume();
  pins.resume();
  takePins();
  takeGravity();
  takeFriction();
  takeStretchTolerance();
  takeBudget();
  takeFrame();
  takePositionTolerance();
  opening.resume();
  motion.exact.resume(motion.state);
  motion.contact.skipSubstep();
  motion.contact.clearCaches();
  ++revision;
}

}  // namespace curtain
