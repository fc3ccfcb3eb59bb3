// SPDX-License-Identifier: BSD-3-Clause
#include "solver/net_contacts.h"

#include <algorithm>
#include <cmath>

#include "solver/constants.h"

namespace curtain {
namespace {

// Any orthonormal pair across the normal will do, but always the same for the same normal.
void tangents(const Vec3& normal, Vec3& first, Vec3& second) {
  int smallest = 0;
  normal.cwiseAbs().minCoeff(&smallest);
  first = normal.cross(Vec3::Unit(smallest)).normalized();
  second = normal.cross(first);
}

}  // namespace

void NetContacts::addRow(const Frame& frame, std::uint32_t index, const Contact& contact, const Vec3& direction,
                         double wanted, bool normal) {
  Row row{};
  row.contact = index;
  row.nodes = contact.nodes;
  row.normal = normal;
  row.dx = static_cast<float>(direction.x());
  row.dy = static_cast<float>(direction.y());
  row.dz = static_cast<float>(direction.z());
  const auto grid_stride = static_cast<std::uint32_t>(frame.grid.stride);
  for (int k = 0; k < contact.nodes; ++k) {
    const auto at = static_cast<std::size_t>(k);
    row.node[at] =
        contact.node[at] / grid_stride * static_cast<std::uint32_t>(frame.stride) + contact.node[at] % grid_stride;
    row.weight[at] = static_cast<float>(contact.weight[at]);
    row.diagonal += row.weight[at] * row.weight[at] * frame.weight[row.node[at]];
  }
  if (!(row.diagonal > 0.0F)) return;  // no node of it can move
  row.per_diagonal = 1.0F / (row.diagonal * (1.0F + damping_));
  row.residual = static_cast<float>(wanted / frame.violation_scale);
  aligned_ += static_cast<double>(row.residual * row.residual * row.per_diagonal);
  rows_.push_back(row);
}

void NetContacts::load(const Frame& frame, const ContactValues& values) {
  rows_.clear();
  aligned_ = 0.0;
  if (values.contacts == nullptr) return;
  damping_ = std::max(frame.damping, kLeastDamping);
  const Contacts& contacts = *values.contacts;
  const bool rates = values.rates;
  for (std::uint32_t index = 0; index < contacts.size(); ++index) {
    const Contact& contact = contacts[index];
    const Vec3 point = contact.point(*values.value);
    const double entered =
        rates ? contact.normal.dot(contact.surface_velocity - point) : contact.offset - contact.normal.dot(point);
    if (!contact.pushes() && (rates || entered <= 0.0)) continue;
    addRow(frame, index, contact, contact.normal, entered, true);
    if (!contact.sticks) continue;
    const Vec3 back = rates ? Vec3(contact.surface_velocity - point) : Vec3(contact.carried - point);
    Vec3 first, second;
    tangents(contact.normal, first, second);
    addRow(frame, index, contact, first, first.dot(back), false);
    addRow(frame, index, contact, second, second.dot(back), false);
  }
}

void NetContacts::turn(float beta, NetNodes push) noexcept {
  for (Row& row : rows_) {
    row.pull = row.residual * row.per_diagonal + beta * row.pull;
    for (int k = 0; k < row.nodes; ++k) {
      const auto at = static_cast<std::size_t>(k);
      const float share = row.pull * row.weight[at];
      push.x[row.node[at]] += share * row.dx;
      push.y[row.node[at]] += share * row.dy;
      push.z[row.node[at]] += share * row.dz;
    }
  }
}

double NetContacts::product(NetNodes move, NetNodes push) noexcept {
  double sum = 0.0;
  for (Row& row : rows_) {
    float along = damping_ * row.diagonal * row.pull;
    for (int k = 0; k < row.nodes; ++k) {
      const auto at = static_cast<std::size_t>(k);
      const std::uint32_t node = row.node[at];
      along += row.weight[at] * (row.dx * move.x[node] + row.dy * move.y[node] + row.dz * move.z[node]);
      push.x[node] = push.y[node] = push.z[node] = 0.0F;
    }
    row.product = along;
    sum += static_cast<double>(along * row.pull);
  }
  return sum;
}

double NetContacts::advance(float alpha) noexcept {
  float largest = 0.0F;
  aligned_ = 0.0;
  for (Row& row : rows_) {
    row.solution += alpha * row.pull;
    row.residual -= alpha * row.product;
    largest = std::max(largest, std::abs(row.residual));
    aligned_ += static_cast<double>(row.residual * row.residual * row.per_diagonal);
  }
  return static_cast<double>(largest);
}

}  // namespace curtain
