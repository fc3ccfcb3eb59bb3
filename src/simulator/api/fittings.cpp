// SPDX-License-Identifier: BSD-3-Clause
//
// The public interface of what cloth hangs by: pins, rail, lines and tie-backs.
#include <algorithm>
#include <cmath>

#include "scene/problem_log.h"
#include "scene/ranges.h"
#include "scene/scalar.h"
#include "scene/sources.h"
#include "simulator/simulator_impl.h"

namespace curtain {

namespace {

// Number of the rail that the cloth of this name hangs from.
std::optional<std::size_t> railOf(const Motion& motion, const std::string& layer) {
  if (layer == kFirstCloth) return motion.parts.rail.railOf(0);
  const std::vector<LayerParams>& layers = motion.scene.layers;
  for (std::size_t k = 0; k < layers.size(); ++k) {
    if (layers[k].name == layer) return motion.parts.rail.railOf(k + 1);
  }
  return std::nullopt;
}

std::string whyNoRail(const Scene& scene, const std::string& layer) {
  if (layer == kFirstCloth) return "is for cloth on a rail: this scene has no rail.path";
  const bool known =
      std::any_of(scene.layers.begin(), scene.layers.end(), [&](const LayerParams& one) { return one.name == layer; });
  return known ? "is for cloth on a rail: layer " + quoted(layer) + " has no rail.path"
               : "is of a layer that there is not: " + quoted(layer);
}

}  // namespace

std::vector<Simulator::LayerColumns> Simulator::layers() const {
  std::vector<LayerColumns> all;
  for (const Layers::Layer& layer : impl_->motion.parts.layers) {
    const std::size_t number = all.size();
    all.push_back(
        {number == 0 ? kFirstCloth : impl_->scene.layers[number - 1].name, layer.first, layer.end - layer.first});
  }
  return all;
}

std::vector<Problem> Simulator::setOpening(double opening, const std::string& layer) {
  const std::optional<std::size_t> rail = railOf(impl_->motion, layer);
  if (!rail) return {{"opening", whyNoRail(impl_->scene, layer)}};
  const Range range = between(0.0, 1.0);
  if (!range.contains(opening)) return {{"opening", "must be " + range.text() + ", is " + formatNumber(opening)}};
  const Rail::Asked& asked = impl_->motion.parts.rail.asked(*rail);
  if (asked.draws && opening == asked.opening) return {};
  impl_->motion.parts.rail.ask(*rail, {true, opening, asked.drive});
  impl_->driven();
  return {};
}

double Simulator::opening(const std::string& layer) const {
  const std::optional<std::size_t> rail = railOf(impl_->motion, layer);
  return rail ? impl_->motion.parts.rail.openingOf(*rail, impl_->motion.state) : 0.0;
}

double Simulator::driveForce(const std::string& layer) const {
  const std::optional<std::size_t> rail = railOf(impl_->motion, layer);
  return rail ? impl_->motion.parts.rail.driveForce(*rail) : 0.0;
}

void Simulator::releaseDrive(const std::string& layer) {
  const std::optional<std::size_t> rail = railOf(impl_->motion, layer);
  if (!rail || !drives(layer)) return;
  const Rail::Asked& asked = impl_->motion.parts.rail.asked(*rail);
  impl_->motion.parts.rail.ask(*rail, {false, asked.opening, asked.drive});
  impl_->driven();
}

std::vector<Problem> Simulator::setDrive(const DriveParams& drive, const std::string& layer) {
  std::vector<Problem> problems = validate(drive, "drive");
  const std::optional<std::size_t> rail = railOf(impl_->motion, layer);
  if (problems.empty() && !rail) problems = {{"drive", whyNoRail(impl_->scene, layer)}};
  if (!problems.empty()) return problems;
  const Rail::Asked& asked = impl_->motion.parts.rail.asked(*rail);
  impl_->motion.parts.rail.ask(*rail, {asked.draws, asked.opening, drive});
  impl_->driven();
  return problems;
}

bool Simulator::drives(const std::string& layer) const {
  const std::optional<std::size_t> rail = railOf(impl_->motion, layer);
  return rail && impl_->motion.parts.rail.asked(*rail).draws;
}

const DriveParams& Simulator::drive(const std::string& layer) const {
  const std::optional<std::size_t> rail = railOf(impl_->motion, layer);
  return rail ? impl_->motion.parts.rail.asked(*rail).drive : impl_->scene.rail.drive;
}

bool Simulator::movePin(NodeIndex node, const Vec3& target) {
  const Grid& grid = impl_->pattern.grid;
  const bool inside = node.row >= 0 && node.row < grid.rows && node.column >= 0 && node.column < grid.columns;
  // Not a node that a hand pins, which moves it.
  if (!inside || impl_->pattern.scene_pins[grid.index(node)] != kPinned || !isPlace(target)) return false;
  impl_->motion.parts.pins.move(grid.index(node), target);
  return true;
}

std::vector<Problem> Simulator::setTieBack(const std::string& id, bool closed) {
  Impl& im = *impl_;
  const std::optional<std::size_t> loop = placeOf(im.scene.tie_back, id);
  if (!loop) {
    std::string known;
    for (const TieBackParams& one : im.scene.tie_back) known += (known.empty() ? "" : ", ") + quoted(one.id);
    return {{"tie_back",
             "has no entry of id " + quoted(id) + (known.empty() ? ", nor any other" : ", known are " + known)}};
  }
  Cords& cords = im.motion.parts.cords;
  if (cords.closed(*loop) == closed) return {};
  im.motion.velocities();  // caches them while the pulls that made them are known
  cords.close(*loop, closed, im.motion.state);
  im.driven();
  return {};
}

bool Simulator::tieBackClosed(const std::string& id) const {
  const std::optional<std::size_t> loop = placeOf(impl_->scene.tie_back, id);
  return loop && impl_->motion.parts.cords.closed(*loop);
}

std::optional<Vec3> Simulator::lineEnd(const std::string& id) const {
  const std::optional<std::size_t> line = placeOf(impl_->scene.lines, id);
  if (!line) return std::nullopt;
  return impl_->motion.state.position.at(impl_->pattern.cords.ends[*line].node);
}

Vec3 Simulator::linePull(const std::string& id) const {
  std::vector<double> tensions;
  copyLineTensions(id, tensions);
  const std::optional<std::size_t> line = placeOf(impl_->scene.lines, id);
  Vec3 sum = Vec3::Zero();
  for (std::size_t k = 0; k < tensions.size(); ++k) {
    const CordEnd& end = impl_->pattern.cords.ends[*line];
    const Field3& position = impl_->motion.state.position;
    const Vec3 up = position.at(impl_->pattern.cords.cords[end.first + k].node) - position.at(end.node);
    if (tensions[k] > 0.0) sum += tensions[k] * up.normalized();
  }
  return sum;
}

void Simulator::copyLineTensions(const std::string& id, std::vector<double>& out) const {
  out.clear();
  const std::optional<std::size_t> line = placeOf(impl_->scene.lines, id);
  if (!line) return;
  const CordEnd& end = impl_->pattern.cords.ends[*line];
  for (std::size_t c = end.first; c < end.last; ++c)
    out.push_back(impl_->motion.step.tensionOf(impl_->motion.parts.cords.row(c)));
}

bool Simulator::setLineEnd(const std::string& id, const Vec3& target) {
  const std::optional<std::size_t> line = placeOf(impl_->scene.lines, id);
  if (!line || impl_->pattern.cords.ends[*line].load || !isPlace(target)) return false;
  impl_->motion.parts.pins.move(impl_->pattern.cords.ends[*line].node, target);
  return true;
}

std::vector<NodeIndex> Simulator::carriers() const {
  std::vector<NodeIndex> nodes;
  for (const RailPattern& rail : impl_->pattern.rails) {
    for (const int column : rail.columns) nodes.push_back({0, column});
  }
  return nodes;
}

std::vector<Vec3> Simulator::railPoints(double spacing, const std::string& layer) const {
  const std::optional<std::size_t> number = railOf(impl_->motion, layer);
  if (!number) return {};
  const RailPattern& rail = impl_->pattern.rails[*number];
  constexpr double kMaxParts = 1e6;
  const int parts = static_cast<int>(std::clamp(std::ceil(rail.path.length() / spacing), 1.0, kMaxParts));
  std::vector<Vec3> points;
  for (int k = 0; k <= parts; ++k) points.push_back(rail.path.at(rail.path.length() * k / parts).point);
  return points;
}

}  // namespace curtain
