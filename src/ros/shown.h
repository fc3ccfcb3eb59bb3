// SPDX-License-Identifier: BSD-3-Clause
//
// Floor 5: names that came in messages, as they may stand in a log: on one line, and no longer than a line.
#pragma once

#include <cstddef>
#include <string>

namespace curtain_ros {

/// Longest id and frame name that a message may hold [bytes].
constexpr std::size_t kLongestName = 255;

/// The text without control characters, cut after `longest` bytes.
inline std::string shown(const std::string& text, std::size_t longest = 80) {
  std::string result = text.substr(0, longest);
  for (char& c : result) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
  }
  if (text.size() > longest) result += "… (" + std::to_string(text.size()) + " bytes)";
  return result;
}

}  // namespace curtain_ros
