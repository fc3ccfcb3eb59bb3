// SPDX-License-Identifier: BSD-3-Clause
//
// Finger pads: obstacles that press cloth against each other by a given force (ObstacleParams::press). Where a node
// lies between two of them, their two contacts become one, which is two-sided (step/contacts.h).
#pragma once

#include <vector>

#include "obstacles/obstacle_set.h"
#include "step/contacts.h"

namespace curtain {

/// Not thread-safe. Allocates only in the constructor.
class Pads {
 public:
  /// pattern and obstacles must outlive this.
  Pads(const ClothPattern& pattern, const ObstacleSet& obstacles, double thickness);

  /// Joins contacts of nodes that two pads pinch: they face each other so that friction alone keeps a force between
  /// them (both contacts have it in their friction cones: force closure, Nguyen 1988), and leave the node no more play
  /// than a node at rest may have in a contact. contacts: sorted by obstacle.
  void pinch(Contacts& contacts) noexcept;

 private:
  struct Touch {
    std::uint32_t node;
    std::size_t contact;
  };
  struct Pair {
    std::size_t first, second;  // contacts
  };
  double pressOf(const Contact& contact) const noexcept { return obstacles_.press(contact.obstacle); }
  bool closes(const Contact& a, const Contact& b) const noexcept;

  const ClothPattern& pattern_;
  const ObstacleSet& obstacles_;
  double max_play_;              // [m]
  std::vector<Touch> touches_;   // scratch
  std::vector<Pair> pairs_;      // scratch
  std::vector<double> pinched_;  // area of the cloth that it pinches, by obstacle [m^2]; scratch
};

}  // namespace curtain
