// SPDX-License-Identifier: BSD-3-Clause
//
// Floor 5: ~snapshot_file. The simulation thread takes the bytes, which is quick; a thread that does nothing else
// writes them, so that no frame waits for a disk. One snapshot waits at most: a newer one takes its place, and that is
// counted.
//
// What is restored is simulated time with all that goes by it: winds and drags have as long to go as they had, whatever
// happened meanwhile. Stamps are of now: the time between the runs is not made up for.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "curtain_sim/simulator.h"

namespace curtain_ros {

/// Since the node's start.
struct SnapshotCounts {
  std::uint32_t written = 0;
  std::uint32_t failed = 0;    ///< times that writing failed
  std::uint32_t replaced = 0;  ///< snapshots that a newer one replaced before they were written
  double restored_time = 0.0;  ///< simulated time that the node went on from [s]; 0: it began at the scene's start
};

/// How ~snapshot_file fares.
struct SnapshotHealth {
  bool wanted = false;  ///< there is a ~snapshot_file
  SnapshotCounts counts;
  std::string refused;       ///< why the file that was there was not restored; empty: it was, or there was none
  bool foreign = false;      ///< … and it is no snapshot at all: left alone, none is written
  std::string last_failure;  ///< empty: the last one was written
};

/// Simulation thread only.
class SnapshotKeeper {
 public:
  /// file    empty: nothing is restored or written
  /// period  [s] of the node's clock, > 0
  SnapshotKeeper(const std::string& file, double period);

  /// Writes what still waits.
  ~SnapshotKeeper() { endWriting(); }

  SnapshotKeeper(const SnapshotKeeper&) = delete;
  SnapshotKeeper& operator=(const SnapshotKeeper&) = delete;

  /// Goes on from the file. False: there is none, or it was refused, which is warned of; then nothing changed. A
  /// refused one is put aside (its name and ".refused") before the first one is written, unless it is no snapshot at
  /// all: then none is written.
  bool restore(curtain::Simulator& simulator);

  /// To be called each frame. now  [ns] of the node's clock
  void update(const curtain::Simulator& simulator, std::int64_t now);

  void take(const curtain::Simulator& simulator);

  /// Takes the last one, and returns when it is written.
  void finish(const curtain::Simulator& simulator);

  /// Cheap: for every frame.
  SnapshotCounts counts() const;
  SnapshotHealth health() const;

  /// Whether all that were taken are written, or could not be.
  bool idle() const;

 private:
  bool isForeign(const curtain::Simulator& simulator) const;
  void endWriting();
  void run();
  std::string setAside();
  void write(const std::string& snapshot);

  std::string file_;
  std::int64_t period_;               // [ns]
  std::optional<std::int64_t> next_;  // [ns]; none before the first frame
  bool writes_ = false;               // settled at the start
  bool wanted_ = false;
  std::atomic<std::uint32_t> written_{0};
  std::atomic<std::uint32_t> failed_{0};
  std::uint32_t replaced_ = 0;
  double restored_time_ = 0.0;
  std::string refused_;
  bool foreign_ = false;
  bool set_aside_ = false;  // what is in the file; the writing thread's, once it has something to write

  // Between this thread and the one that writes.
  mutable std::mutex mutex_;
  std::condition_variable signal_;
  std::optional<std::string> waiting_;
  bool writing_ = false;
  bool stop_ = false;
  std::string last_failure_;
  std::thread thread_;
};

}  // namespace curtain_ros
