// SPDX-License-Identifier: BSD-3-Clause
//
// Reads the files of this checkout.
#pragma once

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace curtain_test {

struct SourceFile {
  std::string name;  ///< relative to the checkout, with slashes
  std::string text;
};

inline std::vector<std::string> lines(const std::string& text) {
  std::vector<std::string> result;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) result.push_back(line);
  return result;
}

/// All files under a folder of the checkout ("" = all of it) but for .git and build folders, sorted by name.
inline std::vector<SourceFile> sourceFiles(const std::string& folder) {
  namespace fs = std::filesystem;
  const fs::path root = CURTAIN_SOURCE_DIR;
  std::vector<SourceFile> files;
  for (auto entry = fs::recursive_directory_iterator(root / folder); entry != fs::end(entry); ++entry) {
    const std::string name = entry->path().filename().string();
    if (entry->is_directory()) {
      const bool built = fs::exists(entry->path() / "CMakeCache.txt") || name.rfind("build", 0) == 0;
      if (name == ".git" || name == "__pycache__" || built) entry.disable_recursion_pending();
      continue;
    }
    std::ifstream file(entry->path(), std::ios::binary);
    std::ostringstream text;
    text << file.rdbuf();
    files.push_back({fs::relative(entry->path(), root).generic_string(), text.str()});
  }
  std::sort(files.begin(), files.end(), [](const SourceFile& a, const SourceFile& b) { return a.name < b.name; });
  return files;
}

}  // namespace curtain_test
