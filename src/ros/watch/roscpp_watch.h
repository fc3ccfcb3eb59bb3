// SPDX-License-Identifier: BSD-3-Clause
//
// Watches, once a second, two things inside roscpp that it does not report. Optional (~watch_roscpp): the node works
// without it.
//
//   restarted master   Connections outlive a master, but a new one knows no node, and no new subscriber finds this one.
//                      Roscpp does not register again; this does: topics, services, private parameters.
//                      A name that now belongs to another node is left alone: roscpp is about to shut this one down.
//   dropped messages   Roscpp counts per connection what its receiving queues dropped, in its bus statistics.
//
// Both take XML-RPC, to the master and to this process, with a time limit: roscpp's own calls wait for ever.
#pragma once

#include <xmlrpcpp/XmlRpcValue.h>

#include <atomic>
#include <cstdint>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "ros/time/periodic.h"

namespace curtain_ros {

/// Of the whole process: other nodelets' topics are registered again, too. All functions are thread-safe.
class RoscppWatch {
 public:
  /// Starts watching, on a thread of its own. The destructor waits for a check under way: some seconds at most.
  ///   private_space  parameters below it are kept for a new master
  ///   topics         resolved names of the subscriptions whose dropped messages count
  ///   services       resolved names of the node's services, for a new master
  ///   registered     called, by the watch's thread, when a new master knows the node again
  RoscppWatch(const std::string& private_space, const std::vector<std::string>& topics,
              const std::vector<std::string>& services, std::function<void()> registered);

  /// Whether the master answered when it was last asked.
  bool masterAnswers() const { return answers_; }
  /// Times that a master had forgotten the node.
  std::uint32_t mastersLost() const { return lost_; }
  /// Messages dropped in roscpp's queues. What a connection dropped in its last second is not seen.
  std::uint64_t droppedMessages() const { return dropped_; }

 private:
  void checkMaster();
  void checkQueues();
  void logWhetherMasterAnswers(bool answers);
  bool registerAll() const;
  bool registerServices() const;

  std::string private_space_;
  XmlRpc::XmlRpcValue parameters_;
  std::set<std::string> topics_;
  std::vector<std::string> services_;
  std::function<void()> registered_;
  bool forgotten_ = false;                              // by the master, and not yet registered again
  std::map<int, std::uint64_t> dropped_by_connection_;  // as roscpp counts
  std::atomic<bool> answers_{true};
  std::atomic<std::uint32_t> lost_{0};
  std::atomic<std::uint64_t> dropped_{0};
  Periodic thread_;  // last: it uses the others
};

}  // namespace curtain_ros
