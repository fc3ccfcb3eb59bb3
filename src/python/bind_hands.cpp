// SPDX-License-Identifier: BSD-3-Clause
//
// Pins that move, and hands.
#include "python/arguments.h"
#include "python/bindings.h"
#include "python/yaml_values.h"

namespace py = pybind11;

namespace curtain::python {
namespace {

using Self = PythonSimulator;

constexpr double kNone = std::numeric_limits<double>::infinity();

// Exactly one of radius, size and nodes says which nodes a hand takes.
void readRegion(const py::object& radius, const py::object& size, const py::object& nodes, const Simulator& simulator,
                GraspParams& grasp) {
  const int given = (radius.is_none() ? 0 : 1) + (size.is_none() ? 0 : 1) + (nodes.is_none() ? 0 : 1);
  if (given != 1) {
    throw py::value_error("grasp: must have one of radius (a ball), size (a box) and nodes, has " +
                          std::string(given == 0 ? "none" : "more"));
  }
  if (!radius.is_none()) {
    grasp.region = GraspRegion::kSphere;
    grasp.radius = readArray(radius, "grasp.radius", {}).data()[0];
  } else if (!size.is_none()) {
    grasp.region = GraspRegion::kBox;
    grasp.size = readPoint(size, "grasp.size");
  } else {
    grasp.region = GraspRegion::kNodes;
    for (const py::handle node : py::iter(nodes)) {
      const std::string name = "grasp.nodes[" + std::to_string(grasp.nodes.size()) + "]";
      grasp.nodes.push_back(readNode(py::reinterpret_borrow<py::object>(node), name, simulator));
    }
  }
}

void setGrasp(Self& self, const std::string& id, const py::object& position, const py::object& orientation,
              const py::object& radius, const py::object& size, const py::object& nodes, double stiffness,
              double break_force, double pinch_force, double friction) {
  GraspParams grasp;
  grasp.id = id;
  grasp.frame = readPose(position, orientation, "grasp");
  readRegion(radius, size, nodes, self.inspect(), grasp);
  grasp.stiffness = stiffness;
  grasp.break_force = break_force;
  grasp.pinch_force = pinch_force;
  grasp.friction = friction;
  refuse(self.change([&](Simulator& s) { return s.setGrasp(grasp); }));
}

void moveGrasp(Self& self, const std::string& id, const py::object& position, const py::object& orientation) {
  const Pose frame = readPose(position, orientation, "grasp");
  if (!self.change([&](Simulator& s) { return s.moveGrasp(id, frame); }))
    throw py::value_error("no grasp \"" + id + "\" holds");
}

py::object graspState(const Self& self, const std::string& id) {
  const std::optional<GraspState> state = self.inspect().graspState(id);
  if (!state) return py::none();
  py::list nodes;
  for (const NodeIndex node : state->nodes) nodes.append(toTuple(node));
  py::dict values;
  values["nodes"] = nodes;
  values["force"] = toArray(state->force);
  values["torque"] = toArray(state->torque);
  values["slipped"] = state->slipped;
  values["holds"] = state->end == GraspEnd::kNone;
  values["end"] = state->end == GraspEnd::kNone ? "" : toString(state->end);
  return py::object(values);
}

void movePin(Self& self, const py::object& node, const py::object& target) {
  const NodeIndex pin = readNode(node, "node", self.inspect());
  const Vec3 point = readPoint(target, "target");
  if (self.change([&](Simulator& s) { return s.movePin(pin, point); })) return;
  throw py::value_error("node (" + std::to_string(pin.row) + ", " + std::to_string(pin.column) +
                        "): is not pinned, or a hand holds it");
}

}  // namespace

void bindHands(SimulatorClass& simulator) {
  const py::tuple unturned = py::make_tuple(0.0, 0.0, 0.0, 1.0);
  simulator
      .def("move_pin", &movePin, py::arg("node"), py::arg("target"),
           "Moves a pinned node to a point [m], evenly over the next frame; there it stays. node: (row, column).")
      .def("set_grasp", &setGrasp, py::arg("id"), py::arg("position"), py::arg("orientation") = unturned,
#if PYBIND11_VERSION_MAJOR > 2 || PYBIND11_VERSION_MINOR >= 6  // before, these can be given by position, too
           py::kw_only(),
#endif
           py::arg("radius") = py::none(), py::arg("size") = py::none(), py::arg("nodes") = py::none(),
           py::arg("stiffness") = kNone, py::arg("break_force") = kNone, py::arg("pinch_force") = kNone,
           py::arg("friction") = 0.5,
           "A hand takes hold of the cloth where it is now.\n\n"
           "position [m] and orientation (unit quaternion x, y, z, w): of the gripper. One of radius (of a ball [m]), "
           "size (edges of a box [m], shape (3,)), both around the gripper's origin, and nodes (list of (row, column)) "
           "says what it takes. stiffness [N/m], break_force [N]: infinite, it neither gives nor loses the cloth. "
           "pinch_force [N] of two pads with this friction: beyond 2 friction pinch_force the cloth slides out.")
      .def("move_grasp", &moveGrasp, py::arg("id"), py::arg("position"), py::arg("orientation") = unturned,
           "Pose of the gripper at the end of the next frame; what it holds moves there evenly, and stays. ValueError: "
           "no grasp of this id holds.")
      .def(
          "release_grasp",
          [](Self& self, const std::string& id) {
            return self.change([&](Simulator& s) { return s.releaseGrasp(id); });
          },
          py::arg("id"), "Lets go; the cloth keeps its velocity. False: there is no grasp of this id.")
      .def(
          "release_all_grasps", [](Self& self) { self.change([](Simulator& s) { s.releaseAllGrasps(); }); },
          "As release_grasp(), of all.")
      .def("grasp_state", &graspState, py::arg("id"),
           "How a grasp goes or how it ended, None where there is none: nodes that it holds; force of the cloth on the "
           "hand [N] and torque about the gripper's origin [N m], mean over the last frame, along the world's axes; "
           "slipped, way of the cloth between the pads [m]; holds; end: \"\", \"broken\" or \"slipped_out\"; of hands "
           "of "
           "the scene also \"waiting\", \"missed\" or \"released\".")
      .def_property_readonly(
          "grasps",
          [](const Self& self) {
            py::list ids;
            for (const std::string& id : self.inspect().grasps()) ids.append(id);
            return ids;
          },
          "Ids of the grasps that hold or have ended, and of the scene's hands.");
}

}  // namespace curtain::python
