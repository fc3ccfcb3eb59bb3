// SPDX-License-Identifier: BSD-3-Clause
//
// Where a number stops being one: while a FloatTraps lives, an operation of this thread that makes NaN, divides by zero
// or overflows ends the program (SIGFPE) at the place where it happens. For Debug builds: others let the compiler
// compute what is thrown away (-fno-trapping-math).
#pragma once

#include <cfenv>

namespace curtain_test {

class FloatTraps {
 public:
  FloatTraps() {
    std::feclearexcept(FE_ALL_EXCEPT);
    before_ = feenableexcept(FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW);
  }
  ~FloatTraps() {
    std::feclearexcept(FE_ALL_EXCEPT);
    fedisableexcept(FE_ALL_EXCEPT);
    feenableexcept(before_);
  }
  FloatTraps(const FloatTraps&) = delete;
  FloatTraps& operator=(const FloatTraps&) = delete;

 private:
  int before_ = 0;
};

}  // namespace curtain_test
