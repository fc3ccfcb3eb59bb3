// SPDX-License-Identifier: BSD-3-Clause
//
// Floor 5: what becomes of the node when the ROS master is restarted. Connections that are there go on without a
// master, but a new one knows nobody, and roscpp does not tell it: nobody new would ever find the node again. So the
// node asks once a second whether it is known, and tells a master that has forgotten it what it publishes, subscribes
// to and serves, and its own parameters. A name that is registered to another node is left to that one: roscpp is about
// to shut this one down.
#pragma once

#include <xmlrpcpp/XmlRpcValue.h>

#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

namespace curtain_ros {

class MasterWatch {
 public:
  /// Of the whole process: what its other nodelets publish is told a new master too.
  ///   private_space  whose parameters are kept for a new master
  explicit MasterWatch(const std::string& private_space);

  /// Asks the master, and tells it everything when it has forgotten the node. One thread at a time; to be called about
  /// once a second; ends within seconds even if the master hangs.
  void look();

  /// False: it did not answer when it was last asked. Any thread.
  bool answers() const { return answers_; }

  /// Times that the node was registered again. Any thread.
  std::uint32_t lost() const { return lost_; }

 private:
  using Values = std::vector<XmlRpc::XmlRpcValue>;

  void sayWhetherItAnswers(bool answers);
  bool registerAll();
  bool registerPublishers(int& count) const;
  bool registerSubscribers(int& count) const;
  bool tellPublishers(const std::string& topic, const XmlRpc::XmlRpcValue& publishers) const;
  bool registerServices() const;
  bool restoreParameters() const;
  void rememberServices();

  std::string private_space_;
  XmlRpc::XmlRpcValue parameters_;
  std::vector<std::string> services_;
  int looks_ = 0;
  bool forgotten_ = false;  // and not yet told everything
  std::atomic<bool> answers_{true};
  std::atomic<std::uint32_t> lost_{0};
};

}  // namespace curtain_ros
