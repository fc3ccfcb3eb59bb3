// SPDX-License-Identifier: BSD-3-Clause
#include "batch/run.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <optional>

namespace curtain_batch {
namespace {

class Run {
 public:
  Run(const Options& options, curtain::Simulator& simulator)
      : options_(options),
        simulator_(simulator),
        rate_(simulator.scene().solver.frame_rate),
        every_(std::max<std::size_t>(framesIn(options.every), 1)) {
    progress_.sums.initial = simulator.energy();
    if (keepsCheckpoints()) {
      identity_ = identityOf(options, simulator);
      resumed_ = readCheckpoint(options.checkpoint, identity_, simulator, progress_);
      for (const std::string& file : {options.checkpoint, options.mesh, options.stats, options.save}) {
        if (!file.empty()) removeLeftovers(file);
      }
    }
    progress_.sums.frame_seconds.reserve(std::min<std::size_t>(framesIn(options.duration), 1000000));
    if (options.out.empty()) return;
    if (resumed_)
      states_.emplace(options.out, progress_.states);
    else
      states_.emplace(options.out);
  }

  void make() {
    if (resumed_) {
      std::cerr << "curtain_batch: " << options_.checkpoint << (isOver() ? ": was done" : ": goes on")
                << " at t = " << simulator_.time() << " s\n";
      skipSamples();
    } else {
      write();  // a checkpoint, too: that it can't be written shows now
    }
    while (!isOver()) {
      simulator_.step();
      progress_.sums.add(simulator_);
      write();
      if (options_.progress && frames() % static_cast<std::size_t>(std::max(1.0, rate_)) == 0) {
        std::cerr << "t = " << simulator_.time() << " s, " << simulator_.statistics().substeps_last << " substeps\n";
      }
    }
    if (states_) states_->flush();
  }

  Progress takeProgress() { return std::move(progress_); }

 private:
  std::size_t framesIn(double seconds) const { return static_cast<std::size_t>(std::ceil(seconds * rate_ - 1e-6)); }
  bool keepsCheckpoints() const { return !options_.checkpoint.empty(); }

  std::size_t frames() const { return progress_.sums.frame_seconds.size(); }
  bool isOver() const { return frames() >= framesIn(options_.duration) || !simulator_.statistics().finite; }

  // What is due after a frame, or at the start.
  void write() {
    for (; sampleIsDue(); ++next_) {
      if (states_) states_->add(simulator_);
    }
    if (states_ && options_.samples.empty() && isOver()) states_->add(simulator_);
    if (keepsCheckpoints() && (isOver() || frames() % every_ == 0)) keep();
  }

  bool sampleIsDue() const {
    return next_ < options_.samples.size() && options_.samples[next_] <= simulator_.time() + 1e-6 / rate_;
  }
  // Those that the file has already.
  void skipSamples() {
    while (sampleIsDue()) ++next_;
  }

  // From what is not finite nothing goes on.
  void keep() {
    if (!simulator_.statistics().finite) return;
    if (states_) progress_.states = states_->toDisk();  // before the checkpoint that counts on it
    writeCheckpoint(options_.checkpoint, identity_, simulator_, progress_);
  }

  const Options& options_;
  curtain::Simulator& simulator_;
  double rate_;        // frames a second
  std::size_t every_;  // frames between two checkpoints
  RunIdentity identity_;
  Progress progress_;
  std::optional<StatesFile> states_;
  std::size_t next_ = 0;  // of the samples
  bool resumed_ = false;
};

}  // namespace

Progress makeRun(const Options& options, curtain::Simulator& simulator) {
  Run run(options, simulator);
  run.make();
  return run.takeProgress();
}

}  // namespace curtain_batch
