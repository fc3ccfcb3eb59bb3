// SPDX-License-Identifier: BSD-3-Clause
#include "curtain_sim/simulator.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "contact/piercings.h"
#include "scene/fnv1a.h"
#include "scene/ranges.h"
#include "simulator/self_crossings.h"
#include "simulator/simulator_impl.h"
#include "solver/composition.h"

namespace curtain {

const char* stageName(Stage stage) {
  switch (stage) {
    case Stage::kForces: return "forces";
    case Stage::kPredict: return "predict";
    case Stage::kWarp: return "warp";
    case Stage::kWeft: return "weft";
    case Stage::kContact: return "contact";
    case Stage::kFinish: return "finish";
    case Stage::kEstimate: return "estimate";
    case Stage::kStageCount: break;
  }
  return "";
}

namespace {

const Scene& judged(const Scene& scene) {
  const std::vector<Problem> problems = validate(scene);
  if (!problems.empty()) throw std::invalid_argument(describe(problems));
  return scene;
}

SolverParams asAuto(SolverParams params) {
  params.method = Method::kAuto;
  params.substeps = 0;
  return params;
}

}  // namespace

Simulator::Impl::Impl(const Scene& given, const MeshResolver& resolve)
    : scene(judged(given)),
      pattern(makePattern(scene)),
      initial(makeInitialState(scene, pattern)),
      state(initial),
      forces(scene, pattern),
      obstacles(scene, resolve),
      contact(pattern, scene.contact, obstacles,
              scene.solver.stretch_tolerance),
      workers(threadsFor(scene.solver.threads, pattern.grid.nodeCount())),
      exact(pattern, scene.solver.stretch_tolerance, scene.solver.max_sweeps, workers),
      paper(pattern),
      control(scene.solver, pattern, scene.gravity),
      plain_control(asAuto(scene.solver), pattern, scene.gravity),
      surface(scene.cloth, pattern),
      rest(pattern, 1.0 / scene.solver.frame_rate, scene.contact.thickness, scene.solver.stretch_tolerance),
      kept_awake(pattern.grid.columns),
      ledger(pattern),
      budget(scene.solver.budget_ms),
      has_pins(std::any_of(pattern.pinned.begin(), pattern.pinned.end(), [](auto pinned) { return pinned != 0; })),
      total_mass(std::accumulate(pattern.mass.begin(), pattern.mass.end(), 0.0)),
      shortest_link(shortestLink(pattern)) {
  setRestLimits();
  exact.hold(rest.asleep(), state);
  exact.expectContacts(contact.capacity());
  velocities.assign(pattern.grid.size(), 0.0);
  before.state = initial;
  exact.save(before.memory);
  if (scene.solver.position_tolerance > 0.0 && ErrorEstimate::knows(scene.solver.method)) {
    const int order = scene.solver.method == Method::kLeapfrog4 ? 4 : 2;
    const bool fixed = scene.solver.substeps > 0;
    estimate = std::make_unique<ErrorEstimate>(pattern, 1.0 / scene.solver.frame_rate, scene.solver.position_tolerance, order,
                                               order == 4 ? static_cast<int>(kStages.size()) : 1,
                                               std::max(1, scene.solver.substeps),
                                               fixed ? scene.solver.substeps : scene.solver.max_substeps);
    companion = rehearsal = {initial, before.memory, 0, 0, true, false, false};
  }
}

void Simulator::Impl::reset() {
  state = initial;
  if (estimate != nullptr) estimate->reset();
  rest.forget();
  budget.forget();
  forces.reset();
  obstacles.reset();
  contact.forget();
  exact.reset();
  exact.hold(rest.asleep(), state);
  control.reset();
  plain_control.reset();
  plain_frames = 0;
  clock.reset();
  statistics = Statistics();
  frame = 0;
  same_since = {};
  ledger.restore({});
  most_energy.reset();
  made_time = 0.0;
  pin_moves.clear();
  velocities_fresh = false;
  ++revision;
}

Simulator::Simulator(const Scene& scene, const MeshResolver& resolve) : impl_(std::make_unique<Impl>(scene, resolve)) {}
Simulator::~Simulator() = default;
Simulator::Simulator(Simulator&&) noexcept = default;
Simulator& Simulator::operator=(Simulator&&) noexcept = default;

const Scene& Simulator::scene() const { return impl_->scene; }
void Simulator::reset() { impl_->reset(); }
void Simulator::step() { impl_->step(); }
double Simulator::time() const { return impl_->statistics.time; }
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
  copyField(impl_->pattern.grid, impl_->state.position, out);
}

void Simulator::copyVelocities(std::vector<Vec3>& out) const {
  copyField(impl_->pattern.grid, impl_->currentVelocities(), out);
}

void Simulator::copyForces(std::vector<Vec3>& out) const {
  Impl& im = *impl_;
  const Grid& grid = im.pattern.grid;
  Field3& total = im.total_force;
  total = *im.forces.last().force;
  if (im.forces.last().has_damping) {
    const Field3& velocity = im.state.velocity;  // that substep's own
    for (std::size_t n = 0; n < grid.size(); ++n) total.add(n, -im.forces.last().damping[n] * velocity.at(n));
  }
  if (im.contact.wanted()) im.contact.addForces(total);
  copyField(grid, total, out);
}

Vec3 Simulator::position(NodeIndex node) const { return impl_->state.position.at(impl_->pattern.grid.index(node)); }
double Simulator::mass(NodeIndex node) const { return impl_->pattern.mass[impl_->pattern.grid.index(node)]; }
bool Simulator::pinned(NodeIndex node) const { return impl_->pattern.isPinned(node); }
NodeIndex Simulator::nearestNode(const Vec3& point) const {
  return curtain::nearestNode(impl_->pattern.grid, impl_->state.position, point);
}

namespace {

template <typename Params>
const Params* findById(const std::vector<Params>& all, const std::string& id) {
  const auto found = std::find_if(all.begin(), all.end(), [&id](const Params& one) { return one.id == id; });
  return found != all.end() ? &*found : nullptr;
}

template <typename Params>
bool actsAt(const Params& source, double time) {
  return source.start <= time && time < source.end;
}

// A source that is given again as it is goes on: since when, nothing feels.
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
  const WindParams* const old = findById(im.forces.winds(), wind.id);
  const double now = im.statistics.time;
  if (old != nullptr && actsAt(*old, now) && actsAt(wind, now) && sameWhileItBlows(*old, wind)) {
    im.forces.setWind(asItGoesOn(wind, *old));
    return problems;
  }
  if (im.rest.watches()) im.forces.markWind(wind.id, im.state.position, im.rest.disturbed());
  im.forces.setWind(wind);
  if (im.rest.watches()) im.forces.markWind(wind.id, im.state.position, im.rest.disturbed());
  return problems;
}

bool Simulator::removeWind(const std::string& id) {
  if (impl_->rest.watches()) impl_->forces.markWind(id, impl_->state.position, impl_->rest.disturbed());
  return impl_->forces.removeWind(id);
}

void Simulator::clearWinds() {
  if (!impl_->forces.winds().empty()) impl_->rest.disturbAll();
  impl_->forces.clearWinds();
}

const std::vector<WindParams>& Simulator::winds() const { return impl_->forces.winds(); }

std::vector<Problem> Simulator::setDrag(const DragParams& drag) {
  Impl& im = *impl_;
  std::vector<Problem> problems = validate(drag, im.scene.cloth, "drag");
  if (!problems.empty()) return problems;
  const DragParams* const old = findById(im.forces.drags(), drag.id);
  const double now = im.statistics.time;
  if (old != nullptr && actsAt(*old, now) && actsAt(drag, now) && sameWhileItActs(*old, drag)) {
    im.forces.setDrag(asItGoesOn(drag, *old));
    return problems;
  }
  im.forces.markDrag(drag.id, im.rest.disturbed());
  im.forces.setDrag(drag);
  im.forces.markDrag(drag.id, im.rest.disturbed());
  return problems;
}

bool Simulator::removeDrag(const std::string& id) {
  impl_->forces.markDrag(id, impl_->rest.disturbed());
  return impl_->forces.removeDrag(id);
}

void Simulator::clearDrags() {
  for (const DragParams& drag : impl_->forces.drags()) impl_->forces.markDrag(drag.id, impl_->rest.disturbed());
  impl_->forces.clearDrags();
}

std::vector<Problem> Simulator::setGravity(const Vec3& gravity) {
  const Range range = anywhere();
  const bool good = range.contains(gravity.x()) && range.contains(gravity.y()) && range.contains(gravity.z());
  if (!good) return {{"gravity", "must be 3 times " + range.text()}};
  Impl& im = *impl_;
  if (gravity == im.scene.gravity) return {};
  im.scene.gravity = gravity;
  im.forces.takeGravity();
  im.most_energy.reset();
  im.control.takeGravity(im.pattern, gravity);
  im.plain_control.takeGravity(im.pattern, gravity);
  im.setRestLimits();
  im.rest.disturbAll();
  return {};
}

std::vector<Problem> Simulator::setAir(const AirParams& air) {
  std::vector<Problem> problems = validate(air, "air");
  if (!problems.empty()) return problems;
  impl_->scene.air = air;
  impl_->forces.takeAir();
  impl_->setRestLimits();
  impl_->rest.disturbAll();
  return problems;
}
const std::vector<DragParams>& Simulator::drags() const { return impl_->forces.drags(); }

bool Simulator::movePin(NodeIndex node, const Vec3& target) {
  const Grid& grid = impl_->pattern.grid;
  const bool inside = node.row >= 0 && node.row < grid.rows && node.column >= 0 && node.column < grid.columns;
  if (!inside || !impl_->pattern.isPinned(node) || !(target.cwiseAbs().maxCoeff() <= kLargest) || !target.allFinite()) return false;
  const std::size_t at = grid.index(node);
  for (Impl::PinMove& move : impl_->pin_moves) {
    if (move.node == at) {
      move.target = target;
      return true;
    }
  }
  impl_->pin_moves.push_back({at, target, false});
  return true;
}

int Simulator::obstacleCount() const { return impl_->obstacles.count(); }
void Simulator::setObstaclePose(int index, const Pose& pose, bool jump) {
  impl_->obstacles.setPose(index, pose, jump);
  if (jump) ++impl_->revision;
}
void Simulator::setObstaclePresent(int index, bool present) {
  if (present == impl_->obstacles.present(index)) return;
  impl_->obstacles.setPresent(index, present);
  ++impl_->revision;
}
bool Simulator::obstaclePresent(int index) const { return impl_->obstacles.present(index); }
const Pose& Simulator::obstaclePose(int index) const { return impl_->obstacles.pose(index); }
const ObstacleShape& Simulator::obstacleShape(int index) const { return impl_->obstacles.shape(index); }

void Simulator::copyFineMesh(FineMesh& out) const {
  impl_->surface.build(impl_->state.position, impl_->obstacles, impl_->scene.contact.thickness, out);
}
const FineMeshTopology& Simulator::fineMeshTopology() const { return impl_->surface.topology(); }

const Statistics& Simulator::statistics() const { return impl_->statistics; }

Energy Simulator::energy() const {
  return impl_->energy();
}

void Simulator::countWork(bool counted) {
  impl_->counts_work = counted;
  impl_->ledger.restore({});
}

Work Simulator::work() const { return impl_->ledger.work(); }

std::int64_t Simulator::selfCrossings() const {
  return countSelfCrossings(impl_->pattern.grid, impl_->state.position);
}

Piercings Simulator::piercings(int obstacle, double depth_tolerance) const {
  const ObstacleSet& obstacles = impl_->obstacles;
  if (!obstacles.present(obstacle)) return {};
  return countPiercings(obstacles.shape(obstacle), Transform(obstacles.reached(obstacle)), impl_->pattern.grid,
                        impl_->state.position, depth_tolerance);
}

Piercings Simulator::finePiercings(int obstacle, double depth_tolerance) const {
  const ObstacleSet& obstacles = impl_->obstacles;
  if (!obstacles.present(obstacle)) return {};
  FineMesh mesh;
  copyFineMesh(mesh);
  return countPiercings(obstacles.shape(obstacle), Transform(obstacles.reached(obstacle)), mesh.positions,
                        fineMeshTopology().triangles, depth_tolerance);
}

ContactWrench Simulator::contactWrench(int obstacle) const { return impl_->contact.wrench(obstacle); }

std::uint64_t Simulator::revision() const { return impl_->revision; }

std::uint64_t Simulator::stateHash() const {
  const Grid& grid = impl_->pattern.grid;
  Fnv1a bits;
  for (int i = 0; i < grid.rows; ++i) {
    for (int j = 0; j < grid.columns; ++j) {
      const std::size_t n = grid.index(i, j);
      for (const Field3* field : {&impl_->state.position, &impl_->state.velocity}) {
        for (const Field* axis : {&field->x, &field->y, &field->z}) bits.addBytes(&(*axis)[n], sizeof(double));
      }
    }
  }
  return bits.hash;
}

}  // namespace curtain
