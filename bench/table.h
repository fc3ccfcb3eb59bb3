// SPDX-License-Identifier: BSD-3-Clause
//
// A CSV file, written row by row.
#pragma once

#include <fstream>
#include <string>
#include <vector>

namespace curtain_bench {

/// A number as CSV and gnuplot read it; "nan" where there is none.
std::string number(double value, int figures = 4);
std::string number(int value);

class Table {
 public:
  /// Writes NAME into the folder. Throws std::runtime_error when it can't be.
  Table(const std::string& folder, const std::string& name, const std::vector<std::string>& columns);

  /// As many cells as columns; none may hold a comma.
  void row(const std::vector<std::string>& cells);

 private:
  void write(const std::vector<std::string>& cells);

  std::ofstream file_;
  std::size_t columns_ = 0;
};

}  // namespace curtain_bench
