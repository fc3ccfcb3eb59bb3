// SPDX-License-Identifier: BSD-3-Clause
//
// ~layers and ~layers/NAME/state: of a scene with several cloths each by itself, cut out of the message of ~state,
// which has all of them side by side.
#pragma once

#include <ros/node_handle.h>
#include <ros/publisher.h>

#include <cstdint>
#include <vector>

#include "curtain_sim/CurtainState.h"
#include "curtain_sim/simulator.h"
#include "ros/outputs/reused_message.h"
#include "ros/time/pace.h"

namespace curtain_ros {

/// The part of a state that columns [first, first + columns) are, with its winds and statistics.
///   warp_rest  of these columns
void cutOut(const curtain_sim::CurtainState& whole, std::uint32_t first, std::uint32_t columns,
            const std::vector<float>& warp_rest, curtain_sim::CurtainState& out);

/// Simulation thread only. Advertises nothing where there is one cloth.
class LayerStates {
 public:
  LayerStates(ros::NodeHandle& node, const curtain::Simulator& simulator, std::uint32_t queue, const Pace& pace);

  void setRates(double rate, double rest_rate, double frame_rate);
  /// To be called each frame. True: somebody is due a state of this revision; publish() is to follow.
  bool due(std::uint64_t revision);
  /// To whom it is due.
  void publish(const curtain_sim::CurtainState& whole);

 private:
  struct Stream {
    ros::Publisher publisher;
    Pace pace;
    std::uint32_t first, columns;
    std::vector<float> warp_rest;
    bool due;
    ReusedMessage<curtain_sim::CurtainState> message;
  };

  ros::Publisher names_;
  std::vector<Stream> streams_;
};

}  // namespace curtain_ros
