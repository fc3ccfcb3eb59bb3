// SPDX-License-Identifier: BSD-3-Clause
#include "obstacles/obstacle_set.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <utility>

namespace curtain {
namespace {

// Obstacles are looked for this much around the cloth, over its size: it moves by less in a frame, mostly. What is
// found does not depend on it.
constexpr double kSearchMargin = 0.1;

Eigen::AlignedBox3d boxAround(const Eigen::AlignedBox3d& box, const Transform& transform) {
  if (!std::isfinite(box.min().sum()) || !std::isfinite(box.max().sum())) {  // a plane is unbounded
    return {Vec3::Constant(-std::numeric_limits<double>::infinity()),
            Vec3::Constant(std::numeric_limits<double>::infinity())};
  }
  const Vec3 middle = transform.toWorld(box.center());
  const Vec3 half = transform.rotation.cwiseAbs() * (0.5 * box.sizes());
  return {middle - half, middle + half};
}

Eigen::AlignedBox3d grownBy(double margin, Eigen::AlignedBox3d box) {
  box.min().array() -= margin;
  box.max().array() += margin;
  return box;
}

}  // namespace

void MovingObstacle::move(const Transform& from, const Transform& to, const PoseChange& last) noexcept {
  before = from;
  after = to;
  speed = last;
  swept_ = boxAround(bounds, before).merged(boxAround(bounds, after));
}

ShapeMaker shapesBy(MeshResolver resolve) {
  return [resolve = std::move(resolve)](std::size_t, const ObstacleParams& params) {
    return std::shared_ptr<const ContactShape>(makeContactShape(params, resolve));
  };
}

ObstacleSet::ObstacleSet(const Scene& scene, const ShapeMaker& make_shape)
    : frame_length_(1.0 / scene.solver.frame_rate) {
  std::string unusable;
  for (std::size_t n = 0; n < scene.obstacles.size(); ++n) {
    const ObstacleParams& params = scene.obstacles[n];
    Item item;
    try {
      item.shape = make_shape(n, params);
    } catch (const std::invalid_argument& error) {
      unusable += (unusable.empty() ? "" : "\n") + std::string(error.what());
      continue;
    }
    MovingObstacle moving;
    moving.shape = item.shape.get();
    moving.padding = params.padding;
    moving.press = params.press;
    moving.bounds = grownBy(params.padding, item.shape->bounds());
    item.radius = moving.bounds.min().cwiseAbs().cwiseMax(moving.bounds.max().cwiseAbs()).norm();
    item.script = ScriptedMotion(params, item.arm());
    item.initial = item.script.any() ? item.script.at(0.0) : params.pose;
    item.own_friction = !std::isnan(params.friction);
    moving.friction = item.own_friction ? params.friction : scene.contact.friction;
    items_.push_back(std::move(item));
    moving_.push_back(moving);
  }
  if (!unusable.empty()) throw std::invalid_argument(unusable);
  near_.reserve(items_.size());
  by_name_.resize(items_.size());
  std::iota(by_name_.begin(), by_name_.end(), 0);
  std::sort(by_name_.begin(), by_name_.end(),
            [&scene](int a, int b) { return scene.obstacles[at(a)].name < scene.obstacles[at(b)].name; });
  rank_.resize(items_.size());
  for (std::size_t n = 0; n < by_name_.size(); ++n) rank_[at(by_name_[n])] = static_cast<int>(n);
  reset();
}

void ObstacleSet::setFriction(double friction) noexcept {
  for (std::size_t n = 0; n < items_.size(); ++n) {
    if (!items_[n].own_friction) moving_[n].friction = friction;
  }
}

bool ObstacleSet::anyPresent() const noexcept {
  return std::any_of(moving_.begin(), moving_.end(), [](const MovingObstacle& m) { return m.present; });
}

void ObstacleSet::reset() noexcept {
  for (std::size_t n = 0; n < items_.size(); ++n) {
    items_[n].left = items_[n].begin = items_[n].end = items_[n].initial;
    items_[n].curve.put(items_[n].initial);
    items_[n].scripted = items_[n].script.any();
    items_[n].stands = items_[n].moves = items_[n].moved = items_[n].behind = items_[n].boxed = false;
    items_[n].pace = 0.0;
    moving_[n].present = true;
  }
  any_moved_ = boxed_ = false;
  setSubstep(0.0, 0.0);
}

void ObstacleSet::setPresent(int index, bool present) noexcept {
  if (present == moving_[at(index)].present) return;
  moving_[at(index)].present = present;
  items_[at(index)].moved = true;
  touch(items_[at(index)]);  // its motion continued without it
}

Eigen::AlignedBox3d ObstacleSet::leftBox(int index) const noexcept {
  return boxAround(moving_[at(index)].bounds, Transform(items_[at(index)].left));
}

void ObstacleSet::setPose(int index, const Pose& pose, bool jump) noexcept {
  Item& item = items_[at(index)];
  item.scripted = false;
  const bool moves = !samePlace(pose, item.end);
  if (!moves && !jump) return;
  moveOn(at(index), pose);
  if (jump) {
    item.begin = pose;
    item.curve.put(pose);
    item.behind = false;
    item.pace = 0.0;
  }
  item.moved = item.moved || moves;
  touch(item);
}

void ObstacleSet::beginFrame(double end_time) noexcept {
  for (std::size_t n = 0; n < items_.size(); ++n) {
    Item& item = items_[n];
    if (item.stands) continue;
    if (item.scripted) moveOn(n, item.script.at(end_time));
    if (item.behind) {
      const double rest = pathBetween(item.begin, item.end, n);
      const double allowed = kCatchUp * item.pace;
      item.curve.leadEvenly(item.begin, item.end, rest > allowed ? allowed / rest : 1.0, frame_length_);
    } else if (item.scripted) {
      item.curve.follow(item.script, end_time, frame_length_);
    } else {
      item.curve.lead(item.begin, item.end, frame_length_, item.arm());
    }
    item.moves = item.curve.moves();
    item.moved = item.moved || item.moves;
    if (item.moves) touch(item);
    item.stands = !item.scripted && !item.behind && !item.moved;
  }
}

// What a rotation moves its points by is bounded by this times the angle; a plane has no bound [m].
double ObstacleSet::Item::arm() const noexcept { return std::isfinite(radius) ? radius : 0.0; }

// Bound of the largest displacement of its points [m].
double ObstacleSet::pathBetween(const Pose& a, const Pose& b, std::size_t index) const noexcept {
  return changeBetween(a, b).reach(items_[index].arm());
}

void ObstacleSet::moveOn(std::size_t index, const Pose& pose) noexcept {
  Item& item = items_[index];
  item.stands = false;
  if (item.behind) item.pace = std::max(item.pace, pathBetween(item.end, pose, index));
  item.end = pose;
}

// Its place and box are out of date.
void ObstacleSet::touch(Item& item) noexcept {
  any_moved_ = any_moved_ || item.moved;
  item.placed = 0;
  item.boxed = boxed_ = false;
}

void ObstacleSet::setSubstep(double from, double to) noexcept {
  if (boxed_ && at_rest_) return;
  from_ = from;
  to_ = to;
  ++substep_;
  if (!boxed_) computeBoxes();
}

void ObstacleSet::computeBoxes() noexcept {
  boxed_ = at_rest_ = true;
  swept_.setEmpty();
  searched_.setEmpty();
  for (std::size_t n = 0; n < items_.size(); ++n) {
    Item& item = items_[n];
    if (!moving_[n].present) continue;
    if (!item.boxed) {
      item.boxed = !item.moves;
      at_rest_ = at_rest_ && !item.moves;
      item.exact = false;
      if (item.moves) {
        const Vec3 low = item.begin.position.cwiseMin(item.end.position);
        const Vec3 high = item.begin.position.cwiseMax(item.end.position);
        item.swept = grownBy(item.radius + 0.5 * item.path(), {low, high});
      } else {
        computeExactBox(n);
      }
    }
    swept_.extend(item.swept);
  }
}

// No point is further than half of its way from where that begins or ends.
void ObstacleSet::computeExactBox(std::size_t index) noexcept {
  Item& item = items_[index];
  const Eigen::AlignedBox3d& box = moving_[index].bounds;
  item.exact = true;
  item.swept = boxAround(box, Transform(item.begin));
  if (!item.moves) return;
  item.swept.extend(boxAround(box, Transform(item.curve.at(1.0))));
  item.swept = grownBy(0.5 * item.path(), item.swept);
}

void ObstacleSet::searchAround(const Eigen::AlignedBox3d& box) noexcept {
  searched_ = grownBy(kSearchMargin * box.sizes().maxCoeff(), box);
  near_.clear();
  for (std::size_t n = 0; n < items_.size(); ++n) {
    if (moving_[n].present && items_[n].swept.intersects(searched_)) near_.push_back(static_cast<int>(n));
  }
}

void ObstacleSet::place(std::size_t index) noexcept {
  Item& item = items_[index];
  item.placed = substep_;
  if (item.moves) {
    moving_[index].move(Transform(item.curve.at(from_)), Transform(item.curve.at(to_)),
                        (to_ - from_) * item.curve.rateAt(to_));
  } else {
    moving_[index].move(Transform(item.begin), Transform(item.begin), {});
  }
}

void ObstacleSet::endFrame(double share) noexcept {
  from_ = to_ = 0.0;
  if (!any_moved_) return;
  any_moved_ = false;
  for (Item& item : items_) {
    if (!item.moved) continue;
    item.begin = item.curve.at(share);
    const bool behind = !samePlace(item.begin, item.end);
    if (!behind || !item.behind) item.pace = behind ? item.path() : 0.0;
    item.curve.arrive(item.begin);
    item.moves = false;
    item.moved = item.behind = behind;
    item.left = item.begin;
    item.placed = 0;
    item.boxed = boxed_ = false;
    any_moved_ = any_moved_ || item.moved;
  }
}

}  // namespace curtain
