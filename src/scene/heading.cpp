// SPDX-License-Identifier: BSD-3-Clause
#include "scene/heading.h"

#include <algorithm>
#include <cmath>

#include "scene/pi.h"

namespace curtain {
namespace {

// w(t), with t in pleats.
double turn(Heading heading, double t) {
  const double share = t - std::floor(t);
  if (heading != Heading::kPinch) return std::cos(2.0 * kPi * share);
  return share < 2.0 / 3.0 ? std::sin(9.0 * kPi * share) : 0.0;
}

struct Chord {
  double along = 0.0, across = 0.0;
  double length() const { return std::hypot(along, across); }
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

int fewestLinks(Heading heading) { return heading == Heading::kPinch ? 9 : 4; }

int pleatCount(const HangParams& hang, int links) {
  return hang.pleats > 0 ? hang.pleats
                         : std::max(links / (hang.heading == Heading::kRipple ? 8 : fewestLinks(hang.heading)), 1);
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

}  // namespace curtain
