// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <vector>

#include "cloth/cloth.h"
#include "curtain_sim/scene_yaml.h"
#include "curtain_sim/simulator.h"
#include "fuzz/checks.h"
#include "fuzz/scene_maker.h"
#include "scene/ranges.h"

namespace curtain_test {
namespace {

using curtain::Method;
using curtain::Scene;
using curtain::Simulator;
using curtain::Statistics;
using curtain::Vec3;

constexpr int kFrames = 2;

void requireFinite(const std::vector<Vec3>& values, const std::string& what) {
  for (const Vec3& value : values) require(value.allFinite(), what + " are finite");
}

// Everything that a user may ask for.
void requireFinite(Simulator& simulator) {
  std::vector<Vec3> values;
  simulator.copyPositions(values);
  requireFinite(values, "positions");
  simulator.copyVelocities(values);
  requireFinite(values, "velocities");
  simulator.copyForces(values);
  requireFinite(values, "forces");
  curtain::FineMesh mesh;
  simulator.copyFineMesh(mesh);
  requireFinite(mesh.positions, "the fine mesh's nodes");
  const curtain::Energy energy = simulator.energy();
  require(std::isfinite(energy.kinetic) && std::isfinite(energy.potential), "energies are finite");
  require(simulator.statistics().finite, "the statistics say so");
}

// Where a frame's substeps all settled, its links are as long as they are, within the tolerance that was asked for.
// What the solver measures is half the relative excess of the squared length, which is a stretch to first order: a
// length below the tolerance in it is one in the stretch too, and a shorter one is beyond it by a tolerance of the
// tolerance, which is at most a tenth. Lengths are differences of coordinates: each end is off by half a unit of
// rounding, and so is every sum on the way to it.
void requireLength(const Scene& scene, const Statistics& before, const Simulator& simulator) {
  const Statistics& now = simulator.statistics();
  const bool settled = now.unsettled == before.unsettled && now.stops == before.stops && now.frames > 0 &&
                       now.unfinished_substeps == before.unfinished_substeps &&
                       now.shortened_frames == before.shortened_frames && now.substeps_last > 0;
  if (scene.solver.method == Method::kPaper || !settled)
    return;  // the paper's scheme never asks whether it has settled
  std::vector<Vec3> positions;
  simulator.copyPositions(positions);
  double farthest = 0.0;
  for (const Vec3& position : positions) farthest = std::max(farthest, position.cwiseAbs().maxCoeff());
  const double shortest = curtain::shortestLink(curtain::makePattern(scene));
  const double bound = 1.1 * scene.solver.stretch_tolerance + 16.0 * 2.3e-16 * farthest / shortest;
  const std::string numbers = curtain::formatNumber(now.warp_stretch) + " " +
                              curtain::formatNumber(now.warp_compression) + " " +
                              curtain::formatNumber(now.weft_stretch) + " > " + curtain::formatNumber(bound);
  require(std::max({now.warp_stretch, now.warp_compression, now.weft_stretch}) <= bound,
          "settled, and links too long: " + numbers);
}

void stepWith(const Scene& scene) {
  Simulator simulator(scene, [](const std::string&) { return CURTAIN_SOURCE_DIR "/test/meshes/cube_binary.stl"; });
  for (int frame = 0; frame < kFrames; ++frame) {
    const Statistics before = simulator.statistics();
    simulator.step();
    requireFinite(simulator);
    requireLength(scene, before, simulator);
  }
}

void check(const Scene& scene) {
  try {
    stepWith(scene);
  } catch (const Violation& violation) {
    throw Violation(std::string(violation.what()) + "\n" + curtain::writeScene(scene));
  } catch (const std::invalid_argument& refused) {  // a mesh that its scale leaves no place for
    const std::string reason = refused.what();
    require(reason.find("mesh '") != std::string::npos, "a valid scene is refused: " + reason);
  }
}

}  // namespace

void checkStep(const std::string& bytes) {
  ByteChoices choices(bytes);
  if (const std::optional<Scene> scene = makeScene(choices)) check(*scene);
}

void checkSteps(const std::string& bytes) {
  ByteChoices choices(bytes);
  std::optional<Scene> scene = makeScene(choices);
  for (std::size_t m = 0; scene && m < curtain::methodNames().size(); ++m) {
    scene->solver.method = static_cast<Method>(m);
    const bool refused = scene->solver.method == Method::kPaper && !curtain::validate(*scene).empty();
    if (!refused) check(*scene);  // the paper's scheme knows neither all laws of the air, nor bending, nor rails
  }
}

}  // namespace curtain_test
