// SPDX-License-Identifier: BSD-3-Clause
#include "fit/shadow.h"

#include <algorithm>
#include <cmath>

#include "fit/drape.h"
#include "fit/sample.h"
#include "scene/pi.h"

namespace curtain_fit {
namespace {

using curtain::ClothPattern;
using curtain::Field3;
using curtain::Grid;
using curtain::Vec3;

// The plane of the shadow, in squares that count when their middle is in it.
class Paper {
 public:
  static constexpr double kSquare = 0.5e-3;  // [m]

  /// Everything that is seen from above through a triangle.
  void shade(const Vec3& a, const Vec3& b, const Vec3& c) {
    const double area = cross(b - a, c - a);
    if (area == 0.0) return;
    const int first_row = indexOf(std::min({a.y(), b.y(), c.y()})), last_row = indexOf(std::max({a.y(), b.y(), c.y()}));
    const int first = indexOf(std::min({a.x(), b.x(), c.x()})), last = indexOf(std::max({a.x(), b.x(), c.x()}));
    for (int row = first_row; row <= last_row; ++row) {
      for (int column = first; column <= last; ++column) {
        const Vec3 p(middleOf(column), middleOf(row), 0.0);
        const double u = cross(b - a, p - a) / area, v = cross(c - b, p - b) / area, w = cross(a - c, p - c) / area;
        if (std::min({u, v, w}) >= -kEdge) dark_[at(row, column)] = 1;
      }
    }
  }
  void shadeDisc(double radius) {
    for (int row = 0; row < kSide; ++row) {
      for (int column = 0; column < kSide; ++column) {
        if (std::hypot(middleOf(row), middleOf(column)) < radius) dark_[at(row, column)] = 1;
      }
    }
  }
  /// [m^2]
  double darkArea() const { return kSquare * kSquare * static_cast<double>(std::count(dark_.begin(), dark_.end(), 1)); }

 private:
  static constexpr double kHalf = 0.16;  // [m]; the sample fits in
  static constexpr int kSide = static_cast<int>(2.0 * kHalf / kSquare);
  static constexpr double kEdge = 1e-9;  // two triangles leave no square of their common edge out

  static double cross(const Vec3& a, const Vec3& b) { return a.x() * b.y() - a.y() * b.x(); }
  static int indexOf(double place) {
    return std::clamp(static_cast<int>(std::floor((place + kHalf) / kSquare)), 0, kSide - 1);
  }
  static double middleOf(int index) { return (index + 0.5) * kSquare - kHalf; }
  static std::size_t at(int row, int column) { return static_cast<std::size_t>(row * kSide + column); }

  std::vector<char> dark_ = std::vector<char>(static_cast<std::size_t>(kSide) * kSide, 0);
};

// A point of the cell below a node, on its left: across and down from its top left corner, each in [0, 1].
Vec3 pointOfCell(const Grid& grid, const Field3& position, int row, int column, double across, double down) {
  const Vec3 top =
      (1.0 - across) * position.at(grid.index(row, column - 1)) + across * position.at(grid.index(row, column));
  const Vec3 bottom =
      (1.0 - across) * position.at(grid.index(row + 1, column - 1)) + across * position.at(grid.index(row + 1, column));
  return (1.0 - down) * top + down * bottom;
}

}  // namespace

double drapeCoefficient(const ClothPattern& pattern, const Field3& position) {
  const Grid& grid = pattern.grid;
  // A cell that the circle cuts counts piece by piece, each as small as a square of the paper.
  const int small = static_cast<int>(std::ceil(pattern.weft_rest[grid.index(0, 1)] / Paper::kSquare));
  Paper paper;
  paper.shadeDisc(kDiscRadius);
  const double disc = paper.darkArea();
  forEachCell(grid, [&](int i, int j, int) {
    const double share = pattern.cell[grid.index(i, j)];
    const int pieces = share < 1.0 ? small : 1;
    const Vec3 corner = flatPlace(grid, i, j - 1), across = flatPlace(grid, i + 1, j) - corner;
    for (int u = 0; share > 0.0 && u < pieces; ++u) {
      for (int v = 0; v < pieces; ++v) {
        const double step = 1.0 / pieces, left = v * step, top = u * step;
        if (std::hypot(corner.x() + (left + 0.5 * step) * across.x(), corner.y() + (top + 0.5 * step) * across.y()) >
            kSampleRadius)
          continue;
        const auto at = [&](double x, double y) { return pointOfCell(grid, position, i, j, x, y); };
        const Vec3 a = at(left, top), b = at(left + step, top), c = at(left + step, top + step),
                   d = at(left, top + step);
        paper.shade(a, b, c);
        paper.shade(a, c, d);
      }
    }
  });
  return (paper.darkArea() - disc) / (curtain::kPi * (kSampleRadius * kSampleRadius - kDiscRadius * kDiscRadius));
}

std::vector<Vec3> rimOf(const Grid& grid, const Field3& position, int points) {
  std::vector<Vec3> rim;
  for (int k = 0; k < points; ++k) {
    const double angle = 2.0 * curtain::kPi * k / points;
    const double links = 0.5 * (grid.rows - 1);
    const double x = links * (1.0 + std::cos(angle)), y = links * (1.0 - std::sin(angle));
    const int column = std::clamp(static_cast<int>(x), 0, grid.columns - 2) + 1;
    const int row = std::clamp(static_cast<int>(y), 0, grid.rows - 2);
    rim.push_back(pointOfCell(grid, position, row, column, x - (column - 1), y - row));
  }
  return rim;
}

int countFolds(const std::vector<Vec3>& rim) {
  std::vector<double> radii;
  for (const Vec3& point : rim) radii.push_back(std::hypot(point.x(), point.y()));
  const auto [low, high] = std::minmax_element(radii.begin(), radii.end());
  double mean = 0.0;
  for (const double radius : radii) mean += radius / static_cast<double>(radii.size());
  const double band = 0.1 * (*high - *low);
  const std::size_t start = static_cast<std::size_t>(low - radii.begin());
  bool out = false;
  int folds = 0;
  for (std::size_t k = 0; k < radii.size(); ++k) {
    const double beyond = radii[(start + k) % radii.size()] - mean;
    if (!out && beyond > band) ++folds;
    if (beyond > band) out = true;
    if (beyond < -band) out = false;
  }
  return folds;
}

}  // namespace curtain_fit
