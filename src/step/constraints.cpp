// SPDX-License-Identifier: BSD-3-Clause
#include "step/constraints.h"

#include <numeric>

#include "cloth/wide.h"

namespace curtain {
namespace {

double middleRestOf(const ClothPattern& pattern) {
  const auto first = pattern.weft_rest.begin() + (pattern.grid.closed ? 0 : 1);
  const auto [shortest, longest] = std::minmax_element(first, pattern.weft_rest.begin() + pattern.grid.columns);
  return 0.5 * (*shortest + *longest);
}

}  // namespace

Constraints::Constraints(const ClothPattern& pattern, const SolverParts& parts, double tolerance,
                         const NodeInertia& inertia, const Workers& workers)
    : pattern_(pattern),
      inertia_(inertia),
      workers_(workers),
      net_(pattern, workers),
      guide_(parts.guide),
      mean_mass_(std::accumulate(pattern.mass.begin(), pattern.mass.end(), 0.0) /
                 static_cast<double>(pattern.grid.nodeCount())),
      middle_rest_(middleRestOf(pattern)),
      distances_(pattern, parts.rows, tolerance, middle_rest_),
      contacts_(middle_rest_) {
  const std::size_t size = pattern.grid.size();
  const std::size_t links = size + static_cast<std::size_t>(pattern.grid.stride);
  const auto blocks = static_cast<std::size_t>(warpBlockCount(pattern.grid));
  scratch_.assign(pattern.grid);
  warp_.assign(pattern.grid);
  weft_.assign(pattern.grid);
  weft_.max_give = tolerance;
  for (Field* field : {&last_warp_, &last_weft_, &best_.warp, &best_.weft, &rod_change_}) field->assign(links, 0.0);
  for (Field* field : {&violation_, &active_, &compliance_, &change_, &free_per_square_}) field->assign(size, 0.0);
  freeWeft(pattern, inertia.masses(), free_per_square_);
  next.assign(size, 0.0);
  best_.position.assign(size, 0.0);
  block_motion_.resize(blocks);
  block_progress_.resize(blocks);
  moved_.assign(size, 0.0);
  expectContacts(0);
  row_worst_.resize(static_cast<std::size_t>((pattern.grid.rows + kRowsAtOnce - 1) / kRowsAtOnce));
}

void Constraints::expectContacts(std::size_t count) {
  const std::size_t rows = 3 * count + distances_.all().size();
  net_.expectRows(rows);
  rows_.reserve(rows);
  contacts_.expect(count);
}

void Constraints::reset() noexcept {
  for (Field* field : {&last_warp_, &last_weft_, &weft_.multiplier}) std::fill(field->begin(), field->end(), 0.0);
  weft_pulls_ = false;
  if (guide_ != nullptr) guide_->forget();
  distances_.forget();
  net_.reset();
  scratch_.assign(pattern_.grid);
}

// ---- Begin and end of a substep

void Constraints::begin(const SubstepStart& start, const ClothState& state, double ratio, bool drives,
                        double gravity) noexcept {
  weight_ = mean_mass_ * gravity;
  per_scale_ = 1.0 / (start.h * start.kick);
  if (guide_ != nullptr) beginGuide(start, state);
  const LineSolve warp = rods(), weft = wefts();
  directions_set_ = measured_ = false;
  forEachBlock([&](int block) { warpBegin(start, warp, last_warp_, ratio, block); });
  if (weft_pulls_) {  // else all multipliers are zero, in weft_ too
    for (std::size_t n = 0; n < pattern_.grid.size(); ++n) weft_.multiplier[n] = ratio * last_weft_[n];
    directions_set_ = ratio != 0.0;
  }
  directions_set_ = distances_.begin(start, state, inertia_.inverse(), drives, ratio, next) || directions_set_;
  if (directions_set_) {
    worstOfRows([&](int i) {
      setWeftDirections(pattern_.grid, i, start.state.position, weft_.direction);
      pullWeft(weft, i, weft_.multiplier);
      return 0.0;
    });
    distances_.setDirections(start.state.position);
    distances_.pull(inertia_.inverse(), next);
  }
  settleGuide();
}

double Constraints::commit(const SubstepStart& start, bool tells_turning, ClothState& state, Field& load) noexcept {
  const LineSolve warp = rods();
  forEachBlock([&](int block) {
    block_motion_[static_cast<std::size_t>(block)] =
        warpFinish(warp, start.state.position, 1.0 / start.h, tells_turning, state.velocity, load, block);
  });
  double heaviest = 0.0;
  for (const WarpMotion& block : block_motion_) heaviest = std::max(heaviest, block.heaviest);
  weft_pulls_ = directions_set_ &&
                std::any_of(weft_.multiplier.begin(), weft_.multiplier.end(), [](double s) { return s != 0.0; });
  if (weft_pulls_) {
    heaviest = loadStrings(load);
    last_weft_ = weft_.multiplier;
  }
  heaviest = std::max(heaviest, distances_.commit(start, next, state, load));
  std::swap(state.position, next);
  std::swap(last_warp_, warp_.multiplier);
  return guide_ != nullptr ? std::max(heaviest, commitGuide(state, load)) : heaviest;
}

void Constraints::end(bool taken) noexcept {
  if (directions_set_ && (!taken || !weft_pulls_)) std::fill(weft_.multiplier.begin(), weft_.multiplier.end(), 0.0);
}

// Adds the strings' multipliers to the nodes' loads; returns the largest load over its mass.
CURTAIN_WIDE double Constraints::loadStrings(Field& loads) noexcept {
  const Grid& grid = pattern_.grid;
  const auto last = static_cast<std::size_t>(grid.columns) - 1;
  double worst = 0.0;
  for (int i = 0; i < grid.rows; ++i) {
    const std::size_t row = grid.row(i);
    const double* const f = weft_.multiplier.data() + row;
    const double* const w = pattern_.inverse_mass.data() + row;
    double* const load = loads.data() + row;
    load[last] += grid.closed ? f[last] + f[0] : f[last];
    worst = std::max(worst, load[last] * w[last]);
#pragma omp simd reduction(max : worst)
    for (std::size_t j = 0; j < last; ++j) {
      load[j] += f[j] + f[j + 1];
      const double heaviest = load[j] * w[j];
      worst = worst > heaviest ? worst : heaviest;
    }
  }
  return worst;
}

double Constraints::turning() const noexcept {
  double sum = 0.0;
  for (const WarpMotion& block : block_motion_) sum += block.turning;
  return sum;
}

Vec3 Constraints::pullAt(int row, int column, const Field& warp, const Field& weft, bool strings) const noexcept {
  const Grid& grid = pattern_.grid;
  const std::size_t n = grid.index(row, column);
  const auto stride = static_cast<std::size_t>(grid.stride);
  const bool last = column + 1 == grid.columns;
  const std::size_t right = last ? grid.index(row, 0) : n + 1;  // closed cloth: the first column's link closes the ring
  Vec3 pull = warp[n + stride] * warp_.direction.at(n + stride) - warp[n] * warp_.direction.at(n);
  if (!strings) return pull;
  pull -= weft[n] * weft_.direction.at(n);
  if (!last || grid.closed) pull += weft[right] * weft_.direction.at(right);
  return pull;
}

// Links are as long as at rest within the stretch tolerance.
Constraints::LinkTensions Constraints::tensionsAt(int row, int column, double scale) const noexcept {
  const std::size_t n = pattern_.grid.index(row, column);
  LinkTensions tensions;
  if (scale != 0.0 && row > 0) tensions.warp = last_warp_[n] * pattern_.warp_rest[n] / scale;
  if (scale != 0.0 && weft_pulls_) tensions.weft = last_weft_[n] * pattern_.weft_rest[n] / scale;
  return tensions;
}

void Constraints::pinsChanged() noexcept {
  freeWeft(pattern_, inertia_.masses(), free_per_square_);
  net_.reset();
}

void Constraints::slackenBetweenPins() noexcept {
  const Field& w = inertia_.masses();
  forEachLink(pattern_, [&](std::size_t n, std::size_t other, double, bool rod) {
    if (w[n] + w[other] == 0.0) (rod ? last_warp_ : last_weft_)[n] = 0.0;
  });
}

void Constraints::save(Memory& memory) const {
  memory.warp = last_warp_;
  memory.weft = last_weft_;
  memory.weft_pulls = weft_pulls_;
  distances_.save(memory.distances);
}

void Constraints::restore(const Memory& memory) {
  last_warp_ = memory.warp;
  last_weft_ = memory.weft;
  weft_pulls_ = memory.weft_pulls;
  distances_.restore(memory.distances);
  if (!weft_pulls_) std::fill(weft_.multiplier.begin(), weft_.multiplier.end(), 0.0);  // as begin() relies on
}

// Restores what reset() guarantees: strings have no multipliers but those of the last substep.
void Constraints::resume(const ClothState& state) noexcept {
  freeWeft(pattern_, inertia_.masses(), free_per_square_);
  for (Field* field : {&weft_.multiplier, &violation_, &active_, &change_})
    std::fill(field->begin(), field->end(), 0.0);
  distances_.resume(state);
  scratch_.assign(pattern_.grid);
  net_.reset();
}

}  // namespace curtain
