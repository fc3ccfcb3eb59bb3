// SPDX-License-Identifier: BSD-3-Clause
//
// Winds, drags, and keys of the scene that may change.
#include "python/arguments.h"
#include "python/bindings.h"
#include "python/yaml_values.h"

namespace py = pybind11;

namespace curtain::python {
namespace {

using Self = PythonSimulator;

// Sources as the entries of a scene file.
py::object windsOf(const Simulator& simulator) {
  Scene scene;
  scene.wind = simulator.winds();
  return writeSceneValues(scene, "wind");
}

py::object dragsOf(const Simulator& simulator) {
  Scene scene;
  scene.drag = simulator.drags();
  return writeSceneValues(scene, "drag");
}

void bindSources(SimulatorClass& simulator) {
  simulator
      .def(
          "set_wind",
          [](Self& self, const py::object& wind) {
            const WindParams params = readWind(wind, wholeCloth(self.inspect().scene()));
            refuse(self.change([&](Simulator& s) { return s.setWind(params); }));
          },
          py::arg("wind"),
          "Adds a wind source, or replaces the one with the same id. wind: a dict with the keys of an entry of a scene "
          "file's wind; start and end are simulated times [s].")
      .def(
          "remove_wind",
          [](Self& self, const std::string& id) { return self.change([&](Simulator& s) { return s.removeWind(id); }); },
          py::arg("id"), "False: there is no wind of this id.")
      .def(
          "clear_winds", [](Self& self) { self.change([](Simulator& s) { s.clearWinds(); }); },
          "Removes all winds, also those of the scene.")
      .def_property_readonly(
          "winds", [](const Self& self) { return windsOf(self.inspect()); },
          "The present ones, dicts as set_wind() takes them.")
      .def(
          "set_drag",
          [](Self& self, const py::object& drag) {
            const DragParams params = readDrag(drag, wholeCloth(self.inspect().scene()));
            refuse(self.change([&](Simulator& s) { return s.setDrag(params); }));
          },
          py::arg("drag"),
          "Adds a force on a node [N], or a spring that pulls it to a point, or replaces the one with the same id. "
          "drag: a dict with the keys of an entry of a scene file's drag.")
      .def(
          "remove_drag",
          [](Self& self, const std::string& id) { return self.change([&](Simulator& s) { return s.removeDrag(id); }); },
          py::arg("id"), "False: there is no drag of this id.")
      .def(
          "clear_drags", [](Self& self) { self.change([](Simulator& s) { s.clearDrags(); }); },
          "Removes all drags, also those of the scene.")
      .def_property_readonly(
          "drags", [](const Self& self) { return dragsOf(self.inspect()); },
          "The present ones, dicts as set_drag() takes them.");
}

// A setter of one number that returns problems.
template <typename Set>
auto number(const Set& set) {
  return [set](Self& self, double value) { refuse(self.change([&](Simulator& s) { return (s.*set)(value); })); };
}

void bindChanges(SimulatorClass& simulator) {
  simulator
      .def(
          "set_gravity",
          [](Self& self, const py::object& gravity) {
            const Vec3 vector = readPoint(gravity, "gravity");
            refuse(self.change([&](Simulator& s) { return s.setGravity(vector); }));
          },
          py::arg("gravity"), "[m/s^2], shape (3,); from the next step on, also after reset().")
      .def(
          "set_air",
          [](Self& self, const py::object& air) {
            const AirParams params = readAir(air, self.inspect().scene().air);
            refuse(self.change([&](Simulator& s) { return s.setAir(params); }));
          },
          py::arg("air"),
          "Changes the air from the next step on, also after reset(). air: a dict with keys of a scene file's air; the "
          "others keep their values.")
      .def("set_frame_rate", number(&Simulator::setFrameRate), py::arg("rate"),
           "Frames per second, in [1, 10000]; from the next step on, also after reset().")
      .def(
          "set_cloth",
          [](Self& self, const std::string& layer, const py::kwargs& values) {
            const ClothParams cloth = readCloth(values, self.inspect().scene(), layer);
            refuse(self.change([&](Simulator& s) { return s.setCloth(cloth, layer); }));
          },
          py::arg("layer") = kFirstCloth,
          "Changes a cloth from the next step on, also after reset(): surface_density, porosity, row_mass, "
          "column_mass, shear, bending_warp, bending_weft, bending_bias, bending_hysteresis, patches, as in a scene; "
          "or material, which sets what is known of the cloth itself. What is not given stays.")
      .def("set_friction", number(&Simulator::setFriction), py::arg("friction"),
           "Coulomb coefficient of the cloth on itself and on obstacles that name none, in [0, 10]; as "
           "set_frame_rate().")
      .def("set_stretch_tolerance", number(&Simulator::setStretchTolerance), py::arg("tolerance"),
           "Relative overlength allowed to any link, in [1e-12, 0.1]; as set_frame_rate().")
      .def("set_position_tolerance", number(&Simulator::setPositionTolerance), py::arg("tolerance"),
           "Error of positions to aim at per simulated second [m], in (0, 1], where the scene asks for one; as "
           "set_frame_rate().")
      .def("set_budget", number(&Simulator::setBudget), py::arg("ms"),
           "Computing time that a frame may take [ms], in [0, 1e6]; 0: no limit; as set_frame_rate().");
}

}  // namespace

void bindForces(SimulatorClass& simulator) {
  bindSources(simulator);
  bindChanges(simulator);
}

}  // namespace curtain::python
