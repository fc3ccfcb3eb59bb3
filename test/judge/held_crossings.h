// SPDX-License-Identifier: BSD-3-Clause
//
// Crossings of what is held: pins and hands that do not give way go where they are told, through each other, too. No
// solver can prevent that, so the court does not judge the cloth that it leaves crossed.
#pragma once

#include "curtain_sim/simulator.h"

namespace curtain_test {

/// Whether two edges of held nodes, or a held node and a face of held nodes, are drawn through each other: an edge
/// then crosses a face, and four of the five nodes are held.
bool heldPartsCross(const curtain::Simulator& simulator);

}  // namespace curtain_test
