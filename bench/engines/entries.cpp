// SPDX-License-Identifier: BSD-3-Clause
#include "bench/engines/entries.h"

#include <cstdio>
#include <utility>

#include "bench/line_up.h"

namespace curtain_bench {
namespace {

using Entries = std::vector<EngineEntry>;

void addOurs(Entries& entries, const EngineScene& scene, const std::string& commit) {
  const auto add = [&](const std::string& setting, std::function<std::unique_ptr<Contestant>()> make) {
    EngineEntry entry;
    entry.engine = "curtain_sim";
    entry.version = commit;
    entry.setting = setting;
    entry.ours = std::move(make);
    entries.push_back(entry);
  };
  add("default", [&scene] { return makeOurs(scene.scene); });
  add("stretch_tolerance 1e-2", [&scene] {
    curtain::Scene loose = scene.scene;
    loose.solver.stretch_tolerance = 1e-2;
    return makeOurs(loose);
  });
  if (!scene.touches_itself) return;
  add("default; without self-contact; five waves", [&scene] {
    curtain::Scene alone = scene.scene;
    alone.contact.self = false;
    return makeOurs(alone, scene.waves);
  });
  add("default; five waves", [&scene] { return makeOurs(scene.scene, scene.waves); });
}

#ifdef CURTAIN_ENGINES_NVCLOTH
std::string metresAsMm(double distance) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2f", 1e3 * distance);
  std::string shown = text;
  if (distance >= 0.01) shown.pop_back();  // 3 figures
  return shown + " mm";
}

void add(Entries& entries, const EngineScene& scene, const NvClothSettings& settings) {
  EngineEntry entry;
  entry.engine = "NvCloth";
  entry.version = CURTAIN_ENGINES_NVCLOTH;
  entry.setting = std::to_string(settings.frequency) + " Hz";
  if (settings.tethers) entry.setting += "; tethers";
  if (settings.continuous) entry.setting += "; CCD";
  if (settings.one_sided) entry.setting += "; weft one-sided";
  if (settings.self_distance > 0.0)
    entry.setting += "; self-collision at " + metresAsMm(settings.self_distance);
  else if (scene.touches_itself)
    entry.setting += "; without self-contact";
  entry.setting += settings.even_odd ? "; phases even/odd" : "; phases top-down";
  entry.flat = settings.one_sided;
  if (entry.flat) entry.setting += "; flat";
  entry.other = [settings](const ClothStart& start) { return makeNvCloth(start, settings); };
  entries.push_back(entry);
}

void addNvClothAndBall(Entries& entries, const EngineScene& scene) {
  NvClothSettings settings;
  for (const int frequency :
       {60, 120, 180, 300, 420, 600, 840, 1200, 1440, 1680, 1920, 2400, 2880, 4800, 9600, 19200}) {
    settings.frequency = frequency;
    const bool fine = frequency == 300 || frequency == 600 || frequency >= 1200;
    const bool tethered = frequency < 1440 || frequency == 2400 || frequency == 4800 || frequency == 9600;
    for (const bool tethers : {false, true}) {
      settings.tethers = tethers;
      if (tethers && !tethered) continue;
      settings.even_odd = false;
      if (frequency < 19200) add(entries, scene, settings);
      settings.even_odd = true;
      const bool both = tethers ? frequency == 1200 || frequency == 4800 || frequency == 9600 : fine;
      if (both) add(entries, scene, settings);
    }
  }
  settings = {};
  settings.frequency = 1200;
  settings.continuous = true;
  add(entries, scene, settings);
}

void addNvClothAndItself(Entries& entries, const EngineScene& scene) {
  const bool coarse = scene.flat.columns <= 40;
  const double wide = coarse ? 0.02 : 0.009, narrow = coarse ? 0.004 : 0.0026;  // below both spacings of the nodes
  for (const int frequency : {120, 300, 600, 1200, 2400, 4800, 9600}) {
    NvClothSettings settings;
    settings.frequency = frequency;
    if (frequency >= 300) add(entries, scene, settings);
    for (const double distance : {narrow, wide}) {
      if (distance == narrow && frequency < (coarse ? 1200 : 4800)) continue;
      settings.self_distance = distance;
      add(entries, scene, settings);
    }
    for (const bool tethers : {false, true}) {
      NvClothSettings one = settings;
      one.tethers = tethers;
      if (tethers) add(entries, scene, one);
      one.one_sided = true;
      if (!tethers || frequency == 2400) add(entries, scene, one);
    }
    settings.self_distance = 0.0;
    settings.tethers = true;
    if (frequency == 1200 || frequency == 4800) add(entries, scene, settings);
    if (frequency < 2400) continue;
    settings.tethers = false;
    settings.even_odd = true;
    for (const double distance : {0.0, narrow, wide}) {
      settings.self_distance = distance;
      const bool of_narrow = frequency == (coarse ? 4800 : 9600) || (!coarse && frequency == 4800);
      const bool of_wide = frequency == 9600 || frequency == (coarse ? 2400 : 4800);
      if (distance == 0.0 || (distance == narrow ? of_narrow : of_wide)) add(entries, scene, settings);
    }
  }
  // Beyond the spacing of the nodes: none fits between its neighbours, so layers do not cross.
  for (const double distance : {coarse ? 0.03 : 0.012, coarse ? 0.04 : 0.016}) {
    NvClothSettings settings;
    settings.self_distance = distance;
    for (const int frequency : {600, 1200, 2400, 4800}) {
      settings.frequency = frequency;
      add(entries, scene, settings);
    }
    settings.even_odd = true;
    for (const int frequency : {9600, 19200}) {
      settings.frequency = frequency;
      add(entries, scene, settings);
    }
  }
}

void addNvCloth(Entries& entries, const EngineScene& scene) {
  scene.touches_itself ? addNvClothAndItself(entries, scene) : addNvClothAndBall(entries, scene);
}
#else
void addNvCloth(Entries&, const EngineScene&) {}
#endif

#ifdef CURTAIN_ENGINES_JOLT
void addJolt(Entries& entries, const EngineScene& scene) {
  std::vector<JoltSettings> all;
  for (const bool long_range : {true, false}) {
    for (const int iterations : {2, 5, 10, 20, 40, 80, 160}) all.push_back({long_range, 1, iterations});
    for (const int steps : {4, 8}) all.push_back({long_range, steps, 40});
  }
  for (const JoltSettings& settings : all) {
    EngineEntry entry;
    entry.engine = "Jolt";
    entry.version = CURTAIN_ENGINES_JOLT;
    entry.setting = settings.long_range ? "LRA; " : "";
    entry.setting +=
        "steps a frame " + std::to_string(settings.steps) + "; iterations " + std::to_string(settings.iterations);
    if (scene.touches_itself) entry.setting += "; without self-contact";
    entry.other = [settings](const ClothStart& start) { return makeJolt(start, settings); };
    entries.push_back(entry);
  }
}
#else
void addJolt(Entries&, const EngineScene&) {}
#endif

#ifdef CURTAIN_ENGINES_BULLET
void add(Entries& entries, const EngineScene& scene, const BulletWorldSettings& settings) {
  EngineEntry entry;
  entry.engine = "Bullet";
  entry.version = CURTAIN_ENGINES_BULLET;
  entry.setting =
      "substeps " + std::to_string(settings.substeps) + "; piterations " + std::to_string(settings.iterations);
  if (settings.defaults) entry.setting += "; hardness 0.1; cells of 0.25";
  if (settings.clusters >= 0)
    entry.setting += "; self clusters " + std::to_string(settings.clusters);
  else if (scene.touches_itself)
    entry.setting += "; without self-contact";
  entry.other = [settings](const ClothStart& start) { return makeBulletWorld(start, settings); };
  entries.push_back(entry);
}

void addBullet(Entries& entries, const EngineScene& scene) {
  const bool coarse = scene.flat.columns <= 40;
  for (const int substeps : {1, 4, 16, 64}) {
    for (const int iterations : {4, 16, 64}) {
      if (iterations == 64 ? scene.touches_itself || substeps == 64 : substeps == 64 && (iterations == 16 || !coarse))
        continue;
      add(entries, scene, BulletWorldSettings{substeps, iterations, false, -1});
    }
  }
  if (!scene.touches_itself) {
    add(entries, scene, BulletWorldSettings{1, 4, true, -1});
    add(entries, scene, BulletWorldSettings{4, 16, true, -1});
    return;
  }
  for (const int iterations : {4, 16}) {
    add(entries, scene, BulletWorldSettings{4, iterations, false, coarse ? 64 : 1000});
    if (coarse) add(entries, scene, BulletWorldSettings{4, iterations, false, 0});
  }
  add(entries, scene, BulletWorldSettings{16, 16, false, coarse ? 64 : 1000});
  add(entries, scene, BulletWorldSettings{64, 4, false, coarse ? 64 : 1000});
  if (coarse) add(entries, scene, BulletWorldSettings{4, 16, false, 256});
}
#else
void addBullet(Entries&, const EngineScene&) {}
#endif

}  // namespace

std::vector<EngineEntry> entriesOf(const EngineScene& scene, const std::string& commit, bool thin) {
  Entries others;
  addNvCloth(others, scene);
  addJolt(others, scene);
  addBullet(others, scene);
  Entries entries;
  addOurs(entries, scene, commit);
  for (std::size_t e = 0; e < others.size(); e += thin ? 4 : 1) entries.push_back(others[e]);
  return entries;
}

std::string bulletVersion() {
#ifdef CURTAIN_ENGINES_BULLET
  std::string version = CURTAIN_ENGINES_BULLET;  // "3.27 6c888f4"
  version.insert(version.find(' ') + 1, "(");
  return "Bullet " + version + ")";
#else
  return "no Bullet";
#endif
}

}  // namespace curtain_bench
