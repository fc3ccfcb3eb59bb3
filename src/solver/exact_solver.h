// SPDX-License-Identifier: BSD-3-Clause
//
// The exact schemes: one substep of point masses, two-sided warp rods and one-sided weft links, whose constraint
// forces are solved for (not approached by relaxation). A sweep is: Newton on the rods, one tridiagonal system a column;
// then all taut weft links and all contacts that push at once, with the rods' answer taken into account (NetSolver); until
// every link is within tolerance and nothing enters. Cloth without a taut string that touches nothing never leaves the first
// half of the first sweep.
//
//   leapfrog  forces act along the links' directions at the start of the step, velocities live half a step behind
//             (SHAKE: Ryckaert, Ciccotti, Berendsen 1977): order 2, symplectic, needs dt * omega_max < 2
//   bdf2      along the directions at the end of the step, two steps remembered (Gear 1971): order 2, damps what it can't
//             follow, stable at any step; where a string snaps taut or something meets something, as implicit
//   implicit  the same with one step (backward Euler): order 1, damps, stable at any step
#pragma once

#include <algorithm>
#include <limits>
#include <vector>

#include "solver/held_columns.h"
#include "solver/last_resort.h"
#include "solver/net_solver.h"
#include "solver/node_inertia.h"
#include "solver/substep.h"
#include "solver/warp_solver.h"
#include "solver/weft_links.h"

namespace curtain {

enum class Scheme { kLeapfrog, kBdf2, kImplicit };

/// A substep to be made.
struct SubstepPlan {
  Scheme scheme = Scheme::kLeapfrog;
  double h = 0.0;            ///< [s], != 0; negative only for leapfrog
  bool last_resort = false;  ///< the smallest step, of the default scheme: taken as far as its links hold (last_resort.h)
  double reach = std::numeric_limits<double>::infinity();  ///< last resort: most that a node may be predicted to move, in links
  bool tells_turning = true; ///< SubstepOutcome::turning is read
  bool precise = false;      ///< rods are solved to rounding
  double most_phase = 0.0;   ///< nodes whose tensions ask for a larger h * omega answer forces as if they were heavier,
                             ///< so that theirs is this; 0: none does. Vanishes with the step.
};

class ExactSolver {
 public:
  /// stretch_tolerance  relative overlength allowed to a link
  /// max_sweeps         bound of the sweeps in a substep
  ExactSolver(const ClothPattern& pattern, double stretch_tolerance, int max_sweeps, const Workers& workers);

  /// Room for so many contacts; more would make a substep allocate.
  void expectContacts(std::size_t count) {
    net_.expectContacts(count);
    best_.contacts.reserve(count);
  }

  /// Forgets the tensions of the last substep.
  void reset() noexcept;

  /// From now on these columns stay where they are, at rest, and the others move. Those that wake start with the tensions they
  /// fell asleep with. For leapfrog and its fall-back.
  void hold(const ColumnSet& columns, ClothState& state) noexcept;
  /// What is held now; and what of it the last substep would have moved (SubstepOutcome::disturbed).
  const HeldColumns& held() const noexcept { return held_; }

  /// One substep. finder may be null: nothing to touch. Allocates nothing.
  SubstepOutcome substep(const SubstepPlan& plan, const NodeForces& forces, ContactFinder* finder,
                         ClothState& state, StageClock& clock) noexcept;

  /// What the links at a node pulled it by in the last substep: the sum of multiplier times direction [kg m], over the substep's
  /// scale a force.
  Vec3 pullAt(int row, int column) const noexcept;

  /// How nodes answered impulses in the last substep [1/kg].
  const Field& inverseInertia() const noexcept { return inertia_.inverse(); }

  /// Velocities at the time of the positions (leapfrog keeps them half a substep behind): advanced by the forces and
  /// made to agree with the links that pull.
  /// contacts: of the last substep, or null.
  void currentVelocities(const ClothState& state, const NodeForces& forces, const Contacts* contacts, Field3& out) noexcept;

  /// The last substep's tensions, and how nodes answered in it.
  const NodeInertia& inertia() const noexcept { return inertia_; }

  /// A string pulled in the last substep.
  bool weftPulls() const noexcept { return weft_pulls_; }

  /// What a substep leaves to the next, to be put back when substeps are made again.
  struct Memory {
    Field warp, weft;
    Field3 older_position, older_velocity;
    NodeInertia::Tensions tensions;
    double older_h = 0.0;
    int single_steps = 0;
    bool weft_pulls = false;

    void carry(Archive& archive);
  };
  void save(Memory& memory) const;
  void restore(const Memory& memory);

  void carry(Archive& archive);
  /// After carry() has loaded: these columns are held, and what is not carried follows from what is.
  void resume(const ColumnSet& held, const ClothState& state) noexcept;

 private:
  struct Progress {
    bool settled = false;    // every link is within the user's tolerance
    bool left_over = false;  // but not within what the step's length asks for
    bool crossed = false;    // something would go through something
    bool late = false;       // its time was over before it had settled
    bool found = false;      // a finite iterate was found
    int sweeps = 0;
    const Contacts* contacts = nullptr;  // null: nothing can touch
  };
  // How a solve of the strings and contacts is to be made.
  struct WeftStep {
    double enough;   // reduction of the residual to stop at
    double damping;  // Levenberg-Marquardt
  };
  struct WarpProgress {
    bool converged = true;
    double first_residual = 0.0;  // before the first iteration
    double last_residual = 0.0;   // before the last one
  };
  // What a sweep that went wrong goes back to.
  struct Iterate {
    Field3 position;
    Field warp, weft;
    std::vector<Contact> contacts;
    double residual = std::numeric_limits<double>::infinity();
    double merit = std::numeric_limits<double>::infinity();
  };
  void keepIterate(double residual, const Contacts* contacts);
  void goBack(Contacts* contacts) noexcept;
  double meritOf(const Contacts* contacts, double rods_lack) noexcept;
  void cutPrediction(const SubstepPlan& plan, const NodeForces& forces, const ClothState& state, double kick, SubstepOutcome& outcome) noexcept;
  void boundPath(const Progress& progress, double h, SubstepOutcome& outcome) noexcept;
  const ClothState& setBase(Scheme scheme, double h, const ClothState& state, double& step) noexcept;
  double begin(const SubstepPlan& plan, const SubstepStart& start, double scale) noexcept;
  // weight_way: that weight moves a node by in the substep [m].
  Progress solveConstraints(const SubstepPlan& plan, const Field3& start, double weight_way, Contacts* contacts,
                            StageClock& clock) noexcept;
  Progress solveAndVerify(const SubstepPlan& plan, const SubstepStart& start, const Field3& from, double ratio,
                          double weight_way, ContactFinder* finder, StageClock& clock) noexcept;
  double turning(double kick) const noexcept;
  bool struck(const Contacts* contacts) const noexcept;
  void keepMomentum(const SubstepStart& start) noexcept;
  WarpProgress solveBlock(bool follow, const LineSolve& warp, int block, double stop, double leave_alone,
                          double most_residual, bool begun) noexcept;
  WarpProgress solveWarp(bool follow, const LineSolve& warp, double stop, double leave_alone, double most_residual, bool begun) noexcept;
  double slackResidual() noexcept;
  double weftResidualNow(const LineSolve& weft) noexcept;
  void solveNet(const LineSolve& weft, Contacts* contacts, double residual, const WeftStep& step) noexcept;
  void followDirections() noexcept;
  void setAllWeftDirections(const Field3& position) noexcept;
  double warpResidualNow(const LineSolve& warp) noexcept;
  bool withinTolerance(const LineSolve& warp, const LineSolve& weft, double tolerance) noexcept;
  void projectVelocity(const Field3& position, const Contacts* contacts, double share, Field3& out) noexcept;
  void projectOnConstraints(const Field3& position, const Contacts* contacts, double share, Field3& out) noexcept;
  // Twice the kinetic energies [J] of a substep: of the way that the nodes have gone, and of that which they would without links.
  struct Kinetic {
    double stepped = 0.0, predicted = 0.0;
    double driven = 0.0;  // to be added: of all the mass at the speed of the fastest pin
    double most(double share) const noexcept;
  };
  Kinetic kineticOf(const SubstepStart& start) const noexcept;
  double kineticOf(const Field3& velocity) const noexcept;
  double fromTolerance(double h) const noexcept;
  double drivenKinetic(const Field3& velocity) const noexcept;
  void boundKinetic(double most, Field3& velocity) const noexcept;
  void layDown(int block, ClothState& state) noexcept;
  void takeUp(int block) noexcept;
  double heaviestOf(int block) const noexcept;
  double loadStrings() noexcept;
  void commit(const ClothState& base, double step, double velocity_age, bool bends, ClothState& state) noexcept;
  template <typename Look>
  double worstOfRows(const Look& look) noexcept;
  template <typename Block>
  void forEachBlock(const Block& block) const;

  static constexpr int kRowsAtOnce = 8;

  const ClothPattern& pattern_;
  bool free_;                 // no node is pinned
  const Workers& workers_;
  double stretch_tolerance_;  // the user's, relative
  double tolerance_;          // inside the solver
  double contact_tolerance_;  // [m]
  double smallest_rest_;      // of a link [m]
  int max_sweeps_;
  double sure_stop_;          // Newton from this close ends within the tolerance: it leaves at most (rows * this)^2
  NodeInertia inertia_;
  HeldColumns held_;
  std::vector<double> laid_down_;  // by block: scale of the multipliers that it was left out with [s^2]
  std::vector<std::uint8_t> skipped_before_;  // scratch of hold()
  NetSolver net_;
  LineScratch scratch_;
  LinkSet warp_, weft_;
  Field last_warp_, last_weft_;  // multipliers of the last accepted substep
  bool weft_pulls_ = false;      // a multiplier of last_weft_ is not zero
  bool directions_set_ = false;  // of the weft, in this substep
  bool newton_begun_ = false;    // begin() has made the first iteration on the rods
  bool measured_ = false;        // violation_ and active_ are of the positions as they are
  double middle_rest_ = 1.0;     // of the top row's weft links, for scale: whichever end they are counted from [m]
  Field violation_, active_, change_;
  Field free_per_square_;  // of weft links with an end that can move: 1 / rest length^2 [1/m^2]; others: 0
  std::vector<LineOutcome> block_begun_;
  std::vector<WarpMotion> block_motion_;
  std::vector<WarpProgress> block_progress_;
  std::vector<double> row_worst_;
  Field3 next_;
  LastResort last_resort_;
  Field3 no_force_;
  Iterate best_;
  ClothState base_;             // what bdf2 and the last resort start from
  Field3 older_position_, older_velocity_;
  double older_h_ = 0.0;        // length of the step between these and the present; 0 = none
  int single_steps_ = 0;        // that bdf2 makes from one step before it takes two again
};

// Calls run(block) for the blocks of columns in which something moves.
template <typename Block>
void ExactSolver::forEachBlock(const Block& run) const {
  workers_.run(warpBlockCount(pattern_.grid), [&](int block) {
    if (!held_.skips(block)) run(block);
  });
}

// Calls look(row) for all rows; the largest of what it returns.
template <typename Look>
double ExactSolver::worstOfRows(const Look& look) noexcept {
  const int rows = pattern_.grid.rows;
  workers_.run(static_cast<int>(row_worst_.size()), [&](int b) {
    double worst = 0.0;
    const int end = std::min((b + 1) * kRowsAtOnce, rows);
    for (int i = b * kRowsAtOnce; i < end; ++i) worst = std::max(worst, look(i));
    row_worst_[static_cast<std::size_t>(b)] = worst;
  });
  return *std::max_element(row_worst_.begin(), row_worst_.end());
}

}  // namespace curtain
