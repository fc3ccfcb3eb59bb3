// SPDX-License-Identifier: BSD-3-Clause
#include "ros/inputs/moving_winds.h"

#include <ros/console.h>

#include <algorithm>

#include "ros/inputs/read_messages.h"
#include "ros/time/warn_period.h"

namespace curtain_ros {

using curtain_sim::WindSource;

void MovingWinds::note(const WindSource& message) {
  if (message.action == WindSource::DELETEALL) {
    carried_.clear();
  } else if (message.action == WindSource::ADD && message.moves_with_frame) {
    carried_[message.id] = message;
  } else {
    carried_.erase(message.id);
  }
}

void MovingWinds::update(Frames& frames, curtain::Simulator& simulator) {
  for (auto carried = carried_.begin(); carried != carried_.end();) {
    const auto& [id, message] = *carried;
    const std::vector<curtain::WindParams>& winds = simulator.winds();
    const auto found = std::find_if(winds.begin(), winds.end(), [&id = id](const auto& wind) { return wind.id == id; });
    if (found == winds.end()) {  // its lifetime is over
      carried = carried_.erase(carried);
      continue;
    }
    const FrameLookup frame = frames.lookup(message.header.frame_id);
    if (frame.known) {
      curtain::WindParams wind = *found;
      placeWind(message, frame.pose, wind);
      simulator.setWind(wind);  // does nothing where it has not moved
    } else {
      ROS_WARN_STREAM_THROTTLE(kWarnPeriod, "wind source '" << forLog(id) << "' stays where it is: its frame '"
                                                            << forLog(message.header.frame_id) << "' is not known in '"
                                                            << frames.world() << "'");
    }
    ++carried;
  }
}

}  // namespace curtain_ros
