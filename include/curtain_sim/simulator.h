// SPDX-License-Identifier: BSD-3-Clause
//
// Floor 4: the simulator, scene in, state out. What most users of the engine need.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "curtain_sim/fine_mesh.h"
#include "curtain_sim/obstacle_shape.h"
#include "curtain_sim/plan.h"
#include "curtain_sim/scene.h"
#include "curtain_sim/statistics.h"

namespace curtain {

/// A curtain. Not thread-safe: one thread at a time; any number of simulators may live side by side.
/// Same scene, same calls: same bits. step() throws nothing and, with one thread, allocates nothing and locks
/// nothing (with more, oneTBB does what it needs).
class Simulator {
 public:
  /// Builds the cloth at its start. Throws std::invalid_argument with every problem of the scene, or a mesh's.
  explicit Simulator(const Scene& scene, const MeshResolver& resolve = resolveMeshUrl);
  ~Simulator();
  /// The simulator that is moved from can only be assigned to or destroyed.
  Simulator(Simulator&&) noexcept;
  Simulator& operator=(Simulator&&) noexcept;  ///< as above

  const Scene& scene() const;  ///< as given, with the gravity, the air and the frame rate of now

  /// Back to the scene's start: time 0, its winds and drags, statistics zero. Obstacles go back to their
  /// scene poses and are all present.
  void reset();

  /// One frame of 1 / solver.frame_rate seconds (setFrameRate()). Obstacles with a scripted motion follow it.
  void step();

  double time() const;  ///< simulated time [s]
  int rows() const;     ///< nodes along the warp
  int columns() const;  ///< nodes along the weft

  /// Everything that the motion goes on from, as bytes (docs/snapshots.md). Changes nothing: not what comes next
  /// either.
  std::string snapshot() const;
  /// Goes on from a snapshot of the same scene, by the bits: time, winds and drags, gravity and air, obstacles and pins
  /// on their way, what sleeps, statistics. The scene may differ in gravity and air, which come with the snapshot, in
  /// solver.threads, and in where a mesh lies. Returns what is wrong with it (damaged, cut short, of another scene or
  /// format); then nothing changed. With solver.budget_ms computing time decides, and the bits to come may differ.
  /// Allocates.
  std::vector<Problem> restore(const std::string& snapshot);

  /// Node state, row-major, shape [rows * columns]; out is resized.
  void copyPositions(std::vector<Vec3>& out) const;   ///< [m]
  void copyVelocities(std::vector<Vec3>& out) const;  ///< [m/s], at the same instant as the positions
  /// External force on each node in the last substep [N]: gravity, wind, damping, drag and contact, without
  /// the links' tensions. Zero before the first step.
  void copyForces(std::vector<Vec3>& out) const;

  Vec3 position(NodeIndex node) const;             ///< [m]
  double mass(NodeIndex node) const;               ///< [kg]
  bool pinned(NodeIndex node) const;               ///< its position is prescribed
  NodeIndex nearestNode(const Vec3& point) const;  ///< to a point [m]; it looks at all of them

  /// Adds a wind source, or replaces the one of the same id, from now on; start and end are simulated times.
  /// Returns what is wrong with it; then nothing changed.
  std::vector<Problem> setWind(const WindParams& wind);
  bool removeWind(const std::string& id);        ///< false: no such id
  void clearWinds();                             ///< the scene's, too
  const std::vector<WindParams>& winds() const;  ///< those that are there now

  /// The same for user forces. A drag given by a point grasps the nearest node when it first acts, and one
  /// that replaces another of the same id and gives a point again keeps the node grasped.
  std::vector<Problem> setDrag(const DragParams& drag);
  bool removeDrag(const std::string& id);        ///< false: no such id
  void clearDrags();                             ///< the scene's, too
  const std::vector<DragParams>& drags() const;  ///< those that are there now

  /// Another gravity [m/s^2], or other air, from the next step on, and after reset() too. Returns what is wrong with
  /// it; then nothing changed.
  std::vector<Problem> setGravity(const Vec3& gravity);
  std::vector<Problem> setAir(const AirParams& air);  ///< as setGravity()

  /// Frames of another length from the next step on, and after reset() too: 1 / rate seconds each, rate in [1, 10000] a
  /// second. It may change before every frame; columns that sleep do so on, though where frames are longer than 1/20 s
  /// none falls asleep. Returns what is wrong with it; then nothing changed.
  std::vector<Problem> setFrameRate(double rate);

  /// Puts the cloth elsewhere: positions [m] and velocities [m/s] of all nodes, row-major, shape [rows * columns]; the
  /// velocities of pinned nodes are not read. All of it wakes, and what the solver knows of the last tensions is
  /// forgotten. Links may be much too long or short, nodes in one place: they are brought to their lengths as fast as
  /// the solver can. Contact takes the sides that parts are on now for theirs. Returns what is wrong (sizes, numbers
  /// not finite or beyond 1e9); then nothing changed. Time goes on.
  std::vector<Problem> setState(const std::vector<Vec3>& positions, const std::vector<Vec3>& velocities);

  /// Takes a pinned node to this point [m], evenly within the next step; there it stays. False: it is not pinned, or
  /// the point is not finite.
  bool movePin(NodeIndex node, const Vec3& target);

  /// Obstacles are numbered in the scene's order.
  int obstacleCount() const;
  /// Where the obstacle will be at the end of the next step, moving there evenly from where it was; it takes the place
  /// of the scene's motion. `jump`: it is there at once, without a velocity (first pose, teleport). Where a frame ended
  /// early (solver.budget_ms) the rest of the way is part of the next one.
  void setObstaclePose(int index, const Pose& pose, bool jump = false);
  /// An absent obstacle touches nothing. One that comes back must be given its pose with jump.
  void setObstaclePresent(int index, bool present);
  bool obstaclePresent(int index) const;                ///< as set, or found at the start
  const Pose& obstaclePose(int index) const;            ///< as given last
  const ObstacleShape& obstacleShape(int index) const;  ///< lives as long as the simulator

  /// The mesh that the eye sees: both layers of nodes, outside the obstacles. Positions [m] in out.positions
  /// (resized), per row all nodes of both layers; triangles are the same for ever (fineMeshTopology()).
  void copyFineMesh(FineMesh& out) const;
  const FineMeshTopology& fineMeshTopology() const;  ///< of that mesh

  /// What has been counted since the start or reset().
  const Statistics& statistics() const;

  /// What a step would do now, what it would leave out, and why. Not for every frame: it looks at all nodes and
  /// allocates.
  Plan plan() const;
  Energy energy() const;  ///< of the cloth now

  /// Whether the work of what acts on the cloth is counted from now on, from zero; it takes some 5 % of a step. work():
  /// so far.
  void countWork(bool counted);
  Work work() const;  ///< so far

  /// Pairs of an edge and a triangle of the first layer's mesh that intersect, by brute force (slow).
  std::int64_t selfCrossings() const;

  /// Parts of the first layer's mesh that are deeper than the tolerance [m] in an obstacle where it is now, or stuck
  /// through it, by brute force (slow). An absent obstacle is pierced by nothing.
  Piercings piercings(int obstacle, double depth_tolerance = 1e-6) const;

  /// The same of the fine mesh.
  Piercings finePiercings(int obstacle, double depth_tolerance = 1e-6) const;

  /// Force and torque that the cloth exerted on an obstacle, mean over the last frame; zero before the first one.
  ContactWrench contactWrench(int obstacle) const;

  /// Another number whenever the cloth or an obstacle may have moved: what was made from the shape for the same number
  /// is still right.
  std::uint64_t revision() const;

  /// Hash of the bits of positions and velocities (FNV-1a, 64 bits).
  std::uint64_t stateHash() const;

 private:
  friend struct CacheClearing;  // of tests: test/clear_caches.h
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace curtain
