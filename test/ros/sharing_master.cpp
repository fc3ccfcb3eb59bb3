// SPDX-License-Identifier: BSD-3-Clause
//
// What subscribers in the node's own process get, as nodelets of one manager are: all of them the one object that was
// published, which stays as it is for as long as they hold it and is filled again after that; and what they get of a
// curtain at rest. Run by rostest.
#include <gtest/gtest.h>
#include <ros/ros.h>
#include <visualization_msgs/InteractiveMarkerUpdate.h>

#include <functional>
#include <set>

#include "ros/inputs/handles.h"
#include "ros/outputs/outputs.h"

namespace curtain_ros {
namespace {

curtain::Scene windlessScene() {
  curtain::Scene scene;
  scene.cloth.rows = 8;
  scene.cloth.columns = 6;
  scene.hang.to.x() = 0.7;
  curtain::ObstacleParams ball;
  ball.name = "ball";
  ball.shape = curtain::ShapeKind::kSphere;
  ball.radius = 0.1;
  ball.pose.position = curtain::Vec3(0.3, 0.1, 1.5);
  scene.obstacles.push_back(ball);
  return scene;
}

void waitUntil(const std::function<bool()>& condition, const char* what) {
  const ros::WallTime deadline = ros::WallTime::now() + ros::WallDuration(20.0);
  while (!condition()) {
    ASSERT_LT(ros::WallTime::now().toSec(), deadline.toSec()) << "waited in vain until " << what;
    ros::spinOnce();
    ros::WallDuration(0.001).sleep();
  }
}

/// A subscriber in this process, with what came last.
template <typename Message>
struct Inbox {
  explicit Inbox(const std::string& topic)
      : subscriber(ros::NodeHandle("~").subscribe<Message>(
            topic, 10, boost::function<void(const boost::shared_ptr<const Message>&)>([this](const auto& message) {
              last = message;
              ++count;
            }))) {}

  void wait() {
    waitUntil([this] { return subscriber.getNumPublishers() > 0; }, "the topic is connected");
  }

  boost::shared_ptr<const Message> last;
  int count = 0;
  ros::Subscriber subscriber;
};

class Sharing : public ::testing::Test {
 protected:
  /// Frames of 1/60 s; moving: the curtain is stepped.
  void publish(int frames, bool moving) {
    for (int frame = 0; frame < frames; ++frame) {
      if (moving) simulator_.step();
      stamp_ += ros::Duration(1.0 / 60.0);
      outputs_.publish(stamp_, {}, true);
      ros::spinOnce();
    }
  }

  static NodeParams restful() {
    NodeParams params;
    params.state_rest_rate = 10.0;
    return params;
  }

  NodeParams params_ = restful();
  curtain::Simulator simulator_{windlessScene()};
  Frames frames_{ros::NodeHandle(), params_.world_frame};
  Outputs outputs_{ros::NodeHandle("~"), params_, simulator_, frames_};
  ros::Time stamp_{100.0};
};

// Both get the object itself, and it is the pool's: a mark that was set in it comes back with a later message.
template <typename Message>
void expectShared(const std::string& topic, const std::function<void()>& publishOne,
                  const std::function<std::string&(Message&)>& unused) {
  SCOPED_TRACE(topic);
  Inbox<Message> one(topic), other(topic);
  one.wait();
  waitUntil(
      [&] {
        publishOne();
        return one.last && other.last;
      },
      "both have a message");
  EXPECT_EQ(one.last.get(), other.last.get());
  std::string& place = unused(const_cast<Message&>(*one.last));
  const std::string before = place;
  place = "marked";
  one.last.reset();
  other.last.reset();
  waitUntil(
      [&] {
        publishOne();
        return one.last && other.last;
      },
      "the next one is there");
  EXPECT_EQ(one.last.get(), other.last.get());
  EXPECT_EQ(unused(const_cast<Message&>(*one.last)), "marked") << "the message was copied on its way";
  unused(const_cast<Message&>(*one.last)) = before;
}

TEST_F(Sharing, SubscribersGetTheObjectThatIsFilledAgain) {
  const auto publishFrames = [this] { publish(6, true); };  // one picture of either kind at least
  expectShared<curtain_sim::CurtainState>(
      "state", publishFrames,
      [](curtain_sim::CurtainState& message) -> std::string& { return message.header.frame_id; });
  expectShared<visualization_msgs::Marker>(
      "mesh", publishFrames, [](visualization_msgs::Marker& message) -> std::string& { return message.text; });
  expectShared<visualization_msgs::MarkerArray>(
      "markers", publishFrames,
      [](visualization_msgs::MarkerArray& message) -> std::string& { return message.markers[0].text; });
  expectShared<curtain_sim::Contacts>("contacts", publishFrames, [](curtain_sim::Contacts& message) -> std::string& {
    return message.header.frame_id;
  });
}

TEST_F(Sharing, AMessageInUseStaysAsItIs) {
  Inbox<curtain_sim::CurtainState> inbox("state");
  inbox.wait();
  waitUntil(
      [&] {
        publish(1, true);
        return inbox.last != nullptr;
      },
      "a state comes");
  std::vector<curtain_sim::CurtainState::ConstPtr> held;
  std::vector<curtain_sim::CurtainState> copies;
  for (int i = 0; i < 20; ++i) {  // more than a pool keeps
    const int count = inbox.count;
    waitUntil(
        [&] {
          publish(1, true);
          return inbox.count > count;
        },
        "the next one comes");
    held.push_back(inbox.last);
    copies.push_back(*inbox.last);
  }
  publish(10, true);
  std::set<const void*> objects;
  for (std::size_t i = 0; i < held.size(); ++i) {
    EXPECT_TRUE(*held[i] == copies[i]) << i;
    objects.insert(held[i].get());
  }
  EXPECT_EQ(objects.size(), held.size());
}

TEST_F(Sharing, AtRestAllComeAtTheirRestRates) {
  Inbox<visualization_msgs::Marker> mesh("mesh");
  Inbox<visualization_msgs::MarkerArray> markers("markers");
  Inbox<curtain_sim::CurtainState> state("state");
  mesh.wait();
  markers.wait();
  state.wait();
  waitUntil(
      [&] {
        publish(6, true);
        return mesh.last && markers.last && state.last;
      },
      "both are there");
  mesh.count = markers.count = state.count = 0;
  publish(60, true);
  waitUntil([&] { return mesh.count == 20 && markers.count == 10; }, "the pictures of a moving second are there");
  publish(600, false);
  waitUntil([&] { return mesh.count == 30 && markers.count == 20; }, "the pictures of ten seconds at rest are there");
  EXPECT_EQ(state.count, 60 + 100);
}

// At rest handles are where their nodes are, unless somebody had one in the hand.
TEST_F(Sharing, HandlesAreMovedWhenTheyOrTheirNodesMay) {
  ros::NodeHandle private_node("~");
  Inputs inputs(ros::NodeHandle(), frames_);
  Handles handles(private_node, params_, simulator_, inputs);
  int moves = 0;
  const auto take = [&](const visualization_msgs::InteractiveMarkerUpdate::ConstPtr& update) {
    moves += !update->poses.empty();
  };
  const ros::Subscriber updates = private_node.subscribe<visualization_msgs::InteractiveMarkerUpdate>(
      "handles/update", 100, boost::function<void(const visualization_msgs::InteractiveMarkerUpdate::ConstPtr&)>(take));
  const ros::Publisher feedback =
      private_node.advertise<visualization_msgs::InteractiveMarkerFeedback>("handles/feedback", 1);
  waitUntil([&] { return updates.getNumPublishers() > 0 && feedback.getNumSubscribers() > 0; }, "both are connected");
  const auto frames = [&](int count, bool moving) {
    for (int frame = 0; frame < count; ++frame) {
      if (moving) simulator_.step();
      handles.update(simulator_);
      ros::spinOnce();
    }
  };
  // Messages that were sent are waited for; those that must not be sent would come before the next ones.
  frames(60, true);
  waitUntil([&] { return moves == 11; }, "the first frame's and ten more are there");
  frames(60, false);

  visualization_msgs::InteractiveMarkerFeedback let_go;
  let_go.header.frame_id = "world";
  let_go.client_id = "sharing";
  let_go.marker_name = "handle_0";
  let_go.event_type = visualization_msgs::InteractiveMarkerFeedback::MOUSE_UP;
  feedback.publish(let_go);
  waitUntil(
      [&] {
        frames(6, false);
        return moves > 11;
      },
      "the handle goes back to its node");
  frames(60, false);
  frames(6, true);
  waitUntil([&] { return moves > 12; }, "the handles follow");
  EXPECT_EQ(moves, 13);
}

}  // namespace
}  // namespace curtain_ros

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "sharing");
  const ros::NodeHandle node;  // keeps ROS up between the tests
  return RUN_ALL_TESTS();
}
