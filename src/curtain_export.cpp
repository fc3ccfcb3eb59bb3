// SPDX-License-Identifier: BSD-3-Clause
//
// curtain_export: an animation of a scene or of a bag, for programs that draw.
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <iostream>
#include <map>
#include <sstream>
#include <stdexcept>

#include "batch/command_line.h"
#include "curtain_sim/scene_yaml.h"
#include "export/gltf_animation.h"
#include "export/play_bag.h"
#include "export/play_scene.h"
#include "export/ply_series.h"
#include "simulator/whole_file.h"

namespace {

constexpr int kBadInput = 2;
constexpr int kNotFinite = 3;
constexpr int kNotWritten = 4;

const char* const kUsage =
    "usage: curtain_export SCENE.yaml|FILE.bag --out FILE.glb|NAME.ply [options]\n"
    "  --out FILE.glb     animated glTF 2.0: the cloth by morph targets, obstacles as nodes\n"
    "  --out NAME.ply     the cloth as NAME_0000.ply, NAME_0001.ply, ...\n"
    "  --start S          from here on [s] (default 0; of a bag: its first state)\n"
    "  --end S            to here [s] (default: of a scene 1, of a bag its end)\n"
    "  --rate HZ          frames a second (default 30), each the first that is not before its time\n"
    "  --topic NAME       of the states, for a bag of several curtains\n"
    "  --color R,G,B      of the cloth in the glTF file, each in [0, 1] (default 0.69,0.2,0.22)\n"
    "exit code: 0; 2 = bad input; 3 = the state became non-finite; 4 = an output could not be written.\n"
    "But for 0 no .glb is written; of NAME.ply there are the files up to there\n";

struct Options {
  std::string source, out, topic;
  curtain::Excerpt excerpt;
  curtain::Vec3 color{0.69, 0.20, 0.22};
  bool help = false;
};

std::string endingOf(const std::string& path) { return std::filesystem::path(path).extension().string(); }

double readNumber(const std::string& option, const std::string& text, double least, double most) {
  const double value = curtain_batch::numberOf(text);
  if (!(value >= least && value <= most)) {
    std::ostringstream message;
    message << option << ": must be a number in [" << least << ", " << most << "], is '" << text << "'";
    throw std::invalid_argument(message.str());
  }
  return value;
}

curtain::Vec3 readColor(const std::string& option, const std::string& text) {
  curtain::Vec3 color;
  std::istringstream list(text);
  int part = 0;
  for (std::string item; std::getline(list, item, ','); ++part) {
    if (part < 3) color[part] = readNumber(option, item, 0.0, 1.0);
  }
  if (part != 3) throw std::invalid_argument(option + ": must be three numbers R,G,B, is '" + text + "'");
  return color;
}

bool isBag(const Options& options) { return endingOf(options.source) == ".bag"; }

void checkOutput(const std::string& path) {
  if (path.empty()) throw std::invalid_argument("--out is needed");
  const std::string ending = endingOf(path);
  if (ending != ".glb" && ending != ".ply")
    throw std::invalid_argument("--out: must end in .glb or .ply, is '" + path + "'");
  curtain_batch::checkOutput("--out", path);
}

void check(Options& options) {
  const std::string ending = endingOf(options.source);
  if (options.source.empty()) throw std::invalid_argument("a scene file or a bag is needed");
  if (ending != ".bag" && ending != ".yaml" && ending != ".yml")
    throw std::invalid_argument(options.source + ": must end in .yaml (a scene) or .bag");
  if (!isBag(options) && !options.topic.empty()) throw std::invalid_argument("--topic: is for bags");
  if (!isBag(options) && !options.excerpt.end) options.excerpt.end = options.excerpt.start + 1.0;
  if (options.excerpt.end && *options.excerpt.end <= options.excerpt.start)
    throw std::invalid_argument("--end: must be after --start");
  checkOutput(options.out);
}

Options readOptions(int argc, char** argv) {
  constexpr double kLongest = 1e8, kFastest = 1e5;  // s, 1/s
  Options options;
  using Read = std::function<void(const std::string&, const std::string&)>;
  const std::map<std::string, Read> readers = {
      {"--out", [&](const auto&, const auto& text) { options.out = text; }},
      {"--topic", [&](const auto&, const auto& text) { options.topic = text; }},
      {"--start", [&](const auto& o, const auto& text) { options.excerpt.start = readNumber(o, text, 0.0, kLongest); }},
      {"--end", [&](const auto& o, const auto& text) { options.excerpt.end = readNumber(o, text, 0.0, kLongest); }},
      {"--rate", [&](const auto& o, const auto& text) { options.excerpt.rate = readNumber(o, text, 1e-3, kFastest); }},
      {"--color", [&](const auto& o, const auto& text) { options.color = readColor(o, text); }}};
  for (int a = 1; a < argc; ++a) {
    const std::string option = argv[a];
    const auto reader = readers.find(option);
    if (reader != readers.end()) {
      if (a + 1 >= argc) throw std::invalid_argument(option + ": needs a value");
      reader->second(option, argv[++a]);
    } else if (option == "--help" || option == "-h") {
      options.help = true;
    } else if (option.size() > 1 && option[0] == '-') {
      throw std::invalid_argument(option + ": unknown option");
    } else if (options.source.empty()) {
      options.source = option;
    } else {
      throw std::invalid_argument(option + ": one scene or bag at a time");
    }
  }
  if (!options.help) check(options);
  return options;
}

// False: the state became non-finite.
bool play(const Options& options, curtain::AnimationWriter& writer) {
  if (isBag(options)) {
    curtain::playBag(options.source, options.topic, options.excerpt, writer);
    return true;
  }
  const curtain::SceneReading reading = curtain::readSceneFile(options.source);
  if (!reading.problems.empty()) throw std::invalid_argument(curtain::describe(reading.problems, options.source));
  return curtain::playScene(reading.scene, options.excerpt, writer);
}

// False: as play().
bool writeGltf(const Options& options) {
  curtain::GltfAnimation animation(options.color);
  if (!play(options, animation)) return false;
  const std::vector<curtain::Problem> problems = curtain::writeWholeFile(options.out, animation.file());
  if (!problems.empty()) throw std::runtime_error(curtain::describe(problems));
  std::cout << options.out << ": " << animation.count() << " frames\n";
  return true;
}

bool writePly(const Options& options) {
  curtain::PlySeries series(options.out);
  if (!play(options, series)) return false;
  std::cout << series.pathOf(0) << " to " << series.pathOf(series.count() - 1) << ": " << series.count() << " frames\n";
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  std::signal(SIGXFSZ, SIG_IGN);  // a limit of file sizes is reported by the write that meets it
  try {
    const Options options = readOptions(argc, argv);
    if (options.help) {
      std::cout << kUsage;
      return EXIT_SUCCESS;
    }
    if (endingOf(options.out) == ".glb" ? writeGltf(options) : writePly(options)) return EXIT_SUCCESS;
    std::cerr << "curtain_export: the state became non-finite\n";
    return kNotFinite;
  } catch (const std::runtime_error& error) {
    std::cerr << "curtain_export: " << error.what() << '\n';
    return kNotWritten;
  } catch (const std::exception& error) {
    std::cerr << "curtain_export: " << error.what() << '\n';
    return kBadInput;
  }
}
