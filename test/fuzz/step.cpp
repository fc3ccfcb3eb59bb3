// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <vector>

#include "cloth/cloth.h"
#include "curtain_sim/scene_yaml.h"
#include "curtain_sim/simulator.h"
#include "drawn/scene_maker.h"
#include "fuzz/checks.h"
#include "verdict.h"

namespace curtain_test {
namespace {

using curtain::Method;
using curtain::Scene;
using curtain::Simulator;
using curtain::Statistics;
using curtain::Vec3;

constexpr int kFrames = 2;

// Where a frame's substeps all settled, its links are as long as they are, within the tolerance that was asked for.
// What the solver measures is half the relative excess of the squared length, which is a stretch to first order: a
// length below the tolerance in it is one in the stretch too, and a shorter one is beyond it by a tolerance of the
// tolerance, which is at most a tenth. Lengths are differences of coordinates: each end is off by half a unit of
// rounding, and so is every sum on the way to it.
void lookAtLength(const Scene& scene, const Statistics& before, const Simulator& simulator, Verdict& verdict) {
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
  verdict.atMost(bound, "settled, and links too long:", worstLink(now));
}

void stepWith(const Scene& scene) {
  Simulator simulator(scene, [](const std::string&) { return CURTAIN_SOURCE_DIR "/test/meshes/cube_binary.stl"; });
  Watch watch(simulator);
  Verdict verdict;
  for (int frame = 0; frame < kFrames && verdict.holds(); ++frame) {
    const Statistics before = simulator.statistics();
    simulator.step();
    watch.look(simulator, verdict);
    lookAtLength(scene, before, simulator, verdict);
  }
  require(verdict.holds(), verdict.holds() ? "" : verdict.faults.front());
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
