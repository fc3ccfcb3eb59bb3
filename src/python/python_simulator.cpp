// SPDX-License-Identifier: BSD-3-Clause
#include "python/python_simulator.h"

#include <chrono>
#include <stdexcept>

namespace py = pybind11;

namespace curtain::python {
namespace {

using Clock = std::chrono::steady_clock;

// Between two looks for signals: a tenth of a second is at once to whoever presses Ctrl-C.
constexpr std::chrono::milliseconds kUnheard{100};

Simulator build(const Scene& scene) {
  const py::gil_scoped_release release;
  return Simulator(scene);
}

std::vector<py::ssize_t> gridOf(const Simulator& simulator) { return {simulator.rows(), simulator.columns()}; }

std::vector<py::ssize_t> vectorsOn(std::vector<py::ssize_t> grid) {
  grid.push_back(3);
  return grid;
}

std::vector<py::ssize_t> fineGridOf(const Simulator& simulator) {
  return {simulator.fineMeshTopology().rows, simulator.fineMeshTopology().columns};
}

void fillWarp(const Simulator& simulator, std::vector<double>& out) {
  std::vector<double> weft;
  simulator.copyTensions(out, weft);
}

void fillWeft(const Simulator& simulator, std::vector<double>& out) {
  std::vector<double> warp;
  simulator.copyTensions(warp, out);
}

void fillFine(const Simulator& simulator, std::vector<Vec3>& out) {
  FineMesh mesh;
  mesh.positions.swap(out);  // the memory stays the same
  simulator.copyFineMesh(mesh);
  mesh.positions.swap(out);
}

}  // namespace

PythonSimulator::PythonSimulator(const Scene& scene)
    : simulator_(build(scene)),
      positions_(vectorsOn(gridOf(simulator_)), &Simulator::copyPositions),
      velocities_(vectorsOn(gridOf(simulator_)), &Simulator::copyVelocities),
      forces_(vectorsOn(gridOf(simulator_)), &Simulator::copyForces),
      contact_forces_(vectorsOn(gridOf(simulator_)), &Simulator::copyContactForces),
      warp_tensions_(gridOf(simulator_), fillWarp),
      weft_tensions_(gridOf(simulator_), fillWeft),
      fine_positions_(vectorsOn(fineGridOf(simulator_)), fillFine) {}

void PythonSimulator::checkFree() const {
  if (in_use_) throw std::runtime_error("the simulator is in use: another thread is in one of its methods");
}

void PythonSimulator::renewArrays() {
  for (LiveArray<Vec3>* array : {&positions_, &velocities_, &forces_, &contact_forces_, &fine_positions_})
    array->renew(simulator_);
  warp_tensions_.renew(simulator_);
  weft_tensions_.renew(simulator_);
}

void PythonSimulator::step(std::int64_t frames) {
  if (frames < 0) throw py::value_error("frames: must be at least 0, is " + std::to_string(frames));
  checkFree();
  const InUse in_use(*this);
  bool stopped = false;
  while (frames > 0 && !stopped) {
    {
      const py::gil_scoped_release release;
      const Clock::time_point pause = Clock::now() + kUnheard;
      do simulator_.step();
      while (--frames > 0 && Clock::now() < pause);
    }
    stopped = PyErr_CheckSignals() != 0;
  }
  renewArrays();
  if (stopped) throw py::error_already_set();
}

std::vector<std::string> PythonSimulator::obstacles() const {
  std::vector<std::string> names;
  for (const ObstacleParams& obstacle : inspect().scene().obstacles) names.push_back(obstacle.name);
  return names;
}

int PythonSimulator::obstacle(const std::string& name) const {
  const std::vector<ObstacleParams>& obstacles = inspect().scene().obstacles;
  for (std::size_t k = 0; k < obstacles.size(); ++k) {
    if (obstacles[k].name == name) return static_cast<int>(k);
  }
  std::string known;
  for (const ObstacleParams& obstacle : obstacles) known += (known.empty() ? "" : ", ") + obstacle.name;
  throw py::value_error("there is no obstacle \"" + name + "\"" + (known.empty() ? "" : ", there are " + known));
}

}  // namespace curtain::python
