// SPDX-License-Identifier: BSD-3-Clause
//
// The hard spot: a sheet hung by two corners at 0.9 of its width and dropped flat. The tension gathers at the pins, and
// the falling sheet is caught by them with a snap, after which no two methods, nor two steps of one, agree in detail.
// So motion is compared with that of the finest run up to the first snap: the first frame at which the finest run has
// lost a hundredth of m g L of its energy, which is kept exactly until rods are caught.
#include <cmath>
#include <cstdio>

#include "bench/line_up.h"
#include "bench/measure.h"
#include "bench/rivals/rivals.h"
#include "bench/studies.h"
#include "bench/table.h"
#include "curtain_sim/scene.h"

namespace curtain_bench {
namespace {

struct Sheet {
  int rows;
  int columns;
  int frames;
  std::vector<int> substeps;  // of ours, besides their own choice
  int finest;                 // substeps of the reference
};

struct Reference {
  std::vector<Points> frames;  // from frame 1
  int snap = 0;                // the last frame before it
};

curtain::Scene sheetScene(const Sheet& sheet) {
  curtain::Scene scene;
  scene.cloth.rows = sheet.rows;
  scene.cloth.columns = sheet.columns;
  scene.cloth.height = scene.cloth.width = 1.0;
  scene.hang.from = curtain::Vec3::Zero();
  scene.hang.to = curtain::Vec3(0.9, 0.0, 0.0);
  scene.hang.tilt = 0.5 * 3.14159265358979323846;
  scene.pins.kind = curtain::PinKind::kTopCorners;
  return scene;
}

// The leapfrog with the most substeps and a tolerance well below what is compared.
Reference finestRun(const Sheet& sheet, const curtain::Scene& given, const ClothStart& start) {
  curtain::Scene scene = given;
  scene.solver.method = curtain::Method::kLeapfrog;
  scene.solver.substeps = sheet.finest;
  scene.solver.stretch_tolerance = 1e-5;
  scene.solver.max_sweeps = 1000;
  const auto contestant = makeOurs(scene);
  double weight = 0.0;
  for (const double mass : start.mass) weight -= mass * start.gravity[2];
  const double first = gravityEnergy(start, start.positions);
  Reference reference;
  const int frames = std::min(sheet.frames, 60);
  run(start, *contestant, frames, 120.0, [&](int frame, const Contestant& now, const Points& positions) {
    reference.frames.push_back(positions);
    const bool lost = first - totalEnergy(start, now) > 0.01 * weight * scene.cloth.height;
    if (!lost && reference.snap == frame - 1) reference.snap = frame;
  });
  return reference;
}

std::vector<Entry> entriesOfSheet(const Sheet& sheet, bool large) {
  std::vector<Entry> entries = ourEntries(sheet.substeps);
  const auto add = [&entries](const char* method, const char* setting, auto make) {
    entries.push_back({method, setting, make, true});
  };
  using curtain::Scene;
  add("XPBD", "substeps 64; iterations 1; compliance 0 m/N", [](const Scene&, const ClothStart& start) {
    return makeXpbd(start, {64, 1, 0.0});
  });
  if (large) return entries;
  add("XPBD", "substeps 256; iterations 1; compliance 0 m/N", [](const Scene&, const ClothStart& start) {
    return makeXpbd(start, {256, 1, 0.0});
  });
  add("XPBD", "substeps 1024; iterations 1; compliance 0 m/N", [](const Scene&, const ClothStart& start) {
    return makeXpbd(start, {1024, 1, 0.0});
  });
  add("PBD", "substeps 4; iterations 30", [](const Scene&, const ClothStart& start) {
    return makePbd(start, {4, 30, 0.0});
  });
  add("PBD", "substeps 16; iterations 30", [](const Scene&, const ClothStart& start) {
    return makePbd(start, {16, 30, 0.0});
  });
  add("Baraff-Witkin", "substeps 8; stiffness 1000 N/m; tolerance 0.01", [](const Scene&, const ClothStart& start) {
    return makeBaraffWitkin(start, {8, 1e3, 1e-2, 400});
  });
  add("Baraff-Witkin", "substeps 16; stiffness 10000 N/m; tolerance 0.001", [](const Scene&, const ClothStart& start) {
    return makeBaraffWitkin(start, {16, 1e4, 1e-3, 400});
  });
  add("symplectic Euler", "substeps 256; dt*omega 1; dashpot 0.2", [](const Scene&, const ClothStart& start) {
    return makeSymplecticEuler(start, {256, 1.0, 0.2});
  });
  add("symplectic Euler", "substeps 1024; dt*omega 1; dashpot 0.2", [](const Scene&, const ClothStart& start) {
    return makeSymplecticEuler(start, {1024, 1.0, 0.2});
  });
  return entries;
}

void drop(const Sheet& sheet, Table& figures, Table& motion) {
  const bool large = sheet.rows >= 100;
  const curtain::Scene scene = sheetScene(sheet);
  const ClothStart start = clothStart(scene);
  const Reference reference = finestRun(sheet, scene, start);
  const std::string name = number(sheet.rows) + "x" + number(sheet.columns);
  for (const Entry& entry : entriesOfSheet(sheet, large)) {
    const auto contestant = entry.make(scene, start);
    double at_snap = std::nan("");
    double rise = 0.0;
    const double first = gravityEnergy(start, start.positions);
    const Run made =
        run(start, *contestant, sheet.frames, 40.0, [&](int frame, const Contestant& now, const Points& positions) {
          rise = std::max(rise, totalEnergy(start, now) - first);
          if (frame > static_cast<int>(reference.frames.size())) return;
          const double error = rmsDistance(start, positions, reference.frames[static_cast<std::size_t>(frame - 1)]);
          if (frame == reference.snap) at_snap = error;
          motion.row({name, entry.method, entry.setting, number(frame * start.frame_seconds), number(error)});
        });
    figures.row({name, entry.method, entry.setting, number(made.frame_median), number(made.frame_max),
                 number(made.sound ? made.stretch : std::nan("")),
                 number(static_cast<double>(made.substeps) / made.frames), number(rise),
                 number(reference.snap * start.frame_seconds), number(at_snap), number(made.frames)});
    std::fprintf(stderr, "hard_spot %s %s, %s: %.1f s\n", name.c_str(), entry.method.c_str(), entry.setting.c_str(),
                 1e-3 * made.ms);
  }
}

}  // namespace

void studyHardSpot(const Options& options) {
  Table figures(options.folder, "hard_spot.csv",
                {"sheet", "method", "setting", "ms_median", "ms_max", "stretch", "substeps", "energy_rise_J",
                 "t_snap_s", "error_at_snap_m", "frames"});
  Table motion(options.folder, "hard_spot_motion.csv", {"sheet", "method", "setting", "t_s", "error_m"});
  drop({20, 20, options.quick ? 60 : 180, {4, 8, 16, 32, 64}, 256}, figures, motion);
  drop({44, 40, options.quick ? 30 : 120, {16, 32, 64, 128}, 256}, figures, motion);
  if (!options.quick) drop({100, 100, 60, {}, 256}, figures, motion);
}

}  // namespace curtain_bench
