// SPDX-License-Identifier: BSD-3-Clause
//
// Parses YAML text within limits. yaml-cpp builds whatever it is given: nested aliases make a tree of a billion values
// from a few lines, and of some texts LoadAll makes documents without end (0.7).
#pragma once

#include <yaml-cpp/yaml.h>

#include <string>

namespace curtain {

/// Longest text that is read, and most values; an alias counts as all values that it stands for.
constexpr std::size_t kLongestYaml = std::size_t{16} << 20U;
constexpr std::size_t kMaxYamlValues = 1000000;

/// Reads the text's only document, null when there is none. False: `problem` says what is wrong, with line and column
/// if known.
bool loadYaml(const std::string& text, YAML::Node& root, std::string& problem);

}  // namespace curtain
