// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "step/elastic_part.h"
#include "step/guide_part.h"
#include "step/row_part.h"

namespace curtain {

/// What constrains the cloth beside rods, strings and contacts. They must outlive the solver.
struct SolverParts {
  ElasticPart* elastic = nullptr;  ///< null: limp cloth
  GuidePart* guide = nullptr;      ///< null: all nodes are free or pinned
  std::vector<RowPart*> rows;      ///< in the order of their rows
};

}  // namespace curtain
