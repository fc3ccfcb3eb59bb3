// SPDX-License-Identifier: BSD-3-Clause
#include "drawn/scene_maker.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "cloth/cloth.h"
#include "curtain_sim/simulator.h"
#include "drawn/places.h"
#include "simulator/start/laid_start.h"

namespace curtain_test {

using curtain::NodeIndex;
using curtain::Range;
using curtain::Scene;
using curtain::Vec3;

bool SceneMaker::wants(Key key, std::uint64_t one_in) {
  if (any_) return one_in == 1 || choices_.oneIn(one_in);
  habit_ = &habitOf(curtain::joinKey(above_, key.name));
  return key.required || choices_.chance(habit_->chance);
}

Bounds SceneMaker::bounds() {
  const bool wild = manner_ == Manner::kWild && habit_->wild.high > 0.0 && !choices_.oneIn(4);
  return wild ? habit_->wild : habit_->everyday;
}

// Evenly, or in the logarithm between bounds that are further apart than a factor of ten: there are as many ways to be
// small as to be large, and what is small takes less time.
double SceneMaker::pickWithin(const Bounds& of) {
  const bool far = of.low > 0.0 && of.high > 10.0 * of.low;
  return far ? choices_.magnitude(of.low, of.high) : choices_.between(of.low, of.high);
}

std::uint64_t SceneMaker::pickSize() {
  const Bounds of = bounds();
  return of.high > 0.0 ? static_cast<std::uint64_t>(pickWithin({of.low, of.high + 1.0})) : 1;
}

int SceneMaker::pickInteger(curtain::IntRange range) {
  if (!any_ && habit_->everyday.high > 0.0)
    return std::min(std::max(static_cast<int>(pickSize()), range.low), range.high);
  // Small: they are the sizes of things and how often something is done.
  const int spread = choices_.oneIn(4) ? 60 : 7;
  const int most = range.high - range.low < spread ? range.high : range.low + spread;
  return range.low + static_cast<int>(choices_.below(static_cast<std::uint64_t>(most - range.low) + 1));
}

double SceneMaker::pick(const Range& range, double usual) {
  if (!any_) return pickByHabit(range, usual);
  const std::uint64_t kind = choices_.below(8);
  if (kind < 2 && range.contains(usual)) return usual;
  if (kind == 2 && range.contains(range.low)) return range.low;
  if (kind == 3 && range.contains(range.high)) return range.high;
  const bool negative = range.low < 0.0 && choices_.oneIn(2);
  // From a width of a hair to a house; all that is physics; or all there are.
  const double spread = kind < 6 ? 2.0 : kind == 6 ? 12.0 : 307.0;
  const double value = (negative ? -1.0 : 1.0) * std::pow(10.0, choices_.between(-spread, spread));
  if (range.contains(value)) return value;
  return std::min(std::max(value, range.low), range.high);
}

double SceneMaker::pickByHabit(const Range& range, double usual) {
  Bounds of = bounds();
  if (of.high == 0.0) of = usual > 0.0 && std::isfinite(usual) ? Bounds{0.5 * usual, 2.0 * usual} : Bounds{1e-3, 1.0};
  return std::min(std::max(pickWithin(of), range.low), range.high);
}

void SceneMaker::pickVector(const Range& range, Vec3& value) {
  if (!any_ && range.low < 0.0) {
    value = pick({0.0, range.high}, value.norm()) * choices_.direction();
    return;
  }
  for (int i = 0; i < 3; ++i) value[i] = pick(range, !any_ || choices_.oneIn(2) ? value[i] : 1.0);
}

NodeIndex SceneMaker::pickNode() {
  NodeIndex node;
  node.row = static_cast<int>(choices_.below(any_ ? kMaxRows : 4096));
  node.column = static_cast<int>(choices_.below(any_ ? kMaxColumns : 4096));
  return node;
}

void SceneMaker::rotation(Key key, curtain::Rotation& value) {
  if (any_ ? choices_.oneIn(2) : !wants(key)) return;
  Eigen::Vector4d q = Eigen::Vector4d::Zero();
  for (int i = 0; i < 4; ++i) q[i] = choices_.between(-1.0, 1.0);
  if (q.norm() > 0.01) value = Eigen::Quaterniond(q).normalized();
}

void SceneMaker::nodes(Key, std::vector<NodeIndex>& values) {
  for (std::uint64_t left = 1 + choices_.below(4); left > 0; --left) values.push_back(pickNode());
}

// As many as are needed are taken of them when the cloth is known.
void SceneMaker::numbers(Key key, std::vector<double>& values, Range range) {
  if (!wants(key, 4)) return;
  for (int i = 0; i < (any_ ? 3 : 128); ++i) values.push_back(pick(range, 1.0));
}

// Their columns are made to fit when the cloth is known.
void SceneMaker::slits(Key key, std::vector<curtain::SlitParams>& values) {
  if (!wants(key, 4)) return;
  for (std::uint64_t left = any_ ? 3 : pickSize(); left > 0; --left)
    values.push_back({0, static_cast<int>(any_ || choices_.oneIn(2) ? choices_.below(8) : choices_.below(64))});
}

void SceneMaker::integers(Key key, std::vector<int>& values, curtain::IntRange range) {
  for (std::uint64_t left = any_ ? choices_.below(4) : wants(key) ? 3 : 0; left > 1; --left)
    values.push_back(pickInteger(range));
}

// Half of the scenes have no rail.
void SceneMaker::path(Key, std::vector<curtain::RailPiece>& pieces, Range range) {
  for (std::uint64_t left = any_ && choices_.oneIn(2) ? 0 : 2 + choices_.below(3); left > 0; --left) {
    pieces.emplace_back();
    pickVector(range, pieces.back().to);
    if (!choices_.oneIn(3)) continue;
    pieces.back().centre.emplace(Vec3::Zero());
    pickVector(range, *pieces.back().centre);
  }
}

void SceneMaker::pins(Key, curtain::PinParams& value) {
  value.kind = static_cast<curtain::PinKind>(choices_.below(curtain::pinNames().size() + 1));
  if (value.kind != curtain::PinKind::kList) return;
  for (std::uint64_t left = choices_.below(5); left > 0; --left) value.nodes.push_back(pickNode());
}

std::optional<Scene> makeScene(Choices& choices, Manner manner, int most) {
  Scene scene;
  SceneMaker maker(choices, manner);
  curtain::visitFields(maker, scene);
  fitTogether(scene, choices, manner, most);
  // Strips overlap where slits cut them from row 0 on, and not by much.
  const auto for_hangs = [&](const auto& change) {
    if (curtain::validate(scene).empty()) return;
    change(scene.hang);
    for (curtain::LayerParams& layer : scene.layers) change(layer.hang);
  };
  for_hangs([](curtain::HangParams& hang) { hang.overlap.reset(); });
  // Pressed pleats ask for bending, which asks for links that have a length, and another method than the paper's.
  for_hangs([](curtain::HangParams& hang) { hang.pressed = 0.0; });
  if (!curtain::validate(scene).empty()) {
    const auto make_limp = [&](curtain::ClothParams& cloth) {
      cloth.bending_warp = cloth.bending_weft = cloth.bending_hysteresis = 0.0;
      if (scene.solver.method == curtain::Method::kPaper) cloth.shear = cloth.bending_bias = 0.0;
      cloth.patches.clear();
    };
    make_limp(scene.cloth);
    for (curtain::LayerParams& layer : scene.layers) make_limp(layer.cloth);
  }
  if (!curtain::validate(scene).empty()) scene.layers.clear();
  if (!curtain::validate(scene).empty()) return std::nullopt;
  if (!curtain::problemsAtStart(scene, curtain::makePattern(scene)).empty()) {
    scene.lines.clear();
    scene.tie_back.clear();
  }
  // Cloths that touch must not begin crossed, or in the same place.
  const curtain::ClothPattern pattern = curtain::makePattern(scene);
  const curtain::Field3 start = makeInitialState(scene, pattern).position;
  if (!curtain::problemOfLayers(scene, pattern, start).empty()) scene.contact.self = false;
  if (manner != Manner::kAny) placeHands(scene, choices, pattern, start);
  return scene;
}

bool mayBegin(const Scene& scene) {
  try {
    const curtain::Simulator begins(scene, resolveTestMesh);
    return true;
  } catch (const std::invalid_argument&) {  // it begins in itself, or its links are too short to bend
    return false;
  }
}

}  // namespace curtain_test
