// SPDX-License-Identifier: BSD-3-Clause
//
// What holds the cloth together in a substep: two-sided warp rods and one-sided weft links, with the positions in the
// making, the links' directions and multipliers, and the solves that bring both together. Rods: Newton, one tridiagonal
// system a column. Strings and contacts that push: all at once, with the rods' answer taken into account (NetSolver).
// What is solved when is for Sweeps.
#pragma once

#include <algorithm>
#include <vector>

#include "solver/held_columns.h"
#include "solver/net_solver.h"
#include "solver/node_inertia.h"
#include "solver/substep.h"
#include "solver/warp_solver.h"
#include "solver/weft_links.h"

namespace curtain {

/// Not thread-safe. Allocates nothing after construction, but for more contacts than expected.
class Constraints {
 public:
  /// tolerance  relative, of the links: what their compliance may give. All of them must outlive this.
  Constraints(const ClothPattern& pattern, double tolerance, const NodeInertia& inertia, const HeldColumns& held,
              const Workers& workers);
  void expectContacts(std::size_t count);
  /// Forgets the tensions of the last substep.
  void reset() noexcept;

  /// Positions in the making [m].
  Field3 next;

  // ---- the beginning and the end of a substep

  /// Predicts, and starts with the last substep's multipliers times ratio.
  void begin(const SubstepStart& start, double ratio) noexcept;
  /// The substep is taken: velocities, loads (returns the largest of them over its mass), memory. bends:
  /// WarpMotion::bent is wanted.
  double commit(const Field3& from, double step, bool bends, ClothState& state, Field& load) noexcept;
  /// It is over, taken or not.
  void end(bool taken) noexcept;

  /// A string pulled in the last substep that was taken.
  bool weftPulls() const noexcept { return weft_pulls_; }
  /// A string pulls now, or one was looked at closely.
  bool stringsAct() const noexcept { return directions_set_; }
  const LinkSet& strings() const noexcept { return weft_; }
  /// A string pulls that did not in the last substep.
  bool snapsTaut() const noexcept;
  /// Sum over the rods of how their motion has changed in the last substep [1/s^2] (WarpMotion::bent).
  double bent() const noexcept;
  /// Sum of multiplier times direction over a node's links, of the last substep [kg m].
  Vec3 pullAt(int row, int column) const noexcept;

  // ---- what a solve is made of

  /// The same substep may be solved more than once, each time with more contacts.
  void beginSolve() noexcept { net_ready_ = false; }

  struct RodsAim {
    bool follow;           ///< along the directions of the present positions
    double stop;           ///< relative violation that an iteration may end from
    double leave_alone;    ///< blocks of columns within it are not touched
    double most_residual;  ///< beyond it a solve has failed
  };
  struct RodsProgress {
    bool converged = true;
    double first_residual = 0.0;  ///< before the first iteration
  };
  RodsProgress solveRods(const RodsAim& aim) noexcept;
  double rodsResidual() noexcept;

  /// Largest relative violation of a string. closely: each one's is kept, for the solve; else none may pull.
  double lookAtStrings(bool closely) noexcept;
  double stringsResidual() noexcept;

  /// Directions of all links are those of the positions as they are now.
  void followDirections() noexcept;
  /// Strings pull along their directions at the start of the substep, rods as they do.
  void takeDirections(const Field3& start) noexcept;

  struct NetAim {
    double residual;  ///< the largest relative violation
    double enough;    ///< reduction of it to stop at
    double damping;   ///< Levenberg-Marquardt term, over the diagonal
    bool newton;      ///< strings leave and join within the solve
  };
  /// One step of all taut strings and contacts. The nodes move by their part of it; the rods' own solve comes next.
  void solveNet(const NetAim& aim, Contacts* contacts) noexcept;

  /// The sum of the squares of what links and contacts lack, over a link; rods_lack: of every rod, where their own
  /// solve has not converged. A damped step makes it smaller if it is short enough, where the largest may stand on a
  /// plateau.
  double merit(const Contacts* contacts, double rods_lack) noexcept;
  /// What a sweep that went wrong goes back to.
  void keepIterate(const Contacts* contacts);
  void goBack(Contacts* contacts) noexcept;

  /// Between the shortest and the longest weft link of the top row, for scale [m].
  double middleRest() const noexcept { return middle_rest_; }

  // ---- velocities (constraints_velocity.cpp)

  /// Takes out of the velocities what would change the lengths of rods and of links that pull, and what contacts
  /// forbid, from where a share of the last substep's forces between nodes leads: friction goes on as it was, and at
  /// rest nothing is left to do.
  void project(const Field3& position, const Contacts* contacts, double share, Field3& velocity) noexcept;

  // ---- columns that fall asleep and wake (constraints_hold.cpp)

  /// Before held changes: multipliers of the last substep, and 1 / scale of them [1/s^2].
  const Field& lastStrings() const noexcept { return last_weft_; }
  /// After it: these blocks were left out before. tensions: of the last substep.
  void hold(const std::vector<std::uint8_t>& skipped_before, const ClothState& state,
            NodeInertia::Tensions& tensions) noexcept;

  // ---- what a substep leaves to the next

  struct Memory {
    Field warp, weft;
    bool weft_pulls = false;

    void carry(Archive& archive);
  };
  void save(Memory& memory) const;
  void restore(const Memory& memory);
  void carry(Archive& archive);
  /// After carry() has loaded, and held and inertia are as they were.
  void resume(const ClothState& state) noexcept;

 private:
  struct Iterate {
    Field3 position;
    Field warp, weft;
    Contacts contacts;
  };
  RodsProgress solveBlock(const LineSolve& warp, const RodsAim& aim, int block) noexcept;
  void setWeftDirectionsAt(const Field3& position) noexcept;
  double measureStrings() noexcept;
  double loadStrings(Field& load) noexcept;
  void spreadForces(const LineSolve& warp, const LineSolve& weft, const Contacts* contacts, double share) noexcept;
  void layDown(int block, const ClothState& state, NodeInertia::Tensions& tensions) noexcept;
  void takeUp(int block, NodeInertia::Tensions& tensions) noexcept;
  double heaviestOf(int block, const Field& load) const noexcept;
  LineSolve rods() noexcept { return {pattern_, inertia_.inverse(), warp_, next, held_.movingSpan()}; }
  LineSolve wefts() noexcept { return {pattern_, inertia_.inverse(), weft_, next, held_.movingSpan()}; }
  template <typename Look>
  double worstOfRows(const Look& look) noexcept;
  template <typename Block>
  void forEachBlock(const Block& block) const;

  static constexpr int kRowsAtOnce = 8;

  const ClothPattern& pattern_;
  const NodeInertia& inertia_;
  const HeldColumns& held_;
  const Workers& workers_;
  NetSolver net_;
  LineScratch scratch_;
  LinkSet warp_, weft_;
  Field last_warp_, last_weft_;  // multipliers of the last accepted substep
  bool weft_pulls_ = false;      // a multiplier of last_weft_ is not zero
  bool directions_set_ = false;  // of the weft, in this substep
  bool measured_ = false;        // violation_ and active_ are of the positions as they are
  double middle_rest_;
  bool net_ready_ = false;  // of directions at the start of the substep
  Field violation_, active_, change_;
  Field free_per_square_;  // of weft links with an end that can move: 1 / rest length^2 [1/m^2]; others: 0
  std::vector<WarpMotion> block_motion_;
  std::vector<RodsProgress> block_progress_;
  std::vector<double> row_worst_;
  std::vector<double> laid_down_;  // by block: scale of the multipliers that it was left out with [s^2]
  Iterate best_;
};

// Calls run(block) for the blocks of columns in which something moves.
template <typename Block>
void Constraints::forEachBlock(const Block& run) const {
  workers_.run(warpBlockCount(pattern_.grid), [&](int block) {
    if (!held_.skips(block)) run(block);
  });
}

// Calls look(row) for all rows; the largest of what it returns.
template <typename Look>
double Constraints::worstOfRows(const Look& look) noexcept {
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
