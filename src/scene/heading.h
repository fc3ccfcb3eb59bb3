// SPDX-License-Identifier: BSD-3-Clause
//
// The top edge of pleated cloth in plan: which way each weft link of row 0 leads, from the line hang.from -> hang.to.
//
//   ripple (pencil the same, narrower)         pinch: three fingers, then flat
//      _   _   _                                  _ _ _         _ _ _
//     / \ / \ / \                                | | | |       | | | |
//    /   V   V   \                             __| |_| |_______| |_| |__
//
// The link in the middle of share t of a pleat leads by the angle a w(t), and a is so that the edge reaches from its
// beginning to its end:
//   ripple, pencil   w = cos(2 pi t): the sine-generated curve, which bends least of all of its length and span
//                    (Langbein, Leopold 1966)
//   eyelets          the same; the pole goes through it at t = 0 and 1/2, where it crosses the line
//   tabs             w = cos(pi t): half a wave from tab to tab, all to one side
//   pinch            w = sin(9 pi t) for t < 2/3, else 0
// Links keep their lengths, so that no fold is left for the second layer.
#pragma once

#include <vector>

#include "curtain_sim/scene.h"

namespace curtain {

/// The start has pleats.
bool isPleated(const HangParams& hang);

/// Pleats of a heading along so many links: hang.pleats, or as many as these links can show (ripples, and the waves of
/// eyelets, twice as wide as pencil pleats; tabs as far apart as eyelets).
int pleatCount(const HangParams& hang, int links);
/// Links that it takes to show a pleat.
int fewestLinks(Heading heading);

/// Angles [rad] from the line of the edge, one a weft link of row 0. links: their rest lengths [m]; span: distance of
/// the edge's ends [m], (0 .. sum of links].
std::vector<double> headingAngles(const HangParams& hang, const std::vector<double>& links, double span);

/// Rest lengths of the weft links of row 0 of flat cloth [m].
std::vector<double> edgeLinks(const ClothParams& cloth);

/// Lengths of the weft links that pleats are made of [m]: of the narrower edge, where top and hem differ by their
/// rounding.
std::vector<double> pleatLinks(const ClothParams& cloth);

/// Columns that the top edge hangs by: of eyelets and tabs the nearest to each, and both ends; of others all.
std::vector<int> headingColumns(const HangParams& hang, const std::vector<double>& links);

}  // namespace curtain
