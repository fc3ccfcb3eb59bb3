// SPDX-License-Identifier: BSD-3-Clause
//
// Reads the queries of test/truth/ccd, see test/truth/README.md. Little-endian machines only, as the files are.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "curtain_sim/ccd.h"

namespace curtain_test {

/// p, a, b, c or a, b, c, d at t = 0, then at t = 1.
using CcdPoints = std::array<curtain::Vec3, 8>;

struct CcdQuery {
  bool edges = false;  ///< edge and edge; else vertex and triangle
  bool hit = false;    ///< the exact answer
  CcdPoints points;
};

inline std::optional<double> timeOfImpact(bool edges, const CcdPoints& x, double min_distance = 0.0) {
  const auto query = edges ? curtain::edgeEdgeTimeOfImpact : curtain::vertexTriangleTimeOfImpact;
  return query(x[0], x[1], x[2], x[3], x[4], x[5], x[6], x[7], min_distance);
}

/// All of test/truth/ccd/NAME.
inline std::vector<CcdQuery> readCcdQueries(const std::string& name) {
  std::ifstream file(std::string(CURTAIN_SOURCE_DIR) + "/test/truth/ccd/" + name, std::ios::binary);
  const std::vector<char> bytes{std::istreambuf_iterator<char>(file), {}};
  constexpr std::size_t kHead = 12;
  constexpr std::size_t kRecord = 8 + 24 * sizeof(double);
  std::uint32_t count = 0;
  if (bytes.size() < kHead || std::memcmp(bytes.data(), "CCDQ", 4) != 0) throw std::runtime_error("no queries " + name);
  std::memcpy(&count, bytes.data() + 8, sizeof(count));
  if (bytes.size() != kHead + kRecord * count) throw std::runtime_error("queries cut short: " + name);
  std::vector<CcdQuery> queries(count);
  for (std::size_t q = 0; q < count; ++q) {
    const char* const record = bytes.data() + kHead + kRecord * q;
    queries[q].edges = record[0] == 1;
    queries[q].hit = record[1] == 1;
    for (std::size_t p = 0; p < 8; ++p) {
      std::memcpy(queries[q].points[p].data(), record + 8 + 24 * p, 3 * sizeof(double));
    }
  }
  return queries;
}

}  // namespace curtain_test
