// SPDX-License-Identifier: BSD-3-Clause
//
// A build without Embree refuses what needs it before anything starts, and says what to do.
#include <gtest/gtest.h>

#include <stdexcept>

#include "curtain_sim/scene_yaml.h"
#include "curtain_sim/simulator.h"
#include "sensing/ray_caster.h"
#include "sensing/sensor_params.h"

namespace curtain {
namespace {

std::vector<Problem> problemsOf(SensorKind kind) {
  SensorParams params;
  params.sensor = kind;
  ProblemLog log;
  checkSensor(params, log);
  return log.problems();
}

TEST(WithoutEmbree, ASensorIsRefused) {
  for (const SensorKind kind : {SensorKind::kCamera, SensorKind::kLidar}) {
    const std::vector<Problem> problems = problemsOf(kind);
    ASSERT_EQ(problems.size(), 1U);
    EXPECT_EQ(problems[0].key, "sensor");
    EXPECT_NE(problems[0].text.find("Embree"), std::string::npos) << problems[0].text;
  }
}

TEST(WithoutEmbree, PointsAllOverTheClothAreThere) { EXPECT_TRUE(problemsOf(SensorKind::kAllRound).empty()); }

TEST(WithoutEmbree, NoRayIsCast) {
  const Simulator simulator(readSceneText("cloth: {rows: 3, columns: 3}").scene);
  EXPECT_FALSE(RayCaster::available());
  EXPECT_THROW(RayCaster(simulator, 0.0), std::runtime_error);
}

}  // namespace
}  // namespace curtain
