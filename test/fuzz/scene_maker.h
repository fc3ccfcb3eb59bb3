// SPDX-License-Identifier: BSD-3-Clause
//
// Made-up scenes: a visitor of fields.h that gives every key a value of its range, so that a new key takes part by
// itself.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "fuzz/choices.h"
#include "scene/fields.h"

namespace curtain_test {

using curtain::Key;

class SceneMaker {
 public:
  explicit SceneMaker(Choices& choices) : choices_(choices) {}

  void integer(Key, int& value, curtain::IntRange range) { value = pickInteger(range); }
  void integerOr(Key, int& value, curtain::IntRange range, const char*, int word_value) {
    value = choices_.oneIn(2) ? word_value : pickInteger(range);
  }
  void seed(Key, std::uint64_t& value) { value = choices_.below(256); }
  void number(Key, double& value, curtain::Range range) { value = pick(range, value); }
  void optionalNumber(Key, std::optional<double>& value, curtain::Range range) {
    if (choices_.oneIn(3)) value = pick(range, 1.0);
  }
  void numberOrUnset(Key, double& value, curtain::Range range) {
    if (choices_.oneIn(2)) value = pick(range, 0.5);
  }
  void flag(Key, bool& value) { value = choices_.oneIn(2); }
  void text(Key key, std::string& value) {
    if (value.empty()) value = std::string(key.name) + " " + std::to_string(++texts_);
  }
  void optionalText(Key, std::optional<std::string>&) {}  // of files and obstacles, which there must be
  void vector(Key, curtain::Vec3& value, curtain::Range range) {
    if (!isGood(value, range) || !choices_.oneIn(3)) pickVector(range, value);
  }
  void optionalVector(Key, std::optional<curtain::Vec3>& value, curtain::Range range) {
    if (!choices_.oneIn(3)) return;
    value.emplace(curtain::Vec3::Zero());
    pickVector(range, *value);
  }
  void scale(Key key, curtain::Vec3& value, curtain::Range range) { vector(key, value, range); }
  void rotation(Key, curtain::Rotation& value);
  void node(Key, std::optional<curtain::NodeIndex>& value) {
    if (choices_.oneIn(2)) value = pickNode();
  }
  void nodes(Key, std::vector<curtain::NodeIndex>& values);
  void numbers(Key, std::vector<double>& values, curtain::Range range);
  void integers(Key, std::vector<int>& values, curtain::IntRange range);
  void pins(Key, curtain::PinParams& value);
  void slits(Key, std::vector<curtain::SlitParams>& values);
  void path(Key, std::vector<curtain::RailPiece>& pieces, curtain::Range range);
  bool belongs(Key, bool yes, const curtain::Chosen&) { return yes; }

  template <typename Enum>
  void choice(Key, Enum& value, const std::vector<std::string>& names) {
    value = static_cast<Enum>(choices_.below(names.size()));
  }

  template <typename T>
  void map(Key, T& value) {
    curtain::visitFields(*this, value);
  }

  template <typename T>
  void list(Key, std::vector<T>& values, const T& = {}) {
    for (std::uint64_t left = choices_.below(4); left > 1; --left) {  // most lists are empty
      values.emplace_back();
      curtain::visitFields(*this, values.back());
    }
  }

 private:
  static bool isGood(const curtain::Vec3& value, const curtain::Range& range) {
    return range.contains(value.x()) && range.contains(value.y()) && range.contains(value.z());
  }
  int pickInteger(curtain::IntRange range);
  double pick(const curtain::Range& range, double usual);
  void pickVector(const curtain::Range& range, curtain::Vec3& value);
  curtain::NodeIndex pickNode();

  Choices& choices_;
  int texts_ = 0;
};

/// Sizes that a made-up scene has at most, so that stepping it takes milliseconds.
constexpr int kMaxRows = 6;
constexpr int kMaxColumns = 6;
constexpr int kMaxRounds = 3;
constexpr int kMaxThreads = 3;

/// A scene with every key made up; none when what they mean together can't be simulated. Its meshes have made-up names.
std::optional<curtain::Scene> makeScene(Choices& choices);

}  // namespace curtain_test
