// SPDX-License-Identifier: BSD-3-Clause
#include "cloth/folds.h"

#include <algorithm>
#include <cmath>

#include "scene/pi.h"

namespace curtain {
namespace {

constexpr int kTableSize = 256;
constexpr double kTautRatio = 1.0 - 1e-12;  // chord over length above which the bow is below rounding

// Chord of a regular arc of k rods with turning angle a at every joint, over their total length:
//   sin(k a / 2) / (k sin(a / 2)), from 1 (a = 0) to 0 (a = 2 pi / k, the closed polygon).
double chordRatio(int k, double angle) {
  if (angle < 1e-9) return 1.0;
  return std::sin(0.5 * k * angle) / (k * std::sin(0.5 * angle));
}

double chordRatioSlope(int k, double angle) {
  const double half = 0.5 * angle;
  const double s = std::sin(half);
  return (0.5 * k * std::cos(k * half) * s - 0.5 * std::sin(k * half) * std::cos(half)) / (k * s * s);
}

double turningByBisection(int k, double ratio) {
  double low = 0.0;
  double high = 2.0 * kPi / k;
  for (int step = 0; step < 60; ++step) {
    const double middle = 0.5 * (low + high);
    (chordRatio(k, middle) > ratio ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

FoldShape::FoldShape(int rod_count) : rod_count_(rod_count) {
  if (rod_count_ < 2) return;
  table_.resize(kTableSize + 1);
  for (int entry = 0; entry <= kTableSize; ++entry) {
    const double s = static_cast<double>(entry) / kTableSize;
    table_[static_cast<std::size_t>(entry)] = turningByBisection(rod_count_, 1.0 - s * s);
  }
}

double FoldShape::turning(double chord_ratio) const noexcept {
  // The angle grows like sqrt(1 - ratio), so over s the table is nearly linear; two Newton steps make it exact.
  const double s = std::sqrt(1.0 - chord_ratio) * kTableSize;
  const int entry = std::min(static_cast<int>(s), kTableSize - 1);
  const double fraction = s - entry;
  const auto at = static_cast<std::size_t>(entry);
  double angle = table_[at] * (1.0 - fraction) + table_[at + 1] * fraction;
  for (int step = 0; step < 2; ++step) {
    const double slope = chordRatioSlope(rod_count_, angle);
    if (std::abs(slope) > 1e-9) angle -= (chordRatio(rod_count_, angle) - chord_ratio) / slope;
  }
  return std::clamp(angle, 0.0, 2.0 * kPi / rod_count_);
}

void FoldShape::place(const FoldArc& arc, Vec3* inner) const noexcept {
  if (rod_count_ < 2) return;
  const Vec3 chord = arc.second - arc.first;
  const double length = chord.norm();
  const double ratio = length / arc.rest;
  if (ratio >= kTautRatio || !(length > 0.0)) {
    for (int p = 1; p < rod_count_; ++p) inner[p - 1] = arc.first + chord * (static_cast<double>(p) / rod_count_);
    return;
  }
  const Vec3 along = chord / length;
  const double angle = turning(ratio);
  const double rod = arc.rest / rod_count_;
  double cosine = std::cos(0.5 * (rod_count_ - 1) * angle);
  double sine = std::sin(0.5 * (rod_count_ - 1) * angle);
  const double turn_cosine = std::cos(angle);
  const double turn_sine = std::sin(angle);
  Vec3 point = arc.first;
  for (int p = 1; p < rod_count_; ++p) {
    point += rod * (cosine * along + sine * arc.bow);
    inner[p - 1] = point;
    const double next_cosine = cosine * turn_cosine + sine * turn_sine;  // each rod turns by -angle
    sine = sine * turn_cosine - cosine * turn_sine;
    cosine = next_cosine;
  }
}

FoldArc foldArc(const Grid& grid, const Field& weft_rest, const Field3& position, const Field3& area_vectors, int row,
                int column) {
  const std::size_t right = grid.index(row, column);
  const std::size_t left = grid.index(row, column > 0 ? column - 1 : grid.columns - 1);
  FoldArc arc;
  arc.first = position.at(left);
  arc.second = position.at(right);
  arc.rest = weft_rest[right];
  const Vec3 chord = arc.second - arc.first;
  const double length_squared = chord.squaredNorm();
  // Normals of both ends: more faces than the paper's two at the link, so less sensitive to one crushed face.
  Vec3 bow = area_vectors.at(left) + area_vectors.at(right);
  if (length_squared > 0.0) bow -= chord * (bow.dot(chord) / length_squared);
  const double size = bow.norm();
  if (size > 1e-12 * arc.rest * arc.rest) {
    bow /= size;
  } else {
    bow = length_squared > 0.0 ? Vec3(chord.unitOrthogonal()) : Vec3::UnitZ();
  }
  arc.bow = column % 2 == 0 ? bow : Vec3(-bow);
  return arc;
}

}  // namespace curtain
