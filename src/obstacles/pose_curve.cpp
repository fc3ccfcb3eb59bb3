// SPDX-License-Identifier: BSD-3-Clause
#include "obstacles/pose_curve.h"

#include <algorithm>
#include <cmath>

#include "cloth/archive.h"
#include "obstacles/rotation_vector.h"
#include "scene/pi.h"

namespace curtain {
namespace {

// Acceleration from which a change of speed is a blow [m/s^2]: 2 g.
constexpr double kBlow = 2.0 * 9.81;

// Whether a cubic with these slopes at its ends never goes back along its change `whole` (Fritsch and Carlson 1980).
bool advances(const Vec3& whole, const Vec3& first, const Vec3& last) {
  const double most = 3.0 * whole.squaredNorm(), a = whole.dot(first), b = whole.dot(last);
  if (most == 0.0) return first.isZero(0.0) && last.isZero(0.0);
  return a >= 0.0 && b >= 0.0 && a <= most && b <= most;
}

// A change of speed over this time [s], of points `arm` [m] per unit, is a blow.
bool isBlow(const Vec3& change, double arm, double time) { return arm * change.norm() > kBlow * time; }

// ---- Position, or rotation vector, of the coming frame. Speeds are per second

struct EndSpeeds {
  Vec3 mean, last;
};

// Constant acceleration goes on: half of the change between the middles of two frames comes until the frame's end.
// Where it can't go on so, the speed is even, from `first` on.
Vec3 lastSpeed(const EndSpeeds& before, const Vec3& mean, double length_before, double length, double arm,
               Vec3& first) noexcept {
  const Vec3 change = mean - before.mean;
  const Vec3 last = mean + (length / (length + length_before)) * change;
  first = before.last;
  if (!isBlow(change, arm, 0.5 * (length + length_before)) && advances(mean, first, last)) return last;
  first = mean;
  return mean;
}

// ---- Position, or rotation vector, through all poses of a script

// Mean speed and duration of what lies between two poses.
struct Piece {
  Vec3 mean;
  double time;
  Vec3 first, last;  // speeds to be found
};

// Speeds at the pose between two pieces: that of the parabola through three poses (exact for constant acceleration).
// None where it stops or turns back; not so much more than the mean speeds that it would go back.
void join(Piece& a, Piece& b, double arm) noexcept {
  if (isBlow(b.mean - a.mean, arm, 0.5 * (a.time + b.time))) {
    a.last = a.mean;
    b.first = b.mean;
    return;
  }
  Vec3 speed = Vec3::Zero();
  if (a.mean.dot(b.mean) > 0.0) {
    speed = (b.time * a.mean + a.time * b.mean) / (a.time + b.time);
    double share = 1.0;
    for (const Vec3& mean : {a.mean, b.mean}) share = std::min(share, 3.0 * mean.squaredNorm() / mean.dot(speed));
    if (share > 0.0) speed *= share;
  }
  a.last = b.first = speed;
}

// Speed at an end of the curve, from that at the piece's other end: an even acceleration; next to a stop or a turn,
// where that would be twice the mean speed, the mean.
Vec3 freeEnd(const Vec3& mean, const Vec3& other) noexcept {
  if (other.isZero(0.0)) return mean;
  const Vec3 speed = 2.0 * mean - other;
  return speed.dot(mean) > 0.0 ? speed : Vec3(Vec3::Zero());
}

void joinAll(std::vector<Piece>& pieces, double arm) {
  if (pieces.empty()) return;
  for (std::size_t k = 1; k < pieces.size(); ++k) join(pieces[k - 1], pieces[k], arm);
  Piece &first = pieces.front(), &last = pieces.back();
  if (pieces.size() == 1) first.last = first.mean;
  first.first = freeEnd(first.mean, first.last);
  last.last = freeEnd(last.mean, last.first);
}

}  // namespace

bool samePlace(const Pose& a, const Pose& b) noexcept {
  return a.position == b.position && a.orientation.coeffs() == b.orientation.coeffs();
}

PoseChange changeBetween(const Pose& from, const Pose& to) noexcept {
  PoseChange change;
  change.move = to.position - from.position;
  if (from.orientation.coeffs() != to.orientation.coeffs())
    change.turn = rotationVectorOf(to.orientation * from.orientation.conjugate());
  return change;
}

Pose changed(const Pose& pose, const PoseChange& change) noexcept {
  Pose result = pose;
  result.position += change.move;
  if (!change.turn.isZero(0.0))
    result.orientation = (rotationOf(change.turn) * Eigen::Quaterniond(pose.orientation)).normalized();
  return result;
}

PoseCurve::PoseCurve(const Pose& from, const Pose& to, const PoseChange& whole, const PoseChange& first,
                     const PoseChange& last) noexcept
    : from_(from), to_(to), whole_(whole), first_(first), last_(last) {}

PoseCurve PoseCurve::even(const Pose& from, const Pose& to) noexcept {
  const PoseChange whole = changeBetween(from, to);
  return {from, to, whole, whole, whole};
}

// Cubic Hermite polynomials of the share s: value and slope.
PoseChange PoseCurve::changeAt(double s) const noexcept {
  return (s * s * (3.0 - 2.0 * s)) * whole_ + (s * (1.0 - s) * (1.0 - s)) * first_ + (s * s * (s - 1.0)) * lastSlope();
}
PoseChange PoseCurve::lastSlope() const noexcept { return {last_.move, slopeOf(whole_.turn, last_.turn)}; }
PoseChange PoseCurve::slopeAt(double s) const noexcept {
  return (6.0 * s * (1.0 - s)) * whole_ + ((1.0 - s) * (1.0 - 3.0 * s)) * first_ + (s * (3.0 * s - 2.0)) * lastSlope();
}

Pose PoseCurve::at(double share) const noexcept {
  if (share <= 0.0) return from_;
  if (share >= 1.0) return to_;
  return changed(from_, changeAt(share));
}

PoseChange PoseCurve::rateAt(double share) const noexcept {
  const double s = std::clamp(share, 0.0, 1.0);
  const PoseChange slope = slopeAt(s);
  return {slope.move, spinOf(changeAt(s).turn, slope.turn)};
}

// The slope is a parabola, with three Bezier points: it stays among them. The slope of the rotation vector r at the end
// is off the spin w by no more than |r| |w| / 2 + |r|^2 |w| / pi^2, see slopeOf().
double PoseCurve::fastest(double radius) const noexcept {
  const PoseChange middle = 3.0 * whole_ - first_ - last_;
  const double move = std::max({first_.move.norm(), middle.move.norm(), last_.move.norm()});
  if (radius == 0.0) return move;
  const double turn = whole_.turn.norm(), spin = last_.turn.norm(), off = (0.5 + turn / (kPi * kPi)) * turn * spin;
  return move + radius * std::max({first_.turn.norm(), middle.turn.norm() + off, spin + off});
}

ScriptedMotion::ScriptedMotion(const ObstacleParams& params, double radius)
    : ScriptedMotion(params.pose, params.motion, radius) {
  steady_ = params.motion.empty() &&
            !(params.velocity.isZero(0.0) && params.spin.isZero(0.0) && params.acceleration.isZero(0.0));
  speed_ = {params.velocity, params.spin};
  acceleration_ = params.acceleration;
}

ScriptedMotion::ScriptedMotion(const Pose& start, const std::vector<PoseKey>& poses, double radius)
    : start_(poses.empty() ? start : poses.front().pose), last_(poses.empty() ? start : poses.back().pose) {
  if (poses.empty()) return;
  std::vector<Piece> moves, turns;
  for (const PoseKey& key : poses) {
    if (!times_.empty()) {
      const double time = key.time - times_.back();
      const PoseChange change = changeBetween(poses[times_.size() - 1].pose, key.pose);
      moves.push_back({change.move / time, time, {}, {}});
      turns.push_back({change.turn / time, time, {}, {}});
    }
    times_.push_back(key.time);
  }
  joinAll(moves, 1.0);
  joinAll(turns, radius);
  for (std::size_t k = 0; k < moves.size(); ++k) {
    const double time = moves[k].time;
    pieces_.emplace_back(poses[k].pose, poses[k + 1].pose, PoseChange{time * moves[k].mean, time * turns[k].mean},
                         PoseChange{time * moves[k].first, time * turns[k].first},
                         PoseChange{time * moves[k].last, time * turns[k].last});
  }
}

// The piece that a time between the first and the last pose lies in; at a pose the one before it.
std::size_t ScriptedMotion::pieceAt(double time) const noexcept {
  const auto next = std::lower_bound(times_.begin() + 1, times_.end() - 1, time);
  return static_cast<std::size_t>(next - times_.begin()) - 1;
}

Pose ScriptedMotion::at(double time) const noexcept {
  if (steady_) return changed(start_, {time * speed_.move + (0.5 * time * time) * acceleration_, time * speed_.turn});
  if (times_.empty() || time <= times_.front()) return start_;
  if (time >= times_.back()) return last_;
  const std::size_t piece = pieceAt(time);
  return pieces_[piece].at((time - times_[piece]) / durationOf(piece));
}

PoseChange ScriptedMotion::rateAt(double time) const noexcept {
  if (steady_) return {speed_.move + time * acceleration_, speed_.turn};
  if (times_.empty() || time <= times_.front() || time > times_.back()) return {};
  const std::size_t piece = pieceAt(time);
  return (1.0 / durationOf(piece)) * pieces_[piece].rateAt((time - times_[piece]) / durationOf(piece));
}

double ScriptedMotion::fastest(double from, double to, double radius) const noexcept {
  if (steady_) return std::max(rateAt(from).reach(radius), rateAt(to).reach(radius));
  double most = 0.0;
  if (times_.empty() || to < times_.front() || from > times_.back() || pieces_.empty()) return most;
  for (std::size_t k = pieceAt(from); k < pieces_.size() && times_[k] < to; ++k)
    most = std::max(most, pieces_[k].fastest(radius) / durationOf(k));
  return most;
}

void FrameCurve::put(const Pose& pose) noexcept {
  arrive(pose);
  moves_ = false;
  mean_ = last_ = {};
}

void FrameCurve::lead(const Pose& from, const Pose& to, double length, double radius) noexcept {
  script_ = nullptr;
  const double length_before = length_ > 0.0 ? length_ : length;
  length_ = length;
  if (samePlace(from, to)) return put(to);
  const PoseChange whole = changeBetween(from, to), mean = (1.0 / length) * whole;
  PoseChange first, last;
  last.move = lastSpeed({mean_.move, last_.move}, mean.move, length_before, length, 1.0, first.move);
  last.turn = lastSpeed({mean_.turn, last_.turn}, mean.turn, length_before, length, radius, first.turn);
  curve_ = PoseCurve(from, to, whole, length * first, length * last);
  mean_ = mean;
  last_ = last;
  moves_ = true;
}

void FrameCurve::leadEvenly(const Pose& from, const Pose& to, double share, double length) noexcept {
  script_ = nullptr;
  const Pose end = share < 1.0 ? PoseCurve::even(from, to).at(share) : to;
  curve_ = PoseCurve::even(from, end);
  mean_ = last_ = (1.0 / length) * changeBetween(from, end);
  length_ = length;
  moves_ = !samePlace(from, end);
}

void FrameCurve::follow(const ScriptedMotion& script, double end, double length) noexcept {
  script_ = &script;
  end_time_ = end;
  length_ = length;
  mean_ = (1.0 / length) * changeBetween(script.at(timeAt(0.0)), script.at(end));
  last_ = script.rateAt(end);
  moves_ = way(1.0) > 0.0;  // a plane turns, though its points have no bound
}

Pose FrameCurve::at(double share) const noexcept {
  return script_ != nullptr ? script_->at(timeAt(share)) : curve_.at(share);
}

PoseChange FrameCurve::rateAt(double share) const noexcept {
  return script_ != nullptr ? length_ * script_->rateAt(timeAt(share)) : curve_.rateAt(share);
}

double FrameCurve::way(double radius) const noexcept {
  return script_ != nullptr ? length_ * script_->fastest(timeAt(0.0), end_time_, radius) : curve_.fastest(radius);
}

// Between two frames: what the next one starts with.
void FrameCurve::serialize(Archive& archive) {
  archive.within("length", length_, 0.0, 1e3);
  archive.finite("mean_move", mean_.move);
  archive.finite("mean_turn", mean_.turn);
  archive.finite("last_move", last_.move);
  archive.finite("last_turn", last_.turn);
}

}  // namespace curtain
