// SPDX-License-Identifier: BSD-3-Clause
//
// ~snapshot_file. The simulation thread takes a snapshot, which is quick; another thread writes it, so that no frame
// waits for a disk. At most one waits: a newer one replaces it, which is counted.
//
// Simulated time is restored, too: winds and drags have the rest of their lifetimes. Stamps are of now: the time
// between the runs is not made up for.
#pragma once

#include <cstdint>
#include <future>
#include <optional>
#include <string>

#include "curtain_sim/Statistics.h"
#include "curtain_sim/simulator.h"

namespace curtain_ros {

/// What became of ~snapshot_file, since the node's start.
struct SnapshotHealth {
  bool wanted = false;       ///< there is a ~snapshot_file
  std::string refused;       ///< why the file that was there was not restored; empty: it was, or there was none
  bool foreign = false;      ///< … and it is no snapshot at all: left alone, none is written
  std::string last_failure;  ///< empty: the last one was written
  std::uint32_t written = 0;
  std::uint32_t failed = 0;    ///< times that writing failed
  std::uint32_t replaced = 0;  ///< snapshots that a newer one replaced before they were written
  double restored_time = 0.0;  ///< simulated time that was restored [s]; 0: started from the scene
};

/// Simulation thread only.
class SnapshotKeeper {
 public:
  /// file    empty: nothing is restored or written
  /// period  [s] of the node's clock, > 0
  SnapshotKeeper(const std::string& file, double period);

  /// Waits until what was taken is written.
  ~SnapshotKeeper() { drain(); }

  SnapshotKeeper(const SnapshotKeeper&) = delete;
  SnapshotKeeper& operator=(const SnapshotKeeper&) = delete;

  /// Restores the simulator from the file. False: there is none, or it was refused, with a warning; then nothing
  /// changed. A refused one is put aside (its name and ".refused") before the first one is written; a file that is no
  /// snapshot is left alone, and none is written.
  bool restore(curtain::Simulator& simulator);

  /// To be called after each frame. now  [ns] of the node's clock
  void update(const curtain::Simulator& simulator, std::int64_t now);

  void keep(const curtain::Simulator& simulator);

  /// Takes the last one, and returns when it is written.
  void finish(const curtain::Simulator& simulator);

  const SnapshotHealth& health() const { return health_; }
  void count(curtain_sim::Statistics& statistics) const;

  /// Whether all that were taken are written, or could not be.
  bool idle();

 private:
  bool writes() const { return health_.wanted && !health_.foreign; }
  void startWriting(std::string snapshot);
  void collect();
  /// A write has ended. failure: why; empty: it is written.
  void note(std::string failure);
  void drain();

  std::string file_;
  std::int64_t period_;               // [ns]
  std::optional<std::int64_t> next_;  // [ns]; none before the first frame
  bool put_aside_ = false;            // what is in the file, before the next one is written
  std::optional<std::string> waiting_;
  std::future<std::string> writing_;  // why it failed; empty: it is written
  SnapshotHealth health_;
};

}  // namespace curtain_ros
