// SPDX-License-Identifier: BSD-3-Clause
//
// One of the checks as a libFuzzer target; CMake says which.
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include "fuzz/checks.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    curtain_test::CURTAIN_FUZZ_CHECK(std::string(reinterpret_cast<const char*>(data), size));
  } catch (const curtain_test::Violation& violation) {
    std::fprintf(stderr, "violated: %s\n", violation.what());
    std::abort();
  }
  return 0;
}
