// SPDX-License-Identifier: BSD-3-Clause
#include "ros/watch/queue_watch.h"

#include <ros/console.h>
#include <ros/xmlrpc_manager.h>

#include "ros/watch/xmlrpc_call.h"

namespace curtain_ros {

using XmlRpc::XmlRpcValue;

namespace {
constexpr double kWarnPeriod = 5.0;  // [s] between warnings
}

void QueueWatch::look() {
  XmlRpcAnswer answer = callXmlRpc(ros::XMLRPCManager::instance()->getServerURI(), "getBusStats", {});
  if (!answer.answered || answer.value.getType() != XmlRpcValue::TypeArray || answer.value.size() < 2) return;
  const std::uint64_t before = dropped_;
  XmlRpcValue& subscriptions = answer.value[1];  // [published, subscribed]
  if (subscriptions.getType() != XmlRpcValue::TypeArray) return;
  for (int i = 0; i < subscriptions.size(); ++i) {
    if (topics_.count(static_cast<std::string&>(subscriptions[i][0])) == 0) continue;
    XmlRpcValue& connections = subscriptions[i][1];
    for (int k = 0; k < connections.size(); ++k) add(connections[k]);
  }
  if (dropped_ == before) return;
  ROS_WARN_STREAM_THROTTLE(kWarnPeriod, "messages come faster than this process takes them from roscpp: "
                                            << dropped_ << " dropped in its queues so far");
}

void QueueWatch::add(XmlRpcValue& connection) {  // id, bytes, messages, drops, …
  const auto drops = static_cast<std::uint64_t>(static_cast<int&>(connection[3]));
  std::uint64_t& known = by_connection_[static_cast<int&>(connection[0])];
  if (drops > known) dropped_ += drops - known;
  known = drops;
}

}  // namespace curtain_ros
