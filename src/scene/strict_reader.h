// SPDX-License-Identifier: BSD-3-Clause
//
// Reads a YAML map strictly: a visitor of fields.h that takes values of the right type, reports all others and finally
// the unknown keys. Ranges are checked by RangeChecker; here they only appear in messages. A value that can't be read
// keeps its default.
#pragma once

#include <yaml-cpp/yaml.h>

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "scene/fields.h"
#include "scene/problem_log.h"
#include "scene/scalar.h"

namespace curtain {

class StrictReader {
 public:
  /// map must be a map; key is its key, "" for the root.
  StrictReader(const YAML::Node& map, std::string key, ProblemLog& log);

  void integer(Key key, int& value, IntRange range);
  void integerOr(Key key, int& value, IntRange range, const char* word, int word_value);
  void seed(Key key, std::uint64_t& value);
  void number(Key key, double& value, Range range);
  void optionalNumber(Key key, std::optional<double>& value, Range range);
  void numberOrUnset(Key key, double& value, Range range);
  void flag(Key key, bool& value);
  void text(Key key, std::string& value);
  void optionalText(Key key, std::optional<std::string>& value);
  void texts(Key key, std::vector<std::string>& values);
  void vector(Key key, Vec3& value, Range range);
  void optionalVector(Key key, std::optional<Vec3>& value, Range range);
  void scale(Key key, Vec3& value, Range range);
  void rotation(Key key, Rotation& value);
  void node(Key key, std::optional<NodeIndex>& value);
  void nodes(Key key, std::vector<NodeIndex>& values);
  void numbers(Key key, std::vector<double>& values, Range range);
  void integers(Key key, std::vector<int>& values, IntRange range);
  void pins(Key key, PinParams& value);
  void slits(Key key, std::vector<SlitParams>& values);
  void path(Key key, std::vector<RailPiece>& pieces, Range range);
  bool belongs(Key key, bool yes, const Chosen& chosen);

  template <typename Enum>
  void choice(Key key, Enum& value, const std::vector<std::string>& names) {
    if (const auto index = choiceIndex(key, names)) value = static_cast<Enum>(*index);
  }

  template <typename T>
  void map(Key key, T& value) {
    readMap(mapUnder(key), keyOf(key), value, log_);
  }

  template <typename T>
  void list(Key key, std::vector<T>& values, const T& unsaid = {}) {
    const YAML::Node* found = find(key, "a list");
    if (!found || !checkSequence(*found, keyOf(key), "a list")) return;
    for (std::size_t i = 0; i < found->size(); ++i) {
      // Unreadable items keep their place, so that later ones keep their index.
      values.push_back(unsaid);
      const std::string item_key = itemKey(keyOf(key), i);
      const YAML::Node item = (*found)[i];
      if (item.IsMap()) {
        readMap(item, item_key, values.back(), log_);
      } else {
        refuse(item_key, "a map", item);
      }
    }
  }

  /// Reports the keys of the map that no visit asked for.
  void reportUnknown() const;

  template <typename T>
  static void readMap(const YAML::Node& map, const std::string& key, T& value, ProblemLog& log) {
    StrictReader reader(map, key, log);
    visitFields(reader, value);
    reader.reportUnknown();
  }

 private:
  using Entries = std::vector<std::pair<std::string, YAML::Node>>;
  std::string keyOf(Key key) const { return joinKey(prefix_, key.name); }
  Entries::const_iterator entryOf(Key key) const;
  const YAML::Node* find(Key key, const std::string& wanted);
  YAML::Node mapUnder(Key key);
  std::optional<std::size_t> choiceIndex(Key key, const std::vector<std::string>& names);
  static std::optional<std::size_t> placeAmong(const std::vector<std::string>& names, const YAML::Node& node);
  bool checkSequence(const YAML::Node& node, const std::string& key, const std::string& wanted,
                     std::optional<std::size_t> size = std::nullopt);
  void refuse(const std::string& key, const std::string& wanted, const YAML::Node& node);
  void refuseNumber(const std::string& key, const std::string& wanted, const YAML::Node& node);
  bool readNumber(const YAML::Node& node, const std::string& key, Range range, double& value);
  void readText(const YAML::Node& node, const std::string& key, std::string& value);
  bool readInteger(const YAML::Node& node, const std::string& key, const std::string& wanted, int& value);
  bool readVector(const YAML::Node& node, const std::string& key, Range range, Vec3& value);
  void readSlit(const YAML::Node& node, const std::string& key, SlitParams& value);
  void readNodes(const YAML::Node& nodes, Key key, std::vector<NodeIndex>& values);
  bool readNode(const YAML::Node& node, const std::string& key, NodeIndex& value);

  std::string prefix_;
  ProblemLog& log_;
  Entries entries_;
  std::vector<std::string> asked_;
};

}  // namespace curtain
