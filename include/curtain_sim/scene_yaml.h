// SPDX-License-Identifier: BSD-3-Clause
//
// Floor 0: scenes to and from YAML. One parser for scene files and for the node's parameter tree: unknown
// keys, wrong types, numbers given as text, non-finite and out-of-range values are all reported at once.
#pragma once

#include <string>
#include <vector>

#include "curtain_sim/scene.h"

namespace YAML {
class Node;
}

namespace curtain {

/// Result of reading: the scene is usable only when problems is empty.
struct SceneReading {
  Scene scene;                    ///< with defaults where a key is missing or wrong
  std::vector<Problem> problems;  ///< empty: none
};

/// Reads a scene from a YAML tree and validates it. Never throws on bad content.
SceneReading readScene(const YAML::Node& root);

/// Reads a scene from YAML text or from a file; a file that can't be opened or parsed is a problem with
/// the key "" and a text naming line and column. Relative mesh paths are taken from the file's folder.
SceneReading readSceneText(const std::string& text);
SceneReading readSceneFile(const std::string& path);  ///< as readSceneText()

/// The scene as YAML text with every key spelled out; readSceneText gives the same scene back, bit by bit.
std::string writeScene(const Scene& scene);

}  // namespace curtain
