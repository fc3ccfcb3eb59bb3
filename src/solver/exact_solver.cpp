// SPDX-License-Identifier: BSD-3-Clause
#include "solver/exact_solver.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace curtain {
namespace {

// The tolerance inside: what the last half-sweep stirs up again must still fit below the user's.
constexpr double kInnerTolerance = 0.5;
// Share of the tolerance below which the weft is not touched in a substep's first sweep. Far smaller than 1: a link left
// to drift through the tolerance and then pulled back at once would be kicked.
constexpr double kFirstSweepShare = 1e-4;
// Newton converges quadratically: an iteration that starts this close ends near the square of it, times a factor that
// grows with the column's height.
constexpr double kNewtonStop = 1e-3;
// In later sweeps the next one looks again, so a start this close is left at that.
constexpr double kNewtonStopLater = 1e-2;
// For what is left to be rounding.
constexpr double kPreciseStop = 1e-7;
constexpr int kNewtonIterations = 12;
// Share of the tolerance below which a block of columns is not solved again in a later sweep.
constexpr double kLeaveAlone = 0.1;
// A relative violation beyond this is a step that failed, not one that converges slowly.
constexpr double kDiverged = 4.0;
constexpr double kInfinite = std::numeric_limits<double>::infinity();
// Conjugate gradients go on until the residual is a share of the tolerance, but at most to a share of itself: past that the
// first-order picture they solve in is no longer true. Where directions must be followed what the last digits ask for throws
// nodes about: measured on sheets hung by two corners, 0.03 rejects six times as many substeps.
constexpr double kReductionShare = 0.3;
constexpr double kLeastReduction = 0.05;
constexpr double kFollowReduction = 0.3;
constexpr double kMostReduction = 0.5;
constexpr int kGradientIterations = 12;
// A sweep that moves a node by more than this share of a link at once is cut back to it [1].
constexpr double kLargestMove = 0.1;
constexpr double kWatchMoves = 1e-3;  // relative violation below which no solve moves a node too far
// Friction takes turns with the solve, for so many sweeps: what sticks under load converges over the substeps, its
// multipliers carry over. And what it may still move in a substep's last sweep, over the tolerance of contact.
constexpr int kRubSweeps = 3;
constexpr double kRubShare = 4.0;
// What is left over becomes motion. Cloth that lies on something has little other motion, so there a share of the tolerance
// is aimed at for the first sweeps: it moves by 0.3 mm/s instead of 0.8 (RMS), for a fifth more sweeps.
constexpr double kStrictShare = 0.2;
constexpr int kStrictSweeps = 6;
// Where strings pull, in short substeps, what a link may lack is more than its weight moves it by, and a flat net makes ten
// times that of it across the strings: it would never come to rest. So this share of the way of its weight is aimed at, but
// not less than that share of the tolerance.
constexpr double kShareOfWeight = 0.3;
constexpr double kLeastShare = 0.01;
// The same in the last resort, whose long substeps would leave more. 1: taut sheets never come to rest; 0.01: rows drawn straight are
// lifted by what they may sag, at no expense.
constexpr double kLastResortShare = 0.1;
// Sweeps that must bring at least this improvement, or the iteration has stalled.
constexpr int kStallWindow = 8;
constexpr double kStallFactor = 0.8;
// With contact, whose rows are damped: a sweep gains less there.
constexpr int kContactStallWindow = 16;
constexpr double kContactStallFactor = 0.9;
// Levenberg-Marquardt term of the weft's solve, over the diagonal: in proportion to the residual, so that it vanishes as
// the solve ends. Constant, it leaves combinations that hardly move anything to creep by a few percent a sweep.
constexpr double kDampingPerResidual = 0.05;
constexpr double kLargestDamping = 0.1;
// In the last resort, whose sweeps must make the sum of squares smaller: a step a thousand times shorter than Jacobi's that does not has
// nothing left to gain.
constexpr double kMostDamping = 1e3;
constexpr double kPoorSweep = 0.8;
// In contact damping itself makes sweeps slow: there only one that has gone further off is poor.
constexpr double kPoorTouchingSweep = 1.0;
constexpr double kMostCaution = 4096.0;
constexpr double kMoreCaution = 8.0;
constexpr double kLessCaution = 2.0;
// bdf2 is stable while steps grow by less than 1 + sqrt(2) at once (Grigorieff 1983); after a longer one it begins anew.
constexpr double kMostGrowth = 2.0;
// How much further than in even cloth a correction of one rod may turn another: short rods by what moves long ones, light nodes
// by what heavy ones resist. Nodes at the border have a half of the others' mass, at corners a quarter.
constexpr double kMassesOfEvenCloth = 4.0;
double unevenness(const ClothPattern& pattern) {
  const Grid& grid = pattern.grid;
  double shortest = std::numeric_limits<double>::infinity(), longest = 0.0;
  double lightest = shortest, heaviest = 0.0;
  for (int i = 1; i < grid.rows; ++i) {
    for (int j = 0; j < grid.columns; ++j) {
      const std::size_t n = grid.index(i, j);
      shortest = std::min(shortest, pattern.warp_rest[n]);
      longest = std::max(longest, pattern.warp_rest[n]);
      lightest = std::min(lightest, pattern.mass[n]);
      heaviest = std::max(heaviest, pattern.mass[n]);
    }
  }
  return longest / shortest * std::max(1.0, heaviest / (kMassesOfEvenCloth * lightest));
}

// Between the shortest and the longest weft link of the top row.
double middleRest(const ClothPattern& pattern) {
  const auto first = pattern.weft_rest.begin() + (pattern.grid.closed ? 0 : 1);
  const auto [shortest, longest] = std::minmax_element(first, pattern.weft_rest.begin() + pattern.grid.columns);
  return 0.5 * (*shortest + *longest);
}

}  // namespace

ExactSolver::ExactSolver(const ClothPattern& pattern, double stretch_tolerance, int max_sweeps, const Workers& workers)
    : pattern_(pattern),
      free_(std::none_of(pattern.pinned.begin(), pattern.pinned.end(), [](std::uint8_t pin) { return pin != 0; })),
      workers_(workers),
      stretch_tolerance_(stretch_tolerance),
      tolerance_(kInnerTolerance * stretch_tolerance),
      contact_tolerance_(kInnerTolerance * stretch_tolerance * shortestLink(pattern)),
      smallest_rest_(shortestLink(pattern)),
      max_sweeps_(max_sweeps),
      sure_stop_(std::sqrt(tolerance_) / (pattern.grid.rows * unevenness(pattern))),
      inertia_(pattern),
      held_(pattern),
      laid_down_(static_cast<std::size_t>(warpBlockCount(pattern.grid)), 0.0),
      skipped_before_(laid_down_.size(), 0),
      net_(pattern, workers),
      middle_rest_(middleRest(pattern)),
      last_resort_(pattern) {
  const std::size_t size = pattern.grid.size();
  const std::size_t links = size + static_cast<std::size_t>(pattern.grid.stride);
  scratch_.assign(pattern.grid);
  warp_.assign(pattern.grid);
  weft_.assign(pattern.grid);
  weft_.most_give = tolerance_;  // with as much for what the solve leaves it is the user's tolerance
  last_warp_.assign(links, 0.0);
  last_weft_.assign(links, 0.0);
  for (Field* field : {&violation_, &active_, &change_}) field->assign(size, 0.0);
  free_per_square_.assign(size, 0.0);
  freeWeft(pattern, pattern.inverse_mass, free_per_square_);
  next_.assign(size, 0.0);
  no_force_.assign(size, 0.0);
  best_.position.assign(size, 0.0);
  best_.warp.assign(links, 0.0);
  best_.weft.assign(links, 0.0);
  for (Field3* field : {&base_.position, &base_.velocity, &older_position_, &older_velocity_}) field->assign(size, 0.0);
  block_begun_.resize(static_cast<std::size_t>(warpBlockCount(pattern.grid)));
  block_motion_.resize(block_begun_.size());
  block_progress_.resize(static_cast<std::size_t>(warpBlockCount(pattern.grid)));
  row_worst_.resize(static_cast<std::size_t>((pattern.grid.rows + kRowsAtOnce - 1) / kRowsAtOnce));
}

void ExactSolver::reset() noexcept {
  std::fill(last_warp_.begin(), last_warp_.end(), 0.0);
  std::fill(last_weft_.begin(), last_weft_.end(), 0.0);
  std::fill(weft_.multiplier.begin(), weft_.multiplier.end(), 0.0);
  inertia_.forget();
  weft_pulls_ = false;
  older_h_ = 0.0;
  single_steps_ = 0;
  net_.reset();
  scratch_.assign(pattern_.grid);
}

void ExactSolver::save(Memory& memory) const {
  memory.warp = last_warp_;
  memory.weft = last_weft_;
  memory.older_position = older_position_;
  memory.older_velocity = older_velocity_;
  memory.tensions = inertia_.tensions();
  memory.older_h = older_h_;
  memory.single_steps = single_steps_;
  memory.weft_pulls = weft_pulls_;
}

void ExactSolver::restore(const Memory& memory) {
  last_warp_ = memory.warp;
  last_weft_ = memory.weft;
  older_position_ = memory.older_position;
  older_velocity_ = memory.older_velocity;
  inertia_.tensions() = memory.tensions;
  older_h_ = memory.older_h;
  single_steps_ = memory.single_steps;
  weft_pulls_ = memory.weft_pulls;
  if (!weft_pulls_) std::fill(weft_.multiplier.begin(), weft_.multiplier.end(), 0.0);  // as begin() relies on
}

// Where the step starts from: leapfrog and implicit, the state itself; bdf2, what its formula makes of the last two
// (variable steps: ratio r = h / h_before; y' = (1+r)^2/(1+2r) y - r^2/(1+2r) y_before + (1+r)/(1+2r) h f).
const ClothState& ExactSolver::setBase(Scheme scheme, double h, const ClothState& state, double& step) noexcept {
  step = h;
  if (scheme != Scheme::kBdf2 || older_h_ == 0.0 || h > kMostGrowth * older_h_) return state;
  const double r = h / older_h_;
  const double change = r * r / (1.0 + 2.0 * r);  // (1+r)^2/(1+2r) is 1 more: what is at rest stays there to the bit
  step = (1.0 + r) / (1.0 + 2.0 * r) * h;
  const auto combine = [&](const Field& y, const Field& older, Field& out) {
    for (std::size_t n = 0; n < y.size(); ++n) out[n] = y[n] + change * (y[n] - older[n]);
  };
  combine(state.position.x, older_position_.x, base_.position.x);
  combine(state.position.y, older_position_.y, base_.position.y);
  combine(state.position.z, older_position_.z, base_.position.z);
  combine(state.velocity.x, older_velocity_.x, base_.velocity.x);
  combine(state.velocity.y, older_velocity_.y, base_.velocity.y);
  combine(state.velocity.z, older_velocity_.z, base_.velocity.z);
  for (std::size_t n = 0; n < pattern_.grid.size(); ++n) {
    if (inertia_.masses()[n] > 0.0) continue;  // pins go where they are told to, whatever they did before
    base_.position.set(n, state.position.at(n) + (h - step) * state.velocity.at(n));
    base_.velocity.set(n, state.velocity.at(n));
  }
  return base_;
}

// Predicts and starts the multipliers where the last substep left them (returns what they change by with the step). Not when forces follow the directions: its
// iteration blows up when the old tensions act along the new directions of rods that have turned much since.
double ExactSolver::begin(const SubstepPlan& plan, const SubstepStart& start, double scale) noexcept {
  const bool warm = plan.scheme == Scheme::kLeapfrog && !plan.last_resort && inertia_.tensions().scale != 0.0;
  const double ratio = warm ? scale / inertia_.tensions().scale : 0.0;
  const LineSolve warp{pattern_, inertia_.inverse(), warp_, next_, held_.movingSpan()};
  const LineSolve weft{pattern_, inertia_.inverse(), weft_, next_, held_.movingSpan()};
  directions_set_ = false;
  newton_begun_ = plan.scheme == Scheme::kLeapfrog && !weft_pulls_;
  forEachBlock([&](int block) {
    if (newton_begun_) {
      const LineOutcome outcome = warpBeginNewton(start, warp, last_warp_, ratio, scratch_, block);
      block_begun_[static_cast<std::size_t>(block)] = outcome;
      warpEndNewton(warp, scratch_, block);
    } else {
      warpBegin(start, warp, last_warp_, ratio, block);
    }
  });
  if (!weft_pulls_) return ratio;  // all multipliers are zero, in weft_ too
  const std::size_t size = pattern_.grid.size();
  for (std::size_t n = 0; n < size; ++n) weft_.multiplier[n] = ratio * last_weft_[n];
  if (ratio == 0.0) return ratio;
  directions_set_ = true;
  worstOfRows([&](int i) {
    setWeftDirections(pattern_.grid, i, held_.movingSpan(), start.state.position, weft_.direction);
    pullWeft(weft, i, weft_.multiplier);
    return 0.0;
  });
  return ratio;
}

// Newton on one block of columns until an iteration starts with a residual of at most stop. A block whose rods are within
// leave_alone already is not touched. begun: begin() has made the first iteration.
ExactSolver::WarpProgress ExactSolver::solveBlock(bool follow, const LineSolve& warp, int block, double stop,
                                                  double leave_alone, double most_residual, bool begun) noexcept {
  WarpProgress progress;
  if (leave_alone > 0.0) {
    const double residual = warpResidual(warp, block);
    progress.first_residual = residual;
    if (residual <= leave_alone) return progress;
  }
  for (int iteration = 0; iteration < kNewtonIterations; ++iteration) {
    if (follow) setWarpDirections(pattern_.grid, block, next_, warp_.direction);
    const LineOutcome outcome =
        begun && iteration == 0 ? block_begun_[static_cast<std::size_t>(block)] : warpNewton(warp, scratch_, block);
    if (iteration == 0) progress.first_residual = std::max(progress.first_residual, outcome.residual);
    if (!outcome.sound || !(outcome.residual < most_residual)) break;
    if (outcome.residual <= stop) {
      progress.last_residual = outcome.residual;
      return progress;
    }
  }
  progress.converged = false;
  return progress;
}

ExactSolver::WarpProgress ExactSolver::solveWarp(bool follow, const LineSolve& warp, double stop,
                                                 double leave_alone, double most_residual, bool begun) noexcept {
  forEachBlock([&](int block) {
    block_progress_[static_cast<std::size_t>(block)] = solveBlock(follow, warp, block, stop, leave_alone, most_residual, begun);
  });
  WarpProgress all;
  for (const WarpProgress& block : block_progress_) {
    all.converged = all.converged && block.converged;
    all.first_residual = std::max(all.first_residual, block.first_residual);
    all.last_residual = std::max(all.last_residual, block.last_residual);
  }
  return all;
}

double ExactSolver::weftResidualNow(const LineSolve& weft) noexcept {
  return worstOfRows([&](int i) { return weftResidual(weft, i); });
}

// The same where no string pulls.
double ExactSolver::slackResidual() noexcept {
  const double longest = worstOfRows([&](int i) { return weftSquare(pattern_.grid, i, held_.movingSpan(), next_, free_per_square_); });
  return longest > 1.0 ? 0.5 * (longest - 1.0) : 0.0;
}

double ExactSolver::warpResidualNow(const LineSolve& warp) noexcept {
  double worst = 0.0;
  for (int block = 0; block < warpBlockCount(pattern_.grid); ++block) {
    if (!held_.skips(block)) worst = std::max(worst, warpResidual(warp, block));
  }
  return worst;
}

bool ExactSolver::withinTolerance(const LineSolve& warp, const LineSolve& weft, double tolerance) noexcept {
  const double allowed = tolerance / kInnerTolerance;
  return warpResidualNow(warp) <= allowed && weftResidualNow(weft) <= allowed;
}

// Directions of all links are those of the positions as they are now.
void ExactSolver::followDirections() noexcept {
  forEachBlock([&](int block) { setWarpDirections(pattern_.grid, block, next_, warp_.direction); });
  setAllWeftDirections(next_);
  net_.begin(next_, inertia_.inverse(), held_.movingSpan());
}

void ExactSolver::setAllWeftDirections(const Field3& position) noexcept {
  worstOfRows([&](int i) {
    setWeftDirections(pattern_.grid, i, held_.movingSpan(), position, weft_.direction);
    return 0.0;
  });
}

// All taut links of the weft and all contacts, with the rods' answer in view. The nodes move by their part of it; the rods'
// own solve comes next.
void ExactSolver::solveNet(const LineSolve& weft, Contacts* contacts, double residual, const WeftStep& step) noexcept {
  if (!measured_) worstOfRows([&](int i) { return measureWeft(weft, i, violation_, active_); });
  net_.solve(violation_, active_, {contacts, &next_, false},
             {residual * middle_rest_, step.damping, step.enough, kGradientIterations}, change_);
  const double move = residual > kWatchMoves
                          ? std::sqrt(worstOfRows([&](int i) { return weftMoveSquared(weft, i, change_); }))
                          : 0.0;
  const double share = move > kLargestMove ? kLargestMove / move : 1.0;
  if (share != 1.0) {
    for (double& change : change_) change *= share;
  }
  worstOfRows([&](int i) {
    takeUpWeft(weft_, pattern_.grid, i, change_);
    pullWeft(weft, i, change_);
    return 0.0;
  });
  if (contacts == nullptr) return;
  net_.forEachContactChange([&](std::uint32_t index, double push, const Vec3& slide) {
    takeUpContact(inertia_.inverse(), share * push, share * slide, (*contacts)[index], next_);
  });
}

void ExactSolver::keepIterate(double residual, const Contacts* contacts) {
  best_.residual = residual;
  best_.position = next_;
  best_.warp = warp_.multiplier;
  best_.weft = weft_.multiplier;
  if (contacts != nullptr) best_.contacts = *contacts;
}

void ExactSolver::goBack(Contacts* contacts) noexcept {
  next_ = best_.position;
  warp_.multiplier = best_.warp;
  weft_.multiplier = best_.weft;
  if (contacts != nullptr) *contacts = best_.contacts;
  measured_ = false;
}

// What a sweep must make smaller: the sum of the squares of what links and contacts lack, over a link. A damped step makes it smaller if
// it is short enough, where the largest may stand on a plateau. rods_lack: of every rod, where their own solve has not converged.
double ExactSolver::meritOf(const Contacts* contacts, double rods_lack) noexcept {
  const LineSolve weft{pattern_, inertia_.inverse(), weft_, next_, held_.movingSpan()};
  if (!measured_) worstOfRows([&](int i) { return measureWeft(weft, i, violation_, active_); });
  measured_ = true;
  double sum = static_cast<double>(pattern_.grid.nodeCount()) * rods_lack * rods_lack;
  for (std::size_t n = 0; n < pattern_.grid.size(); ++n) {
    const double relative = violation_[n] * pattern_.weft_per_square[n];
    sum += relative * relative;
  }
  for (std::size_t k = 0; contacts != nullptr && k < contacts->size(); ++k) {
    const double relative = contactViolation((*contacts)[k], next_) / middle_rest_;
    sum += relative * relative;
  }
  return sum;
}

ExactSolver::Progress ExactSolver::solveConstraints(const SubstepPlan& plan, const Field3& start, double weight_way,
                                                    Contacts* contacts, StageClock& clock) noexcept {
  const LineSolve warp{pattern_, inertia_.inverse(), warp_, next_, held_.movingSpan()};
  const LineSolve weft{pattern_, inertia_.inverse(), weft_, next_, held_.movingSpan()};
  const bool touches = contacts != nullptr && !contacts->empty();
  // What the last resort leaves the far shorter steps after it would have to mend at once: by a blow.
  const double share_for_weight =
      plan.last_resort   ? kLastResortShare
      : weight_way > 0.0 ? std::clamp(kShareOfWeight * weight_way / (middle_rest_ * tolerance_), kLeastShare, 1.0)
                         : 1.0;
  Progress progress;
  bool follow = plan.scheme != Scheme::kLeapfrog || plan.last_resort;
  bool net_ready = false;
  double window_residual = std::numeric_limits<double>::infinity();
  double last_residual = window_residual;
  double touch = 0.0;
  double caution = 1.0;
  best_.residual = best_.merit = std::numeric_limits<double>::infinity();
  while (progress.sweeps < max_sweeps_) {
    const bool first = progress.sweeps == 0;
    double strict = 1.0;
    if (progress.sweeps < kStrictSweeps) {
      if (touches) strict = kStrictShare;
      if (!touches && (weft_pulls_ || directions_set_)) strict = share_for_weight;
    }
    const double tolerance = strict * tolerance_;
    const double contact_tolerance = strict * contact_tolerance_;
    const double stop = plan.precise ? kPreciseStop : first && !weft_pulls_ ? kNewtonStop : kNewtonStopLater;
    const WarpProgress rods = solveWarp(follow, warp, stop, first ? 0.0 : kLeaveAlone * tolerance,
                                        plan.last_resort ? kInfinite : kDiverged, first && newton_begun_);
    clock.lap(Stage::kWarp);
    if (!rods.converged && !plan.last_resort) return progress;
    ++progress.sweeps;
    const double rubbed =
        touches && progress.sweeps <= kRubSweeps ? rubContacts(inertia_.inverse(), *contacts, next_) : 0.0;
    touch = touches ? contactResidual(*contacts, next_) : 0.0;
    clock.lap(Stage::kContact);
    measured_ = weft_pulls_ || !first;
    const double strings = measured_ ? worstOfRows([&](int i) { return measureWeft(weft, i, violation_, active_); })
                                     : slackResidual();
    const double share = first && !plan.last_resort ? kFirstSweepShare : 1.0;
    if (rods.converged && strings <= share * tolerance && touch <= share * contact_tolerance && rubbed <= kRubShare * contact_tolerance &&
        ((rods.last_residual * inertia_.dampingSpread() <= sure_stop_ && rubbed == 0.0) ||
         warpResidualNow(warp) <= tolerance)) {
      progress.settled = true;
      clock.lap(Stage::kWeft);
      return progress;
    }
    double residual = std::max(strings, touch / middle_rest_);
    if (!std::isfinite(residual)) break;
    bool undone = false;
    if (plan.last_resort) {
      const double merit = meritOf(contacts, rods.converged ? 0.0 : warpResidualNow(warp));
      if (merit < best_.merit) {
        best_.merit = merit;
        keepIterate(residual, touches ? contacts : nullptr);
        caution = std::max(1.0, caution / kLessCaution);
      } else if (std::isfinite(best_.merit)) {
        goBack(contacts);
        residual = best_.residual;
        caution *= kMoreCaution;
        undone = true;
        if (caution * kDampingPerResidual * residual > kMostDamping) break;
      }
    } else {
      // A sweep that has not brought the links nearer went too far where hardly anything holds: the next one is damped more.
      caution = residual > (touches ? kPoorTouchingSweep : kPoorSweep) * last_residual
                    ? std::min(kMostCaution, caution * kMoreCaution)
                    : std::max(1.0, caution / kLessCaution);
    }
    last_residual = residual;
    if (undone || strings > (first && !plan.last_resort ? kFirstSweepShare : kLeaveAlone) * tolerance ||
        touch > (first && !plan.last_resort ? kFirstSweepShare : kLeaveAlone) * contact_tolerance) {
      // What the first sweep leaves is corrected along the present directions, all of it: forces along the directions at
      // the start may have no solution at all where a flat net shears, and a correction along one set of directions taken
      // back along another is a force that does work. Contact settles better along given ones.
      follow = follow || !touches;
      if (follow) {
        followDirections();
        directions_set_ = net_ready = true;
      } else if (!net_ready) {
        if (!directions_set_) setAllWeftDirections(start);
        directions_set_ = net_ready = true;
        net_.begin(start, inertia_.inverse(), held_.movingSpan());
      }
      const double least = follow ? kFollowReduction : kLeastReduction;
      solveNet(weft, contacts, residual, {std::clamp(kReductionShare * tolerance / residual, least, kMostReduction),
                                          std::min(plan.last_resort ? kMostDamping : kLargestDamping, caution * kDampingPerResidual * residual)});
    }
    clock.lap(Stage::kWeft);
    if (clock.late()) {
      progress.late = true;
      break;
    }
    if (plan.last_resort) continue;
    if (progress.sweeps % (touches ? kContactStallWindow : kStallWindow) == 0) {
      const double factor = touches ? kContactStallFactor : kStallFactor;
      const double left = std::max(rods.first_residual, residual);
      if (!(left < factor * window_residual)) break;
      window_residual = left;
    }
  }
  if (plan.last_resort && std::isfinite(best_.merit)) {
    goBack(contacts);
    if (touches) touch = contactResidual(*contacts, next_, false);
  }
  // Slower than it should, but what was asked for may be reached all the same.
  progress.settled = touch <= contact_tolerance_ && withinTolerance(warp, weft, tolerance_);
  progress.found = true;
  progress.left_over = true;
  return progress;
}

}  // namespace curtain
