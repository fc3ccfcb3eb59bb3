// SPDX-License-Identifier: BSD-3-Clause
//
// Floor 0: the scene as plain values with defaults and units (SI throughout). validate() checks a Scene, scene_yaml.h
// reads and writes it as YAML. The same keys are curtain_batch's file and the node's ~scene parameter tree.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

/// The engine, without ROS.
namespace curtain {

/// A point or a vector.
using Vec3 = Eigen::Vector3d;

/// A problem with an input: its dotted key, and what is wrong, with the allowed range.
struct Problem {
  std::string key;   ///< e.g. "cloth.rows" or "wind[0].radius"
  std::string text;  ///< e.g. "must be an integer in [2, 4096], is 1"
};

/// All problems, one per line, each as "source: key: text" (without source when that is empty).
std::string describe(const std::vector<Problem>& problems, const std::string& source = "");

/// A rotation as a quaternion. Not aligned: an aligned one, and with it a Scene, would be laid out otherwise in
/// programs compiled for AVX (-march=native) than in the library.
using Rotation = Eigen::Quaternion<double, Eigen::DontAlign>;

/// A rigid pose; orientation is a unit quaternion.
struct Pose {
  Vec3 position = Vec3::Zero();                 ///< [m]
  Rotation orientation = Rotation::Identity();  ///< unit
};

/// A node of the grid: row 0 is the hung edge, columns run along it.
struct NodeIndex {
  int row = 0;     ///< along the warp
  int column = 0;  ///< along the weft
};

/// How the cloth's mass is shared among the nodes.
enum class Lumping {
  kArea,    ///< every node has the mass of its share of the cloth's area
  kUniform  ///< every node has total mass / node count
};

/// A cut along the warp: no weft links, and no cloth, between two neighbouring columns.
struct SlitParams {
  int column = 0;    ///< between this column and the next, [0..columns - 2] (closed cloth: [0..columns - 1])
  int from_row = 0;  ///< the weft links of this row and of all below it are cut [0..rows - 1]
};

/// Fabrics with known properties (docs/materials.md).
enum class Material {
  kNone,
  kCottonVoile,
  kLinen,
  kSilk,
  kPolyester,
  kVelvet,
  kBlackout,
  kHospital,
  kShowerPeva,
  kPvcStrip,
  kCanvas,
  kParachuteNylon
};

/// A part of the cloth that is of another fabric: the nodes of a block, each with its share of the area. What is not
/// given is that of the cloth, or of patches before it in the list.
struct PatchParams {
  std::vector<int> rows;                     ///< its first and its last, [0..rows - 1]. Empty: all
  std::vector<int> columns;                  ///< the same, [0..columns - 1]
  Material material = Material::kNone;       ///< what applyMaterial() was called with; has no effect of its own
  std::optional<double> surface_density;     ///< as those of the cloth
  std::optional<double> porosity;            ///< the same
  std::optional<double> bending_warp;        ///< the same
  std::optional<double> bending_weft;        ///< the same
  std::optional<double> bending_bias;        ///< the same
  std::optional<double> bending_hysteresis;  ///< the same
  std::optional<double> shear;               ///< the same
};

/// The cloth: its grid, its size and its mass.
struct ClothParams {
  int rows = 0;                         ///< nodes along the warp, hung edge first [2..4096]; no default
  int columns = 0;                      ///< nodes along the weft [2..4096] (closed cloth: [3..4096]); no default
  double height = 2.0;                  ///< warp length [m], > 0
  double width = 1.0;                   ///< weft length of the top row [m], > 0
  std::optional<double> hem_width;      ///< weft length of the bottom row [m], > 0; default: width
  Material material = Material::kNone;  ///< what applyMaterial() was called with; has no effect of its own
  double surface_density = 0.2;         ///< [kg/m^2], > 0
  Lumping lumping = Lumping::kArea;     ///< how mass is shared among the nodes
  bool closed = false;                  ///< the weft closes to a ring (skirt, canopy)
  int folds = 6;                        ///< rods per weft link [1..64]; 1 = no second-layer nodes
  double porosity = 0.0;                ///< share of the air that passes through [0..1]
  double bending_warp = 0.0;  ///< bending rigidity along the warp [N m], [0..1000]: moment per width and curvature
  double bending_weft = 0.0;  ///< the same along the weft; 0: limp
  double bending_bias = 0.0;  ///< the same along the bias, of wide cloth, [0..1000]; up to the quarter of the others'
                              ///< sum that warp and weft give: no more than that
  double bending_hysteresis = 0.0;  ///< twice the friction's moment per width [N], [0..1e6]: KES 2HB; 0: none
  double shear = 0.0;  ///< shear rigidity [N/m], [0..1e6]: force per width and angle; 0: none. With it wefts
                       ///< that bend resist shortening until they buckle
  std::vector<PatchParams> patches;  ///< parts of other fabrics; where they overlap the last one holds
  std::vector<SlitParams> slits;     ///< cuts along the warp, each elsewhere; strips have at least two columns
  /// Relative lengths of the rows-1 warp rods, top first, each > 0; scaled to height. Empty: all equal.
  std::vector<double> row_spacing;
  /// Relative lengths of the weft links of a row (columns-1, closed: columns), each > 0; scaled to the
  /// row's width. Empty: all equal.
  std::vector<double> column_spacing;
  /// Factor on the mass that each row has by lumping (rows entries, > 0), e.g. a heavy hem; by area the first and the
  /// last row have half the mass of an inner one. Empty: 1.
  std::vector<double> row_mass;
  /// The same of each column (columns entries, > 0); by area a column at an edge or a slit has half the mass of an
  /// inner one. Empty: 1.
  std::vector<double> column_mass;
};

/// What the top edge of cloth is gathered by.
enum class Heading {
  kGathered,  ///< nothing: a straight edge; where it is shorter than the cloth, each weft link makes a fold
  kPencil,    ///< narrow pleats side by side
  kPinch,     ///< pleats of three fingers, flat between
  kRipple,    ///< an even wave
  kEyelets,   ///< an even wave about a pole that goes through it, two eyelets a wave
  kTabs       ///< bows to one side between tabs, one a pleat
};

/// The weight of the bottom row, over that of its cloth.
struct HemParams {
  double line_density = 0.0;  ///< of a lead band or a chain [kg/m], >= 0
  /// Single weights [kg], shape [columns], each >= 0. Empty: none.
  std::vector<double> weights;
};

/// Where the cloth is at the start, in place of hung by its edge. One of both, or neither.
struct StartParams {
  std::optional<std::string> over;  ///< laid over this obstacle: flat and level above it, along hang.from -> hang.to,
                                    ///< from where it has come to rest on all obstacles at their start
  std::optional<std::string> file;  ///< its nodes: CSV as curtain_batch --out writes it (of several times the last), or
                                    ///< ASCII PLY as its --mesh; a path or a URL
};

/// Where the cloth starts.
struct HangParams {
  Vec3 from = Vec3(0.0, 0.0, 2.2);  ///< [m]; closed cloth: the ring's centre
  Vec3 to = Vec3(1.0, 0.0, 2.2);    ///< [m], |to - from| <= width; not used by closed cloth
  /// Radius of the hung ring [m], closed cloth only; default: width / (2 pi). The chord between
  /// neighbours must not be longer than their weft link.
  std::optional<double> radius;
  /// [rad], [-6.3..6.3]. Rotation of the flat cloth about its hung edge out of the vertical; pi/2 = horizontal, towards
  /// the normal (to - from) x up. Closed cloth: half-angle of the cone that the cloth starts as.
  double tilt = 0.0;
  Heading heading = Heading::kGathered;  ///< not for closed or tapered cloth
  /// Of a heading other than kGathered [0..1024]; 0: as many as the links can show. Each needs four links at least,
  /// nine with kPinch, two with kTabs.
  int pleats = 0;
  /// Depth below the edge down to which the cloth keeps its pleats' curvature, as of a heading tape or pressed [m], >=
  /// 0; of a heading other than kGathered, with bending_weft > 0, and pleats that turn by 80 degrees a node at most.
  double pressed = 0.0;
  /// Width over |to - from|, [1..3]. Scene files may give it in place of cloth.width; if both, they must agree.
  std::optional<double> fullness;
  /// Strips that slits cut from row 0 down overlap by so much [m], [0..half of the narrowest strip); each is two
  /// contact thicknesses in front of or behind its neighbours. Flat cloth only. Not given: they hang side by side, the
  /// cut links between them.
  std::optional<double> overlap;
  StartParams start;  ///< somewhere else
};

/// Which nodes are pinned.
enum class PinKind {
  kTop,         ///< the whole row 0; of headings kEyelets and kTabs where it hangs by them
  kLeft,        ///< the whole column 0
  kTopCorners,  ///< both ends of row 0
  kNone,        ///< none
  kList         ///< the listed nodes
};

/// Nodes with a prescribed position.
struct PinParams {
  PinKind kind = PinKind::kTop;  ///< which nodes
  std::vector<NodeIndex> nodes;  ///< for kList
};

/// A piece of a rail, from the end of the one before it.
struct RailPiece {
  Vec3 to = Vec3::Zero();      ///< its end [m]; of the first piece: where the rail begins
  std::optional<Vec3> centre;  ///< of an arc, the shorter way round [m]; none: straight
};

/// What the cloth hangs from a rail by. The first and the last column have a carrier.
struct CarrierParams {
  int every = 4;             ///< a carrier at every so many columns [1..4095], and at the last; not read with `columns`
  std::vector<int> columns;  ///< the carriers' columns, increasing, from 0 to the last; empty: see `every`
  double mass = 0.01;        ///< of each [kg], >= 0; added to that of its node
  double friction = 0.15;    ///< Coulomb coefficient on the rail [0..10]
  double gap = 0.015;        ///< least distance of neighbours along the rail [m], > 0
};

/// What draws the master carriers.
struct DriveParams {
  double speed = 0.2;   ///< [m/s], > 0
  double force = 10.0;  ///< at most, on each master [N], >= 0
};

/// A rail on which the top edge's carriers slide. The cloth hangs down from it; between carriers its edge is free.
struct RailParams {
  std::vector<RailPiece> path;  ///< in the order of the columns; empty: there is no rail
  CarrierParams carriers;       ///< on it
  double opening = 0.0;         ///< where the carriers start: 0 drawn shut, 1 gathered as far as the gaps allow [0..1]
  DriveParams drive;            ///< of Simulator::setOpening()
  /// Columns of the carriers that the drive moves: one, and the cloth gathers at the rail's beginning, or two
  /// neighbouring ones, and it gathers at both ends. Empty: the last.
  std::vector<int> masters;
};

/// Lines from nodes to a common end, a fixed point or a free load. They only pull, weigh and touch nothing.
struct LineParams {
  std::string id;                ///< unique among the lines, not empty
  std::vector<NodeIndex> nodes;  ///< each has a line of its own; different ones, at least one
  std::optional<double> length;  ///< of each line [m], >= its distance at the start; default: that distance
  std::optional<Vec3> to;        ///< end, or start of a load [m]; default of a load: as low as the lines reach
  std::optional<double> mass;    ///< of a load [kg], > 0; none: the end is fixed, and Simulator::setLineEnd() moves it
};

/// A loop around nodes of a row. Closed, it keeps them within its reach of a point, which shrinks to `radius`.
struct TieBackParams {
  std::string id;             ///< unique among the tie-backs, not empty
  int row = 0;                ///< [0..rows - 1]
  int first_column = 0;       ///< [0..columns - 1]
  int last_column = 0;        ///< [first_column..columns - 1]
  Vec3 point = Vec3::Zero();  ///< where the loop is held [m]
  double radius = 0.1;        ///< of the closed loop [m], >= 1e-3
  double speed = 0.3;         ///< at which it closes [m/s], > 0
  bool closed = true;         ///< at the start it begins to close
};

/// The law of the air's force.
enum class AirLaw {
  kContinuous,  ///< Cheng 2000, Eqs. (2) to (4); Eq. (4) with its quadratic branch divided by the threshold: no jump
  kPrinted,     ///< Cheng 2000, Eqs. (2) to (4) to the letter
  kRelative     ///< of the air's velocity relative to the cloth; winds are speeds of air instead of forces
};

/// Air. Cheng 2000, Eq. (4): force against the velocity, per area of cloth; c_r is one of inside / border / corner by
/// the node's place, times (1 + fast_gain * |v|). Law kRelative: normal_drag and tangential_drag instead.
struct AirParams {
  double density = 1.2;              ///< rho [kg/m^3], >= 0
  AirLaw law = AirLaw::kContinuous;  ///< which law
  double threshold = 1.0;            ///< speed at which the law turns from linear to quadratic [m/s], > 0
  double inside = 0.0;               ///< c_r of nodes with four neighbours [m/s], >= 0
  double border = 0.0;               ///< c_r of border nodes [m/s], >= 0
  double corner = 0.0;               ///< c_r of corner nodes [m/s], >= 0
  double fast_gain = 0.0;            ///< growth of c_r with speed [s/m], >= 0
  double normal_drag = 1.2;          ///< kRelative: c_n, of the velocity along the normal, [0..100]
  double tangential_drag = 0.02;     ///< kRelative: c_t, of the velocity along the cloth, both sides together, [0..100]
};

/// One-dimensional spectra of gusts.
enum class GustSpectrum {
  kVonKarman,  ///< MIL-F-8785C, Sect. 3.7.1, von Karman form
  kDryden      ///< MIL-F-8785C, Sect. 3.7.1, Dryden form
};

/// The wind that blows everywhere; for AirLaw::kRelative. Its gusts are carried along unchanged (Taylor 1938).
struct AmbientParams {
  Vec3 velocity = Vec3::Zero();  ///< mean [m/s]
  double intensity = 0.0;        ///< standard deviation of each component of the gusts over the mean speed, [0..1]
  double length_scale = 5.0;     ///< L of the spectra, in all directions [m], [1e-3..1e6]
  GustSpectrum spectrum = GustSpectrum::kVonKarman;  ///< of the gusts
  std::uint64_t seed = 1;                            ///< of the gusts
};

/// How the pressure of a wind source varies over its disc.
enum class WindProfile {
  kUniform,  ///< not at all
  kRingJet   ///< strongest in a ring at 0.76 radii, none on the axis and at the edge: a rotor's downwash
};

/// A cone wind source, Cheng 2000, Eq. (2)(3).
struct WindParams {
  std::string id;                               ///< unique among the winds, not empty
  Vec3 position = Vec3::Zero();                 ///< centre of the disc [m]
  Vec3 direction = Vec3::UnitX();               ///< axis, any length > 0
  double radius = 1.0;                          ///< of the disc [m], > 0
  double half_angle = 0.0;                      ///< of the cone [rad], [0, 1.5]; 0 = parallel wind
  WindProfile profile = WindProfile::kUniform;  ///< of the pressure over the disc
  double pressure = 0.0;                        ///< on the disc, kRingJet: where it is highest [Pa], >= 0
  double node_force = 0.0;           ///< the paper's own form: a force per node [N], >= 0, added to the pressure's
  double porosity_weight = 1.0;      ///< c_mu of Eq. (3), [0..1]
  double distance_weight = 1.0;      ///< c_d of Eq. (3), > 0
  double reference_length = 1.0;     ///< what Eq. (3) measures |d| in [m], [1e-6..1e6]
  double unsteadiness = 0.0;         ///< standard deviation of each component of the gusts [Pa], >= 0
  double correlation_time = 0.2;     ///< of the gusts [s], [1e-6..1e6]
  double correlation_length = 0.25;  ///< of the gusts along the cloth [m], > 0
  bool shadow = false;               ///< obstacles and other cloths shade the nodes behind them
  double start = 0.0;                ///< [s]
  double end = std::numeric_limits<double>::infinity();  ///< [s], > start
};

/// A pose at a time: of a smooth curve, held at both ends, see docs/method.md, "Obstacles that move".
struct PoseKey {
  double time = 0.0;  ///< [s], strictly increasing along a motion
  Pose pose;          ///< in the world
};

/// Which nodes a hand takes.
enum class GraspRegion {
  kSphere,  ///< those in a ball
  kBox,     ///< those in a box
  kNodes    ///< listed ones
};

/// A hand that takes hold of the cloth. What it holds moves with the gripper's frame.
///
/// Where nothing but releaseGrasp() ends it and it does not give, the held nodes are pinned. Otherwise each hangs on a
/// spring from its place in the frame (stiff: 0.05 mm at break_force), and is a free node of the cloth for all else.
struct GraspParams {
  std::string id;                             ///< unique among the grasps, not empty
  Pose frame;                                 ///< of the gripper in the world, when it takes hold
  GraspRegion region = GraspRegion::kSphere;  ///< decides which of the members below are read
  Pose place;                                 ///< of ball and box, centre and axes in the gripper's frame
  double radius = 0.0;                        ///< of the ball [m], > 0
  Vec3 size = Vec3::Zero();                   ///< of the box, edge lengths [m], > 0
  std::vector<NodeIndex> nodes;               ///< listed ones, each once
  double stiffness = std::numeric_limits<double>::infinity();    ///< of the hand [N/m], > 0; infinite: it does not give
  double break_force = std::numeric_limits<double>::infinity();  ///< pull that tears the cloth out of it [N], > 0
  /// Either of two pads presses with this [N], > 0: they hold by 2 friction pinch_force at most, and beyond that the
  /// cloth slides out between them. With a ball or a box, which is where the pads are. Infinite: it never slides.
  double pinch_force = std::numeric_limits<double>::infinity();
  double friction = 0.5;  ///< of the pads, Coulomb coefficient; > 0 with a pinch_force
};

/// A hand that takes hold, moves and lets go by itself.
struct HandParams {
  GraspParams grasp;                                     ///< grasp.frame: pose of the gripper where it has no motion
  std::vector<PoseKey> motion;                           ///< of the gripper
  double start = 0.0;                                    ///< [s]; it takes hold as the first frame from then on begins
  double end = std::numeric_limits<double>::infinity();  ///< [s], > start; it lets go, in the same way
};

/// A point at a time.
struct PointKey {
  double time = 0.0;             ///< [s], strictly increasing along a path
  Vec3 position = Vec3::Zero();  ///< [m]
};

/// A user force on a node and its neighbourhood.
struct DragParams {
  std::string id;                 ///< unique among the drags, not empty
  std::optional<NodeIndex> node;  ///< the grasped node; exactly one of node and point is given
  std::optional<Vec3> point;      ///< [m] grasp the node nearest to this point when the drag starts
  Vec3 force = Vec3::Zero();      ///< [N], shared by the neighbourhood
  std::optional<Vec3> target;     ///< [m] pull the node to this point with a critically damped spring
  std::vector<PointKey> path;     ///< in place of target: the same to a point on a smooth curve through these
  double stiffness = 20.0;        ///< of that spring [N/m], > 0
  double max_force = 10.0;        ///< the spring never pulls harder [N], > 0
  double radius = 0.0;            ///< of the neighbourhood along the cloth [m], >= 0; 0 = the node alone
  double start = 0.0;             ///< [s]
  double end = std::numeric_limits<double>::infinity();  ///< [s], > start
};

/// Shapes of obstacles.
enum class ShapeKind {
  kSphere,    ///< around the origin
  kBox,       ///< around the origin, edges along the axes
  kCylinder,  ///< around the z axis
  kCapsule,   ///< around the z axis
  kPlane,     ///< z = 0; the +z side is free
  kMesh       ///< triangles of a mesh file
};

/// A rigid body that the cloth touches.
struct ObstacleParams {
  std::string name;                      ///< unique among the obstacles, not empty
  std::string frame = "world";           ///< tf2 frame it is fixed to; not used offline
  ShapeKind shape = ShapeKind::kSphere;  ///< decides which of the members below are read
  double radius = 0.0;                   ///< sphere, cylinder, capsule [m], > 0
  double length = 0.0;                   ///< cylinder: whole, capsule: between the caps' centres, along z [m], > 0
  Vec3 size = Vec3::Zero();              ///< box: edges [m], each > 0
  std::string mesh;                      ///< mesh: URL, package://, file:// or a plain path; STL, OBJ or DAE
  Vec3 scale = Vec3::Ones();             ///< mesh: factor to metres, each != 0 (a single number in YAML: all three)
  Pose pose;                             ///< offline: in the world; in the node: in its frame
  double friction = std::numeric_limits<double>::quiet_NaN();  ///< [0..10]; NaN: contact.friction
  double press = 0.0;    ///< a finger pad: force on cloth that another pad presses from the other side [N], >= 0
  double padding = 0.0;  ///< kept between cloth and surface beyond contact.thickness [m], >= 0
  Vec3 color = Vec3(0.45, 0.50, 0.58);  ///< red, green, blue [0..1]; drawn by the node, nothing else
  bool visible = true;                  ///< the same; false: it is there, and not drawn
  /// Offline only: a smooth curve through these poses, held at both ends; see docs/method.md, "Obstacles that move".
  std::vector<PoseKey> motion;
  Vec3 velocity = Vec3::Zero();      ///< at the start [m/s]; this and the next two: offline only, not with `motion`
  Vec3 acceleration = Vec3::Zero();  ///< [m/s^2]
  Vec3 spin = Vec3::Zero();          ///< about its origin, in world axes [rad/s]
};

/// Contact of the cloth with obstacles and with itself.
struct ContactParams {
  double thickness = 0.004;     ///< gap kept between cloth and obstacles, and (up to a quarter of the shortest link)
                                ///< cloth and cloth [m], > 0
  double friction = 0.3;        ///< Coulomb coefficient of cloth on itself and on obstacles without their own [0..10]
  bool self = false;            ///< contact of the cloth with itself
  double recovery_speed = 0.1;  ///< depenetration speed of what is nearer than the thickness when a substep begins
                                ///< [m/s], > 0; out of an obstacle: 20 times as fast
  int zone_iterations = 8;      ///< times a substep is solved again when something would go through [1..1000]
};

/// Time integration schemes (docs/method.md).
enum class Method {
  kAuto,       ///< leapfrog with substeps from the tensions and from how fast rods turn
  kLeapfrog,   ///< constraint forces along the links' directions at the start of the step; order 2, symplectic
  kLeapfrog4,  ///< five leapfrog steps to a substep, composed to order 4 (with damping: 2); as auto where a string is
               ///< taut or contact is near
  kImplicit,   ///< along the directions at the end of the step; order 1, stable at any step, damps
  kPaper       ///< Cheng 2000, Sect. 3: one explicit pass, rods rebuilt to their length; order 1, wefts give way
};

/// Air drag of a further cloth; density, law, threshold and fast_gain are those of AirParams.
struct LayerAirParams {
  double inside = 0.0;            ///< as AirParams has them, each
  double border = 0.0;            ///< as above
  double corner = 0.0;            ///< as above
  double normal_drag = 1.2;       ///< as above
  double tangential_drag = 0.02;  ///< as above
};

/// Name of the first cloth beside those of its layers.
constexpr const char* kFirstCloth = "cloth";

/// A further cloth in the same world. It touches the first and all others where contact.self is true.
///
/// Its columns are counted on after those before it: nodes of lines, tie-backs, drags and hands are [row, column] with
/// such columns, and so are all results. Pins, slits and carriers are of its own columns.
struct LayerParams {
  std::string name;    ///< unique among the layers, not "cloth": letters, digits and _, a letter first
  ClothParams cloth;   ///< as many rows and folds as the first has; not closed
  HangParams hang;     ///< where it starts; start.file is the first's alone, of all nodes
  HemParams hem;       ///< weights along its bottom row
  PinParams pins;      ///< its pinned nodes
  RailParams rail;     ///< its own
  LayerAirParams air;  ///< its own
};

/// How motion is computed.
struct SolverParams {
  Method method = Method::kAuto;    ///< time integration scheme
  double frame_rate = 60.0;         ///< published steps per second [1..10000]
  int substeps = 0;                 ///< per frame [1..10000]; 0 = auto
  double stretch_tolerance = 1e-3;  ///< relative overlength allowed to any link [1e-12..0.1]
  double position_tolerance = 0.0;  ///< error of positions to aim at [m per simulated second, RMS over the nodes],
                                    ///< [0..1]; 0: substeps from stability alone
  double rest_speed = 1e-4;         ///< columns that stay slower for half a second sleep [m/s], [0..1]; 0: none does
  double budget_ms = 0.0;           ///< computing time that a frame may take [ms], [0..1e6]; 0: no limit
  int threads = 0;                  ///< for one cloth [1..256]; 0 = auto: one for every 4000 nodes, at most the cores
  int max_substeps = 256;  ///< of auto per frame [1..10000]; a solve that fails there is left to the last resort
  int max_sweeps = 60;     ///< cap of warp/weft/contact sweeps per substep [1..10000]
  std::uint64_t seed = 1;  ///< of every random number
};

/// Everything a simulator starts from.
struct Scene {
  ClothParams cloth;                      ///< grid, size and mass
  HangParams hang;                        ///< start position
  HemParams hem;                          ///< weights along the bottom row
  PinParams pins;                         ///< pinned nodes; on a rail kTop pins none
  RailParams rail;                        ///< the top edge slides on it, or there is none
  std::vector<LineParams> lines;          ///< unique ids
  std::vector<TieBackParams> tie_back;    ///< unique ids
  Vec3 gravity = Vec3(0.0, 0.0, -9.81);   ///< [m/s^2]
  AirParams air;                          ///< damping, or the law of the relative velocity
  AmbientParams ambient;                  ///< the wind everywhere
  std::vector<WindParams> wind;           ///< unique ids
  std::vector<DragParams> drag;           ///< unique ids
  std::vector<HandParams> hands;          ///< unique ids
  std::vector<PoseKey> pins_motion;       ///< of a frame that the pins move with, from where they are at time 0
  std::vector<ObstacleParams> obstacles;  ///< unique names
  ContactParams contact;                  ///< of cloth with obstacles and itself
  std::vector<LayerParams> layers;        ///< unique names; further cloths beside the first
  SolverParams solver;                    ///< how motion is computed
};

/// The grid that all cloths of a scene have together: the first's parameters, with the columns and slits of all, and a
/// slit between neighbours. Without layers: the scene's cloth.
ClothParams wholeCloth(const Scene& scene);

/// Everything wrong with the scene's values; empty when it can be simulated. Does not open mesh files.
std::vector<Problem> validate(const Scene& scene);

/// The same for one wind, drag or obstacle, for the air and the solver; key is the prefix of the problems' keys.
std::vector<Problem> validate(const WindParams& wind, const std::string& key);
std::vector<Problem> validate(const DragParams& drag, const ClothParams& cloth,
                              const std::string& key);                                  ///< on this cloth
std::vector<Problem> validate(const ObstacleParams& obstacle, const std::string& key);  ///< as above
std::vector<Problem> validate(const AirParams& air, const std::string& key);            ///< as above
std::vector<Problem> validate(const DriveParams& drive, const std::string& key);        ///< as above
std::vector<Problem> validate(const SolverParams& solver, const std::string& key);      ///< as above
std::vector<Problem> validate(const ContactParams& contact, const std::string& key);    ///< as above

/// Sets what is known of the material: its density, bending, porosity, friction, thickness and air drag
/// (docs/materials.md); the coefficients of Eq. (4) unless air.law, to be set first, is relative. kNone changes nothing
/// but the name. A scene file's other keys come after it.
void applyMaterial(Material material, Scene& scene);
/// The same for a layer of the scene, but for friction and thickness, which are of all contact.
void applyMaterial(Material material, const Scene& scene, LayerParams& layer);
/// The same for a patch, but for air drag, too.
void applyMaterial(Material material, PatchParams& patch);
/// Lays a patch on the cloth, over those that are there; those that it covers go. One that gives nothing only does
/// that.
void addPatch(const PatchParams& patch, ClothParams& cloth);

/// Names of the methods as scene files and --method spell them, in the order of the enum.
const std::vector<std::string>& methodNames();
std::string toString(Method method);                            ///< its name
std::optional<Method> methodFromName(const std::string& name);  ///< none: there is no such method

/// Weft links in a row: columns - 1, or columns for closed cloth.
inline int weftLinkCount(const ClothParams& cloth) { return cloth.closed ? cloth.columns : cloth.columns - 1; }

}  // namespace curtain
