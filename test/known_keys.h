// SPDX-License-Identifier: BSD-3-Clause
//
// Every key of a scene, from the table of fields.
#pragma once

#include <algorithm>

#include "scene/fields.h"
#include "scene/problem_log.h"

namespace curtain {

// Collects the names of all keys.
class KeyCollector {
 public:
  KeyCollector(std::string prefix, std::vector<std::string>& keys) : prefix_(std::move(prefix)), keys_(keys) {}

  void integer(Key key, const int&, IntRange) { note(key); }
  void integerOr(Key key, const int&, IntRange, const char*, int) { note(key); }
  void seed(Key key, const std::uint64_t&) { note(key); }
  void number(Key key, const double&, Range) { note(key); }
  void optionalNumber(Key key, const std::optional<double>&, Range) { note(key); }
  void numberOrUnset(Key key, const double&, Range) { note(key); }
  void flag(Key key, const bool&) { note(key); }
  void text(Key key, const std::string&) { note(key); }
  void optionalText(Key key, const std::optional<std::string>&) { note(key); }
  void vector(Key key, const Vec3&, Range) { note(key); }
  void optionalVector(Key key, const std::optional<Vec3>&, Range) { note(key); }
  void scale(Key key, const Vec3&, Range) { note(key); }
  void rotation(Key key, const Rotation&) { note(key); }
  void node(Key key, const std::optional<NodeIndex>&) { note(key); }
  void nodes(Key key, const std::vector<NodeIndex>&) { note(key); }
  void numbers(Key key, const std::vector<double>&, Range) { note(key); }
  void integers(Key key, const std::vector<int>&, IntRange) { note(key); }
  void pins(Key key, const PinParams&) { note(key); }
  void slits(Key key, const std::vector<SlitParams>&) { note(key); }
  void path(Key key, const std::vector<RailPiece>&, Range) { note(key); }
  bool belongs(Key, bool, const Chosen&) { return true; }

  template <typename Enum>
  void choice(Key key, const Enum&, const std::vector<std::string>&) {
    note(key);
  }

  template <typename T>
  void map(Key key, const T& value) {
    KeyCollector collector(joinKey(prefix_, key.name), keys_);
    visitFields(collector, value);
  }

  template <typename T>
  void list(Key key, const std::vector<T>&, const T& = {}) {
    KeyCollector collector(joinKey(prefix_, key.name) + "[]", keys_);
    const T item;
    visitFields(collector, item);
  }

 private:
  void note(Key key) { keys_.push_back(joinKey(prefix_, key.name)); }

  std::string prefix_;
  std::vector<std::string>& keys_;
};

/// Dotted, lists as "wind[].radius"; sorted.
inline std::vector<std::string> knownSceneKeys() {
  std::vector<std::string> keys;
  KeyCollector collector("", keys);
  const Scene scene;
  visitFields(collector, scene);
  std::sort(keys.begin(), keys.end());
  return keys;
}

}  // namespace curtain
