// SPDX-License-Identifier: BSD-3-Clause
//
// import curtain_engine: the engine for Python. See docs/python.md.
#include <pybind11/numpy.h>

#include "python/bindings.h"
#include "python/yaml_values.h"

namespace py = pybind11;

namespace {

// What Simulator() takes.
curtain::Scene sceneOf(const py::object& given) {
  if (py::isinstance<curtain::Scene>(given)) return given.cast<curtain::Scene>();
  if (py::isinstance<py::dict>(given)) return curtain::python::readSceneValues(given);
  const std::string type = py::str(given.get_type().attr("__name__"));
  throw py::type_error("scene: must be a Scene or a dict, is a " + type);
}

}  // namespace

PYBIND11_MODULE(curtain_engine, module) {
  using curtain::python::PythonSimulator;
  // Now, and not with the first array: pybind11 keeps it in a static variable, and NumPy's import lets other threads
  // run, of which one would wait for that variable with the GIL in its hands.
  py::detail::npy_api::get();
  module.doc() =
      "The curtain simulator's engine, without ROS.\n\n"
      "SI units throughout: m, s, kg, N, rad. Nodes are (row, column); row 0 is the hung edge. Bad input is a "
      "ValueError "
      "that says what is wrong, where, and what is allowed; then nothing changed.";
  module.attr("__version__") = CURTAIN_VERSION;
  curtain::python::bindScene(module);

  curtain::python::SimulatorClass simulator(
      module, "Simulator",
      "A curtain. Same scene, same calls: same bits.\n\n"
      "Attributes that are arrays are read-only and live: after a step the same array shows the new state; copy() "
      "keeps "
      "one. Methods return arrays of their own.\n\n"
      "One simulator is for one thread at a time: step(), restore() and the constructor release the GIL, and a call "
      "into "
      "a simulator that another thread is in is a RuntimeError. Any number of simulators run side by side.");
  simulator.def(py::init([](const py::object& scene) { return std::make_unique<PythonSimulator>(sceneOf(scene)); }),
                py::arg("scene"),
                "Builds the cloth at its start.\n\n"
                "scene: a Scene, or a dict with the keys of scene files. ValueError with every problem of the scene or "
                "of a mesh.");
  curtain::python::bindState(simulator);
  curtain::python::bindForces(simulator);
  curtain::python::bindHands(simulator);
  curtain::python::bindFittings(simulator);
  curtain::python::bindObstacles(simulator);
  curtain::python::bindMeasures(simulator);
}
