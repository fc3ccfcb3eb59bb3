// SPDX-License-Identifier: BSD-3-Clause
#include "batch/options.h"

#include <cmath>
#include <filesystem>
#include <map>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "batch/command_line.h"
#include "curtain_sim/scene_yaml.h"
#include "simulator/export.h"

namespace curtain_batch {

const char* const kUsage =
    "usage: curtain_batch SCENE.yaml [options]\n"
    "  --duration S       simulated time [s] (default 1)\n"
    "  --method NAME      instead of the scene's solver.method\n"
    "  --substeps N       instead of the scene's solver.substeps\n"
    "  --rows N           instead of the scene's cloth.rows, of layers too\n"
    "  --columns N        instead of the scene's cloth.columns\n"
    "  --out FILE.csv     states t,row,column,x,y,z,vx,vy,vz of the first-layer nodes\n"
    "  --sample T,T,...   times of these states [s], each at the first frame not before it (default: the end)\n"
    "  --sample-rate HZ   so many states a second instead, from the start on\n"
    "  --wrenches FILE    t,obstacle,fx,fy,fz,tx,ty,tz,contacts of every frame, as CSV: what obstacles feel\n"
    "  --mesh FILE        fine mesh at the end, .ply, .obj or .stl\n"
    "  --stats FILE.json  what it took and how well it went\n"
    "  --save FILE        snapshot at the end, for --restore\n"
    "  --restore FILE     go on from a snapshot of the same scene; the duration comes on top, times of --sample go on, "
    "too\n"
    "  --checkpoint FILE  state and outputs so far, again and again; where FILE is there, of the same run, goes on "
    "from it\n"
    "  --every S          simulated time between two of them [s] (default 10)\n"
    "  --progress         a line a simulated second on stderr\n"
    "  --explain          what runs (+) for this scene and what is skipped (-), at the start and after the duration\n"
    "  --check            reads scenes, any number, and lists what is wrong with them, then exit\n"
    "  --list-methods     names for --method, then exit\n"
    "  --version          of the program, then exit\n"
    "exit code: 0; 2 = bad input, nothing written; 3 = the state became non-finite, no snapshot is saved;\n"
    "4 = an output could not be written, others may be, the last checkpoint stays\n";

namespace {

constexpr double kLongest = 1e8;  // s; three years, and few enough frames to keep each one's time

double readNumber(const std::string& option, const std::string& text) {
  const double value = numberOf(text);
  if (!std::isfinite(value) || value < 0.0) {
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

double readSampleRate(const std::string& option, const std::string& text) {
  const double rate = readNumber(option, text);
  if (rate <= 0.0) throw std::invalid_argument(option + ": must be > 0, is '" + text + "'");
  return rate;
}

// Samples after the first; a whole number may have been rounded down.
double samplesWithin(const Options& options) { return std::floor(options.duration * options.sample_rate + 1e-9); }

void checkSampleRate(const Options& options) {
  constexpr double kMaxSamples = 1e6;
  if (options.sample_rate == 0.0) return;
  if (!options.samples.empty()) throw std::invalid_argument("--sample-rate: there is --sample, too; leave one out");
  if (samplesWithin(options) >= kMaxSamples)
    throw std::invalid_argument("--sample-rate: at most 1000000 states are possible, --duration has more");
}

void checkMeshName(const std::string& path) {
  if (!path.empty() && !curtain::meshFormatOf(path)) {
    throw std::invalid_argument(std::string("--mesh: must end in ") + curtain::kMeshEndings + ", is '" + path + "'");
  }
}

// A checkpoint that another output overwrites, or that overwrites one, is none.
void checkOutputs(const Options& options) {
  const std::pair<const char*, const std::string&> outputs[] = {{"--out", options.out},
                                                                {"--wrenches", options.wrenches},
                                                                {"--mesh", options.mesh},
                                                                {"--stats", options.stats},
                                                                {"--save", options.save}};
  const auto place = [](const std::string& path) {
    return std::filesystem::weakly_canonical(std::filesystem::absolute(path));
  };
  for (const auto& [option, path] : outputs) {
    if (path.empty()) continue;
    checkOutput(option, path);
    if (options.checkpoint.empty() || place(path) != place(options.checkpoint)) continue;
    throw std::invalid_argument(std::string(option) + ": '" + path + "' is the checkpoint, too");
  }
  if (!options.checkpoint.empty()) checkOutput("--checkpoint", options.checkpoint);
}

const std::map<std::string, std::string Options::*> kTexts = {
    {"--method", &Options::method},     {"--out", &Options::out},
    {"--wrenches", &Options::wrenches}, {"--mesh", &Options::mesh},
    {"--stats", &Options::stats},       {"--save", &Options::save},
    {"--restore", &Options::restore},   {"--checkpoint", &Options::checkpoint}};
const std::map<std::string, int Options::*> kCounts = {
    {"--substeps", &Options::substeps}, {"--rows", &Options::rows}, {"--columns", &Options::columns}};
const std::map<std::string, bool Options::*> kFlags = {{"--progress", &Options::progress},
                                                       {"--explain", &Options::explain},
                                                       {"--check", &Options::check},
                                                       {"--list-methods", &Options::list_methods},
                                                       {"--version", &Options::version},
                                                       {"--help", &Options::help},
                                                       {"-h", &Options::help}};

}  // namespace

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

std::vector<double> samplesFrom(double start, const Options& options) {
  std::vector<double> samples;
  for (double k = 0.0; k <= samplesWithin(options); ++k) samples.push_back(start + k / options.sample_rate);
  return samples;
}

Options readOptions(int argc, char** argv) {
  Options options;
  bool every = false;
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
    else if (option == "--sample-rate")
      options.sample_rate = readSampleRate(option, value());
    else if (option == "--every") {
      options.every = readDuration(option, value());
      every = true;
    } else if (option.size() > 1 && option[0] == '-')
      throw std::invalid_argument(option + ": unknown option");
    else
      options.scenes.push_back(option);
  }
  if (options.list_methods || options.version || options.help) return options;
  if (options.scenes.empty()) throw std::invalid_argument("a scene file is needed");
  if (options.check) return options;
  if (options.scenes.size() > 1) throw std::invalid_argument(options.scenes[1] + ": one scene at a time");
  checkSampleRate(options);
  if (options.restore.empty()) checkSamples(options, 0.0);
  checkMeshName(options.mesh);
  if (every && options.checkpoint.empty()) throw std::invalid_argument("--every: of what? it needs --checkpoint");
  if (options.every <= 0.0) throw std::invalid_argument("--every: must be > 0 s");
  checkOutputs(options);
  return options;
}

curtain::Scene readScene(const std::string& path, const Options& options) {
  curtain::SceneReading reading = curtain::readSceneFile(path);
  if (!reading.problems.empty()) throw std::invalid_argument(curtain::describe(reading.problems, path));
  curtain::Scene scene = reading.scene;
  if (!options.method.empty()) {
    const auto method = curtain::methodFromName(options.method);
    if (!method) throw std::invalid_argument("--method: no method '" + options.method + "'; see --list-methods");
    scene.solver.method = *method;
  }
  if (options.substeps > 0) scene.solver.substeps = options.substeps;
  if (options.rows > 0) {
    scene.cloth.rows = options.rows;
    for (curtain::LayerParams& layer : scene.layers) layer.cloth.rows = options.rows;
  }
  if (options.columns > 0) scene.cloth.columns = options.columns;
  return scene;
}

}  // namespace curtain_batch
