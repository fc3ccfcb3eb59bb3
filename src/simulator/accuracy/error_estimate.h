// SPDX-License-Identifier: BSD-3-Clause
//
// Estimates the error of the computed motion, and the substeps that bring it to a tolerance.
//
// For one second out of four a reference run moves along, from the same start in half (or twice) as many substeps. With
// a scheme of order p, the error is the difference over |1 - (n/m)^p|, n and m being the substeps (Richardson 1911),
// however errors grow. Before the motion two pilot runs of half a second give a first guess. Errors are RMS over the
// movable nodes.
#pragma once

#include <algorithm>

#include "cloth/cloth.h"
#include "step/schemes/composition.h"

namespace curtain {

class ErrorEstimate {
 public:
  /// params: with a position_tolerance, and a method that it knows(). They must outlive this.
  ErrorEstimate(const SolverParams& params, const ClothPattern& pattern);

  /// Methods whose error can be estimated: those made of leapfrog steps.
  static bool knows(Method method) {
    return method == Method::kAuto || method == Method::kLeapfrog || method == Method::kLeapfrog4;
  }

  /// Leapfrog steps that a substep is made of.
  static int stepsPerSubstep(Method method) noexcept {
    return method == Method::kLeapfrog4 ? static_cast<int>(kStages.size()) : 1;
  }

  void reset() noexcept;
  /// Sets the length of the next frames [s]; the next comparison starts at once.
  void setFrameLength(double length) noexcept;

  /// The reference run starts with the coming frame from the motion's state, or is on its way.
  bool referenceStarts() const noexcept { return frames_ % (kEverySeconds * window_) == 0; }
  bool referenceMoves() const noexcept { return frames_ % (kEverySeconds * window_) < window_; }

  /// Least substeps a frame of the motion.
  int substeps() const noexcept { return substeps_; }
  /// Largest number it may ask for.
  int maxSubsteps() const noexcept { return most_; }
  /// Stability needs this many.
  void atLeast(int least) noexcept { substeps_ = std::clamp(least, substeps_, most_); }
  /// A reference run with half as many is stable, if `least` are needed for that.
  bool halfWillDo(int least) const noexcept { return (substeps_ + 1) / 2 >= least && substeps_ > 1; }
  /// Substeps of the reference run: half as many, or twice as many.
  int referenceSubsteps(bool finer) const noexcept { return finer ? 2 * substeps_ : (substeps_ + 1) / 2; }

  /// Frames of a pilot run; its result makes the first choice of substeps.
  int pilotFrames() const noexcept;
  void pilotsMade(const Field3& position, int substeps, const Field3& finer_position, int finer_substeps) noexcept;

  /// After a frame in so many leapfrog steps. reference: null when there is none or it has failed; of_stages: all steps
  /// were stages of whole substeps.
  void frameMade(const Field3& position, int steps, const Field3* reference, int reference_steps,
                 bool of_stages) noexcept;

  /// Estimated error that a second of motion adds to the positions [m].
  double perSecond() const noexcept;

  void serialize(Archive& archive);

 private:
  static constexpr int kEverySeconds = 4;
  double error(const Field3& a, double n, const Field3& b, double m, int order) const noexcept;
  void beginWindow() noexcept;
  void aimAt(double error_per_second, double substeps) noexcept;

  const ClothPattern& pattern_;
  double frame_length_;
  const double& tolerance_;  // which may change
  int order_;                // of the scheme; a window in which stages could not be made counts as order 2
  int steps_per_substep_;    // leapfrog steps
  bool of_stages_ = true;    // in the present window
  int window_;               // frames a second
  int fewest_, most_;        // substeps a frame; equal where they are fixed
  int substeps_;
  long frames_ = 0;
  int compared_ = 0;  // frames of the present window with a reference
  double steps_sum_ = 0.0, reference_sum_ = 0.0;
  double now_ = 0.0, last_second_ = 0.0;
};

}  // namespace curtain
