// SPDX-License-Identifier: BSD-3-Clause
#include "curtain_sim/simulator.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "contact/oracle/piercings.h"
#include "scene/find_by_id.h"
#include "scene/fnv1a.h"
#include "scene/ranges.h"
#include "simulator/self_crossings.h"
#include "simulator/simulator_impl.h"

namespace curtain {

const char* stageName(Stage stage) {
  constexpr std::array<const char*, kStageCount> kNames = {"forces",  "predict", "warp",    "weft",
                                                           "contact", "finish",  "estimate"};
  return kNames.at(static_cast<std::size_t>(stage));
}

namespace {

const Scene& judged(const Scene& scene) {
  const std::vector<Problem> problems = validate(scene);
  if (!problems.empty()) throw std::invalid_argument(describe(problems));
  return scene;
}

ClothPattern patternOf(const Scene& scene) {
  ClothPattern pattern = makePattern(scene);
  const std::vector<Problem> problems = problemsOfCords(scene, pattern);
  if (!problems.empty()) throw std::invalid_argument(describe(problems));
  return pattern;
}

}  // namespace

Simulator::Impl::Impl(const Scene& given, const MeshResolver& resolve)
    : scene(judged(given)),
      pattern(patternOf(scene)),
      times(scene.solver.frame_rate),
      motion(scene, pattern, times, resolve),
      opening(scene, pattern, motion.carriers),
      controls(scene.solver, pattern, scene.gravity),
      sleep(motion),
      budget(scene.solver.budget_ms),
      loop(motion, controls, budget),
      guard(motion, controls, !ErrorControl::wanted(scene.solver)),
      grasps(motion.grasps),
      pins(pattern),
      surface(scene.cloth, pattern) {
  if (ErrorControl::wanted(scene.solver)) errors.emplace(motion, controls, loop, budget);
  opening.measure(motion.state, motion.statistics);
}

void Simulator::Impl::reset() {
  times.reset();
  if (grasps.clear(pins)) takePins();
  motion.reset();
  controls.reset();
  sleep.reset();
  budget.forget();
  if (errors) errors->reset();
  guard.forget();
  pins.clear();
  opening.reset();
  opening.measure(motion.state, motion.statistics);
  ++revision;
}

void Simulator::Impl::takeGravity() noexcept {
  motion.forces.takeGravity();
  controls.takeGravity(pattern, scene.gravity);
}

// Takes what follows from the pins. Allocates nothing but for Method::kPaper.
void Simulator::Impl::takePins() {
  pinBeside(grasps.scenePins(), grasps.pinned(), scene.cloth, pattern);
  motion.takePins();
  guard.takePins();
  sleep.takeLimits();
}

// The drive, or a tie-back, does something else from now on.
void Simulator::Impl::driven() noexcept {
  guard.forget();
  sleep.rest().disturb();
}

void Simulator::Impl::takeFrame() noexcept {
  controls.takeFrame(times.length());
  motion.obstacles.takeFrame(times.length());
  sleep.takeLimits();
}

Simulator::Simulator(const Scene& scene, const MeshResolver& resolve) : impl_(std::make_unique<Impl>(scene, resolve)) {}
Simulator::~Simulator() = default;
Simulator::Simulator(Simulator&&) noexcept = default;
Simulator& Simulator::operator=(Simulator&&) noexcept = default;

const Scene& Simulator::scene() const { return impl_->scene; }
void Simulator::reset() { impl_->reset(); }
void Simulator::step() { impl_->step(); }
double Simulator::time() const { return impl_->motion.statistics.time; }
int Simulator::rows() const { return impl_->pattern.grid.rows; }
int Simulator::columns() const { return impl_->pattern.grid.columns; }

namespace {

void copyField(const Grid& grid, const Field3& field, std::vector<Vec3>& out) {
  out.resize(grid.nodeCount());
  std::size_t n = 0;
  for (int i = 0; i < grid.rows; ++i) {
    for (int j = 0; j < grid.columns; ++j) out[n++] = field.at(grid.index(i, j));
  }
}

}  // namespace

void Simulator::copyPositions(std::vector<Vec3>& out) const {
  copyField(impl_->pattern.grid, impl_->motion.state.position, out);
}

void Simulator::copyVelocities(std::vector<Vec3>& out) const {
  copyField(impl_->pattern.grid, impl_->motion.velocities(), out);
}

void Simulator::copyForces(std::vector<Vec3>& out) const {
  Impl& im = *impl_;
  const Grid& grid = im.pattern.grid;
  Field3& total = im.total_force;
  total = *im.motion.forces.last().force;
  if (im.motion.forces.last().has_damping) {
    const Field3& velocity = im.motion.state.velocity;  // that substep's own
    for (std::size_t n = 0; n < grid.size(); ++n) total.add(n, -im.motion.forces.last().damping[n] * velocity.at(n));
  }
  if (im.motion.contact.wanted()) im.motion.contact.addForces(total);
  copyField(grid, total, out);
}

void Simulator::copyContactForces(std::vector<Vec3>& out) const {
  Impl& im = *impl_;
  im.total_force.assign(im.pattern.grid.size(), 0.0);
  if (im.motion.contact.wanted()) im.motion.contact.addForces(im.total_force);
  copyField(im.pattern.grid, im.total_force, out);
}

void Simulator::copyContactPoints(std::vector<ContactForce>& out) const {
  out.clear();
  if (impl_->motion.contact.wanted()) impl_->motion.contact.copyForces(impl_->motion.state.position, out);
}

void Simulator::copyTensions(std::vector<double>& warp, std::vector<double>& weft) const {
  warp.clear();
  weft.clear();
  for (int i = 0; i < rows(); ++i) {
    for (int j = 0; j < columns(); ++j) {
      const Constraints::LinkTensions tensions = impl_->motion.exact.tensionsAt(i, j);
      warp.push_back(tensions.warp);
      weft.push_back(tensions.weft);
    }
  }
}

void Simulator::copyRestLengths(std::vector<double>& warp, std::vector<double>& weft) const {
  const ClothPattern& pattern = impl_->pattern;
  const Grid& grid = pattern.grid;
  warp.clear();
  weft.clear();
  for (int i = 0; i < grid.rows; ++i) {
    if (i > 0) warp.push_back(pattern.warp_rest[grid.index(i, 0)]);
    for (int link = 0; link < grid.linkCount(); ++link) {
      weft.push_back(pattern.weft_rest[grid.index(i, (link + 1) % grid.columns)]);
    }
  }
}

Vec3 Simulator::position(NodeIndex node) const {
  return impl_->motion.state.position.at(impl_->pattern.grid.index(node));
}
double Simulator::mass(NodeIndex node) const { return impl_->pattern.mass[impl_->pattern.grid.index(node)]; }
bool Simulator::pinned(NodeIndex node) const { return impl_->pattern.isPinned(node); }
NodeIndex Simulator::nearestNode(const Vec3& point) const {
  return curtain::nearestNode(impl_->pattern.grid, impl_->motion.state.position, point);
}

namespace {

template <typename Params>
bool actsAt(const Params& source, double time) {
  return source.start <= time && time < source.end;
}

// An unchanged source that is given again continues: it keeps its start, so that nothing wakes.
template <typename Params>
Params asItGoesOn(Params source, const Params& old) {
  source.start = old.start;
  return source;
}

}  // namespace

std::vector<Problem> Simulator::setWind(const WindParams& wind) {
  std::vector<Problem> problems = validate(wind, "wind");
  if (!problems.empty()) return problems;
  Impl& im = *impl_;
  const WindParams* const old = findById(im.motion.forces.winds(), wind.id);
  const double now = im.motion.statistics.time;
  if (old != nullptr && actsAt(*old, now) && actsAt(wind, now) && sameWhileItBlows(*old, wind)) {
    im.motion.forces.setWind(asItGoesOn(wind, *old));
    return problems;
  }
  im.sleep.disturbByWind(wind.id);
  im.motion.forces.setWind(wind);
  if (im.motion.forces.readsPulls()) im.sleep.takeLimits();  // the wind's speed damps
  im.sleep.disturbByWind(wind.id);
  return problems;
}

bool Simulator::removeWind(const std::string& id) {
  impl_->sleep.disturbByWind(id);
  return impl_->motion.forces.removeWind(id);
}

void Simulator::clearWinds() {
  if (!impl_->motion.forces.winds().empty()) impl_->sleep.rest().disturb();
  impl_->motion.forces.clearWinds();
}

const std::vector<WindParams>& Simulator::winds() const { return impl_->motion.forces.winds(); }

std::vector<Problem> Simulator::setDrag(const DragParams& drag) {
  Impl& im = *impl_;
  std::vector<Problem> problems = validate(drag, im.scene.cloth, "drag");
  if (!problems.empty()) return problems;
  const DragParams* const old = findById(im.motion.forces.drags(), drag.id);
  const double now = im.motion.statistics.time;
  if (old != nullptr && actsAt(*old, now) && actsAt(drag, now) && sameWhileItActs(*old, drag)) {
    im.motion.forces.setDrag(asItGoesOn(drag, *old));
    return problems;
  }
  im.motion.forces.setDrag(drag);
  im.sleep.rest().disturb();
  return problems;
}

bool Simulator::removeDrag(const std::string& id) {
  const bool removed = impl_->motion.forces.removeDrag(id);
  if (removed) impl_->sleep.rest().disturb();
  return removed;
}

void Simulator::clearDrags() {
  ForceField& forces = impl_->motion.forces;
  if (!forces.drags().empty()) impl_->sleep.rest().disturb();
  forces.clearDrags();
}

std::vector<Problem> Simulator::setGravity(const Vec3& gravity) {
  const Range range = anywhere();
  const bool good = range.contains(gravity.x()) && range.contains(gravity.y()) && range.contains(gravity.z());
  if (!good) return {{"gravity", "must be 3 times " + range.text()}};
  Impl& im = *impl_;
  if (gravity == im.scene.gravity) return {};
  im.motion.velocities();  // caches them while the forces that made them are known
  im.scene.gravity = gravity;
  im.takeGravity();
  im.guard.forget();
  im.sleep.takeLimits();
  im.sleep.rest().disturb();
  return {};
}

std::vector<Problem> Simulator::setAir(const AirParams& air) {
  Scene with_air = impl_->scene;
  with_air.air = air;
  std::vector<Problem> problems = validate(with_air);  // not every method and wind goes with every law
  if (!problems.empty()) return problems;
  impl_->motion.velocities();  // as in setGravity()
  impl_->scene.air = air;
  impl_->motion.forces.takeAir();
  impl_->sleep.takeLimits();
  impl_->sleep.rest().disturb();
  return problems;
}
const std::vector<DragParams>& Simulator::drags() const { return impl_->motion.forces.drags(); }

std::vector<NodeIndex> Simulator::carriers() const {
  std::vector<NodeIndex> nodes;
  for (const int column : impl_->pattern.rail.columns) nodes.push_back({0, column});
  return nodes;
}

std::vector<Vec3> Simulator::railPoints(double spacing) const {
  const RailPattern& rail = impl_->pattern.rail;
  if (rail.empty()) return {};
  constexpr double kMostParts = 1e6;
  const int parts = static_cast<int>(std::clamp(std::ceil(rail.path.length() / spacing), 1.0, kMostParts));
  std::vector<Vec3> points;
  for (int k = 0; k <= parts; ++k) points.push_back(rail.path.at(rail.path.length() * k / parts).point);
  return points;
}

int Simulator::obstacleCount() const { return impl_->motion.obstacles.count(); }
void Simulator::setObstaclePose(int index, const Pose& pose, bool jump) {
  impl_->motion.obstacles.setPose(index, pose, jump);
  if (jump) ++impl_->revision;
}
void Simulator::setObstaclePresent(int index, bool present) {
  if (present == impl_->motion.obstacles.present(index)) return;
  impl_->motion.obstacles.setPresent(index, present);
  ++impl_->revision;
}
bool Simulator::obstaclePresent(int index) const { return impl_->motion.obstacles.present(index); }
const Pose& Simulator::obstaclePose(int index) const { return impl_->motion.obstacles.reached(index); }
const Pose& Simulator::obstacleTarget(int index) const { return impl_->motion.obstacles.target(index); }
double Simulator::obstacleLag(int index) const { return impl_->motion.obstacles.lag(index); }
const ObstacleShape& Simulator::obstacleShape(int index) const { return impl_->motion.obstacles.shape(index); }

void Simulator::copyFineMesh(FineMesh& out) const {
  impl_->surface.build(impl_->motion.state.position, impl_->motion.obstacles, impl_->scene.contact.thickness, out);
}
const FineMeshTopology& Simulator::fineMeshTopology() const { return impl_->surface.topology(); }

const Statistics& Simulator::statistics() const { return impl_->motion.statistics; }

Energy Simulator::energy() const { return impl_->motion.energy(); }

void Simulator::countWork(bool counted) {
  impl_->motion.counts_work = counted;
  impl_->motion.ledger.restore({});
}

Work Simulator::work() const { return impl_->motion.ledger.work(); }

std::int64_t Simulator::selfCrossings() const {
  return countSelfCrossings(impl_->pattern.grid, impl_->motion.state.position);
}

Piercings Simulator::piercings(int obstacle, double depth_tolerance) const {
  const ObstacleSet& obstacles = impl_->motion.obstacles;
  if (!obstacles.present(obstacle)) return {};
  return countPiercings(obstacles.shape(obstacle), Transform(obstacles.reached(obstacle)), impl_->pattern.grid,
                        impl_->motion.state.position, depth_tolerance);
}

Piercings Simulator::finePiercings(int obstacle, double depth_tolerance) const {
  const ObstacleSet& obstacles = impl_->motion.obstacles;
  if (!obstacles.present(obstacle)) return {};
  FineMesh mesh;
  copyFineMesh(mesh);
  return countPiercings(obstacles.shape(obstacle), Transform(obstacles.reached(obstacle)), mesh.positions,
                        fineMeshTopology().triangles, depth_tolerance);
}

ContactWrench Simulator::contactWrench(int obstacle) const { return impl_->motion.contact.wrench(obstacle); }

std::uint64_t Simulator::revision() const { return impl_->revision; }

std::uint64_t Simulator::stateHash() const {
  const Grid& grid = impl_->pattern.grid;
  Fnv1a bits;
  for (int i = 0; i < grid.rows; ++i) {
    for (int j = 0; j < grid.columns; ++j) {
      const std::size_t n = grid.index(i, j);
      for (const Field3* field : {&impl_->motion.state.position, &impl_->motion.state.velocity}) {
        for (const Field* axis : {&field->x, &field->y, &field->z}) bits.addBytes(&(*axis)[n], sizeof(double));
      }
    }
  }
  for (const CordEnd& end : impl_->pattern.cords.ends) {
    for (const Field3* field : {&impl_->motion.state.position, &impl_->motion.state.velocity}) {
      const Vec3 value = field->at(end.node);
      bits.addBytes(value.data(), 3 * sizeof(double));
    }
  }
  return bits.hash;
}

}  // namespace curtain
