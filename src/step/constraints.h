// SPDX-License-Identifier: BSD-3-Clause
//
// The constraints of a substep: two-sided warp rods, one-sided weft strings, and who makes further rows (RowMaker),
// with the positions being solved for and the links' directions and multipliers. Rods: Newton, one tridiagonal system a
// column. Taut strings and rows: all at once, with the rods eliminated (NetSolver). Sweeps decides what is solved when.
// Where functions speak of strings, distances that parts bound are among them.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "step/distance_rows.h"
#include "step/energy_account.h"
#include "step/net_solver.h"
#include "step/node_inertia.h"
#include "step/solver_parts.h"
#include "step/substep.h"
#include "step/warp_solver.h"
#include "step/weft_links.h"

namespace curtain {

/// Not thread-safe. Allocates only in the constructor, and for more contacts than expected.
class Constraints {
 public:
  /// tolerance  relative overlength that the links' compliance may reach. All arguments must outlive this.
  Constraints(const ClothPattern& pattern, const SolverParts& parts, double tolerance, const NodeInertia& inertia,
              const Workers& workers);
  void expectContacts(std::size_t count);
  /// Forgets the tensions of the last substep.
  void reset() noexcept;

  /// Positions being solved for [m].
  Field3 next;

  // ---- Begin and end of a substep

  /// Predicts, and warm-starts with the last substep's multipliers times ratio. state: at the start of the substep;
  /// drives: parts do.
  void begin(const SubstepStart& start, const ClothState& state, double ratio, bool drives, double gravity) noexcept;
  /// Accepts the substep: sets velocities and loads (returns the largest load over its mass) and keeps the multipliers.
  /// tells_turning: compute WarpMotion::turning.
  double commit(const SubstepStart& start, bool tells_turning, ClothState& state, Field& load) noexcept;
  /// Ends the substep, accepted or not.
  void end(bool taken) noexcept;

  /// A string pulled in the last accepted substep.
  bool stringsPull() const noexcept { return weft_pulls_ || distances_.pulls(); }
  /// A string pulls now, or directions were set because one was too long.
  bool stringsAct() const noexcept { return directions_set_; }
  /// Sum over the rods of their relative change of velocity in the last substep [1/s^2] (WarpMotion::turning).
  double turning() const noexcept;
  /// Tensions in the last substep [N] of the rod above a node and of the link to its left; a rod that pushes has a
  /// negative one. scale: of that substep, h * kick [s^2]; 0: there was none.
  struct LinkTensions {
    double warp = 0.0, weft = 0.0;
  };
  LinkTensions tensionsAt(int row, int column, double scale) const noexcept;
  /// Sum of multiplier times direction over a node's links, of the last substep [kg m].
  Vec3 pullAt(int row, int column) const noexcept {
    const Vec3 pull = pullAt(row, column, last_warp_, last_weft_, weft_pulls_);
    return distances_.any() ? Vec3(pull + distances_.pullAt(pattern_.grid.index(row, column))) : pull;
  }

  /// Sets the relative overlength that the links' compliance may reach.
  void setTolerance(double tolerance) noexcept {
    weft_.max_give = tolerance;
    distances_.setMostGive(tolerance);
  }

  /// null: all nodes are free or pinned.
  GuidePart* guide() noexcept { return guide_; }
  const GuidePart* guide() const noexcept { return guide_; }
  DistanceRows& distances() noexcept { return distances_; }
  const DistanceRows& distances() const noexcept { return distances_; }
  ContactRows& contacts() noexcept { return contacts_; }
  const ContactRows& contacts() const noexcept { return contacts_; }

  // ---- Parts of a solve

  /// A substep is solved again when contacts are added.
  void beginSolve() noexcept {
    net_ready_ = false;
    const double gives = contacts_.all().empty() ? kStraightCompliance : kWeftCompliance;
    weft_.compliance = weight_ > 0.0 ? gives * middle_rest_ * std::abs(per_scale_) / weight_ : 0.0;
  }

  struct RodsAim {
    bool follow;          ///< along the directions of the present positions
    double stop;          ///< relative residual at the start of the last Newton iteration
    double leave_alone;   ///< blocks of columns within this residual are skipped
    double max_residual;  ///< beyond it the solve has failed
  };
  struct RodsProgress {
    bool converged = true;
    double first_residual = 0.0;  ///< before the first iteration
  };
  RodsProgress solveRods(const RodsAim& aim) noexcept;
  double rodsResidual() noexcept;

  /// Largest relative violation of a string. closely: keep the violation of each for solveNet(); otherwise none may
  /// pull.
  double checkStrings(bool closely) noexcept;

  /// Sets the directions of all links from the present positions.
  void followDirections() noexcept;
  /// Sets the strings' directions from the start of the substep; the rods have theirs.
  void setDirections(const Field3& start) noexcept;

  struct NetAim {
    double residual;  ///< largest relative violation
    double enough;    ///< reduction of it to stop at
    double damping;   ///< Levenberg-Marquardt term, relative to the diagonal
    bool newton;      ///< the active set of strings changes within the solve
  };
  /// One step of all taut strings and rows. Moves the nodes; the rods are solved for next.
  void solveNet(const NetAim& aim) noexcept;

  /// After nodes were moved by others: guided ones are where their part lets them be.
  void settleGuide() noexcept;

  /// Sum of the squared violations of links and rows, in lengths of a link; rods_lack: violation assumed of every
  /// rod, where their solve has not converged. A damped step reduces it if it is short enough, while the largest
  /// violation may stay the same.
  double merit(double rods_lack) noexcept;
  /// The iterate to return to when a sweep made things worse.
  void saveIterate();
  void restoreIterate() noexcept;

  /// Energy that links and contacts can hold in a substep of h [s] by being off one way and then the other as far as
  /// the tolerance lets them [J]: a pull of T that is off by e holds T e. tolerance: relative, of links;
  /// contact_tolerance: [m].
  double canHold(double h, double tolerance, double contact_tolerance) const noexcept;

  /// Energy that links hold at the start of a substep of h [s] by being off further than the tolerance [J]. They were
  /// put there, or left so by the last resort.
  double heldBeyond(const Field3& start, double h, double tolerance) const noexcept;

  /// Mean of the shortest and the longest weft link of the top row, the length scale [m].
  double middleRest() const noexcept { return middle_rest_; }

  // ---- Velocities (constraints_velocity.cpp)

  /// Projects the velocities on the constraints: no rod or pulling string changes its length, no pushing contact
  /// penetrates. Starts from `share` of the last substep's forces between nodes, so friction goes on and cloth at rest
  /// is a fixed point. Guided nodes: after GuidePart::beginRates(). most: what the account lets the velocities have.
  void project(const Field3& position, double share, const EnergyAccount& account, double most,
               Field3& velocity) noexcept;
  /// Adds what links and rows acted by in the last substep, along their directions at these positions, times share and
  /// over the nodes' masses. Between substeps only.
  void addPulls(const Field3& position, double share, Field3& velocity) noexcept;

  // ---- Changes of pins

  /// The pattern's pins have changed, and inertia has taken them.
  void pinsChanged() noexcept;
  /// Forgets the tensions of links between two pins: nothing solves for them any more.
  void slackenBetweenPins() noexcept;

  // ---- What a substep leaves to the next

  struct Memory {
    Field warp, weft;
    bool weft_pulls = false;
    DistanceRows::Memory distances;

    void serialize(Archive& archive);
  };
  void save(Memory& memory) const;
  void restore(const Memory& memory);
  void serialize(Archive& archive);
  /// After serialize() has loaded, with inertia as it was saved.
  void resume(const ClothState& state) noexcept;

 private:
  // What acts on a node with the multipliers being solved for.
  class ForceNow final : public NodeForce {
   public:
    explicit ForceNow(const Constraints& of) : of_(of) {}
    Vec3 at(int row, int column) const noexcept override;

   private:
    const Constraints& of_;
  };
  struct Iterate {
    Field3 position;
    Field warp, weft;
  };
  RodsProgress solveBlock(const LineSolve& warp, const RodsAim& aim, int block) noexcept;
  void setWeftDirectionsAt(const Field3& position) noexcept;
  double measureStrings() noexcept;
  double loadStrings(Field& load) noexcept;
  void spreadForces(const LineSolve& warp, const LineSolve& weft, double share) noexcept;
  void undoRound(Field3& velocity) noexcept;
  // Nodes that are guided in this substep; null: none.
  GuidedNodes* guided() noexcept { return guide_ != nullptr && guide_->moves() ? guide_ : nullptr; }
  LineSolve rods() noexcept { return {pattern_, inertia_.inverse(), warp_, next, guided()}; }
  LineSolve wefts() noexcept { return {pattern_, inertia_.inverse(), weft_, next, guided()}; }
  double applyStringChange(double residual) noexcept;
  double applyTogether() noexcept;
  void beginGuide(const SubstepStart& start, const ClothState& state) noexcept;
  double commitGuide(ClothState& state, const Field& load) noexcept;
  Vec3 pullAt(int row, int column, const Field& warp, const Field& weft, bool strings) const noexcept;
  void makeRows(const Field3& value, bool rates) noexcept;
  template <typename Visit>
  double worstOfRows(const Visit& visit) noexcept;
  template <typename Block>
  void forEachBlock(const Block& block) const;

  static constexpr int kRowsAtOnce = 8;  // of a task for the workers

  const ClothPattern& pattern_;
  const NodeInertia& inertia_;
  const Workers& workers_;
  NetSolver net_;
  GuidePart* guide_;
  double mean_mass_;     // of a node [kg]
  double weight_ = 0.0;  // of such a node, in the substep being made [N]
  double middle_rest_;   // of a link of the top row [m]
  DistanceRows distances_;
  ContactRows contacts_;
  std::array<RowMaker*, 2> makers_{&distances_, &contacts_};
  Rows rows_;                            // of all makers
  Field rod_change_;                     // of the rods' multipliers, with those of strings and rows
  Field3 moved_;                         // by all of them [m]
  const Field3* other_force_ = nullptr;  // all but the links', in the substep being made [N]
  double per_scale_ = 0;                 // 1 / (h kick) [1/s^2]
  int presses_ = 0;                      // times that the guide was pressed in this substep
  LineScratch scratch_;
  LinkSet warp_, weft_;
  Field last_warp_, last_weft_;  // multipliers of the last accepted substep
  bool weft_pulls_ = false;      // a multiplier of last_weft_ is not zero
  bool directions_set_ = false;  // of the weft, in this substep
  bool measured_ = false;        // violation_ and active_ belong to the present positions
  bool net_ready_ = false;       // net_ has directions of this substep
  Field violation_, active_, compliance_, change_;
  Field free_per_square_;  // 1 / rest length^2 of weft links with a movable end [1/m^2]; others: 0
  std::vector<WarpMotion> block_motion_;
  std::vector<RodsProgress> block_progress_;
  std::vector<double> row_worst_;
  Iterate best_;
};

// Calls run(block) for all blocks of columns.
template <typename Block>
void Constraints::forEachBlock(const Block& run) const {
  workers_.run(warpBlockCount(pattern_.grid), [&](int block) { run(block); });
}

// Calls visit(row) for all rows; returns the largest result.
template <typename Visit>
double Constraints::worstOfRows(const Visit& visit) noexcept {
  const int rows = pattern_.grid.rows;
  workers_.run(static_cast<int>(row_worst_.size()), [&](int b) {
    double worst = 0.0;
    const int end = std::min((b + 1) * kRowsAtOnce, rows);
    for (int i = b * kRowsAtOnce; i < end; ++i) worst = std::max(worst, visit(i));
    row_worst_[static_cast<std::size_t>(b)] = worst;
  });
  return *std::max_element(row_worst_.begin(), row_worst_.end());
}

}  // namespace curtain
