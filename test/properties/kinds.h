// SPDX-License-Identifier: BSD-3-Clause
//
// The kinds of scenes and the methods that a property is tried with.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <tuple>

#include "properties/random_scenes.h"

namespace curtain_test {

struct Kind {
  const char* name;
  Wanted wanted;
  bool touches;  ///< in some of its scenes something touches
};

inline Wanted wantedFor(bool taut, bool gentle) {
  Wanted wanted;
  wanted.taut = taut;
  wanted.gentle = gentle;
  wanted.damped = wanted.wind = wanted.drags = true;
  return wanted;
}

/// Rods alone: gathered, and no string ever pulls.
inline Kind slack() { return {"Slack", wantedFor(false, true), false}; }
/// Rods and strings, winds, drags.
inline Kind taut() { return {"Taut", wantedFor(true, false), false}; }
/// With one obstacle of each shape.
inline Kind obstacles() {
  Kind kind{"Obstacles", wantedFor(true, false), true};
  kind.wanted.obstacles = true;
  return kind;
}
inline Kind mesh() {
  Kind kind{"Mesh", wantedFor(true, false), true};
  kind.wanted.mesh = true;
  return kind;
}
/// Of cloth that bends, shears, twists and rubs; any method but the paper's.
inline Kind fabric() {
  Kind kind{"Fabric", wantedFor(true, false), false};
  kind.wanted.fabric = true;
  return kind;
}
/// Gathered and blown together.
inline Kind selfContact() {
  Kind kind{"SelfContact", wantedFor(false, false), true};
  kind.wanted.self = true;
  kind.wanted.max_nodes = 11;
  return kind;
}

inline const auto kEveryMethod =
    ::testing::Values(curtain::Method::kAuto, curtain::Method::kLeapfrog, curtain::Method::kLeapfrog4,
                      curtain::Method::kImplicit, curtain::Method::kPaper);

inline const auto kMethodsThatBend = ::testing::Values(curtain::Method::kAuto, curtain::Method::kLeapfrog,
                                                       curtain::Method::kLeapfrog4, curtain::Method::kImplicit);

inline std::string nameOfMethod(const ::testing::TestParamInfo<curtain::Method>& test) { return toString(test.param); }
inline std::string nameOfKind(const ::testing::TestParamInfo<std::tuple<Kind, curtain::Method>>& test) {
  return std::get<0>(test.param).name + ("_" + toString(std::get<1>(test.param)));
}

}  // namespace curtain_test
