// SPDX-License-Identifier: BSD-3-Clause
//
// curtain_engines: our curtains and the same ones in other engines, as a table. All take turns, pass by pass.
#include <algorithm>
#include <cstdio>
#include <exception>
#include <string>

#include "bench/engines/entries.h"
#include "bench/engines/measure_run.h"
#include "bench/engines/scenes.h"
#include "bench/table.h"

namespace curtain_bench {
namespace {

struct Options {
  std::string folder = ".", commit = "unknown", scene, setting;
  int repeats = 2;
  bool quick = false;
};

constexpr const char* kUsage =
    "curtain_engines [--out FOLDER] [--commit HASH] [--repeats N] [--quick] [--scene NAME] [--setting PART]\n"
    "curtain_engines --bullet\n"
    "  --commit   of this checkout, for the table\n"
    "  --repeats  passes; the least of their medians counts (2)\n"
    "  --quick    a part of the settings, of a second each\n"
    "  --scene    this one alone\n"
    "  --setting  only those whose engine and setting have this in them\n"
    "  --bullet   tells Bullet's version\n";

struct Row {
  EngineEntry entry;
  Figures figures;            // of the pass with the least median
  double ms_median_most = 0;  // of all passes
};

Figures figuresOf(const EngineScene& scene, const EngineEntry& entry, int frames) {
  if (entry.ours) {
    const auto ours = entry.ours();
    return figuresOf(scene.flat, scene.scene, frames, *ours, nullptr);
  }
  const ClothStart& start = entry.flat ? scene.flat : scene.waves;
  const auto engine = entry.other(start);
  return figuresOf(start, scene.scene, frames, *engine, engine.get());
}

std::string text(const char* format, double value) {
  char out[64];
  std::snprintf(out, sizeof out, format, value);
  return out;
}

void write(Table& table, const std::string& scene, const Row& row) {
  const Figures& f = row.figures;
  table.row({scene, row.entry.engine, row.entry.version, row.entry.setting, text("%.4f", f.ms_median),
             text("%.4f", row.ms_median_most), text("%.4f", f.ms_99), number(f.stretch_max, 6),
             number(f.stretch_rms, 6), number(f.nodes_inside), text("%.3f", 1e3 * f.deepest),
             std::to_string(f.crossings)});
}

// Rows of an engine stay together, from the fastest on.
void order(std::vector<Row>& rows) {
  for (auto first = rows.begin(); first != rows.end();) {
    const auto end =
        std::find_if(first, rows.end(), [&](const Row& r) { return r.entry.engine != first->entry.engine; });
    std::sort(first, end, [](const Row& a, const Row& b) { return a.figures.ms_median < b.figures.ms_median; });
    first = end;
  }
}

void compare(const EngineScene& scene, const Options& options, Table& table) {
  std::vector<Row> rows;
  for (const EngineEntry& entry : entriesOf(scene, options.commit, options.quick)) {
    if ((entry.engine + " " + entry.setting).find(options.setting) != std::string::npos)
      rows.push_back({entry, {}, 0.0});
  }
  const int frames = options.quick ? 60 : scene.frames;
  for (int pass = 0; pass < options.repeats; ++pass) {
    for (Row& row : rows) {
      const Figures now = figuresOf(scene, row.entry, frames);
      row.ms_median_most = std::max(row.ms_median_most, now.ms_median);
      if (pass == 0 || now.ms_median < row.figures.ms_median) row.figures = now;
      std::fprintf(stderr, "%s, %s, %s: %.4f ms, misfit %.3g, %lld crossings\n", scene.name.c_str(),
                   row.entry.engine.c_str(), row.entry.setting.c_str(), now.ms_median, now.stretch_max,
                   static_cast<long long>(now.crossings));
    }
  }
  order(rows);
  for (const Row& row : rows) write(table, scene.name, row);
}

Options read(int count, char** words) {
  Options options;
  for (int w = 1; w < count; ++w) {
    const std::string word = words[w];
    if (word == "--quick") {
      options.quick = true;
      continue;
    }
    if (w + 1 == count) throw std::invalid_argument(kUsage);
    const std::string value = words[++w];
    if (word == "--out") {
      options.folder = value;
    } else if (word == "--commit") {
      options.commit = value;
    } else if (word == "--repeats") {
      options.repeats = std::stoi(value);
    } else if (word == "--scene") {
      options.scene = value;
    } else if (word == "--setting") {
      options.setting = value;
    } else {
      throw std::invalid_argument(kUsage);
    }
  }
  return options;
}

void compareAll(const Options& options) {
  Table table(options.folder, "engines.csv",
              {"scene", "engine", "version", "setting", "ms_median", "ms_median_most", "ms_99", "stretch_max",
               "stretch_rms", "nodes_inside", "deepest_mm", "crossings_end"});
  for (const EngineScene& scene : engineScenes()) {
    if (options.scene.empty() || scene.name == options.scene) compare(scene, options, table);
  }
}

}  // namespace
}  // namespace curtain_bench

int main(int count, char** words) {
  try {
    if (count == 2 && std::string(words[1]) == "--bullet") {
      std::puts(curtain_bench::bulletVersion().c_str());
      return 0;
    }
    curtain_bench::compareAll(curtain_bench::read(count, words));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
