// SPDX-License-Identifier: BSD-3-Clause
//
// Statistics, energy, work, and what a step does.
#include "python/arguments.h"
#include "python/bindings.h"

namespace py = pybind11;

namespace curtain::python {
namespace {

using Self = PythonSimulator;

// Every member of Statistics, under its name: test/python asks for that.
py::dict statisticsOf(const Simulator& simulator) {
  const Statistics& s = simulator.statistics();
  py::dict stages;
  for (int stage = 0; stage < kStageCount; ++stage)
    stages[stageName(static_cast<Stage>(stage))] = s.stage_seconds.at(static_cast<std::size_t>(stage));
  using namespace py::literals;
  return py::dict(
      "frames"_a = s.frames, "time"_a = s.time, "substeps"_a = s.substeps, "substeps_last"_a = s.substeps_last,
      "sweeps"_a = s.sweeps, "sweeps_last"_a = s.sweeps_last, "rejected"_a = s.rejected,
      "last_resort_substeps"_a = s.last_resort_substeps, "unsettled"_a = s.unsettled,
      "asleep_frames"_a = s.asleep_frames, "wakes"_a = s.wakes, "asleep"_a = s.asleep,
      "estimates_skipped"_a = s.estimates_skipped, "longer_substeps"_a = s.longer_substeps,
      "unfinished_substeps"_a = s.unfinished_substeps, "shortened_frames"_a = s.shortened_frames,
      "lost_time"_a = s.lost_time, "late_frames"_a = s.late_frames, "stops"_a = s.stops, "stops_last"_a = s.stops_last,
      "momentum_cut"_a = s.momentum_cut, "momentum_cut_last"_a = s.momentum_cut_last, "quality"_a = toString(s.quality),
      "obstacles_waited"_a = s.obstacles_waited, "warp_stretch"_a = s.warp_stretch, "weft_stretch"_a = s.weft_stretch,
      "warp_compression"_a = s.warp_compression, "warp_stretch_max"_a = s.warp_stretch_max,
      "weft_stretch_max"_a = s.weft_stretch_max, "warp_compression_max"_a = s.warp_compression_max,
      "contacts"_a = s.contacts, "contacts_max"_a = s.contacts_max, "penetration_max"_a = s.penetration_max,
      "step_seconds"_a = s.step_seconds, "step_seconds_max"_a = s.step_seconds_max,
      "step_seconds_sum"_a = s.step_seconds_sum, "stage_seconds"_a = stages, "opening"_a = s.opening,
      "drive_force"_a = s.drive_force, "position_error"_a = s.position_error, "finite"_a = s.finite);
}

py::dict workOf(const Simulator& simulator) {
  const Work work = simulator.work();
  using namespace py::literals;
  return py::dict("gravity"_a = work.gravity, "elastic"_a = work.elastic, "dissipated"_a = work.dissipated,
                  "forces"_a = work.forces, "drive"_a = work.drive, "pins"_a = work.pins,
                  "obstacles"_a = work.obstacles, "kinetic"_a = work.kinetic);
}

py::dict energyOf(const Simulator& simulator) {
  const Energy energy = simulator.energy();
  using namespace py::literals;
  return py::dict("kinetic"_a = energy.kinetic, "potential"_a = energy.potential);
}

}  // namespace

void bindMeasures(SimulatorClass& simulator) {
  simulator
      .def_property_readonly(
          "statistics", [](const Self& self) { return statisticsOf(self.inspect()); },
          "Counters since the start or reset(), a new dict with the members of the engine's "
          "Statistics (include/curtain_sim/statistics.h).")
      .def_property_readonly(
          "energy", [](const Self& self) { return energyOf(self.inspect()); },
          "Kinetic and potential energy of the cloth [J], a new dict.")
      .def(
          "count_work", [](Self& self, bool counted) { self.change([&](Simulator& s) { s.countWork(counted); }); },
          py::arg("counted"), "Starts (from zero) or stops counting work; counting costs about 5 % of a step.")
      .def_property_readonly(
          "work", [](const Self& self) { return workOf(self.inspect()); },
          "Work on the cloth counted so far [J], a new dict: gravity, elastic, dissipated, forces, drive, pins, "
          "obstacles; and kinetic, the increase of the kinetic energy.")
      .def(
          "plan", [](const Self& self) { return describe(self.inspect().plan()); },
          "What a step would do now, what it would skip, and why, in words, a line each.")
      .def(
          "self_crossings", [](const Self& self) { return self.inspect().selfCrossings(); },
          "Pairs of an edge and a triangle of the cloth that intersect, by brute force (slow).");
}

}  // namespace curtain::python
