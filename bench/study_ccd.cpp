// SPDX-License-Identifier: BSD-3-Clause
//
// Continuous collision detection on the public queries of test/truth/ccd: time a query, what is missed, false alarms.
#include <algorithm>
#include <chrono>
#include <iterator>
#include <limits>

#include "bench/studies.h"
#include "bench/table.h"
#include "ccd_truth.h"

namespace curtain_bench {
namespace {

using curtain_test::CcdQuery;

/// ns a query, the least of the repeats; `told`: how many are told to be impacts.
double nanoseconds(const std::vector<CcdQuery>& queries, double min_distance, int repeats, int& told) {
  double least = std::numeric_limits<double>::infinity();
  for (int repeat = 0; repeat < repeats; ++repeat) {
    told = 0;
    const auto begin = std::chrono::steady_clock::now();
    for (const CcdQuery& query : queries) {
      if (curtain_test::timeOfImpact(query.edges, query.points, min_distance)) ++told;
    }
    const std::chrono::duration<double, std::nano> time = std::chrono::steady_clock::now() - begin;
    least = std::min(least, time.count() / static_cast<double>(queries.size()));
  }
  return least;
}

}  // namespace

void studyCcd(const Options& options) {
  // A round takes two milliseconds, so many of them cost nothing.
  const int repeats = (options.quick ? 2 : 20) * options.repeats;
  Table table(options.folder, "ccd.csv",
              {"set", "pair", "queries", "hits", "missed", "false_alarms", "ns_min", "ns_min_1mm"});
  for (const std::string set : {"queries", "queries_cloth"}) {
    const std::vector<CcdQuery> all = curtain_test::readCcdQueries(set + ".bin");
    for (const bool edges : {false, true}) {
      std::vector<CcdQuery> queries;
      std::copy_if(all.begin(), all.end(), std::back_inserter(queries),
                   [edges](const CcdQuery& q) { return q.edges == edges; });
      int hits = 0;
      int missed = 0;
      for (const CcdQuery& query : queries) {
        if (!query.hit) continue;
        ++hits;
        if (!curtain_test::timeOfImpact(edges, query.points)) ++missed;
      }
      int told = 0;
      int told_near = 0;
      const double ns = nanoseconds(queries, 0.0, repeats, told);
      const double ns_near = nanoseconds(queries, 1e-3, repeats, told_near);
      table.row({set == "queries" ? "handcrafted" : "cloth", edges ? "edge and edge" : "vertex and triangle",
                 number(static_cast<int>(queries.size())), number(hits), number(missed), number(told - hits + missed),
                 number(ns), number(ns_near)});
    }
  }
}

}  // namespace curtain_bench
