// SPDX-License-Identifier: BSD-3-Clause
//
// The threads of a simulator: parallel loops over independent blocks. A block's result does not depend on who computes
// it, and reductions run over the blocks in order, so any number of threads gives the same bits.
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>

namespace curtain {

class Workers {
 public:
  /// threads >= 1; 1 runs everything on the caller's thread.
  explicit Workers(int threads);
  ~Workers();
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  int threads() const { return threads_; }
  /// Number of parts to divide work of uneven cost into.
  int shares() const { return threads_ == 1 ? 1 : kSharesPerThread * threads_; }

  /// While it lives helper threads poll for work, so that a loop of a few microseconds is worth sharing. One at a time.
  class Shift {
   public:
    explicit Shift(const Workers& workers);
    ~Shift();
    Shift(const Shift&) = delete;
    Shift& operator=(const Shift&) = delete;

   private:
    const Workers& workers_;
  };

  /// Calls block(0) … block(count - 1), each once; returns when all are done. Outside of a shift the caller does all.
  /// block must not throw, nor run another loop.
  template <typename Block>
  void run(int count, const Block& block) const {
    if (!onShift() || count < 2 || count > kMaxBlocks) {
      for (int b = 0; b < count; ++b) block(b);
      return;
    }
    share(
        count, [](const void* self, int b) { (*static_cast<const Block*>(self))(b); }, &block);
  }
  /// Items of a loop that one thread takes at a time where each is a search of a microsecond or so.
  static constexpr std::size_t kSearchesAtOnce = 64;
  /// Calls chunk(first, end) for parts of 0 … count - 1, of `at_once` each but the last.
  template <typename Chunk>
  void runChunks(std::size_t count, std::size_t at_once, const Chunk& chunk) const {
    run(static_cast<int>((count + at_once - 1) / at_once), [&](int c) {
      const std::size_t first = static_cast<std::size_t>(c) * at_once;
      chunk(first, std::min(first + at_once, count));
    });
  }

 private:
  static constexpr int kMaxBlocks = 0xffff;
  static constexpr int kSharesPerThread = 4;

  bool onShift() const noexcept;
  void share(int count, void (*call)(const void*, int), const void* block) const;

  struct Crew;
  int threads_;
  std::unique_ptr<Crew> crew_;
};

/// Threads for a cloth of so many nodes when `asked` is 0 (auto), at most the machine's cores.
int threadsFor(int asked, std::size_t node_count);

}  // namespace curtain
