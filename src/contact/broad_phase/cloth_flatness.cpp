// SPDX-License-Identifier: BSD-3-Clause
#include "contact/broad_phase/cloth_flatness.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cloth/wide.h"

namespace curtain {
namespace {

// Longest strips and spans [links]. Longer ones are fewer to check but bound the slopes between less.
constexpr int kMaxRods = 2, kMaxWefts = 20;
// Largest relative difference of rest lengths: the bound assumes a regular reference mesh.
constexpr double kIrregular = 1e-6;
// Covers rounding of slopes and kIrregular.
constexpr double kFlatnessRounding = 1e-5;

struct Extremes {
  double min_square, least, max_across;
};

// Over vectors from nodes to nodes, `stride` apart: squared length, component along one direction, and across it.
CURTAIN_INTO_WIDE Extremes extremes(const ConstFieldView& from, const ConstFieldView& to, std::size_t count,
                                    std::size_t stride, const Vec3& along, const Vec3& across) noexcept {
  const double *const ax = from.x, *const ay = from.y, *const az = from.z;
  const double *const bx = to.x, *const by = to.y, *const bz = to.z;
  const double px = along.x(), py = along.y(), pz = along.z(), qx = across.x(), qy = across.y(), qz = across.z();
  double min_square = 1e300, least = 1e300, max_across = 0.0;
#pragma omp simd reduction(min : min_square, least) reduction(max : max_across)
  for (std::size_t n = 0; n < count; ++n) {
    const std::size_t k = n * stride;
    const double x = bx[k] - ax[k], y = by[k] - ay[k], z = bz[k] - az[k];
    const double square = x * x + y * y + z * z, p = x * px + y * py + z * pz, q = std::abs(x * qx + y * qy + z * qz);
    min_square = min_square < square ? min_square : square;
    least = least < p ? least : p;
    max_across = max_across > q ? max_across : q;
  }
  return {min_square, least, max_across};
}

CURTAIN_WIDE Extremes extremesOfRow(const ConstFieldView& from, const ConstFieldView& to, std::size_t count,
                                    const Vec3& along, const Vec3& across) noexcept {
  return extremes(from, to, count, 1, along, across);
}

CURTAIN_WIDE Extremes extremesOfColumn(const ConstFieldView& from, const ConstFieldView& to, std::size_t count,
                                       std::size_t stride, const Vec3& along, const Vec3& across) noexcept {
  return extremes(from, to, count, stride, along, across);
}

// Along the warp [m]; used of regular cloth only, whose columns are alike.
Field rowsOf(const ClothPattern& pattern, int column) {
  Field rows;
  for (int i = 0; i < pattern.grid.rows; ++i) rows.push_back(pattern.warp_coordinate[pattern.grid.index(i, column)]);
  return rows;
}

// Whether no link of the top row from column `first` to `end` exceeds this squared ratio to its rest length.
CURTAIN_WIDE bool holdsRow(const ClothPattern& pattern, std::size_t first, std::size_t end, const Field3& position,
                           double max_square) noexcept {
  const double *const x = position.x.data(), *const y = position.y.data(), *const z = position.z.data();
  const double* const per_square = pattern.weft_per_square.data();
  double most = 0.0;
#pragma omp simd reduction(max : most)
  for (std::size_t j = first + 1; j < end; ++j) {
    const double dx = x[j] - x[j - 1], dy = y[j] - y[j - 1], dz = z[j] - z[j - 1];
    const double square = (dx * dx + dy * dy + dz * dz) * per_square[j];
    most = most > square ? most : square;
  }
  return most <= max_square;
}

}  // namespace

ClothFlatness::ClothFlatness(const ClothPattern& pattern, int first, int end, double overlong)
    : pattern_(pattern),
      first_(first),
      end_column_(end),
      overlong_(overlong),
      regular_(isRegular()),
      strips_(spansOf(rowsOf(pattern, first), kMaxRods)),
      spans_(spansOf({pattern.weft_coordinate.begin() + first, pattern.weft_coordinate.begin() + end}, kMaxWefts)) {
  for (Span& span : spans_) {
    span.first += static_cast<std::size_t>(first);
    span.last += static_cast<std::size_t>(first);
  }
  const Grid& grid = pattern.grid;
  const double per_u = 1.0 / pattern.weft_rest[grid.index(0, first + 1)];
  const double per_v = 1.0 / pattern.warp_rest[grid.index(1, first)];
  per_altitude_ = std::sqrt(per_u * per_u + per_v * per_v);
  pinsChanged();
}

void ClothFlatness::pinsChanged() noexcept {
  const Grid& grid = pattern_.grid;
  usable_ = regular_;
  checks_top_ = false;
  for (int i = 0; i < grid.rows; ++i) {
    for (int j = first_; j < end_column_; ++j) {
      const std::size_t n = grid.index(i, j);
      if (pattern_.canMove(n)) continue;
      // Links between pins are not bounded by the solve. Those of the top row are checked; for others the proof is not
      // used.
      if (i > 0 && !pattern_.canMove(grid.index(i - 1, j))) usable_ = false;
      if (j == first_ || pattern_.canMove(n - 1)) continue;
      if (i == 0)
        checks_top_ = true;
      else
        usable_ = false;
    }
  }
}

bool ClothFlatness::isRegular() const {
  const Grid& grid = pattern_.grid;
  if (grid.closed) return false;
  const auto isLike = [](double rest, double first) { return std::abs(rest / first - 1.0) <= kIrregular; };
  const double u = pattern_.weft_rest[grid.index(0, first_ + 1)], v = pattern_.warp_rest[grid.index(1, first_)];
  for (int i = 0; i < grid.rows; ++i) {
    for (int j = first_; j < end_column_; ++j) {
      const std::size_t n = grid.index(i, j);
      if (i > 0 && !isLike(pattern_.warp_rest[n], v)) return false;
      if (j > first_ && !(grid.hasLink(i, j) && isLike(pattern_.weft_rest[n], u))) return false;
    }
  }
  return true;
}

std::vector<ClothFlatness::Span> ClothFlatness::spansOf(const Field& coordinate, int max_links) {
  const int links = static_cast<int>(coordinate.size()) - 1, count = (links + max_links - 1) / max_links;
  std::vector<Span> spans;
  for (int k = 0; k < count; ++k) {
    const auto first = static_cast<std::size_t>(k * links / count);
    const auto last = static_cast<std::size_t>((k + 1) * links / count);
    spans.push_back({first, last, 1.0 / (coordinate[last] - coordinate[first]), static_cast<double>(last - first)});
  }
  return spans;
}

void ClothFlatness::Slopes::merge(const Slopes& other) noexcept {
  min_u = std::min(min_u, other.min_u);
  min_v = std::min(min_v, other.min_v);
  max_u_across = std::max(max_u_across, other.max_u_across);
  max_v_across = std::max(max_v_across, other.max_v_across);
}

// Mean of the two warp directions in the middle column that differ most.
Vec3 ClothFlatness::warpDirection(const Field3& position) const noexcept {
  const Grid& grid = pattern_.grid;
  const int column = (first_ + end_column_) / 2;
  const auto line = [&](const Span& strip) {
    const Vec3 slope = position.at(grid.index(static_cast<int>(strip.last), column)) -
                       position.at(grid.index(static_cast<int>(strip.first), column));
    return Vec3(slope * strip.per_length);
  };
  const auto furthest_from = [&](const Vec3& direction) {
    Vec3 furthest = direction;
    double least = std::numeric_limits<double>::infinity();
    for (const Span& strip : strips_) {
      const Vec3 slope = line(strip);
      if (slope.dot(direction) < least) {
        least = slope.dot(direction);
        furthest = slope;
      }
    }
    return furthest;
  };
  const Vec3 one = furthest_from(line(strips_.front()));
  return one + furthest_from(one);
}

// Chooses a and b from the mean weft and warp direction, made orthonormal as in contact/narrow_phase/flatness.h.
// False: the cloth has none.
bool ClothFlatness::chooseDirections(const Field3& position, Projection& projection) const noexcept {
  const Grid& grid = pattern_.grid;
  const int last = end_column_ - 1, hem = grid.rows - 1;
  const Vec3 u = position.at(grid.index(0, last)) - position.at(grid.index(0, first_)) +
                 position.at(grid.index(hem, last)) - position.at(grid.index(hem, first_));
  const Vec3 v = warpDirection(position);
  const double size_u = u.norm(), size_v = v.norm();
  if (!(std::min(size_u, size_v) > 1e-6)) return false;
  const Vec3 unit_u = u / size_u, unit_v = v / size_v;
  const double cosine = unit_u.dot(unit_v);
  if (!(std::abs(cosine) < 0.9)) return false;
  const Vec3 mean = (unit_u + unit_v) / (2.0 * std::sqrt(1.0 + cosine));
  const Vec3 skew = (unit_u - unit_v) / (2.0 * std::sqrt(1.0 - cosine));
  projection.a = mean + skew;
  projection.b = mean - skew;
  return true;
}

// Largest deviation of a link's slope from that of its line, over all lines of a span.
double ClothFlatness::slopeDeviation(double min_square, const Span& span) const noexcept {
  const double longest = 1.0 + overlong_;
  const double c = std::min(std::sqrt(min_square) * span.per_length, longest);
  const double s = span.links * (1.0 - c) + (span.links - 1.0) * overlong_;
  return std::sqrt(std::max(0.0, longest * longest - 2.0 * c * (1.0 - s) + c * c)) + kFlatnessRounding;
}

ClothFlatness::Slopes ClothFlatness::slopesOf(const Field3& position, const Projection& projection) const noexcept {
  const Grid& grid = pattern_.grid;
  Slopes all{1e300, 0.0, 1e300, 0.0};
  for (const Span& strip : strips_) {
    const std::size_t from = grid.index(static_cast<int>(strip.first), first_);
    const std::size_t to = grid.index(static_cast<int>(strip.last), first_);
    const Extremes of = extremesOfRow({position, from}, {position, to}, static_cast<std::size_t>(end_column_ - first_),
                                      projection.b, projection.a);
    const double deviation = slopeDeviation(of.min_square, strip);
    all.min_v = std::min(all.min_v, of.least * strip.per_length - deviation);
    all.max_v_across = std::max(all.max_v_across, of.max_across * strip.per_length + deviation);
  }
  for (const Span& span : spans_) {
    const Extremes of =
        extremesOfColumn({position, span.first}, {position, span.last}, static_cast<std::size_t>(grid.rows),
                         static_cast<std::size_t>(grid.stride), projection.a, projection.b);
    const double deviation = slopeDeviation(of.min_square, span);
    all.min_u = std::min(all.min_u, of.least * span.per_length - deviation);
    all.max_u_across = std::max(all.max_u_across, of.max_across * span.per_length + deviation);
  }
  return all;
}

bool ClothFlatness::areFlat(const Slopes& slopes, double reach) const noexcept {
  const double limit = reach * per_altitude_ * (1.0 + kFlatnessRounding) + kFlatnessRounding;
  const double u = slopes.min_u - limit, v = slopes.min_v - limit;
  const double across = 0.5 * (slopes.max_u_across + slopes.max_v_across);
  return u > 0.0 && v > 0.0 && u * v > across * across;
}

bool ClothFlatness::topRowHolds(const Field3& position) const noexcept {
  return !checks_top_ || holdsRow(pattern_, static_cast<std::size_t>(first_), static_cast<std::size_t>(end_column_),
                                  position, (1.0 + overlong_) * (1.0 + overlong_));
}

void ClothFlatness::measure(const Field3& position, Projection& projection) const noexcept {
  projection.known = true;
  projection.has_directions = topRowHolds(position) && chooseDirections(position, projection);
  if (projection.has_directions) projection.slopes = slopesOf(position, projection);
}

bool ClothFlatness::isFlat(const Field3& position, double reach) noexcept {
  end_.known = false;
  if (!usable_) return false;
  if (!start_.known) measure(position, start_);
  return start_.has_directions && areFlat(start_.slopes, reach);
}

// The slopes at the start were measured along start_.a and start_.b. Along the directions of the end each differs by
// at most its length times the change of the direction.
bool ClothFlatness::staysFlat(const Field3& end, double reach) noexcept {
  measure(end, end_);
  if (!end_.has_directions) return false;
  const double longest = (1.0 + overlong_) * (1.0 + kFlatnessRounding);
  const double off_a = longest * (end_.a - start_.a).norm(), off_b = longest * (end_.b - start_.b).norm();
  Slopes slopes = start_.slopes;
  slopes.min_u -= off_a;
  slopes.max_v_across += off_a;
  slopes.min_v -= off_b;
  slopes.max_u_across += off_b;
  slopes.merge(end_.slopes);
  return areFlat(slopes, reach);
}

}  // namespace curtain
