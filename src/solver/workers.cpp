// SPDX-License-Identifier: BSD-3-Clause
#include "solver/workers.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <thread>

namespace curtain {
namespace {

// Waking a thread costs some 5 us; below this size a pass over the cloth takes not much longer.
constexpr std::size_t kNodesWorthThreads = 8000;

}  // namespace

struct Workers::Arena {
  explicit Arena(int threads) : arena(threads) {}
  tbb::task_arena arena;
};

Workers::Workers(int threads)
    : threads_(std::max(1, threads)), arena_(threads_ > 1 ? std::make_unique<Arena>(threads_) : nullptr) {}

Workers::~Workers() = default;

void Workers::spread(int count, void (*call)(const void*, int), const void* block) const {
  arena_->arena.execute([&] {
    tbb::parallel_for(
        tbb::blocked_range<int>(0, count),
        [&](const tbb::blocked_range<int>& range) {
          for (int b = range.begin(); b < range.end(); ++b) call(block, b);
        },
        tbb::static_partitioner());
  });
}

int threadsFor(int asked, std::size_t node_count) {
  if (asked > 0) return asked;
  if (node_count < kNodesWorthThreads) return 1;
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

}  // namespace curtain
