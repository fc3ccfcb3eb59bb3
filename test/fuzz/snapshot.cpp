// SPDX-License-Identifier: BSD-3-Clause
#include <cstring>
#include <limits>
#include <vector>

#include "curtain_sim/scene_yaml.h"
#include "curtain_sim/simulator.h"
#include "drawn/choices.h"
#include "fuzz/checks.h"
#include "simulator/snapshot_format.h"

namespace curtain_test {
namespace {

using curtain::Simulator;

// Between them: contacts with an obstacle and with itself, gusts, a drag, an estimate of the error, an obstacle on its
// way.
const char* const kScenes[] = {
    "cloth: {rows: 7, columns: 6, height: 0.6, width: 0.5}\n"
    "hang: {from: [0, 0, 1], to: [0.3, 0, 1], tilt: 0.3}\n"
    "contact: {thickness: 0.01, self: true}\n"
    "obstacles: [{name: ball, shape: sphere, radius: 0.15, position: [0.15, 0, 0.6]}]\n"
    "wind: [{id: fan, position: [0.2, -1, 0.8], direction: [0, 1, 0], radius: 0.5, pressure: 5, unsteadiness: 1}]\n",
    "cloth: {rows: 6, columns: 5, height: 0.5, width: 0.4}\n"
    "hang: {from: [0, 0, 1], to: [0.4, 0, 1]}\n"
    "solver: {method: implicit, position_tolerance: 0.001}\n"
    "drag: [{id: hand, force: [0, 2, 0], node: [5, 2]}]\n",
    "cloth: {rows: 6, columns: 5, height: 0.5, width: 0.4}\n"
    "hang: {from: [0, 0, 1], to: [0.4, 0, 1]}\n"
    "air: {inside: 50, border: 50, corner: 50}\n"
    "obstacles: [{name: wall, shape: box, size: [1, 0.1, 1], position: [0, 0.3, 0.5],\n"
    "  motion: [{time: 0, position: [0, 0.3, 0.5]}, {time: 2, position: [0, 0.04, 0.5]}]}]\n"};

struct Sample {
  curtain::Scene scene;
  std::string snapshot;
};

// A rigid hand on its way, and two pads.
void holdCorners(Simulator& simulator) {
  curtain::GraspParams grasp;
  grasp.id = "rigid";
  grasp.frame.position = simulator.position({simulator.rows() - 1, 0});
  grasp.radius = 0.12;
  require(simulator.setGrasp(grasp).empty(), "the corner is held");
  grasp.id = "pads";
  grasp.frame.position = simulator.position({simulator.rows() - 1, simulator.columns() - 1});
  grasp.pinch_force = 0.5;
  require(simulator.setGrasp(grasp).empty(), "the other corner is held");
  simulator.moveGrasp("rigid", {simulator.position({simulator.rows() - 1, 0}) + curtain::Vec3(0.0, 0.05, 0.05),
                                curtain::Rotation::Identity()});
}

Sample makeSample(const char* text) {
  const curtain::SceneReading reading = curtain::readSceneText(text);
  require(reading.problems.empty(), "the sample is a scene: " + curtain::describe(reading.problems, "sample"));
  Simulator simulator(reading.scene);
  holdCorners(simulator);
  for (int frame = 0; frame < 30; ++frame) simulator.step();
  return {reading.scene, simulator.snapshot()};
}

const Sample& sample(std::size_t index) {
  static const std::vector<Sample> samples = [] {
    std::vector<Sample> made;
    for (const char* text : kScenes) made.push_back(makeSample(text));
    return made;
  }();
  return samples[index];
}

template <typename Number>
void overwrite(std::string& bytes, std::size_t at, Number number) {
  if (at + sizeof number <= bytes.size()) std::memcpy(&bytes[at], &number, sizeof number);
}

double hostileNumber(Choices& choices) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const double numbers[] = {kInfinity, -kInfinity, std::numeric_limits<double>::quiet_NaN(),
                            1e300,     -1e300,     1e-300,
                            5e-324,    0.0,        -0.0,
                            -1.0,      1.0,        1e9,
                            -1e9,      1e-9};
  return numbers[choices.below(std::size(numbers))];
}

std::uint64_t hostileCount(Choices& choices) {
  const std::uint64_t counts[] = {0,    1,         2,           ~std::uint64_t{0}, std::uint64_t{1} << 63U,
                                  1000, 1U << 31U, 0xFFFFFFFFU, 0x100000001U};
  return counts[choices.below(std::size(counts))];
}

// One thing that is state becomes something else, or is gone, or comes twice.
void change(Choices& choices, std::string& state) {
  if (state.empty()) return;
  const std::size_t at = choices.below(state.size());
  switch (choices.below(5)) {
    case 0:
      return overwrite(state, at, hostileNumber(choices));
    case 1:
      return overwrite(state, at, hostileCount(choices));
    case 2:
      return overwrite(state, at, static_cast<char>(choices.below(256)));
    case 3:
      state.erase(at, 1 + choices.below(64));
      return;
    default:
      state.insert(at, state.substr(at, 1 + choices.below(64)));
      return;
  }
}

// Everything that goes on from what was restored: it ends, and reads nothing that isn't its own.
void useAll(Simulator& simulator) {
  for (int frame = 0; frame < 2; ++frame) simulator.step();
  std::vector<curtain::Vec3> values;
  simulator.copyVelocities(values);
  simulator.copyForces(values);
  curtain::FineMesh mesh;
  simulator.copyFineMesh(mesh);
  require(!simulator.snapshot().empty(), "it can be saved again");
}

}  // namespace

void checkSnapshot(const std::string& bytes) {
  ByteChoices choices(bytes);
  const Sample& good = sample(choices.below(std::size(kScenes)));
  curtain::SnapshotParts parts;
  require(!curtain::unpackSnapshot(good.snapshot, parts), "the sample is a snapshot");
  std::string state(parts.state);
  for (std::uint64_t changes = 1 + choices.below(4); changes > 0; --changes) change(choices, state);
  parts.state = state;
  const std::string changed = curtain::packSnapshot(parts);

  Simulator simulator(good.scene);
  const std::string before = simulator.snapshot();
  if (!simulator.restore(changed).empty()) {
    require(simulator.snapshot() == before, "a refused snapshot changes nothing");
  } else {
    useAll(simulator);
  }
  require(simulator.restore(good.snapshot).empty(), "a sound one is taken after a hostile one");
  require(simulator.snapshot() == good.snapshot, "and leaves nothing of it");
}

}  // namespace curtain_test
