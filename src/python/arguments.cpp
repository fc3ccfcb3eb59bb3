// SPDX-License-Identifier: BSD-3-Clause
#include "python/arguments.h"

#include <array>
#include <cmath>
#include <limits>

#include "python/yaml_values.h"

namespace py = pybind11;

namespace curtain::python {
namespace {

std::string shapeText(const Shape& shape) {
  std::string text = "(";
  for (const py::ssize_t length : shape) text += (length < 0 ? "n" : std::to_string(length)) + ", ";
  if (shape.size() == 1) return text.substr(0, text.size() - 1) + ")";
  return (shape.empty() ? text : text.substr(0, text.size() - 2)) + ")";
}

[[noreturn]] void refuseArray(const std::string& name, const Shape& shape, const std::string& is) {
  throw py::value_error(name + ": must be an array of real numbers of shape " + shapeText(shape) + ", is " + is);
}

bool hasShape(const py::array& array, const Shape& shape) {
  if (array.ndim() != static_cast<py::ssize_t>(shape.size())) return false;
  for (std::size_t k = 0; k < shape.size(); ++k) {
    if (shape[k] >= 0 && array.shape(static_cast<py::ssize_t>(k)) != shape[k]) return false;
  }
  return true;
}

// numpy.asarray(), and what it has to say of what is no array: of lists with unequal lengths, mostly.
py::array asArray(const py::object& given, const std::string& name, const Shape& shape) {
  py::object array = py::reinterpret_steal<py::object>(py::detail::npy_api::get().PyArray_FromAny_(
      given.ptr(), nullptr, 0, 0, py::detail::npy_api::NPY_ARRAY_ENSUREARRAY_, nullptr));
  if (array) return py::reinterpret_borrow<py::array>(array);
  py::error_already_set error;
  if (!error.matches(PyExc_ValueError) && !error.matches(PyExc_TypeError)) throw error;
  refuseArray(name, shape, "none: " + std::string(py::str(error.value())));
}

bool isNumber(const py::array& array) {
  const char kind = array.dtype().kind();
  return kind == 'f' || kind == 'i' || kind == 'u';
}

}  // namespace

py::array_t<double> readArray(const py::object& given, const std::string& name, const Shape& shape) {
  if (py::hasattr(given, "mask")) refuseArray(name, shape, "masked");
  const py::array array = asArray(given, name, shape);
  if (!isNumber(array)) refuseArray(name, shape, "of dtype " + std::string(py::str(array.dtype())));
  if (!hasShape(array, shape))
    refuseArray(name, shape, "of shape " + shapeText(Shape(array.shape(), array.shape() + array.ndim())));
  return py::array_t<double, py::array::c_style | py::array::forcecast>(array);
}

Vec3 readPoint(const py::object& given, const std::string& name) {
  const py::array_t<double> array = readArray(given, name, {3});
  const Vec3 point(array.at(0), array.at(1), array.at(2));
  if (!point.allFinite())
    throw py::value_error(name + ": must be finite, is " + std::string(py::str(py::object(array))));
  return point;
}

std::vector<Vec3> readField(const py::object& given, const std::string& name, int rows, int columns) {
  const py::array_t<double> array = readArray(given, name, {rows, columns, 3});
  std::vector<Vec3> field(static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns));
  const double* value = array.data();
  for (Vec3& entry : field) {
    entry = Vec3(value[0], value[1], value[2]);
    value += 3;
  }
  return field;
}

NodeIndex readNode(const py::object& given, const std::string& name, const Simulator& simulator) {
  const auto outside = [&]() {
    return py::value_error(name + ": must be (row, column), integers in [0, " + std::to_string(simulator.rows() - 1) +
                           "] and [0, " + std::to_string(simulator.columns() - 1) + "], is " +
                           std::string(py::repr(given)));
  };
  const py::array array = asArray(given, name, {2});
  const char kind = array.dtype().kind();
  if ((kind != 'i' && kind != 'u') || !hasShape(array, {2})) throw outside();
  const py::array_t<std::int64_t, py::array::c_style | py::array::forcecast> pair(array);
  const bool inside =
      pair.at(0) >= 0 && pair.at(0) < simulator.rows() && pair.at(1) >= 0 && pair.at(1) < simulator.columns();
  if (!inside) throw outside();
  return {static_cast<int>(pair.at(0)), static_cast<int>(pair.at(1))};
}

Pose readPose(const py::object& position, const py::object& orientation, const std::string& name) {
  ObstacleParams moved;  // an obstacle's pose has all the checks
  moved.name = name;
  moved.radius = 1.0;
  moved.pose.position = readPoint(position, name + ".position");
  const py::array_t<double> q = readArray(orientation, name + ".orientation", {4});
  moved.pose.orientation = Rotation(q.at(3), q.at(0), q.at(1), q.at(2));
  refuse(validate(moved, name));
  moved.pose.orientation.normalize();
  return moved.pose;
}

py::array_t<double> toArray(const Vec3& vector) { return py::array_t<double>(3, vector.data()); }

py::array_t<double> toArray(const Rotation& rotation) {
  const std::array<double, 4> values = {rotation.x(), rotation.y(), rotation.z(), rotation.w()};
  return py::array_t<double>(4, values.data());
}

py::tuple toTuple(NodeIndex node) { return py::make_tuple(node.row, node.column); }

}  // namespace curtain::python
