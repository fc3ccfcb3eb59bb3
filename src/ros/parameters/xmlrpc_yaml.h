// SPDX-License-Identifier: BSD-3-Clause
//
// Floor 5: the parameter server's trees as YAML trees, so that scene files and ~scene go through one parser.
#pragma once

#include <xmlrpcpp/XmlRpcValue.h>
#include <yaml-cpp/yaml.h>

#include <string>

namespace curtain_ros {

/// The same tree, types kept: text becomes quoted scalars, so that "1e-6" stays text and is refused where a
/// number is wanted; doubles keep all their bits and never look like integers; inf and nan become .inf and .nan.
YAML::Node toYaml(const XmlRpc::XmlRpcValue& value);

/// A double as YAML writes it, with all its bits and never like an integer: 1.0, 0.1, .inf, -.inf, .nan.
std::string yamlText(double number);

/// What a value is, for messages: `"1e-6" (text)`, `3 (integer)`, `a list of 2`.
std::string describeValue(const XmlRpc::XmlRpcValue& value);

}  // namespace curtain_ros
