// SPDX-License-Identifier: BSD-3-Clause
//
// Floor 5: the messages of ~state and ~contacts.
#pragma once

#include <ros/time.h>

#include <cstdint>
#include <optional>
#include <vector>

#include "curtain_sim/Contacts.h"
#include "curtain_sim/CurtainState.h"
#include "ros/outputs/geometry_cache.h"
#include "ros/outputs/message_pool.h"
#include "ros/parameters/parameters.h"

namespace curtain_ros {

/// Node states. One thread at a time.
class StateMessages {
 public:
  /// shape must outlive this.
  StateMessages(const NodeParams& params, Shape& shape);

  /// The message of a frame.
  ///   statistics  the node's own fields; the engine's are filled in
  curtain_sim::CurtainState::ConstPtr build(const ros::Time& stamp, const curtain_sim::Statistics& statistics);

 private:
  void fill(curtain_sim::CurtainState& message);

  Shape& shape_;
  bool folds_;
  std::vector<curtain::Vec3> vectors_;
  MessagePool<curtain_sim::CurtainState, std::optional<std::uint64_t>> pool_;  // content: revision of the arrays
};

/// What the cloth does to the obstacles that are present. One thread at a time.
class ContactMessages {
 public:
  explicit ContactMessages(const NodeParams& params);

  curtain_sim::Contacts::ConstPtr build(const curtain::Simulator& simulator, const ros::Time& stamp);

 private:
  struct Nothing {};  // wrenches are few: filled in each time
  MessagePool<curtain_sim::Contacts, Nothing> pool_;
};

}  // namespace curtain_ros
