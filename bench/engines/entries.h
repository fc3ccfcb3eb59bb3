// SPDX-License-Identifier: BSD-3-Clause
//
// Who takes part in a scene, at which settings: those of each engine from its fastest to its truest.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "bench/engines/engine.h"
#include "bench/engines/scenes.h"

namespace curtain_bench {

struct EngineEntry {
  std::string engine, version, setting;  ///< no commas
  bool flat = false;                     ///< starts as ours
  /// One of both is there.
  std::function<std::unique_ptr<Contestant>()> ours;
  std::function<std::unique_ptr<Engine>(const ClothStart&)> other;
};

/// thin: a part of the settings. commit: of this checkout. The entries refer to the scene.
std::vector<EngineEntry> entriesOf(const EngineScene& scene, const std::string& commit, bool thin);

/// E.g. "Bullet 3.27 (6c888f4)", or that it was not built.
std::string bulletVersion();

}  // namespace curtain_bench
