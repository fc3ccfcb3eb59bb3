// SPDX-License-Identifier: BSD-3-Clause
#include "ros/parameters/xmlrpc_yaml.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace curtain_ros {

using XmlRpc::XmlRpcValue;

namespace {

// A scalar with the tag of quotation marks: never a number, whatever it looks like.
YAML::Node quoted(const std::string& text) {
  YAML::Node node(text);
  node.SetTag("!");
  return node;
}

YAML::Node plain(const std::string& text) {
  YAML::Node node(text);
  node.SetTag("?");
  return node;
}

}  // namespace

std::string yamlText(double number) {
  if (std::isnan(number)) return ".nan";
  if (std::isinf(number)) return number > 0.0 ? ".inf" : "-.inf";
  // The shortest of those that give the same bits back.
  char text[40];
  for (int digits = 15; digits <= 17; ++digits) {
    std::snprintf(text, sizeof text, "%.*g", digits, number);
    if (std::strtod(text, nullptr) == number) break;
  }
  std::string result(text);
  // YAML 1.1 takes 1e+22 for text and 1 for an integer.
  if (result.find('.') == std::string::npos) result.insert(std::min(result.find('e'), result.size()), ".0");
  return result;
}

YAML::Node toYaml(const XmlRpcValue& value) {
  switch (value.getType()) {
    case XmlRpcValue::TypeBoolean:
      return plain(static_cast<const bool&>(value) ? "true" : "false");
    case XmlRpcValue::TypeInt:
      return plain(std::to_string(static_cast<const int&>(value)));
    case XmlRpcValue::TypeDouble:
      return plain(yamlText(static_cast<const double&>(value)));
    case XmlRpcValue::TypeString:
      return quoted(static_cast<const std::string&>(value));
    case XmlRpcValue::TypeArray: {
      YAML::Node list(YAML::NodeType::Sequence);
      for (int i = 0; i < value.size(); ++i) list.push_back(toYaml(value[i]));
      return list;
    }
    case XmlRpcValue::TypeStruct: {
      YAML::Node map(YAML::NodeType::Map);
      for (const auto& entry : value) map[entry.first] = toYaml(entry.second);
      return map;
    }
    default:
      return quoted(describeValue(value));  // dates and binary data: no scene key takes them
  }
}

std::string describeValue(const XmlRpcValue& value) {
  switch (value.getType()) {
    case XmlRpcValue::TypeBoolean:
      return std::string(static_cast<const bool&>(value) ? "true" : "false") + " (boolean)";
    case XmlRpcValue::TypeInt:
      return std::to_string(static_cast<const int&>(value)) + " (integer)";
    case XmlRpcValue::TypeDouble:
      return yamlText(static_cast<const double&>(value)) + " (number)";
    case XmlRpcValue::TypeString:
      return '"' + static_cast<const std::string&>(value) + "\" (text)";
    case XmlRpcValue::TypeArray:
      return "a list of " + std::to_string(value.size());
    case XmlRpcValue::TypeStruct:
      return "a dictionary";
    case XmlRpcValue::TypeDateTime:
      return "a date";
    case XmlRpcValue::TypeBase64:
      return "binary data";
    default:
      return "nothing";
  }
}

}  // namespace curtain_ros
