// SPDX-License-Identifier: BSD-3-Clause
//
// Floor 5: how many messages roscpp itself dropped, because they came faster than this process took them out of its
// queues. roscpp counts them for each connection and tells whoever asks for its bus statistics; what a sender's queue
// dropped nobody here can know.
#pragma once

#include <xmlrpcpp/XmlRpcValue.h>

#include <atomic>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace curtain_ros {

class QueueWatch {
 public:
  /// topics  resolved names
  explicit QueueWatch(const std::vector<std::string>& topics) : topics_(topics.begin(), topics.end()) {}

  /// Asks, and warns when there are more. One thread at a time; to be called about once a second: a connection that is
  /// gone takes with it what it dropped since the last look.
  void look();

  /// Messages dropped since construction. Any thread.
  std::uint64_t dropped() const { return dropped_; }

 private:
  void add(XmlRpc::XmlRpcValue& connection);

  std::set<std::string> topics_;
  std::map<int, std::uint64_t> by_connection_;
  std::atomic<std::uint64_t> dropped_{0};
};

}  // namespace curtain_ros
