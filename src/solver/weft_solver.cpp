// SPDX-License-Identifier: BSD-3-Clause
#include "solver/weft_solver.h"

#include <algorithm>
#include <cmath>

#include "cloth/wide.h"

namespace curtain {
namespace {

constexpr double kSmallestPivot = 1e-9;  // as in the warp: share of (w_a + w_b) l^2
constexpr int kRowIterations = 4;        // Newton iterations on one row per sweep; the sweeps go on anyway

Vec3 across(const Field3& value, std::size_t left, std::size_t right) { return value.at(right) - value.at(left); }

// Violation C = (|r|^2 - l^2) / 2 of one link, less what its compliance allows, over l^2.
double violation(const LineSolve& line, std::size_t left, std::size_t right) {
  const double w = line.inverse_inertia[left] + line.inverse_inertia[right];
  return 0.5 * (across(line.value, left, right).squaredNorm() * line.pattern.weft_per_square[right] - 1.0) -
         kWeftCompliance * w * line.links.multiplier[right];
}

// A link takes part when it is too long or still pulls, and has an end that can move.
bool takesPart(const LineSolve& line, std::size_t left, std::size_t right, double c) {
  return line.inverse_inertia[left] + line.inverse_inertia[right] > 0.0 &&
         (c > 0.0 || line.links.multiplier[right] > 0.0);
}

}  // namespace

WeftSolver::WeftSolver(const Grid& grid) : system_(static_cast<std::size_t>(grid.columns)) {
  links_.reserve(static_cast<std::size_t>(grid.columns));
  active_.assign(static_cast<std::size_t>(grid.columns), 0.0);
  violation_ = active_;
  before_ = active_;
}

void WeftSolver::setDirections(const Grid& grid, const Field3& position, Field3& direction) noexcept {
  const auto difference = [&grid](const Field& from, Field& to) {
    for (int i = 0; i < grid.rows; ++i) {
      const double* const p = from.data() + grid.row(i);
      double* const out = to.data() + grid.row(i);
#pragma omp simd
      for (int j = 1; j < grid.columns; ++j) out[j] = p[j] - p[j - 1];
      if (grid.closed) out[0] = p[0] - p[grid.columns - 1];
    }
  };
  difference(position.x, direction.x);
  difference(position.y, direction.y);
  difference(position.z, direction.z);
}

void WeftSolver::applyMultipliers(const LineSolve& line) noexcept {
  const Grid& grid = line.pattern.grid;
  for (int i = 0; i < grid.rows; ++i) {
    for (int j = grid.closed ? 0 : 1; j < grid.columns; ++j) {
      const std::size_t right = grid.index(i, j);
      const double s = line.links.multiplier[right];
      if (s == 0.0) continue;
      const std::size_t left = grid.index(i, j > 0 ? j - 1 : grid.columns - 1);
      const Vec3 pull = s * line.links.direction.at(right);
      line.value.add(left, line.inverse_inertia[left] * pull);
      line.value.add(right, -line.inverse_inertia[right] * pull);
    }
  }
}

void WeftSolver::listLinks(const Grid& grid, int row) noexcept {
  links_.clear();
  const std::size_t first = grid.row(row);
  const auto columns = static_cast<std::size_t>(grid.columns);
  for (std::size_t j = grid.closed ? 0 : 1; j < columns; ++j) {
    links_.push_back({first + (j > 0 ? j - 1 : columns - 1), first + j});
  }
}

// The links of a row between neighbouring columns are one loop without a branch, so that it widens.
CURTAIN_WIDE double WeftSolver::measurePositions(const LineSolve& line, int i) noexcept {
  const Grid& grid = line.pattern.grid;
  const std::size_t row = grid.row(i);
  const auto columns = static_cast<std::size_t>(grid.columns);
  const double* const x = line.value.x.data() + row;
  const double* const y = line.value.y.data() + row;
  const double* const z = line.value.z.data() + row;
  const double* const w = line.inverse_inertia.data() + row;
  const double* const s = line.links.multiplier.data() + row;
  const double* const rest = line.pattern.weft_rest.data() + row;
  const double* const per_square = line.pattern.weft_per_square.data() + row;
  double* const c_out = violation_.data();
  double* const active_out = active_.data();
  double worst = 0.0;
#pragma omp simd reduction(max : worst)
  for (std::size_t j = 1; j < columns; ++j) {
    const double rx = x[j] - x[j - 1], ry = y[j] - y[j - 1], rz = z[j] - z[j - 1];
    const double both = w[j] + w[j - 1];
    const double c =
        0.5 * ((rx * rx + ry * ry + rz * rz) * per_square[j] - 1.0) - kWeftCompliance * both * s[j];
    const double active = ((both > 0.0) & ((c > 0.0) | (s[j] > 0.0))) ? 1.0 : 0.0;
    const double size = active * std::abs(c);
    active_out[j] = active;
    c_out[j] = active * c * rest[j] * rest[j];
    worst = worst > size ? worst : size;
  }
  if (grid.closed) {
    const double c = violation(line, row + columns - 1, row);
    active_[0] = takesPart(line, row + columns - 1, row, c) ? 1.0 : 0.0;
    violation_[0] = active_[0] * c * rest[0] * rest[0];
    worst = std::max(worst, active_[0] * std::abs(c));
  }
  return worst;
}

double WeftSolver::measureVelocities(const LineSolve& line, int i) noexcept {
  double worst = 0.0;
  for (const Link& link : links_) {
    const std::size_t j = link.right - line.pattern.grid.row(i);
    const double rest = line.pattern.weft_rest[link.right];
    const bool active = line.links.multiplier[link.right] > 0.0;
    active_[j] = active ? 1.0 : 0.0;
    const double rate =
        active ? line.links.direction.at(link.right).dot(across(line.value, link.left, link.right)) : 0.0;
    violation_[j] = rate;
    worst = std::max(worst, std::abs(rate) / (rest * rest));
  }
  return worst;
}

// Row p: link p against the links that share its left and its right node. In an open row the first has none on its
// left and the last none on its right; the system never looks at those entries.
void WeftSolver::buildMatrix(const LineSolve& line, bool velocity_level) noexcept {
  const std::size_t count = links_.size();
  const Field& w = line.inverse_inertia;
  // Links are listed by their columns, from this one on.
  const double* const active = active_.data() + (line.pattern.grid.closed ? 0 : 1);
  const double* const violation = violation_.data() + (line.pattern.grid.closed ? 0 : 1);
  for (std::size_t p = 0; p < count; ++p) {
    system_.rhs[p] = violation[p];
    if (active[p] == 0.0) {
      system_.diagonal[p] = 1.0;
      system_.lower[p] = system_.upper[p] = system_.smallest[p] = 0.0;
      continue;
    }
    const Link& link = links_[p];
    const Vec3 d = line.links.direction.at(link.right);
    const Vec3 gradient = velocity_level ? d : across(line.value, link.left, link.right);
    const double rest = line.pattern.weft_rest[link.right];
    const double scale = (w[link.left] + w[link.right]) * rest * rest;
    const std::size_t before = p > 0 ? p - 1 : count - 1;
    const std::size_t after = p + 1 < count ? p + 1 : 0;
    system_.diagonal[p] = (w[link.left] + w[link.right]) * gradient.dot(d) + kWeftCompliance * scale;
    system_.lower[p] = -w[link.left] * gradient.dot(line.links.direction.at(links_[before].right)) * active[before];
    system_.upper[p] = -w[link.right] * gradient.dot(line.links.direction.at(links_[after].right)) * active[after];
    system_.smallest[p] = kSmallestPivot * scale;
  }
}

void WeftSolver::movePositions(const LineSolve& line) noexcept {
  const Field& w = line.inverse_inertia;
  for (std::size_t p = 0; p < links_.size(); ++p) {
    if (system_.rhs[p] == 0.0) continue;  // does not take part
    const Link& link = links_[p];
    double& s = line.links.multiplier[link.right];
    const double change = std::max(system_.rhs[p], -s);  // a string only pulls
    s += change;
    const Vec3 pull = change * line.links.direction.at(link.right);
    line.value.add(link.left, w[link.left] * pull);
    line.value.add(link.right, -w[link.right] * pull);
  }
}

void WeftSolver::moveVelocities(const LineSolve& line) noexcept {
  for (std::size_t p = 0; p < links_.size(); ++p) {
    if (system_.rhs[p] == 0.0) continue;  // does not pull
    const Link& link = links_[p];
    const Vec3 pull = system_.rhs[p] * line.links.direction.at(link.right);
    line.value.add(link.left, line.inverse_inertia[link.left] * pull);
    line.value.add(link.right, -line.inverse_inertia[link.right] * pull);
  }
}

// Takes the row's last solve so much further than it went, as far as strings that only pull allow.
void WeftSolver::relaxFurther(const LineSolve& line, double share) noexcept {
  const Field& w = line.inverse_inertia;
  for (std::size_t p = 0; p < links_.size(); ++p) {
    const Link& link = links_[p];
    double& s = line.links.multiplier[link.right];
    const double change = std::max(share * (s - before_[p]), -s);
    if (change == 0.0) continue;
    s += change;
    const Vec3 pull = change * line.links.direction.at(link.right);
    line.value.add(link.left, w[link.left] * pull);
    line.value.add(link.right, -w[link.right] * pull);
  }
}

LineOutcome WeftSolver::solve(const LineSolve& line, double tolerance, double leave_alone, bool follow_directions,
                              double further) noexcept {
  const Grid& grid = line.pattern.grid;
  LineOutcome outcome;
  for (int i = 0; i < grid.rows; ++i) {
    double residual = measurePositions(line, i);
    outcome.residual = std::max(outcome.residual, residual);
    if (!(residual > leave_alone)) continue;
    listLinks(grid, i);
    for (std::size_t p = 0; p < links_.size(); ++p) before_[p] = line.links.multiplier[links_[p].right];
    for (int iteration = 0; iteration < kRowIterations && (iteration == 0 || residual > tolerance); ++iteration) {
      if (follow_directions) {
        for (const Link& link : links_) line.links.direction.set(link.right, across(line.value, link.left, link.right));
      }
      buildMatrix(line, false);
      outcome.sound = system_.solve(links_.size(), grid.closed) && outcome.sound;
      movePositions(line);
      residual = measurePositions(line, i);
    }
    outcome.solved = outcome.solved && residual <= tolerance;
    if (further > 0.0) relaxFurther(line, further);
  }
  return outcome;
}

double WeftSolver::residual(const LineSolve& line) noexcept {
  double worst = 0.0;
  for (int i = 0; i < line.pattern.grid.rows; ++i) worst = std::max(worst, measurePositions(line, i));
  return worst;
}

LineOutcome WeftSolver::projectVelocity(const LineSolve& line) noexcept {
  const Grid& grid = line.pattern.grid;
  LineOutcome outcome;
  for (int i = 0; i < grid.rows; ++i) {
    listLinks(grid, i);
    const double rate = measureVelocities(line, i);
    outcome.residual = std::max(outcome.residual, rate);
    if (rate == 0.0) continue;
    buildMatrix(line, true);
    outcome.sound = system_.solve(links_.size(), grid.closed) && outcome.sound;
    moveVelocities(line);
  }
  return outcome;
}

double weftStretch(const ClothPattern& pattern, const Field3& position) noexcept {
  const Grid& grid = pattern.grid;
  double longest = 0.0;
  for (int i = 0; i < grid.rows; ++i) {
    for (int j = grid.closed ? 0 : 1; j < grid.columns; ++j) {
      const std::size_t right = grid.index(i, j);
      const std::size_t left = grid.index(i, j > 0 ? j - 1 : grid.columns - 1);
      if (pattern.inverse_mass[left] + pattern.inverse_mass[right] <= 0.0) continue;
      const double relative = across(position, left, right).norm() / pattern.weft_rest[right] - 1.0;
      longest = std::max(longest, relative);
    }
  }
  return longest;
}

}  // namespace curtain
