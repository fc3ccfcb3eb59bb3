// SPDX-License-Identifier: BSD-3-Clause
#include "scene/heading.h"

#include <algorithm>
#include <cmath>

#include "scene/pi.h"
#include "scene/shares.h"

namespace curtain {
namespace {

// w(t), with t in pleats.
double turn(Heading heading, double t) {
  const double share = t - std::floor(t);
  if (heading == Heading::kTabs) return std::cos(kPi * share);
  if (heading != Heading::kPinch) return std::cos(2.0 * kPi * share);
  return share < 2.0 / 3.0 ? std::sin(9.0 * kPi * share) : 0.0;
}

struct Chord {
  double along = 0.0, across = 0.0;
  double length() const { return std::sqrt(along * along + across * across); }  // hypot differs between C libraries
};

Chord chordOf(const std::vector<double>& links, const std::vector<double>& turns, double size) {
  Chord chord;
  for (std::size_t j = 0; j < links.size(); ++j) {
    chord.along += links[j] * std::cos(size * turns[j]);
    chord.across += links[j] * std::sin(size * turns[j]);
  }
  return chord;
}

}  // namespace

bool isPleated(const HangParams& hang) { return hang.heading != Heading::kGathered; }

int fewestLinks(Heading heading) {
  switch (heading) {
    case Heading::kPinch:
      return 9;
    case Heading::kTabs:
      return 2;
    default:
      return 4;
  }
}

int pleatCount(const HangParams& hang, int links) {
  if (hang.pleats > 0) return hang.pleats;
  const bool wide = hang.heading == Heading::kRipple || hang.heading == Heading::kEyelets;
  const int usual = wide ? 8 : hang.heading == Heading::kTabs ? 4 : fewestLinks(hang.heading);
  return std::max(links / usual, 1);
}

// The chord gets shorter with the size of the turns up to a turn there and back, where it is shortest; bisection.
std::vector<double> headingAngles(const HangParams& hang, const std::vector<double>& links, double span) {
  const int pleats = pleatCount(hang, static_cast<int>(links.size()));
  double length = 0.0;
  for (const double link : links) length += link;
  std::vector<double> turns;
  double along = 0.0;
  for (const double link : links) {
    turns.push_back(turn(hang.heading, pleats * (along + 0.5 * link) / length));
    along += link;
  }
  double least = 0.0, most = kPi;
  constexpr int kHalvings = 60;  // to the last bit
  for (int k = 0; k < kHalvings; ++k) {
    const double size = 0.5 * (least + most);
    (chordOf(links, turns, size).length() > span ? least : most) = size;
  }
  const Chord chord = chordOf(links, turns, least);
  const double aside = std::atan2(chord.across, chord.along);
  for (double& angle : turns) angle = least * angle - aside;
  return turns;
}

std::vector<double> edgeLinks(const ClothParams& cloth) {
  return shareOut(cloth.width, cloth.column_spacing, cloth.columns - 1);
}

std::vector<double> pleatLinks(const ClothParams& cloth) {
  return shareOut(std::min(cloth.width, hemWidth(cloth)), cloth.column_spacing, cloth.columns - 1);
}

std::vector<int> headingColumns(const HangParams& hang, const std::vector<double>& links) {
  const int last = static_cast<int>(links.size());
  std::vector<int> columns;
  const int per_pleat = hang.heading == Heading::kEyelets ? 2 : hang.heading == Heading::kTabs ? 1 : 0;
  if (per_pleat == 0) {
    for (int column = 0; column <= last; ++column) columns.push_back(column);
    return columns;
  }
  double length = 0.0, along = 0.0;
  for (const double link : links) length += link;
  const double apart = length / (per_pleat * pleatCount(hang, last));
  int next = 0;  // place of the next one, in their distances
  for (int column = 0; column <= last; ++column) {
    const double ahead = column < last ? links[static_cast<std::size_t>(column)] : length;
    if (along + 0.5 * ahead > next * apart || column == last) columns.push_back(column);
    while (next * apart < along + 0.5 * ahead) ++next;
    along += ahead;
  }
  return columns;
}

}  // namespace curtain
