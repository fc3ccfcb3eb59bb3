// SPDX-License-Identifier: BSD-3-Clause
//
// The obstacles of a scene and their poses: at the start and the end of the frame, and on a curve in between.
//
// The motion in a substep is computed only for obstacles that are asked for (moving()). An obstacle can be near only if
// the box around its whole motion in the frame is; the first test uses the ball that contains it in any orientation. So
// a robot out of reach costs one such box for each moving link in a frame, and nothing while it stands still. The
// search for near obstacles uses a box somewhat larger than asked for, and is repeated when the cloth leaves that box.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "curtain_sim/scene.h"
#include "obstacles/contact_shape.h"
#include "obstacles/pose_curve.h"

namespace curtain {

class Archive;

/// An obstacle or pin can fall behind its target, because a frame ended early or the cloth could not give way. It then
/// follows at no more than this factor times the highest speed of the target since. If it were much faster, it would
/// hit the cloth like a blow, and substeps would have to be so short that it gets no further in a frame. With 1 it
/// would never catch up with a target that moves evenly.
constexpr double kCatchUp = 1.5;

/// A rigid transform as a matrix, for many points.
struct Transform {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Vec3 translation = Vec3::Zero();

  Transform() = default;
  explicit Transform(const Pose& pose) : rotation(pose.orientation.toRotationMatrix()), translation(pose.position) {}
  Vec3 toWorld(const Vec3& local) const { return rotation * local + translation; }
  Vec3 toLocal(const Vec3& world) const { return rotation.transpose() * (world - translation); }
};

/// An obstacle as it is during one substep.
struct MovingObstacle {
  const ContactShape* shape = nullptr;
  double friction = 0.0;
  double press = 0.0;    ///< on what another one presses from the other side [N]
  double padding = 0.0;  ///< kept beyond the thickness [m]
  bool present = true;
  Eigen::AlignedBox3d bounds;  ///< of the shape with its padding, in its frame
  Transform before;            ///< at the substep's start
  Transform after;             ///< at its end
  PoseChange speed;            ///< there, per substep

  /// Box around the obstacle during the substep, world frame.
  const Eigen::AlignedBox3d& sweptBounds() const noexcept { return swept_; }
  void move(const Transform& from, const Transform& to, const PoseChange& last) noexcept;
  /// What a point of it would move by in a substep at the speed that it has after `share` of this one [m]: the mean of
  /// the speeds at both ends is what it moves by.
  Vec3 motionAt(double share, const Vec3& local) const noexcept {
    const Vec3 from = before.toWorld(local), to = after.toWorld(local);
    const Vec3 last = speed.move + speed.turn.cross(to - after.translation);
    return last + 2.0 * (1.0 - share) * (to - from - last);
  }
  /// A direction of it after `share` of the substep, in the world; unit.
  Vec3 directionAt(double share, const Vec3& local) const noexcept {
    const Vec3 from = before.rotation * local;
    return share == 0.0 ? from : Vec3(((1.0 - share) * from + share * (after.rotation * local)).normalized());
  }
  void serialize(Archive& archive);

 private:
  Eigen::AlignedBox3d swept_;
};

/// The shape of the scene's obstacle of this number. Throws std::invalid_argument for a mesh that cannot be used.
using ShapeMaker = std::function<std::shared_ptr<const ContactShape>(std::size_t number, const ObstacleParams& params)>;
/// Makes them from the scene; meshes are read from where this finds them.
ShapeMaker shapesBy(MeshResolver resolve);

class ObstacleSet {
 public:
  /// Throws std::invalid_argument with all that make_shape throws.
  ObstacleSet(const Scene& scene, const ShapeMaker& make_shape);

  int count() const { return static_cast<int>(items_.size()); }
  bool anyPresent() const noexcept;
  /// Where it is going: its pose as set last, or of its motion.
  const Pose& target(int index) const { return items_[at(index)].end; }
  /// Where it is between two frames: not at its target while it waits for the cloth, or where a frame ended early.
  const Pose& reached(int index) const { return items_[at(index)].begin; }
  /// Bound of how far a point of it is from where it will be at its target [m]; plane: its origin.
  double lag(int index) const noexcept {
    return pathBetween(items_[at(index)].begin, items_[at(index)].end, at(index));
  }
  const ContactShape& shape(int index) const { return *items_[at(index)].shape; }
  std::shared_ptr<const ContactShape> sharedShape(std::size_t number) const { return items_[number].shape; }
  bool present(int index) const { return moving_[at(index)].present; }
  void setPresent(int index, bool present) noexcept;

  void reset() noexcept;
  /// Sets the length of a frame [s].
  void setFrameLength(double length) noexcept { frame_length_ = length; }
  /// Sets the friction of those that have none of their own.
  void setFriction(double friction) noexcept;
  /// Sets the pose at the end of the coming frame, or (jump) from now on.
  void setPose(int index, const Pose& pose, bool jump) noexcept;

  /// Starts a frame that ends at this time [s]: scripted obstacles take their pose from their motion. One that fell
  /// behind catches up at a limited speed: anything faster would be a blow to the cloth.
  void beginFrame(double end_time) noexcept;
  /// Sets the substep, as shares of the frame in [0, 1].
  void setSubstep(double from, double to) noexcept;
  /// Ends the frame; obstacles rest until moved again. share [0..1]: part of the frame that was simulated; the rest
  /// of the motion moves to the next frame.
  void endFrame(double share = 1.0) noexcept;

  /// It moves in this frame, or was placed, added or removed since the last one.
  bool moved(int index) const noexcept { return items_[at(index)].moved; }
  bool anyMoved() const noexcept { return any_moved_; }
  /// Box around its pose at the end of the last frame, world frame.
  Eigen::AlignedBox3d leftBox(int index) const noexcept;

  /// The obstacle during the substep; between frames where it has got to. Valid until the next call that moves it.
  const MovingObstacle& moving(int index) noexcept {
    if (items_[at(index)].placed != substep_) place(at(index));
    return moving_[at(index)];
  }
  double padding(int index) const { return moving_[at(index)].padding; }
  double press(int index) const { return moving_[at(index)].press; }
  /// Box around all present obstacles during the frame or more, world frame, as of the last setSubstep(); empty: none.
  const Eigen::AlignedBox3d& sweptBounds() const noexcept { return swept_; }
  /// Box around one of them during the frame, with the arcs of its rotation.
  const Eigen::AlignedBox3d& sweptBounds(int index) noexcept {
    if (!items_[at(index)].exact) computeExactBox(at(index));
    return items_[at(index)].swept;
  }
  /// Present obstacles whose box of the frame may meet this one, and all that do. Valid until the next call.
  const std::vector<int>& near(const Eigen::AlignedBox3d& box) noexcept {
    if (!searched_.contains(box)) searchAround(box);
    return near_;
  }
  /// It is present and its box of the frame meets this one.
  bool mayMeet(int index, const Eigen::AlignedBox3d& box) noexcept {
    return moving_[at(index)].present && items_[at(index)].swept.intersects(box) && sweptBounds(index).intersects(box);
  }
  /// Bound of how far a point of its surface would move in a frame at the largest speed of this one [m]; plane: its
  /// origin.
  double path(int index) const noexcept { return items_[at(index)].path(); }
  /// Indices sorted by name: results depend on names, not on the order in the scene.
  const std::vector<int>& byName() const noexcept { return by_name_; }
  /// Position of an obstacle in byName().
  int rank(int index) const { return rank_[at(index)]; }

  void serialize(Archive& archive);

 private:
  struct Item {
    std::shared_ptr<const ContactShape> shape;
    ScriptedMotion script;
    FrameCurve curve;  // from begin, in the frame
    Pose initial;
    Pose left;  // at the end of the last frame
    Pose begin;
    Pose end;
    bool scripted = false;  // follows its script
    bool moves = false;     // in the frame
    bool moved = false;
    bool stands = false;        // has stood for a frame, and nothing has moved it since
    double radius = 0.0;        // of its points about its origin, with the padding [m]
    double pace = 0.0;          // of its target, at its fastest since it was last there [m a frame]
    bool behind = false;        // the last frame ended short of the target
    std::uint64_t placed = 0;   // substep that its MovingObstacle is of
    Eigen::AlignedBox3d swept;  // around its motion in the frame, world frame
    bool exact = false;         // that box is no larger than need be
    bool boxed = false;         // and holds until it moves
    bool own_friction = false;  // the scene names its friction

    double arm() const noexcept;
    double path() const noexcept { return curve.way(arm()); }
    void serialize(Archive& archive);
  };
  static std::size_t at(int index) { return static_cast<std::size_t>(index); }
  double pathBetween(const Pose& a, const Pose& b, std::size_t index) const noexcept;
  void moveOn(std::size_t index, const Pose& pose) noexcept;
  void touch(Item& item) noexcept;
  void place(std::size_t index) noexcept;
  void computeBoxes() noexcept;
  void computeExactBox(std::size_t index) noexcept;
  void searchAround(const Eigen::AlignedBox3d& box) noexcept;

  double frame_length_;  // [s]

  std::vector<Item> items_;
  std::vector<MovingObstacle> moving_;
  Eigen::AlignedBox3d swept_;
  double from_ = 0.0, to_ = 0.0;  // the substep, as shares of the frame
  std::uint64_t substep_ = 1;     // counts the substeps that obstacles are placed for
  bool any_moved_ = false;
  bool boxed_ = false;            // the boxes are those of the frame
  bool at_rest_ = false;          // and no obstacle moves in it
  Eigen::AlignedBox3d searched_;  // that near_ holds for
  std::vector<int> near_;
  std::vector<int> by_name_, rank_;
};

}  // namespace curtain
