// SPDX-License-Identifier: BSD-3-Clause
#include "ros/snapshots/snapshot_keeper.h"

#include <ros/console.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <system_error>
#include <utility>

#include "curtain_sim/snapshot_file.h"

namespace curtain_ros {

namespace {
constexpr double kWarnPeriod = 30.0;    // [s] between warnings
constexpr std::size_t kBeginning = 16;  // bytes that all snapshots begin with
constexpr char kAside[] = ".refused";   // behind the name, of a snapshot that could not be gone on from
}  // namespace

SnapshotKeeper::SnapshotKeeper(const std::string& file, double period)
    : file_(file.empty() ? file : std::filesystem::absolute(file).lexically_normal().string()),
      period_(std::llround(1e9 * period)),
      writes_(!file.empty()),
      wanted_(writes_) {
  if (writes_) thread_ = std::thread([this] { run(); });
}

void SnapshotKeeper::finish(const curtain::Simulator& simulator) {
  take(simulator);
  endWriting();
}

void SnapshotKeeper::endWriting() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stop_ = true;
  }
  signal_.notify_all();
  thread_.join();
}

bool SnapshotKeeper::restore(curtain::Simulator& simulator) {
  if (!writes_) return false;
  std::error_code error;
  if (std::filesystem::status(file_, error).type() == std::filesystem::file_type::not_found) {
    ROS_INFO_STREAM("no snapshot yet in " << file_ << ": the curtain begins at the scene's start");
    return false;
  }
  std::string snapshot;
  std::vector<curtain::Problem> problems = curtain::readSnapshotFile(file_, snapshot);
  if (problems.empty()) problems = simulator.restore(snapshot);
  if (!problems.empty()) {
    writes_ = !isForeign(simulator);
    foreign_ = !writes_;
    set_aside_ = writes_;
    refused_ = curtain::describe(problems);
    ROS_WARN_STREAM("can't go on from the snapshot in "
                    << file_ << ", the curtain begins at the scene's start: " << refused_
                    << (writes_ ? "; the first one written puts it aside as " + file_ + kAside
                                : "; it is left alone, and no snapshots are written"));
    return false;
  }
  ROS_INFO_STREAM("goes on from the snapshot in " << file_ << " at " << simulator.time() << " s");
  restored_time_ = simulator.time();
  return true;
}

// Something that is no snapshot, and not nothing either, somebody may still want.
bool SnapshotKeeper::isForeign(const curtain::Simulator& simulator) const {
  std::ifstream stream(file_, std::ios::binary);
  std::string beginning(kBeginning, '\0');
  if (!stream.read(beginning.data(), kBeginning) && stream.gcount() == 0) {
    std::error_code error;
    return !std::filesystem::is_regular_file(file_, error) || std::filesystem::file_size(file_, error) != 0;
  }
  beginning.resize(static_cast<std::size_t>(stream.gcount()));
  return simulator.snapshot().compare(0, beginning.size(), beginning) != 0;
}

void SnapshotKeeper::update(const curtain::Simulator& simulator, std::int64_t now) {
  if (!writes_) return;
  // The first one a period after the start, and after a clock that jumped back.
  if (!next_ || now < *next_ - period_) next_ = now + period_;
  if (now < *next_) return;
  next_ = now + period_;
  take(simulator);
}

void SnapshotKeeper::take(const curtain::Simulator& simulator) {
  if (!writes_) return;
  std::string snapshot = simulator.snapshot();
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (waiting_) ++replaced_;
    waiting_ = std::move(snapshot);
  }
  signal_.notify_all();
}

SnapshotCounts SnapshotKeeper::counts() const { return {written_, failed_, replaced_, restored_time_}; }

SnapshotHealth SnapshotKeeper::health() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return {wanted_, counts(), refused_, foreign_, last_failure_};
}

bool SnapshotKeeper::idle() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return !waiting_ && !writing_;
}

void SnapshotKeeper::run() {
  std::unique_lock<std::mutex> lock(mutex_);
  while (true) {
    signal_.wait(lock, [this] { return waiting_ || stop_; });
    if (!waiting_) return;
    const std::string snapshot = std::move(*waiting_);
    waiting_.reset();
    writing_ = true;
    lock.unlock();
    write(snapshot);
    lock.lock();
    writing_ = false;
  }
}

// What was refused is somebody's state still: the wrong scene was started, or another version.
std::string SnapshotKeeper::setAside() {
  if (!set_aside_) return "";
  std::error_code error;
  std::filesystem::copy_file(file_, file_ + kAside, std::filesystem::copy_options::overwrite_existing, error);
  if (error && error != std::errc::no_such_file_or_directory)
    return file_ + kAside + ": cannot be written: " + error.message();
  set_aside_ = false;
  return "";
}

void SnapshotKeeper::write(const std::string& snapshot) {
  std::string failure = setAside();
  if (failure.empty()) {
    const std::vector<curtain::Problem> problems = curtain::writeSnapshotFile(file_, snapshot);
    if (!problems.empty()) failure = curtain::describe(problems);
  }
  if (!failure.empty()) ROS_WARN_STREAM_THROTTLE(kWarnPeriod, "the snapshot could not be written: " << failure);
  const std::lock_guard<std::mutex> lock(mutex_);
  last_failure_ = failure;
  ++(failure.empty() ? written_ : failed_);
}

}  // namespace curtain_ros
