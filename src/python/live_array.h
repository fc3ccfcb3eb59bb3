// SPDX-License-Identifier: BSD-3-Clause
//
// A field of the simulator's state as NumPy sees it. The engine keeps x, y and z apart, padded, and brings velocities
// to the time of the positions only when asked; an array of shape [rows, columns, 3] cannot lie on that. So the field
// is written out row-major, once a step and only while somebody holds an array on it; access copies nothing.
#pragma once

#include <pybind11/numpy.h>

#include <functional>
#include <memory>
#include <vector>

#include "curtain_sim/simulator.h"

namespace curtain::python {

/// An array on this memory that keeps its owner alive, read-only.
inline pybind11::array readOnlyArray(const pybind11::dtype& type, const std::vector<pybind11::ssize_t>& shape,
                                     const void* data, const pybind11::handle& owner) {
  pybind11::array array(type, shape, data, owner);
  pybind11::detail::array_proxy(array.ptr())->flags &= ~pybind11::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return array;
}

/// Value: double or Vec3. Needs the GIL.
template <typename Value>
class LiveArray {
 public:
  /// Writes the field; the size is always the same.
  using Fill = std::function<void(const Simulator&, std::vector<Value>&)>;

  LiveArray(std::vector<pybind11::ssize_t> shape, Fill fill) : shape_(std::move(shape)), fill_(std::move(fill)) {}

  /// An array of the present values, which renew() keeps up to date. It outlives the simulator, with the last values.
  pybind11::array view(const Simulator& simulator) {
    if (!fresh_) write(simulator);
    auto* const share = new std::shared_ptr<std::vector<Value>>(values_);
    const pybind11::capsule owner(share, [](void* p) { delete static_cast<std::shared_ptr<std::vector<Value>>*>(p); });
    return readOnlyArray(pybind11::dtype::of<double>(), shape_, values_->data(), owner);
  }

  /// After any change of the simulator.
  void renew(const Simulator& simulator) {
    fresh_ = false;
    if (values_.use_count() > 1) write(simulator);
  }

 private:
  void write(const Simulator& simulator) {
    fill_(simulator, *values_);
    fresh_ = true;
  }

  std::vector<pybind11::ssize_t> shape_;
  Fill fill_;
  std::shared_ptr<std::vector<Value>> values_ = std::make_shared<std::vector<Value>>();
  bool fresh_ = false;
};

}  // namespace curtain::python
