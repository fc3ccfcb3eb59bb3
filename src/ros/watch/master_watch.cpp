// SPDX-License-Identifier: BSD-3-Clause
#include "ros/watch/master_watch.h"

#include <ros/connection_manager.h>
#include <ros/console.h>
#include <ros/init.h>
#include <ros/master.h>
#include <ros/network.h>
#include <ros/param.h>
#include <ros/service_manager.h>
#include <ros/this_node.h>
#include <ros/xmlrpc_manager.h>

#include <algorithm>

#include "ros/watch/xmlrpc_call.h"

namespace curtain_ros {

using XmlRpc::XmlRpcValue;

namespace {

constexpr int kServicesEvery = 60;  // looks; services rarely come and go

std::string ownUri() { return ros::XMLRPCManager::instance()->getServerURI(); }

XmlRpcAnswer askMaster(const std::string& method, const std::vector<XmlRpcValue>& parameters) {
  return callXmlRpc(ros::master::getURI(), method, parameters);
}

// What roscpp itself serves in each node.
std::vector<std::string> alwaysServed() {
  return {ros::this_node::getName() + "/get_loggers", ros::this_node::getName() + "/set_logger_level"};
}

bool isArray(const XmlRpcValue& value) { return value.getType() == XmlRpcValue::TypeArray; }

// What this process itself says of its topics: pairs of name and type.
std::vector<std::pair<XmlRpcValue, XmlRpcValue>> ownTopics(const std::string& method) {
  std::vector<std::pair<XmlRpcValue, XmlRpcValue>> topics;
  XmlRpcAnswer answer = callXmlRpc(ownUri(), method, {});
  if (!answer.success || !isArray(answer.value)) return topics;
  for (int i = 0; i < answer.value.size(); ++i) topics.emplace_back(answer.value[i][0], answer.value[i][1]);
  return topics;
}

XmlRpcValue parametersOf(const std::string& space) {
  XmlRpcValue tree;
  ros::param::get(space, tree);
  return tree;
}

}  // namespace

MasterWatch::MasterWatch(const std::string& private_space)
    : private_space_(private_space), parameters_(parametersOf(private_space)), services_(alwaysServed()) {}

void MasterWatch::look() {
  // A service that every roscpp node has from its start to its end. Not the node's name: a new master knows that as
  // soon as anything of it is registered, as a topic that it happens to subscribe to just then.
  const XmlRpcAnswer answer = askMaster("lookupService", {XmlRpcValue(alwaysServed().front())});
  // A node that shuts down takes itself off the master's list.
  if (!ros::ok() || ros::isShuttingDown()) return;
  sayWhetherItAnswers(answer.answered);
  if (!answer.answered) return;
  if (!answer.success) forgotten_ = true;
  if (forgotten_) {
    forgotten_ = !registerAll();
  } else if (looks_++ % kServicesEvery == 0) {
    rememberServices();
  }
}

void MasterWatch::sayWhetherItAnswers(bool answers) {
  if (answers == answers_) return;
  answers_ = answers;
  if (answers) {
    ROS_INFO_STREAM("the ROS master at " << ros::master::getURI() << " answers again");
  } else {
    ROS_WARN_STREAM("the ROS master at " << ros::master::getURI()
                                         << " does not answer: the connections that are there go on, "
                                         << "no new ones can be made; asked again each second");
  }
}

bool MasterWatch::registerAll() {
  int publishers = 0;
  int subscribers = 0;
  const bool all =
      restoreParameters() && registerPublishers(publishers) && registerSubscribers(subscribers) && registerServices();
  if (!all) return false;
  ++lost_;
  ROS_WARN_STREAM(
      "the ROS master at " << ros::master::getURI() << " had forgotten this node, as one does that was restarted: "
                           << "told it of " << publishers << " topics published, " << subscribers << " subscribed to, "
                           << services_.size() << " services and the parameters of " << private_space_);
  return true;
}

bool MasterWatch::registerPublishers(int& count) const {
  for (const auto& [topic, type] : ownTopics("getPublications")) {
    if (!askMaster("registerPublisher", {topic, type, XmlRpcValue(ownUri())}).success) return false;
    ++count;
  }
  return true;
}

bool MasterWatch::registerSubscribers(int& count) const {
  for (const auto& [topic, type] : ownTopics("getSubscriptions")) {
    const XmlRpcAnswer answer = askMaster("registerSubscriber", {topic, type, XmlRpcValue(ownUri())});
    XmlRpcValue name = topic;
    if (!answer.success || !tellPublishers(static_cast<std::string&>(name), answer.value)) return false;
    ++count;
  }
  return true;
}

// Says to this process, as the master does, who publishes a topic. It would hang up on those that are not on the list:
// those that it still hears are, whether the new master knows them or not.
bool MasterWatch::tellPublishers(const std::string& topic, const XmlRpcValue& publishers) const {
  XmlRpcValue all = publishers;
  if (!isArray(all) || all.size() == 0) return true;
  XmlRpcAnswer connections = callXmlRpc(ownUri(), "getBusInfo", {});
  if (!connections.success || !isArray(connections.value)) return false;
  for (int i = 0; i < connections.value.size(); ++i) {
    XmlRpcValue& connection = connections.value[i];  // id, peer, direction, transport, topic, …
    const bool heard =
        static_cast<std::string&>(connection[2]) == "i" && static_cast<std::string&>(connection[4]) == topic;
    if (heard) all[all.size()] = connection[1];
  }
  return callXmlRpc(ownUri(), "publisherUpdate", {XmlRpcValue(topic), all}).success;
}

bool MasterWatch::registerServices() const {
  const std::string uri =
      "rosrpc://" + ros::network::getHost() + ":" + std::to_string(ros::ConnectionManager::instance()->getTCPPort());
  const auto& manager = ros::ServiceManager::instance();
  return std::all_of(services_.begin(), services_.end(), [&](const std::string& service) {
    if (!manager->lookupServicePublication(service)) return true;  // gone meanwhile
    return askMaster("registerService", {XmlRpcValue(service), XmlRpcValue(uri), XmlRpcValue(ownUri())}).success;
  });
}

// Where somebody has set parameters below the name already, theirs are right.
bool MasterWatch::restoreParameters() const {
  if (!parameters_.valid()) return true;
  XmlRpcAnswer there = askMaster("hasParam", {XmlRpcValue(private_space_)});
  if (!there.success || there.value.getType() != XmlRpcValue::TypeBoolean) return false;
  if (static_cast<bool&>(there.value)) return true;
  return askMaster("setParam", {XmlRpcValue(private_space_), parameters_}).success;
}

void MasterWatch::rememberServices() {
  XmlRpcAnswer answer = askMaster("getSystemState", {});
  if (!answer.success || !isArray(answer.value) || answer.value.size() != 3) return;
  services_ = alwaysServed();
  XmlRpcValue& services = answer.value[2];  // pairs of name and the nodes that serve it
  for (int i = 0; isArray(services) && i < services.size(); ++i) {
    std::string name = services[i][0];
    const bool ours = ros::ServiceManager::instance()->lookupServicePublication(name) != nullptr;
    if (ours && std::find(services_.begin(), services_.end(), name) == services_.end()) services_.push_back(name);
  }
}

}  // namespace curtain_ros
