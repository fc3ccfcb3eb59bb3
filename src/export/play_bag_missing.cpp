// SPDX-License-Identifier: BSD-3-Clause
#include <stdexcept>

#include "export/play_bag.h"

namespace curtain {

void playBag(const std::string& path, const std::string&, const Excerpt&, AnimationWriter&) {
  throw std::invalid_argument(path +
                              ": this program was built without ROS and librosbag-storage-dev, it reads no bags");
}

}  // namespace curtain
