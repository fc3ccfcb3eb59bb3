// SPDX-License-Identifier: BSD-3-Clause
//
// A run as glTF: the file is valid, at each frame's time the cloth is the simulator's fine mesh as single precision has
// it, and bodies are where the scene has them.
#include <gtest/gtest.h>

#include <cmath>

#include "export/gltf_animation.h"
#include "export/gltf_check.h"
#include "export/play_scene.h"
#include "export/scenes.h"

namespace {

using curtain::Vec3;
using curtain_test::clothAt;
using curtain_test::exportedScene;
using curtain_test::numbersOf;
using curtain_test::timesOf;

tinygltf::Model exported(const curtain::Scene& scene, const curtain::Excerpt& excerpt) {
  curtain::GltfAnimation animation(Vec3(0.5, 0.25, 0.0));
  EXPECT_TRUE(curtain::playScene(scene, excerpt, animation));
  return curtain_test::readGltf(animation.file());
}

curtain::Excerpt excerpt(double start, double end, double rate) { return {start, end, rate}; }

// The differences are rounded once, and positions before them: half a unit in the last place each.
void expectCloth(const tinygltf::Model& model, std::size_t frame, const curtain::Simulator& simulator) {
  const std::vector<Vec3> wanted = curtain_test::drawnPositions(simulator);
  const std::vector<double> positions = clothAt(model, frame, "POSITION"), first = clothAt(model, 0, "POSITION");
  ASSERT_EQ(positions.size(), 3 * wanted.size());
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const double value = wanted[i / 3][static_cast<int>(i % 3)];
    const double tolerance = std::ldexp(std::abs(value) + std::abs(value - first[i]), -24) * (1.0 + 1e-6) + 1e-45;
    EXPECT_NEAR(positions[i], value, tolerance) << "frame " << frame << ", number " << i;
  }
}

class GltfOfAScene : public testing::TestWithParam<bool> {};

TEST_P(GltfOfAScene, IsValidAndShowsTheFineMeshAtEveryFrame) {
  const curtain::Scene scene = exportedScene(GetParam());
  const tinygltf::Model model = exported(scene, excerpt(0.0, 0.5, 30.0));
  EXPECT_EQ(curtain_test::GltfCheck(model).wrong(), std::vector<std::string>());
  curtain::Simulator simulator(scene);
  const std::vector<double> times = timesOf(model);
  ASSERT_EQ(times.size(), 16u) << "30 a second, and one at the end";
  for (std::size_t frame = 0; frame < times.size(); ++frame) {
    EXPECT_EQ(times[frame], static_cast<double>(static_cast<float>(simulator.time())));
    expectCloth(model, frame, simulator);
    simulator.step();
    simulator.step();
  }
  EXPECT_GT(std::abs(clothAt(model, 15, "POSITION").back() - clothAt(model, 0, "POSITION").back()), 1e-3) << "it moved";
}

TEST_P(GltfOfAScene, HasTrianglesCoordinatesAndNormalsOfTheCloth) {
  const curtain::Scene scene = exportedScene(GetParam());
  const tinygltf::Model model = exported(scene, excerpt(0.0, 0.2, 30.0));
  const tinygltf::Primitive& cloth = model.meshes.at(0).primitives.at(0);
  const curtain::Simulator simulator(scene);
  EXPECT_EQ(numbersOf(model, cloth.indices).size(), 3 * simulator.fineMeshTopology().triangles.size());
  const std::vector<double> coordinates = numbersOf(model, cloth.attributes.at("TEXCOORD_0"));
  const std::size_t columns = coordinates.size() / 2 / 8;
  EXPECT_NEAR(coordinates[2 * (columns - 1)], 1.0, 1e-6) << "metres along the weft, all around a ring";
  EXPECT_NEAR(coordinates.back(), 1.0, 1e-6) << "metres down the warp";
  // Between two frames normals of unit length are.
  const std::vector<double> normals = clothAt(model, 6, "NORMAL");
  for (std::size_t i = 0; i < normals.size(); i += 3)
    EXPECT_NEAR(Vec3(normals[i], normals[i + 1], normals[i + 2]).norm(), 1.0, 1e-6);
  const tinygltf::Material& material = model.materials.at(static_cast<std::size_t>(cloth.material));
  EXPECT_TRUE(material.doubleSided);
  EXPECT_NEAR(material.pbrMetallicRoughness.baseColorFactor.at(0), 0.21404, 1e-5) << "sRGB 0.5 is this bright";
}

INSTANTIATE_TEST_SUITE_P(OpenAndClosed, GltfOfAScene, testing::Bool());

TEST(Gltf, BodiesGoWhereTheSceneHasThem) {
  const curtain::Scene scene = exportedScene(false);
  const tinygltf::Model model = exported(scene, excerpt(0.0, 0.5, 30.0));
  ASSERT_EQ(model.nodes.size(), 3u) << "the world, the cloth, the ball; the box is not visible";
  const tinygltf::Node& ball = model.nodes.at(2);
  EXPECT_EQ(ball.name, "ball");
  const std::vector<double> corners = numbersOf(model, model.meshes.at(1).primitives.at(0).attributes.at("POSITION"));
  for (std::size_t i = 0; i < corners.size(); i += 3)
    EXPECT_NEAR(Vec3(corners[i], corners[i + 1], corners[i + 2]).norm(), 0.1, 1e-3) << "around its own origin";
  int moved = 0;
  for (const tinygltf::AnimationChannel& channel : model.animations.at(0).channels) {
    if (channel.target_node != 2) continue;
    const tinygltf::AnimationSampler& sampler =
        model.animations[0].samplers.at(static_cast<std::size_t>(channel.sampler));
    const std::vector<double> times = numbersOf(model, sampler.input), values = numbersOf(model, sampler.output);
    ASSERT_EQ(times.size(), 16u);
    for (std::size_t k = 0; k < times.size(); ++k) {
      if (channel.target_path == "translation") {
        EXPECT_NEAR(values[3 * k], 0.5 * times[k], 1e-7);
      } else if (channel.target_path == "rotation") {
        EXPECT_NEAR(values[4 * k + 2], std::sin(times[k]), 1e-7);
      }
    }
    ++moved;
  }
  EXPECT_EQ(moved, 2) << "translation and rotation; it is there all the time, so no scale";
}

TEST(Gltf, ABodyThatIsGoneHasNoSizeAndComesBack) {
  curtain::GltfAnimation animation(Vec3::Zero());
  animation.setCloth({{0, 1, 2}}, {{0.0F, 0.0F}, {1.0F, 0.0F}, {0.0F, 1.0F}});
  const std::array<float, 3> up{0.0F, 0.0F, 1.0F};
  const std::vector<curtain::AnimatedVertex> triangle{
      {{0.0F, 0.0F, 0.0F}, up}, {{1.0F, 0.0F, 0.0F}, up}, {{0.0F, 1.0F, 0.0F}, up}};
  animation.addFrame(0.0, triangle, 1);
  animation.addFrame(1.0, triangle, 1);
  curtain::ShapeTriangles shape;
  shape.corners = {Vec3::Zero(), Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitX()};
  shape.triangles = {{0, 1, 2}, {1, 3, 0}};  // the second has no area
  const std::size_t body = animation.addBody({"body", Vec3::Ones(), shape});
  animation.addPose(body, 0.0, {Vec3::UnitX(), curtain::Rotation::Identity()}, true);
  animation.addPose(body, 0.0, curtain::Pose(), true);  // the last of equal times counts
  animation.addPose(body, 0.5, curtain::Pose(), true);  // dropped, as the next one is
  animation.addPose(body, 0.6, curtain::Pose(), true);
  animation.addPose(body, 0.4, curtain::Pose(), false);
  animation.addPose(body, 0.8, curtain::Pose(), true);
  const tinygltf::Model model = curtain_test::readGltf(animation.file());
  EXPECT_EQ(curtain_test::GltfCheck(model).wrong(), std::vector<std::string>());
  const tinygltf::Animation& moving = model.animations.at(0);
  ASSERT_EQ(moving.channels.size(), 2u) << "weights, and the body's scale";
  const tinygltf::AnimationSampler& scale = moving.samplers.at(static_cast<std::size_t>(moving.channels[1].sampler));
  EXPECT_EQ(scale.interpolation, "STEP");
  EXPECT_EQ(numbersOf(model, scale.output), (std::vector<double>{1, 1, 1, 0, 0, 0, 1, 1, 1}));
}

TEST(Gltf, WhatFitsInNoFileIsRefusedBeforeItIsWritten) {
  curtain::GltfAnimation animation(Vec3::Zero());
  animation.setCloth({{0, 1, 2}}, {{0.0F, 0.0F}, {1.0F, 0.0F}, {0.0F, 1.0F}});
  const std::vector<curtain::AnimatedVertex> triangle(3, {{0.0F, 0.0F, 0.0F}, {0.0F, 0.0F, 1.0F}});
  // The weights of 31 623 frames have 4e9 bytes.
  try {
    for (int frame = 0; frame < 40000; ++frame) animation.addFrame(frame, triangle, 1);
    FAIL() << "nothing was refused";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("4 GB"), std::string::npos) << error.what();
  }
  EXPECT_LT(animation.count(), 31623);
  EXPECT_GT(animation.count(), 31000);
}

TEST(Gltf, AnExcerptBeginsAtZeroAndHasItsRate) {
  const curtain::Scene scene = exportedScene(false);
  const std::vector<double> times = timesOf(exported(scene, excerpt(0.2, 0.6, 25.0)));
  ASSERT_EQ(times.size(), 11u) << "0, 0.04 … 0.4";
  for (std::size_t k = 0; k < times.size(); ++k) {
    EXPECT_GE(times[k], 0.04 * static_cast<double>(k) - 1e-6);
    EXPECT_LT(times[k], 0.04 * static_cast<double>(k) + 1.0 / 60.0) << "the first frame that is not before its tick";
  }
  EXPECT_EQ(timesOf(exported(scene, excerpt(0.2, 0.21, 30.0))).size(), 1u) << "a picture";
}

}  // namespace
