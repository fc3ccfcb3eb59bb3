// SPDX-License-Identifier: BSD-3-Clause
#include "cloth/folded_start.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "scene/pi.h"

namespace curtain {
namespace {

constexpr double kSteepestRod = 0.9;  // sine of the steepest rod
constexpr int kSizeHalvings = 40;     // of an interval of angles: to 1e-11 of it
constexpr int kNewtonSteps = 8;
constexpr double kMinDepth = 1e-2;      // of their depth that folds are tried with
constexpr double kLengthSlack = 1e-12;  // relative, of lengths

using Vec2 = Eigen::Vector2d;

// Half a wave between two columns, which lie on the course; of a ring a whole one, to its outside. Columns are counted
// on beyond a ring's last one.
struct Fold {
  int first, last;
  bool holds_pins;    // columns between them are hung, too, so that the top row is straight
  double size = 0.0;  // of its curve in the row above
};

class FoldedStart {
 public:
  FoldedStart(const Scene& scene, const ClothPattern& pattern, const Vec3& down, const Field3& position)
      : scene_(scene), pattern_(pattern), grid_(pattern.grid), down_(down), plain_(position) {}

  // Folds as deep as links allow, or half, a quarter of it and so on. False: none are possible.
  bool fold(Field3& position) {
    findSupports();
    divide();
    sag();
    for (share_ = 1.0; share_ > kMinDepth; share_ *= 0.5) {
      position_ = plain_;
      for (Fold& each : folds_) each.size = 0.0;
      if (!placeRows()) continue;
      position = position_;
      return true;
    }
    return false;
  }

 private:
  int column(int unwrapped) const { return unwrapped % grid_.columns; }
  std::size_t at(int row, int unwrapped) const { return grid_.index(row, column(unwrapped)); }
  bool isHung(int unwrapped) const { return pattern_.pinned[at(0, unwrapped)] != kFree; }
  // Of the link that ends at a column.
  double rest(int row, int unwrapped) const { return pattern_.weft_rest[at(row, unwrapped)]; }
  // Along the top row from the first column [m].
  double along(int unwrapped) const {
    return pattern_.weft_coordinate[static_cast<std::size_t>(column(unwrapped))] +
           scene_.cloth.width * (unwrapped / grid_.columns);
  }
  double depth(int row) const { return pattern_.warp_coordinate[grid_.index(row, 0)]; }
  Vec3 course(int row, int unwrapped) const { return inPlan(plain_.at(at(row, unwrapped))); }
  Vec3 inPlan(const Vec3& point) const { return point - point.dot(down_) * down_; }
  double weightOf(double mass) const { return mass * scene_.gravity.dot(down_); }

  // Hung columns, and the ends of open cloth.
  void findSupports() {
    int first = 0;
    while (grid_.closed && first + 1 < grid_.columns && !isHung(first)) ++first;
    const int last = grid_.closed ? first + grid_.columns : grid_.columns - 1;
    for (int j = first; j <= last; ++j) {
      if (j == first || j == last || isHung(j)) supports_.push_back(j);
    }
  }

  // Of a fold. Half of the wave that a sheet of rigidity B wrinkles with under tension T over a length H, sqrt(pi) (B /
  // T)^(1/4) H^(1/2) (Cerda, Mahadevan 2003), T being the mean of its own weight. None is of less than two links, or
  // as narrow as cloth is thick.
  double naturalArc() const {
    const ClothParams& cloth = scene_.cloth;
    const double tension = 0.5 * weightOf(cloth.surface_density) * cloth.height;
    const double widest = cloth.width / (grid_.closed ? 4.0 : 1.0);
    if (!(tension > 0.0)) return widest;
    const double half = std::sqrt(kPi * cloth.height * std::sqrt(cloth.bending_weft / tension));
    const double arc = (grid_.closed ? 2.0 : 1.0) * std::max(half, 2.0 * cloth.width / grid_.linkCount());
    const Vec3 there = course(0, supports_[1]) - course(0, supports_[0]);
    const double fullness = (along(supports_[1]) - along(supports_[0])) / std::max(there.norm(), 1e-12);
    return std::min(widest, std::max(arc, 2.0 * scene_.contact.thickness * fullness));
  }

  // Folds end at supports, where these are not too close to each other or too far apart for the natural arc.
  void divide() {
    const double arc = naturalArc();
    const double end = along(supports_.back());
    std::size_t from = 0;
    while (from + 1 < supports_.size()) {
      const double begin = along(supports_[from]);
      std::size_t to = from + 1;
      while (to + 1 < supports_.size() &&
             std::abs(along(supports_[to + 1]) - begin - arc) < std::abs(along(supports_[to]) - begin - arc))
        ++to;
      if (end - along(supports_[to]) < 0.5 * arc) to = supports_.size() - 1;
      addFolds(supports_[from], supports_[to], arc, to > from + 1);
      from = to;
    }
  }

  // One link makes no fold.
  void addFolds(int first, int last, double arc, bool holds_pins) {
    const double begin = along(first), length = along(last) - begin;
    const int most = holds_pins ? 1 : std::max(1, (last - first) / 2);
    const int count = std::clamp(static_cast<int>(std::lround(length / arc)), 1, most);
    int from = first;
    for (int k = 1; k < count; ++k) {
      int to = from + 2;
      while (to < last - 2 * (count - k) && along(to) + 0.5 * rest(0, to + 1) < begin + length * k / count) ++to;
      folds_.push_back({from, to, holds_pins, 0.0});
      from = to;
    }
    folds_.push_back({from, last, holds_pins, 0.0});
  }

  // How far shear lets whole columns down between those that are hung [m]: across a link it carries G height slope.
  // Links reach so far at most.
  void sag() {
    sag_.assign(static_cast<std::size_t>(grid_.columns), 0.0);
    const int end = supports_.back();
    for (int first = supports_.front(); first < end;) {
      int last = first;
      while (last < end && stiffness(last + 1) > 0.0 && (last == first || !isHung(last))) ++last;
      if (last > first) sagBetween(first, last);
      first = std::max(last, first + 1);
    }
    double share = 1.0;
    for (int j = supports_.front() + 1; j <= end; ++j) {
      const double drop = std::abs(sagOf(j) - sagOf(j - 1)), plain = (course(0, j) - course(0, j - 1)).norm();
      if (!(drop > 0.0)) continue;
      share = std::min(share, std::sqrt(std::max(0.0, rest(0, j) * rest(0, j) - plain * plain)) / drop);
    }
    for (double& down : sag_) down *= share;
  }

  double& sagOf(int unwrapped) { return sag_[static_cast<std::size_t>(column(unwrapped))]; }

  // Of the cells on the left of a column against a slope [N]. 0: they are all cut.
  double stiffness(int right) const {
    double height = 0.0;
    for (int i = 0; i + 1 < grid_.rows; ++i)
      height += pattern_.cell[at(i, right)] * pattern_.warp_rest[at(i + 1, right)];
    return scene_.cloth.shear * height;
  }

  double columnWeight(int unwrapped) const {
    double mass = 0.0;
    for (int i = 0; i < grid_.rows; ++i) mass += pattern_.mass[at(i, unwrapped)];
    return weightOf(mass);
  }

  void sagBetween(int first, int last) {
    const bool left = isHung(first), right = isHung(last);
    if (!left && !right) return;
    // What the first link carries: all if the other end is free; else so much that both ends are at the same height.
    double carried = left ? 0.0 : -columnWeight(first), moment = 0.0, give = 0.0, beyond = 0.0;
    for (int j = first + 1; j <= last; ++j) {
      const double gives = rest(0, j) / stiffness(j);
      give += gives;
      moment += gives * beyond;
      if (j < last || !right) beyond += columnWeight(j);
    }
    if (left) carried = right ? moment / give : beyond;
    double down = 0.0;
    for (int j = first + 1; j <= last; ++j) {
      down += carried * rest(0, j) / stiffness(j);
      if (j < last || !right) sagOf(j) = down;
      carried -= columnWeight(j);
    }
    if (left) return;
    for (int j = first; j < last; ++j) sagOf(j) -= down;
  }

  // Places a node below the one above it. False: its rod can't reach so far.
  bool hang(int row, int unwrapped, const Vec3& plan) {
    const std::size_t n = at(row, unwrapped);
    if (row == 0) {
      const double height = isHung(unwrapped) ? 0.0 : sagOf(unwrapped);
      position_.set(n, plan + (plain_.at(n).dot(down_) + height) * down_);
      return true;
    }
    const Vec3 above = position_.at(at(row - 1, unwrapped));
    const double rod = pattern_.warp_rest[n], aside = (plan - inPlan(above)).norm();
    if (!(aside < rod)) return false;
    position_.set(n, plan + (above.dot(down_) + std::sqrt(rod * rod - aside * aside)) * down_);
    return aside <= kSteepestRod * rod;
  }

  bool placeRows() {
    for (int i = 0; i < grid_.rows; ++i) {
      if (!placeRow(i)) return false;
    }
    return true;
  }

  bool placeRow(int row) {
    bool reaches = true;
    for (const Fold& fold : folds_) reaches = hang(row, fold.first, course(row, fold.first)) && reaches;
    reaches = hang(row, folds_.back().last, course(row, folds_.back().last)) && reaches;
    double side = -1.0;  // of a ring's course, outside
    for (Fold& fold : folds_) {
      reaches = reaches && placeFold(row, fold, side);
      if (!grid_.closed) side = -side;
    }
    return reaches;
  }

  // What a link's fall from end to end leaves of its length. Rows alike fall alike, so it is taken from the row above.
  double lengthInPlan(int row, int right) {
    const double fall = row == 0 ? sagOf(right) - sagOf(right - 1)
                                 : (position_.at(at(row - 1, right)) - position_.at(at(row - 1, right - 1))).dot(down_);
    return std::sqrt(std::max(0.0, rest(row, right) * rest(row, right) - fall * fall));
  }

  // Turns of the links out of their course, in the ratio of a line's that is pressed from end to end and bends to one
  // side: close to the elastica, as a sine-generated curve (Langbein, Leopold 1966). None is more than a right angle.
  void prepare(int row, const Fold& fold, double side) {
    const Vec3 begin = course(row, fold.first), chord = course(row, fold.last) - begin;
    chord_ = chord.norm();
    axis_ = chord / chord_;
    across_ = side * axis_.cross(down_);
    links_.clear();
    turns_.clear();
    courses_.clear();
    double length = 0.0, passed = 0.0;
    for (int j = fold.first + 1; j <= fold.last; ++j) length += rest(row, j);
    for (int j = fold.first + 1; j <= fold.last; ++j) {
      const Vec3 link = course(row, j) - course(row, j - 1);
      links_.push_back(lengthInPlan(row, j));
      const double share = (passed + 0.5 * rest(row, j)) / length;
      turns_.push_back(grid_.closed ? std::sin(2.0 * kPi * share) : std::cos(kPi * share));
      courses_.push_back(std::atan2(link.dot(across_), link.dot(axis_)));
      passed += rest(row, j);
    }
  }

  // The curve of this size, as wide as the chord; its links' lengths over those at rest.
  double bend(double size) {
    Vec2 sum = Vec2::Zero();
    curve_.clear();
    for (std::size_t k = 0; k < links_.size(); ++k) {
      const double angle = courses_[k] + std::clamp(size * turns_[k], -0.5 * kPi, 0.5 * kPi);
      sum += links_[k] * Vec2(std::cos(angle), std::sin(angle));
      curve_.push_back(sum);
    }
    const double ratio = chord_ / sum.norm();
    const Vec2 aim = sum / sum.norm();
    for (Vec2& point : curve_) point = ratio * Vec2(aim.dot(point), aim.x() * point.y() - aim.y() * point.x());
    return aim.x() > 0.0 ? ratio : std::numeric_limits<double>::infinity();  // too sharp: it leads back
  }

  // The largest size, up to `most`, with which all is as it should.
  template <typename Fits>
  static double largest(double most, const Fits& fits) {
    if (fits(most)) return most;
    double least = 0.0;
    for (int k = 0; k < kSizeHalvings; ++k) {
      const double size = 0.5 * (least + most);
      (fits(size) ? least : most) = size;
    }
    return least;
  }

  bool placeFold(int row, Fold& fold, double side) {
    if (row == 0 && fold.holds_pins) {
      for (int j = fold.first + 1; j < fold.last; ++j) hang(row, j, course(row, j));
      return true;
    }
    prepare(row, fold, side);
    const double slack = 1.0 - bend(0.0);
    const double sharpest = slack > kLengthSlack ? kPi * static_cast<double>(links_.size()) : 0.0;
    double deepest = std::numeric_limits<double>::infinity();
    if (fold.holds_pins || share_ < 1.0) {
      bend(largest(sharpest, [&](double size) { return bend(size) <= 1.0; }));
      deepest = share_ * deepestPoint();
      if (fold.holds_pins) deepest *= shareOfDepth(row, deepest);
    }
    fold.size = largest(sharpest, [&](double trial) {
      if (bend(trial) > 1.0 || deepestPoint() > deepest || turnsBack()) return false;
      // What rods do not reach is too deep, or not as deep as the row above.
      return placeCurve(row, fold) ? noneIsOverlong(row, fold) : trial < fold.size;
    });
    bend(fold.size);
    return placeCurve(row, fold) && noneIsOverlong(row, fold);
  }

  // Somewhere against the chord, where it could meet the next one.
  bool turnsBack() const {
    double before = 0.0;
    for (const Vec2& point : curve_) {
      if (point.x() < before - kLengthSlack * chord_) return true;
      before = point.x();
    }
    return false;
  }

  bool placeCurve(int row, const Fold& fold) {
    const Vec3 begin = course(row, fold.first);
    for (int j = fold.first + 1; j < fold.last; ++j) {
      const Vec2 point = curve_[static_cast<std::size_t>(j - fold.first - 1)];
      if (!hang(row, j, begin + point.x() * axis_ + point.y() * across_)) return false;
    }
    return true;
  }

  // None is longer than it is.
  bool noneIsOverlong(int row, const Fold& fold) const {
    for (int j = fold.first + 1; j <= fold.last; ++j) {
      const double length = (position_.at(at(row, j)) - position_.at(at(row, j - 1))).norm();
      if (length > (1.0 + kLengthSlack) * rest(row, j)) return false;
    }
    return true;
  }

  double deepestPoint() const {
    double deepest = 0.0;
    for (const Vec2& point : curve_) deepest = std::max(deepest, point.y());
    return deepest;
  }

  // Of a fold's depth where the top row is straight: a quarter of a sine down to a height h, which has the least energy
  // for each metre of width. Rods at the crest of depth Y lead aside, so that it is higher by D / h, D = pi^2 Y^2 / 16:
  // that lifts what hangs, T D / 2h, and shears all below it, G k^2 H D^2 / 4h^2 for waves of k. Against it wefts push
  // that are pressed to a share r, with p (1 - r) h / 2.
  double shareOfDepth(int row, double deepest) const {
    const ClothParams& cloth = scene_.cloth;
    double arc = 0.0;
    for (const double link : links_) arc += link;
    const double link = arc / static_cast<double>(links_.size()), k = kPi / arc;
    const double push = kPi * kPi * cloth.bending_weft / (link * link) * (1.0 - chord_ / arc);
    const double higher = kPi * kPi / 16.0 * deepest * deepest;
    const double lift = higher * std::max(0.0, weightOf(cloth.surface_density) * cloth.height) / push;
    const double shear = cloth.shear * k * k * cloth.height * higher * higher / push;
    double height = std::sqrt(lift) + std::cbrt(shear);  // no less than it is: Newton's steps lead down to it
    for (int step = 0; step < kNewtonSteps; ++step)
      height -= (height * (height * height - lift) - shear) / (3.0 * height * height - lift);
    return depth(row) < height ? std::sin(0.5 * kPi * depth(row) / height) : 1.0;
  }

  const Scene& scene_;
  const ClothPattern& pattern_;
  const Grid& grid_;
  const Vec3 down_;
  const Field3& plain_;
  Field3 position_;
  std::vector<int> supports_;
  std::vector<Fold> folds_;
  std::vector<double> sag_;  // of columns [m]
  double share_ = 1.0;       // of the depth that folds could have
  // Of the fold at hand: rest lengths, turns and directions of the course by link; where links end, along and across.
  std::vector<double> links_, turns_, courses_;
  std::vector<Vec2> curve_;
  Vec3 axis_, across_;
  double chord_ = 0.0;
};

}  // namespace

void foldStart(const Scene& scene, const ClothPattern& pattern, const Vec3& down, Field3& position) {
  Field3 folded;
  if (FoldedStart(scene, pattern, down, position).fold(folded)) position = folded;
}

}  // namespace curtain
