// SPDX-License-Identifier: BSD-3-Clause
//
// What bends and drapes, against what is known of it.
//
//   cantilever   a strip that stands out from a clamp and sinks under its weight: the heavy elastica
//                (test/truth/elastica_cantilever.csv), by the drop of its end
//   drape        Cusick's sample of an isotropic fabric against an elastic shell of triangles (bench/shell): both are
//   at
//                rest in one of several shapes, so means of some starts are compared
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <string>
#include <vector>

#include "bench/measure.h"
#include "bench/shell/shell.h"
#include "bench/studies.h"
#include "bench/table.h"
#include "curtain_sim/simulator.h"
#include "fit/drape.h"
#include "scene/pi.h"
#include "truth_table.h"

namespace curtain_bench {
namespace {

using curtain::Scene;
using curtain::Simulator;
using curtain::Vec3;

// ---- Cantilever

struct Strip {
  int rods = 0;
  double length = 1.0, density = 0.2;  // [m], [kg/m^2]
  double rigidity = 0.0;               // [N m]
};

// One more link is held fast: it is the clamp. The air damps the strip's lowest mode critically.
Scene standingOut(const Strip& strip) {
  const double link = strip.length / strip.rods;
  Scene scene;
  scene.cloth.rows = strip.rods + 2;
  scene.cloth.columns = 2;
  scene.cloth.height = strip.length + link;
  scene.cloth.width = 0.1 * strip.length;
  scene.cloth.surface_density = strip.density;
  scene.cloth.bending_warp = strip.rigidity;
  scene.hang.from = Vec3(0.0, 0.0, 2.0);
  scene.hang.to = Vec3(scene.cloth.width, 0.0, 2.0);
  scene.hang.tilt = 0.5 * curtain::kPi;
  scene.pins.kind = curtain::PinKind::kList;
  scene.pins.nodes = {{0, 0}, {0, 1}, {1, 0}, {1, 1}};
  // beta^2 sqrt(B / density) / L^2 with beta = 1.8751, of the strip without weight.
  const double lowest = 3.5160152685 * std::sqrt(strip.rigidity / strip.density) / (strip.length * strip.length);
  scene.air.inside = scene.air.border = scene.air.corner = 2.0 * lowest * strip.density / scene.air.density;
  scene.air.threshold = 1e6;  // linear throughout
  scene.solver.rest_speed = 0.0;
  scene.solver.threads = 1;
  return scene;
}

double dropOf(const Simulator& simulator) {
  return simulator.position({1, 0}).z() - simulator.position({simulator.rows() - 1, 0}).z();
}

// Until a second brings less than a millionth of its length, but for a minute at most.
double sinks(Simulator& simulator, double length, std::vector<double>& ms, int& substeps) {
  double before = -1.0;
  for (int second = 0; second < 60; ++second) {
    for (int frame = 0; frame < 60; ++frame) {
      simulator.step();
      ms.push_back(1e3 * simulator.statistics().step_seconds);
    }
    substeps = simulator.statistics().substeps_last;
    const double now = dropOf(simulator);
    if (std::abs(now - before) < 1e-6 * length) break;
    before = now;
  }
  return dropOf(simulator);
}

void cantilevers(const Options& options, Table& table) {
  for (const auto& row : curtain_test::readTruth("elastica_cantilever.csv")) {
    const double gamma = std::stod(row.at("Gamma")), exact = std::stod(row.at("H_over_L"));
    if (gamma != 1.0 && gamma != 10.0 && gamma != 100.0) continue;
    for (const int rods : {10, 20, 40, 80}) {
      if (options.quick && rods > 20) continue;
      for (const curtain::Method method : {curtain::Method::kAuto, curtain::Method::kImplicit}) {
        Strip strip;
        strip.rods = rods;
        const Scene plain;
        strip.rigidity = strip.density * plain.gravity.norm() * strip.length * strip.length * strip.length / gamma;
        Scene scene = standingOut(strip);
        scene.solver.method = method;
        Simulator simulator(scene);
        std::vector<double> ms;
        int substeps = 0;
        const double drop = sinks(simulator, strip.length, ms, substeps);
        table.row({"cantilever", "Gamma " + number(gamma), toString(method), number(rods), number(substeps),
                   number(median(ms)), number(drop), number(exact), number(std::abs(drop / exact - 1.0))});
      }
    }
  }
}

// ---- Drape

struct Isotropic {
  const char* name;
  double density, bending, shear;  // [kg/m^2], [N m], [N/m]
};
// Of cotton's and of a faille's weight and bending, and one between. A shell's shear holds for both of its directions.
const std::vector<Isotropic> kFabrics = {
    {"stiff", 0.12, 1.157e-5, 150.0}, {"between", 0.11, 5e-6, 100.0}, {"limp", 0.097, 1.863e-6, 60.0}};
constexpr int kRings = 8;

struct Mean {
  double mean = 0.0, spread = 0.0;
};
Mean meanOf(const std::vector<double>& values) {
  Mean result;
  const auto count = static_cast<double>(values.size());
  for (const double value : values) result.mean += value / count;
  for (const double value : values) result.spread += (value - result.mean) * (value - result.mean);
  result.spread = count > 1.0 ? std::sqrt(result.spread / (count - 1.0)) : 0.0;
  return result;
}

void drapes(const Options& options, Table& table) {
  const int starts = options.quick ? 2 : 5;
  for (const Isotropic& fabric : kFabrics) {
    if (options.quick && &fabric != &kFabrics.front()) continue;
    std::vector<double> coefficients, folds;
    const auto add = [&](const std::string& method, int nodes, double seconds) {
      const Mean share = meanOf(coefficients);
      table.row({fabric.name, method, number(nodes), number(share.mean), number(share.spread),
                 number(meanOf(folds).mean), number(seconds / starts)});
      coefficients.clear();
      folds.clear();
    };
    const auto timed = [](const std::function<void()>& made) {
      const auto begin = std::chrono::steady_clock::now();
      made();
      return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    };
    const double shell_seconds = timed([&] {
      for (int start = 1; start <= starts; ++start) {
        const curtain_shell::Reading reading = curtain_shell::drape(
            {fabric.density, fabric.bending, fabric.shear, 0.3, 0.0}, kRings, static_cast<unsigned>(start));
        coefficients.push_back(reading.coefficient);
        folds.push_back(reading.folds);
      }
    });
    add("shell", kRings, shell_seconds);
    for (const int nodes : {24, 36, 48}) {
      if (options.quick && nodes > 24) continue;
      curtain::ClothParams cloth;
      cloth.surface_density = fabric.density;
      cloth.bending_warp = cloth.bending_weft = cloth.bending_bias = fabric.bending;
      cloth.shear = fabric.shear;
      curtain_fit::DrapeTest test;
      test.nodes = nodes;
      test.starts = starts;
      const double seconds = timed([&] {
        for (const curtain_fit::DrapeReading& reading : curtain_fit::drape(cloth, test)) {
          coefficients.push_back(reading.coefficient);
          folds.push_back(reading.folds);
        }
      });
      add("auto", nodes, seconds);
    }
    std::fprintf(stderr, "fabric %s done\n", fabric.name);
  }
}

}  // namespace

void studyFabric(const Options& options) {
  Table strips(options.folder, "fabric.csv",
               {"test", "case", "method", "rods", "substeps", "ms_median", "drop_m", "exact_m", "error"});
  cantilevers(options, strips);
  Table samples(options.folder, "fabric_drape.csv",
                {"fabric", "method", "size", "coefficient", "spread", "folds", "seconds"});
  drapes(options, samples);
}

}  // namespace curtain_bench
