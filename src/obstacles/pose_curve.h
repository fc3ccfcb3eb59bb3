// SPDX-License-Identifier: BSD-3-Clause
//
// How an obstacle gets from pose to pose: the only file that knows how poses are joined.
//
// Position and rotation vector are cubics of time between two poses (cubic Hermite), with speeds at the poses that both
// sides share: no step in the speed, which friction and forces would feel. Where there is a step in truth it stays one:
// a change by more than 2 g over the time between the poses is a blow. Nothing goes beyond its poses where it stops or
// turns back.
//
//   PoseCurve      between two poses, with given speeds at both
//   ScriptedMotion of a scene file: through all its poses, or with constant speed, spin and acceleration; of obstacles,
//                  hands, pins and drags
//   FrameCurve     of the coming frame: along a script, or to a pose that was set, of which the next is not known yet
#pragma once

#include <vector>

#include "curtain_sim/scene.h"

namespace curtain {

class Archive;

/// Change of a pose, or its rate, in world axes.
struct PoseChange {
  Vec3 move = Vec3::Zero();  ///< [m], or [m/s]
  Vec3 turn = Vec3::Zero();  ///< rotation vector [rad], or spin [rad/s]

  /// Bound of what points within `radius` [m] of the origin move by, or at.
  double reach(double radius) const noexcept { return move.norm() + radius * turn.norm(); }
};

inline PoseChange operator+(const PoseChange& a, const PoseChange& b) { return {a.move + b.move, a.turn + b.turn}; }
inline PoseChange operator-(const PoseChange& a, const PoseChange& b) { return {a.move - b.move, a.turn - b.turn}; }
inline PoseChange operator*(double factor, const PoseChange& a) { return {factor * a.move, factor * a.turn}; }

/// To the last bit.
bool samePlace(const Pose& a, const Pose& b) noexcept;
/// The change that leads from one pose to another, by the shorter rotation.
PoseChange changeBetween(const Pose& from, const Pose& to) noexcept;
/// A pose after a change.
Pose changed(const Pose& pose, const PoseChange& change) noexcept;

class PoseCurve {
 public:
  PoseCurve() = default;
  /// Stands.
  explicit PoseCurve(const Pose& pose) : from_(pose), to_(pose) {}
  /// whole: the change between both; first, last: speeds at the ends, per duration of the curve.
  PoseCurve(const Pose& from, const Pose& to, const PoseChange& whole, const PoseChange& first,
            const PoseChange& last) noexcept;
  /// At an even speed.
  static PoseCurve even(const Pose& from, const Pose& to) noexcept;

  /// share: of the time, [0..1]. Exactly the poses at its ends.
  Pose at(double share) const noexcept;
  /// Speed there, per duration of the curve.
  PoseChange rateAt(double share) const noexcept;
  /// Bound of the speed of points within `radius` [m] of the origin, per duration of the curve.
  double fastest(double radius) const noexcept;

 private:
  PoseChange changeAt(double share) const noexcept;
  PoseChange slopeAt(double share) const noexcept;
  PoseChange lastSlope() const noexcept;

  Pose from_, to_;
  PoseChange whole_, first_, last_;  // change, and speeds at both ends
};

class ScriptedMotion {
 public:
  ScriptedMotion() = default;
  /// start: where there are no poses. radius: of its points about its origin [m].
  ScriptedMotion(const Pose& start, const std::vector<PoseKey>& poses, double radius);
  ScriptedMotion(const ObstacleParams& params, double radius);

  /// False: it stands.
  bool any() const noexcept { return steady_ || !times_.empty(); }
  /// Before its first pose and after its last one it stands.
  Pose at(double time) const noexcept;
  /// Speed [m/s, rad/s].
  PoseChange rateAt(double time) const noexcept;
  /// Bound of the speed, between two times, of points within `radius` [m] of the origin [m/s].
  double fastest(double from, double to, double radius) const noexcept;

 private:
  std::size_t pieceAt(double time) const noexcept;
  double durationOf(std::size_t piece) const noexcept { return times_[piece + 1] - times_[piece]; }

  bool steady_ = false;  // moves by the constants below
  Pose start_;
  PoseChange speed_;
  Vec3 acceleration_ = Vec3::Zero();
  std::vector<double> times_;      // of the poses [s]; one at least, or none
  std::vector<PoseCurve> pieces_;  // between them
  Pose last_;
};

class FrameCurve {
 public:
  /// Stands at a pose as if it had always been there.
  void put(const Pose& pose) noexcept;
  /// Between frames: it has got to a pose, and keeps its speed.
  void arrive(const Pose& pose) noexcept { curve_ = PoseCurve(pose), script_ = nullptr; }

  /// The coming frame of `length` [s] leads to a pose. radius: of the obstacle's points about its origin [m].
  void lead(const Pose& from, const Pose& to, double length, double radius) noexcept;
  /// At an even speed, over a share of the way.
  void leadEvenly(const Pose& from, const Pose& to, double share, double length) noexcept;
  /// The coming frame follows a script, which must outlive it, and ends at this time [s].
  void follow(const ScriptedMotion& script, double end, double length) noexcept;

  /// Share of the frame, [0..1].
  Pose at(double share) const noexcept;
  /// Speed there, per frame.
  PoseChange rateAt(double share) const noexcept;
  bool moves() const noexcept { return moves_; }  ///< in the frame
  /// Bound of the way in the frame of points within `radius` [m] of the origin [m].
  double way(double radius) const noexcept;

  void serialize(Archive& archive);

 private:
  double timeAt(double share) const noexcept { return end_time_ - (1.0 - share) * length_; }

  PoseCurve curve_;
  const ScriptedMotion* script_ = nullptr;  // followed in this frame, or null
  double end_time_ = 0.0;                   // of that frame [s]
  double length_ = 0.0;                     // of the frame [s]
  bool moves_ = false;
  PoseChange mean_, last_;  // speed in the frame, and at its end [m/s, rad/s]
};

}  // namespace curtain
