// SPDX-License-Identifier: BSD-3-Clause
//
// Snapshots are taken by the node's clock, written by another thread, and all are accounted for; what is no snapshot is
// left alone.
#include "ros/snapshots/snapshot_keeper.h"

#include <gtest/gtest.h>
#include <pthread.h>
#include <ros/time.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "curtain_sim/scene_yaml.h"

namespace curtain_ros {
namespace {

constexpr std::int64_t kSecond = 1000000000;

curtain::Simulator makeSimulator(int rows = 10) {
  return curtain::Simulator(
      curtain::readSceneText("cloth: {rows: " + std::to_string(rows) + ", columns: 8}\npins: left\n").scene);
}

// A folder of its own for each test.
class SnapshotKeeperTest : public ::testing::Test {
 protected:
  SnapshotKeeperTest() {
    ros::Time::init();  // for warnings that are throttled
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::temp_directory_path() /
              ("curtain_" + std::string(test->name()) + "_" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder_);
    file_ = (folder_ / "curtain.snapshot").string();
  }
  ~SnapshotKeeperTest() override { std::filesystem::remove_all(folder_); }

  std::string content(const std::string& suffix = "") const {
    std::ifstream stream(file_ + suffix, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  }
  void put(const std::string& bytes) const { std::ofstream(file_, std::ios::binary) << bytes; }

  std::filesystem::path folder_;
  std::string file_;
};

TEST_F(SnapshotKeeperTest, WithoutAFileDoesNothing) {
  curtain::Simulator simulator = makeSimulator();
  SnapshotKeeper keeper("", 1.0);
  EXPECT_FALSE(keeper.restore(simulator));
  keeper.update(simulator, 0);
  keeper.update(simulator, 10 * kSecond);
  keeper.keep(simulator);
  EXPECT_FALSE(keeper.health().wanted);
  EXPECT_TRUE(std::filesystem::is_empty(folder_));
}

TEST_F(SnapshotKeeperTest, GoesOnFromTheLastOne) {
  curtain::Simulator simulator = makeSimulator();
  for (int i = 0; i < 20; ++i) simulator.step();
  {
    SnapshotKeeper keeper(file_, 10.0);
    EXPECT_FALSE(keeper.restore(simulator)) << "there is none yet";
    EXPECT_TRUE(keeper.health().refused.empty());
    keeper.keep(simulator);
  }
  curtain::Simulator other = makeSimulator();
  SnapshotKeeper keeper(file_, 10.0);
  ASSERT_TRUE(keeper.restore(other));
  EXPECT_EQ(other.stateHash(), simulator.stateHash());
  EXPECT_EQ(keeper.health().restored_time, simulator.time());
}

// The stack of a thread that is larger than what there is of addresses: none can be started.
TEST_F(SnapshotKeeperTest, WithoutAThreadTheWriteFailsAndTheNextOneIsTried) {
  const curtain::Simulator simulator = makeSimulator();
  SnapshotKeeper keeper(file_, 10.0);
  pthread_attr_t usual, too_large;
  ASSERT_EQ(pthread_getattr_default_np(&usual), 0);
  ASSERT_EQ(pthread_attr_init(&too_large), 0);
  ASSERT_EQ(pthread_attr_setstacksize(&too_large, std::size_t{1} << 47U), 0);
  ASSERT_EQ(pthread_setattr_default_np(&too_large), 0);
  keeper.keep(simulator);
  ASSERT_EQ(pthread_setattr_default_np(&usual), 0);
  EXPECT_TRUE(keeper.idle());
  EXPECT_EQ(keeper.health().failed, 1U);
  EXPECT_NE(keeper.health().last_failure.find(file_ + ": cannot be written"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(file_));
  keeper.finish(simulator);
  EXPECT_EQ(keeper.health().written, 1U);
  EXPECT_TRUE(keeper.health().last_failure.empty());
  EXPECT_EQ(content(), simulator.snapshot());
}

// One each period of the clock; not at the start, and not when the clock jumps back, which begins another period.
TEST_F(SnapshotKeeperTest, TakesOneEachPeriod) {
  const curtain::Simulator simulator = makeSimulator();
  const auto takenAt = [&](const std::vector<std::int64_t>& times) {
    std::filesystem::remove(file_);
    SnapshotKeeper keeper(file_, 10.0);
    for (const std::int64_t time : times) keeper.update(simulator, time * kSecond);
    while (true) {  // written or replaced: both were taken
      if (keeper.idle()) return keeper.health().written + keeper.health().replaced;
      ::usleep(1000);
    }
  };
  EXPECT_EQ(takenAt({5, 9, 14}), 0U);
  EXPECT_EQ(takenAt({5, 15}), 1U);
  EXPECT_EQ(takenAt({5, 15, 16, 24, 25}), 2U);
  EXPECT_EQ(takenAt({5, 15, 4, 13}), 1U) << "back: the next one is due at 14";
  EXPECT_EQ(takenAt({5, 15, 4, 14}), 2U);
  EXPECT_EQ(takenAt({5, 500, 505, 509}), 1U) << "missed ones are not made up for";
}

// Taken faster than a disk writes: each is written, or replaced by a newer one, and the newest is there in the end.
TEST_F(SnapshotKeeperTest, AllAreAccountedFor) {
  curtain::Simulator simulator = makeSimulator(100);
  SnapshotHealth counts;
  {
    SnapshotKeeper keeper(file_, 10.0);
    for (int i = 0; i < 300; ++i) keeper.keep(simulator);
    simulator.step();
    keeper.finish(simulator);
    counts = keeper.health();
  }
  EXPECT_EQ(counts.written + counts.replaced, 301U);
  EXPECT_GT(counts.replaced, 0U);
  EXPECT_GT(counts.written, 0U);
  EXPECT_EQ(counts.failed, 0U);
  EXPECT_EQ(content(), simulator.snapshot());
}

TEST_F(SnapshotKeeperTest, AFolderThatIsNotThereIsAFailure) {
  const curtain::Simulator simulator = makeSimulator();
  SnapshotKeeper keeper((folder_ / "nowhere" / "curtain.snapshot").string(), 10.0);
  keeper.keep(simulator);
  while (!keeper.idle()) ::usleep(1000);
  EXPECT_EQ(keeper.health().failed, 1U);
  EXPECT_NE(keeper.health().last_failure.find("nowhere"), std::string::npos);
}

// Of another scene, or cut short: named, nothing changed, and put aside.
TEST_F(SnapshotKeeperTest, OneThatIsRefusedIsPutAside) {
  const curtain::Simulator larger = makeSimulator(12);
  const std::string whole = makeSimulator().snapshot();
  for (const std::string& bytes : {larger.snapshot(), whole.substr(0, whole.size() / 2), std::string()}) {
    put(bytes);
    curtain::Simulator simulator = makeSimulator();
    {
      SnapshotKeeper keeper(file_, 10.0);
      EXPECT_FALSE(keeper.restore(simulator));
      EXPECT_FALSE(keeper.health().refused.empty());
      EXPECT_FALSE(keeper.health().foreign);
      EXPECT_EQ(simulator.stateHash(), makeSimulator().stateHash());
      EXPECT_EQ(content(), bytes) << "not before there is another one";
      keeper.keep(simulator);
      while (!keeper.idle()) ::usleep(1000);
      simulator.step();
      keeper.keep(simulator);
    }
    EXPECT_EQ(content(), simulator.snapshot());
    EXPECT_EQ(content(".refused"), bytes);
  }
}

// Something that never was a snapshot: somebody's scene, by a mistake in the path.
TEST_F(SnapshotKeeperTest, WhatIsNoSnapshotIsLeftAlone) {
  for (const std::string bytes : {"cloth: {rows: 10, columns: 8}\n", "x"}) {
    put(bytes);
    curtain::Simulator simulator = makeSimulator();
    {
      SnapshotKeeper keeper(file_, 10.0);
      EXPECT_FALSE(keeper.restore(simulator));
      EXPECT_TRUE(keeper.health().foreign);
      keeper.update(simulator, 0);
      keeper.update(simulator, 100 * kSecond);
      keeper.keep(simulator);
    }
    EXPECT_EQ(content(), bytes);
  }
}

}  // namespace
}  // namespace curtain_ros
