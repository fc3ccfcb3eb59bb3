// SPDX-License-Identifier: BSD-3-Clause
//
// Carriers on a rail, in the solve. A carrier is a node of the top row with one freedom, its place s along the rail:
// x = gamma(s), and since |gamma'| = 1, the mass that belongs to s is that of node and carrier, on arcs too. A force f
// moves it by w (f . tangent): its inverse inertia is the matrix w tangent tangent^T (GuidedNodes).
//
// What a loop over nodes moved it by counts along the tangent only, as a change of the wished place, where a carrier
// would be without the rail's forces, and RailLaw says where it is. So it is on the rail whatever happens.
#pragma once

#include <algorithm>
#include <vector>

#include "cloth/cloth.h"
#include "parts/rail/rail_law.h"
#include "step/guide_part.h"

namespace curtain {

/// Where the masters are to be drawn. In a substep they move towards their goals by their speed at most.
struct RailDrive {
  bool draws = false;
  double speed = 0.0;        ///< [m/s], > 0
  double force = 0.0;        ///< on each master, at most [N], >= 0
  std::vector<double> goal;  ///< of the masters [m]
};

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
};

/// Not thread-safe; blocks of columns may settle() in parallel. Allocates only in the constructor.
class Carriers final : public GuidePart {
 public:
  /// pattern must outlive this.
  explicit Carriers(const ClothPattern& pattern);

  bool any() const noexcept { return !pattern_.rail.empty(); }
  const std::vector<Carrier>& all() const noexcept { return all_; }
  std::size_t node(const Carrier& carrier) const noexcept { return static_cast<std::size_t>(carrier.column); }

  // ---- A substep

  void setDrive(const RailDrive& drive) { drive_ = drive; }
  const RailDrive& drive() const noexcept { return drive_; }

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
  /// Force of the drive on all masters in the last substep [N]; 0: none draws.
  double driveForce() const noexcept;
  double energy() const noexcept override;
  double work(const Field3& before, const Field3& after, double kick) const noexcept override;

  // ---- Velocities at the places of the last accepted substep

  /// Velocities [m/s] that forces have changed for `age` [s]: as the rail lets them; before: without the change.
  void beginRates(const ClothState& state, double age, Field3& velocity) noexcept override;
  void settleVelocities(int first, int end, Field3& velocity) noexcept override;
  /// Those that push each other move as one.
  void settleRates(Field3& velocity) noexcept override;

  /// What a substep leaves to the next.
  struct Memory {
    std::vector<std::uint8_t> stays;  ///< it stayed
    std::vector<std::uint8_t> joins;  ///< it pushed the next one
    std::vector<double> force;        ///< of the rail, along it [N]
    std::vector<double> drawn;        ///< of the drive [N]

    void carry(Archive& archive);
  };
  Memory& memory() noexcept { return memory_; }
  const Memory& memory() const noexcept { return memory_; }
  void save(std::vector<double>& memory) const override;
  void restore(const std::vector<double>& memory) noexcept override;
  void forget() noexcept override;

 private:
  const Carrier* from(int column) const noexcept {
    return std::lower_bound(all_.data(), all_.data() + all_.size(), column,
                            [](const Carrier& carrier, int at) { return carrier.column < at; });
  }
  void put(std::size_t k, double place, Field3& position) noexcept;
  void setFreedom(std::size_t k) noexcept;
  void bindFriction(std::size_t k, const Vec3& force) noexcept;

  const ClothPattern& pattern_;
  std::vector<Carrier> all_;
  std::vector<std::uint8_t> adjacent_;  // a neighbouring column has one too
  std::vector<RailRow> rows_;           // wishes and places
  RailLaw law_;
  RailDrive drive_;
  double step_ = 0.0;    // of the substep [s]
  double scale_ = 0.0;   // step times kick [s^2]
  bool stands_ = false;  // nothing moves a carrier in this substep
  Memory memory_;
};

}  // namespace curtain
