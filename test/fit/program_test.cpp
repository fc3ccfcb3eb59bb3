// SPDX-License-Identifier: BSD-3-Clause
//
// curtain_fit as it is called.
#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include "batch/batch_testing.h"
#include "curtain_sim/scene_yaml.h"

namespace {

using curtain_test::Outcome;
using Arguments = std::vector<std::string>;

class FitTest : public curtain_test::BatchTest {
 protected:
  Outcome fit(const Arguments& arguments) const { return run(CURTAIN_FIT, arguments); }
};

const Arguments kCotton = {"--weight", "120g/m2", "--warp", "0.118gf.cm2/cm", "--weft", "0.118gf.cm2/cm"};

Arguments with(Arguments arguments, const Arguments& more) {
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

TEST_F(FitTest, EngineReadsWhatItPrints) {
  const Outcome outcome = fit(with(kCotton, {"--bias", "0.1gf.cm2/cm", "--hysteresis", "0.124gf.cm/cm", "--shear",
                                             "0.7gf/cm.deg", "--thickness", "0.4mm"}));
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  std::string text = outcome.out;
  text.insert(text.find('\n') + 1, "  rows: 5\n  columns: 5\n");
  const curtain::SceneReading reading = curtain::readSceneText(text);
  EXPECT_TRUE(reading.problems.empty()) << describe(reading.problems) << text;
  const curtain::ClothParams& cloth = reading.scene.cloth;
  // Six digits are printed.
  EXPECT_NEAR(cloth.surface_density, 0.12, 1e-6);
  EXPECT_NEAR(cloth.bending_warp, 1.1571847e-5, 1e-10);
  EXPECT_NEAR(cloth.bending_weft, 1.1571847e-5, 1e-10);
  EXPECT_NEAR(cloth.bending_bias, 9.80665e-6, 1e-11);
  EXPECT_NEAR(cloth.bending_hysteresis, 1.2160246e-3, 1e-8);
  EXPECT_NEAR(cloth.shear, 39.331576, 1e-4);
  EXPECT_EQ(reading.scene.contact.thickness, 4e-4);
}

TEST_F(FitTest, ReadsItsOwnPresetAndAMaterial) {
  const Outcome first = fit({"--material", "linen", "--shear", "40N/m"});
  ASSERT_EQ(first.exit_code, 0) << first.err;
  const Outcome second = fit({scene(first.out)});
  ASSERT_EQ(second.exit_code, 0) << second.err;
  EXPECT_NE(second.out.find("bending_warp: 6.121e-05  # N m: of "), std::string::npos) << second.out;
  EXPECT_NE(second.out.find("shear: 40  # "), std::string::npos) << second.out;
}

TEST_F(FitTest, PrintsTheDrapeTest) {
  const Outcome outcome = fit(with(kCotton, {"--shear", "40N/m", "--drape", "--nodes", "16", "--starts", "2"}));
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const YAML::Node reading = YAML::Load(outcome.out);
  EXPECT_EQ(reading["nodes"].as<int>(), 16);
  EXPECT_EQ(reading["starts"].size(), 2u);
  // Printed with one digit.
  EXPECT_NEAR(
      reading["coefficient"].as<double>(),
      0.5 * (reading["starts"][0]["coefficient"].as<double>() + reading["starts"][1]["coefficient"].as<double>()),
      0.1001);
}

// The shear that cloth was made with is found again, from what it drapes to.
TEST_F(FitTest, FindsTheShearThatDrapesNearest) {
  const Arguments grid = {"--nodes", "16", "--starts", "3"};
  const Outcome made = fit(with(with(kCotton, grid), {"--shear", "110N/m", "--drape"}));
  const std::string coefficient = YAML::Load(made.out)["coefficient"].as<std::string>() + "%";
  const Outcome found = fit(with(with(kCotton, grid), {"--dc", coefficient}));
  ASSERT_EQ(found.exit_code, 0) << found.err;
  EXPECT_EQ(YAML::Load(found.out)["cloth"]["shear"].as<double>(), 110.0) << found.out;
  EXPECT_NE(found.out.find("# drape coefficient: measured " + coefficient + ", computed "), std::string::npos);
  EXPECT_NE(found.err.find("drape coefficient"), std::string::npos);
}

TEST_F(FitTest, SaysWhatIsWrong) {
  struct Bad {
    Arguments arguments;
    const char* says;
  };
  const Bad bads[] = {
      {{}, "--weight is needed"},
      {{"--weight", "120g/m2", "--warp", "1cm"}, "--weft is needed"},
      {{"--weight"}, "--weight: needs a value"},
      {{"--weight", "120"}, "--weight: must be a number > 0 and a unit: g/m2, kg/m2; is '120'"},
      {with(kCotton, {"--shear", "-1N/m"}), "--shear: must be a number > 0"},
      {with(kCotton, {"--dc", "101%"}), "--dc: must be at most 100%"},
      {with(kCotton, {"--dc", "50%", "--drape"}), "leave out --drape"},
      {with(kCotton, {"--bias-sample", "wide"}), "--bias-sample: of what?"},
      {with(kCotton, {"--bias", "1uN.m", "--bias-sample", "round"}), "--bias-sample: must be wide or narrow"},
      {with(kCotton, {"--overhang"}), "--overhang: of what?"},
      {with(kCotton, {"--nodes", "4"}), "--nodes: must be a whole number in [8, 512], is '4'"},
      {with(kCotton, {"--starts", "1.5"}), "--starts: must be a whole number"},
      {{"--material", "lining"}, "--material: must be one of none, cotton_voile"},
      {{"--material", "linen", "scene.yaml"}, "leave one out"},
      {{"nowhere.yaml"}, "nowhere.yaml"},
      {{"a.yaml", "b.yaml"}, "b.yaml: one scene at a time"},
      {{"--shiny"}, "--shiny: unknown option"},
  };
  for (const Bad& bad : bads) {
    const Outcome outcome = fit(bad.arguments);
    EXPECT_EQ(outcome.exit_code, 2) << bad.says;
    EXPECT_EQ(outcome.out, "") << bad.says;
    EXPECT_EQ(outcome.err.rfind("curtain_fit: ", 0), 0u) << outcome.err;
    EXPECT_NE(outcome.err.find(bad.says), std::string::npos) << outcome.err;
  }
  EXPECT_EQ(files(), Arguments());
}

TEST_F(FitTest, HelpAndVersion) {
  EXPECT_EQ(fit({"--help"}).out.rfind("usage: curtain_fit", 0), 0u);
  EXPECT_EQ(fit({"--version"}).out.rfind("curtain_fit ", 0), 0u);
}

}  // namespace
