// SPDX-License-Identifier: BSD-3-Clause
#include "step/step_control.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "step/constants.h"
#include "step/schemes/composition.h"

namespace curtain {
namespace {

int fixedSubsteps(const SolverParams& params) {
  if (params.substeps > 0) return params.substeps;
  if (params.method == Method::kPaper) return kPaperSubsteps;
  return params.method == Method::kImplicit ? kImplicitSubsteps : 0;
}

// Hanging free, the uppermost rod carries the column: tension T gives omega^2 = 4 T / (m l), largest of all columns.
double hangingOmega(const ClothPattern& pattern, const Vec3& gravity) {
  const Grid& grid = pattern.grid;
  double worst = 0.0;
  for (int j = 0; j < grid.columns; ++j) {
    double mass_below = 0.0;
    for (int i = grid.rows - 1; i > 0; --i) {
      mass_below += pattern.mass[grid.index(i, j)];
      worst =
          std::max(worst, 4.0 * mass_below / (pattern.mass[grid.index(i, j)] * pattern.warp_rest[grid.index(i, j)]));
    }
  }
  return std::sqrt(worst * gravity.norm());
}

}  // namespace

StepControl::StepControl(const SolverParams& params, const ClothPattern& pattern, const Vec3& gravity)
    : frame_(1.0 / params.frame_rate),
      fixed_substeps_(fixedSubsteps(params)),
      max_substeps_(std::max(params.max_substeps, kRoomBelowFixed * params.substeps)),
      method_(params.method),
      phase_share_(phaseShare(pattern)),
      initial_omega_(hangingOmega(pattern, gravity)),
      composed_(params.method == Method::kLeapfrog4),
      shortens_(params.substeps == 0 && params.method != Method::kPaper) {
  reset();
}

double StepControl::phaseShare(const ClothPattern& pattern) noexcept {
  return pattern.grid.end_rows == 0 ? 1.0 : kShareWithEnds;
}

void StepControl::reset() noexcept {
  omega_ = initial_omega_;
  turning_ = 0.0;
  last_step_ = std::numeric_limits<double>::infinity();
  scaled_step_ = 0.0;
  limit_ = frame_;
  good_ = 0;
  trust_.reset();
  surface_step_ = std::numeric_limits<double>::infinity();
}

void StepControl::setGravity(const ClothPattern& pattern, const Vec3& gravity) noexcept {
  initial_omega_ = hangingOmega(pattern, gravity);
}

// A limit from rejections stays. Without one, longer frames start unlimited.
void StepControl::setFrameLength(double length) noexcept {
  const bool was_limited = limit_ < frame_;
  limit_ = was_limited ? std::min(limit_, length) : length;
  frame_ = length;
}

void StepControl::afterPinsChanged(const Step& solver) noexcept {
  if (solver.inertia().tensions().scale != 0.0) omega_ = std::sqrt(solver.inertia().omegaSquared());
}

double StepControl::stepFromTensions(bool frame_begins, const Step& solver) noexcept {
  const double longest_stage = composed_ ? kLongestStage : 1.0;
  const double omega = std::max(omega_, std::sqrt(solver.inertia().elastic()));  // no tension may be known yet
  const double for_phase = omega > 0.0 ? phase_share_ * kPhasePerStep / (longest_stage * omega) : frame_;
  if (method_ != Method::kAuto || for_phase > kWorthScaling * frame_) return for_phase;
  // Once a frame: an impact within it is no reason for longer steps. But at its beginning no tensions may be known.
  if (frame_begins || std::isinf(scaled_step_))
    scaled_step_ = solver.inertia().stepForPhase(phase_share_ * kPhasePerStep, kMassScalingShare);
  return std::isfinite(scaled_step_) ? std::max(for_phase, scaled_step_) : for_phase;
}

// The longest share of the rest of the frame in which links turn by no more than kTurnPerStep. With steps h leapfrog
// conserves v^2 + (1 - (h omega)^2 / 4) (omega x)^2 of what oscillates, so that a longer one h' may make it swing wider
// by sqrt((4 - (h omega)^2) / (4 - (h' omega)^2)), and turn faster. It is taken only where it stays short enough if
// that comes twice. Otherwise cloth that comes to rest goes to and fro between two steps, is given energy by the
// changes, and trembles on.
double StepControl::stepForTurn(double remaining) const noexcept {
  const double longest = kTurnPerStep / turning_;
  const auto left = [this](double h) { return std::max(0.0, 4.0 - h * h * omega_ * omega_); };
  for (double substeps = std::max(1.0, std::ceil(remaining / longest - 1e-6));; ++substeps) {
    const double h = remaining / substeps;
    const bool longer = h > (1.0 + 1e-6) * last_step_;
    if (!longer || longest * left(h) >= h * left(last_step_)) return h;
  }
}

// What explicit elastic forces bear, which do not get stiffer or softer with the step.
double StepControl::stepOfElastic(bool leapfrog, const Step& solver) const noexcept {
  const double elastic = solver.inertia().elastic();
  if (!(elastic > 0.0)) return std::numeric_limits<double>::infinity();
  const double phase =
      leapfrog ? phase_share_ * kPhasePerStep / (composed_ ? kLongestStage : 1.0) : std::sqrt(kElasticBackward);
  return phase / std::sqrt(elastic);
}

// Lengthens the step when computing time is short: only for methods that stay stable, and not beyond what was rejected
// or what moving contacts allow.
double StepControl::stretch(double wanted, double remaining, double bears) noexcept {
  stretched_ = false;
  if (method_ != Method::kAuto && method_ != Method::kImplicit) return wanted;
  const double not_rejected = std::max(limit_, frame_ / max_substeps_);
  const double longest = std::min({kMaxStretch * wanted, remaining / allowed_, not_rejected, surface_step_, bears});
  stretched_ = longest > wanted;
  return std::max(wanted, longest);
}

SubstepPlan StepControl::next(double remaining, const Step& solver) noexcept {
  const bool frame_begins = remaining > (1.0 - 1e-6) * frame_;
  if (frame_begins) scaled_step_ = 0.0;
  SubstepPlan plan;
  plan.precise = composed_;
  plan.tells_turning = fixed_substeps_ == 0;
  const double smallest = frame_ / max_substeps_;
  const double most = fixed_substeps_ > 0 ? frame_ / fixed_substeps_ : frame_;
  double wanted = most;
  if (method_ == Method::kImplicit) plan.scheme = SchemeKind::kImplicit;
  const bool leapfrog = plan.scheme == SchemeKind::kLeapfrog;
  if (leapfrog && method_ == Method::kAuto) plan.max_phase = phase_share_ * kStablePhase;
  if (leapfrog && fixed_substeps_ == 0) {
    const double for_phase = stepFromTensions(frame_begins, solver);
    const double for_turn = turning_ > 0.0 && !composed_ ? stepForTurn(remaining) : frame_;
    wanted = std::min({for_phase, for_turn, frame_ / asked_});
  }
  if (shortens_) wanted = std::min(wanted, surface_step_);
  const double bears = stepOfElastic(leapfrog, solver);
  wanted = std::max(smallest, std::min(wanted, bears));
  double step = std::min(wanted, std::max(limit_, smallest));
  if (trust_.rules(frame_begins) && method_ != Method::kPaper) {
    plan.scheme = SchemeKind::kLastResort;
    plan.reach = trust_.reach();
    plan.precise = false;
    plan.max_phase = phase_share_ * kStablePhase;
    step = std::max(smallest, frame_ / kLastResortSubsteps);
  }
  if (!plan.isLastResort()) step = stretch(step, remaining, std::max(smallest, bears));
  // Equal shares of the rest of the frame; the slack keeps rounding from adding a substep.
  plan.h = remaining / std::max(1.0, std::ceil(remaining / step - 1e-6));
  plan.may_be_shorter = shortens_ && !plan.isLastResort() && step > smallest;
  return plan;
}

double StepControl::longestStableStep() const noexcept {
  return omega_ > 0.0 ? phase_share_ * kLongestPhase / ((composed_ ? kLongestStage : 1.0) * omega_) : frame_;
}

bool StepControl::askFor(int substeps) noexcept {
  const int before = asked_;
  asked_ = std::clamp(substeps, 1, max_substeps_);
  return asked_ != before;
}

void StepControl::watch(const SubstepOutcome& outcome) noexcept {
  omega_ = std::sqrt(outcome.omega_squared);
  turning_ = outcome.turning;
}

void StepControl::accepted(const SubstepPlan& plan, const SubstepOutcome& outcome) noexcept {
  watch(outcome);
  last_step_ = plan.h;
  surface_step_ = std::min(outcome.longest_step, 2.0 * surface_step_);  // what left may be back
  if (!plan.isLastResort())
    trust_.reset();
  else if (outcome.settled)
    trust_.succeeded();
  else
    trust_.failed(outcome.touches);
  if (limit_ < frame_ && ++good_ >= kGoodToGrow) {
    limit_ = std::min(frame_, limit_ * kLimitGrowth);
    good_ = 0;
  }
}

void StepControl::rejected(const SubstepPlan& plan, const SubstepOutcome& outcome) noexcept {
  if (plan.may_be_shorter && plan.h > kTooLong * outcome.longest_step) {
    surface_step_ = outcome.longest_step;
    return;
  }
  good_ = 0;
  if (trust_.bounded()) return trust_.schemeFailed();
  limit_ = 0.5 * plan.h;
  if (limit_ < frame_ / max_substeps_) trust_.schemeFailed();
}

void StepControl::tookTooLong(const SubstepPlan& plan) noexcept {
  if (trust_.bounded()) return trust_.schemeFailed();  // a last resort is taken even where its time is over
  limit_ = std::min(limit_, std::max(0.5 * plan.h, 2.0 * frame_ / max_substeps_));
  good_ = 0;
}

}  // namespace curtain
