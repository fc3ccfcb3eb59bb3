// SPDX-License-Identifier: BSD-3-Clause
//
// The table of a scene's keys: every key once, with its member and range. The reader, the range checker, the writer,
// the comparison and the list of known keys are visitors of this table, so they cannot disagree.
//
// A visitor has these members; keys are relative to the visited map:
//   integer, integerOr (a word stands for one value), seed, number, optionalNumber, numberOrUnset (NaN: not given),
//   flag, text, optionalText, choice, vector, optionalVector, scale (one number or three), rotation, node, nodes,
//   numbers, integers, pins, slits, path (of a rail), map (a struct below), list (a list of structs, and what one has
//   that says nothing), belongs (false: the key is not for what was chosen).
#pragma once

#include <type_traits>

#include "curtain_sim/scene.h"
#include "scene/names.h"
#include "scene/ranges.h"

namespace curtain {

/// Name of a key; a required one has no default.
struct Key {
  Key(const char* key_name, bool is_required = false) : name(key_name), required(is_required) {}
  const char* name;
  bool required;
};

inline Key required(const char* name) { return {name, true}; }

/// A choice that other keys belong to.
struct Chosen {
  const char* key;
  const std::vector<std::string>& names;
  std::size_t value;
};

/// A layer that says nothing: its drag and its folds are the scene's.
inline LayerParams layerBeside(const Scene& scene) {
  LayerParams layer;
  layer.cloth.folds = scene.cloth.folds;
  const AirParams& air = scene.air;
  layer.air = {air.inside, air.border, air.corner, air.normal_drag, air.tangential_drag};
  return layer;
}

template <typename T>
struct Fields;

/// Visits every key of a struct.
template <typename Visitor, typename T>
void visitFields(Visitor& visitor, T& value) {
  Fields<std::remove_const_t<T>>::visit(visitor, value);
}

template <>
struct Fields<PatchParams> {
  template <typename Visitor, typename T>
  static void visit(Visitor& v, T& patch) {
    v.integers("rows", patch.rows, IntRange{0, 4095});
    v.integers("columns", patch.columns, IntRange{0, 4095});
    v.choice("material", patch.material, materialNames());
    v.optionalNumber("surface_density", patch.surface_density, positive());
    v.optionalNumber("porosity", patch.porosity, between(0.0, 1.0));
    v.optionalNumber("bending_warp", patch.bending_warp, between(0.0, 1e3));
    v.optionalNumber("bending_weft", patch.bending_weft, between(0.0, 1e3));
    v.optionalNumber("bending_bias", patch.bending_bias, between(0.0, 1e3));
    v.optionalNumber("bending_hysteresis", patch.bending_hysteresis, between(0.0, 1e6));
    v.optionalNumber("shear", patch.shear, between(0.0, 1e6));
  }
};

template <>
struct Fields<ClothParams> {
  template <typename Visitor, typename T>
  static void visit(Visitor& v, T& cloth) {
    v.flag("closed", cloth.closed);  // first: the range of columns depends on it
    v.integer(required("rows"), cloth.rows, IntRange{2, 4096});
    v.integer(required("columns"), cloth.columns, IntRange{cloth.closed ? 3 : 2, 4096});
    v.number("height", cloth.height, positive());
    v.number("width", cloth.width, positive());
    v.optionalNumber("hem_width", cloth.hem_width, positive());
    v.choice("material", cloth.material, materialNames());
    v.number("surface_density", cloth.surface_density, positive());
    v.choice("lumping", cloth.lumping, lumpingNames());
    v.integer("folds", cloth.folds, IntRange{1, 64});
    v.number("porosity", cloth.porosity, between(0.0, 1.0));
    v.number("bending_warp", cloth.bending_warp, between(0.0, 1e3));
    v.number("bending_weft", cloth.bending_weft, between(0.0, 1e3));
    v.number("bending_bias", cloth.bending_bias, between(0.0, 1e3));
    v.number("bending_hysteresis", cloth.bending_hysteresis, between(0.0, 1e6));
    v.number("shear", cloth.shear, between(0.0, 1e6));
    v.list("patches", cloth.patches);
    v.slits("slits", cloth.slits);
    v.numbers("row_spacing", cloth.row_spacing, positive());
    v.numbers("column_spacing", cloth.column_spacing, positive());
    v.numbers("row_mass", cloth.row_mass, positive());
    v.numbers("column_mass", cloth.column_mass, positive());
  }
};

template <>
struct Fields<StartParams> {
  template <typename Visitor, typename T>
  static void visit(Visitor& v, T& start) {
    v.optionalText("over", start.over);
    v.optionalText("file", start.file);
  }
};

template <>
struct Fields<HangParams> {
  template <typename Visitor, typename T>
  static void visit(Visitor& v, T& hang) {
    v.vector("from", hang.from, anywhere());
    v.vector("to", hang.to, anywhere());
    v.optionalNumber("radius", hang.radius, positive());
    v.number("tilt", hang.tilt, turn());
    v.choice("heading", hang.heading, headingNames());
    v.integer("pleats", hang.pleats, IntRange{0, 1024});
    v.number("pressed", hang.pressed, notNegative());
    v.optionalNumber("fullness", hang.fullness, between(1.0, 3.0));
    v.optionalNumber("overlap", hang.overlap, notNegative());
    v.map("start", hang.start);
  }
};

template <>
struct Fields<HemParams> {
  template <typename Visitor, typename T>
  static void visit(Visitor& v, T& hem) {
    v.number("line_density", hem.line_density, notNegative());
    v.numbers("weights", hem.weights, notNegative());
  }
};

template <>
struct Fields<CarrierParams> {
  template <typename Visitor, typename T>
  static void visit(Visitor& v, T& carriers) {
    v.integer("every", carriers.every, IntRange{1, 4095});
    v.integers("columns", carriers.columns, IntRange{0, 4095});
    v.number("mass", carriers.mass, notNegative());
    v.number("friction", carriers.friction, between(0.0, 10.0));
    v.number("gap", carriers.gap, positive());
  }
};

template <>
struct Fields<DriveParams> {
  template <typename Visitor, typename T>
  static void visit(Visitor& v, T& drive) {
    v.number("speed", drive.speed, positive());
    v.number("force", drive.force, notNegative());
  }
};

template <>
struct Fields<RailParams> {
  template <typename Visitor, typename T>
  static void visit(Visitor& v, T& rail) {
    v.path("path", rail.path, anywhere());
    v.map("carriers", rail.carriers);
    v.number("opening", rail.opening, between(0.0, 1.0));
    v.map("drive", rail.drive);
    v.integers("masters", rail.masters, IntRange{0, 4095});
  }
};

template <>
struct Fields<LineParams> {
  template <typename Visitor, typename T>
  static void visit(Visitor& v, T& line) {
    v.text(required("id"), line.id);
    v.nodes(required("nodes"), line.nodes);
    v.optionalNumber("length", line.length, positive());
    v.optionalVector("to", line.to, anywhere());
    v.optionalNumber("mass", line.mass, positive());
  }
};

template <>
struct Fields<TieBackParams> {
  template <typename Visitor, typename T>
  static void visit(Visitor& v, T& loop) {
    v.text(required("id"), loop.id);
    v.integer(required("row"), loop.row, IntRange{0, 4095});
    v.integer(required("first_column"), loop.first_column, IntRange{0, 4095});
    v.integer(required("last_column"), loop.last_column, IntRange{0, 4095});
    v.vector(required("point"), loop.point, anywhere());
    v.number("radius", loop.radius, between(1e-3, kLargest));
    v.number("speed", loop.speed, positive());
    v.flag("closed", loop.closed);
  }
};

template <>
struct Fields<AirParams> {
  template <typename Visitor, typename T>
  static void visit(Visitor& v, T& air) {
    v.number("density", air.density, notNegative());
    v.choice("law", air.law, airLawNames());
    v.number("threshold", air.threshold, positive());
    v.number("inside", air.inside, notNegative());
    v.number("border", air.border, notNegative());
    v.number("corner", air.corner, notNegative());
    v.number("fast_gain", air.fast_gain, notNegative());
    v.number("normal_drag", air.normal_drag, between(0.0, 100.0));
    v.number("tangential_drag", air.tangential_drag, between(0.0, 100.0));
  }
};

template <>
struct Fields<AmbientParams> {
  template <typename Visitor, typename T>
  static void visit(Visitor& v, T& ambient) {
    v.vector("velocity", ambient.velocity, anywhere());
    v.number("intensity", ambient.intensity, between(0.0, 1.0));
    v.number("length_scale", ambient.length_scale, between(1e-3, 1e6));
    v.choice("spectrum", ambient.spectrum, gustSpectrumNames());
    v.seed("seed", ambient.seed);
  }
};

template <>
struct Fields<WindParams> {
  template <typename Visitor, typename T>
  static void visit(Visitor& v, T& wind) {
    v.text(required("id"), wind.id);
    v.vector("position", wind.position, anywhere());
    v.vector("direction", wind.direction, anywhere());
    v.number("radius", wind.radius, positive());
    v.number("half_angle", wind.half_angle, between(0.0, 1.5));
    v.choice("profile", wind.profile, windProfileNames());
    v.number("pressure", wind.pressure, notNegative());
    v.number("node_force", wind.node_force, notNegative());
    v.number("porosity_weight", wind.porosity_weight, between(0.0, 1.0));
    v.number("distance_weight", wind.distance_weight, positive());
    v.number("reference_length", wind.reference_length, between(1e-6, 1e6));
    v.number("unsteadiness", wind.unsteadiness, notNegative());
    v.number("correlation_time", wind.correlation_time, between(1e-6, 1e6));
    v.number("correlation_length", wind.correlation_length, positive());
    v.flag("shadow", wind.shadow);
    v.number("start", wind.start, anywhere());
    v.number("end", wind.end, orInfinite());
  }
};

template <>
struct Fields<PointKey> {
  template <typename Visitor, typename T>
  static void visit(Visitor& v, T& key) {
    v.number("time", key.time, anywhere());
    v.vector("position", key.position, anywhere());
  }
};

template <>
struct Fields<DragParams> {
  template <typename Visitor, typename T>
  static void visit(Visitor& v, T& drag) {
    v.text(required("id"), drag.id);
    v.node("node", drag.node);
    v.optionalVector("point", drag.point, anywhere());
    v.vector("force", drag.force, anyForce());
    v.optionalVector("target", drag.target, anywhere());
    v.list("path", drag.path);
    v.number("stiffness", drag.stiffness, positive());
    v.number("max_force", drag.max_force, positive());
    v.number("radius", drag.radius, notNegative());
    v.number("start", drag.start, anywhere());
    v.number("end", drag.end, orInfinite());
  }
};

template <>
struct Fields<PoseKey> {
  template <typename Visitor, typename T>
  static void visit(Visitor& v, T& key) {
    v.number("time", key.time, anywhere());
    v.vector("position", key.pose.position, anywhere());
    v.rotation("orientation", key.pose.orientation);
  }
};

template <>
struct Fields<Pose> {
  template <typename Visitor, typename T>
  static void visit(Visitor& v, T& pose) {
    v.vector("position", pose.position, anywhere());
    v.rotation("orientation", pose.orientation);
  }
};

template <>
struct Fields<GraspParams> {
  template <typename Visitor, typename T>
  static void visit(Visitor& v, T& grasp) {
    v.text(required("id"), grasp.id);
    v.map("frame", grasp.frame);
    visitHold(v, grasp);
  }

  /// What it takes, and how it holds it.
  template <typename Visitor, typename T>
  static void visitHold(Visitor& v, T& grasp) {
    v.choice("region", grasp.region, graspRegionNames());
    const GraspRegion region = grasp.region;
    const Chosen chosen{"region", graspRegionNames(), static_cast<std::size_t>(region)};
    if (v.belongs("place", region != GraspRegion::kNodes, chosen)) v.map("place", grasp.place);
    if (v.belongs("radius", region == GraspRegion::kSphere, chosen))
      v.number(required("radius"), grasp.radius, positive());
    if (v.belongs("size", region == GraspRegion::kBox, chosen)) v.vector(required("size"), grasp.size, positive());
    if (v.belongs("nodes", region == GraspRegion::kNodes, chosen)) v.nodes(required("nodes"), grasp.nodes);
    v.number("stiffness", grasp.stiffness, strength());
    v.number("break_force", grasp.break_force, strength());
    v.number("pinch_force", grasp.pinch_force, strength());
    v.number("friction", grasp.friction, grasp.pinch_force <= kLargest ? positive() : notNegative());
  }
};

template <>
struct Fields<HandParams> {
  template <typename Visitor, typename T>
  static void visit(Visitor& v, T& hand) {
    v.text(required("id"), hand.grasp.id);
    v.vector("position", hand.grasp.frame.position, anywhere());
    v.rotation("orientation", hand.grasp.frame.orientation);
    Fields<GraspParams>::visitHold(v, hand.grasp);
    v.number("start", hand.start, anywhere());
    v.number("end", hand.end, orInfinite());
    v.list("motion", hand.motion, PoseKey{0.0, hand.grasp.frame});  // read before
  }
};

template <>
struct Fields<ObstacleParams> {
  template <typename Visitor, typename T>
  static void visit(Visitor& v, T& obstacle) {
    v.text(required("name"), obstacle.name);
    v.text("frame", obstacle.frame);
    v.choice("shape", obstacle.shape, shapeNames());
    visitShape(v, obstacle);
    v.vector("position", obstacle.pose.position, anywhere());
    v.rotation("orientation", obstacle.pose.orientation);
    v.numberOrUnset("friction", obstacle.friction, between(0.0, 10.0));
    v.number("press", obstacle.press, notNegative());
    v.number("padding", obstacle.padding, notNegative());
    v.vector("color", obstacle.color, between(0.0, 1.0));
    v.flag("visible", obstacle.visible);
    v.vector("velocity", obstacle.velocity, anywhere());
    v.vector("acceleration", obstacle.acceleration, anywhere());
    v.vector("spin", obstacle.spin, anywhere());
    v.list("motion", obstacle.motion, PoseKey{0.0, obstacle.pose});  // read before
  }

 private:
  template <typename Visitor, typename T>
  static void visitShape(Visitor& v, T& obstacle) {
    const ShapeKind shape = obstacle.shape;
    const bool long_shape = shape == ShapeKind::kCylinder || shape == ShapeKind::kCapsule;
    const bool box = shape == ShapeKind::kBox;
    const bool mesh = shape == ShapeKind::kMesh;
    const Chosen chosen{"shape", shapeNames(), static_cast<std::size_t>(shape)};
    if (v.belongs("radius", long_shape || shape == ShapeKind::kSphere, chosen)) {
      v.number(required("radius"), obstacle.radius, positive());
    }
    if (v.belongs("length", long_shape, chosen)) v.number(required("length"), obstacle.length, positive());
    if (v.belongs("size", box, chosen)) v.vector(required("size"), obstacle.size, positive());
    if (v.belongs("mesh", mesh, chosen)) v.text(required("mesh"), obstacle.mesh);
    if (v.belongs("scale", mesh, chosen)) v.scale("scale", obstacle.scale, notZero());
  }
};

template <>
struct Fields<ContactParams> {
  template <typename Visitor, typename T>
  static void visit(Visitor& v, T& contact) {
    v.number("thickness", contact.thickness, positive());
    v.number("friction", contact.friction, between(0.0, 10.0));
    v.flag("self", contact.self);
    v.number("recovery_speed", contact.recovery_speed, positive());
    v.integer("zone_iterations", contact.zone_iterations, IntRange{1, 1000});
  }
};

template <>
struct Fields<LayerAirParams> {
  template <typename Visitor, typename T>
  static void visit(Visitor& v, T& air) {
    v.number("inside", air.inside, notNegative());
    v.number("border", air.border, notNegative());
    v.number("corner", air.corner, notNegative());
    v.number("normal_drag", air.normal_drag, between(0.0, 100.0));
    v.number("tangential_drag", air.tangential_drag, between(0.0, 100.0));
  }
};

template <>
struct Fields<LayerParams> {
  template <typename Visitor, typename T>
  static void visit(Visitor& v, T& layer) {
    v.text(required("name"), layer.name);
    v.map("cloth", layer.cloth);
    v.map("hang", layer.hang);
    v.map("hem", layer.hem);
    v.pins("pins", layer.pins);
    v.map("rail", layer.rail);
    v.map("air", layer.air);
  }
};

template <>
struct Fields<SolverParams> {
  template <typename Visitor, typename T>
  static void visit(Visitor& v, T& solver) {
    v.choice("method", solver.method, methodNames());
    v.number("frame_rate", solver.frame_rate, between(1.0, 10000.0));
    v.integerOr("substeps", solver.substeps, IntRange{1, 10000}, "auto", 0);
    v.number("stretch_tolerance", solver.stretch_tolerance, between(1e-12, 0.1));
    v.number("position_tolerance", solver.position_tolerance, between(0.0, 1.0));
    v.number("rest_speed", solver.rest_speed, between(0.0, 1.0));
    v.number("budget_ms", solver.budget_ms, between(0.0, 1e6));
    v.integerOr("threads", solver.threads, IntRange{1, 256}, "auto", 0);
    v.integer("max_substeps", solver.max_substeps, IntRange{1, 10000});
    v.integer("max_sweeps", solver.max_sweeps, IntRange{1, 10000});
    v.seed("seed", solver.seed);
  }
};

template <>
struct Fields<Scene> {
  template <typename Visitor, typename T>
  static void visit(Visitor& v, T& scene) {
    v.map("cloth", scene.cloth);
    v.map("hang", scene.hang);
    v.map("hem", scene.hem);
    v.pins("pins", scene.pins);
    v.map("rail", scene.rail);
    v.list("lines", scene.lines);
    v.list("tie_back", scene.tie_back);
    v.vector("gravity", scene.gravity, anywhere());
    v.map("air", scene.air);
    v.map("ambient", scene.ambient);
    v.list("wind", scene.wind);
    v.list("drag", scene.drag);
    v.list("hands", scene.hands);
    v.list("pins_motion", scene.pins_motion);
    v.list("obstacles", scene.obstacles);
    v.map("contact", scene.contact);
    v.list("layers", scene.layers, layerBeside(scene));
    v.map("solver", scene.solver);
  }
};

}  // namespace curtain
