// SPDX-License-Identifier: BSD-3-Clause
//
// Serialization of the solver for snapshots. Left out is what every substep writes before it reads it (prediction,
// directions, multipliers being solved for, all of NetSolver) and what follows from the scene.
#include <limits>

#include "cloth/archive.h"
#include "step/step.h"
#include "step/step_control.h"

namespace curtain {
namespace {

constexpr int kCount = 1 << 30;  // bound of counters that are read back: adding to them can't overflow an int

}  // namespace

void NodeInertia::Tensions::serialize(Archive& archive) {
  archive.numbers("load", load);
  archive.number("heaviest", heaviest);
  archive.number("scale", scale);
}

void Constraints::Memory::serialize(Archive& archive) {
  archive.numbers("warp", warp);
  archive.numbers("weft", weft);
  archive.flag("weft_pulls", weft_pulls);
  archive.part("distances", distances);
}

void DistanceRows::Memory::serialize(Archive& archive) { archive.numbers("last", last); }

void DistanceRows::serialize(Archive& archive) {
  for (DistanceRow& row : all_) archive.number("last", row.last);
}

void Step::Memory::serialize(Archive& archive) {
  archive.part("constraints", constraints);
  archive.part("tensions", tensions);
  archive.number("held", held);
  archive.flag("left_off", left_off);
  archive.finite("guide", guide);
  archive.finite("elastic", elastic);
}

void Constraints::serialize(Archive& archive) {
  archive.numbers("last_warp", last_warp_);
  archive.numbers("last_weft", last_weft_);
  archive.flag("weft_pulls", weft_pulls_);
  archive.part("distances", distances_);
}

void Step::serialize(Archive& archive) {
  archive.part("constraints", constraints_);
  archive.part("tensions", inertia_.tensions());
  archive.part("account", account_);
  archive.flag("left_off", left_off_);
}

void Step::resume(const ClothState& state) noexcept { constraints_.resume(state); }

// The ranges bound the number of substeps in a frame; next() clamps the other numbers itself.
void StepControl::serialize(Archive& archive) {
  double frame = frame_;
  archive.atOnce([&] { archive.within("frame", frame, 1e-6, 1e3); });
  archive.put(frame_, frame);
  archive.number("omega", omega_);
  archive.number("turning", turning_);
  archive.number("last_step", last_step_);
  archive.number("heavier_step", scaled_step_);
  archive.number("surface_step", surface_step_);
  archive.number("limit", limit_);
  archive.integer("allowed", allowed_, 1, std::numeric_limits<int>::max());
  archive.flag("stretched", stretched_);
  archive.integer("asked", asked_, 1, max_substeps_);
  archive.part("trust", trust_);
  archive.integer("good", good_, 0, kCount);
}

}  // namespace curtain
