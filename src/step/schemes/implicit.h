// SPDX-License-Identifier: BSD-3-Clause
//
// Backward Euler: forces act along the links' directions at the end of the step. Order 1, damps, stable at any step.
#pragma once

#include "step/scheme.h"

namespace curtain {

class Implicit final : public Scheme {
 public:
  Implicit() noexcept : Scheme({true, true, 0.0}) {}
};

}  // namespace curtain
