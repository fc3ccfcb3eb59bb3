// SPDX-License-Identifier: BSD-3-Clause
#include "rviz/surface/layers.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace curtain_rviz {
namespace {

constexpr double kForget = 4.0;     // [s] in which the range's end falls to 1/e
constexpr double kMinRange = 1e-6;  // so that rounding noise of cloth at rest is not spread over all colours

using Nodes = std::vector<float>;

float norm(const Nodes& flat, std::size_t node) {
  return std::hypot(flat[3 * node], flat[3 * node + 1], flat[3 * node + 2]);
}

float distance(const Nodes& flat, std::size_t a, std::size_t b) {
  return std::hypot(flat[3 * a] - flat[3 * b], flat[3 * a + 1] - flat[3 * b + 1], flat[3 * a + 2] - flat[3 * b + 2]);
}

void raise(float& value, float to) { value = std::max(value, to); }

void strains(const curtain_sim::CurtainState& state, Nodes& out) {
  const std::size_t rows = state.rows, columns = state.columns, links = state.closed ? columns : columns - 1;
  const auto link = [&](std::size_t a, std::size_t b, float rest) {
    const float percent = 100.0F * (distance(state.positions, a, b) / rest - 1.0F);
    raise(out[a], percent);
    raise(out[b], percent);
  };
  std::vector<std::size_t> cut_from(columns, rows);  // of the link on the right of each column
  for (std::size_t k = 0; k < state.slit_columns.size(); ++k) {
    if (state.slit_columns[k] < columns) cut_from[state.slit_columns[k]] = state.slit_rows[k];
  }
  for (std::size_t i = 0; i < rows; ++i) {
    for (std::size_t j = 0; j < columns; ++j) {
      const std::size_t n = i * columns + j;
      if (i > 0) link(n - columns, n, state.warp_rest[i - 1]);
      if (j < links && i < cut_from[j]) link(n, i * columns + (j + 1) % columns, state.weft_rest[i * links + j]);
    }
  }
}

// Each link's tension is stored at its lower or right node.
void tensions(const curtain_sim::CurtainState& state, const curtain_sim::Loads& loads, Nodes& out) {
  const std::size_t columns = state.columns;
  for (std::size_t n = 0; n < out.size(); ++n) {
    const std::size_t row = n / columns, column = n % columns;
    const float warp = std::abs(loads.warp_tension[n]), weft = std::abs(loads.weft_tension[n]);
    raise(out[n], std::max(warp, weft));
    if (row > 0) raise(out[n - columns], warp);
    raise(out[column > 0 ? n - 1 : n + columns - 1], weft);
  }
}

}  // namespace

LayerText textOf(Layer layer) {
  switch (layer) {
    case Layer::kSpeed:
      return {"Speed", "m/s"};
    case Layer::kStrain:
      return {"Strain", "%"};
    case Layer::kTension:
      return {"Tension", "N"};
    case Layer::kContact:
      return {"Contact force", "N"};
    case Layer::kPlain:
      break;
  }
  return {"Plain", ""};
}

void valuesOf(Layer layer, const curtain_sim::CurtainState& state, const curtain_sim::Loads* loads, Nodes& out) {
  out.assign(std::size_t{state.rows} * state.columns, 0.0F);
  switch (layer) {
    case Layer::kSpeed:
      for (std::size_t n = 0; n < out.size(); ++n) out[n] = norm(state.velocities, n);
      break;
    case Layer::kStrain:
      strains(state, out);
      break;
    case Layer::kTension:
      tensions(state, *loads, out);
      break;
    case Layer::kContact:
      for (std::size_t n = 0; n < out.size(); ++n) out[n] = norm(loads->contact_forces, n);
      break;
    case Layer::kPlain:
      break;
  }
}

double LayerRange::follow(const std::vector<float>& values, double seconds) {
  const double largest = values.empty() ? 0.0 : *std::max_element(values.begin(), values.end());
  peak_ = std::max({peak_ * std::exp(-seconds / kForget), largest, kMinRange});
  return roundUp(peak_);
}

double roundUp(double x) {
  const double power = std::pow(10.0, std::floor(std::log10(x)));
  for (const double step : {1.0, 2.0, 5.0}) {
    if (x <= step * power * (1.0 + 1e-9)) return step * power;
  }
  return 10.0 * power;
}

std::string legendNumber(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", x);
  return text;
}

}  // namespace curtain_rviz
