// SPDX-License-Identifier: BSD-3-Clause
//
// YAML text to a tree, within limits. yaml-cpp builds whatever it is told to: aliases of aliases make a tree of a
// billion values from a few lines, and there are texts of which its LoadAll makes documents without end (0.7).
#pragma once

#include <yaml-cpp/yaml.h>

#include <string>

namespace curtain {

/// Longest text that is read, 16 MiB, and most values that it may come to, each alias counting as all that it stands
/// for.
constexpr std::size_t kLongestYaml = std::size_t{16} << 20U;
constexpr std::size_t kMostYamlValues = 1000000;

/// The text's only document, null when there is none. False: what is wrong is in `problem`, with line and column where
/// it has a place.
bool loadYaml(const std::string& text, YAML::Node& root, std::string& problem);

}  // namespace curtain
