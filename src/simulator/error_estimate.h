// SPDX-License-Identifier: BSD-3-Clause
//
// How far the computed motion is off the exact one, and how many substeps bring it to a tolerance.
//
// For one second out of four a reference run moves along, from the same start in half (or twice) as many substeps. By
// the scheme's order p the error of the motion is what the two differ by over |1 - (n/m)^p|, n and m being their
// substeps (Richardson 1911): no assumption on how errors grow enters. Before the motion begins two pilot runs of half
// a second make a first guess, so that it starts with about the substeps it needs. RMS over the nodes that can move.
#pragma once

#include <algorithm>

#include "cloth/cloth.h"
#include "solver/schemes/composition.h"

namespace curtain {

class ErrorEstimate {
 public:
  /// params: with a position_tolerance, of a method that it knows. pattern must outlive this.
  ErrorEstimate(const SolverParams& params, const ClothPattern& pattern);

  /// Methods whose error it can tell: those that are made of leapfrog steps.
  static bool knows(Method method) {
    return method == Method::kAuto || method == Method::kLeapfrog || method == Method::kLeapfrog4;
  }

  /// Leapfrog steps that a substep is made of.
  static int stepsPerSubstep(Method method) noexcept {
    return method == Method::kLeapfrog4 ? static_cast<int>(kStages.size()) : 1;
  }

  void reset() noexcept;
  /// Frames are so long from now on [s]: the next comparison is a whole period away.
  void takeFrame(double length) noexcept;

  /// The reference run sets out with the coming frame (from the motion's own state), or is on its way.
  bool referenceStarts() const noexcept { return frames_ % (kEverySeconds * window_) == 0; }
  bool referenceMoves() const noexcept { return frames_ % (kEverySeconds * window_) < window_; }

  /// Substeps a frame of the motion, at least.
  int substeps() const noexcept { return substeps_; }
  /// The most it may ask for.
  int mostSubsteps() const noexcept { return most_; }
  /// Stability needs so many.
  void atLeast(int least) noexcept { substeps_ = std::clamp(least, substeps_, most_); }
  /// A reference run in half as many is stable when the motion needs `least` for that.
  bool halfWillDo(int least) const noexcept { return (substeps_ + 1) / 2 >= least && substeps_ > 1; }
  /// Half as many, or twice as many.
  int referenceSubsteps(bool finer) const noexcept { return finer ? 2 * substeps_ : (substeps_ + 1) / 2; }

  /// Frames of a pilot run, and what came of it: makes the first choice of substeps.
  int pilotFrames() const noexcept;
  void pilotsMade(const Field3& position, int substeps, const Field3& finer_position, int finer_substeps) noexcept;

  /// A frame has gone by in so many leapfrog steps. reference: null when it is not on its way or has failed. of_stages:
  /// all steps were stages of whole substeps.
  void frameMade(const Field3& position, int steps, const Field3* reference, int reference_steps,
                 bool of_stages) noexcept;

  /// Estimated error of the positions that a second of motion adds [m].
  double perSecond() const noexcept;

  void carry(Archive& archive);

 private:
  static constexpr int kEverySeconds = 4;
  double error(const Field3& a, double n, const Field3& b, double m, int order) const noexcept;
  void aimAt(double error_per_second, double substeps) noexcept;

  const ClothPattern& pattern_;
  double frame_length_, tolerance_;
  int order_;              // of the scheme; where its stages could not be made in the window, it is taken for 2
  int steps_per_substep_;  // leapfrog steps
  bool of_stages_ = true;  // in the present window
  int window_;             // frames of a second
  int fewest_, most_;      // substeps a frame that it may ask for; the same where they are fixed
  int substeps_;
  long frames_ = 0;
  int compared_ = 0;  // frames of the present window
  double steps_sum_ = 0.0, reference_sum_ = 0.0;
  double now_ = 0.0, last_second_ = 0.0;
};

}  // namespace curtain
