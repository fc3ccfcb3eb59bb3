// SPDX-License-Identifier: BSD-3-Clause
//
// Helpers of the scene tests: reading with an expectation about the problems, and comparing scenes bit by bit.
#pragma once

#include <gtest/gtest.h>

#include <cstring>
#include <string>
#include <vector>

#include "curtain_sim/scene_yaml.h"

namespace curtain {

/// A small valid scene; tests add to it.
inline const char* smallScene() { return "cloth: {rows: 4, columns: 3}\n"; }

/// The text gives exactly one problem, with this key, whose text has all fragments in it.
inline void expectProblem(const std::string& yaml, const std::string& key, const std::vector<std::string>& fragments) {
  SCOPED_TRACE(yaml);
  const std::vector<Problem> problems = readSceneText(yaml).problems;
  ASSERT_EQ(problems.size(), 1u) << describe(problems);
  EXPECT_EQ(problems[0].key, key) << problems[0].text;
  for (const std::string& fragment : fragments) {
    EXPECT_NE(problems[0].text.find(fragment), std::string::npos) << problems[0].text << " lacks: " << fragment;
  }
}

inline Scene expectScene(const std::string& yaml) {
  const SceneReading reading = readSceneText(yaml);
  EXPECT_TRUE(reading.problems.empty()) << describe(reading.problems) << "\nin\n" << yaml;
  return reading.scene;
}

/// Same bits; tells -0 from 0, and NaN equals NaN.
inline bool sameBits(double a, double b) { return std::memcmp(&a, &b, sizeof a) == 0; }

}  // namespace curtain
