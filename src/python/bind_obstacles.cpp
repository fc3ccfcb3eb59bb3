// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include "python/arguments.h"
#include "python/bindings.h"
#include "python/yaml_values.h"

namespace py = pybind11;

namespace curtain::python {
namespace {

using Self = PythonSimulator;

void setPose(Self& self, const std::string& name, const py::object& position, const py::object& orientation,
             bool jump) {
  const int index = self.obstacle(name);
  const py::object turned =
      orientation.is_none() ? toArray(self.inspect().obstacleTarget(index).orientation) : orientation;
  const Pose pose = readPose(position, turned, name);
  self.change([&](Simulator& s) { s.setObstaclePose(index, pose, jump); });
}

py::tuple poseTuple(const Pose& pose) { return py::make_tuple(toArray(pose.position), toArray(pose.orientation)); }

py::dict wrenchOn(const Self& self, const std::string& name) {
  const ContactWrench wrench = self.inspect().contactWrench(self.obstacle(name));
  py::dict values;
  values["force"] = toArray(wrench.force);
  values["torque"] = toArray(wrench.torque);
  values["contacts"] = wrench.contacts;
  values["time"] = wrench.time;
  return values;
}

py::dict contactPoints(const Self& self) {
  std::vector<ContactForce> contacts;
  self.inspect().copyContactPoints(contacts);
  const auto count = static_cast<py::ssize_t>(contacts.size());
  const auto vectors = [&](const Vec3 ContactForce::*member) {
    py::array_t<double> array({count, py::ssize_t{3}});
    double* out = array.mutable_data();
    for (const ContactForce& contact : contacts) out = std::copy_n((contact.*member).data(), 3, out);
    return array;
  };
  py::array_t<std::int64_t> obstacle(count);
  py::array_t<double> normal_force(count);
  for (py::ssize_t k = 0; k < count; ++k) {
    obstacle.mutable_at(k) = contacts[static_cast<std::size_t>(k)].obstacle;
    normal_force.mutable_at(k) = contacts[static_cast<std::size_t>(k)].normal_force;
  }
  py::dict values;
  values["obstacle"] = obstacle;
  values["position"] = vectors(&ContactForce::position);
  values["normal"] = vectors(&ContactForce::normal);
  values["normal_force"] = normal_force;
  values["friction"] = vectors(&ContactForce::friction);
  return values;
}

py::dict distanceOf(const Self& self, const std::string& name) {
  const ObstacleDistance found = self.inspect().obstacleDistance(self.obstacle(name));
  py::dict values;
  values["distance"] = found.distance;
  values["on_cloth"] = toArray(found.on_cloth);
  values["on_obstacle"] = toArray(found.on_obstacle);
  return values;
}

py::dict piercings(const Self& self, const std::string& name, double tolerance, bool fine) {
  if (!(tolerance >= 0.0 && std::isfinite(tolerance)))
    throw py::value_error("tolerance: must be a finite number >= 0 [m], is " +
                          std::string(py::str(py::float_(tolerance))));
  const int index = self.obstacle(name);
  const Piercings found =
      fine ? self.inspect().finePiercings(index, tolerance) : self.inspect().piercings(index, tolerance);
  py::dict values;
  values["nodes"] = found.nodes;
  values["edges"] = found.edges;
  values["faces"] = found.faces;
  return values;
}

}  // namespace

void bindObstacles(SimulatorClass& simulator) {
  simulator
      .def_property_readonly(
          "obstacles",
          [](const Self& self) {
            py::list names;
            for (const std::string& name : self.obstacles()) names.append(name);
            return names;
          },
          "Names of the obstacles, in the scene's order.")
      .def("set_obstacle_pose", &setPose, py::arg("name"), py::arg("position"), py::arg("orientation") = py::none(),
           py::arg("jump") = false,
           "Pose of an obstacle at the end of the next frame: position [m], orientation (unit quaternion x, y, z, w; "
           "None: that of its target). It moves there smoothly, in place of the scene's motion, but waits where the "
           "cloth "
           "is jammed in its way. jump: it is there at once, without a velocity.")
      .def(
          "obstacle_pose",
          [](const Self& self, const std::string& name) {
            return poseTuple(self.inspect().obstaclePose(self.obstacle(name)));
          },
          py::arg("name"),
          "Position [m], shape (3,), and orientation (x, y, z, w), shape (4,): where it is for the cloth, at the end "
          "of "
          "the last frame.")
      .def(
          "obstacle_target",
          [](const Self& self, const std::string& name) {
            return poseTuple(self.inspect().obstacleTarget(self.obstacle(name)));
          },
          py::arg("name"), "The same of where it is going: as set last, or by the scene's motion.")
      .def(
          "obstacle_lag",
          [](const Self& self, const std::string& name) { return self.inspect().obstacleLag(self.obstacle(name)); },
          py::arg("name"),
          "How far it is behind its target [m], >= 0: no point of it is further from where it will be there. After a "
          "frame 0, unless it waits for jammed cloth, was cut short by solver.budget_ms, or catches up.")
      .def(
          "set_obstacle_present",
          [](Self& self, const std::string& name, bool present) {
            const int index = self.obstacle(name);
            self.change([&](Simulator& s) { s.setObstaclePresent(index, present); });
          },
          py::arg("name"), py::arg("present"),
          "An absent obstacle touches nothing. When it comes back, set its pose with jump.")
      .def(
          "obstacle_present",
          [](const Self& self, const std::string& name) { return self.inspect().obstaclePresent(self.obstacle(name)); },
          py::arg("name"), "As set; at the start: True.")
      .def("contact_wrench", &wrenchOn, py::arg("name"),
           "Force [N] and torque [N m] of the cloth on an obstacle, about the origin of its frame, along the world's "
           "axes, mean over the last frame; contacts: that pushed at its end; time: that the forces acted for [s], "
           "times "
           "which they are the momentum given.")
      .def("contact_points", &contactPoints,
           "Where the cloth presses on obstacles, sorted by their names: a dict of arrays with one entry a place. "
           "obstacle: its number in obstacles, shape (n,); position of the cloth [m] and normal (unit, out of the "
           "obstacle), shape (n, 3); normal_force [N], > 0, shape (n,); friction of the cloth on the obstacle [N], "
           "shape "
           "(n, 3).")
      .def("obstacle_distance", &distanceOf, py::arg("name"),
           "Where the cloth is nearest to an obstacle, or deepest in it: the distance [m], negative inside, infinite "
           "for "
           "an absent one; on_cloth and on_obstacle, the two points [m].")
      .def(
          "hides",
          [](const Self& self, const py::object& point, const py::object& direction) {
            const Vec3 at = readPoint(point, "point"), from = readPoint(direction, "direction");
            if (!(from.norm() > 0.0)) throw py::value_error("direction: must have a length > 0");
            return self.inspect().hides(at, from);
          },
          py::arg("point"), py::arg("direction") = py::make_tuple(0.0, 0.0, 1.0),
          "The cloth is between a point [m] and somebody far away in this direction.")
      .def(
          "covered",
          [](const Self& self, const std::string& name, const py::object& direction) {
            const Vec3 from = readPoint(direction, "direction");
            if (!(from.norm() > 0.0)) throw py::value_error("direction: must have a length > 0");
            return self.inspect().covered(self.obstacle(name), from);
          },
          py::arg("name"), py::arg("direction") = py::make_tuple(0.0, 0.0, 1.0),
          "Share of an obstacle's silhouette, in [0, 1], that the cloth hides from somebody far away in this "
          "direction, "
          "to about a hundredth; nan for an absent one and a plane.")
      .def(
          "piercings", &piercings, py::arg("name"), py::arg("depth_tolerance") = 1e-6, py::arg("fine") = false,
          "Nodes, edges and faces of the cloth that are deeper than the tolerance [m] in an obstacle or go through it, "
          "by brute force (slow). fine: of the mesh for display.");
}

}  // namespace curtain::python
