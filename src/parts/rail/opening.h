// SPDX-License-Identifier: BSD-3-Clause
//
// The opening of a curtain on a rail: what is asked of the drive, and where its masters are. Once asked, the drive
// draws the masters to their places and keeps them there, with its force at most, until it lets go.
#pragma once

#include "cloth/archive.h"
#include "curtain_sim/scene.h"
#include "curtain_sim/statistics.h"
#include "parts/rail/carriers.h"

namespace curtain {

/// Not thread-safe.
class Opening {
 public:
  /// All arguments must outlive this.
  Opening(const Scene& scene, const ClothPattern& pattern, Carriers& carriers);

  /// Lets go, and draws as the scene says from now on.
  void reset();
  /// Draws the masters to this opening [0..1].
  void draw(double opening);
  void letGo();
  void setDrive(const DriveParams& drive);

  bool draws() const noexcept { return draws_; }
  double goal() const noexcept { return goal_; }
  const DriveParams& drive() const noexcept { return drive_; }

  /// It draws a master that has not arrived.
  bool isUnderWay(const ClothState& state) const noexcept;
  /// Writes the present opening; with a rail only.
  void measure(const ClothState& state, Statistics& statistics) const noexcept;

  void carry(Archive& archive);
  /// After carry() has loaded.
  void resume() { take(); }

 private:
  void take();

  const Scene& scene_;
  const ClothPattern& pattern_;
  Carriers& carriers_;
  bool draws_ = false;
  double goal_ = 0.0;
  DriveParams drive_;
};

}  // namespace curtain
