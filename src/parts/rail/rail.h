// SPDX-License-Identifier: BSD-3-Clause
//
// The rails of curtains: their carriers, in the solve, and what is asked of their drives. A carrier is a node of the
// top row with one freedom, its place s along the rail: x = gamma(s), and since |gamma'| = 1, the mass that belongs to
// s is that of node and carrier, on arcs too. A force f moves it by w (f . tangent): its inverse inertia is the matrix
// w tangent tangent^T (GuidedNodes).
//
// Each carrier has a wished place: where it would be without the rail's forces. When a loop over all nodes has moved
// the carrier's node, the part of that move along the tangent is added to the wished place, and RailLaw finds the place
// from it. So a carrier is on the rail whatever happens.
//
// Once asked, the drive draws the masters to their places and keeps them there, with its force at most, until it lets
// go. In a substep they move towards their goals by its speed at most.
#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "curtain_sim/scene.h"
#include "parts/rail/rail_law.h"
#include "step/guide_part.h"
#include "step/part.h"

namespace curtain {

/// A carrier during a solve.
struct Carrier {
  int column = 0;
  Vec3 along = Vec3::UnitX();  ///< tangent that forces act along: where the links' directions are from
  Vec3 now = Vec3::UnitX();    ///< tangent at its place
  Vec3 point = Vec3::Zero();   ///< of the rail at its place [m]
  double inverse = 0.0;        ///< w [1/kg]
  double mobility = 0.0;       ///< w, or 0: it stays whatever the links change
  bool moved = false;    ///< it did not stay as first found: from now on its mobility is w, so that the solve ends
  double began = 0.0;    ///< place that the substep starts from [m]
  double entered = 0.0;  ///< speed along the rail that it starts with [m/s]
  double speed = 0.0;    ///< along the rail, while velocities are projected [m/s]
  // Of the last accepted substep.
  bool stays = true;   ///< it stayed
  bool joins = false;  ///< it pushed the next one
  double force = 0.0;  ///< of the rail, along it [N]
  double drawn = 0.0;  ///< of the drive [N]
};

/// Does nothing where the pattern has no rail. Not thread-safe, but for settlePositions() and settleVelocities().
/// Allocates in the constructor and in what users ask.
class Rail final : public GuidePart, public Part {
 public:
  /// scene and pattern must outlive this.
  Rail(const Scene& scene, const ClothPattern& pattern);

  bool any() const noexcept { return !pattern_.rails.empty(); }

  /// What is asked of a drive.
  struct Asked {
    bool draws = false;
    double opening = 0.0;  ///< to draw the masters to [0..1]
    DriveParams drive;
  };
  /// Number of the rail that a cloth (Layers) hangs from; none: it hangs from none.
  std::optional<std::size_t> railOf(std::size_t layer) const noexcept;
  void ask(std::size_t rail, const Asked& asked);
  const Asked& asked(std::size_t rail) const noexcept { return tracks_[rail].asked; }
  /// Of a rail's drive on all its masters, mean over the last frame [N].
  double driveForce(std::size_t rail) const noexcept { return tracks_[rail].force; }
  /// Present opening of a rail.
  double openingOf(std::size_t rail, const ClothState& state) const noexcept;

  /// Lets go, and draws as the scene says from now on.
  void reset(ClothState& state) override;
  void placed(const ClothState& before, ClothState& state) noexcept override;
  void serialize(Archive& archive) override;
  void resume() override;
  /// Writes the present opening of the first cloth.
  void measure(const ClothState& state, Statistics& statistics) const noexcept override;
  bool explain(const ClothState& state, double time, Plan& plan) const override;
  /// It draws a master that has not arrived.
  bool isUnderWay(const ClothState& state) const noexcept override;
  bool drives(const ClothState&) const noexcept override;
  bool reversible() const noexcept override { return !any(); }
  bool beginFrame(const FrameBegin&, ClothState&) noexcept override {
    for (Track& track : tracks_) track.impulse = 0.0;
    return false;
  }
  void substepDone(const SubstepMade& made) noexcept override;
  bool endFrame(const FrameEnd& end, ClothState& state) noexcept override;

  // ---- A substep, of the carriers

  void begin(const SubstepStart& start, const ClothState& state, const Field& inverse) noexcept override;
  bool moves() const noexcept override { return any() && !stands_; }
  /// Each by itself, without the law.
  void settlePositions(int first, int end, Field3& position) noexcept override;
  /// After loops over all nodes: all together. True: a mobility has changed.
  bool settle(Field3& position) noexcept override;
  /// Sets the bound of friction.
  void press(const NodeForce& force) noexcept override;
  void followDirections() noexcept override;
  void commit(ClothState& state) noexcept override;
  double energy() const noexcept override;
  double work(const Field3& before, const Field3& after, double kick) const noexcept override;

  // ---- Velocities at the places of the last accepted substep

  /// Velocities [m/s] that forces have changed for `age` [s]: as the rail lets them; before: without the change.
  void beginRates(const ClothState& state, double age, Field3& velocity) noexcept override;
  void settleVelocities(int first, int end, Field3& velocity) noexcept override;
  /// Those that push each other move as one.
  void settleRates(Field3& velocity) noexcept override;

  // ---- What a substep leaves to the next

  void save(std::vector<double>& memory) const override;
  void restore(const std::vector<double>& memory) noexcept override;
  void forget() noexcept override;

 private:
  const Carrier* from(int column) const noexcept {
    return std::lower_bound(all_.data(), all_.data() + all_.size(), column,
                            [](const Carrier& carrier, int at) { return carrier.column < at; });
  }
  // A rail and its carriers, [first, end) of all.
  struct Track {
    const RailPattern& rail;
    std::size_t first, end;
    RailLaw law;
    Asked asked;
    std::vector<double> goal;  // places that the masters are drawn to [m]
    double impulse = 0.0;      // of the drive in this frame [N s]
    double force = 0.0;        // mean over the last frame [N]
  };
  const DriveParams& driveOf(const Track& track) const noexcept;
  bool hasArrived(const Track& track, const ClothState& state) const noexcept;
  const RailPath& pathOf(std::size_t k) const noexcept { return tracks_[track_of_[k]].rail.path; }
  // Its column is taut (TautColumns).
  bool isHeld(std::size_t k) const noexcept { return pattern_.pinned[node(all_[k])] == kHeld; }
  bool isFastened(std::size_t k) const noexcept { return fastened_[k] != 0 || isHeld(k); }
  void put(std::size_t k, double place, Field3& position) noexcept;
  void setFreedom(std::size_t k) noexcept;
  void bindFriction(std::size_t k, const Vec3& force) noexcept;

  std::size_t node(const Carrier& carrier) const noexcept { return static_cast<std::size_t>(carrier.column); }

  const Scene& scene_;
  const ClothPattern& pattern_;
  std::vector<Carrier> all_;
  std::vector<std::uint8_t> adjacent_;  // a neighbouring column has one too
  std::vector<RailRow> rows_;           // wishes and places
  std::vector<Track> tracks_;
  std::vector<std::size_t> track_of_;   // by carrier
  std::vector<std::uint8_t> fastened_;  // the same
  double step_ = 0.0;                   // of the substep [s]
  double scale_ = 0.0;                  // step times kick [s^2]
  bool stands_ = false;                 // nothing moves a carrier in this substep
};

}  // namespace curtain
