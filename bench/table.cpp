// SPDX-License-Identifier: BSD-3-Clause
#include "bench/table.h"

#include <cmath>
#include <cstdio>
#include <stdexcept>

namespace curtain_bench {

std::string number(double value, int figures) {
  if (!std::isfinite(value)) return "nan";
  char text[32];
  std::snprintf(text, sizeof text, "%.*g", figures, value);
  return text;
}

std::string number(int value) { return std::to_string(value); }

Table::Table(const std::string& folder, const std::string& name, const std::vector<std::string>& columns)
    : file_(folder + "/" + name), columns_(columns.size()) {
  if (!file_) throw std::runtime_error("can't write " + folder + "/" + name);
  write(columns);
}

void Table::row(const std::vector<std::string>& cells) {
  if (cells.size() != columns_) throw std::logic_error("a row has " + std::to_string(cells.size()) + " cells");
  write(cells);
}

void Table::write(const std::vector<std::string>& cells) {
  for (std::size_t c = 0; c < cells.size(); ++c) file_ << (c > 0 ? "," : "") << cells[c];
  file_ << std::endl;  // flushed: a study that is stopped leaves what it has
}

}  // namespace curtain_bench
