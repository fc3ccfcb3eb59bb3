// SPDX-License-Identifier: BSD-3-Clause
//
// Floor 5: how the node is, as the simulation thread tells it to the thread of the diagnostics. It does so only when it
// was asked, about once a second, so that a frame pays for nothing but the look at a flag.
#pragma once

#include <ros/time.h>

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "curtain_sim/Statistics.h"
#include "ros/obstacles/obstacle_tracker.h"
#include "ros/snapshots/snapshot_keeper.h"

namespace curtain_ros {

/// Of one moment.
struct Health {
  curtain_sim::Statistics statistics;
  double stretch_tolerance = 0.0;  ///< of the scene, relative
  double frame_rate = 0.0;         ///< [1/s]
  std::vector<ObstacleHealth> obstacles;
  SnapshotHealth snapshots;
  std::string last_drop;     ///< which message was dropped last, and why; empty: none
  std::string viewer_error;  ///< why the frame of ~mesh's viewer is not known; empty: it is, or none is asked for
};

/// Where one thread asks for it and the simulation thread answers. Thread-safe.
class HealthDesk {
 public:
  /// What the last answer was, or nothing when there was none yet; and asks for another one.
  std::shared_ptr<const Health> ask() {
    wanted_.store(true, std::memory_order_relaxed);
    const std::lock_guard<std::mutex> lock(mutex_);
    return health_;
  }

  /// Whether somebody asked since the last answer. Costs next to nothing.
  bool wanted() const { return wanted_.load(std::memory_order_relaxed); }

  void answer(Health health) {
    auto made = std::make_shared<const Health>(std::move(health));
    wanted_.store(false, std::memory_order_relaxed);
    const std::lock_guard<std::mutex> lock(mutex_);
    health_.swap(made);
  }

  /// Remembers when a frame was made.
  void frameMade(const ros::SteadyTime& now) {
    last_frame_.store(static_cast<std::int64_t>(now.toNSec()), std::memory_order_relaxed);
  }

  /// When the last frame was made; zero: none yet.
  ros::SteadyTime lastFrame() const {
    return ros::SteadyTime().fromNSec(static_cast<std::uint64_t>(last_frame_.load(std::memory_order_relaxed)));
  }

 private:
  std::atomic<bool> wanted_{true};
  std::atomic<std::int64_t> last_frame_{0};  // [ns]
  std::mutex mutex_;
  std::shared_ptr<const Health> health_;
};

}  // namespace curtain_ros
