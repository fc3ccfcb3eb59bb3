// SPDX-License-Identifier: BSD-3-Clause
#include "curtain_sim/simulator.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>

#include "contact/obstacle_contact.h"
#include "simulator/error_estimate.h"
#include "simulator/fine_surface.h"
#include "simulator/force_field.h"
#include "simulator/self_crossings.h"
#include "solver/composition.h"
#include "solver/exact_solver.h"
#include "solver/paper_solver.h"
#include "solver/step_control.h"

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

std::uint64_t hashBits(std::uint64_t hash, double value) {
  unsigned char bytes[sizeof value];
  std::memcpy(bytes, &value, sizeof value);
  for (const unsigned char byte : bytes) hash = (hash ^ byte) * 1099511628211ULL;  // FNV-1a
  return hash;
}

}  // namespace

struct Simulator::Impl {
  Impl(const Scene& given, const MeshResolver& resolve)
      : scene(judged(given)),
        pattern(makePattern(scene)),
        initial(makeInitialState(scene, pattern)),
        state(initial),
        forces(scene, pattern),
        obstacles(scene, resolve),
        contact(pattern, scene.contact, obstacles),
        workers(threadsFor(scene.solver.threads, pattern.grid.nodeCount())),
        exact(pattern, scene.solver.stretch_tolerance, scene.solver.max_sweeps, workers),
        paper(pattern),
        control(scene.solver, pattern, scene.gravity),
        surface(scene.cloth, pattern) {
    velocities.assign(pattern.grid.size(), 0.0);
    before.state = initial;
    exact.save(before.memory);
    if (scene.solver.position_tolerance > 0.0 && ErrorEstimate::knows(scene.solver.method)) {
      const int order = scene.solver.method == Method::kLeapfrog4 ? 4 : 2;
      estimate = std::make_unique<ErrorEstimate>(pattern, 1.0 / scene.solver.frame_rate, scene.solver.position_tolerance, order);
      companion = rehearsal = {initial, before.memory, 0, false, false};
    }
  }

  void reset();
  void step();
  void makeFrame();
  bool makeEvenSubstep(const SubstepPlan& plan, double done, int divisions);
  bool makeEvenFrame(int substeps);
  void rehearse();
  void moveCompanion();
  void synchronise();
  double makeSubstep(double done);
  bool makeComposed(const SubstepPlan& plan, double done);
  SubstepOutcome attempt(const SubstepPlan& plan, double done);
  void measure();
  const Field3& currentVelocities();

  const Scene scene;
  const ClothPattern pattern;
  const ClothState initial;
  ClothState state;
  ForceField forces;
  ObstacleSet obstacles;
  ObstacleContact contact;
  Workers workers;
  ExactSolver exact;
  PaperSolver paper;
  StepControl control;
  FineSurface surface;
  // What a substep of several stages goes back to.
  struct {
    ClothState state;
    ExactSolver::Memory memory;
  } before;
  // With a position tolerance: the estimate, the motion's companion, and what to go back to.
  struct Held {
    ClothState state;
    ExactSolver::Memory memory;
    int substeps = 0;
    bool lost = false;  // a substep failed
    bool in_finer_steps = false;
  };
  std::unique_ptr<ErrorEstimate> estimate;
  Held companion, rehearsal;
  Statistics statistics;
  StageClock clock;
  std::int64_t frame = 0;
  double contact_scale = 0.0;  // h * kick of the last substep [s^2]; 0 = none yet
  Field3 velocities;           // at the time of the positions
  bool velocities_fresh = false;
};

void Simulator::Impl::reset() {
  state = initial;
  if (estimate != nullptr) estimate->reset();
  forces.reset();
  obstacles.reset();
  contact.forget();
  exact.reset();
  control.reset();
  clock.reset();
  statistics = Statistics();
  frame = 0;
  contact_scale = 0.0;
  velocities_fresh = false;
}

// One attempt at a substep from `done` seconds into the frame.
SubstepOutcome Simulator::Impl::attempt(const SubstepPlan& plan, double done) {
  const double frame_length = 1.0 / scene.solver.frame_rate;
  PositionConstraints* const constraints = obstacles.anyPresent() ? &contact : nullptr;
  clock.start();
  if (constraints != nullptr) obstacles.setSubstep(done / frame_length, (done + plan.h) / frame_length);
  const NodeForces& now = forces.evaluate(state, statistics.time + done, plan.h);
  clock.lap(Stage::kForces);
  const SubstepOutcome outcome = scene.solver.method == Method::kPaper
                                     ? paper.substep(now, plan.h, constraints, state, clock)
                                     : exact.substep(plan, now, constraints, state, clock);
  statistics.sweeps += outcome.sweeps;
  statistics.sweeps_last += outcome.sweeps;
  return outcome;
}

// A substep of five stages. False, and nothing changed: a string pulls or something touches, which forbids to go back in
// time.
bool Simulator::Impl::makeComposed(const SubstepPlan& plan, double done) {
  if (exact.weftPulls()) return false;
  exact.save(before.memory);
  before.state = state;
  double at = done;
  for (const double gamma : kStages) {
    SubstepPlan stage = plan;
    stage.h = gamma * plan.h;
    stage.must_accept = false;
    const SubstepOutcome outcome = attempt(stage, at);
    if (!outcome.accepted || exact.weftPulls() || (obstacles.anyPresent() && contact.any())) {
      state = before.state;
      exact.restore(before.memory);
      return false;
    }
    control.accepted(stage, outcome);
    contact_scale = outcome.scale;
    at += stage.h;
  }
  return true;
}

// One substep from `done` seconds into the frame. Returns how far it came: 0 when it was rejected.
double Simulator::Impl::makeSubstep(double done) {
  const double frame_length = 1.0 / scene.solver.frame_rate;
  SubstepPlan plan = control.next(frame_length - done, exact);
  if (scene.solver.method == Method::kLeapfrog4 && plan.scheme == Scheme::kLeapfrog) {
    if (makeComposed(plan, done)) {
      ++statistics.substeps;
      ++statistics.substeps_last;
      return plan.h;
    }
    plan.h /= static_cast<double>(kStages.size());
  }
  const SubstepOutcome outcome = attempt(plan, done);
  if (!outcome.accepted) {
    ++statistics.rejected;
    control.rejected(plan);
    if (!plan.must_accept) return 0.0;
    // Not even finite: forces beyond all numbers. The cloth stays where it is, at rest, until they are over.
    state.velocity.assign(pattern.grid.size(), 0.0);
    state.velocity_age = 0.0;
    exact.reset();
    ++statistics.stops;
    return plan.h;
  }
  control.accepted(plan, outcome);
  contact_scale = outcome.scale;
  ++statistics.substeps;
  ++statistics.substeps_last;
  if (plan.scheme == Scheme::kImplicit && scene.solver.method != Method::kImplicit) ++statistics.implicit;
  if (!outcome.settled) ++statistics.unsettled;
  contact.afterSubstep(outcome.settled);
  return plan.h;
}

void Simulator::Impl::makeFrame() {
  const double frame_length = 1.0 / scene.solver.frame_rate;
  double done = 0.0;
  while (frame_length - done > 1e-9 * frame_length) done += makeSubstep(done);
}

// A substep of the motion that is only compared with: what fails is divided, up to `divisions` times.
bool Simulator::Impl::makeEvenSubstep(const SubstepPlan& plan, double done, int divisions) {
  if (attempt(plan, done).accepted) return true;
  if (divisions == 0) return false;
  SubstepPlan half = plan;
  half.h = 0.5 * plan.h;
  return makeEvenSubstep(half, done, divisions - 1) && makeEvenSubstep(half, done + half.h, divisions - 1);
}

// A frame in so many equal leapfrog (or composed) substeps. False: one of them failed.
bool Simulator::Impl::makeEvenFrame(int substeps) {
  constexpr int kDivisions = 5;
  SubstepPlan plan;
  plan.h = 1.0 / scene.solver.frame_rate / substeps;
  if (scene.solver.method == Method::kAuto) plan.most_phase = control.stablePhase();
  plan.precise = scene.solver.method == Method::kLeapfrog4;
  for (int k = 0; k < substeps; ++k) {
    const double done = k * plan.h;
    if (scene.solver.method == Method::kLeapfrog4 && makeComposed(plan, done)) continue;
    const int parts = scene.solver.method == Method::kLeapfrog4 ? static_cast<int>(kStages.size()) : 1;
    SubstepPlan part = plan;
    part.h = plan.h / parts;
    for (int p = 0; p < parts; ++p) {
      if (!makeEvenSubstep(part, done + p * part.h, kDivisions)) return false;
    }
  }
  return true;
}

// Velocities at the time of the positions. A step of another length than the last one's would else start from a velocity
// half the difference off.
void Simulator::Impl::synchronise() {
  if (state.velocity_age == 0.0) return;
  exact.currentVelocities(state, forces.last(), obstacles.anyPresent() ? &contact : nullptr, velocities);
  state.velocity = velocities;
  state.velocity_age = 0.0;
  velocities_fresh = false;
}

// Before the motion begins: some frames of it, twice, to find the substeps it needs.
void Simulator::Impl::rehearse() {
  const Statistics before_all = statistics;
  const StageClock stages = clock;
  const double omega_step = control.longestStableStep();
  const int substeps = std::max(1, static_cast<int>(std::ceil(1.0 / (scene.solver.frame_rate * omega_step))));
  const auto play = [&](int count) {
    rehearsal.state = state;
    exact.save(rehearsal.memory);
    bool made = true;
    for (int f = 0; f < estimate->rehearsalFrames() && made; ++f) {
      made = makeEvenFrame(count);
      statistics.time += 1.0 / scene.solver.frame_rate;
    }
    statistics = before_all;
    return made;
  };
  const auto goBack = [&] {
    state = rehearsal.state;
    exact.restore(rehearsal.memory);
  };
  const bool coarse_made = play(substeps);
  companion.state.position = state.position;
  goBack();
  const bool fine_made = play(2 * substeps);
  if (coarse_made && fine_made) estimate->rehearsed(companion.state.position, substeps, state.position, 2 * substeps);
  goBack();
  clock = stages;
}

// Moves the companion by the coming frame. It goes first, so that forces and contacts stay those of the motion.
void Simulator::Impl::moveCompanion() {
  if (estimate->companionStarts()) {
    const int least = static_cast<int>(std::ceil(1.0 / (scene.solver.frame_rate * control.longestStableStep())));
    estimate->atLeast(least);
    companion.in_finer_steps = !estimate->halfWillDo(least);
  }
  if (estimate->companionStarts() || companion.lost) {
    synchronise();
    companion.state = state;
    exact.save(companion.memory);
  }
  const Statistics published = statistics;
  const StageClock stages = clock;
  rehearsal.state = state;
  exact.save(rehearsal.memory);
  std::swap(state, companion.state);
  exact.restore(companion.memory);
  const int substeps = estimate->companionSubsteps(companion.in_finer_steps);
  if (substeps != companion.substeps) synchronise();
  companion.substeps = substeps;
  companion.lost = !makeEvenFrame(substeps);
  companion.in_finer_steps = companion.in_finer_steps || companion.lost;
  exact.save(companion.memory);
  std::swap(state, companion.state);
  exact.restore(rehearsal.memory);
  statistics = published;
  clock = stages;
}

void Simulator::Impl::step() {
  const auto begin = std::chrono::steady_clock::now();
  const double frame_length = 1.0 / scene.solver.frame_rate;
  statistics.time = static_cast<double>(frame) * frame_length;
  obstacles.beginFrame(static_cast<double>(frame + 1) * frame_length);
  if (estimate != nullptr) {
    clock.start();
    if (frame == 0) rehearse();
    if (estimate->companionMoves()) moveCompanion();
    if (control.askFor(estimate->substeps())) synchronise();
    clock.lap(Stage::kEstimate);
  }
  statistics.substeps_last = 0;
  statistics.sweeps_last = 0;
  velocities_fresh = false;
  makeFrame();
  if (estimate != nullptr) {
    const bool compares = estimate->companionMoves() && !companion.lost;
    estimate->frameMade(state.position, statistics.substeps_last, compares ? &companion.state.position : nullptr,
                        companion.substeps);
    statistics.position_error = estimate->perSecond();
    clock.lap(Stage::kEstimate);
  }
  obstacles.endFrame();
  ++frame;
  statistics.frames = frame;
  statistics.time = static_cast<double>(frame) * frame_length;
  measure();
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  statistics.step_seconds = seconds;
  statistics.step_seconds_max = std::max(statistics.step_seconds_max, seconds);
  statistics.step_seconds_sum += seconds;
  statistics.stage_seconds = clock.seconds();
}

void Simulator::Impl::measure() {
  clock.start();
  Statistics& s = statistics;
  const Stretch warp = warpStretch(pattern, state.position);
  s.warp_stretch = warp.longer;
  s.warp_compression = warp.shorter;
  s.weft_stretch = weftStretch(pattern, state.position);
  s.warp_stretch_max = std::max(s.warp_stretch_max, s.warp_stretch);
  s.weft_stretch_max = std::max(s.weft_stretch_max, s.weft_stretch);
  s.warp_compression_max = std::max(s.warp_compression_max, s.warp_compression);
  const bool near = obstacles.anyPresent() && contact.any();
  s.contacts = near ? contact.contactCount() : 0;
  s.contacts_max = std::max(s.contacts_max, s.contacts);
  if (near) s.penetration_max = std::max(s.penetration_max, contact.deepestPenetration(state.position));
  const double sum = s.warp_stretch + s.warp_compression + s.weft_stretch;
  if (!std::isfinite(sum)) s.finite = false;
  clock.lap(Stage::kFinish);
}

const Field3& Simulator::Impl::currentVelocities() {
  if (velocities_fresh) return velocities;
  if (frame == 0 || state.velocity_age == 0.0) {
    velocities = state.velocity;
  } else {
    exact.currentVelocities(state, forces.last(), obstacles.anyPresent() ? &contact : nullptr, velocities);
  }
  velocities_fresh = true;
  return velocities;
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
  const Impl& im = *impl_;
  const Grid& grid = im.pattern.grid;
  Field3 total = *im.forces.last().force;
  if (im.forces.last().has_damping) {
    const Field3& velocity = im.state.velocity;  // that substep's own
    for (std::size_t n = 0; n < grid.size(); ++n) total.add(n, -im.forces.last().damping[n] * velocity.at(n));
  }
  if (im.contact_scale > 0.0 && im.obstacles.anyPresent()) {
    im.contact.addForces(im.exact.inverseInertia(), im.contact_scale, total);
  }
  copyField(grid, total, out);
}

Vec3 Simulator::position(NodeIndex node) const { return impl_->state.position.at(impl_->pattern.grid.index(node)); }
double Simulator::mass(NodeIndex node) const { return impl_->pattern.mass[impl_->pattern.grid.index(node)]; }
bool Simulator::pinned(NodeIndex node) const { return impl_->pattern.isPinned(node); }
NodeIndex Simulator::nearestNode(const Vec3& point) const {
  return curtain::nearestNode(impl_->pattern.grid, impl_->state.position, point);
}

std::vector<Problem> Simulator::setWind(const WindParams& wind) { return impl_->forces.setWind(wind); }
bool Simulator::removeWind(const std::string& id) { return impl_->forces.removeWind(id); }
void Simulator::clearWinds() { impl_->forces.clearWinds(); }
const std::vector<WindParams>& Simulator::winds() const { return impl_->forces.winds(); }

std::vector<Problem> Simulator::setDrag(const DragParams& drag) { return impl_->forces.setDrag(drag); }
bool Simulator::removeDrag(const std::string& id) { return impl_->forces.removeDrag(id); }
void Simulator::clearDrags() { impl_->forces.clearDrags(); }
const std::vector<DragParams>& Simulator::drags() const { return impl_->forces.drags(); }

int Simulator::obstacleCount() const { return impl_->obstacles.count(); }
void Simulator::setObstaclePose(int index, const Pose& pose, bool jump) { impl_->obstacles.setPose(index, pose, jump); }
void Simulator::setObstaclePresent(int index, bool present) { impl_->obstacles.setPresent(index, present); }
bool Simulator::obstaclePresent(int index) const { return impl_->obstacles.present(index); }
const Pose& Simulator::obstaclePose(int index) const { return impl_->obstacles.pose(index); }
const ObstacleShape& Simulator::obstacleShape(int index) const { return impl_->obstacles.shape(index); }

void Simulator::copyFineMesh(FineMesh& out) const {
  impl_->surface.build(impl_->state.position, impl_->obstacles, impl_->scene.contact.thickness, out);
}
const FineMeshTopology& Simulator::fineMeshTopology() const { return impl_->surface.topology(); }

const Statistics& Simulator::statistics() const { return impl_->statistics; }

Energy Simulator::energy() const {
  const Impl& im = *impl_;
  const Field3& velocity = impl_->currentVelocities();
  Energy energy;
  for (std::size_t n = 0; n < im.pattern.grid.size(); ++n) {
    energy.kinetic += 0.5 * im.pattern.mass[n] * velocity.at(n).squaredNorm();
    energy.potential -= im.pattern.mass[n] * im.scene.gravity.dot(im.state.position.at(n));
  }
  return energy;
}

std::int64_t Simulator::selfCrossings() const {
  return countSelfCrossings(impl_->pattern.grid, impl_->state.position);
}

std::uint64_t Simulator::stateHash() const {
  const Grid& grid = impl_->pattern.grid;
  std::uint64_t hash = 14695981039346656037ULL;
  for (int i = 0; i < grid.rows; ++i) {
    for (int j = 0; j < grid.columns; ++j) {
      const std::size_t n = grid.index(i, j);
      for (const Field3* field : {&impl_->state.position, &impl_->state.velocity}) {
        hash = hashBits(hashBits(hashBits(hash, field->x[n]), field->y[n]), field->z[n]);
      }
    }
  }
  return hash;
}

}  // namespace curtain
