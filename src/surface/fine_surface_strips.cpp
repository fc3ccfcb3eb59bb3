// SPDX-License-Identifier: BSD-3-Clause
//
// The part of FineSurface that moves the folds of strips that are too near to an obstacle although their rods are not:
// strip by strip, without spoiling the strips above and below.
#include <algorithm>

#include "surface/fine_surface.h"
#include "surface/fold_turn.h"

namespace curtain {
namespace {

// Sweeps that turn folds, then sweeps that lift them; later ones gather nodes.
constexpr int kTurnSweeps = 2;
constexpr int kLiftSweeps = 3;
// Smallest lift as a share of the clearance, and how often it is doubled.
constexpr double kFirstLift = 0.5;
constexpr int kDoublings = 9;
constexpr int kLiftBisections = 6;

}  // namespace

const FineSurface::Strip* FineSurface::stripAt(int row, int link) const {
  if (row < 0 || row + 1 >= topology_->rows) return nullptr;
  const std::int32_t at = strip_at_[static_cast<std::size_t>(row * links_ + link)];
  return at < 0 ? nullptr : &strips_[static_cast<std::size_t>(at)];
}

void FineSurface::settleStrips() {
  bool all_clear = false;
  for (int sweep = 0; !all_clear; ++sweep) {
    all_clear = true;
    for (Strip& strip : strips_) {
      if (strip.clearance < 0.0 || isClear(strip.row, strip.link, strip.clearance)) continue;
      all_clear = false;
      if (sweep < kTurnSweeps) {
        turn(strip);
      } else if (sweep < kTurnSweeps + kLiftSweeps) {
        lift(strip);
      } else if (!gather(strip)) {
        strip.clearance = -1.0;  // already the quad, which is clear but for rounding
      }
    }
  }
}

// Returns a predicate: whether, after move(amount), the strip is clear and the strips above and below still are if they
// were.
template <typename Move>
auto FineSurface::test(const Strip& strip, Rows rows, Move move) {
  const auto mustStay = [&](int row) -> const Strip* {
    const Strip* const other = row == strip.row ? nullptr : stripAt(row, strip.link);
    if (other == nullptr || other->clearance < 0.0 || !isClear(row, strip.link, other->clearance)) return nullptr;
    return other;
  };
  const Strip* const above = mustStay(rows.first - 1);
  const Strip* const below = mustStay(rows.last);
  return [this, &strip, above, below, move](double amount) {
    move(amount);
    for (const Strip* each : {&strip, above, below}) {
      if (each != nullptr && !isClear(each->row, each->link, each->clearance)) return false;
    }
    return true;
  };
}

bool FineSurface::allFree(Rows rows, int link, Stage most) {
  for (int row = rows.first; row <= rows.last; ++row) {
    if (fold(row, link).stage > most) return false;
  }
  return true;
}

bool FineSurface::turn(Strip& strip) {
  const Rows upper{strip.row, strip.row}, lower{strip.row + 1, strip.row + 1}, both{strip.row, strip.row + 1};
  for (;;) {
    for (const Rows& rows : {upper, lower, both}) {
      if (tryTurn(strip, rows)) return true;
    }
    if (strip.clearance <= least_) return false;
    strip.clearance = least_;  // better too near than with rods of wrong length
    if (isClear(strip.row, strip.link, least_)) return true;
  }
}

std::optional<double> FineSurface::tryTurn(const Strip& strip, Rows rows) {
  if (!allFree(rows, strip.link, Stage::kFree)) return std::nullopt;
  const auto turnBy = [this, rows, link = strip.link](double angle) {
    for (int row = rows.first; row <= rows.last; ++row) place(row, link, fold(row, link).turn + angle);
  };
  const std::optional<double> angle = minTurn(test(strip, rows, turnBy));
  turnBy(angle.value_or(0.0));
  for (int row = rows.first; row <= rows.last; ++row) fold(row, strip.link).turn += angle.value_or(0.0);
  return angle;
}

bool FineSurface::lift(const Strip& strip) {
  const Rows upper{strip.row, strip.row}, lower{strip.row + 1, strip.row + 1}, both{strip.row, strip.row + 1};
  for (const Rows& rows : {upper, lower, both}) {
    if (tryLift(strip, rows)) return true;
  }
  return false;
}

// Bisects between two lifts that differ by a factor of two.
std::optional<double> FineSurface::tryLift(const Strip& strip, Rows rows) {
  if (!allFree(rows, strip.link, Stage::kLifted)) return std::nullopt;
  kept_.clear();
  for (int row = rows.first; row <= rows.last; ++row) {
    for (int p = 1; p < topology_->folds; ++p) kept_.push_back(node(row, strip.link, p));
  }
  const auto clears = test(strip, rows, [this, &strip, rows](double lift) { liftFolds(strip, rows, lift); });
  double good = kFirstLift * wanted_;
  int doublings = 0;
  while (doublings < kDoublings && !clears(good)) {
    good *= 2.0;
    ++doublings;
  }
  if (doublings == kDoublings) {
    liftFolds(strip, rows, 0.0);
    return std::nullopt;
  }
  double bad = doublings > 0 ? 0.5 * good : 0.0;
  for (int n = 0; n < kLiftBisections; ++n) {
    const double middle = 0.5 * (bad + good);
    (clears(middle) ? good : bad) = middle;
  }
  liftFolds(strip, rows, good);
  for (int row = rows.first; row <= rows.last; ++row) fold(row, strip.link).stage = Stage::kLifted;
  return good;
}

// Puts the nodes `lift` [m] from their kept places, each along the normal of the nearest obstacle there.
void FineSurface::liftFolds(const Strip& strip, Rows rows, double lift) {
  // A point of the quad, so on the cloth's side of an open mesh.
  const Vec3 from = 0.5 * (node(strip.row, strip.link, topology_->folds) + node(strip.row + 1, strip.link, 0));
  std::size_t at = 0;
  for (int row = rows.first; row <= rows.last; ++row) {
    for (int p = 1; p < topology_->folds; ++p, ++at) {
      const Vec3& base = kept_[at];
      double nearest = (base - from).norm() + wanted_;  // the strip's obstacle is within this of the quad
      Vec3 normal = Vec3::Zero();
      for (const MovingObstacle* obstacle : near_) {
        SurfacePoint surface;
        const Transform& place = obstacle->after;
        if (!obstacle->shape->query(place.toLocal(from), place.toLocal(base), nearest, surface)) continue;
        if (surface.distance >= nearest) continue;
        nearest = surface.distance;
        normal = obstacle->after.rotation * surface.normal;
      }
      node(row, strip.link, p) = base + lift * normal;
    }
  }
}

// False: they were gathered already.
bool FineSurface::gather(const Strip& strip) {
  bool moved = false;
  for (int row = strip.row; row <= strip.row + 1; ++row) {
    Fold& each = fold(row, strip.link);
    if (each.stage == Stage::kGathered) continue;
    each.stage = Stage::kGathered;
    moved = true;
    for (int p = 1; p < topology_->folds; ++p) node(row, strip.link, p) = node(row, strip.link, topology_->folds);
  }
  return moved;
}

}  // namespace curtain
