// SPDX-License-Identifier: BSD-3-Clause
#include "curtain_sim/simulator.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "contact/oracle/coverage.h"
#include "contact/oracle/obstacle_distance.h"
#include "contact/oracle/piercings.h"
#include "scene/fnv1a.h"
#include "scene/ranges.h"
#include "simulator/self_crossings.h"
#include "simulator/simulator_impl.h"
#include "simulator/start/laid_start.h"

namespace curtain {

const char* stageName(Stage stage) {
  constexpr std::array<const char*, kStageCount> kNames = {"forces",  "predict", "warp",    "weft",
                                                           "contact", "finish",  "estimate"};
  return kNames.at(static_cast<std::size_t>(stage));
}

const char* toString(FrameQuality quality) {
  constexpr std::array<const char*, kFrameQualityCount> kNames = {"resolved", "hurried", "unsettled", "bounded",
                                                                  "stopped"};
  return kNames.at(static_cast<std::size_t>(quality));
}

namespace {

const Scene& judged(const Scene& scene) {
  const std::vector<Problem> problems = validate(scene);
  if (!problems.empty()) throw std::invalid_argument(describe(problems));
  return scene;
}

ClothPattern patternOf(const Scene& scene) {
  ClothPattern pattern = makePattern(scene);
  const std::vector<Problem> problems = problemsAtStart(scene, pattern);
  if (!problems.empty()) throw std::invalid_argument(describe(problems));
  return pattern;
}

}  // namespace

Simulator::Impl::Impl(const Scene& given, const ShapeMaker& make_shape)
    : scene(judged(given)),
      pattern(patternOf(scene)),
      times(scene.solver.frame_rate),
      motion(scene, pattern, times, make_shape),
      controls(scene.solver, pattern, scene.gravity),
      sleep(motion),
      budget(scene.solver.budget_ms),
      loop(motion, controls, budget),
      closed(motion, controls, !ErrorControl::wanted(scene.solver)),
      surface(wholeCloth(scene), pattern),
      pinned_by_parts(pattern.grid.size(), 0) {
  pinsChanged();
  if (ErrorControl::wanted(scene.solver)) errors.emplace(motion, controls, loop, budget);
}

void Simulator::Impl::reset() {
  times.reset();
  motion.reset();
  pinsChanged();
  controls.reset();
  sleep.reset();
  budget.forget();
  if (errors) errors->reset();
  motion.step.account().leaveOpen();
  ++revision;
}

// Updates what depends on the keys of the scene that may change.
void Simulator::Impl::keysChanged() {
  for (Part* const part : motion.parts.all) part->resume();
  motion.forces.gravityChanged();
  motion.obstacles.setFriction(scene.contact.friction);
  motion.contact.setFriction(scene.contact.friction);
  motion.obstacles.setFrameLength(times.length());
  motion.contact.setStretchTolerance(scene.solver.stretch_tolerance);
  motion.step.setStretchTolerance(scene.solver.stretch_tolerance);
  budget.set(scene.solver.budget_ms);
  controls.both([this](StepControl& control) {
    control.setGravity(pattern, scene.gravity);
    control.setFrameLength(times.length());
    if (!budget.any()) control.allow(std::numeric_limits<int>::max());
  });
  sleep.limitsChanged();
}

// Updates what depends on the pins. Allocates nothing but for Method::kPaper.
void Simulator::Impl::pinsChanged() {
  std::fill(pinned_by_parts.begin(), pinned_by_parts.end(), std::uint8_t{0});
  for (const Part* const part : motion.parts.all) part->pin(pinned_by_parts);
  pinBeside(pinned_by_parts, motion.parts.layers, pattern);
  motion.pinsChanged();
  closed.pinsChanged();
  sleep.limitsChanged();
}

// Something that puts energy in does something else from now on.
void Simulator::Impl::driven() noexcept {
  motion.step.account().leaveOpen();
  sleep.rest().disturb();
}

Simulator::Simulator(const Scene& scene, const MeshResolver& resolve)
    : impl_(std::make_unique<Impl>(scene, shapesBy(resolve))) {
  const StartParams& start = scene.hang.start;
  if (start.file) startFrom(*start.file, resolve);
  if (!start.file && startsElsewhere(impl_->scene)) layOver(resolve);
  const std::string problem = problemOfLayers(impl_->scene, impl_->pattern, impl_->motion.state.position);
  if (!problem.empty()) throw std::invalid_argument("layers: " + problem);
}
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
      const Constraints::LinkTensions tensions = impl_->motion.step.tensionsAt(i, j);
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

void Simulator::copyRods(std::vector<double>& out) const {
  const Grid& grid = impl_->pattern.grid;
  out.clear();
  for (int i = 1; i < grid.rows; ++i) {
    for (int j = 0; j < grid.columns; ++j) out.push_back(impl_->pattern.warp_rest[grid.index(i, j)]);
  }
}

Vec3 Simulator::position(NodeIndex node) const {
  return impl_->motion.state.position.at(impl_->pattern.grid.index(node));
}
double Simulator::mass(NodeIndex node) const { return impl_->pattern.mass[impl_->pattern.grid.index(node)]; }
bool Simulator::pinned(NodeIndex node) const { return impl_->pattern.isPinned(node); }

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
  impl_->motion.step.account().restore({});
}

Work Simulator::work() const { return impl_->motion.step.account().work(); }

std::int64_t Simulator::selfCrossings() const {
  return countSelfCrossings(impl_->pattern.grid, impl_->motion.state.position);
}

ObstacleDistance Simulator::obstacleDistance(int obstacle) const {
  const ObstacleSet& obstacles = impl_->motion.obstacles;
  if (!obstacles.present(obstacle)) return {};
  return distanceTo(obstacles.shape(obstacle), Transform(obstacles.reached(obstacle)), impl_->pattern.grid,
                    impl_->motion.state.position);
}

double Simulator::covered(int obstacle, const Vec3& from) const {
  const ObstacleSet& obstacles = impl_->motion.obstacles;
  if (!obstacles.present(obstacle)) return std::numeric_limits<double>::quiet_NaN();
  return coveredShare(obstacles.shape(obstacle), Transform(obstacles.reached(obstacle)), impl_->pattern.grid,
                      impl_->motion.state.position, from);
}

bool Simulator::hides(const Vec3& point, const Vec3& from) const {
  return hidesPoint(impl_->pattern.grid, impl_->motion.state.position, point, from);
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
  for (int i = 0; i < grid.allRows(); ++i) {
    for (int j = 0; j < grid.columns; ++j) {
      const std::size_t n = grid.index(i, j);
      if (!impl_->pattern.isThere(n)) continue;
      for (const Field3* field : {&impl_->motion.state.position, &impl_->motion.state.velocity}) {
        const Vec3 value = field->at(n);
        bits.addBytes(value.data(), 3 * sizeof(double));
      }
    }
  }
  return bits.hash;
}

}  // namespace curtain
