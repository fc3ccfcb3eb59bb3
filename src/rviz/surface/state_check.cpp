// SPDX-License-Identifier: BSD-3-Clause
#include "rviz/surface/state_check.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace curtain_rviz {
namespace {

// As scenes allow: [m], [m/s], [N].
constexpr float kLargest = 1e9F;
constexpr std::uint32_t kMaxFolds = 64;
// Of the drawn mesh: its indices have 32 bits, and what is beyond would not be seen.
constexpr std::uint64_t kMaxVertices = 1U << 26U;

/// Collects the first thing that is wrong.
class Check {
 public:
  void that(bool holds, const std::string& text) {
    if (!holds && wrong_.empty()) wrong_ = text;
  }
  /// As many numbers, each between least and kLargest.
  void numbers(const char* field, const std::vector<float>& values, std::uint64_t count, float least = -kLargest) {
    that(values.size() == count, std::string(field) + ": has " + std::to_string(values.size()) +
                                     " numbers, must have " + std::to_string(count));
    const bool sound = std::all_of(values.begin(), values.end(), [&](float x) { return x >= least && x <= kLargest; });
    that(sound, std::string(field) + ": a number is not finite or out of range");
  }
  const std::string& wrong() const { return wrong_; }

 private:
  std::string wrong_;
};

bool isSound(const curtain_sim::WindSource& wind) {
  const auto& p = wind.pose.position;
  const auto& q = wind.pose.orientation;
  const double norm = std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
  const auto within = [](double x) { return std::abs(x) <= 1e9; };
  return within(p.x) && within(p.y) && within(p.z) && norm > 1e-6 && norm <= 1e9 && wind.radius > 0.0 &&
         within(wind.radius) && wind.half_angle >= 0.0 && wind.half_angle <= 1.5 && wind.pressure >= 0.0 &&
         within(wind.pressure);
}

}  // namespace

std::string whatIsWrong(const curtain_sim::CurtainState& state) {
  Check check;
  check.that(state.rows >= 2 && state.columns >= 2, "rows, columns: must be at least 2");
  check.that(state.folds >= 1 && state.folds <= kMaxFolds, "folds: must be in [1, 64]");
  if (!check.wrong().empty()) return check.wrong();
  const std::uint64_t rows = state.rows, columns = state.columns, folds = state.folds;
  const std::uint64_t links = rows * (state.closed ? columns : columns - 1);
  check.that(rows <= kMaxVertices && links <= kMaxVertices && links * folds <= kMaxVertices,
             "rows, columns: too many to draw");
  if (!check.wrong().empty()) return check.wrong();
  constexpr float kSmallest = 1e-9F;
  check.numbers("positions", state.positions, 3 * rows * columns);
  check.numbers("velocities", state.velocities, 3 * rows * columns);
  check.numbers("warp_rest", state.warp_rest, rows - 1, kSmallest);
  check.numbers("weft_rest", state.weft_rest, links, kSmallest);
  check.numbers("fold_nodes", state.fold_nodes, state.fold_nodes.empty() ? 0 : 3 * links * (folds - 1));
  const bool pairs = state.slit_columns.size() == state.slit_rows.size();
  check.that(pairs && state.slit_columns.size() <= links / rows,
             "slit_columns, slit_rows: must be as many, one a link");
  const auto within = [](const std::vector<std::uint32_t>& numbers, std::uint64_t end) {
    return std::all_of(numbers.begin(), numbers.end(), [end](std::uint32_t number) { return number < end; });
  };
  check.that(within(state.slit_columns, links / rows), "slit_columns: there is no such link");
  check.that(within(state.slit_rows, rows), "slit_rows: there is no such row");
  for (const curtain_sim::WindSource& wind : state.winds) {
    check.that(isSound(wind), "winds: '" + wind.id + "' has a number that is not finite or out of range");
  }
  return check.wrong();
}

std::string whatIsWrong(const curtain_sim::Loads& loads, const curtain_sim::CurtainState& state) {
  Check check;
  check.that(loads.rows == state.rows && loads.columns == state.columns, "loads: are of another grid than the state");
  const std::uint64_t nodes = std::uint64_t{state.rows} * state.columns;
  check.numbers("warp_tension", loads.warp_tension, nodes);
  check.numbers("weft_tension", loads.weft_tension, nodes);
  check.numbers("contact_forces", loads.contact_forces, 3 * nodes);
  return check.wrong();
}

}  // namespace curtain_rviz
