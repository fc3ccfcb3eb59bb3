// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace curtain_ros {

/// Between two warnings of one kind on the log. [s] What lasts is told often enough to be seen, and does not fill the
/// log.
constexpr double kWarnPeriod = 5.0;

}  // namespace curtain_ros
