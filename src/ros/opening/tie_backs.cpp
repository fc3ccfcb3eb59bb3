// SPDX-License-Identifier: BSD-3-Clause
#include "ros/opening/tie_backs.h"

#include <algorithm>

namespace curtain_ros {
namespace {

constexpr std::size_t kMaxRequests = 50;  // between two frames

std::vector<std::string> idsOf(const curtain::Scene& scene) {
  std::vector<std::string> ids;
  for (const curtain::TieBackParams& loop : scene.tie_back) ids.push_back(loop.id);
  return ids;
}

}  // namespace

TieBacks::TieBacks(ros::NodeHandle private_node, const curtain::Scene& scene)
    : ids_(idsOf(scene)),
      mailbox_(kMaxRequests),
      server_(private_node.advertiseService("tie_back", &TieBacks::answer, this)) {}

bool TieBacks::answer(curtain_sim::TieBack::Request& request, curtain_sim::TieBack::Response& response) {
  response.success = std::find(ids_.begin(), ids_.end(), request.id) != ids_.end();
  if (response.success) {
    mailbox_.post(request);
    return true;
  }
  response.message = "there is no tie-back '" + request.id + "', known are";
  for (const std::string& id : ids_) response.message += " '" + id + "'";
  return true;
}

void TieBacks::apply(curtain::Simulator& simulator) {
  mailbox_.collect(requests_);
  for (const curtain_sim::TieBack::Request& request : requests_) simulator.setTieBack(request.id, request.closed != 0);
  requests_.clear();
}

}  // namespace curtain_ros
