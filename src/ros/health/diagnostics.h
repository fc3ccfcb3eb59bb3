// SPDX-License-Identifier: BSD-3-Clause
//
// /diagnostics, once every ~diagnostic_period of the computer's clock, on a thread of its own; whether anybody listens
// or not, as aggregators expect. The simulation thread reports only when asked: a frame costs the reading of a flag.
#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/node_handle.h>

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <utility>

#include "ros/health/health_checks.h"
#include "ros/time/periodic.h"

namespace curtain_ros {

/// The public functions are for the simulation thread.
class Diagnostics {
 public:
  ///   period           [s], > 0
  ///   clock_simulated  frames follow a /clock that others drive
  Diagnostics(const ros::NodeHandle& node, const ros::NodeHandle& private_node, double period, bool clock_simulated);

  /// Whether answer() is waited for.
  bool wanted() const { return wanted_.load(std::memory_order_relaxed); }

  void answer(Health health) {
    wanted_.store(false, std::memory_order_relaxed);
    const std::lock_guard<std::mutex> lock(mutex_);
    answer_ = std::move(health);
  }

  /// Notes that a frame was made now.
  void frameMade() {
    last_frame_.store(static_cast<std::int64_t>(ros::SteadyTime::now().toNSec()), std::memory_order_relaxed);
  }

 private:
  void add(const std::string& name, Check* check);
  void publish();

  std::atomic<bool> wanted_{true};
  std::atomic<std::int64_t> last_frame_{0};  // [ns]
  std::mutex mutex_;
  Health answer_;

  // Of the thread.
  Health health_;
  Pulse pulse_;
  Rises rises_;
  ros::Time last_clock_;
  diagnostic_updater::Updater updater_;
  std::unique_ptr<Periodic> thread_;  // last: it uses the others
};

}  // namespace curtain_ros
