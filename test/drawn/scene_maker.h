// SPDX-License-Identifier: BSD-3-Clause
//
// Made-up scenes: a visitor of fields.h that gives every key a value, so that a new key takes part by itself. Any value
// of its range, as the fuzzer asks for; or what a curtain meets, every day or at the worst: of the sizes that habits.h
// knows, with all that acts on the cloth placed where it does (places.h).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "drawn/choices.h"
#include "drawn/habits.h"
#include "scene/fields.h"
#include "scene/problem_log.h"

namespace curtain_test {

using curtain::Key;

/// Sizes that a scene of any values has at most, so that stepping it takes milliseconds.
constexpr int kMaxRows = 6;
constexpr int kMaxColumns = 6;
constexpr int kMaxRounds = 3;
constexpr int kMaxThreads = 3;

/// How a scene is made up.
enum class Manner {
  kAny,       ///< any values
  kEveryday,  ///< as habits.h says
  kWild       ///< the same, three quarters of the values by the wilder bounds
};

class SceneMaker {
 public:
  SceneMaker(Choices& choices, Manner manner) : choices_(choices), any_(manner == Manner::kAny), manner_(manner) {}

  /// One of the things that a scene has, by its key: "wind[]".
  template <typename T>
  void make(const std::string& name, T& value) {
    const std::string above = std::exchange(above_, name);
    curtain::visitFields(*this, value);
    above_ = above;
  }

  void integer(Key key, int& value, curtain::IntRange range) {
    if (wants(key)) value = pickInteger(range);
  }
  void integerOr(Key key, int& value, curtain::IntRange range, const char*, int word_value) {
    if (wants(key)) value = choices_.oneIn(2) ? word_value : pickInteger(range);
  }
  void seed(Key, std::uint64_t& value) { value = choices_.below(256); }
  void number(Key key, double& value, curtain::Range range) {
    if (wants(key)) value = pick(range, value);
  }
  void optionalNumber(Key key, std::optional<double>& value, curtain::Range range) {
    if (wants(key, 3)) value = pick(range, 1.0);
  }
  void numberOrUnset(Key key, double& value, curtain::Range range) {
    if (wants(key, 2)) value = pick(range, 0.5);
  }
  void flag(Key key, bool& value) { value = wants(key, 2) != (!any_ && value); }
  void text(Key key, std::string& value) {
    if (value.empty()) value = std::string(key.name) + " " + std::to_string(++texts_);
  }
  void optionalText(Key, std::optional<std::string>&) {}  // of files and obstacles, which there must be
  void vector(Key key, curtain::Vec3& value, curtain::Range range) {
    if (any_ ? !isGood(value, range) || !choices_.oneIn(3) : wants(key)) pickVector(range, value);
  }
  void optionalVector(Key key, std::optional<curtain::Vec3>& value, curtain::Range range) {
    if (!wants(key, 3)) return;
    value.emplace(curtain::Vec3::Zero());
    pickVector(range, *value);
  }
  void scale(Key key, curtain::Vec3& value, curtain::Range range) { vector(key, value, range); }
  void rotation(Key key, curtain::Rotation& value);
  void node(Key key, std::optional<curtain::NodeIndex>& value) {
    if (wants(key, 2)) value = pickNode();
  }
  void nodes(Key, std::vector<curtain::NodeIndex>& values);
  void numbers(Key key, std::vector<double>& values, curtain::Range range);
  void integers(Key key, std::vector<int>& values, curtain::IntRange range);
  void pins(Key, curtain::PinParams& value);
  void slits(Key key, std::vector<curtain::SlitParams>& values);
  void path(Key, std::vector<curtain::RailPiece>& pieces, curtain::Range range);
  bool belongs(Key, bool yes, const curtain::Chosen&) { return yes; }

  template <typename Enum>
  void choice(Key key, Enum& value, const std::vector<std::string>& names) {
    if (wants(key)) value = static_cast<Enum>(choices_.below(names.size()));
  }

  template <typename T>
  void map(Key key, T& value) {
    if (wants(key)) make(curtain::joinKey(above_, key.name), value);
  }

  template <typename T>
  void list(Key key, std::vector<T>& values, const T& = {}) {
    const std::string name = curtain::joinKey(above_, key.name) + "[]";
    // Most lists of any values are empty.
    const std::uint64_t end = any_ ? choices_.below(4) : wants(key) ? 1 + pickSize() : 0;
    for (std::uint64_t left = end; left > 1; --left) {
      values.emplace_back();
      make(name, values.back());
    }
  }

 private:
  static bool isGood(const curtain::Vec3& value, const curtain::Range& range) {
    return range.contains(value.x()) && range.contains(value.y()) && range.contains(value.z());
  }
  /// Of any values one in so many is given.
  bool wants(Key key, std::uint64_t one_in = 1);
  Bounds bounds();
  double pickWithin(const Bounds& of);
  std::uint64_t pickSize();
  int pickInteger(curtain::IntRange range);
  double pick(const curtain::Range& range, double usual);
  double pickByHabit(const curtain::Range& range, double usual);
  void pickVector(const curtain::Range& range, curtain::Vec3& value);
  curtain::NodeIndex pickNode();

  Choices& choices_;
  const bool any_;
  const Manner manner_;
  std::string above_;             // the key of what is visited
  const Habit* habit_ = nullptr;  // of the key that was wanted last
  int texts_ = 0;
};

/// A scene with every key made up; none when what they mean together can't be simulated. Of any values its meshes have
/// made-up names; else they are files, named as resolveTestMesh() knows. most: rows, and columns of each cloth.
std::optional<curtain::Scene> makeScene(Choices& choices, Manner manner = Manner::kAny, int most = 100);

/// The cloth does not begin in itself, and its links are long enough to bend.
bool mayBegin(const curtain::Scene& scene);

/// Makes what goes together fit.
void fitTogether(curtain::Scene& scene, Choices& choices, Manner manner, int most);

/// Names meshes by their path in the source folder.
std::string resolveTestMesh(const std::string& url);

}  // namespace curtain_test
