// SPDX-License-Identifier: BSD-3-Clause
//
// What a scene may have, to be weighed: without it, with it but in vain, and at work. A row more is an entry more in
// features.cpp; the table, its page and the test take it from there.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "curtain_sim/simulator.h"

namespace curtain_bench {

enum class FeatureState { kOff, kIdle, kActive };

/// "off", "idle", "active".
const char* stateName(FeatureState state);

/// A scene, and what its user does in every frame besides Simulator::step() (nothing: null), which is weighed with it.
struct Play {
  curtain::Scene scene;
  std::function<void(curtain::Simulator& simulator)> each_frame;
};

struct Feature {
  std::string name;
  Play off;
  std::string idle_is;                        ///< in words; empty: it can't be idle
  std::function<void(Play& play)> make_idle;  ///< from off, which moves to the same bits
  std::string active_is;
  std::function<void(Play& play)> make_active;  ///< from off
  double max_idle = 1.02;                       ///< instructions of idle over those of off that the test lets pass
  int frames = 240;                             ///< to be weighed
  int nodes = 44 * 40;                          ///< that a frame moves, of all cloths
  int warm_up = 0;                              ///< frames before these

  bool has(FeatureState state) const;
  Play play(FeatureState state) const;
};

/// All of them, in the order of the table. Throws std::runtime_error when a scene can't be read.
const std::vector<Feature>& features();

/// Throws std::invalid_argument when there is none of that name.
const Feature& featureOf(const std::string& name);

}  // namespace curtain_bench
