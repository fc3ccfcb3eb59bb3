// SPDX-License-Identifier: BSD-3-Clause
//
// What a simulator does for a scene and what it skips, in words.
#pragma once

#include <string>
#include <vector>

namespace curtain {

/// A stage of a frame, or a part of one.
struct PlanEntry {
  std::string stage;  ///< its name
  bool runs = false;  ///< false: it is skipped
  std::string why;    ///< what it does, or why it is skipped

  /// Has the same content.
  bool operator==(const PlanEntry& other) const {
    return stage == other.stage && runs == other.runs && why == other.why;
  }
};

/// In the order of a frame.
using Plan = std::vector<PlanEntry>;

/// A line for each entry: "+ stage: why" for what runs, "- stage: why" for what is skipped.
std::string describe(const Plan& plan);

}  // namespace curtain
