// SPDX-License-Identifier: BSD-3-Clause
#include "fuzz/breakages.h"

#include <yaml-cpp/yaml.h>

#include <cmath>
#include <initializer_list>
#include <limits>
#include <sstream>

#include "scene/fields.h"
#include "scene/problem_log.h"

namespace curtain_test {
namespace {

using curtain::IntRange;
using curtain::Key;
using curtain::Range;

class Breaker {
 public:
  Breaker(std::string prefix, std::vector<Breakage>& all) : prefix_(std::move(prefix)), all_(all) {}

  void integer(Key key, const int&, IntRange range) {
    if (range.low > std::numeric_limits<int>::min()) add(key, std::to_string(range.low - 1));
    if (range.high < std::numeric_limits<int>::max()) add(key, std::to_string(range.high + 1));
    add(key, {"2.5", "1e2", "five", "'5.0'", "0x10", "99999999999999999999", ".nan", "true", "[5]", "{}", "~"});
    removeKey(key);
  }
  void integerOr(Key key, const int& value, IntRange range, const char*, int word_value) {
    integer(key, value, range);
    if (!range.contains(word_value)) add(key, std::to_string(word_value));
    add(key, "automatic");
  }
  void seed(Key key, const std::uint64_t&) { add(key, {"-1", "1.5", "18446744073709551616", "one", "~"}); }
  void number(Key key, const double&, Range range) {
    for (const std::string& value : badNumbers(range)) add(key, value);
    removeKey(key);
  }
  void optionalNumber(Key key, const std::optional<double>& value, Range range) {
    if (value) number(key, *value, range);
  }
  void numberOrUnset(Key key, const double& value, Range range) {
    if (!std::isnan(value)) number(key, value, range);
  }
  void flag(Key key, const bool&) { add(key, {"1", "maybe", "'true'", "tRue", "[true]", "~"}); }
  void text(Key key, const std::string&) {
    add(key, {"5", "''", "true", "[a]", "{}", "~", ".inf"});
    removeKey(key);
  }
  void optionalText(Key key, const std::optional<std::string>&) {
    add(key, {"5", "''", "true", "[a]", "{}", "~", ".inf"});
  }
  void vector(Key key, const curtain::Vec3&, Range range) {
    add(key, {"5", "[1, 2]", "[1, 2, 3, 4]", "{x: 1}", "north", "[]", "~"});
    for (const std::string& value : badNumbers(range)) add(key, "[1.0, " + value + ", 1.0]");
    removeKey(key);
  }
  void optionalVector(Key key, const std::optional<curtain::Vec3>& value, Range range) {
    if (value) vector(key, *value, range);
  }
  void scale(Key key, const curtain::Vec3& value, Range range) {
    for (const std::string& number : badNumbers(range)) add(key, {number, "[1.0, 1.0, " + number + "]"});
    add(key, {"[1, 2]", "{}", "~"});
    (void)value;
  }
  void rotation(Key key, const curtain::Rotation&) {
    add(key, {"1", "[0, 0, 1]", "[0, 0, 0, 0]", "[1, 1, 1, 1]", "[0, 0, .nan, 1]", "[0, 0, 0, up]", "~"});
  }
  void node(Key key, const std::optional<curtain::NodeIndex>& value) {
    if (value) add(key, {"1", "[1]", "[1, 2, 3]", "[0, 99999]", "[-1, 0]", "[0.5, 0]", "[a, b]", "~"});
  }
  void nodes(Key key, const std::vector<curtain::NodeIndex>&) {
    add(key,
        {"1", "{}", "all", "[]", "[1]", "[[1]]", "[[0, 99999]]", "[[-1, 0]]", "[[0, 0], [0, 0]]", "[[0.5, 0]]", "~"});
  }
  void numbers(Key key, const std::vector<double>&, Range range) {
    add(key, {"1", "{}", "all", "~", "[1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20]"});
    for (const std::string& value : badNumbers(range)) add(key, "[" + value + "]");
  }
  void integers(Key key, const std::vector<int>&, IntRange range) {
    add(key, {"1", "{}", "all", "~", "[1.5]", "[a]", "['1.0']", "[[1]]", "[" + std::to_string(range.low - 1) + "]",
              "[" + std::to_string(range.high + 1) + "]"});
  }
  void path(Key key, const std::vector<curtain::RailPiece>&, Range range) {
    add(key, {"1", "{}", "straight", "~", "[[1, 2]]", "[[0, 0, 0]]", "[[0, 0, 0], [0, 0, 0]]",
              "[[0, 0, 0], {to: [1, 0, 0]}]", "[[0, 0, 0], {to: [1, 0, 0], centre: [0, 1, 0]}]"});
    for (const std::string& value : badNumbers(range)) {
      if (value != "0" && value != "-0.0") add(key, "[[0, 0, 0], [1.0, " + value + ", 0]]");
    }
  }
  void pins(Key key, const curtain::PinParams&) {
    add(key, {"bottom", "1", "{}", "[1]", "[[1]]", "[[0, 99999]]", "[[-1, 0]]", "[[0, 0], top]", "~"});
  }
  void slits(Key key, const std::vector<curtain::SlitParams>&) {
    add(key, {"1", "{}", "all", "[x]", "[-1]", "[99999]", "[[0]]", "[{from_row: 1}]", "[{column: 1, row: 1}]", "~"});
  }
  bool belongs(Key key, bool yes, const curtain::Chosen&) {
    if (!yes) add(key, "1.0");  // one that does not belong there
    return yes;
  }

  template <typename Enum>
  void choice(Key key, const Enum&, const std::vector<std::string>& names) {
    add(key, {"nonsense", "1", names.front() + "x", "[" + names.front() + "]", "~"});
  }

  template <typename T>
  void map(Key key, const T& value) {
    add(key, {"1", "[]", "text", "~"});
    Breaker under(keyOf(key), all_);
    under.visit(value);
  }

  template <typename T>
  void list(Key key, const std::vector<T>& values, const T& = {}) {
    add(key, {"1", "{}", "text", "~"});
    for (std::size_t i = 0; i < values.size(); ++i) {
      Breaker under(curtain::itemKey(keyOf(key), i), all_);
      all_.push_back({curtain::itemKey(keyOf(key), i), "7"});
      under.visit(values[i]);
    }
  }

  template <typename T>
  void visit(const T& value) {
    curtain::visitFields(*this, value);
    add("no_such_key", {"1", "~", "{}"});
  }

 private:
  std::string keyOf(Key key) const { return curtain::joinKey(prefix_, key.name); }
  void add(Key key, const std::string& value) { all_.push_back({keyOf(key), value}); }
  void add(Key key, std::initializer_list<std::string> values) {
    for (const std::string& value : values) add(key, value);
  }
  void removeKey(Key key) {
    if (key.required) all_.push_back({keyOf(key), ""});
  }

  static std::vector<std::string> badNumbers(const Range& range) {
    std::vector<std::string> values = {".nan", "-.inf", "1e-6m", "'1,0'", "''",   "'.5 '", "0x1",
                                       "inf",  "1.0.0", "many",  "false", "[[]]", "{}"};
    const double infinity = std::numeric_limits<double>::infinity();
    if (!range.contains(infinity)) values.insert(values.end(), {".inf", "1.0e+999"});
    if (!range.contains(0.0)) values.insert(values.end(), {"0", "-0.0"});
    if (std::isfinite(range.low)) values.push_back(curtain::formatYamlNumber(std::nextafter(range.low, -infinity)));
    if (std::isfinite(range.high)) values.push_back(curtain::formatYamlNumber(std::nextafter(range.high, infinity)));
    return values;
  }

  std::string prefix_;
  std::vector<Breakage>& all_;
};

// "wind[0]" -> "wind" and the indices behind it.
YAML::Node childOf(const YAML::Node& parent, const std::string& part) {
  const std::size_t bracket = part.find('[');
  YAML::Node child = parent[part.substr(0, bracket)];
  if (bracket == std::string::npos) return child;
  const std::size_t index = static_cast<std::size_t>(std::stoul(part.substr(bracket + 1)));
  return child[index];
}

}  // namespace

std::vector<Breakage> breakagesOf(const curtain::Scene& scene) {
  std::vector<Breakage> all;
  Breaker("", all).visit(scene);
  return all;
}

std::string breakText(const std::string& text, const Breakage& breakage) {
  YAML::Node root = YAML::Load(text);
  YAML::Node parent = root;
  std::istringstream parts(breakage.key);
  std::string part;
  std::getline(parts, part, '.');
  for (std::string next; std::getline(parts, next, '.'); part = next) parent.reset(childOf(parent, part));
  const std::string marker = "BROKEN";  // in its place the value as it is: a tree forgets quotes
  if (breakage.value.empty()) {
    parent.remove(part);
  } else if (part.find('[') != std::string::npos) {
    childOf(parent, part) = marker;
  } else {
    parent[part] = marker;
  }
  YAML::Emitter out;
  out << root;
  std::string broken = std::string(out.c_str()) + "\n";
  const std::size_t at = broken.find(marker);
  if (at != std::string::npos) broken.replace(at, marker.size(), breakage.value);
  return broken;
}

}  // namespace curtain_test
