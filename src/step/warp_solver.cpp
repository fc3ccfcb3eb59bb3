// SPDX-License-Identifier: BSD-3-Clause
#include "step/warp_solver.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cloth/wide.h"

namespace curtain {
namespace {

// A pivot below this share of (w_a + w_b) l^2 means that the rod has turned by nearly 90 degrees from its direction.
constexpr double kSmallestPivot = 1e-9;
// The residual reported for such a rod.
constexpr double kUnsound = std::numeric_limits<double>::infinity();

// Violation and gradient of a rod from the nodal values.
struct PositionLevel {
  // C = (|r|^2 - l^2) / 2, its gradient r.
  static double violation(double rx, double ry, double rz, double, double, double, double rest_squared) {
    return 0.5 * (rx * rx + ry * ry + rz * rz - rest_squared);
  }
  static double gradient(double r, double) { return r; }
  static void settle(GuidedNodes& guided, int first, int end, Field3& value) {
    guided.settlePositions(first, end, value);
  }
};
struct VelocityLevel {
  // dC/dt = d . (v_b - v_a), its gradient d.
  static double violation(double rx, double ry, double rz, double dx, double dy, double dz, double) {
    return rx * dx + ry * dy + rz * dz;
  }
  static double gradient(double, double d) { return d; }
  static void settle(GuidedNodes& guided, int first, int end, Field3& value) {
    guided.settleVelocities(first, end, value);
  }
};

// Largest residual by column of a block, reduced once a block.
struct Worst {
  double of[kLane] = {};
  LineOutcome outcome() const {
    LineOutcome all;
    for (const double one : of) all.residual = std::max(all.residual, one);
    all.sound = all.residual < kUnsound;
    return all;
  }
};

// Forward elimination of row i of a block of columns, from offset first on, of the tridiagonal systems
//   -w_a (g.d_above) s_(i-1) + (w_a + w_b)(g.d) s_i - w_b (g.d_below) s_(i+1) = C,   g = gradient of C.
template <typename Level>
CURTAIN_INTO_WIDE void eliminateRow(const LineSolve& line, LineScratch& scratch, std::size_t first, Worst& worst) {
  const ClothPattern& pattern = line.pattern;
  const auto stride = static_cast<std::size_t>(pattern.grid.stride);
  const std::size_t above = first - stride;
  const ConstFieldView va(line.value, above), vb(line.value, first);
  const ConstFieldView d_above(line.links.direction, above), d(line.links.direction, first);
  const ConstFieldView d_below(line.links.direction, first + stride);
  const double* const wa = line.inverse_inertia.data() + above;
  const double* const wb = line.inverse_inertia.data() + first;
  const double* const rest = pattern.warp_rest.data() + first;
  const double* const per_square = pattern.warp_per_square.data() + first;
  const double* const e_above = scratch.elimination.data() + above;
  const double* const s_above = scratch.solution.data() + above;
  double* const e = scratch.elimination.data() + first;
  double* const s = scratch.solution.data() + first;
#pragma omp simd
  for (int j = 0; j < kLane; ++j) {
    const double rx = vb.x[j] - va.x[j], ry = vb.y[j] - va.y[j], rz = vb.z[j] - va.z[j];
    const double rest_squared = rest[j] * rest[j];
    const double c = Level::violation(rx, ry, rz, d.x[j], d.y[j], d.z[j], rest_squared);
    const double gx = Level::gradient(rx, d.x[j]), gy = Level::gradient(ry, d.y[j]), gz = Level::gradient(rz, d.z[j]);
    const double w = wa[j] + wb[j];
    const double diagonal = w * (gx * d.x[j] + gy * d.y[j] + gz * d.z[j]);
    const double lower = -wa[j] * (gx * d_above.x[j] + gy * d_above.y[j] + gz * d_above.z[j]);
    const double upper = -wb[j] * (gx * d_below.x[j] + gy * d_below.y[j] + gz * d_below.z[j]);
    const double pivot = diagonal - lower * e_above[j];
    const double smallest = kSmallestPivot * w * rest_squared;
    const double inverse = pivot > smallest ? 1.0 / pivot : 0.0;  // both ends pinned: 0, the rod stays as it is
    e[j] = upper * inverse;
    s[j] = (c - lower * s_above[j]) * inverse;
    const double relative = pivot > smallest ? std::abs(c) * per_square[j] : kUnsound;
    const double counted = w > 0.0 ? relative : 0.0;
    worst.of[j] = worst.of[j] > counted ? worst.of[j] : counted;
  }
}

// The same for the rods of row i that end at guided nodes.
template <typename Level>
void eliminateGuided(const LineSolve& line, LineScratch& scratch, int block, int i, Worst& worst) {
  const auto stride = static_cast<std::size_t>(line.pattern.grid.stride);
  // b^T W a at a node: what an impulse along a moves it by along b.
  const auto through = [&](int row, int column, const Vec3& b, const Vec3& a) {
    const GuidedNode* const guided = line.guided->at(row, column);
    return line.inverse_inertia[line.pattern.grid.index(row, column)] *
           (guided == nullptr ? b.dot(a) : b.dot(guided->newton * a));
  };
  const auto eliminate = [&](const GuidedNode&, int column) {
    const std::size_t n = line.pattern.grid.index(i, column), above = n - stride;
    const Vec3 r = line.value.at(n) - line.value.at(above), d = line.links.direction.at(n);
    const double rest_squared = line.pattern.warp_rest[n] * line.pattern.warp_rest[n];
    const double c = Level::violation(r.x(), r.y(), r.z(), d.x(), d.y(), d.z(), rest_squared);
    const Vec3 g(Level::gradient(r.x(), d.x()), Level::gradient(r.y(), d.y()), Level::gradient(r.z(), d.z()));
    const double diagonal = through(i - 1, column, g, d) + through(i, column, g, d);
    const double lower = -through(i - 1, column, g, line.links.direction.at(above));
    const double pivot = diagonal - lower * scratch.elimination[above];
    const double w = line.inverse_inertia[n] + line.inverse_inertia[above];
    const bool sound = pivot > kSmallestPivot * w * rest_squared;
    const double inverse = sound ? 1.0 / pivot : 0.0;
    scratch.elimination[n] = -through(i, column, g, line.links.direction.at(n + stride)) * inverse;
    scratch.solution[n] = (c - lower * scratch.solution[above]) * inverse;
    if (!sound && w > 0.0) worst.of[column % kLane] = kUnsound;
  };
  const int first = block * kLane, end = std::min(first + kLane, line.pattern.grid.columns);
  line.guided->forEach(i - 1, first, end, eliminate);
  line.guided->forEach(i, first, end, eliminate);
}

// Back substitution of the same row; moves its nodes.
CURTAIN_INTO_WIDE void substituteRow(const LineSolve& line, LineScratch& scratch, std::size_t first) {
  const auto stride = static_cast<std::size_t>(line.pattern.grid.stride);
  const FieldView v(line.value, first);
  const ConstFieldView d(line.links.direction, first), d_below(line.links.direction, first + stride);
  const double* const w = line.inverse_inertia.data() + first;
  const double* const e = scratch.elimination.data() + first;
  double* const s = scratch.solution.data() + first;
  const double* const s_below = s + stride;
  double* const multiplier = line.links.multiplier.data() + first;
#pragma omp simd
  for (int j = 0; j < kLane; ++j) {
    const double change = s[j] - e[j] * s_below[j];
    s[j] = change;
    multiplier[j] += change;
    v.x[j] -= w[j] * (change * d.x[j] - s_below[j] * d_below.x[j]);
    v.y[j] -= w[j] * (change * d.y[j] - s_below[j] * d_below.y[j]);
    v.z[j] -= w[j] * (change * d.z[j] - s_below[j] * d_below.z[j]);
  }
}

// The top row has no rod above it. A failed solve leaves 0 * NaN there, which must not reach the next one.
CURTAIN_INTO_WIDE void forgetTop(const LineSolve& line, LineScratch& scratch, std::size_t offset) {
  for (std::size_t j = offset; j < offset + kLane; ++j) scratch.solution[j] = line.links.multiplier[j] = 0.0;
}

// One Newton iteration on a block of columns. Row 0 of the scratch and the row after the last one are zero: no rod
// above, none below.
template <typename Level>
CURTAIN_INTO_WIDE LineOutcome newton(const LineSolve& line, LineScratch& scratch, int block) {
  const Grid& grid = line.pattern.grid;
  const auto offset = static_cast<std::size_t>(block) * kLane;
  Worst worst;
  for (int i = 1; i < grid.rows; ++i) {
    eliminateRow<Level>(line, scratch, grid.row(i) + offset, worst);
    if (line.guided != nullptr && (line.guided->inRow(i - 1) || line.guided->inRow(i)))
      eliminateGuided<Level>(line, scratch, block, i, worst);
  }
  for (int i = grid.rows - 1; i >= 0; --i) substituteRow(line, scratch, grid.row(i) + offset);
  forgetTop(line, scratch, offset);
  if (line.guided != nullptr) Level::settle(*line.guided, block * kLane, (block + 1) * kLane, line.value);
  return worst.outcome();
}

}  // namespace

void setWarpDirections(const Grid& grid, const Field3& position, Field3& direction) noexcept {
  for (int block = 0; block < warpBlockCount(grid); ++block) setWarpDirections(grid, block, position, direction);
}

CURTAIN_WIDE void setWarpDirections(const Grid& grid, int block, const Field3& position, Field3& direction) noexcept {
  const auto stride = static_cast<std::size_t>(grid.stride);
  for (int i = 1; i < grid.rows; ++i) {
    const std::size_t first = grid.row(i) + static_cast<std::size_t>(block) * kLane;
    const FieldView d(direction, first);
    const ConstFieldView below(position, first), above(position, first - stride);
#pragma omp simd
    for (int j = 0; j < kLane; ++j) {
      d.x[j] = below.x[j] - above.x[j];
      d.y[j] = below.y[j] - above.y[j];
      d.z[j] = below.z[j] - above.z[j];
    }
  }
}

// Predicts a row's nodes.
CURTAIN_INTO_WIDE void predictRow(const SubstepStart& start, const LineSolve& line, std::size_t first) {
  const ConstFieldView x(start.state.position, first), v(start.state.velocity, first), f(start.force, first);
  const FieldView next(line.value, first);
  const double* const w = line.inverse_inertia.data() + first;
  const double h = start.h, kick = start.kick;
  if (start.uniform != nullptr) {
    const double gx = kick * start.uniform->x(), gy = kick * start.uniform->y(), gz = kick * start.uniform->z();
#pragma omp simd
    for (int j = 0; j < kLane; ++j) {
      next.x[j] = x.x[j] + h * (v.x[j] + (w[j] > 0.0 ? gx : 0.0));
      next.y[j] = x.y[j] + h * (v.y[j] + (w[j] > 0.0 ? gy : 0.0));
      next.z[j] = x.z[j] + h * (v.z[j] + (w[j] > 0.0 ? gz : 0.0));
    }
  } else if (start.keep != nullptr) {
    const double* const keep = start.keep->data() + first;
#pragma omp simd
    for (int j = 0; j < kLane; ++j) {
      next.x[j] = x.x[j] + h * (keep[j] * v.x[j] + kick * w[j] * f.x[j]);
      next.y[j] = x.y[j] + h * (keep[j] * v.y[j] + kick * w[j] * f.y[j]);
      next.z[j] = x.z[j] + h * (keep[j] * v.z[j] + kick * w[j] * f.z[j]);
    }
  } else {
#pragma omp simd
    for (int j = 0; j < kLane; ++j) {
      next.x[j] = x.x[j] + h * (v.x[j] + kick * w[j] * f.x[j]);
      next.y[j] = x.y[j] + h * (v.y[j] + kick * w[j] * f.y[j]);
      next.z[j] = x.z[j] + h * (v.z[j] + kick * w[j] * f.z[j]);
    }
  }
}

// Sets direction and first multiplier of a row's rods, and moves the row above by these rods and its own.
CURTAIN_INTO_WIDE void hangRow(const SubstepStart& start, const LineSolve& line, const Field& last, double ratio,
                               std::size_t first, std::size_t stride) {
  const ConstFieldView x(start.state.position, first), above(start.state.position, first - stride);
  const ConstFieldView d_above(line.links.direction, first - stride);
  const FieldView d(line.links.direction, first), next_above(line.value, first - stride);
  double* const s = line.links.multiplier.data() + first;
  const double* const s_above = s - stride;
  const double* const s_last = last.data() + first;
  const double* const w_above = line.inverse_inertia.data() + first - stride;
#pragma omp simd
  for (int j = 0; j < kLane; ++j) {
    const double dx = x.x[j] - above.x[j], dy = x.y[j] - above.y[j], dz = x.z[j] - above.z[j];
    const double pull = ratio * s_last[j];
    d.x[j] = dx;
    d.y[j] = dy;
    d.z[j] = dz;
    s[j] = pull;
    next_above.x[j] -= w_above[j] * (s_above[j] * d_above.x[j] - pull * dx);
    next_above.y[j] -= w_above[j] * (s_above[j] * d_above.y[j] - pull * dy);
    next_above.z[j] -= w_above[j] * (s_above[j] * d_above.z[j] - pull * dz);
  }
}

// The lowest row has no rod below it.
CURTAIN_INTO_WIDE void hangHem(const LineSolve& line, std::size_t first) {
  const FieldView next(line.value, first);
  const ConstFieldView d(line.links.direction, first);
  const double* const w = line.inverse_inertia.data() + first;
  const double* const s = line.links.multiplier.data() + first;
#pragma omp simd
  for (int j = 0; j < kLane; ++j) {
    next.x[j] -= w[j] * (s[j] * d.x[j]);
    next.y[j] -= w[j] * (s[j] * d.y[j]);
    next.z[j] -= w[j] * (s[j] * d.z[j]);
  }
}

// One pass down a block of columns, while a row's neighbours are still in the cache.
CURTAIN_WIDE void warpBegin(const SubstepStart& start, const LineSolve& line, const Field& last, double ratio,
                            int block) noexcept {
  const Grid& grid = line.pattern.grid;
  const auto stride = static_cast<std::size_t>(grid.stride);
  const std::size_t offset = static_cast<std::size_t>(block) * kLane;
  predictRow(start, line, offset);
  for (int i = 1; i < grid.rows; ++i) {
    const std::size_t first = grid.row(i) + offset;
    predictRow(start, line, first);
    hangRow(start, line, last, ratio, first, stride);
  }
  hangHem(line, grid.row(grid.rows - 1) + offset);
}

template <bool kTurning>
CURTAIN_INTO_WIDE WarpMotion finishBlock(const LineSolve& line, const Field3& from, double per_step, Field3& velocity,
                                         Field& load, int block) {
  const Grid& grid = line.pattern.grid;
  const auto stride = static_cast<std::size_t>(grid.stride);
  Worst worst;
  double turning[kLane] = {};                                            // by column
  double above_x[kLane] = {}, above_y[kLane] = {}, above_z[kLane] = {};  // change of velocity in the row above
  for (int i = 0; i < grid.rows; ++i) {
    const std::size_t first = grid.row(i) + static_cast<std::size_t>(block) * kLane;
    const ConstFieldView to(line.value, first), at(from, first);
    const FieldView v(velocity, first);
    const double* const s = line.links.multiplier.data() + first;
    const double* const s_below = s + stride;
    const double* const w = line.pattern.inverse_mass.data() + first;
    const double* const per_square = line.pattern.warp_per_square.data() + first;
    double* const sum = load.data() + first;
    const double rods = i > 0 ? 1.0 : 0.0;  // the top row has none above
#pragma omp simd
    for (int j = 0; j < kLane; ++j) {
      const double vx = (to.x[j] - at.x[j]) * per_step, vy = (to.y[j] - at.y[j]) * per_step,
                   vz = (to.z[j] - at.z[j]) * per_step;
      if (kTurning) {
        const double ax = vx - v.x[j], ay = vy - v.y[j], az = vz - v.z[j];
        const double rx = ax - above_x[j], ry = ay - above_y[j], rz = az - above_z[j];
        turning[j] += rods * per_square[j] * (rx * rx + ry * ry + rz * rz);
        above_x[j] = ax;
        above_y[j] = ay;
        above_z[j] = az;
      }
      v.x[j] = vx;
      v.y[j] = vy;
      v.z[j] = vz;
      sum[j] = std::abs(s[j]) + std::abs(s_below[j]);
      const double heaviest = sum[j] * w[j];
      worst.of[j] = worst.of[j] > heaviest ? worst.of[j] : heaviest;
    }
  }
  WarpMotion motion{worst.outcome().residual, 0.0};
  for (const double column : turning) motion.turning += column;
  return motion;
}

CURTAIN_WIDE WarpMotion warpFinish(const LineSolve& line, const Field3& from, double per_step, bool tells_turning,
                                   Field3& velocity, Field& load, int block) noexcept {
  return tells_turning ? finishBlock<true>(line, from, per_step, velocity, load, block)
                       : finishBlock<false>(line, from, per_step, velocity, load, block);
}

CURTAIN_WIDE void pullWarp(const LineSolve& line, int block, const Field& multiplier) noexcept {
  const Grid& grid = line.pattern.grid;
  const auto stride = static_cast<std::size_t>(grid.stride);
  for (int i = 0; i < grid.rows; ++i) {
    const std::size_t first = grid.row(i) + static_cast<std::size_t>(block) * kLane;
    const FieldView v(line.value, first);
    const ConstFieldView d(line.links.direction, first), d_below(line.links.direction, first + stride);
    const double* const w = line.inverse_inertia.data() + first;
    const double* const s = multiplier.data() + first;
    const double* const s_below = s + stride;
#pragma omp simd
    for (int j = 0; j < kLane; ++j) {
      v.x[j] -= w[j] * (s[j] * d.x[j] - s_below[j] * d_below.x[j]);
      v.y[j] -= w[j] * (s[j] * d.y[j] - s_below[j] * d_below.y[j]);
      v.z[j] -= w[j] * (s[j] * d.z[j] - s_below[j] * d_below.z[j]);
    }
  }
}

CURTAIN_WIDE LineOutcome warpNewton(const LineSolve& line, LineScratch& scratch, int block) noexcept {
  return newton<PositionLevel>(line, scratch, block);
}

CURTAIN_WIDE LineOutcome warpProjectVelocity(const LineSolve& line, LineScratch& scratch, int block) noexcept {
  return newton<VelocityLevel>(line, scratch, block);
}

CURTAIN_WIDE double warpResidual(const LineSolve& line, int block) noexcept {
  const Grid& grid = line.pattern.grid;
  const auto stride = static_cast<std::size_t>(grid.stride);
  Worst worst;
  for (int i = 1; i < grid.rows; ++i) {
    const std::size_t first = grid.row(i) + static_cast<std::size_t>(block) * kLane;
    const ConstFieldView above(line.value, first - stride), below(line.value, first);
    const double* const wa = line.inverse_inertia.data() + first - stride;
    const double* const wb = line.inverse_inertia.data() + first;
    const double* const per_square = line.pattern.warp_per_square.data() + first;
#pragma omp simd
    for (int j = 0; j < kLane; ++j) {
      const double rx = below.x[j] - above.x[j], ry = below.y[j] - above.y[j], rz = below.z[j] - above.z[j];
      const double relative = 0.5 * std::abs((rx * rx + ry * ry + rz * rz) * per_square[j] - 1.0);
      const double counted = wa[j] + wb[j] > 0.0 ? relative : 0.0;
      worst.of[j] = worst.of[j] > counted ? worst.of[j] : counted;
    }
  }
  return worst.outcome().residual;
}

CURTAIN_WIDE Stretch warpStretch(const ClothPattern& pattern, const Field3& position) noexcept {
  const Grid& grid = pattern.grid;
  const auto stride = static_cast<std::size_t>(grid.stride);
  double longest = 1.0, shortest = 1.0;  // squared, over the rest length's square
  for (std::size_t row = stride; row < grid.row(grid.rows); row += stride) {
    const ConstFieldView above(position, row - stride), below(position, row);
    const double* const w = pattern.inverse_mass.data() + row;
    const double* const w_above = w - stride;
    const double* const per_square = pattern.warp_per_square.data() + row;
#pragma omp simd reduction(max : longest) reduction(min : shortest)
    for (std::size_t j = 0; j < stride; ++j) {
      const double rx = below.x[j] - above.x[j], ry = below.y[j] - above.y[j], rz = below.z[j] - above.z[j];
      const double square = w[j] + w_above[j] > 0.0 ? (rx * rx + ry * ry + rz * rz) * per_square[j] : 1.0;
      longest = longest > square ? longest : square;
      shortest = shortest < square ? shortest : square;
    }
  }
  return {std::sqrt(longest) - 1.0, 1.0 - std::sqrt(shortest)};
}

}  // namespace curtain
