// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/accuracy/error_estimate.h"

#include <algorithm>
#include <cmath>

namespace curtain {
namespace {

// Substeps are chosen for kAim of the tolerance; fewer only if the error is below kFewer of it.
constexpr double kAim = 0.7;
constexpr double kFewer = 0.35;
// Least |1 - (n/m)^p|: runs with nearly equal steps say nothing of the error.
constexpr double kMinPart = 0.3;
constexpr double kPilot = 0.5;  // length of a pilot run [s]
// Errors grow at least with the square of time, since errors of velocities move the nodes. From a pilot run's half
// second on we assume the cube: measured powers are 1.5 to 2.2 for chains released at 45 degrees and 2.8 to 3.2 at 90,
// and the first guess should rather be too good.
constexpr double kGrowth = 2.0;
constexpr double kGrowthOfGuess = 3.0;

}  // namespace

ErrorEstimate::ErrorEstimate(const SolverParams& params, const ClothPattern& pattern)
    : pattern_(pattern),
      frame_length_(1.0 / params.frame_rate),
      tolerance_(params.position_tolerance),
      order_(params.method == Method::kLeapfrog4 ? 4 : 2),
      steps_per_substep_(stepsPerSubstep(params.method)),
      window_(std::max(1, static_cast<int>(std::lround(1.0 / frame_length_)))),
      fewest_(std::max(1, params.substeps)),
      most_(params.substeps > 0 ? params.substeps : std::max(1, params.max_substeps)),
      substeps_(fewest_) {}

void ErrorEstimate::reset() noexcept {
  substeps_ = fewest_;
  frames_ = 0;
  last_second_ = 0.0;
  beginWindow();
}

void ErrorEstimate::beginWindow() noexcept {
  compared_ = 0;
  steps_sum_ = reference_sum_ = now_ = 0.0;
  of_stages_ = true;
}

// Substeps keep their length, and a comparison starts at once.
void ErrorEstimate::setFrameLength(double length) noexcept {
  substeps_ =
      static_cast<int>(std::clamp<double>(std::ceil(substeps_ * length / frame_length_ - 1e-9), fewest_, most_));
  frame_length_ = length;
  window_ = std::max(1, static_cast<int>(std::lround(1.0 / length)));
  frames_ = 0;
  beginWindow();
}

int ErrorEstimate::pilotFrames() const noexcept {
  return std::max(1, static_cast<int>(std::lround(kPilot / frame_length_)));
}

double ErrorEstimate::error(const Field3& a, double n, const Field3& b, double m, int order) const noexcept {
  double sum = 0.0;
  std::size_t count = 0;
  for (std::size_t k = 0; k < pattern_.grid.size(); ++k) {
    if (pattern_.inverse_mass[k] <= 0.0) continue;
    sum += (a.at(k) - b.at(k)).squaredNorm();
    ++count;
  }
  const double part = std::abs(1.0 - std::pow(n / m, order));
  return count > 0 && part > kMinPart ? std::sqrt(sum / static_cast<double>(count)) / part : 0.0;
}

void ErrorEstimate::aimAt(double error_per_second, double substeps) noexcept {
  if (!std::isfinite(error_per_second)) return;
  if (error_per_second <= kAim * tolerance_ && error_per_second >= kFewer * tolerance_) return;
  const double wanted = substeps * std::pow(error_per_second / (kAim * tolerance_), 1.0 / order_);
  substeps_ = static_cast<int>(std::clamp<double>(std::ceil(wanted), fewest_, most_));
}

void ErrorEstimate::pilotsMade(const Field3& position, int substeps, const Field3& finer_position,
                               int finer_substeps) noexcept {
  const double growth = std::pow(1.0 / (pilotFrames() * frame_length_), kGrowthOfGuess);
  substeps_ = std::clamp(substeps, fewest_, most_);
  aimAt(growth * error(position, substeps, finer_position, finer_substeps, order_), substeps);
}

void ErrorEstimate::frameMade(const Field3& position, int steps, const Field3* reference, int reference_steps,
                              bool of_stages) noexcept {
  const bool in_window = referenceMoves();
  ++frames_;
  if (!in_window) return;
  if (reference == nullptr) {  // it restarts with the next frame
    compared_ = 0;
    steps_sum_ = reference_sum_ = 0.0;
  } else {
    ++compared_;
    of_stages_ = of_stages_ && of_stages;
    steps_sum_ += steps;
    reference_sum_ += reference_steps;
    now_ = error(position, steps_sum_, *reference, reference_sum_, of_stages_ ? order_ : 2);
  }
  const bool over = !referenceMoves();
  if (over && compared_ > 0 && now_ > 0.0) {
    // A reference run that was lost within the second is extrapolated.
    last_second_ = now_ * std::pow(static_cast<double>(window_) / compared_, kGrowth);
    aimAt(last_second_, steps_sum_ / (compared_ * steps_per_substep_));
  }
  if (over) beginWindow();
}

double ErrorEstimate::perSecond() const noexcept { return std::max(now_, last_second_); }

}  // namespace curtain
