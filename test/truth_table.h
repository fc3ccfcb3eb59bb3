// SPDX-License-Identifier: BSD-3-Clause
//
// Reads the tables of test/truth.
#pragma once

#include <fstream>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

namespace curtain_test {

/// A row of a table: column name to text.
using TruthRow = std::map<std::string, std::string>;

inline std::vector<std::string> splitLine(const std::string& line) {
  std::vector<std::string> cells(1);
  bool quoted = false;
  for (const char letter : line) {
    if (letter == '"') {
      quoted = !quoted;
    } else if (letter == ',' && !quoted) {
      cells.emplace_back();
    } else {
      cells.back() += letter;
    }
  }
  return cells;
}

/// All rows of test/truth/NAME; lines that start with # are remarks, the first other one names the columns.
inline std::vector<TruthRow> readTruth(const std::string& name) {
  std::ifstream file(std::string(CURTAIN_SOURCE_DIR) + "/test/truth/" + name);
  if (!file) throw std::runtime_error("no truth table " + name);
  std::vector<std::string> header;
  std::vector<TruthRow> rows;
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line[0] == '#') continue;
    const std::vector<std::string> cells = splitLine(line);
    if (header.empty()) {
      header = cells;
      continue;
    }
    TruthRow row;
    for (std::size_t c = 0; c < cells.size() && c < header.size(); ++c) row[header[c]] = cells[c];
    rows.push_back(row);
  }
  return rows;
}

}  // namespace curtain_test
