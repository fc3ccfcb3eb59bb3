// SPDX-License-Identifier: BSD-3-Clause
#include "ros/watch/xmlrpc_call.h"

#include <ros/network.h>
#include <ros/this_node.h>
#include <xmlrpcpp/XmlRpcClient.h>

namespace curtain_ros {

using XmlRpc::XmlRpcValue;

namespace {
// [s], whatever its header says of milliseconds. An answer takes 1 ms on an idle computer.
constexpr double kPatience = 2.0;
}  // namespace

XmlRpcAnswer callXmlRpc(const std::string& uri, const std::string& method, const std::vector<XmlRpcValue>& parameters) {
  XmlRpcAnswer answer;
  std::string host;
  std::uint32_t port = 0;
  if (!ros::network::splitURI(uri, host, port)) return answer;
  XmlRpcValue request;
  request[0] = ros::this_node::getName();
  for (std::size_t i = 0; i < parameters.size(); ++i) request[static_cast<int>(i) + 1] = parameters[i];

  XmlRpc::XmlRpcClient client(host.c_str(), static_cast<int>(port), "/");
  XmlRpcValue response;
  if (client.executeNonBlock(method.c_str(), request)) client._disp.work(kPatience);
  const bool done = client.executeCheckDone(response);
  client.close();
  if (!done || !response.valid()) return answer;  // done, but without a word: nobody is there
  answer.answered = true;
  answer.value = response;
  // [code, message, value]; code 1: success
  if (response.getType() != XmlRpcValue::TypeArray || response.size() != 3) return answer;
  if (response[0].getType() != XmlRpcValue::TypeInt) return answer;
  answer.success = static_cast<int&>(response[0]) == 1;
  answer.value = response[2];
  return answer;
}

}  // namespace curtain_ros
