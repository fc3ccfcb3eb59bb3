// SPDX-License-Identifier: BSD-3-Clause
//
// A bag as glTF: frames are its states, obstacles those of its markers; what is no animation is refused. No ROS master
// needed.
#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <std_msgs/Header.h>
#include <unistd.h>

#include <filesystem>
#include <functional>

#include "export/gltf_animation.h"
#include "export/gltf_check.h"
#include "export/play_bag.h"
#include "export/scenes.h"
#include "ros/outputs/markers.h"
#include "rviz/state_of.h"

namespace {

using curtain_sim::CurtainState;
using curtain_test::exportedScene;

constexpr char kStates[] = "/curtain/curtain_node/state";

class BagTest : public testing::Test {
 protected:
  void SetUp() override {
    path_ = (std::filesystem::temp_directory_path() / ("curtain_bag_" + std::to_string(getpid()) + ".bag")).string();
    bag_.open(path_, rosbag::bagmode::Write);
  }
  void TearDown() override { std::filesystem::remove(path_); }

  // Bags are in the order in which messages came.
  void write(const CurtainState& state, const std::string& topic = kStates) {
    received_ += ros::Duration(0.01);
    bag_.write(topic, received_, state);
  }

  /// So many frames of a run, as the node would send them.
  void record(curtain::Simulator& simulator, int frames, double begin = 100.0) {
    curtain_ros::GeometryCache geometry(simulator);
    curtain_ros::DetailMarkers markers("world", geometry, false);
    for (int frame = 0; frame < frames; ++frame) {
      CurtainState state = curtain_test::stateOf(simulator, true);
      state.header.stamp = ros::Time(begin + simulator.time());
      write(state);
      states_.push_back(state);
      if (frame % 6 == 0) {
        markers.update();
        bag_.write("/curtain/curtain_node/markers", received_, *markers.build(state.header.stamp));
      }
      simulator.step();
    }
  }

  std::string exported(const curtain::Excerpt& excerpt = {}, const std::string& topic = "") {
    bag_.close();
    curtain::GltfAnimation animation(curtain::Vec3::Ones());
    curtain::playBag(path_, topic, excerpt, animation);
    return animation.file();
  }

  /// What it says, refused.
  std::string refusal(const std::string& topic = "") {
    try {
      exported({}, topic);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "it is exported";
  }

  std::string path_;
  rosbag::Bag bag_;
  ros::Time received_{50.0};
  std::vector<CurtainState> states_;
};

TEST_F(BagTest, FramesAreTheStatesOfTheBag) {
  curtain::Simulator simulator(exportedScene(true));
  record(simulator, 31);
  const tinygltf::Model model = curtain_test::readGltf(exported());
  EXPECT_EQ(curtain_test::GltfCheck(model).wrong(), std::vector<std::string>());
  ASSERT_EQ(curtain_test::timesOf(model).size(), 16u);
  const std::size_t vertices_a_row = 22, folds = 3;
  for (std::size_t frame = 0; frame < 16; ++frame) {
    const std::vector<double> positions = curtain_test::clothAt(model, frame, "POSITION");
    const std::vector<double> first = curtain_test::clothAt(model, 0, "POSITION");
    const CurtainState& state = states_[2 * frame];
    for (std::size_t row = 0; row < 8; ++row) {
      for (std::size_t column = 0; column < 7; ++column) {
        for (std::size_t part = 0; part < 3; ++part) {
          const std::size_t at = 3 * (row * vertices_a_row + folds * column) + part;
          const double wanted = static_cast<double>(state.positions[3 * (row * 7 + column) + part]);
          EXPECT_NEAR(positions[at], wanted, std::ldexp(std::abs(wanted - first[at]), -24) + 1e-45) << frame;
        }
      }
    }
  }
}

TEST_F(BagTest, ObstaclesAreThoseOfTheMarkers) {
  curtain::Simulator simulator(exportedScene(false));
  record(simulator, 31);
  const tinygltf::Model model = curtain_test::readGltf(exported({0.25, 0.45, 60.0}));
  EXPECT_EQ(curtain_test::GltfCheck(model).wrong(), std::vector<std::string>());
  ASSERT_EQ(model.nodes.size(), 4u) << "the world, the cloth, the ball, and the box";
  EXPECT_EQ(model.nodes[2].scale.at(0), 1.0);
  EXPECT_EQ(model.nodes[3].scale.at(0), 0.0) << "which is not visible";
  // Poses come at 0.2 s, which counts as the start, at 0.3 and 0.4 s.
  for (const tinygltf::AnimationChannel& channel : model.animations.at(0).channels) {
    if (channel.target_node != 2 || channel.target_path != "translation") continue;
    const tinygltf::AnimationSampler& sampler =
        model.animations[0].samplers.at(static_cast<std::size_t>(channel.sampler));
    const std::vector<double> times = curtain_test::numbersOf(model, sampler.input);
    const std::vector<double> values = curtain_test::numbersOf(model, sampler.output);
    ASSERT_EQ(times.size(), 3u);
    EXPECT_EQ(times[0], 0.0);
    EXPECT_NEAR(values[0], 0.5 * 0.2, 1e-6);
    EXPECT_NEAR(times[2], 0.15, 1e-6);
    EXPECT_NEAR(values[6], 0.5 * 0.4, 1e-6);
    return;
  }
  FAIL() << "the ball does not move";
}

TEST_F(BagTest, MarkersNeitherBeginNorEndTheAnimation) {
  curtain::Simulator simulator(exportedScene(false));
  curtain_ros::GeometryCache geometry(simulator);
  curtain_ros::DetailMarkers markers("world", geometry, false);
  const auto mark = [&](double time) {
    markers.update();
    bag_.write("/curtain/curtain_node/markers", received_, *markers.build(ros::Time(time)));
  };
  mark(95.0);
  record(simulator, 3);
  mark(200.0);
  for (const double time : {100.5, 100.7}) {
    CurtainState state = states_[0];
    state.header.stamp = ros::Time(time);
    write(state);
  }
  const tinygltf::Model model = curtain_test::readGltf(exported({0.0, 0.6, 60.0}));
  EXPECT_EQ(curtain_test::GltfCheck(model).wrong(), std::vector<std::string>());
  const std::vector<double> times = curtain_test::timesOf(model);
  ASSERT_EQ(times.size(), 4u) << "from the first state to the last before the end";
  EXPECT_EQ(times[3], 0.5);
}

TEST_F(BagTest, OneCurtainOfSeveralIsChosen) {
  curtain::Simulator simulator(exportedScene(false));
  record(simulator, 3);
  write(states_[0], "/other/state");
  const std::string both = refusal();
  for (const char* word : {"--topic", kStates, "/other/state"}) EXPECT_NE(both.find(word), std::string::npos) << both;
  EXPECT_NE(refusal("/none").find("/none"), std::string::npos);
  EXPECT_EQ(curtain_test::timesOf(curtain_test::readGltf(exported({}, "/other/state"))).size(), 1u);
}

TEST_F(BagTest, WithoutStatesItIsRefused) {
  bag_.write(kStates, ros::Time(1.0), std_msgs::Header());
  EXPECT_NE(refusal().find("no curtain_sim/CurtainState"), std::string::npos) << refusal();
}

TEST_F(BagTest, NothingInThePartAskedForIsRefused) {
  curtain::Simulator simulator(exportedScene(false));
  record(simulator, 3);
  EXPECT_THROW(exported({5.0, 6.0, 30.0}), std::invalid_argument);
}

TEST_F(BagTest, WhatIsNoAnimationIsRefused) {
  curtain::Simulator simulator(exportedScene(false));
  record(simulator, 3);
  const std::pair<std::function<void(CurtainState&)>, const char*> cases[] = {
      {[](CurtainState& state) { state.header.stamp = ros::Time(99.0); }, "jumps back"},
      {[](CurtainState& state) { state.header.stamp = ros::Time(4e9); }, "jumped ahead"},
      {[](CurtainState& state) { state.weft_rest[3] *= 2.0F; }, "another cloth"},
      {[](CurtainState& state) { state.positions[7] = std::nanf(""); }, "positions: a number is not finite"},
      {[](CurtainState& state) { state.rows = 4000000000U; }, "rows"}};
  bag_.close();
  for (const auto& [spoil, words] : cases) {
    bag_.open(path_, rosbag::bagmode::Write);
    CurtainState state = states_[0];
    write(state);
    state.header.stamp += ros::Duration(1.0);
    spoil(state);
    write(state);
    const std::string said = refusal();
    EXPECT_NE(said.find(words), std::string::npos) << said;
    EXPECT_NE(said.find(path_), std::string::npos) << said;
  }
}

TEST_F(BagTest, BrokenFilesAreRefused) {
  curtain::Simulator simulator(exportedScene(false));
  record(simulator, 31);
  bag_.close();
  const auto size = std::filesystem::file_size(path_);
  std::filesystem::resize_file(path_, size - size / 8);  // as of a recording that was killed
  EXPECT_NE(refusal().find(path_), std::string::npos) << refusal();
  std::filesystem::resize_file(path_, 5000);
  EXPECT_NE(refusal().find(path_), std::string::npos) << refusal();
  std::filesystem::resize_file(path_, 0);
  EXPECT_NE(refusal().find(path_), std::string::npos) << refusal();
}

}  // namespace
