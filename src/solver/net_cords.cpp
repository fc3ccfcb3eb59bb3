// SPDX-License-Identifier: BSD-3-Clause
#include "solver/net_cords.h"

#include <algorithm>
#include <cmath>

namespace curtain {
namespace {

constexpr float kNever = 1e30F;  // as slack as no cord that may join is [1]

void addPush(std::uint32_t n, float share, float dx, float dy, float dz, NetNodes push) noexcept {
  push.x[n] += share * dx;
  push.y[n] += share * dy;
  push.z[n] += share * dz;
}

}  // namespace

void NetCords::begin(const NetContacts::Frame& frame, bool bounded) noexcept {
  damping_ = frame.damping;
  bounded_ = bounded;
  aligned_ = 0.0;
  any_ = false;
}

void NetCords::setPlace(const NetContacts::Frame& frame, const CordLink& cord, Row& row) noexcept {
  const auto grid_stride = static_cast<std::size_t>(frame.grid.stride);
  const auto placeOf = [&](std::size_t n) {
    return static_cast<std::uint32_t>(n / grid_stride * frame.stride + n % grid_stride);
  };
  row = Row();
  row.node = placeOf(cord.node);
  row.end = placeOf(cord.end);
  row.per_length = 1.0 / cord.length;
  row.dx = static_cast<float>(cord.direction.x() * row.per_length);
  row.dy = static_cast<float>(cord.direction.y() * row.per_length);
  row.dz = static_cast<float>(cord.direction.z() * row.per_length);
}

void NetCords::take(const NetContacts::Frame& frame, const CordLink& cord, float mobility, Row& row) noexcept {
  row.diagonal = mobility + frame.weight[row.end] * (row.dx * row.dx + row.dy * row.dy + row.dz * row.dz);
  if (!cord.ties || !(row.diagonal > 0.0F)) {
    row.residual = -kNever;
    return;
  }
  row.on = cord.active ? 1.0F : 0.0F;
  row.per_diagonal = 1.0F / (row.diagonal * (1.0F + damping_));
  row.residual = static_cast<float>(cord.violation * row.per_length / frame.violation_scale);
  const double per_multiplier = frame.inertia_scale / frame.violation_scale;
  row.least = static_cast<float>(-cord.multiplier * cord.length * per_multiplier);
  aligned_ += static_cast<double>(row.on * row.residual * row.residual * row.per_diagonal);
  any_ = any_ || bounded_ || cord.active;
}

void NetCords::turn(float beta, NetNodes push) noexcept {
  for (Row& row : rows_) {
    row.pull = row.on * row.residual * row.per_diagonal + beta * row.pull;
    addPush(row.node, row.pull, row.dx, row.dy, row.dz, push);
    addPush(row.end, -row.pull, row.dx, row.dy, row.dz, push);
  }
}

// A cord's pull moves its ends towards each other: the product is by how much that shortens it.
double NetCords::product(NetNodes move, NetNodes push) noexcept {
  double sum = 0.0;
  for (Row& row : rows_) {
    const std::uint32_t a = row.node, b = row.end;
    row.product = damping_ * row.diagonal * row.pull + row.dx * (move.x[a] - move.x[b]) +
                  row.dy * (move.y[a] - move.y[b]) + row.dz * (move.z[a] - move.z[b]);
    sum += static_cast<double>(row.product * row.pull);
    for (const std::uint32_t n : {a, b}) push.x[n] = push.y[n] = push.z[n] = 0.0F;
  }
  return sum;
}

double NetCords::advance(float alpha) noexcept {
  float largest = 0.0F;
  aligned_ = 0.0;
  for (Row& row : rows_) {
    row.solution += alpha * row.pull;
    row.residual -= alpha * row.product;
    largest = std::max(largest, row.on * std::abs(row.residual));
    aligned_ += static_cast<double>(row.on * row.residual * row.residual * row.per_diagonal);
  }
  return static_cast<double>(largest);
}

int NetCords::countChanges(float goal) const noexcept {
  return static_cast<int>(std::count_if(rows_.begin(), rows_.end(), [goal](const Row& row) {
    return row.on > 0.0F ? row.solution < row.least : row.residual > goal;
  }));
}

int NetCords::changeSet(float goal, NetNodes push) noexcept {
  int leave = 0;
  aligned_ = 0.0;
  for (Row& row : rows_) {
    row.pull = 0.0F;
    if (row.on > 0.0F && row.solution < row.least) {
      row.pull = row.least - row.solution;
      row.on = 0.0F;
      ++leave;
      addPush(row.node, row.pull, row.dx, row.dy, row.dz, push);
      addPush(row.end, -row.pull, row.dx, row.dy, row.dz, push);
    } else if (!(row.on > 0.0F) && row.residual > goal) {
      row.on = 1.0F;
    }
    aligned_ += static_cast<double>(row.on * row.residual * row.residual * row.per_diagonal);
  }
  return leave;
}

void NetCords::conclude(NetNodes push) noexcept {
  for (Row& row : rows_) {
    row.solution = std::max(row.solution, row.least);
    addPush(row.node, row.solution, row.dx, row.dy, row.dz, push);
    addPush(row.end, -row.solution, row.dx, row.dy, row.dz, push);
  }
}

}  // namespace curtain
