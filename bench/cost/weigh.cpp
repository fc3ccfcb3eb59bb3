// SPDX-License-Identifier: BSD-3-Clause
#include "bench/cost/weigh.h"

#include <sys/wait.h>

#include <cstdio>
#include <cstdlib>
#include <memory>
#include <sstream>
#include <stdexcept>

namespace curtain_bench {
namespace {

// What a command says, on both of its outputs.
std::string outputOf(const std::string& command) {
  FILE* const pipe = popen((command + " 2>&1").c_str(), "r");
  if (pipe == nullptr) throw std::runtime_error("can't run " + command);
  std::string text;
  char piece[4096];
  while (const std::size_t count = std::fread(piece, 1, sizeof piece, pipe)) text.append(piece, count);
  const int status = pclose(pipe);
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) throw std::runtime_error(command + " failed:\n" + text);
  return text;
}

// The first word after a key that occurs once.
std::string wordAfter(const std::string& text, const std::string& key) {
  const std::size_t at = text.find(key);
  if (at == std::string::npos) throw std::runtime_error("no '" + key + "' in:\n" + text);
  std::istringstream rest(text.substr(at + key.size()));
  std::string word;
  rest >> word;
  return word;
}

std::string programFor(const Feature& feature, FeatureState state) {
  return std::string("'") + CURTAIN_COST + "' '" + feature.name + "' " + stateName(state);
}

Weight read(const std::string& text) {
  Weight weight;
  weight.ns = std::stod(wordAfter(text, "ns:"));
  weight.substeps = std::stod(wordAfter(text, "substeps:"));
  weight.state_hash = wordAfter(text, "hash:");
  return weight;
}

}  // namespace

Weight weigh(const Feature& feature, FeatureState state) {
  if (std::system("valgrind --version >/dev/null 2>&1") != 0) {
    throw std::runtime_error("valgrind is missing, instructions can't be counted (Debian: apt-get install valgrind)");
  }
  const std::string callgrind =
      "valgrind --tool=callgrind --callgrind-out-file=/dev/null --toggle-collect=weighedFrame ";
  const std::string text = outputOf(callgrind + programFor(feature, state));
  Weight weight = read(text);
  weight.ns = 0.0;
  weight.instructions = std::stod(wordAfter(text, "Collected :")) / (feature.frames * feature.nodes);
  return weight;
}

Weight clockOf(const Feature& feature, FeatureState state) { return read(outputOf(programFor(feature, state))); }

}  // namespace curtain_bench
