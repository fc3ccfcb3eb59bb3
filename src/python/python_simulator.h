// SPDX-License-Identifier: BSD-3-Clause
//
// A simulator as Python holds it: with arrays on its state, and a guard. The GIL is released while frames are made, so
// another thread may call in; that call is refused, for a simulator is not thread-safe.
#pragma once

#include <pybind11/pybind11.h>

#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

#include "curtain_sim/simulator.h"
#include "python/live_array.h"

namespace curtain::python {

class PythonSimulator {
 public:
  /// Releases the GIL. Throws std::invalid_argument, as Simulator does.
  explicit PythonSimulator(const Scene& scene);

  /// For looking; RuntimeError while another thread makes frames.
  const Simulator& inspect() const {
    checkFree();
    return simulator_;
  }

  /// Calls change(simulator) and brings the arrays up to date; RuntimeError as above.
  template <typename Change>
  auto change(const Change& change) {
    checkFree();
    if constexpr (std::is_void_v<decltype(change(simulator_))>) {
      change(simulator_);
      renewArrays();
    } else {
      auto result = change(simulator_);
      renewArrays();
      return result;
    }
  }

  /// The same without the GIL: change() must not touch Python.
  template <typename Change>
  auto changeWithoutGil(const Change& change) {
    checkFree();
    const InUse in_use(*this);
    const auto released = [&] {
      const pybind11::gil_scoped_release release;
      return change(simulator_);
    };
    auto result = released();
    renewArrays();
    return result;
  }

  /// Makes frames without the GIL; now and then looks for signals, as of Ctrl-C, and then raises what they raise.
  void step(std::int64_t frames);

  /// Arrays on the present state, read-only. See LiveArray.
  pybind11::array positions() { return positions_.view(inspect()); }
  pybind11::array velocities() { return velocities_.view(inspect()); }         ///< [m/s]
  pybind11::array forces() { return forces_.view(inspect()); }                 ///< [N]
  pybind11::array contactForces() { return contact_forces_.view(inspect()); }  ///< [N]
  pybind11::array warpTensions() { return warp_tensions_.view(inspect()); }    ///< [N]
  pybind11::array weftTensions() { return weft_tensions_.view(inspect()); }    ///< [N]
  pybind11::array finePositions() { return fine_positions_.view(inspect()); }  ///< [m]

  /// Number of the obstacle in the scene; ValueError when there is none of this name.
  int obstacle(const std::string& name) const;
  std::vector<std::string> obstacles() const;  ///< names, in the scene's order

 private:
  // Read and written under the GIL.
  class InUse {
   public:
    explicit InUse(PythonSimulator& owner) : owner_(owner) { owner_.in_use_ = true; }
    ~InUse() { owner_.in_use_ = false; }
    InUse(const InUse&) = delete;
    InUse& operator=(const InUse&) = delete;

   private:
    PythonSimulator& owner_;
  };

  void checkFree() const;
  void renewArrays();

  Simulator simulator_;
  bool in_use_ = false;
  LiveArray<Vec3> positions_, velocities_, forces_, contact_forces_;
  LiveArray<double> warp_tensions_, weft_tensions_;
  LiveArray<Vec3> fine_positions_;
};

}  // namespace curtain::python
