// SPDX-License-Identifier: BSD-3-Clause
#include "ros/snapshots/snapshot_keeper.h"

#include <ros/console.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <system_error>
#include <utility>

#include "curtain_sim/snapshot_file.h"
#include "ros/time/warn_period.h"

namespace curtain_ros {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kSignature = 16;  // bytes that all snapshots begin with
constexpr char kAside[] = ".refused";   // added to the name of a refused snapshot

// Whether the file begins like a snapshot, as far as it goes; what does not, somebody may still want.
bool beginsLike(const std::string& file, const std::string& snapshot) {
  std::ifstream stream(file, std::ios::binary);
  std::string signature(kSignature, '\0');
  stream.read(signature.data(), kSignature);
  signature.resize(static_cast<std::size_t>(stream.gcount()));
  return snapshot.compare(0, signature.size(), signature) == 0;
}

// Returns why it failed. What was refused is somebody's state still: the wrong scene was started, or another version.
std::string write(const std::string& file, const std::string& snapshot, bool put_aside) {
  std::error_code error;
  if (put_aside) fs::copy_file(file, file + kAside, fs::copy_options::overwrite_existing, error);
  if (error && error != std::errc::no_such_file_or_directory) {
    return file + kAside + ": cannot be written: " + error.message();
  }
  return curtain::describe(curtain::writeSnapshotFile(file, snapshot));
}

}  // namespace

SnapshotKeeper::SnapshotKeeper(const std::string& file, double period)
    : file_(file.empty() ? file : fs::absolute(file).lexically_normal().string()), period_(std::llround(1e9 * period)) {
  health_.wanted = !file.empty();
}

bool SnapshotKeeper::restore(curtain::Simulator& simulator) {
  if (!writes()) return false;
  std::error_code error;
  if (fs::status(file_, error).type() == fs::file_type::not_found) {
    ROS_INFO_STREAM("no snapshot yet in " << file_ << ": starting from the scene");
    return false;
  }
  std::string snapshot;
  std::vector<curtain::Problem> problems = curtain::readSnapshotFile(file_, snapshot);
  if (problems.empty()) problems = simulator.restore(snapshot);
  if (problems.empty()) {
    health_.restored_time = simulator.time();
    ROS_INFO_STREAM("restored the snapshot in " << file_ << ", taken at " << simulator.time() << " s");
    return true;
  }
  put_aside_ = beginsLike(file_, simulator.snapshot());
  health_.foreign = !put_aside_;
  health_.refused = curtain::describe(problems);
  ROS_WARN_STREAM("can't restore the snapshot in "
                  << file_ << ", starting from the scene: " << health_.refused
                  << (put_aside_ ? "; it is kept as " + file_ + kAside + " when the first one is written"
                                 : "; it is no snapshot: it is left as it is, and none is written"));
  return false;
}

void SnapshotKeeper::update(const curtain::Simulator& simulator, std::int64_t now) {
  if (!writes()) return;
  collect();
  // The first one a period after the start, and after a clock that jumped back.
  if (!next_ || now < *next_ - period_) next_ = now + period_;
  if (now < *next_) return;
  next_ = now + period_;
  keep(simulator);
}

void SnapshotKeeper::keep(const curtain::Simulator& simulator) {
  if (!writes()) return;
  collect();
  if (!writing_.valid()) {
    startWriting(simulator.snapshot());
  } else {
    if (waiting_) ++health_.replaced;
    waiting_ = simulator.snapshot();
  }
}

void SnapshotKeeper::finish(const curtain::Simulator& simulator) {
  keep(simulator);
  drain();
}

bool SnapshotKeeper::idle() {
  collect();
  return !writing_.valid();
}

void SnapshotKeeper::count(curtain_sim::Statistics& statistics) const {
  statistics.restored_time = health_.restored_time;
  statistics.snapshots_written = health_.written;
  statistics.snapshots_failed = health_.failed;
  statistics.snapshots_replaced = health_.replaced;
}

void SnapshotKeeper::startWriting(std::string snapshot) {
  try {
    writing_ = std::async(std::launch::async, [file = file_, bytes = std::move(snapshot), aside = put_aside_] {
      return write(file, bytes, aside);
    });
  } catch (const std::system_error& error) {  // there is no thread to be had
    note(file_ + ": cannot be written: " + error.code().message());
  }
}

// Starts the one that waits when a write has ended.
void SnapshotKeeper::collect() {
  if (!writing_.valid() || writing_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
  note(writing_.get());
  if (waiting_) startWriting(std::move(*waiting_));
  waiting_.reset();
}

void SnapshotKeeper::note(std::string failure) {
  health_.last_failure = std::move(failure);
  if (health_.last_failure.empty()) {
    ++health_.written;
    put_aside_ = false;
  } else {
    ++health_.failed;
    ROS_WARN_STREAM_THROTTLE(kWarnPeriod, "the snapshot could not be written: " << health_.last_failure);
  }
}

void SnapshotKeeper::drain() {
  while (writing_.valid()) {
    writing_.wait();
    collect();
  }
}

}  // namespace curtain_ros
