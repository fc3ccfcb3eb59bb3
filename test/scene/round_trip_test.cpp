// SPDX-License-Identifier: BSD-3-Clause
//
// writeScene -> readSceneText gives every field back with the same bits.
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <random>

#include "scene/scene_testing.h"

namespace curtain {
namespace {

// Compares by the structs of scene.h, not by the table of keys: a field missing there must show.
class Comparison {
 public:
  void number(const std::string& what, double a, double b) { note(what, sameBits(a, b)); }
  void vector(const std::string& what, const Vec3& a, const Vec3& b) {
    for (int i = 0; i < 3; ++i) number(what, a[i], b[i]);
  }
  void pose(const std::string& what, const Pose& a, const Pose& b) {
    vector(what, a.position, b.position);
    for (int i = 0; i < 4; ++i) number(what, a.orientation.coeffs()[i], b.orientation.coeffs()[i]);
  }
  void numbers(const std::string& what, const std::vector<double>& a, const std::vector<double>& b) {
    note(what, a.size() == b.size());
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) number(what, a[i], b[i]);
  }
  template <typename T>
  void same(const std::string& what, const T& a, const T& b) {
    note(what, a == b);
  }
  void optional(const std::string& what, const std::optional<double>& a, const std::optional<double>& b) {
    note(what, a.has_value() == b.has_value());
    if (a && b) number(what, *a, *b);
  }
  void optional(const std::string& what, const std::optional<Vec3>& a, const std::optional<Vec3>& b) {
    note(what, a.has_value() == b.has_value());
    if (a && b) vector(what, *a, *b);
  }
  void node(const std::string& what, const NodeIndex& a, const NodeIndex& b) {
    note(what, a.row == b.row && a.column == b.column);
  }

 private:
  static void note(const std::string& what, bool same) { EXPECT_TRUE(same) << what; }
};

void compareCloth(const ClothParams& a, const ClothParams& b) {
  Comparison c;
  c.same("rows", a.rows, b.rows);
  c.same("columns", a.columns, b.columns);
  c.number("height", a.height, b.height);
  c.number("width", a.width, b.width);
  c.optional("hem_width", a.hem_width, b.hem_width);
  c.number("surface_density", a.surface_density, b.surface_density);
  c.same("lumping", a.lumping, b.lumping);
  c.same("closed", a.closed, b.closed);
  c.same("folds", a.folds, b.folds);
  c.number("porosity", a.porosity, b.porosity);
  ASSERT_EQ(a.slits.size(), b.slits.size());
  for (std::size_t i = 0; i < a.slits.size(); ++i) {
    c.same("slits.column", a.slits[i].column, b.slits[i].column);
    c.same("slits.from_row", a.slits[i].from_row, b.slits[i].from_row);
  }
  ASSERT_EQ(a.patches.size(), b.patches.size());
  for (std::size_t i = 0; i < a.patches.size(); ++i) {
    const PatchParams &one = a.patches[i], &other = b.patches[i];
    EXPECT_EQ(one.rows, other.rows);
    EXPECT_EQ(one.columns, other.columns);
    c.same("patches.material", one.material, other.material);
    c.optional("patches.surface_density", one.surface_density, other.surface_density);
    c.optional("patches.porosity", one.porosity, other.porosity);
    c.optional("patches.bending_warp", one.bending_warp, other.bending_warp);
    c.optional("patches.bending_weft", one.bending_weft, other.bending_weft);
    c.optional("patches.bending_bias", one.bending_bias, other.bending_bias);
    c.optional("patches.bending_hysteresis", one.bending_hysteresis, other.bending_hysteresis);
    c.optional("patches.shear", one.shear, other.shear);
  }
  c.numbers("row_spacing", a.row_spacing, b.row_spacing);
  c.numbers("column_spacing", a.column_spacing, b.column_spacing);
  c.numbers("row_mass", a.row_mass, b.row_mass);
  c.numbers("column_mass", a.column_mass, b.column_mass);
}

void compareWind(const WindParams& a, const WindParams& b) {
  Comparison c;
  c.same("id", a.id, b.id);
  c.vector("position", a.position, b.position);
  c.vector("direction", a.direction, b.direction);
  c.number("radius", a.radius, b.radius);
  c.number("half_angle", a.half_angle, b.half_angle);
  c.number("pressure", a.pressure, b.pressure);
  c.number("node_force", a.node_force, b.node_force);
  c.number("porosity_weight", a.porosity_weight, b.porosity_weight);
  c.number("distance_weight", a.distance_weight, b.distance_weight);
  c.number("reference_length", a.reference_length, b.reference_length);
  c.number("unsteadiness", a.unsteadiness, b.unsteadiness);
  c.number("correlation_time", a.correlation_time, b.correlation_time);
  c.number("correlation_length", a.correlation_length, b.correlation_length);
  c.same("profile", a.profile, b.profile);
  c.same("shadow", a.shadow, b.shadow);
  c.number("start", a.start, b.start);
  c.number("end", a.end, b.end);
}

void compareDrag(const DragParams& a, const DragParams& b) {
  Comparison c;
  c.same("id", a.id, b.id);
  c.same("node", a.node.has_value(), b.node.has_value());
  if (a.node && b.node) c.node("node", *a.node, *b.node);
  c.optional("point", a.point, b.point);
  c.vector("force", a.force, b.force);
  c.optional("target", a.target, b.target);
  c.number("stiffness", a.stiffness, b.stiffness);
  c.number("max_force", a.max_force, b.max_force);
  c.number("radius", a.radius, b.radius);
  c.number("start", a.start, b.start);
  c.number("end", a.end, b.end);
}

void compareObstacle(const ObstacleParams& a, const ObstacleParams& b) {
  Comparison c;
  c.same("name", a.name, b.name);
  c.same("frame", a.frame, b.frame);
  c.same("shape", a.shape, b.shape);
  c.number("radius", a.radius, b.radius);
  c.number("length", a.length, b.length);
  c.vector("size", a.size, b.size);
  c.same("mesh", a.mesh, b.mesh);
  c.vector("scale", a.scale, b.scale);
  c.pose("pose", a.pose, b.pose);
  c.same("friction given", std::isnan(a.friction), std::isnan(b.friction));
  if (!std::isnan(a.friction)) c.number("friction", a.friction, b.friction);
  c.number("padding", a.padding, b.padding);
  c.vector("color", a.color, b.color);
  c.same("visible", a.visible, b.visible);
  c.vector("velocity", a.velocity, b.velocity);
  c.vector("acceleration", a.acceleration, b.acceleration);
  c.vector("spin", a.spin, b.spin);
  ASSERT_EQ(a.motion.size(), b.motion.size());
  for (std::size_t i = 0; i < a.motion.size(); ++i) {
    c.number("motion.time", a.motion[i].time, b.motion[i].time);
    c.pose("motion.pose", a.motion[i].pose, b.motion[i].pose);
  }
}

void compareSolver(const SolverParams& a, const SolverParams& b) {
  Comparison c;
  c.same("method", a.method, b.method);
  c.number("frame_rate", a.frame_rate, b.frame_rate);
  c.same("substeps", a.substeps, b.substeps);
  c.number("stretch_tolerance", a.stretch_tolerance, b.stretch_tolerance);
  c.same("position_tolerance", a.position_tolerance, b.position_tolerance);
  c.same("rest_speed", a.rest_speed, b.rest_speed);
  c.same("budget_ms", a.budget_ms, b.budget_ms);
  c.same("threads", a.threads, b.threads);
  c.same("max_substeps", a.max_substeps, b.max_substeps);
  c.same("max_sweeps", a.max_sweeps, b.max_sweeps);
  c.same("seed", a.seed, b.seed);
}

void compareRest(const Scene& a, const Scene& b) {
  Comparison c;
  c.vector("hang.from", a.hang.from, b.hang.from);
  c.vector("hang.to", a.hang.to, b.hang.to);
  c.optional("hang.radius", a.hang.radius, b.hang.radius);
  c.number("hang.tilt", a.hang.tilt, b.hang.tilt);
  c.same("hang.heading", a.hang.heading, b.hang.heading);
  c.same("hang.pleats", a.hang.pleats, b.hang.pleats);
  c.optional("hang.fullness", a.hang.fullness, b.hang.fullness);
  c.optional("hang.overlap", a.hang.overlap, b.hang.overlap);
  c.number("hem.line_density", a.hem.line_density, b.hem.line_density);
  c.numbers("hem.weights", a.hem.weights, b.hem.weights);
  c.same("pins.kind", a.pins.kind, b.pins.kind);
  ASSERT_EQ(a.pins.nodes.size(), b.pins.nodes.size());
  for (std::size_t i = 0; i < a.pins.nodes.size(); ++i) c.node("pins", a.pins.nodes[i], b.pins.nodes[i]);
  c.vector("gravity", a.gravity, b.gravity);
  c.number("air.density", a.air.density, b.air.density);
  c.same("air.law", a.air.law, b.air.law);
  c.number("air.threshold", a.air.threshold, b.air.threshold);
  c.number("air.inside", a.air.inside, b.air.inside);
  c.number("air.border", a.air.border, b.air.border);
  c.number("air.corner", a.air.corner, b.air.corner);
  c.number("air.fast_gain", a.air.fast_gain, b.air.fast_gain);
  c.number("air.normal_drag", a.air.normal_drag, b.air.normal_drag);
  c.number("air.tangential_drag", a.air.tangential_drag, b.air.tangential_drag);
  c.vector("ambient.velocity", a.ambient.velocity, b.ambient.velocity);
  c.number("ambient.intensity", a.ambient.intensity, b.ambient.intensity);
  c.number("ambient.length_scale", a.ambient.length_scale, b.ambient.length_scale);
  c.same("ambient.spectrum", a.ambient.spectrum, b.ambient.spectrum);
  c.same("ambient.seed", a.ambient.seed, b.ambient.seed);
  c.number("contact.thickness", a.contact.thickness, b.contact.thickness);
  c.number("contact.friction", a.contact.friction, b.contact.friction);
  c.same("contact.self", a.contact.self, b.contact.self);
  c.number("contact.recovery_speed", a.contact.recovery_speed, b.contact.recovery_speed);
  c.same("contact.zone_iterations", a.contact.zone_iterations, b.contact.zone_iterations);
}

void expectRoundTrip(const Scene& scene) {
  const std::string text = writeScene(scene);
  SCOPED_TRACE(text);
  const Scene back = expectScene(text);
  compareCloth(scene.cloth, back.cloth);
  compareRest(scene, back);
  compareSolver(scene.solver, back.solver);
  ASSERT_EQ(scene.wind.size(), back.wind.size());
  for (std::size_t i = 0; i < scene.wind.size(); ++i) compareWind(scene.wind[i], back.wind[i]);
  ASSERT_EQ(scene.drag.size(), back.drag.size());
  for (std::size_t i = 0; i < scene.drag.size(); ++i) compareDrag(scene.drag[i], back.drag[i]);
  ASSERT_EQ(scene.obstacles.size(), back.obstacles.size());
  for (std::size_t i = 0; i < scene.obstacles.size(); ++i) compareObstacle(scene.obstacles[i], back.obstacles[i]);
}

// Numbers with all their bits in use.
class Numbers {
 public:
  double between(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  Vec3 vector() { return Vec3(between(-3.0, 3.0), between(-1e-9, 1e-9), between(-1e8, 1e8)); }
  std::vector<double> list(int count) {
    std::vector<double> values;
    for (int i = 0; i < count; ++i) values.push_back(between(0.5, 2.0));
    return values;
  }
  Pose pose() {
    Pose pose;
    pose.position = vector();
    const Eigen::Vector4d q(between(-1, 1), between(-1, 1), between(-1, 1), between(-1, 1));
    pose.orientation = Eigen::Quaterniond(q).normalized();
    return pose;
  }

 private:
  std::mt19937_64 random_{7};
};

WindParams oddWind(Numbers& numbers, const std::string& id) {
  WindParams wind;
  wind.id = id;
  wind.position = numbers.vector();
  wind.direction = numbers.vector();
  wind.radius = numbers.between(0.1, 2.0);
  wind.half_angle = numbers.between(0.0, 1.5);
  wind.pressure = numbers.between(0.0, 9.0);
  wind.node_force = numbers.between(0.0, 1e-3);
  wind.porosity_weight = numbers.between(0.0, 1.0);
  wind.distance_weight = numbers.between(0.1, 1e9);
  wind.reference_length = numbers.between(0.1, 1e3);
  wind.unsteadiness = 4.9406564584124654e-324;  // the smallest double there is
  wind.correlation_time = numbers.between(0.1, 1.0);
  wind.correlation_length = numbers.between(0.1, 1.0);
  wind.profile = WindProfile::kRingJet;
  wind.shadow = true;
  wind.start = -0.0;
  wind.end = numbers.between(1.0, 2.0);
  return wind;
}

ObstacleParams oddObstacle(Numbers& numbers, ShapeKind shape, const std::string& name) {
  ObstacleParams obstacle;
  obstacle.name = name;
  obstacle.frame = "robot/hand: \"left\" #1";
  obstacle.shape = shape;
  const bool is_long = shape == ShapeKind::kCylinder || shape == ShapeKind::kCapsule;
  if (is_long || shape == ShapeKind::kSphere) obstacle.radius = numbers.between(0.1, 1.0);
  if (is_long) obstacle.length = numbers.between(0.1, 1.0);
  if (shape == ShapeKind::kBox) obstacle.size = Vec3(1.0 / 3.0, 2.0 / 3.0, 100.0);
  if (shape == ShapeKind::kMesh) {
    obstacle.mesh = "package://odd name/ä.stl";
    obstacle.scale = Vec3(1e-3, -1.0 / 3.0, 7.0);
  }
  obstacle.pose = numbers.pose();
  if (shape == ShapeKind::kBox) obstacle.friction = numbers.between(0.0, 10.0);
  obstacle.padding = numbers.between(0.0, 0.1);
  obstacle.color = Vec3(numbers.between(0.0, 1.0), 0.0, 1.0);
  obstacle.visible = shape != ShapeKind::kBox;
  if (shape == ShapeKind::kCapsule) {
    obstacle.velocity = numbers.pose().position;
    obstacle.acceleration = numbers.pose().position;
    obstacle.spin = numbers.pose().position;
    return obstacle;
  }
  for (int i = 0; i < 3; ++i) obstacle.motion.push_back({i + numbers.between(0.0, 0.5), numbers.pose()});
  return obstacle;
}

Scene oddScene() {
  Numbers numbers;
  Scene scene;
  scene.cloth.rows = 6;
  scene.cloth.columns = 5;
  scene.cloth.height = numbers.between(1.0, 3.0);
  scene.cloth.width = 2.0 + numbers.between(0.0, 1.0);
  scene.cloth.hem_width = 2.0 + numbers.between(0.0, 1.0);
  scene.cloth.surface_density = numbers.between(0.1, 0.3);
  scene.cloth.lumping = Lumping::kUniform;
  scene.cloth.folds = 9;
  scene.cloth.porosity = 1.0 / 3.0;
  PatchParams patch;
  patch.rows = {2, 4};
  applyMaterial(Material::kVelvet, patch);
  patch.surface_density = numbers.between(0.1, 0.3);
  patch.porosity = 1.0 / 3.0;
  patch.bending_bias = 0.0;
  scene.cloth.patches = {patch, {}};
  scene.cloth.patches[1].columns = {0, 3};
  scene.cloth.patches[1].bending_warp = 1e-4 / 3.0;
  scene.cloth.patches[1].bending_weft = 1e-5 / 3.0;
  scene.cloth.patches[1].bending_hysteresis = 1e-3 / 3.0;
  scene.cloth.patches[1].shear = 1e2 / 3.0;
  scene.cloth.slits = {{1, 5}};
  scene.cloth.row_spacing = numbers.list(5);
  scene.cloth.column_spacing = numbers.list(4);
  scene.cloth.row_mass = numbers.list(6);
  scene.cloth.column_mass = numbers.list(5);
  scene.hang.from = Vec3(0.1, 0.2, 0.3);
  scene.hang.to = Vec3(0.1 + 4.0 / 3.0, 0.7, 1e-17);
  scene.hang.tilt = 3.14159265358979323846 / 2.0;
  scene.hang.fullness = scene.cloth.width / (scene.hang.to - scene.hang.from).norm();
  scene.hem.line_density = 1.0 / 11.0;
  scene.hem.weights = numbers.list(5);
  scene.pins.kind = PinKind::kList;
  scene.pins.nodes = {{0, 0}, {5, 4}};
  scene.gravity = numbers.vector();
  scene.air = {1.0 / 7.0, AirLaw::kRelative, 2.0 / 7.0, 0.0, 0.0, 0.0, 6.0 / 7.0, 8.0 / 7.0, 9.0 / 7.0};
  scene.ambient = {numbers.vector(), 1.0 / 3.0, 10.0 / 3.0, GustSpectrum::kDryden, 12345678901234567890ULL};
  // Ids that YAML would take for something else, were they not quoted.
  const std::string controls("tab\t line\n nul\0 end", 18);
  for (const std::string& id : {std::string("5"), std::string("on"), std::string("~"), controls}) {
    scene.wind.push_back(oddWind(numbers, id));
  }
  scene.drag.resize(2);
  scene.drag[0].id = "1e-6";
  scene.drag[0].node = NodeIndex{5, 4};
  scene.drag[0].force = numbers.vector();
  scene.drag[0].stiffness = numbers.between(1.0, 1e3);
  scene.drag[0].max_force = numbers.between(1.0, 1e3);
  scene.drag[0].radius = numbers.between(0.0, 1.0);
  scene.drag[0].start = numbers.between(-1.0, 0.0);
  scene.drag[0].end = numbers.between(1.0, 2.0);
  scene.drag[1].id = "null";
  scene.drag[1].point = numbers.vector();
  scene.drag[1].target = numbers.vector();
  for (int shape = 0; shape <= static_cast<int>(ShapeKind::kMesh); ++shape) {
    scene.obstacles.push_back(oddObstacle(numbers, static_cast<ShapeKind>(shape), "thing " + std::to_string(shape)));
  }
  scene.contact = {numbers.between(1e-3, 1e-2), numbers.between(0.0, 1.0), false, 77};
  scene.solver = {Method::kImplicit,
                  1000.0 / 7.0,
                  3,
                  1e-11 / 3.0,
                  1e-4 / 3.0,
                  1e-2 / 3.0,
                  10.0 / 3.0,
                  5,
                  99,
                  1234,
                  std::uint64_t{0xFFFFFFFFFFFFFFFF}};
  return scene;
}

TEST(RoundTrip, KeepsDefaults) {
  Scene scene;
  scene.cloth.rows = 44;
  scene.cloth.columns = 40;
  expectRoundTrip(scene);
}

TEST(RoundTrip, KeepsEveryFieldDifferentFromItsDefault) { expectRoundTrip(oddScene()); }

TEST(RoundTrip, KeepsClosedCloth) {
  Scene scene;
  scene.cloth.rows = 5;
  scene.cloth.columns = 7;
  scene.cloth.closed = true;
  scene.cloth.column_spacing = std::vector<double>(7, 1.0 / 3.0);
  scene.hang.radius = 1.0 / 7.0;
  scene.hang.tilt = -1.0 / 300.0;
  scene.pins.kind = PinKind::kTopCorners;
  expectRoundTrip(scene);
}

// Written numbers are numbers to YAML 1.1 too: the strict reader takes them, however small or large.
TEST(RoundTrip, KeepsOverlappingStrips) {
  Scene scene;
  scene.cloth.rows = 4;
  scene.cloth.columns = 6;
  scene.cloth.slits = {{2, 0}};
  scene.hang.overlap = 1.0 / 30.0;
  scene.hang.to = scene.hang.from + Vec3(0.5, 0.0, 0.0);
  expectRoundTrip(scene);
}

TEST(RoundTrip, KeepsNumbersOfEverySize) {
  for (int exponent = -323; exponent <= 99; ++exponent) {
    Scene scene;
    scene.cloth.rows = 2;
    scene.cloth.columns = 2;
    const double size = std::strtod(("1.7e" + std::to_string(exponent)).c_str(), nullptr);
    scene.drag.resize(1);  // its force has the widest range there is
    scene.drag[0].id = "hand";
    scene.drag[0].node = NodeIndex{1, 1};
    scene.drag[0].force.x() = -size;
    const Scene back = expectScene(writeScene(scene));
    EXPECT_TRUE(sameBits(scene.drag[0].force.x(), back.drag.at(0).force.x())) << exponent;
  }
}

// What is not given (hem_width, radius, target, friction) has no spelling; everything else is written out.
TEST(RoundTrip, EveryKeyIsSpelledOut) {
  const Scene scene = oddScene();
  const YAML::Node root = YAML::Load(writeScene(scene));
  const auto has = [](const YAML::Node& node, const std::vector<std::string>& keys) {
    for (const std::string& key : keys) EXPECT_TRUE(node[key].IsDefined()) << key;
  };
  has(root, {"cloth", "hang", "hem", "pins", "gravity", "air", "wind", "drag", "obstacles", "contact", "solver"});
  has(root["cloth"], {"rows", "columns", "closed", "folds", "porosity", "lumping", "row_spacing", "hem_width"});
  has(root["wind"][0], {"id", "node_force", "correlation_length", "start", "end"});
  has(root["obstacles"][0], {"name", "frame", "shape", "radius", "position", "orientation", "motion"});
  EXPECT_FALSE(root["obstacles"][0]["friction"].IsDefined());
  EXPECT_FALSE(root["obstacles"][0]["size"].IsDefined());
  has(root["solver"], {"method", "frame_rate", "substeps", "stretch_tolerance", "position_tolerance", "rest_speed",
                       "budget_ms", "threads", "max_substeps", "max_sweeps", "seed"});
}

}  // namespace
}  // namespace curtain
