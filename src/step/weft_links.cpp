// SPDX-License-Identifier: BSD-3-Clause
#include "step/weft_links.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cloth/wide.h"

namespace curtain {
namespace {

struct LinkRow {
  const double *x, *y, *z, *w, *s, *per_square;
  double compliance, max_give;
  LinkRow(const LineSolve& line, int i) {
    const std::size_t row = line.pattern.grid.row(i);
    x = line.value.x.data() + row;
    y = line.value.y.data() + row;
    z = line.value.z.data() + row;
    w = line.inverse_inertia.data() + row;
    s = line.links.multiplier.data() + row;
    per_square = line.pattern.weft_per_square.data() + row;
    compliance = line.links.compliance;
    max_give = line.links.max_give;
  }
};

struct Link {
  double violation;  // relative; 0 where no end can move
  double active;
  double compliance;  // WeftFields::compliance
  double not_finite;  // 0, or NaN when a position at its ends is not finite
};

// What is looked for the largest of, and Link::not_finite.
struct Size {
  double size, not_finite;
};

// A link takes part when it is too long or still pulls, and has an end that can move.
CURTAIN_INTO_WIDE Link linkAt(const LinkRow& row, std::size_t left, std::size_t right) {
  const double rx = row.x[right] - row.x[left], ry = row.y[right] - row.y[left], rz = row.z[right] - row.z[left];
  const double both = row.w[right] + row.w[left];
  const double load = row.compliance * row.s[right];
  const double stiff = 1.0 / (1.0 + load / row.max_give), give = stiff * load;
  const double c = 0.5 * ((rx * rx + ry * ry + rz * rz) * row.per_square[right] - 1.0) - give;
  const double active = ((both > 0.0) & ((c > 0.0) | (row.s[right] > 0.0))) ? 1.0 : 0.0;
  const double compliance = stiff * stiff * row.compliance / both;
  const double not_finite = 0.0 * c;  // 0 * x is NaN for NaN and infinity alike
  return {both > 0.0 ? c : 0.0, active, both > 0.0 ? compliance : 0.0, not_finite};
}

// Largest sizeOf(left, right) of a row's links, called once for each; infinite when a position is not finite.
template <typename SizeOf>
CURTAIN_INTO_WIDE double largestOf(const Grid& grid, const SizeOf& sizeOf) {
  const auto columns = static_cast<std::size_t>(grid.columns);
  double worst = 0.0, finite = 0.0;
#pragma omp simd reduction(max : worst) reduction(+ : finite)
  for (std::size_t j = 1; j < columns; ++j) {
    const Size link = sizeOf(j - 1, j);
    worst = worst > link.size ? worst : link.size;
    finite += link.not_finite;
  }
  if (grid.closed) worst = std::max(worst, sizeOf(columns - 1, 0).size);
  return finite == 0.0 ? worst : std::numeric_limits<double>::infinity();
}

}  // namespace

CURTAIN_WIDE void setWeftDirections(const Grid& grid, int row, const Field3& position, Field3& direction) noexcept {
  const auto columns = static_cast<std::size_t>(grid.columns);
  const auto difference = [&grid, row, columns](const Field& from, Field& to) {
    const double* const p = from.data() + grid.row(row);
    double* const out = to.data() + grid.row(row);
#pragma omp simd
    for (std::size_t j = 1; j < columns; ++j) out[j] = p[j] - p[j - 1];
    if (grid.closed) out[0] = p[0] - p[columns - 1];
  };
  difference(position.x, direction.x);
  difference(position.y, direction.y);
  difference(position.z, direction.z);
}

void freeWeft(const ClothPattern& pattern, const Field& inverse_mass, Field& out) noexcept {
  const Grid& grid = pattern.grid;
  for (int i = 0; i < grid.rows; ++i) {
    for (int j = grid.closed ? 0 : 1; j < grid.columns; ++j) {
      const std::size_t right = grid.index(i, j), left = grid.index(i, j > 0 ? j - 1 : grid.columns - 1);
      const bool free = inverse_mass[left] + inverse_mass[right] > 0.0;
      out[right] = free ? pattern.weft_per_square[right] : 0.0;
    }
  }
}

CURTAIN_WIDE double weftSquare(const Grid& grid, int i, const Field3& position, const Field& free_per_square) noexcept {
  const ConstFieldView p(position, grid.row(i));
  const double* const per_square = free_per_square.data() + grid.row(i);
  return largestOf(grid, [=](std::size_t left, std::size_t right) -> Size {
    const double rx = p.x[right] - p.x[left], ry = p.y[right] - p.y[left], rz = p.z[right] - p.z[left];
    const double square = (rx * rx + ry * ry + rz * rz) * per_square[right];
    return {square, 0.0 * square};
  });
}

CURTAIN_WIDE double measureWeft(const LineSolve& line, int i, const WeftFields& out) noexcept {
  const Grid& grid = line.pattern.grid;
  const LinkRow row(line, i);
  const double* const rest = line.pattern.weft_rest.data() + grid.row(i);
  double* const c_out = out.violation.data() + grid.row(i);
  double* const active_out = out.active.data() + grid.row(i);
  double* const compliance_out = out.compliance.data() + grid.row(i);
  return largestOf(grid, [=](std::size_t left, std::size_t right) -> Size {
    const Link link = linkAt(row, left, right);
    active_out[right] = link.active;
    compliance_out[right] = link.compliance;
    c_out[right] = link.violation * rest[right] * rest[right];
    return {link.active * std::abs(link.violation), link.not_finite};
  });
}

double measureWeftRates(const LineSolve& line, int i, Field& violation, Field& active) noexcept {
  const Grid& grid = line.pattern.grid;
  double worst = 0.0;
  for (int j = grid.closed ? 0 : 1; j < grid.columns; ++j) {
    const std::size_t right = grid.index(i, j);
    const std::size_t left = grid.index(i, j > 0 ? j - 1 : grid.columns - 1);
    const bool pulls = line.links.multiplier[right] > 0.0;
    active[right] = pulls ? 1.0 : 0.0;
    violation[right] = pulls ? line.links.direction.at(right).dot(line.value.at(right) - line.value.at(left)) : 0.0;
    worst = std::max(worst, std::abs(violation[right]) * line.pattern.weft_per_square[right]);
  }
  return worst;
}

CURTAIN_WIDE void applyWeftChange(LinkSet& links, const Grid& grid, int i, Field& change) noexcept {
  double* const s = links.multiplier.data() + grid.row(i);
  double* const ds = change.data() + grid.row(i);
#pragma omp simd
  for (int j = 0; j < grid.columns; ++j) {
    const double most = -s[j];
    ds[j] = ds[j] > most ? ds[j] : most;
    s[j] += ds[j];
  }
}

// Node j is the right end of link j and the left end of link j + 1.
CURTAIN_WIDE void pullWeft(const LineSolve& line, int i, const Field& multiplier) noexcept {
  const Grid& grid = line.pattern.grid;
  const std::size_t row = grid.row(i);
  const auto last = static_cast<std::size_t>(grid.columns) - 1;
  const double* const w = line.inverse_inertia.data() + row;
  const double* const s = multiplier.data() + row;
  const auto pull = [=, &grid](const Field& direction, Field& value) {
    const double* const d = direction.data() + row;
    double* const v = value.data() + row;
#pragma omp simd
    for (std::size_t j = 0; j < last; ++j) v[j] += w[j] * (s[j + 1] * d[j + 1] - s[j] * d[j]);
    v[last] += w[last] * ((grid.closed ? s[0] * d[0] : 0.0) - s[last] * d[last]);
  };
  pull(line.links.direction.x, line.value.x);
  pull(line.links.direction.y, line.value.y);
  pull(line.links.direction.z, line.value.z);
}

CURTAIN_WIDE double weftMoveSquared(const LineSolve& line, int i, const Field& multiplier) noexcept {
  const Grid& grid = line.pattern.grid;
  const std::size_t row = grid.row(i);
  const auto last = static_cast<std::size_t>(grid.columns) - 1;
  const double* const w = line.inverse_inertia.data() + row;
  const double* const s = multiplier.data() + row;
  const ConstFieldView d(line.links.direction, row);
  const double* const per_square = line.pattern.weft_per_square.data() + row;
  double worst = 0.0;
#pragma omp simd reduction(max : worst)
  for (std::size_t j = 0; j < last; ++j) {
    const double x = w[j] * (s[j + 1] * d.x[j + 1] - s[j] * d.x[j]);
    const double y = w[j] * (s[j + 1] * d.y[j + 1] - s[j] * d.y[j]);
    const double z = w[j] * (s[j + 1] * d.z[j + 1] - s[j] * d.z[j]);
    const double size = (x * x + y * y + z * z) * per_square[j + 1];
    worst = worst > size ? worst : size;
  }
  const auto wrapped = [&](const double* along) {
    return w[last] * ((grid.closed ? s[0] * along[0] : 0.0) - s[last] * along[last]);
  };
  const double x = wrapped(d.x), y = wrapped(d.y), z = wrapped(d.z);
  return std::max(worst, (x * x + y * y + z * z) * per_square[last]);
}

CURTAIN_WIDE double weftStretch(const ClothPattern& pattern, const Field3& position) noexcept {
  const Grid& grid = pattern.grid;
  const auto columns = static_cast<std::size_t>(grid.columns);
  double longest = 1.0;  // squared, over the rest length's square
  for (int i = 0; i < grid.rows; ++i) {
    const ConstFieldView p(position, grid.row(i));
    const double* const w = pattern.inverse_mass.data() + grid.row(i);
    const double* const per_square = pattern.weft_per_square.data() + grid.row(i);
    const auto square = [=](std::size_t left, std::size_t right) {
      const double rx = p.x[right] - p.x[left], ry = p.y[right] - p.y[left], rz = p.z[right] - p.z[left];
      return w[left] + w[right] > 0.0 ? (rx * rx + ry * ry + rz * rz) * per_square[right] : 1.0;
    };
#pragma omp simd reduction(max : longest)
    for (std::size_t j = 1; j < columns; ++j) {
      const double size = square(j - 1, j);
      longest = longest > size ? longest : size;
    }
    if (grid.closed) longest = std::max(longest, square(columns - 1, 0));
  }
  for (std::size_t k = 1; k < pattern.guided.size(); ++k) {  // guided at both ends
    const std::size_t left = pattern.guided[k - 1], right = left + 1;
    if (pattern.guided[k] != right) continue;
    longest =
        std::max(longest, (position.at(right) - position.at(left)).squaredNorm() * pattern.weft_per_square[right]);
  }
  return std::sqrt(longest) - 1.0;
}

}  // namespace curtain
