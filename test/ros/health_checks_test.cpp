// SPDX-License-Identifier: BSD-3-Clause
//
// A node that is well says OK; each fault turns its own status to the level that health_checks.h states, and back once
// it is over for five seconds.
#include "ros/health/health_checks.h"

#include <gtest/gtest.h>

#include <functional>

namespace curtain_ros {
namespace {

using curtain_sim::Statistics;
using diagnostic_msgs::DiagnosticStatus;
using diagnostic_updater::DiagnosticStatusWrapper;

ros::SteadyTime at(double seconds) { return ros::SteadyTime(1000.0 + seconds); }

Health well() {
  Health health;
  health.stretch_tolerance = 1e-3;
  health.frame_rate = 60.0;
  health.statistics.real_time_factor = 1.0;
  health.statistics.warp_stretch = 1e-3;
  health.obstacles.push_back({"ball", "hand", true, false, false, false, 0.01, "", 0.0});
  return health;
}

DiagnosticStatusWrapper simulation(const Health& health, double now, Rises& rises, double last_frame,
                                   bool simulated = false, bool stands = false) {
  DiagnosticStatusWrapper status;
  checkSimulation(health, {at(now), at(last_frame), simulated, stands}, rises, status);
  return status;
}

DiagnosticStatusWrapper inputs(const Health& health, double now, Rises& rises) {
  DiagnosticStatusWrapper status;
  checkInputs(health, {at(now), {}}, rises, status);
  return status;
}

DiagnosticStatusWrapper obstacles(const Health& health, double now, Rises& rises) {
  DiagnosticStatusWrapper status;
  checkObstacles(health, {at(now), {}}, rises, status);
  return status;
}

DiagnosticStatusWrapper master(const Health& health, double now, Rises& rises) {
  DiagnosticStatusWrapper status;
  checkMaster(health, {at(now), {}}, rises, status);
  return status;
}

TEST(HealthChecks, ANodeThatIsWellIsOk) {
  Rises rises;
  EXPECT_EQ(simulation(well(), 0.0, rises, 0.0).level, DiagnosticStatus::OK);
  EXPECT_EQ(inputs(well(), 0.0, rises).level, DiagnosticStatus::OK);
  EXPECT_EQ(obstacles(well(), 0.0, rises).level, DiagnosticStatus::OK);
  EXPECT_EQ(master(well(), 0.0, rises).level, DiagnosticStatus::OK);
  EXPECT_EQ(master(well(), 0.0, rises).message, "knows the node");
}

struct Counted {
  const char* name;
  std::function<void(Statistics&)> rise;
  unsigned char level;
};

// Each count: OK before, its level once it rises and for five seconds on, OK after; and again with the next rise.
TEST(HealthChecks, CountsThatRoseLatelyAreTold) {
  const Counted simulation_counts[] = {
      {"not_finite", [](Statistics& s) { ++s.not_finite; }, DiagnosticStatus::ERROR},
      {"stops", [](Statistics& s) { ++s.stops; }, DiagnosticStatus::WARN},
      {"unsettled", [](Statistics& s) { ++s.unsettled; }, DiagnosticStatus::WARN},
      {"last_resort_substeps", [](Statistics& s) { ++s.last_resort_substeps; }, DiagnosticStatus::WARN},
      {"dropped_frames", [](Statistics& s) { ++s.dropped_frames; }, DiagnosticStatus::WARN},
      {"late_frames", [](Statistics& s) { ++s.late_frames; }, DiagnosticStatus::WARN},
      {"shortened_frames", [](Statistics& s) { ++s.shortened_frames; }, DiagnosticStatus::WARN},
      {"clock_jumps_back", [](Statistics& s) { ++s.clock_jumps_back; }, DiagnosticStatus::WARN},
      {"clock_set_back", [](Statistics& s) { ++s.clock_set_back; }, DiagnosticStatus::WARN}};
  const Counted input_counts[] = {
      {"dropped_invalid", [](Statistics& s) { ++s.dropped_invalid; }, DiagnosticStatus::WARN},
      {"dropped_untransformed", [](Statistics& s) { ++s.dropped_untransformed; }, DiagnosticStatus::WARN},
      {"dropped_overflow", [](Statistics& s) { ++s.dropped_overflow; }, DiagnosticStatus::WARN},
      {"dropped_queue", [](Statistics& s) { ++s.dropped_queue; }, DiagnosticStatus::WARN}};
  const Counted obstacle_counts[] = {
      {"late_poses", [](Statistics& s) { ++s.late_poses; }, DiagnosticStatus::WARN},
      {"early_poses", [](Statistics& s) { ++s.early_poses; }, DiagnosticStatus::WARN},
      {"obstacles_lost", [](Statistics& s) { ++s.obstacles_lost; }, DiagnosticStatus::WARN},
      {"obstacles_waited", [](Statistics& s) { s.obstacles_waited += 1e-3; }, DiagnosticStatus::WARN}};
  const auto hold = [](const Counted& counted, const auto& check) {
    SCOPED_TRACE(counted.name);
    Rises rises;
    Health health = well();
    EXPECT_EQ(check(health, 0.0, rises).level, DiagnosticStatus::OK);
    counted.rise(health.statistics);
    EXPECT_EQ(check(health, 1.0, rises).level, counted.level);
    EXPECT_EQ(check(health, 5.9, rises).level, counted.level) << "4.9 s after";
    EXPECT_EQ(check(health, 6.1, rises).level, DiagnosticStatus::OK) << "5.1 s after";
    counted.rise(health.statistics);
    EXPECT_EQ(check(health, 20.0, rises).level, counted.level);
  };
  for (const Counted& counted : simulation_counts) {
    hold(counted, [](const Health& health, double now, Rises& rises) { return simulation(health, now, rises, now); });
  }
  for (const Counted& counted : input_counts) hold(counted, inputs);
  for (const Counted& counted : obstacle_counts) hold(counted, obstacles);
}

// The engine's counts begin again with a restart: fewer than before is no rise, more than that is one.
TEST(HealthChecks, CountsThatBeginAgainAreNoRise) {
  Rises rises;
  EXPECT_TRUE(rises.lately("unsettled", 10.0, at(0.0)));
  EXPECT_FALSE(rises.lately("unsettled", 0.0, at(10.0)));
  EXPECT_TRUE(rises.lately("unsettled", 1.0, at(11.0)));
}

TEST(HealthChecks, LinksAboveTheToleranceAreWarnedOf) {
  Rises rises;
  Health health = well();
  health.statistics.weft_stretch = 1.01e-3;
  EXPECT_EQ(simulation(health, 0.0, rises, 0.0).level, DiagnosticStatus::WARN);
}

TEST(HealthChecks, SlowerThanTheClockIsWarnedOf) {
  Rises rises;
  Health health = well();
  health.statistics.real_time_factor = 0.9;
  EXPECT_EQ(simulation(health, 0.0, rises, 0.0).level, DiagnosticStatus::WARN);
  EXPECT_EQ(simulation(health, 0.0, rises, 0.0, true).level, DiagnosticStatus::OK) << "/clock may run as it likes";
  health.statistics.real_time_factor = 0.0;
  EXPECT_EQ(simulation(health, 0.0, rises, 0.0).level, DiagnosticStatus::OK) << "not known yet";
}

// A pause is no fault, and nobody is slow in it.
TEST(HealthChecks, APauseIsNoFault) {
  Rises rises;
  Health health = well();
  health.statistics.real_time_factor = 0.1;
  EXPECT_EQ(simulation(health, 60.0, rises, 0.0).level, DiagnosticStatus::ERROR);
  health.paused = true;
  EXPECT_EQ(simulation(health, 60.0, rises, 0.0).level, DiagnosticStatus::OK);
  EXPECT_EQ(simulation(health, 60.0, rises, 0.0).message, "paused");
  DiagnosticStatusWrapper status;
  checkSimulation(health, {at(0.0), ros::SteadyTime()}, rises, status);
  EXPECT_EQ(status.level, DiagnosticStatus::OK) << "from the start on";
}

// A thread that makes no frames although the clock runs is an error; a /clock that stands is not.
TEST(HealthChecks, FramesThatStandStillAreAnError) {
  Rises rises;
  EXPECT_EQ(simulation(well(), 4.9, rises, 0.0).level, DiagnosticStatus::OK);
  EXPECT_EQ(simulation(well(), 5.1, rises, 0.0).level, DiagnosticStatus::ERROR);
  EXPECT_EQ(simulation(well(), 5.1, rises, 0.0, true, true).level, DiagnosticStatus::OK);
  EXPECT_EQ(simulation(well(), 5.1, rises, 0.0, true, false).level, DiagnosticStatus::ERROR) << "a /clock that runs";
  DiagnosticStatusWrapper status;
  checkSimulation(well(), {at(0.0), ros::SteadyTime(), true}, rises, status);
  EXPECT_EQ(status.level, DiagnosticStatus::WARN);
  EXPECT_NE(status.message.find("/clock"), std::string::npos);
}

TEST(HealthChecks, ObstaclesSayWhatIsWrong) {
  Rises rises;
  Health health = well();
  health.obstacles[0].late = true;
  EXPECT_EQ(obstacles(health, 0.0, rises).level, DiagnosticStatus::WARN);
  health = well();
  health.obstacles[0].early = true;
  EXPECT_EQ(obstacles(health, 0.0, rises).level, DiagnosticStatus::WARN);
  health = well();
  health.obstacles[0].present = false;
  health.obstacles[0].error = "no such frame";
  const DiagnosticStatusWrapper left_out = obstacles(health, 0.0, rises);
  EXPECT_EQ(left_out.level, DiagnosticStatus::WARN);
  EXPECT_NE(left_out.message.find("'ball'"), std::string::npos);
  ASSERT_FALSE(left_out.values.empty());
  EXPECT_EQ(left_out.values[0].value, "left out: no such frame");
  health = well();
  health.obstacles[0].lag = 0.0981;
  const DiagnosticStatusWrapper waits = obstacles(health, 0.0, rises);
  EXPECT_EQ(waits.level, DiagnosticStatus::WARN);
  EXPECT_EQ(waits.message, "'ball' waits 0.098100 m behind 'hand'");
  EXPECT_EQ(waits.values[0].value, "0.010000 s old, waits 0.098100 m behind");
  health.obstacles[0].present = false;
  EXPECT_EQ(obstacles(health, 0.0, rises).message, "'ball' is left out") << "what is left out waits for nothing";
  health = well();
  health.viewer_error = "no such frame";
  EXPECT_EQ(obstacles(health, 0.0, rises).level, DiagnosticStatus::WARN);
}

TEST(HealthChecks, SnapshotsSayWhatIsWrong) {
  Rises rises;
  const auto check = [&](const SnapshotHealth& snapshots, double now) {
    Health health = well();
    health.snapshots = snapshots;
    DiagnosticStatusWrapper status;
    checkSnapshots(health, {at(now), {}}, rises, status);
    return status;
  };
  SnapshotHealth snapshots;
  EXPECT_EQ(check(snapshots, 0.0).message, "off");
  snapshots.wanted = true;
  EXPECT_EQ(check(snapshots, 0.0).level, DiagnosticStatus::OK);
  snapshots.last_failure = "disk full";
  EXPECT_EQ(check(snapshots, 0.0).level, DiagnosticStatus::WARN);
  snapshots.last_failure.clear();
  snapshots.refused = "of another scene";
  EXPECT_EQ(check(snapshots, 0.0).level, DiagnosticStatus::WARN);
  EXPECT_EQ(check(snapshots, 10.0).level, DiagnosticStatus::OK) << "it has been written over";
  snapshots.foreign = true;
  EXPECT_EQ(check(snapshots, 10.0).level, DiagnosticStatus::WARN);
  snapshots = SnapshotHealth();
  snapshots.replaced = 1;
  EXPECT_EQ(check(snapshots, 20.0).level, DiagnosticStatus::WARN);
}

TEST(HealthChecks, MasterThatIsGoneOrForgotIsWarnedOf) {
  Rises rises;
  Health health = well();
  health.master_answers = false;
  EXPECT_EQ(master(health, 0.0, rises).level, DiagnosticStatus::WARN);
  health = well();
  health.statistics.masters_lost = 1;
  EXPECT_EQ(master(health, 0.0, rises).level, DiagnosticStatus::WARN);
  EXPECT_EQ(master(health, 6.0, rises).level, DiagnosticStatus::OK);
}

TEST(HealthChecks, MasterThatIsNotWatchedIsOk) {
  Rises rises;
  Health health = well();
  health.master_watched = false;
  EXPECT_EQ(master(health, 0.0, rises).level, DiagnosticStatus::OK);
  EXPECT_EQ(master(health, 0.0, rises).message, "not watched");
}

}  // namespace
}  // namespace curtain_ros
