// SPDX-License-Identifier: BSD-3-Clause
//
// Rail, tie-backs and lines.
#include <algorithm>
#include <cmath>

#include "python/arguments.h"
#include "python/bindings.h"
#include "python/yaml_values.h"

namespace py = pybind11;

namespace curtain::python {
namespace {

using Self = PythonSimulator;

template <typename Params>
const std::string& known(const std::vector<Params>& all, const std::string& id, const char* none) {
  const bool found = std::any_of(all.begin(), all.end(), [&](const Params& one) { return one.id == id; });
  if (!found) throw py::value_error(std::string(none) + " \"" + id + "\"");
  return id;
}

const std::string& lines(const Self& self, const std::string& id) {
  return known(self.inspect().scene().lines, id, "there are no lines");
}

const std::string& layerOf(const Self& self, const std::string& layer) {
  const std::vector<Simulator::LayerColumns> layers = self.inspect().layers();
  const bool found =
      std::any_of(layers.begin(), layers.end(), [&](const Simulator::LayerColumns& one) { return one.name == layer; });
  if (!found) throw py::value_error("there is no layer \"" + layer + "\"");
  return layer;
}

py::object driveOf(const Simulator& simulator, const std::string& layer) {
  if (!simulator.drives(layer)) return py::none();
  py::dict values;
  values["speed"] = simulator.drive(layer).speed;
  values["force"] = simulator.drive(layer).force;
  return py::object(values);
}

void setDrive(Self& self, double speed, double force, const std::string& layer) {
  DriveParams drive;
  drive.speed = speed;
  drive.force = force;
  refuse(self.change([&](Simulator& s) { return s.setDrive(drive, layer); }));
}

py::array_t<double> railPoints(const Self& self, double spacing, const std::string& layer) {
  if (!(spacing >= 1e-4 && std::isfinite(spacing)))
    throw py::value_error("spacing: must be a finite number >= 0.0001 [m], is " +
                          std::string(py::str(py::float_(spacing))));
  const std::vector<Vec3> points = self.inspect().railPoints(spacing, layerOf(self, layer));
  py::array_t<double> array({static_cast<py::ssize_t>(points.size()), py::ssize_t{3}});
  std::copy_n(points.empty() ? nullptr : points.front().data(), 3 * points.size(), array.mutable_data());
  return array;
}

void bindRail(SimulatorClass& simulator) {
  simulator
      .def(
          "set_opening",
          [](Self& self, double opening, const std::string& layer) {
            refuse(self.change([&](Simulator& s) { return s.setOpening(opening, layer); }));
          },
          py::arg("opening"), py::arg("layer") = kFirstCloth,
          "Draws the master carriers of a layer's rail to an opening, 0 (shut) to 1 (gathered as far as the gaps "
          "allow), "
          "by the drive; arrived, it keeps them there. opening() is the present one.")
      .def(
          "opening",
          [](const Self& self, const std::string& layer) { return self.inspect().opening(layerOf(self, layer)); },
          py::arg("layer") = kFirstCloth, "Present opening of a layer's rail; 0 without one.")
      .def(
          "drive_force",
          [](const Self& self, const std::string& layer) { return self.inspect().driveForce(layerOf(self, layer)); },
          py::arg("layer") = kFirstCloth, "Force of the drive of a layer's rail on its masters, mean over a frame [N].")
      .def(
          "release_drive",
          [](Self& self, const std::string& layer) {
            layerOf(self, layer);
            self.change([&](Simulator& s) { s.releaseDrive(layer); });
          },
          py::arg("layer") = kFirstCloth,
          "The drive lets go: carriers slide freely, as before the first set_opening().")
      .def("set_drive", &setDrive, py::arg("speed"), py::arg("force"), py::arg("layer") = kFirstCloth,
           "Speed [m/s] and greatest force on each master [N] of the drive, until reset().")
      .def_property_readonly(
          "drive", [](const Self& self) { return driveOf(self.inspect(), kFirstCloth); },
          "Speed [m/s] and force [N] of the first cloth's drive; None: it has let go.")
      .def(
          "carriers",
          [](const Self& self) {
            py::list nodes;
            for (const NodeIndex node : self.inspect().carriers()) nodes.append(toTuple(node));
            return nodes;
          },
          "Nodes that hang by carriers, as (row, column), in the order of the rail; empty: there is no rail.")
      .def("rail_points", &railPoints, py::arg("spacing"), py::arg("layer") = kFirstCloth,
           "Points along a layer's rail [m], evenly, no further apart than spacing [m]; shape (n, 3).");
}

void bindTieBacks(SimulatorClass& simulator) {
  simulator
      .def(
          "set_tie_back",
          [](Self& self, const std::string& id, bool closed) {
            refuse(self.change([&](Simulator& s) { return s.setTieBack(id, closed); }));
          },
          py::arg("id"), py::arg("closed"),
          "Closes a tie-back, from where its nodes are and at its speed, or opens it.")
      .def(
          "tie_back_closed",
          [](const Self& self, const std::string& id) {
            return self.inspect().tieBackClosed(known(self.inspect().scene().tie_back, id, "there is no tie-back"));
          },
          py::arg("id"), "It is closed, or closes.");
}

py::array_t<double> lineTensions(const Self& self, const std::string& id) {
  std::vector<double> tensions;
  self.inspect().copyLineTensions(lines(self, id), tensions);
  return py::array_t<double>(static_cast<py::ssize_t>(tensions.size()), tensions.data());
}

void setLineEnd(Self& self, const std::string& id, const py::object& target) {
  const Vec3 point = readPoint(target, "target");
  lines(self, id);
  if (!self.change([&](Simulator& s) { return s.setLineEnd(id, point); }))
    throw py::value_error("lines \"" + id + "\": end at a load, which hangs freely");
}

void bindLines(SimulatorClass& simulator) {
  simulator
      .def(
          "line_end",
          [](const Self& self, const std::string& id) { return toArray(*self.inspect().lineEnd(lines(self, id))); },
          py::arg("id"), "Where the lines of this id end [m], shape (3,).")
      .def(
          "line_pull",
          [](const Self& self, const std::string& id) { return toArray(self.inspect().linePull(lines(self, id))); },
          py::arg("id"), "Force of the lines on their end in the last substep [N], shape (3,).")
      .def("line_tensions", &lineTensions, py::arg("id"),
           "Tension of each of the lines in the last substep [N], in the order of their nodes, 0: slack; shape (n,).")
      .def("set_line_end", &setLineEnd, py::arg("id"), py::arg("target"),
           "Moves a fixed end to a point [m], evenly over the next frame; there it stays.");
}

}  // namespace

void bindFittings(SimulatorClass& simulator) {
  bindRail(simulator);
  bindTieBacks(simulator);
  bindLines(simulator);
}

}  // namespace curtain::python
