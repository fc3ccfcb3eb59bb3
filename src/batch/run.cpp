// SPDX-License-Identifier: BSD-3-Clause
#include "batch/run.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <optional>

#include "simulator/export.h"

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
    open(options.out, progress_.states, &curtain::writeStateHeader, states_);
    open(options.wrenches, progress_.wrenches, &curtain::writeWrenchHeader, wrenches_);
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
      if (wrenches_) wrenches_->add([this](std::ostream& out) { curtain::writeWrenches(simulator_, out); });
      write();
      if (options_.progress && frames() % static_cast<std::size_t>(std::max(1.0, rate_)) == 0) {
        std::cerr << "t = " << simulator_.time() << " s, " << simulator_.statistics().substeps_last << " substeps\n";
      }
    }
    for (std::optional<TableFile>* const table : {&states_, &wrenches_}) {
      if (*table) (*table)->flush();
    }
  }

  Progress progress() { return std::move(progress_); }

 private:
  void open(const std::string& path, const TableMark& mark, void (*header)(std::ostream&),
            std::optional<TableFile>& table) const {
    if (path.empty()) return;
    if (resumed_) {
      table.emplace(path, mark);
    } else {
      table.emplace(path);
      table->add(header);
    }
  }
  void addState() {
    states_->add([this](std::ostream& out) { curtain::writeState(simulator_, out); });
  }

  std::size_t framesIn(double seconds) const { return static_cast<std::size_t>(std::ceil(seconds * rate_ - 1e-6)); }
  bool keepsCheckpoints() const { return !options_.checkpoint.empty(); }

  std::size_t frames() const { return progress_.sums.frame_seconds.size(); }
  bool isOver() const { return frames() >= framesIn(options_.duration) || !simulator_.statistics().finite; }

  // What is due after a frame, or at the start.
  void write() {
    for (; sampleIsDue(); ++next_) {
      if (states_) addState();
    }
    if (states_ && options_.samples.empty() && isOver()) addState();
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
    // Before the checkpoint that counts on them.
    if (states_) progress_.states = states_->toDisk();
    if (wrenches_) progress_.wrenches = wrenches_->toDisk();
    writeCheckpoint(options_.checkpoint, identity_, simulator_, progress_);
  }

  const Options& options_;
  curtain::Simulator& simulator_;
  double rate_;        // frames a second
  std::size_t every_;  // frames between two checkpoints
  RunIdentity identity_;
  Progress progress_;
  std::optional<TableFile> states_, wrenches_;
  std::size_t next_ = 0;  // of the samples
  bool resumed_ = false;
};

}  // namespace

Progress makeRun(const Options& options, curtain::Simulator& simulator) {
  Run run(options, simulator);
  run.make();
  return run.progress();
}

}  // namespace curtain_batch
