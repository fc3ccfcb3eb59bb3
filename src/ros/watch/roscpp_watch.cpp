// SPDX-License-Identifier: BSD-3-Clause
#include "ros/watch/roscpp_watch.h"

#include <ros/connection_manager.h>
#include <ros/console.h>
#include <ros/init.h>
#include <ros/master.h>
#include <ros/network.h>
#include <ros/param.h>
#include <ros/this_node.h>
#include <ros/xmlrpc_manager.h>
#include <xmlrpcpp/XmlRpcClient.h>

#include <utility>

#include "ros/time/warn_period.h"

namespace curtain_ros {

using XmlRpc::XmlRpcValue;

namespace {

constexpr double kPeriod = 1.0;    // [s] between two checks
constexpr double kPatience = 2.0;  // [s] for an answer; an idle computer gives it within 1 ms

struct Answer {
  bool came = false;     // false: nobody there, or not in time
  bool success = false;  // it has the form [code, message, value], with the code of success
  XmlRpcValue value;     // [2] of that form; else the whole answer, as of getBusStats
};

// Calls a method with this node's name in front of the parameters.
Answer call(const std::string& uri, const std::string& method, const std::vector<XmlRpcValue>& parameters = {}) {
  Answer answer;
  std::string host;
  std::uint32_t port = 0;
  if (!ros::network::splitURI(uri, host, port)) return answer;
  XmlRpcValue request;
  request[0] = ros::this_node::getName();
  for (const XmlRpcValue& parameter : parameters) request[request.size()] = parameter;

  XmlRpc::XmlRpcClient client(host.c_str(), static_cast<int>(port), "/");
  XmlRpcValue response;
  if (client.executeNonBlock(method.c_str(), request)) client._disp.work(kPatience);
  const bool done = client.executeCheckDone(response);
  client.close();
  if (!done || !response.valid()) return answer;  // an invalid response: nobody is there
  const bool usual = response.getType() == XmlRpcValue::TypeArray && response.size() == 3 &&
                     response[0].getType() == XmlRpcValue::TypeInt;
  answer.came = true;
  answer.success = usual && static_cast<int&>(response[0]) == 1;
  answer.value = usual ? response[2] : response;
  return answer;
}

Answer askMaster(const std::string& method, const std::vector<XmlRpcValue>& parameters) {
  return call(ros::master::getURI(), method, parameters);
}

std::string ownUri() { return ros::XMLRPCManager::instance()->getServerURI(); }

int sizeOf(const XmlRpcValue& list) { return list.getType() == XmlRpcValue::TypeArray ? list.size() : 0; }

// What roscpp itself serves in each node, from its start to its end.
std::vector<std::string> services() {
  return {ros::this_node::getName() + "/get_loggers", ros::this_node::getName() + "/set_logger_level"};
}

// Tells this process who publishes a topic, as a master does. Roscpp disconnects publishers that are not listed, so
// those still connected are listed, too, whether the new master knows them or not.
bool announcePublishers(const XmlRpcValue& topic, XmlRpcValue publishers) {
  if (sizeOf(publishers) == 0) return true;
  Answer connections = call(ownUri(), "getBusInfo");
  if (!connections.success) return false;
  for (int i = 0; i < sizeOf(connections.value); ++i) {
    XmlRpcValue& connection = connections.value[i];  // id, peer, direction, transport, topic, …
    if (connection[2] == XmlRpcValue("i") && connection[4] == topic) publishers[publishers.size()] = connection[1];
  }
  return call(ownUri(), "publisherUpdate", {topic, publishers}).success;
}

// Registers what this process lists as its topics, pairs of name and type.
bool registerTopics(const std::string& list, const std::string& method) {
  Answer topics = call(ownUri(), list);
  for (int i = 0; i < sizeOf(topics.value); ++i) {
    XmlRpcValue& topic = topics.value[i];
    const Answer others = askMaster(method, {topic[0], topic[1], XmlRpcValue(ownUri())});
    if (!others.success) return false;
    if (method == "registerSubscriber" && !announcePublishers(topic[0], others.value)) return false;
  }
  return topics.success;
}

// Where somebody has set parameters below the name already, those are kept.
bool restoreParameters(const std::string& space, const XmlRpcValue& parameters) {
  const Answer there = askMaster("hasParam", {XmlRpcValue(space)});
  if (!there.success) return false;
  return there.value == XmlRpcValue(true) || askMaster("setParam", {XmlRpcValue(space), parameters}).success;
}

XmlRpcValue parametersBelow(const std::string& space) {
  XmlRpcValue tree;
  ros::param::get(space, tree);
  return tree;
}

}  // namespace

RoscppWatch::RoscppWatch(const std::string& private_space, const std::vector<std::string>& topics,
                         const std::vector<std::string>& services, std::function<void()> registered)
    : private_space_(private_space),
      parameters_(parametersBelow(private_space)),
      topics_(topics.begin(), topics.end()),
      services_(services),
      registered_(std::move(registered)),
      thread_(kPeriod, [this] {
        checkQueues();
        checkMaster();
      }) {}

// Of the node, and those that roscpp itself serves.
bool RoscppWatch::registerServices() const {
  const std::string uri =
      "rosrpc://" + ros::network::getHost() + ":" + std::to_string(ros::ConnectionManager::instance()->getTCPPort());
  std::vector<std::string> all = services();
  all.insert(all.end(), services_.begin(), services_.end());
  for (const std::string& service : all) {
    if (!askMaster("registerService", {XmlRpcValue(service), XmlRpcValue(uri), XmlRpcValue(ownUri())}).success)
      return false;
  }
  return true;
}

void RoscppWatch::checkMaster() {
  // Asks for a service, not for the node: a new master knows the node's name as soon as any topic of it is registered.
  const Answer answer = askMaster("lookupService", {XmlRpcValue(services().front())});
  if (!ros::ok() || ros::isShuttingDown()) return;  // a node that shuts down takes itself off the master's list
  logWhetherMasterAnswers(answer.came);
  if (!answer.came) return;
  forgotten_ = forgotten_ || !answer.success;
  if (!forgotten_ || !registerAll()) return;
  forgotten_ = false;
  ++lost_;
  registered_();
  ROS_WARN_STREAM(
      "the ROS master at " << ros::master::getURI() << " had forgotten this node, as after a restart: registered "
                           << "its topics, its services and the parameters of " << private_space_ << " again");
}

void RoscppWatch::logWhetherMasterAnswers(bool answers) {
  if (answers == answers_) return;
  answers_ = answers;
  if (answers) {
    ROS_INFO_STREAM("the ROS master at " << ros::master::getURI() << " answers again");
  } else {
    ROS_WARN_STREAM("the ROS master at " << ros::master::getURI()
                                         << " does not answer: connections go on, new ones are not possible");
  }
}

bool RoscppWatch::registerAll() const {
  return restoreParameters(private_space_, parameters_) && registerTopics("getPublications", "registerPublisher") &&
         registerTopics("getSubscriptions", "registerSubscriber") && registerServices();
}

void RoscppWatch::checkQueues() {
  Answer answer = call(ownUri(), "getBusStats");  // [publications, subscriptions, services]
  if (sizeOf(answer.value) < 2) return;
  XmlRpcValue& subscriptions = answer.value[1];
  const std::uint64_t before = dropped_;
  for (int i = 0; i < sizeOf(subscriptions); ++i) {
    if (topics_.count(static_cast<std::string&>(subscriptions[i][0])) == 0) continue;
    for (int k = 0; k < sizeOf(subscriptions[i][1]); ++k) {
      XmlRpcValue& connection = subscriptions[i][1][k];  // id, bytes, messages, drops, …
      const auto drops = static_cast<std::uint64_t>(static_cast<int&>(connection[3]));
      std::uint64_t& known = dropped_by_connection_[static_cast<int&>(connection[0])];
      dropped_ += drops - known;
      known = drops;
    }
  }
  if (dropped_ == before) return;
  ROS_WARN_STREAM_THROTTLE(kWarnPeriod, "messages arrive faster than this process handles them: "
                                            << dropped_ << " dropped in roscpp's queues so far");
}

}  // namespace curtain_ros
