// SPDX-License-Identifier: BSD-3-Clause
//
// Serialization of what a simulator is made of; that of lower floors is in src/*/serialize.cpp, of parts in their own.
#include <limits>

#include "cloth/archive_params.h"
#include "scene/infinity.h"
#include "simulator/simulator_impl.h"

namespace curtain {
namespace {

constexpr double kLargestNumber = std::numeric_limits<double>::max();
constexpr double kMinNumber = std::numeric_limits<double>::min();
constexpr std::int64_t kCount = 1 << 30;  // bound of counters: adding to them can't overflow an int
constexpr std::int64_t kMaxCount = std::int64_t{1} << 53;

void serializeStatistics(Archive& archive, Statistics& s) {
  for (std::int64_t* const count : {&s.frames, &s.substeps, &s.sweeps, &s.rejected, &s.last_resort_substeps,
                                    &s.unsettled, &s.asleep_frames, &s.wakes, &s.estimates_skipped, &s.longer_substeps,
                                    &s.unfinished_substeps, &s.shortened_frames, &s.late_frames, &s.stops})
    archive.integer("count", *count, 0, kMaxCount);
  for (int* const count : {&s.substeps_last, &s.sweeps_last, &s.stops_last, &s.contacts, &s.contacts_max})
    archive.integer("count_last", *count, 0, kCount);
  for (double* const number : {&s.time, &s.lost_time, &s.momentum_cut, &s.momentum_cut_last, &s.obstacles_waited,
                               &s.warp_stretch, &s.weft_stretch, &s.warp_compression, &s.warp_stretch_max,
                               &s.weft_stretch_max, &s.warp_compression_max, &s.penetration_max, &s.step_seconds,
                               &s.step_seconds_max, &s.step_seconds_sum, &s.position_error, &s.opening, &s.drive_force})
    archive.number("number", *number);
  archive.integer("quality", s.quality, 0, kFrameQualityCount - 1);
  for (bool* const flag : {&s.asleep, &s.finite}) archive.flag("flag", *flag);
  for (double& seconds : s.stage_seconds) archive.number("stage_seconds", seconds);
}

}  // namespace

// The last forces are needed for velocities that lag behind the positions.
void ForceField::serialize(Archive& archive) {
  bool more_than_weight = forces_.force == &sum_.force;
  archive.atOnce([&] { archive.flag("more_than_weight", more_than_weight); });
  archive.numbers("sum", sum_.force);
  archive.flag("weight_only", forces_.weight_only);
  archive.numbers("gravity", forces_.gravity);
  archive.numbers("damping", forces_.damping);
  archive.flag("has_damping", forces_.has_damping);
  archive.put(forces_.force, static_cast<const Field3*>(more_than_weight ? &sum_.force : &weight_));
}

void Rest::serialize(Archive& archive) {
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
  archive.integer("wakes", wakes_, 0, kMaxCount);
}

// Members of the present frame are set by the next one.
void Budget::serialize(Archive& archive) {
  archive.within("substep", substep_, 0.0, kLargestNumber);
  archive.within("companion", reference_, 0.0, kLargestNumber);
  archive.within("tail", tail_, 0.0, kLargestNumber);
  archive.within("frame", frame_, 0.0, kLargestNumber);
  archive.integer("stalled", stalled_, 0, kCount);
}

void ErrorEstimate::serialize(Archive& archive) {
  archive.within("frame_length", frame_length_, 1e-6, 1e3);
  archive.integer("window", window_, 1, kCount);
  archive.flag("of_stages", of_stages_);
  archive.integer("substeps", substeps_, fewest_, most_);
  archive.integer("frames", frames_, 0, kMaxCount);
  archive.integer("compared", compared_, 0, kCount);
  archive.within("steps_sum", steps_sum_, 0.0, kLargestNumber);
  archive.within("companion_sum", reference_sum_, 0.0, kLargestNumber);
  archive.within("now", now_, 0.0, kInfinity);
  archive.within("last_second", last_second_, 0.0, kInfinity);
}

// Names are part of the layout: they stay when members are renamed.
void ErrorControl::Reference::serialize(Archive& archive) {
  archive.part("state", at.state);
  archive.part("memory", at.memory);
  archive.integer("substeps", substeps, 0, kCount);
  archive.integer("steps", tally.steps, 0, kCount);
  archive.flag("of_stages", tally.of_stages);
  archive.flag("lost", lost);
  archive.flag("in_finer_steps", in_finer_steps);
}

void ErrorControl::serialize(Archive& archive) {
  archive.part("estimate", estimate_);
  archive.part("companion", reference_);
}

void StepControls::serialize(Archive& archive) {
  archive.part("control", main);
  archive.integer("plain_frames", plain_frames, 0, kCount);
  archive.part("plain_control", plain);
}

void FrameTimes::serialize(Archive& archive) {
  archive.integer("frame", frame_, 0, kMaxCount);
  archive.within("frame_rate", rate_, 1.0, 10000.0);
  archive.integer("same_since_frame", since_.frame, 0, kMaxCount);
  archive.finite("same_since_time", since_.time);
  archive.finite("made_time", made_time_);
}

void Motion::serializeVelocities(Archive& archive) {
  archive.numbers("velocities", velocities_);
  archive.flag("velocities_fresh", velocities_fresh_);
}

// Not serialized: checkpoints, which are written before they are read; the fine mesh, which has no memory; the
// revision, which belongs to this simulator's users.
void Simulator::Impl::serialize(Archive& archive) {
  archive.finite("gravity", scene.gravity);
  AirParams air = scene.air;
  archive.group("air", [&] { serializeParams(archive, air); });
  archive.put(scene.air, air);
  archive.within("friction", scene.contact.friction, 0.0, 10.0);
  archive.within("stretch_tolerance", scene.solver.stretch_tolerance, 1e-12, 0.1);
  if (errors) archive.within("position_tolerance", scene.solver.position_tolerance, kMinNumber, 1.0);
  archive.within("budget_ms", scene.solver.budget_ms, 0.0, 1e6);
  archive.part("state", motion.state);
  archive.group("parts", [&] {
    for (Part* const part : motion.parts.all) part->serialize(archive);
  });
  archive.part("forces", motion.forces);
  archive.part("obstacles", motion.obstacles);
  archive.part("contact", motion.contact);
  archive.part("exact", motion.step);
  controls.serialize(archive);
  archive.part("rest", sleep.rest());
  archive.part("budget", budget);
  if (errors) errors->serialize(archive);
  archive.group("statistics", [&] { serializeStatistics(archive, motion.statistics); });
  archive.part("clock", motion.clock);
  archive.flag("counts_work", motion.counts_work);
  times.serialize(archive);
  motion.serializeVelocities(archive);
}

// After serialize() has loaded: restores what follows from it.
void Simulator::Impl::resume() noexcept {
  keysChanged();
  pinsChanged();
  motion.step.resume(motion.state);
  motion.contact.skipSubstep();
  motion.contact.clearCaches();
  ++revision;
}

}  // namespace curtain
