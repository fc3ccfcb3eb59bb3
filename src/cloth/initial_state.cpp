// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "cloth/cloth.h"
#include "scene/pi.h"

namespace curtain {
namespace {

// Axes of the flat cloth: along the hung edge, and down the warp (rotated by tilt).
struct HangFrame {
  Vec3 along;
  Vec3 down;
};

HangFrame hangFrame(const HangParams& hang) {
  HangFrame frame;
  frame.along = (hang.to - hang.from).normalized();
  Vec3 normal = frame.along.cross(Vec3::UnitZ());
  // A vertical hung edge leaves the normal open: any horizontal one will do.
  normal = normal.norm() > 1e-9 ? Vec3(normal.normalized()) : Vec3::UnitX();
  const Vec3 plumb = frame.along.cross(normal);
  frame.down = std::cos(hang.tilt) * plumb + std::sin(hang.tilt) * normal;
  return frame;
}

// Relative overlength of weft links that counts as rounding.
constexpr double kRounded = 1e-9;

// Of a rod across the warp, as a share of its length.
constexpr double kMostSlant = 0.9;

// A point in the plane of the flat cloth: across from the middle of the hung edge, and down [m].
using Flat = Eigen::Vector2d;

// The lower of the two points at distance `rod` from `above` and `weft` from `beside`; if both are too short for that,
// the point on the rod's circle nearest to `beside`.
Flat atBothLengths(const Flat& above, double rod, const Flat& beside, double weft) {
  const Flat to_beside = beside - above;
  const double distance = to_beside.norm();
  const double along = std::min(rod, (rod * rod - weft * weft + distance * distance) / (2.0 * distance));
  const Flat unit = to_beside / distance;
  const Flat normal = std::sqrt(rod * rod - along * along) * Flat(-unit.y(), unit.x());
  const Flat foot = above + along * unit;
  return normal.y() > 0.0 ? Flat(foot + normal) : Flat(foot - normal);
}

// Places the nodes of the flat cloth row by row. A row is as wide as the hung edge or as its own weft, whichever is
// shorter; rods have their lengths. Slanting rods lift the outer columns of a tapered row: where its weft links are too
// short for that, columns are closer together.
class FlatCloth {
 public:
  FlatCloth(const Scene& scene, const ClothPattern& pattern) : scene_(scene), pattern_(pattern) {
    const double top_width = pattern.weft_coordinate.back();
    for (const double at : pattern.weft_coordinate) shares_.push_back(at / top_width - 0.5);
    const auto nearer = [](double a, double b) { return std::abs(a) < std::abs(b); };
    const double least = std::abs(*std::min_element(shares_.begin(), shares_.end(), nearer)) + kRounded;
    const auto isMiddle = [&](double share) { return std::abs(share) <= least; };
    first_ = std::find_if(shares_.begin(), shares_.end(), isMiddle) - shares_.begin();
    last_ = shares_.rend() - std::find_if(shares_.rbegin(), shares_.rend(), isMiddle) - 1;
  }

  void place(Field3& position) {
    const HangFrame frame = hangFrame(scene_.hang);
    const Vec3 middle = 0.5 * (scene_.hang.from + scene_.hang.to);
    for (int i = 0; i < pattern_.grid.rows; ++i) {
      placeRow(i);
      for (int j = 0; j < pattern_.grid.columns; ++j) {
        const Flat& at = row_[static_cast<std::size_t>(j)];
        position.set(pattern_.grid.index(i, j), middle + at.x() * frame.along + at.y() * frame.down);
      }
    }
  }

 private:
  void placeRow(int i) {
    const double span = (scene_.hang.to - scene_.hang.from).norm();
    const double hem_width = scene_.cloth.hem_width.value_or(scene_.cloth.width);
    const double depth = pattern_.warp_coordinate[static_cast<std::size_t>(i)] / scene_.cloth.height;
    width_above_ = width_;
    width_ = std::min(span, scene_.cloth.width + (hem_width - scene_.cloth.width) * depth);
    above_ = row_;
    row_.resize(shares_.size());
    const auto count = static_cast<std::ptrdiff_t>(shares_.size());
    for (std::ptrdiff_t j = first_; j <= last_; ++j) placeNode(i, j, j);
    for (std::ptrdiff_t j = last_ + 1; j < count; ++j) placeNode(i, j, j - 1);
    for (std::ptrdiff_t j = first_ - 1; j >= 0; --j) placeNode(i, j, j + 1);
  }

  // beside: neighbour in the row that is already placed; j itself: none.
  void placeNode(int i, std::ptrdiff_t j, std::ptrdiff_t beside) {
    Flat& at = row_[static_cast<std::size_t>(j)];
    at = Flat(shares_[static_cast<std::size_t>(j)] * width_, 0.0);
    if (i == 0) return;
    const Grid& grid = pattern_.grid;
    const Flat& above = above_[static_cast<std::size_t>(j)];
    const double rod = pattern_.warp_rest[grid.index(i, static_cast<int>(j))];
    const double share = shares_[static_cast<std::size_t>(j)];
    if (std::abs(share * (width_ - width_above_)) > kMostSlant * rod) {
      throw std::invalid_argument("cloth.hem_width: the cloth tapers faster than its warp rods are long (row " +
                                  std::to_string(i) + ")");
    }
    const double slant = std::clamp(at.x() - above.x(), -kMostSlant * rod, kMostSlant * rod);
    at = above + Flat(slant, std::sqrt(rod * rod - slant * slant));
    if (beside == j) return;
    const Flat& neighbour = row_[static_cast<std::size_t>(beside)];
    const double weft = pattern_.weft_rest[grid.index(i, static_cast<int>(std::max(j, beside)))];
    if ((at - neighbour).norm() > weft * (1.0 + kRounded)) at = atBothLengths(above, rod, neighbour, weft);
  }

  const Scene& scene_;
  const ClothPattern& pattern_;
  std::vector<double> shares_;              // position in the top row by column, from its middle, over its width
  std::ptrdiff_t first_ = 0, last_ = 0;     // the one or two columns nearest to the middle
  double width_ = 0.0, width_above_ = 0.0;  // of the present row [m]
  std::vector<Flat> row_, above_;           // the present row and the one above [m]
};

// Closed cloth starts as a cone around the vertical through hang.from, with normals outward.
void placeRing(const Scene& scene, const ClothPattern& pattern, Field3& position) {
  const Grid& grid = pattern.grid;
  const double radius = scene.hang.radius.value_or(scene.cloth.width / (2.0 * kPi));
  for (int i = 0; i < grid.rows; ++i) {
    const double along = pattern.warp_coordinate[static_cast<std::size_t>(i)];
    const double ring = radius + along * std::sin(scene.hang.tilt);
    const double height = -along * std::cos(scene.hang.tilt);
    for (int j = 0; j < grid.columns; ++j) {
      const double angle = 2.0 * kPi * pattern.weft_coordinate[static_cast<std::size_t>(j)] / scene.cloth.width;
      position.set(grid.index(i, j), scene.hang.from + Vec3(ring * std::cos(angle), ring * std::sin(angle), height));
    }
  }
}

}  // namespace

ClothState makeInitialState(const Scene& scene, const ClothPattern& pattern) {
  const Grid& grid = pattern.grid;
  ClothState state;
  state.position.assign(grid.size(), 0.0);
  state.velocity.assign(grid.size(), 0.0);
  if (scene.cloth.closed) {
    placeRing(scene, pattern, state.position);
  } else {
    FlatCloth(scene, pattern).place(state.position);
  }
  // Padding hangs straight down with rods of length 1 (its rest length), so that no kernel divides by zero there.
  for (int i = 0; i < grid.rows; ++i) {
    for (int j = grid.columns; j < grid.stride; ++j) state.position.set(grid.index(i, j), Vec3(0.0, 0.0, -i));
  }
  return state;
}

}  // namespace curtain
