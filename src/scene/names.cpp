// SPDX-License-Identifier: BSD-3-Clause
#include "scene/names.h"

#include <algorithm>

#include "curtain_sim/scene.h"

namespace curtain {

const std::vector<std::string>& lumpingNames() {
  static const std::vector<std::string> kNames = {"area", "uniform"};
  return kNames;
}

const std::vector<std::string>& materialNames() {
  static const std::vector<std::string> kNames = {"none",        "cotton_voile", "linen",    "silk",
                                                  "polyester",   "velvet",       "blackout", "hospital",
                                                  "shower_peva", "pvc_strip",    "canvas",   "parachute_nylon"};
  return kNames;
}

const std::vector<std::string>& headingNames() {
  static const std::vector<std::string> kNames = {"gathered", "pencil", "pinch", "ripple", "eyelets", "tabs"};
  return kNames;
}

const std::vector<std::string>& pinNames() {
  static const std::vector<std::string> kNames = {"top", "left", "top_corners", "none"};
  return kNames;
}

const std::vector<std::string>& airLawNames() {
  static const std::vector<std::string> kNames = {"continuous", "printed", "relative"};
  return kNames;
}

const std::vector<std::string>& gustSpectrumNames() {
  static const std::vector<std::string> kNames = {"von_karman", "dryden"};
  return kNames;
}

const std::vector<std::string>& windProfileNames() {
  static const std::vector<std::string> kNames = {"uniform", "ring_jet"};
  return kNames;
}

const std::vector<std::string>& shapeNames() {
  static const std::vector<std::string> kNames = {"sphere", "box", "cylinder", "capsule", "plane", "mesh"};
  return kNames;
}

const std::vector<std::string>& graspRegionNames() {
  static const std::vector<std::string> kNames = {"sphere", "box", "nodes"};
  return kNames;
}

const std::vector<std::string>& methodNames() {
  static const std::vector<std::string> kNames = {"auto", "leapfrog", "leapfrog4", "implicit", "paper"};
  return kNames;
}

std::string toString(Method method) { return methodNames().at(static_cast<std::size_t>(method)); }

std::optional<Method> methodFromName(const std::string& name) {
  const auto& names = methodNames();
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) return std::nullopt;
  return static_cast<Method>(found - names.begin());
}

std::string alternatives(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i > 0) text += i + 1 == names.size() ? " or " : ", ";
    text += names[i];
  }
  return text;
}

}  // namespace curtain
