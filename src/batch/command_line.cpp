// SPDX-License-Identifier: BSD-3-Clause
#include "batch/command_line.h"

#include <cmath>
#include <filesystem>
#include <stdexcept>

namespace curtain_batch {

double numberOf(const std::string& text) {
  try {
    std::size_t used = 0;
    const double value = std::stod(text, &used);
    return used == text.size() ? value : std::nan("");
  } catch (const std::exception&) {
    return std::nan("");
  }
}

void checkOutput(const std::string& option, const std::string& path) {
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  if (!folder.empty() && !std::filesystem::is_directory(folder)) {
    throw std::invalid_argument(option + ": there is no folder '" + folder.string() + "'");
  }
  if (std::filesystem::is_directory(path)) throw std::invalid_argument(option + ": '" + path + "' is a folder");
}

}  // namespace curtain_batch
