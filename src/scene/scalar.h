// SPDX-License-Identifier: BSD-3-Clause
//
// Type of a YAML scalar by YAML 1.1 (PyYAML, rosparam), so that a file means the same to curtain_batch and to
// roslaunch: "1e-6", "1.0e6" and "-.5" are text there, although yaml-cpp takes them for numbers. Quoted scalars are
// always text. Scalars built in code without a tag (YAML::Node(1e-6)) are values; text built in code must have the tag
// "!". Where a number is wanted, text that is wholly a decimal number is that number (numberValue()).
#pragma once

#include <cstdint>
#include <string>

namespace YAML {
class Node;
}

namespace curtain {

enum class ScalarKind { kNone, kBool, kInteger, kReal, kText };

/// A scalar with its value; `kind` tells which members are set.
struct ScalarValue {
  ScalarKind kind = ScalarKind::kNone;
  bool flag = false;            ///< kBool
  double number = 0.0;          ///< kInteger, kReal; infinite when the text is beyond a double's range
  bool negative = false;        ///< kInteger: sign
  std::uint64_t magnitude = 0;  ///< kInteger: absolute value
  bool overflow = false;        ///< kInteger: magnitude does not fit
  std::string hint;             ///< kText that was meant as a number: how to write it, e.g. "write .inf"
};

/// kNone: the node is no scalar.
ScalarValue scalarValue(const YAML::Node& node);

/// The same where a number is wanted: text that is one from its first to its last character, [sign] digits with or
/// without a point [e [sign] digits], in any locale, is that number.
ScalarValue numberValue(const YAML::Node& node);

/// Describes a value for a problem: `1`, `the text "auto"`, `a list of 2`, `a map`, `empty`; with a hint for what was
/// meant as a number.
std::string describeValue(const YAML::Node& node);

/// The same where a number is wanted: text that is one is described as that number.
std::string describeNumber(const YAML::Node& node);

/// The text, shortened with ... when it is long.
std::string shortened(const std::string& text);

/// The same in double quotes.
std::string quoted(const std::string& text);

}  // namespace curtain
