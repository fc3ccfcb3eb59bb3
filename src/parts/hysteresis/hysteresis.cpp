// SPDX-License-Identifier: BSD-3-Clause
#include "parts/hysteresis/hysteresis.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "cloth/archive.h"

namespace curtain {
namespace {

// Stiffness of a slider, before it slips, over that of its joint: chosen. So a loop turns round within a tenth of
// 2HB / B; stiffer ones ask for shorter steps.
constexpr double kSlider = 10.0;
// Joints that share a node: three of its warp line, and three of its weft line.
constexpr double kJointsOfANode = 6.0;

}  // namespace

Hysteresis::Hysteresis(const Layers& layers, const ClothPattern& pattern) : pattern_(pattern), layers_(layers) {
  if (!layers.anyFabric([](const Fabric& fabric) { return fabric.bending_hysteresis > 0.0; })) return;
  const std::size_t size = pattern.grid.size();
  slips_.assign(2 * size, 0.0);
  sliders_.reserve(2 * size);
  for (Field* const field : {&warp_length_, &weft_length_}) field->assign(size, 0.0);
  assign(size);
  startSlips();
  fill();
}

// As its cloth lay where nothing bends it.
void Hysteresis::startSlips() noexcept {
  const std::size_t size = slips_.size() / 2;  // none where nothing rubs
  for (std::size_t n = 0; n < size; ++n) {
    slips_[n] = pattern_.warp_rest_turn.empty() ? 0.0 : std::sin(pattern_.warp_rest_turn[n]);
    slips_[size + n] = pattern_.weft_rest_turn.empty() ? 0.0 : std::sin(pattern_.weft_rest_turn[n]);
  }
}

// A joint's own frequency bounds that of all of them, each with its share of the nodes' masses (Irons, Treharne 1971).
void Hysteresis::fill() noexcept {
  const Grid& grid = pattern_.grid;
  sliders_.clear();
  omega_squared_ = 0.0;
  fillTurningLengths(pattern_, warp_length_, weft_length_);
  const auto visit = [&](bool warp, const Field& stiffness, const Field& length, double Fabric::*rigidity) {
    for (int i = 0; i < grid.rows && !stiffness.empty(); ++i) {
      for (int j = 0; j < grid.columns; ++j) {
        const std::size_t n = grid.index(i, j);
        if (stiffness[n] == 0.0) continue;
        const Fabric fabric = layers_.fabricAt(i, j);
        if (!(fabric.bending_hysteresis > 0.0)) continue;
        Slider slider;
        slider.joint = turningJoint(pattern_, warp, i, j);
        slider.slip = warp ? n : grid.size() + n;
        slider.stiffness = kSlider * stiffness[n];
        const double width = stiffness[n] * length[n] / (fabric.*rigidity);
        slider.most = 0.5 * fabric.bending_hysteresis * width;
        const double a = slider.joint.per_before, b = slider.joint.per_after;
        const Field& mass = pattern_.mass;
        const double per_mass =
            a * a / mass[slider.joint.before] + (a + b) * (a + b) / mass[n] + b * b / mass[slider.joint.after];
        omega_squared_ = std::max(omega_squared_, kJointsOfANode * slider.stiffness * per_mass);
        sliders_.push_back(slider);
      }
    }
  };
  visit(true, pattern_.warp_bending, warp_length_, &Fabric::bending_warp);
  visit(false, pattern_.weft_bending, weft_length_, &Fabric::bending_weft);
}

void Hysteresis::pinsChanged() noexcept {
  if (any()) fill();
}

void Hysteresis::reset(ClothState&) { startSlips(); }

void Hysteresis::placed(const ClothState&, ClothState& state) noexcept { commit(state.position); }

void Hysteresis::addOwn(const Field3& position, Field3& sum) noexcept {
  for (const Slider& slider : sliders_) {
    const Turn turn = turnOf(slider.joint, position);
    const double moment = std::clamp(slider.stiffness * (turn.sine - slips_[slider.slip]), -slider.most, slider.most);
    addCouple(slider.joint, turn, -share() * moment, sum);
  }
}

double Hysteresis::energyAt(const Field3& position) const noexcept {
  double energy = 0.0;
  for (const Slider& slider : sliders_) {
    const double moment = slider.stiffness * std::abs(turnOf(slider.joint, position).sine - slips_[slider.slip]);
    const double held = std::min(moment, slider.most);
    energy += held * (moment - 0.5 * held) / slider.stiffness;
  }
  return share() * energy;
}

double Hysteresis::commit(const Field3& position) noexcept {
  double taken = 0.0;
  for (const Slider& slider : sliders_) {
    double& slip = slips_[slider.slip];
    const double sine = turnOf(slider.joint, position).sine, reach = slider.most / slider.stiffness;
    const double slipped = std::clamp(slip, sine - reach, sine + reach);
    taken += slider.most * std::abs(slipped - slip);
    slip = slipped;
  }
  return share() * taken;
}

void Hysteresis::save(std::vector<double>& memory) const { memory.insert(memory.end(), slips_.begin(), slips_.end()); }

const double* Hysteresis::restore(const double* memory) noexcept {
  std::copy(memory, memory + slips_.size(), slips_.begin());
  return memory + slips_.size();
}

void Hysteresis::serialize(Archive& archive) { archive.finite("slips", slips_); }

bool Hysteresis::explain(const ClothState&, double, Plan& plan) const {
  std::ostringstream text;
  if (any())
    text << listOf(layers_, [](const Fabric& fabric) { return fabric.bending_hysteresis; }) << " N"
         << (share() < 1.0 ? ", of which the substeps bear a part" : "");
  else
    text << "cloth.bending_hysteresis is 0";
  plan.push_back({"hysteresis", any(), text.str()});
  return false;
}

}  // namespace curtain
