// SPDX-License-Identifier: BSD-3-Clause
//
// The package's own simulator as a contestant, and the scene's start as it makes it.
#include <stdexcept>

#include "bench/line_up.h"
#include "curtain_sim/simulator.h"
#include "obstacles/pose_curve.h"

namespace curtain_bench {
namespace {

void copy(const std::vector<curtain::Vec3>& from, Points& out) {
  out.resize(from.size());
  for (std::size_t n = 0; n < from.size(); ++n) {
    out.x[n] = from[n].x();
    out.y[n] = from[n].y();
    out.z[n] = from[n].z();
  }
}

class Ours : public Contestant {
 public:
  explicit Ours(const curtain::Scene& scene) : simulator_(scene) {}

  Ours(const curtain::Scene& scene, const Points& at) : simulator_(scene) {
    std::vector<curtain::Vec3> nodes;
    for (std::size_t n = 0; n < at.x.size(); ++n) nodes.emplace_back(at.x[n], at.y[n], at.z[n]);
    const std::vector<curtain::Problem> problems =
        simulator_.setState(nodes, std::vector<curtain::Vec3>(nodes.size(), curtain::Vec3::Zero()));
    if (!problems.empty()) throw std::invalid_argument(curtain::describe(problems));
  }

  void frame() override { simulator_.step(); }

  void copyPositions(Points& out) const override {
    std::vector<curtain::Vec3> positions;
    simulator_.copyPositions(positions);
    copy(positions, out);
  }

  void copyVelocities(Points& out) const override {
    std::vector<curtain::Vec3> velocities;
    simulator_.copyVelocities(velocities);
    copy(velocities, out);
  }

  int substeps() const override { return simulator_.statistics().substeps_last; }

 private:
  curtain::Simulator simulator_;
};

}  // namespace

Solid solidOf(const curtain::Scene& scene) {
  Solid solid;
  solid.margin = scene.contact.thickness;
  solid.friction = scene.contact.friction;
  if (scene.obstacles.empty()) return solid;
  const curtain::ObstacleParams& ball = scene.obstacles.front();
  solid.shape = Solid::Shape::kBall;
  solid.radius = ball.radius;
  solid.at = [motion = curtain::ScriptedMotion(ball, ball.radius)](double time) {
    const curtain::Vec3 place = motion.at(time).position;
    return Solid::Place{place.x(), place.y(), place.z()};
  };
  return solid;
}

ClothStart clothStart(const curtain::Scene& scene, double damping) {
  const curtain::ClothParams& cloth = scene.cloth;
  if (cloth.closed || !cloth.row_spacing.empty() || !cloth.column_spacing.empty() || cloth.hem_width) {
    throw std::invalid_argument("the rivals know open cloth of equal links only");
  }
  const curtain::Simulator simulator(scene);
  ClothStart start;
  start.rows = simulator.rows();
  start.columns = simulator.columns();
  std::vector<curtain::Vec3> positions;
  simulator.copyPositions(positions);
  copy(positions, start.positions);
  for (int i = 0; i < start.rows; ++i) {
    for (int j = 0; j < start.columns; ++j) {
      start.mass.push_back(simulator.mass({i, j}));
      start.pinned.push_back(simulator.pinned({i, j}) ? 1 : 0);
    }
  }
  start.warp_rest = cloth.height / (start.rows - 1);
  start.weft_rest = cloth.width / (start.columns - 1);
  start.gravity = {scene.gravity.x(), scene.gravity.y(), scene.gravity.z()};
  start.damping = damping;
  start.frame_seconds = 1.0 / scene.solver.frame_rate;
  return start;
}

std::unique_ptr<Contestant> makeOurs(const curtain::Scene& scene) { return std::make_unique<Ours>(scene); }

std::unique_ptr<Contestant> makeOurs(const curtain::Scene& scene, const ClothStart& start) {
  return std::make_unique<Ours>(scene, start.positions);
}

Entry ourEntry(const std::string& method, int substeps) {
  Entry entry;
  entry.method = method;
  entry.setting = substeps == 0 ? "default" : "substeps " + std::to_string(substeps);
  entry.make = [method, substeps](const curtain::Scene& given, const ClothStart&) {
    curtain::Scene scene = given;
    scene.solver.method = *curtain::methodFromName(method);
    scene.solver.substeps = substeps;
    return makeOurs(scene);
  };
  return entry;
}

std::vector<Entry> ourEntries(const std::vector<int>& substeps) {
  std::vector<Entry> entries;
  for (const std::string& method : curtain::methodNames()) {
    entries.push_back(ourEntry(method, 0));
    for (const int count : substeps) entries.push_back(ourEntry(method, count));
  }
  return entries;
}

}  // namespace curtain_bench
