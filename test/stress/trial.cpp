// SPDX-License-Identifier: BSD-3-Clause
#include "stress/trial.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace curtain_test {
namespace {

using namespace curtain;

// The cloth is at rest again when what it has above the energy of its rest is this share of m g H.
constexpr double kAtRest = 1e-3;
// Or it has come to rest elsewhere: slack cloth lies in many ways. In half a second a swing of that energy turns to
// potential and back.
constexpr double kStill = 1e-2 * kAtRest;
// Time to fall back into place before damping counts, and the factor on what it asks for: a swing's energy goes by
// exp(-c / m t) on average over a period, the last swings take a whole one.
// And a swing more, for it may be seen at rest while it turns.
constexpr double kFall = 2.0, kPatience = 2.0;
constexpr double kStays = 0.5;             // [s] at rest, or it has only gone by
constexpr double kLongestRecovery = 40.0;  // [s]; what asks for more is not waited for
constexpr double kNever = std::numeric_limits<double>::quiet_NaN();

// Energy of the cloth at rest, hanging as it does where nothing torments it: in thick air, until it sleeps.
double restEnergy(Scene scene) {
  scene.wind.clear();
  scene.drag.clear();
  scene.solver.method = Method::kAuto;
  scene.solver.frame_rate = 60.0;
  const double thick = 10.0 * std::max(scene.air.inside, 0.1);
  scene.air.inside = scene.air.border = scene.air.corner = thick;
  Simulator simulator(scene);
  for (int f = 0; f < 1200 && simulator.statistics().asleep_frames == 0; ++f) simulator.step();
  return simulator.energy().potential;
}

void lookAtFrame(const Torture& torture, const Simulator& simulator, Watch& watch, Trial& trial) {
  watch.look(simulator, trial);
  watch.lookAtEnergy(simulator, torture.gravity_changes, trial);
}

// The torture alone. Returns the hash of where it ends.
std::uint64_t torment(const Torture& torture, Watch& watch, Simulator& simulator, Trial& trial) {
  Random random(7);
  if (torture.begin) torture.begin(simulator);
  simulator.countWork(true);
  watch.open(simulator);
  for (int frame = 0; simulator.time() < torture.seconds - 1e-9 && trial.finite; ++frame) {
    if (torture.torment) torture.torment(simulator, frame, random);
    simulator.step();
    trial.kinetic = std::max(trial.kinetic, simulator.energy().kinetic);
    lookAtFrame(torture, simulator, watch, trial);
  }
  if (torture.end) torture.end(simulator);
  return simulator.stateHash();
}

// And what comes after it.
void recover(const Torture& torture, double scale, Watch& watch, Simulator& simulator, Trial& trial) {
  trial.recovery = trial.recovery_allowed = kNever;
  const auto oneFrame = [&, during = trial.stretch] {
    simulator.step();
    lookAtFrame(torture, simulator, watch, trial);
    trial.stretch = during;
    trial.stretch_after = worstLink(simulator.statistics());
  };
  if (!torture.recovers) {
    oneFrame();
    return;
  }
  const double rest = restEnergy(torture.scene);
  const auto above = [&] {
    const Energy energy = simulator.energy();
    return energy.kinetic + energy.potential - rest;
  };
  const AirParams& air = torture.scene.air;
  const double per_mass =
      air.density * air.inside * torture.scene.cloth.height * torture.scene.cloth.width / freeMass(simulator);
  const double start = simulator.time();
  const double swing = 2.0 * 3.14159 * std::sqrt(2.0 / 3.0 * torture.scene.cloth.height / torture.scene.gravity.norm());
  const double allowed = kFall + swing + kPatience * std::max(0.0, std::log(above() / (kAtRest * scale))) / per_mass;
  if (allowed < kLongestRecovery) trial.recovery_allowed = allowed;
  const double end = start + (std::isnan(trial.recovery_allowed) ? 0.0 : trial.recovery_allowed);
  double since = kNever;  // it is at rest
  do {
    oneFrame();
    const double time = simulator.time() - start;
    if (std::abs(above()) > kAtRest * scale && simulator.energy().kinetic > kStill * scale)
      since = kNever;
    else if (std::isnan(since))
      since = time;
    if (time - since >= kStays) break;
  } while (simulator.time() < end + kStays && trial.finite);
  trial.recovery = since;
}

void judge(const Torture& torture, bool one_pass, Trial& trial) {
  if (!trial.same_bits) trial.fault("other bits when repeated");
  // The paper's scheme keeps rods, but leaves wefts too long, and knows no work of pins: nothing more is asked of it
  // than numbers.
  if (one_pass) return;
  trial.stretch_allowed = torture.stretch_during;
  trial.energy_allowed = torture.energy_gain;
  trial.atMost(torture.stretch_during, "stretch", trial.stretch);
  trial.atMost(torture.energy_gain, "energy", trial.energy_gain);
  trial.atMost(torture.kinetic, "kinetic energy", trial.kinetic);
  if (std::isnan(trial.recovery_allowed)) return;
  trial.atMost(torture.stretch_after, "stretch after it", trial.stretch_after);
  trial.atMost(trial.recovery_allowed, "at rest after", trial.recovery);
}

}  // namespace

Trial carryOut(const Torture& torture, Method method, bool twice) {
  Scene scene = torture.scene;
  scene.solver.method = method;
  Simulator simulator(scene);
  const double scale = weightScale(simulator);
  Trial trial;
  Watch watch(simulator);
  const std::uint64_t hash = torment(torture, watch, simulator, trial);
  if (trial.finite) recover(torture, scale, watch, simulator, trial);
  trial.kinetic /= scale;
  if (twice) {
    Simulator again(scene);
    Trial other;
    Watch scrap(again);
    trial.repeated = true;
    trial.same_bits = torment(torture, scrap, again, other) == hash;
  }
  judge(torture, method == Method::kPaper, trial);
  return trial;
}

}  // namespace curtain_test
