// SPDX-License-Identifier: BSD-3-Clause
//
// The obstacles of a scene and where they are: a pose at the start and at the end of the frame, and in between.
#pragma once

#include <memory>
#include <vector>

#include "contact/shapes/contact_shape.h"
#include "curtain_sim/scene.h"

namespace curtain {

class Archive;

/// What has fallen behind, because frames ended early or the cloth could not give way, follows at this speed at most,
/// or at its own if that is higher [m/s]: that of a fall through the cloth's height, which moves cloth about as fast as
/// it moves by itself. Without gravity nothing bounds it.
double followingSpeed(const Scene& scene) noexcept;

/// A rigid transform ready for use on many points.
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
  bool present = true;
  Eigen::AlignedBox3d bounds;  ///< of the shape, its own frame
  Transform before;            ///< at the substep's start
  Transform after;             ///< at its end

  /// Box around the obstacle over the substep, world frame.
  const Eigen::AlignedBox3d& sweptBounds() const noexcept { return swept_; }
  void move(const Transform& from, const Transform& to) noexcept;
  void carry(Archive& archive);

 private:
  Eigen::AlignedBox3d swept_;
};

class ObstacleSet {
 public:
  /// Throws std::invalid_argument for a mesh that can't be used.
  ObstacleSet(const Scene& scene, const MeshResolver& resolve);

  int count() const { return static_cast<int>(items_.size()); }
  bool anyPresent() const noexcept;
  const Pose& pose(int index) const { return items_[at(index)].end; }
  /// Where it has got to; behind the pose when the last frame ended early.
  const Pose& reached(int index) const { return items_[at(index)].begin; }
  const ContactShape& shape(int index) const { return *items_[at(index)].shape; }
  bool present(int index) const { return moving_[at(index)].present; }
  void setPresent(int index, bool present) noexcept;

  void reset() noexcept;
  /// Frames are so long from now on [s].
  void takeFrame(double length) noexcept { frame_length_ = length; }
  /// Where the obstacle will be at the end of the coming frame, or (jump) is from now on.
  void setPose(int index, const Pose& pose, bool jump) noexcept;

  /// Starts a frame that ends at this time [s]: scripted obstacles take their pose from their motion. What has fallen
  /// behind follows, but not at any speed: for a cloth whose time runs slower it would be a blow.
  void beginFrame(double end_time) noexcept;
  /// Sets the substep, as shares of the frame in [0, 1].
  void setSubstep(double from, double to) noexcept;
  /// Ends the frame: obstacles rest where they are until they are told otherwise. share: of the frame that was made,
  /// [0, 1]; the rest of their way is part of the next one.
  void endFrame(double share = 1.0) noexcept;

  /// It moves in this frame, or has been put elsewhere, come or gone since the last one.
  bool moved(int index) const noexcept { return items_[at(index)].moved; }
  bool anyMoved() const noexcept;
  /// Box around it where it was when the last frame ended, world frame.
  Eigen::AlignedBox3d leftBox(int index) const noexcept;

  const std::vector<MovingObstacle>& moving() const { return moving_; }
  /// Box around all that are present over the substep, world frame; empty: none is.
  const Eigen::AlignedBox3d& sweptBounds() const noexcept { return swept_; }
  /// How far an obstacle's surface goes in the whole frame, at most [m]; of a plane: its origin.
  double path(int index) const noexcept;
  /// Indices in the order of the names: what depends on an order takes this one, not that of the scene's list.
  const std::vector<int>& byName() const noexcept { return by_name_; }
  /// Where an obstacle stands in it.
  int rank(int index) const { return rank_[at(index)]; }

  void carry(Archive& archive);

 private:
  struct Item {
    std::unique_ptr<const ContactShape> shape;
    std::vector<PoseKey> motion;
    Pose initial;
    Pose left;  // where the last frame left it
    Pose begin;
    Pose end;
    bool scripted = false;  // still follows its motion
    bool moved = false;
    double own_way = 0.0;  // that its pose has moved on by since the last frame [m]
    double share = 1.0;    // of the way to its pose that it goes in this frame
    bool behind = false;   // the last frame ended before it had got there
    bool placed = false;   // rests, and its substep is that already

    void carry(Archive& archive);
  };
  static std::size_t at(int index) { return static_cast<std::size_t>(index); }
  double wayBetween(const Pose& a, const Pose& b, std::size_t index) const noexcept;
  void moveOn(std::size_t index, const Pose& pose) noexcept;

  double frame_length_;     // [s]
  double following_speed_;  // [m/s]

  std::vector<Item> items_;
  std::vector<MovingObstacle> moving_;
  Eigen::AlignedBox3d swept_;
  bool at_rest_ = false;  // the last substep moved none: unless one is moved the next one finds them as they are
  std::vector<int> by_name_, rank_;
};

/// A motion's pose at a time: linear in position, slerp in orientation, held at both ends.
Pose poseAt(const std::vector<PoseKey>& motion, double time) noexcept;

}  // namespace curtain
