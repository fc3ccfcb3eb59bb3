// SPDX-License-Identifier: BSD-3-Clause
#include "python/arguments.h"
#include "python/bindings.h"
#include "python/yaml_values.h"

namespace py = pybind11;

namespace curtain::python {
namespace {

using Self = PythonSimulator;

template <typename Value, typename Read>
py::array_t<Value> onGrid(const Simulator& simulator, const Read& read) {
  py::array_t<Value> array({simulator.rows(), simulator.columns()});
  Value* out = array.mutable_data();
  for (int i = 0; i < simulator.rows(); ++i) {
    for (int j = 0; j < simulator.columns(); ++j) *out++ = read(NodeIndex{i, j});
  }
  return array;
}

py::tuple restLengths(const Simulator& simulator) {
  std::vector<double> warp, weft;
  simulator.copyRestLengths(warp, weft);
  const py::array_t<double> rods(static_cast<py::ssize_t>(warp.size()), warp.data());
  const auto links = static_cast<py::ssize_t>(weft.size()) / simulator.rows();
  return py::make_tuple(rods, py::array_t<double>({py::ssize_t{simulator.rows()}, links}, weft.data()));
}

void bindTime(SimulatorClass& simulator) {
  simulator
      .def("step", &Self::step, py::arg("frames") = 1,
           "Makes so many frames of 1 / frame rate seconds, without the GIL. Ctrl-C stops between two frames.")
      .def(
          "reset", [](Self& self) { self.change([](Simulator& s) { s.reset(); }); },
          "Back to the scene's start: time 0, its winds and drags, zero statistics. Obstacles return to their scene "
          "poses and are all present; hands let go. What was changed of gravity, air, frame rate, friction and "
          "tolerances stays.")
      .def_property_readonly(
          "time", [](const Self& self) { return self.inspect().time(); }, "Simulated time [s].")
      .def_property_readonly(
          "rows", [](const Self& self) { return self.inspect().rows(); }, "Nodes along the warp.")
      .def_property_readonly(
          "columns", [](const Self& self) { return self.inspect().columns(); }, "Nodes along the weft, of all cloths.")
      .def_property_readonly(
          "layers",
          [](const Self& self) {
            py::dict columns;
            for (const Simulator::LayerColumns& layer : self.inspect().layers())
              columns[py::str(layer.name)] =
                  py::slice(layer.first_column, layer.first_column + layer.columns, py::ssize_t{1});
            return columns;
          },
          "Columns of each cloth, as slices by name: positions[:, layers[\"blackout\"]] are that layer's. The first "
          "cloth "
          "is \"cloth\".")
      .def_property_readonly(
          "scene", [](const Self& self) { return self.inspect().scene(); },
          "The scene, with the present values of what may change: gravity, air, frame rate, friction, "
          "tolerances, budget.");
}

void bindSaving(SimulatorClass& simulator) {
  simulator
      .def(
          "snapshot", [](const Self& self) { return py::bytes(self.inspect().snapshot()); },
          "The full state of the motion, as bytes that restore() takes; also those of snapshot files.")
      .def(
          "restore",
          [](Self& self, const py::bytes& snapshot) {
            const std::string bytes = snapshot;
            refuse(self.changeWithoutGil([&](Simulator& s) { return s.restore(bytes); }));
          },
          py::arg("snapshot"),
          "Continues from a snapshot of the same scene with the same bits. ValueError when it is damaged, cut short, "
          "or "
          "of another scene; then nothing changed. Releases the GIL.")
      .def(
          "state_hash", [](const Self& self) { return self.inspect().stateHash(); },
          "Hash of the bits of positions and velocities (FNV-1a, 64 bits).");
}

void bindArrays(SimulatorClass& simulator) {
  simulator.def_property_readonly("positions", &Self::positions, "[m], shape (rows, columns, 3); live, read-only.")
      .def_property_readonly("velocities", &Self::velocities,
                             "[m/s], at the same instant as the positions, shape (rows, columns, 3); live, read-only.")
      .def_property_readonly("forces", &Self::forces,
                             "External force on each node in the last substep [N]: gravity, wind, damping, drag and "
                             "contact, without the links' tensions; shape (rows, columns, 3); live, read-only.")
      .def_property_readonly("contact_forces", &Self::contactForces,
                             "The contacts' part of the forces [N], shape (rows, columns, 3); live, read-only.")
      .def_property_readonly("warp_tensions", &Self::warpTensions,
                             "Tension of the rod above each node in the last substep [N], negative where it is pushed; "
                             "row 0: 0; shape (rows, columns); live, read-only.")
      .def_property_readonly(
          "weft_tensions", &Self::weftTensions,
          "Tension of the link left of each node in the last substep [N], 0 where it is slack; column "
          "0: of the link that closes the ring, or 0; shape (rows, columns); live, read-only.")
      .def_property_readonly("fine_positions", &Self::finePositions,
                             "Nodes of the mesh for display [m]: both layers, outside the obstacles; shape (rows, fine "
                             "columns, 3); live, read-only.")
      .def_property_readonly(
          "fine_triangles",
          [](const py::object& self) {
            const auto& triangles = self.cast<const Self&>().inspect().fineMeshTopology().triangles;
            return readOnlyArray(py::dtype::of<std::uint32_t>(), {static_cast<py::ssize_t>(triangles.size()), 3},
                                 triangles.data(), self);
          },
          "Triangles over the rows of fine_positions.reshape(-1, 3), of equal winding; they never "
          "change; shape (n, 3), uint32; read-only.");
}

void bindNodes(SimulatorClass& simulator) {
  simulator
      .def(
          "set_state",
          [](Self& self, const py::object& positions, const py::object& velocities) {
            const Simulator& now = self.inspect();
            const auto p = readField(positions, "positions", now.rows(), now.columns());
            const auto v = readField(velocities, "velocities", now.rows(), now.columns());
            refuse(self.change([&](Simulator& s) { return s.setState(p, v); }));
          },
          py::arg("positions"), py::arg("velocities"),
          "Sets positions [m] and velocities [m/s] of all nodes, both of shape (rows, columns, 3). Velocities of "
          "pinned "
          "nodes are ignored, carriers are put where the rail is nearest. The time stays.")
      .def(
          "fine_normals",
          [](const Self& self) {
            FineMesh mesh;
            self.inspect().copyFineMesh(mesh);
            std::vector<Vec3> normals;
            fineMeshNormals(self.inspect().fineMeshTopology(), mesh, normals);
            const auto& grid = self.inspect().fineMeshTopology();
            return py::array_t<double>({grid.rows, grid.columns, 3}, normals.data()->data());
          },
          "Unit normals of the mesh for display, shape (rows, fine columns, 3).")
      .def(
          "nearest_node",
          [](const Self& self, const py::object& point) {
            return toTuple(self.inspect().nearestNode(readPoint(point, "point")));
          },
          py::arg("point"), "Node nearest to a point [m], as (row, column).")
      .def(
          "masses",
          [](const Self& self) {
            const Simulator& s = self.inspect();
            return onGrid<double>(s, [&](NodeIndex node) { return s.mass(node); });
          },
          "[kg], of nodes with their carriers, shape (rows, columns).")
      .def(
          "pinned",
          [](const Self& self) {
            const Simulator& s = self.inspect();
            return onGrid<bool>(s, [&](NodeIndex node) { return s.pinned(node); });
          },
          "Whether a node's position is prescribed, or a rigid hand's; bool, shape (rows, columns).")
      .def(
          "rods",
          [](const Self& self) {
            std::vector<double> rods;
            self.inspect().copyRods(rods);
            const py::ssize_t rows = self.inspect().rows() - 1, columns = self.inspect().columns();
            return py::array_t<double>({rows, columns}, rods.data());
          },
          "Rest lengths of the rods of all columns [m], shape (rows - 1, columns).")
      .def(
          "rest_lengths", [](const Self& self) { return restLengths(self.inspect()); },
          "Rest lengths [m]: of the first cloth's rods between two rows, from the top down, shape (rows - 1,), and of "
          "the weft "
          "links, "
          "shape (rows, links); closed cloth has as many links as columns, other cloth one less.");
}

}  // namespace

void bindState(SimulatorClass& simulator) {
  bindTime(simulator);
  bindSaving(simulator);
  bindArrays(simulator);
  bindNodes(simulator);
}

}  // namespace curtain::python
