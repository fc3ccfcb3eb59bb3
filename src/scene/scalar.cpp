// SPDX-License-Identifier: BSD-3-Clause
#include "scene/scalar.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <locale>
#include <sstream>

namespace curtain {
namespace {

// A number, split: [sign] whole [. fraction] [e [sign] exponent].
struct NumberParts {
  std::string sign;
  std::string whole;
  bool dot = false;
  std::string fraction;
  std::string exponent_sign;
  std::string exponent;  // empty: none
};

std::string readDigits(const std::string& text, std::size_t& at) {
  const std::size_t start = at;
  while (at < text.size() && text[at] >= '0' && text[at] <= '9') ++at;
  return text.substr(start, at - start);
}

std::string readSign(const std::string& text, std::size_t& at) {
  if (at < text.size() && (text[at] == '-' || text[at] == '+')) return std::string(1, text[at++]);
  return "";
}

// Splits the decimal number that the text begins with; returns how long that is, 0: there is none.
std::size_t splitFront(const std::string& text, NumberParts& parts) {
  std::size_t at = 0;
  parts.sign = readSign(text, at);
  parts.whole = readDigits(text, at);
  if (at < text.size() && text[at] == '.') {
    parts.dot = true;
    parts.fraction = readDigits(text, ++at);
  }
  if (parts.whole.empty() && parts.fraction.empty()) return 0;
  if (at == text.size() || (text[at] != 'e' && text[at] != 'E')) return at;
  std::size_t end = at + 1;
  parts.exponent_sign = readSign(text, end);
  parts.exponent = readDigits(text, end);
  return parts.exponent.empty() ? at : end;
}

// Whether the text is a decimal number in any common spelling.
bool splitNumber(const std::string& text, NumberParts& parts) {
  return !text.empty() && splitFront(text, parts) == text.size();
}

bool isInteger(const NumberParts& parts) { return !parts.dot && parts.exponent.empty(); }

// Whether YAML 1.1 takes it for an octal number.
bool isOctal(const NumberParts& parts) {
  return isInteger(parts) && parts.whole.size() > 1 && parts.whole[0] == '0' &&
         parts.whole.find_first_of("89") == std::string::npos;
}

// Whether YAML 1.1 takes it for a decimal number.
bool isYaml11Number(const NumberParts& parts) {
  if (isInteger(parts)) return parts.whole == "0" || parts.whole[0] != '0';
  const bool mantissa = parts.dot && (!parts.whole.empty() || parts.sign.empty());
  return mantissa && (parts.exponent.empty() || !parts.exponent_sign.empty());
}

std::string yaml11Spelling(const NumberParts& parts) {
  std::string whole = parts.whole;
  whole.erase(0, std::min(whole.find_first_not_of('0'), whole.size()));
  if (whole.empty()) whole = "0";
  const std::string sign = parts.sign == "-" ? "-" : "";
  if (isInteger(parts)) return sign + whole;
  std::string text = sign + whole + "." + (parts.fraction.empty() ? "0" : parts.fraction);
  if (!parts.exponent.empty()) text += "e" + (parts.exponent_sign.empty() ? "+" : parts.exponent_sign) + parts.exponent;
  return text;
}

std::string lowerCase(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return text;
}

// YAML 1.1 has its words in lower case, Title case and UPPER CASE.
bool isYamlCase(const std::string& text) {
  const std::string lower = lowerCase(text);
  if (text == lower || text.empty()) return true;
  const auto isUpper = [](char c) { return c < 'a' || c > 'z'; };
  return isUpper(text[0]) && (text.substr(1) == lower.substr(1) || std::all_of(text.begin(), text.end(), isUpper));
}

// .inf and .nan, with a sign or none.
bool splitSpecial(const std::string& text, double& value) {
  const bool has_sign = !text.empty() && (text[0] == '-' || text[0] == '+');
  const std::string body = text.substr(has_sign ? 1 : 0);
  if (body.size() != 4 || body[0] != '.' || !isYamlCase(body.substr(1))) return false;
  const std::string word = lowerCase(body);
  if (word == ".inf") {
    value = std::numeric_limits<double>::infinity() * (text[0] == '-' ? -1.0 : 1.0);
    return true;
  }
  if (word != ".nan" || has_sign) return false;
  value = std::numeric_limits<double>::quiet_NaN();
  return true;
}

double parseReal(const NumberParts& parts) {
  std::istringstream in(yaml11Spelling(parts));
  in.imbue(std::locale::classic());
  double value = 0.0;
  in >> value;
  if (!in.fail()) return value;
  // Streams clamp beyond a double's range; infinity fails every range check.
  return std::numeric_limits<double>::infinity() * (parts.sign == "-" ? -1.0 : 1.0);
}

void parseInteger(const NumberParts& parts, ScalarValue& value) {
  value.negative = parts.sign == "-";
  constexpr std::uint64_t kMax = std::numeric_limits<std::uint64_t>::max();
  for (const char c : parts.whole) {
    const auto digit = static_cast<std::uint64_t>(c - '0');
    value.overflow = value.overflow || value.magnitude > (kMax - digit) / 10;
    if (!value.overflow) value.magnitude = 10 * value.magnitude + digit;
  }
}

bool isBoolWord(const std::string& text, bool& flag) {
  const std::string word = lowerCase(text);
  flag = word == "true" || word == "yes" || word == "on";
  return (flag || word == "false" || word == "no" || word == "off") && isYamlCase(text);
}

std::string hintFor(const std::string& text, bool in_quotes) {
  const std::string how = in_quotes ? " without quotes" : "";
  double special = 0.0;
  if (splitSpecial(text, special)) return "write " + text + how;
  const std::string word = lowerCase(text);
  if (word == "inf" || word == "+inf" || word == "infinity") return "write .inf" + how;
  NumberParts parts;
  const std::size_t front = splitFront(text, parts);
  if (front == 0) return "";
  if (front == text.size()) return !in_quotes && isOctal(parts) ? "octal in YAML, write " + yaml11Spelling(parts) : "";
  // "20 mm", "30deg", but not "0x1F" and "1,5".
  const std::size_t unit = text.find_first_not_of(' ', front);
  const bool has_unit = unit != std::string::npos && std::strchr("xX,._:+-/*0123456789", text[unit]) == nullptr;
  return has_unit ? "write the number alone, in SI units" : "";
}

bool isNumberTag(const std::string& tag) { return tag == "tag:yaml.org,2002:float" || tag == "tag:yaml.org,2002:int"; }

// In quotes, without a tag, or with that of text.
bool isTextTag(const std::string& tag) { return tag == "!" || tag == "?" || tag == "tag:yaml.org,2002:str"; }

void readNumber(const NumberParts& parts, ScalarValue& value) {
  value.kind = isInteger(parts) ? ScalarKind::kInteger : ScalarKind::kReal;
  value.number = parseReal(parts);
  if (value.kind == ScalarKind::kInteger) parseInteger(parts, value);
}

}  // namespace

ScalarValue scalarValue(const YAML::Node& node) {
  ScalarValue value;
  if (!node.IsScalar()) return value;
  value.kind = ScalarKind::kText;
  const std::string& text = node.Scalar();
  const std::string& tag = node.Tag();
  const bool is_value = tag.empty() || isNumberTag(tag);  // built in code, or tagged as a number
  if (!is_value && tag != "?" && tag != "tag:yaml.org,2002:bool") {
    value.hint = hintFor(text, tag == "!");
    return value;
  }
  NumberParts parts;
  if (isBoolWord(text, value.flag)) {
    value.kind = ScalarKind::kBool;
  } else if (splitSpecial(text, value.number)) {
    value.kind = ScalarKind::kReal;
  } else if (splitNumber(text, parts) && (is_value || isYaml11Number(parts))) {
    readNumber(parts, value);
  } else {
    value.hint = hintFor(text, false);
  }
  return value;
}

ScalarValue numberValue(const YAML::Node& node) {
  ScalarValue value = scalarValue(node);
  NumberParts parts;
  if (value.kind != ScalarKind::kText || !isTextTag(node.Tag()) || !splitNumber(node.Scalar(), parts)) return value;
  if (node.Tag() == "?" && isOctal(parts)) return value;  // rosparam makes another number of it
  readNumber(parts, value);
  return value;
}

std::string shortened(const std::string& text) {
  constexpr std::size_t kLongest = 60;
  if (text.size() <= kLongest) return text;
  std::size_t end = kLongest;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U) --end;  // whole UTF-8 characters only
  return text.substr(0, end) + "...";
}

std::string quoted(const std::string& text) { return '"' + shortened(text) + '"'; }

std::string describeValue(const YAML::Node& node) {
  if (!node.IsDefined() || node.IsNull()) return "empty";
  if (node.IsSequence()) return "a list of " + std::to_string(node.size());
  if (node.IsMap()) return "a map";
  const ScalarValue value = scalarValue(node);
  if (value.kind != ScalarKind::kText) return shortened(node.Scalar());
  return "the text " + quoted(node.Scalar()) + (value.hint.empty() ? "" : " (" + shortened(value.hint) + ")");
}

std::string describeNumber(const YAML::Node& node) {
  const ScalarKind kind = numberValue(node).kind;
  const bool is_number = kind == ScalarKind::kInteger || kind == ScalarKind::kReal;
  return is_number ? shortened(node.Scalar()) : describeValue(node);
}

}  // namespace curtain
