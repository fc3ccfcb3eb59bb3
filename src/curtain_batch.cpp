// SPDX-License-Identifier: BSD-3-Clause
//
// curtain_batch: the engine without ROS, for measuring, sweeps and tests.
#include <csignal>
#include <cstdlib>
#include <iostream>
#include <stdexcept>

#include "batch/options.h"
#include "batch/run.h"
#include "curtain_sim/scene_yaml.h"
#include "curtain_sim/snapshot_file.h"
#include "simulator/export.h"
#include "simulator/whole_file.h"

namespace {

using curtain_batch::Options;

constexpr int kBadInput = 2;
constexpr int kNotFinite = 3;
constexpr int kNotWritten = 4;

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

void explain(const curtain::Simulator& simulator) {
  std::cout << "t = " << simulator.time() << " s\n" << curtain::describe(simulator.plan());
}

int simulate(Options options) {
  curtain::Simulator simulator(readScene(options.scenes.front(), options));
  restore(simulator, options);
  if (options.sample_rate > 0.0) options.samples = samplesFrom(simulator.time(), options);
  if (options.explain) explain(simulator);
  const curtain_batch::Progress progress = makeRun(options, simulator);
  if (options.explain && !progress.sums.frame_seconds.empty()) explain(simulator);
  save(simulator, options);
  if (!options.mesh.empty()) curtain::writeMesh(simulator, options.mesh);
  if (!options.stats.empty()) {
    const std::string text = curtain::statisticsJson(simulator, progress.sums);
    const std::vector<curtain::Problem> problems = curtain::writeWholeFile(options.stats, text);
    if (!problems.empty()) throw std::runtime_error(curtain::describe(problems, "--stats"));
  }
  const std::string jammed = curtain::describeLastResort(simulator.statistics());
  if (!jammed.empty()) std::cerr << "curtain_batch: " << jammed << '\n';
  for (const curtain::HandParams& hand : simulator.scene().hands) {
    const auto state = simulator.graspState(hand.grasp.id);
    const std::string failure = state ? curtain::describeFailure(hand, state->end) : "";
    if (!failure.empty()) std::cerr << "curtain_batch: " << failure << '\n';
  }
  if (simulator.statistics().finite) return EXIT_SUCCESS;
  std::cerr << "curtain_batch: the state became non-finite at t = " << simulator.time() << " s\n";
  return kNotFinite;
}

// Lists what is wrong with each of the scenes.
int check(const Options& options) {
  int worst = EXIT_SUCCESS;
  for (const std::string& path : options.scenes) {
    try {
      const std::vector<curtain::Problem> problems = curtain::validate(readScene(path, options));
      if (!problems.empty()) throw std::invalid_argument(curtain::describe(problems, path));
    } catch (const std::invalid_argument& error) {
      std::cerr << "curtain_batch: " << error.what() << '\n';
      worst = kBadInput;
    }
  }
  return worst;
}

int answer(const Options& options) {
  if (options.help) {
    std::cout << curtain_batch::kUsage;
    return EXIT_SUCCESS;
  }
  if (options.version) {
    std::cout << "curtain_batch " CURTAIN_VERSION "\n";
    return EXIT_SUCCESS;
  }
  if (options.list_methods) {
    for (const std::string& name : curtain::methodNames()) std::cout << name << '\n';
    return EXIT_SUCCESS;
  }
  return options.check ? check(options) : simulate(options);
}

}  // namespace

int main(int argc, char** argv) {
  std::signal(SIGXFSZ, SIG_IGN);  // a limit of file sizes is reported by the write that meets it
  try {
    return answer(curtain_batch::readOptions(argc, argv));
  } catch (const std::runtime_error& error) {
    std::cerr << "curtain_batch: " << error.what() << '\n';
    return kNotWritten;
  } catch (const std::exception& error) {
    std::cerr << "curtain_batch: " << error.what() << '\n';
    return kBadInput;
  }
}
