// SPDX-License-Identifier: BSD-3-Clause
//
// Floor 4: the simulator, scene in, state out. What most users of the engine need.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "curtain_sim/fine_mesh.h"
#include "curtain_sim/grasp.h"
#include "curtain_sim/obstacle_shape.h"
#include "curtain_sim/plan.h"
#include "curtain_sim/scene.h"
#include "curtain_sim/statistics.h"

namespace curtain {

/// A curtain. Not thread-safe, but any number of simulators may live side by side. Same scene, same calls: same bits.
/// step() throws nothing and, with one thread, allocates nothing and takes no locks (with more, oneTBB may).
class Simulator {
 public:
  /// Builds the cloth at its start. Throws std::invalid_argument with every problem of the scene or of a mesh.
  explicit Simulator(const Scene& scene, const MeshResolver& resolve = resolveMeshUrl);
  ~Simulator();
  /// A moved-from simulator can only be assigned to or destroyed.
  Simulator(Simulator&&) noexcept;
  Simulator& operator=(Simulator&&) noexcept;  ///< as above

  /// As given, with the present values of what may change: gravity, air, frame rate, friction, tolerances, budget, and
  /// the cloth's fabric (setCloth()).
  const Scene& scene() const;

  /// Back to the scene's start: time 0, its winds and drags, zero statistics. Obstacles return to their scene poses and
  /// are all present; hands let go.
  void reset();

  /// One frame of 1 / solver.frame_rate seconds (setFrameRate()). Obstacles with a scripted motion follow it.
  void step();

  double time() const;  ///< simulated time [s]
  int rows() const;     ///< nodes along the warp
  int columns() const;  ///< nodes along the weft

  /// The full state of the motion as bytes (docs/snapshots.md). Does not affect the motion.
  std::string snapshot() const;
  /// Restores a snapshot of the same scene and continues with the same bits: time, winds and drags, moves of obstacles
  /// and pins, grasps, sleep, statistics. The scene may differ in what may change (see scene()), which comes with the
  /// snapshot, in solver.threads, and in mesh paths. Returns what is wrong (damaged, cut short, of another scene or
  /// format); then nothing changed. With solver.budget_ms later bits depend on computing time. Where the cloth's fabric
  /// is another one, references end as those of setCloth() do. Allocates.
  std::vector<Problem> restore(const std::string& snapshot);

  /// Node state, row-major, shape [rows * columns]; out is resized.
  void copyPositions(std::vector<Vec3>& out) const;   ///< [m]
  void copyVelocities(std::vector<Vec3>& out) const;  ///< [m/s], at the same instant as the positions
  /// External force on each node in the last substep [N]: gravity, wind, damping, drag and contact, without the links'
  /// tensions. Zero before the first step.
  void copyForces(std::vector<Vec3>& out) const;

  /// The contacts' part of it [N].
  void copyContactForces(std::vector<Vec3>& out) const;
  /// Tensions of the links in the last substep [N], row-major, shape [rows * columns]; resized. warp: of the rod above
  /// each node (row 0: 0), negative where it is pushed; weft: of the link to the left, 0 where it is slack (column 0:
  /// of the link that closes the ring, or 0). All 0 before the first step and with method: paper.
  void copyTensions(std::vector<double>& warp, std::vector<double>& weft) const;

  /// Rest lengths [m]. warp: of the rods between two rows, from the top down, the same in every column of a
  /// cloth, of several the first's, shape [rows - 1]; weft: of the links, row by row, shape [rows * links], as
  /// FineMeshBuilder takes them. Resized.
  void copyRestLengths(std::vector<double>& warp, std::vector<double>& weft) const;
  /// Rest lengths of the rods of all columns [m], row by row, shape [(rows - 1) * columns].
  void copyRods(std::vector<double>& out) const;

  Vec3 position(NodeIndex node) const;             ///< [m]
  double mass(NodeIndex node) const;               ///< [kg], with its carrier's
  bool pinned(NodeIndex node) const;               ///< its position is prescribed, or a rigid hand's; not carriers
  NodeIndex nearestNode(const Vec3& point) const;  ///< to a point [m]; linear in the number of nodes

  /// Adds a wind source, or replaces the one with the same id; start and end are simulated times. Returns what is wrong
  /// with it; then nothing changed.
  std::vector<Problem> setWind(const WindParams& wind);
  bool removeWind(const std::string& id);        ///< false: no such id
  void clearWinds();                             ///< also those of the scene
  const std::vector<WindParams>& winds() const;  ///< the present ones

  /// The same for user forces. A drag given by a point grasps the nearest node when it first acts; if it replaces one
  /// with the same id that has a node, it keeps that node.
  std::vector<Problem> setDrag(const DragParams& drag);
  bool removeDrag(const std::string& id);        ///< false: no such id
  void clearDrags();                             ///< also those of the scene
  const std::vector<DragParams>& drags() const;  ///< the present ones

  /// Changes gravity [m/s^2], or the air, from the next step on, also after reset(). Returns what is wrong with it;
  /// then nothing changed.
  std::vector<Problem> setGravity(const Vec3& gravity);
  std::vector<Problem> setAir(const AirParams& air);  ///< as setGravity()

  /// Changes the length of frames from the next step on, also after reset(): 1 / rate seconds, rate in [1, 10000] per
  /// second. May change before every frame. Sleeping cloth stays asleep, but with frames longer than 1/20 s it does not
  /// fall asleep. Returns what is wrong with it; then nothing changed.
  std::vector<Problem> setFrameRate(double rate);

  /// Change a key of the scene from the next step on, also after reset(); cloth that sleeps wakes where the change may
  /// move it. Each returns what is wrong with the value; then nothing changed.
  ///   friction   contact.friction, [0, 10]: of the cloth on itself and on obstacles that name none
  ///   tolerance  solver.stretch_tolerance, [1e-12, 0.1]; links that are longer than a smaller one are shortened within
  ///              the next step
  ///   tolerance  solver.position_tolerance, (0, 1] m, where the scene asks for one; it is not turned on or off
  ///   ms         solver.budget_ms, [0, 1e6]; 0: no limit
  std::vector<Problem> setFriction(double friction);
  std::vector<Problem> setStretchTolerance(double tolerance);   ///< see setFriction()
  std::vector<Problem> setPositionTolerance(double tolerance);  ///< see setFriction()
  std::vector<Problem> setBudget(double ms);                    ///< see setFriction()

  /// Changes the first cloth, or that of a layer, from the next step on, also after reset(): surface_density, porosity,
  /// row_mass, column_mass, shear, bending_warp, bending_weft, bending_bias, bending_hysteresis, patches and material
  /// (a name: applyMaterial() has set the others); all else must be as it is. Motion goes on, contacts are found anew,
  /// and sleeping cloth wakes; a start by hang.start stays. Within, the simulator is made anew but for the obstacles'
  /// shapes and the fine mesh's topology: other references that it gave end, as those of scene(), statistics(),
  /// winds(). Returns what is wrong; then nothing changed.
  std::vector<Problem> setCloth(const ClothParams& cloth, const std::string& layer = kFirstCloth);

  /// Sets positions [m] and velocities [m/s] of all nodes, row-major, shape [rows * columns]; velocities of pinned
  /// nodes are ignored, carriers are put where the rail is nearest. Wakes all of the cloth and forgets the tensions.
  /// Links may be far from their lengths and nodes may coincide: the solver corrects lengths as fast as it can. Contact
  /// assumes that the present sides are right. Returns what is wrong (sizes, numbers not finite or beyond 1e9); then
  /// nothing changed. The time stays.
  std::vector<Problem> setState(const std::vector<Vec3>& positions, const std::vector<Vec3>& velocities);

  /// A cloth of the scene and its columns, [first_column, first_column + columns) of all.
  struct LayerColumns {
    std::string name;      ///< kFirstCloth, or LayerParams::name
    int first_column = 0;  ///< of all columns
    int columns = 0;       ///< how many
  };
  /// All cloths, in the order of their columns.
  std::vector<LayerColumns> layers() const;

  // Of rails, `layer` says whose: kFirstCloth, or the name of a layer.

  /// Draws the master carriers of the rail to an opening, 0 (shut) to 1 (gathered as far as the gaps allow), by the
  /// drive: not faster than its speed, not harder than its force. Arrived, it keeps them there. Returns what is wrong:
  /// no rail, not in [0, 1]; then nothing changed.
  std::vector<Problem> setOpening(double opening, const std::string& layer = kFirstCloth);
  /// Present place of the master carriers, as rail.opening; 0 without a rail.
  double opening(const std::string& layer = kFirstCloth) const;
  /// Force of its rail's drive on all masters, mean over the last frame [N]; 0 without a rail.
  double driveForce(const std::string& layer = kFirstCloth) const;
  /// The drive lets go: carriers slide freely, as before the first setOpening().
  void releaseDrive(const std::string& layer = kFirstCloth);
  /// Changes the drive's speed and force, until reset(). Returns what is wrong; then nothing changed.
  std::vector<Problem> setDrive(const DriveParams& drive, const std::string& layer = kFirstCloth);
  /// Nodes that hang by carriers of any rail, in the order of their columns; none: there is no rail.
  std::vector<NodeIndex> carriers() const;
  /// Points along the rail, from its beginning to its end, evenly, no further apart than spacing > 0 [m], in a million
  /// parts at most. Empty: there is no rail.
  std::vector<Vec3> railPoints(double spacing, const std::string& layer = kFirstCloth) const;
  bool drives(const std::string& layer = kFirstCloth) const;  ///< its rail's drive has not let go
  /// The present drive of its rail, or of the scene where there is none.
  const DriveParams& drive(const std::string& layer = kFirstCloth) const;

  /// Moves a pinned node to this point [m], evenly over the next step; there it stays. False: it is not pinned, a hand
  /// holds it, or the point is not finite.
  bool movePin(NodeIndex node, const Vec3& target);

  /// A hand takes hold of the cloth where it is now: of all nodes in its region, or of listed ones. Nodes of the region
  /// that the scene pins, that hang on a rail or that another hand holds are passed over. Sleeping cloth wakes. Returns
  /// what is wrong: a value, a region without a free node, a listed node that is not free, an id that holds already, or
  /// anything but a rigid grasp with method: paper; then nothing changed. Allocates.
  std::vector<Problem> setGrasp(const GraspParams& grasp);
  /// Pose of the gripper's frame at the end of the next step. The nodes move there evenly, and stay; where a frame ends
  /// early (solver.budget_ms), or pins have to wait for the cloth, they follow in the next ones. A hand of the scene
  /// goes where its motion leads all the same. False: no grasp of this id holds, or the pose is not finite.
  bool moveGrasp(const std::string& id, const Pose& frame);
  /// Lets go, and forgets the grasp; its nodes keep the velocity they moved with. A hand of the scene does nothing more
  /// until reset(). False: there is none of this id.
  bool releaseGrasp(const std::string& id);
  void releaseAllGrasps();  ///< as releaseGrasp(), of all
  /// How a grasp goes, or how it ended (until releaseGrasp(), reset(), or another of this id); none: there is none.
  std::optional<GraspState> graspState(const std::string& id) const;
  /// Ids of the grasps that hold or have ended, in their order; first those of the scene.
  std::vector<std::string> grasps() const;

  /// Closes a tie-back, from where its nodes are and at its speed, or opens it: its nodes are free at once. Returns
  /// what is wrong: there is none of this id; then nothing changed.
  std::vector<Problem> setTieBack(const std::string& id, bool closed);
  bool tieBackClosed(const std::string& id) const;  ///< it is, or closes; false: open, or there is none

  /// Where the lines of this id end [m]; none: there are no such lines.
  std::optional<Vec3> lineEnd(const std::string& id) const;
  /// Force of the lines on their end in the last substep [N]: up for a load that hangs. Zero: all are slack, or there
  /// are none.
  Vec3 linePull(const std::string& id) const;
  /// Tension of each of the lines in the last substep [N], in the order of LineParams::nodes; 0: slack. Resized.
  void copyLineTensions(const std::string& id, std::vector<double>& out) const;
  /// Moves a fixed end to this point [m], evenly over the next step; there it stays. False: there are no such lines,
  /// they end at a load, or the point is not finite.
  bool setLineEnd(const std::string& id, const Vec3& target);

  /// Obstacles are numbered in the scene's order.
  int obstacleCount() const;
  /// Pose of the obstacle at the end of the next step; it moves there smoothly, in place of the scene's motion. `jump`:
  /// it is there at once, without a velocity (first pose, teleport). Where the cloth is jammed in its way it waits, and
  /// where a frame ends early (solver.budget_ms) it is cut short: the rest of the motion follows in the next frames.
  void setObstaclePose(int index, const Pose& pose, bool jump = false);
  /// An absent obstacle touches nothing. When it comes back, set its pose with jump.
  void setObstaclePresent(int index, bool present);
  bool obstaclePresent(int index) const;  ///< as set; at the start: true
  /// Where it is for the cloth: at the end of the last step, or where it has jumped to since.
  const Pose& obstaclePose(int index) const;
  /// Where it is going: its pose as set last; with a scripted motion, that of the motion at the last step's end.
  const Pose& obstacleTarget(int index) const;
  /// How far it is behind its target [m], >= 0: no point of it is further than this from where it will be there (plane:
  /// its origin). After a step 0, unless it waits for jammed cloth, was cut short by solver.budget_ms, or catches up.
  double obstacleLag(int index) const;
  const ObstacleShape& obstacleShape(int index) const;  ///< lives as long as the simulator

  /// The mesh for display: both layers of nodes, outside the obstacles. Positions [m] in out.positions (resized), row
  /// by row with all nodes of both layers; fineMeshTopology() has the triangles, which never change.
  void copyFineMesh(FineMesh& out) const;
  const FineMeshTopology& fineMeshTopology() const;  ///< of copyFineMesh()

  /// Counters since the start or reset().
  const Statistics& statistics() const;

  /// What a step would do now, what it would skip, and why. Looks at all nodes and allocates: not for every frame.
  Plan plan() const;
  Energy energy() const;  ///< present energy of the cloth

  /// Starts (from zero) or stops counting the work of forces on the cloth; counting costs about 5 % of a step.
  void countWork(bool counted);
  Work work() const;  ///< counted so far

  /// Pairs of an edge and a triangle of the first layer's mesh that intersect, by brute force (slow).
  std::int64_t selfCrossings() const;

  /// Parts of the first layer's mesh that are deeper than the tolerance [m] in an obstacle at its present pose, or that
  /// go through it, by brute force (slow). An absent obstacle has none.
  Piercings piercings(int obstacle, double depth_tolerance = 1e-6) const;

  /// The same for the fine mesh.
  Piercings finePiercings(int obstacle, double depth_tolerance = 1e-6) const;

  /// Where the first layer's mesh is nearest to an obstacle at its present pose, by a query of the shape for every node
  /// (slow for large meshes). An absent obstacle is infinitely far.
  ObstacleDistance obstacleDistance(int obstacle) const;

  /// Share of an obstacle's silhouette [0..1] that the first layer's mesh hides from somebody far away in the direction
  /// `from` (any length > 0), sampled: to about a hundredth. NaN: it is absent, or a plane. Allocates.
  double covered(int obstacle, const Vec3& from) const;
  /// The cloth is between a point [m] and who looks at it from far away; from: direction towards that one, any length >
  /// 0.
  bool hides(const Vec3& point, const Vec3& from) const;

  /// Force and torque of the cloth on an obstacle, mean over the last frame; zero before the first one.
  ContactWrench contactWrench(int obstacle) const;
  /// Where the cloth presses on obstacles at the end of the last substep, with the mean forces of that substep, sorted
  /// by the obstacles' names; empty before the first step. Resized. Costs nothing until it is called.
  void copyContactPoints(std::vector<ContactForce>& out) const;

  /// Changes whenever the cloth or an obstacle may have moved, so that results for the same number can be reused.
  std::uint64_t revision() const;

  /// Hash of the bits of positions and velocities (FNV-1a, 64 bits).
  std::uint64_t stateHash() const;

 private:
  friend struct CacheClearing;  // test/clear_caches.h
  struct Impl;
  void startFrom(const std::string& file, const MeshResolver& resolve);
  void layOver(const MeshResolver& resolve);
  std::unique_ptr<Impl> impl_;
};

}  // namespace curtain
