// SPDX-License-Identifier: BSD-3-Clause
//
// What a YAML scalar is, judged as YAML 1.1 (PyYAML, rosparam) judges it, so that a file means the same to
// curtain_batch and to roslaunch: "1e-6", "1.0e6" and "-.5" are text there although yaml-cpp would take them as
// numbers. Quoted scalars are always text. Scalars built in code (YAML::Node(1e-6), no tag) were values already and
// are read for what they are; text built in code must carry the tag "!".
#pragma once

#include <cstdint>
#include <string>

namespace YAML {
class Node;
}

namespace curtain {

enum class ScalarKind { kBool, kInteger, kReal, kText };

/// A scalar with its value; which members count depends on kind.
struct ScalarValue {
  ScalarKind kind = ScalarKind::kText;
  bool flag = false;            ///< kBool
  double number = 0.0;          ///< kInteger, kReal; infinite when the text is beyond a double's range
  bool negative = false;        ///< kInteger: sign
  std::uint64_t magnitude = 0;  ///< kInteger: absolute value
  bool overflow = false;        ///< kInteger: magnitude does not fit
  std::string hint;             ///< kText that was meant as a number: how to write it, e.g. "write 1.0e-6"
};

/// node must be a scalar.
ScalarValue scalarValue(const YAML::Node& node);

/// What a problem says the value is: `1`, `the text "auto"`, `a list of 2`, `a map`, `empty`; with the hint of a number
/// given as text.
std::string describeValue(const YAML::Node& node);

/// The text, cut short with ... when it is long.
std::string shortened(const std::string& text);

/// The same in double quotes.
std::string quoted(const std::string& text);

}  // namespace curtain
