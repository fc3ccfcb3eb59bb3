// SPDX-License-Identifier: BSD-3-Clause
#include "fit/settling.h"

namespace curtain_fit {

void Settling::step() {
  motion_.statistics.time = times_.begin();
  const curtain::FrameBegin begin{times_.begin(), times_.end(), times_.rate(), true};
  for (curtain::Part* const part : motion_.parts.all) part->prepareFrame(begin, motion_.state);
  for (curtain::Part* const part : motion_.parts.all) part->beginFrame(begin, motion_.state);
  loop_.make();
  const curtain::FrameEnd end{1.0, times_.length(), true, motion_.statistics};
  for (curtain::Part* const part : motion_.parts.all) part->endFrame(end, motion_.state);
  times_.next(1.0);
}

}  // namespace curtain_fit
