// SPDX-License-Identifier: BSD-3-Clause
//
// Arguments of methods: arrays, points, nodes and poses out of whatever NumPy makes an array of. What is wrong with one
// is a ValueError that names it, what it must be, and what it is.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <string>
#include <vector>

#include "curtain_sim/simulator.h"

namespace curtain::python {

using Shape = std::vector<pybind11::ssize_t>;

/// Real numbers as doubles in C order. -1 in the shape: any length there.
pybind11::array_t<double> readArray(const pybind11::object& given, const std::string& name, const Shape& shape);

/// Three finite numbers.
Vec3 readPoint(const pybind11::object& given, const std::string& name);

/// Of shape [rows, columns, 3], as Simulator::setState() takes them.
std::vector<Vec3> readField(const pybind11::object& given, const std::string& name, int rows, int columns);

/// A pair (row, column) on the grid.
NodeIndex readNode(const pybind11::object& given, const std::string& name, const Simulator& simulator);

/// A position [m] and a unit quaternion x, y, z, w, within the ranges of scene files; name: of the moved thing.
Pose readPose(const pybind11::object& position, const pybind11::object& orientation, const std::string& name);

/// A new array of 3.
pybind11::array_t<double> toArray(const Vec3& vector);
/// The quaternion x, y, z, w.
pybind11::array_t<double> toArray(const Rotation& rotation);
pybind11::tuple toTuple(NodeIndex node);  ///< (row, column)

}  // namespace curtain::python
