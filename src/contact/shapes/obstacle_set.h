// SPDX-License-Identifier: BSD-3-Clause
//
// The obstacles of a scene and their poses: at the start and the end of the frame, interpolated in between.
#pragma once

#include <memory>
#include <vector>

#include "contact/shapes/contact_shape.h"
#include "curtain_sim/scene.h"

namespace curtain {

class Archive;

/// Speed limit of an obstacle that fell behind its pose, because a frame ended early or the cloth could not give way
/// [m/s]; its own speed if that is higher. It is that of a free fall through the cloth's height, at which cloth
/// commonly moves by itself. Infinite without gravity.
double followingSpeed(const Scene& scene) noexcept;

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
  double press = 0.0;  ///< on what another one presses from the other side [N]
  bool present = true;
  Eigen::AlignedBox3d bounds;  ///< of the shape, in its frame
  Transform before;            ///< at the substep's start
  Transform after;             ///< at its end

  /// Box around the obstacle during the substep, world frame.
  const Eigen::AlignedBox3d& sweptBounds() const noexcept { return swept_; }
  void move(const Transform& from, const Transform& to) noexcept;
  void carry(Archive& archive);

 private:
  Eigen::AlignedBox3d swept_;
};

class ObstacleSet {
 public:
  /// Throws std::invalid_argument for a mesh that cannot be used.
  ObstacleSet(const Scene& scene, const MeshResolver& resolve);

  int count() const { return static_cast<int>(items_.size()); }
  bool anyPresent() const noexcept;
  const Pose& pose(int index) const { return items_[at(index)].end; }
  /// Pose reached so far; differs from pose() when the last frame ended early.
  const Pose& reached(int index) const { return items_[at(index)].begin; }
  const ContactShape& shape(int index) const { return *items_[at(index)].shape; }
  bool present(int index) const { return moving_[at(index)].present; }
  void setPresent(int index, bool present) noexcept;

  void reset() noexcept;
  /// Sets the length of a frame [s].
  void takeFrame(double length) noexcept { frame_length_ = length; }
  /// Sets the friction of those that have none of their own.
  void takeFriction(double friction) noexcept;
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
  bool anyMoved() const noexcept;
  /// Box around its pose at the end of the last frame, world frame.
  Eigen::AlignedBox3d leftBox(int index) const noexcept;

  const std::vector<MovingObstacle>& moving() const { return moving_; }
  /// Box around all present obstacles during the substep, world frame; empty: none.
  const Eigen::AlignedBox3d& sweptBounds() const noexcept { return swept_; }
  /// Bound of how far a point of its surface moves in the frame [m]; plane: its origin.
  double path(int index) const noexcept;
  /// Indices sorted by name: results depend on names, not on the order in the scene.
  const std::vector<int>& byName() const noexcept { return by_name_; }
  /// Position of an obstacle in byName().
  int rank(int index) const { return rank_[at(index)]; }

  void carry(Archive& archive);

 private:
  struct Item {
    std::unique_ptr<const ContactShape> shape;
    std::vector<PoseKey> motion;
    Pose initial;
    Pose left;  // at the end of the last frame
    Pose begin;
    Pose end;
    bool scripted = false;  // follows its motion
    bool moved = false;
    double own_path = 0.0;      // displacement of its target since the last frame [m]
    double share = 1.0;         // part of the remaining path covered in this frame
    bool behind = false;        // the last frame ended short of the target
    bool placed = false;        // at rest, with its substep set
    bool own_friction = false;  // the scene names its friction

    void carry(Archive& archive);
  };
  static std::size_t at(int index) { return static_cast<std::size_t>(index); }
  double pathBetween(const Pose& a, const Pose& b, std::size_t index) const noexcept;
  void moveOn(std::size_t index, const Pose& pose) noexcept;

  double frame_length_;     // [s]
  double following_speed_;  // [m/s]

  std::vector<Item> items_;
  std::vector<MovingObstacle> moving_;
  Eigen::AlignedBox3d swept_;
  bool at_rest_ = false;  // no obstacle moved in the last substep: the next one need not be set
  std::vector<int> by_name_, rank_;
};

/// Pose of a motion at a time: linear in position, slerp in orientation, clamped at both ends.
Pose poseAt(const std::vector<PoseKey>& motion, double time) noexcept;

}  // namespace curtain
