// SPDX-License-Identifier: BSD-3-Clause
//
// curtain_batch: the engine without ROS, for measuring, sweeps and tests.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <sstream>
#include <stdexcept>

#include "curtain_sim/scene_yaml.h"
#include "curtain_sim/snapshot_file.h"
#include "simulator/export.h"

namespace {

constexpr int kBadInput = 2;
constexpr int kNotFinite = 3;
constexpr int kNotWritten = 4;
constexpr double kLongest = 1e8;  // s; three years, and few enough frames to keep each one's time

const char* const kUsage =
    "usage: curtain_batch SCENE.yaml [options]\n"
    "  --duration S       simulated time [s] (default 1)\n"
    "  --method NAME      instead of the scene's solver.method\n"
    "  --substeps N       instead of the scene's solver.substeps\n"
    "  --rows N           instead of the scene's cloth.rows\n"
    "  --columns N        instead of the scene's cloth.columns\n"
    "  --out FILE.csv     states t,row,column,x,y,z,vx,vy,vz of the first-layer nodes\n"
    "  --sample T,T,...   times of these states [s], each at the first frame not before it (default: the end)\n"
    "  --mesh FILE        fine mesh at the end, .ply, .obj or .stl\n"
    "  --stats FILE.json  what it took and how well it went\n"
    "  --save FILE        snapshot at the end, for --restore\n"
    "  --restore FILE     go on from a snapshot of the same scene; the duration comes on top, times of --sample go on, "
    "too\n"
    "  --progress         a line a simulated second on stderr\n"
    "  --explain          what runs (+) for this scene and what is skipped (-), at the start and after the duration\n"
    "  --list-methods     names for --method, then exit\n"
    "exit code: 0; 2 = bad input, nothing written; 3 = the state became non-finite, no snapshot is saved;\n"
    "4 = an output could not be written, others may be\n";

struct Options {
  std::string scene;
  double duration = 1.0;
  std::string method, out, mesh, stats, save, restore;
  int substeps = 0, rows = 0, columns = 0;
  std::vector<double> samples;
  bool progress = false;
  bool explain = false;
  bool list_methods = false;
  bool help = false;
};

double readNumber(const std::string& option, const std::string& text) {
  std::size_t used = 0;
  double value = std::nan("");
  try {
    value = std::stod(text, &used);
  } catch (const std::exception&) {
    used = 0;
  }
  if (used == 0 || used != text.size() || !std::isfinite(value) || value < 0.0) {
    throw std::invalid_argument(option + ": must be a finite number >= 0, is '" + text + "'");
  }
  return value;
}

double readDuration(const std::string& option, const std::string& text) {
  const double value = readNumber(option, text);
  if (value > kLongest) throw std::invalid_argument(option + ": must be at most 1e8 s, is '" + text + "'");
  return value;
}

int readCount(const std::string& option, const std::string& text) {
  const double value = readNumber(option, text);
  if (value != std::floor(value) || value < 1.0 || value > 1e6) {
    throw std::invalid_argument(option + ": must be a whole number in [1, 1000000], is '" + text + "'");
  }
  return static_cast<int>(value);
}

std::vector<double> readSamples(const std::string& option, const std::string& text) {
  std::vector<double> samples;
  std::istringstream list(text);
  for (std::string item; std::getline(list, item, ',');) {
    samples.push_back(readNumber(option, item));
    if (samples.size() > 1 && samples[samples.size() - 2] > samples.back()) {
      throw std::invalid_argument(option + ": times must not decrease, are '" + text + "'");
    }
  }
  if (samples.empty()) throw std::invalid_argument(option + ": needs at least one time");
  return samples;
}

// An output must have a folder to lie in and not be one itself, before anything is written.
void checkOutput(const std::string& option, const std::string& path) {
  if (path.empty()) return;
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  if (!folder.empty() && !std::filesystem::is_directory(folder)) {
    throw std::invalid_argument(option + ": there is no folder '" + folder.string() + "'");
  }
  if (std::filesystem::is_directory(path)) throw std::invalid_argument(option + ": '" + path + "' is a folder");
}

void checkMeshName(const std::string& path) {
  if (!path.empty() && !curtain::meshFormatOf(path)) {
    throw std::invalid_argument(std::string("--mesh: must end in ") + curtain::kMeshEndings + ", is '" + path + "'");
  }
}

// start: simulated time that the duration begins at [s].
void checkSamples(const Options& options, double start) {
  if (options.samples.empty()) return;
  if (options.samples.front() < start) {
    throw std::invalid_argument("--sample: " + std::to_string(options.samples.front()) + " is before the start, at " +
                                std::to_string(start));
  }
  if (options.samples.back() <= start + options.duration) return;
  throw std::invalid_argument("--sample: " + std::to_string(options.samples.back()) + " is after the end, --duration " +
                              std::to_string(options.duration) +
                              (start > 0.0 ? " on top of " + std::to_string(start) : std::string()));
}

const std::map<std::string, std::string Options::*> kTexts = {
    {"--method", &Options::method}, {"--out", &Options::out},   {"--mesh", &Options::mesh},
    {"--stats", &Options::stats},   {"--save", &Options::save}, {"--restore", &Options::restore}};
const std::map<std::string, int Options::*> kCounts = {
    {"--substeps", &Options::substeps}, {"--rows", &Options::rows}, {"--columns", &Options::columns}};
const std::map<std::string, bool Options::*> kFlags = {{"--progress", &Options::progress},
                                                       {"--explain", &Options::explain},
                                                       {"--list-methods", &Options::list_methods},
                                                       {"--help", &Options::help},
                                                       {"-h", &Options::help}};

Options readOptions(int argc, char** argv) {
  Options options;
  for (int a = 1; a < argc; ++a) {
    const std::string option = argv[a];
    const auto value = [&]() -> std::string {
      if (a + 1 >= argc) throw std::invalid_argument(option + ": needs a value");
      return argv[++a];
    };
    const auto text = kTexts.find(option);
    const auto count = kCounts.find(option);
    const auto flag = kFlags.find(option);
    if (text != kTexts.end())
      options.*(text->second) = value();
    else if (count != kCounts.end())
      options.*(count->second) = readCount(option, value());
    else if (flag != kFlags.end())
      options.*(flag->second) = true;
    else if (option == "--duration")
      options.duration = readDuration(option, value());
    else if (option == "--sample")
      options.samples = readSamples(option, value());
    else if (option.size() > 1 && option[0] == '-')
      throw std::invalid_argument(option + ": unknown option");
    else if (options.scene.empty())
      options.scene = option;
    else
      throw std::invalid_argument(option + ": one scene at a time");
  }
  if (options.list_methods || options.help) return options;
  if (options.scene.empty()) throw std::invalid_argument("a scene file is needed");
  if (options.restore.empty()) checkSamples(options, 0.0);
  checkMeshName(options.mesh);
  checkOutput("--out", options.out);
  checkOutput("--mesh", options.mesh);
  checkOutput("--stats", options.stats);
  checkOutput("--save", options.save);
  return options;
}

curtain::Scene readScene(const Options& options) {
  curtain::SceneReading reading = curtain::readSceneFile(options.scene);
  if (!reading.problems.empty()) throw std::invalid_argument(curtain::describe(reading.problems, options.scene));
  curtain::Scene scene = reading.scene;
  if (!options.method.empty()) {
    const auto method = curtain::methodFromName(options.method);
    if (!method) throw std::invalid_argument("--method: no method '" + options.method + "'; see --list-methods");
    scene.solver.method = *method;
  }
  if (options.substeps > 0) scene.solver.substeps = options.substeps;
  if (options.rows > 0) scene.cloth.rows = options.rows;
  if (options.columns > 0) scene.cloth.columns = options.columns;
  return scene;  // the simulator judges the whole
}

void restore(curtain::Simulator& simulator, const Options& options) {
  if (options.restore.empty()) return;
  std::string snapshot;
  std::vector<curtain::Problem> problems = curtain::readSnapshotFile(options.restore, snapshot);
  if (!problems.empty()) throw std::invalid_argument(curtain::describe(problems, "--restore"));
  problems = simulator.restore(snapshot);
  if (!problems.empty()) throw std::invalid_argument(curtain::describe(problems, "--restore: " + options.restore));
  checkSamples(options, simulator.time());
}

void save(const curtain::Simulator& simulator, const Options& options) {
  if (options.save.empty() || !simulator.statistics().finite) return;  // from what is not finite nothing goes on
  const std::vector<curtain::Problem> problems = curtain::writeSnapshotFile(options.save, simulator.snapshot());
  if (!problems.empty()) throw std::runtime_error(curtain::describe(problems, "--save"));
}

// Steps through the duration; writes the samples as their times come.
std::vector<double> run(curtain::Simulator& simulator, const Options& options, std::ostream* samples) {
  const double rate = simulator.scene().solver.frame_rate;
  const auto frames = static_cast<long>(std::ceil(options.duration * rate - 1e-6));
  std::vector<double> frame_seconds;
  frame_seconds.reserve(static_cast<std::size_t>(std::min(frames, 1000000L)));
  std::size_t next = 0;
  const auto sample = [&]() {
    for (; next < options.samples.size() && options.samples[next] <= simulator.time() + 1e-6 / rate; ++next) {
      if (samples != nullptr) curtain::writeState(simulator, *samples);
    }
  };
  sample();
  for (long frame = 0; frame < frames && simulator.statistics().finite; ++frame) {
    simulator.step();
    frame_seconds.push_back(simulator.statistics().step_seconds);
    sample();
    if (options.progress && (frame + 1) % static_cast<long>(std::max(1.0, rate)) == 0) {
      std::cerr << "t = " << simulator.time() << " s, " << simulator.statistics().substeps_last << " substeps\n";
    }
  }
  if (samples != nullptr && options.samples.empty()) curtain::writeState(simulator, *samples);
  return frame_seconds;
}

void explain(const curtain::Simulator& simulator) {
  std::cout << "t = " << simulator.time() << " s\n" << curtain::describe(simulator.plan());
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const Options options = readOptions(argc, argv);
    if (options.help) {
      std::cout << kUsage;
      return EXIT_SUCCESS;
    }
    if (options.list_methods) {
      for (const std::string& name : curtain::methodNames()) std::cout << name << '\n';
      return EXIT_SUCCESS;
    }
    curtain::Simulator simulator(readScene(options));
    restore(simulator, options);
    if (options.explain) explain(simulator);
    const curtain::Energy initial = simulator.energy();
    std::ofstream states;
    if (!options.out.empty()) {
      states.open(options.out);
      curtain::writeStateHeader(states);
    }
    const std::vector<double> seconds = run(simulator, options, options.out.empty() ? nullptr : &states);
    if (options.explain && !seconds.empty()) explain(simulator);
    if (!options.out.empty() && !states.flush()) throw std::runtime_error(options.out + ": cannot be written");
    save(simulator, options);
    if (!options.mesh.empty()) curtain::writeMesh(simulator, options.mesh);
    if (!options.stats.empty()) {
      std::ofstream stats(options.stats);
      stats << curtain::statisticsJson(simulator, initial, seconds);
      if (!stats.flush()) throw std::runtime_error(options.stats + ": cannot be written");
    }
    if (!simulator.statistics().finite) {
      std::cerr << "curtain_batch: the state became non-finite at t = " << simulator.time() << " s\n";
      return kNotFinite;
    }
    return EXIT_SUCCESS;
  } catch (const std::runtime_error& error) {
    std::cerr << "curtain_batch: " << error.what() << '\n';
    return kNotWritten;
  } catch (const std::exception& error) {
    std::cerr << "curtain_batch: " << error.what() << '\n';
    return kBadInput;
  }
}
