// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "cloth/cloth.h"
#include "judge/court.h"

namespace curtain_test {

using namespace curtain;

namespace {

// What a verdict finds fault with first, without its figures; empty: it holds.
std::string kindOf(const TrialVerdict& verdict) {
  if (verdict.holds()) return {};
  const std::string& fault = verdict.faults.front();
  return fault.substr(0, fault.find_first_of("0123456789"));
}

}  // namespace

// Not to a scene that fails in another way, or takes longer than it may.
Drawn shrink(Drawn drawn, const Rigour& rigour) {
  const std::string kind = kindOf(judge(drawn, rigour));
  if (kind.empty()) return drawn;  // it does not fail in so little time
  const auto fails = [&](const Drawn& candidate) {
    return validate(candidate.scene).empty() &&
           problemsAtStart(candidate.scene, makePattern(candidate.scene)).empty() &&
           kindOf(judge(candidate, rigour)) == kind;
  };
  std::vector<std::function<bool(Drawn&)>> cuts;
  const auto cut = [&cuts](std::function<bool(Drawn&)> one) { cuts.push_back(std::move(one)); };
  cut([](Drawn& d) { return d.scene.obstacles.empty() ? false : (d.scene.obstacles.pop_back(), true); });
  cut([](Drawn& d) {
    return d.scene.obstacles.empty() ? false : (d.scene.obstacles.erase(d.scene.obstacles.begin()), true);
  });
  cut([](Drawn& d) { return d.scene.drag.empty() ? false : (d.scene.drag.pop_back(), true); });
  cut([](Drawn& d) { return d.scene.drag.empty() ? false : (d.scene.drag.erase(d.scene.drag.begin()), true); });
  cut([](Drawn& d) { return d.scene.wind.empty() ? false : (d.scene.wind.pop_back(), true); });
  cut([](Drawn& d) { return d.scene.wind.empty() ? false : (d.scene.wind.erase(d.scene.wind.begin()), true); });
  cut([](Drawn& d) { return d.scene.layers.empty() ? false : (d.scene.layers.clear(), true); });
  cut([](Drawn& d) { return d.scene.cloth.patches.empty() ? false : (d.scene.cloth.patches.clear(), true); });
  cut([](Drawn& d) { return d.scene.contact.self ? (d.scene.contact.self = false, true) : false; });
  cut([](Drawn& d) { return d.happenings.pin_swing.isZero() ? false : (d.happenings.pin_swing.setZero(), true); });
  cut([](Drawn& d) { return d.happenings.pin_jerk.isZero() ? false : (d.happenings.pin_jerk.setZero(), true); });
  cut([](Drawn& d) { return d.happenings.gravity.isZero() ? false : (d.happenings.gravity.setZero(), true); });
  cut([](Drawn& d) { return d.happenings.hands.empty() ? false : (d.happenings.hands.pop_back(), true); });
  cut([](Drawn& d) {
    return d.happenings.hands.size() < 2 ? false : (d.happenings.hands.erase(d.happenings.hands.begin()), true);
  });
  cut([](Drawn& d) { return d.scene.tie_back.empty() ? false : (d.scene.tie_back.clear(), true); });
  cut([](Drawn& d) { return d.scene.lines.empty() ? false : (d.scene.lines.pop_back(), true); });
  cut([](Drawn& d) { return d.scene.lines.empty() ? false : (d.scene.lines.clear(), true); });
  cut([](Drawn& d) { return d.happenings.opening < 0.0 ? false : (d.happenings.opening = -1.0, true); });
  cut([](Drawn& d) {
    return d.scene.air.inside + d.scene.air.border > 0.0 ? (d.scene.air = AirParams(), true) : false;
  });
  cut([](Drawn& d) {
    const bool relative = d.scene.air.law == AirLaw::kRelative;
    return relative ? (d.scene.air = AirParams(), d.scene.ambient = AmbientParams(), true) : false;
  });
  cut([](Drawn& d) { return d.scene.ambient.intensity > 0.0 ? (d.scene.ambient.intensity = 0.0, true) : false; });
  const auto plain = [](std::vector<double>& values) { return values.empty() ? false : (values.clear(), true); };
  cut([](Drawn& d) { return d.scene.cloth.slits.empty() ? false : (d.scene.cloth.slits.clear(), true); });
  cut([plain](Drawn& d) { return plain(d.scene.cloth.row_spacing); });
  cut([plain](Drawn& d) { return plain(d.scene.cloth.column_spacing); });
  cut([plain](Drawn& d) { return plain(d.scene.cloth.row_mass); });
  cut([plain](Drawn& d) { return plain(d.scene.cloth.column_mass); });
  const auto smaller = [](Drawn& d, int rows, int columns) {
    ClothParams& cloth = d.scene.cloth;
    rows = std::max(2, rows);
    columns = std::max(2, columns);
    const bool plain_grid = cloth.row_spacing.empty() && cloth.column_spacing.empty() && cloth.row_mass.empty() &&
                            cloth.column_mass.empty() && cloth.slits.empty() && cloth.patches.empty() &&
                            d.scene.layers.empty();
    if (!plain_grid || (rows == cloth.rows && columns == cloth.columns)) return false;
    const auto move = [&](NodeIndex& node) {
      node.row = node.row * (rows - 1) / (cloth.rows - 1);
      node.column = node.column * (columns - 1) / (cloth.columns - 1);
    };
    for (DragParams& drag : d.scene.drag) {
      if (drag.node) move(*drag.node);
    }
    for (NodeIndex& node : d.scene.pins.nodes) move(node);
    for (Hand& hand : d.happenings.hands) move(hand.node);
    cloth.rows = rows;
    cloth.columns = columns;
    return true;
  };
  cut([smaller](Drawn& d) { return smaller(d, d.scene.cloth.rows / 2, d.scene.cloth.columns / 2); });
  cut([smaller](Drawn& d) { return smaller(d, d.scene.cloth.rows / 2, d.scene.cloth.columns); });
  cut([smaller](Drawn& d) { return smaller(d, d.scene.cloth.rows, d.scene.cloth.columns / 2); });
  cut([smaller](Drawn& d) { return smaller(d, d.scene.cloth.rows - 1, d.scene.cloth.columns); });
  cut([smaller](Drawn& d) { return smaller(d, d.scene.cloth.rows, d.scene.cloth.columns - 1); });
  for (bool changed = true; changed;) {
    changed = false;
    for (const auto& one : cuts) {
      for (int times = 0; times < 64; ++times) {
        Drawn candidate = drawn;
        if (!one(candidate) || !fails(candidate)) break;
        drawn = candidate;
        changed = true;
      }
    }
  }
  return drawn;
}

}  // namespace curtain_test
