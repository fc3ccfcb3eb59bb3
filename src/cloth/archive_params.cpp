// SPDX-License-Identifier: BSD-3-Clause
#include "cloth/archive_params.h"

#include "scene/fields.h"

namespace curtain {
namespace {

class ParamCarrier {
 public:
  explicit ParamCarrier(Archive& archive, const Grid& grid = {}) : archive_(archive), grid_(grid) {}

  void number(Key key, double& value, Range) { archive_.number(key.name, value); }
  void flag(Key key, bool& value) { archive_.flag(key.name, value); }
  void text(Key key, std::string& value) { archive_.text(key.name, value); }
  void vector(Key key, Vec3& value, Range) { archive_.numbers(key.name, value); }
  void optionalVector(Key key, std::optional<Vec3>& value, Range) {
    archive_.optional(key.name, value, Vec3(Vec3::Zero()), [this](Vec3& item) { archive_.numbers("value", item); });
  }
  void node(Key key, std::optional<NodeIndex>& value) {
    archive_.optional(key.name, value, NodeIndex(), [this](NodeIndex& item) { archive_.node("value", item, grid_); });
  }
  template <typename T>
  void list(Key key, std::vector<T>& values) {
    archive_.list(key.name, values, [this](T& item) { visitFields(*this, item); });
  }
  template <typename Enum>
  void choice(Key key, Enum& value, const std::vector<std::string>& names) {
    archive_.integer(key.name, value, 0, static_cast<std::int64_t>(names.size()) - 1);
  }

 private:
  Archive& archive_;
  Grid grid_;  // of node indices
};

void judge(const Archive& archive, const std::vector<Problem>& problems) {
  if (archive.loads() && !problems.empty()) archive.fail(describe(problems));
}

template <typename Params>
void serializeFields(Archive& archive, Params& params, const Grid& grid = {}) {
  ParamCarrier carrier(archive, grid);
  archive.atOnce([&] { visitFields(carrier, params); });
}

}  // namespace

void serializeParams(Archive& archive, WindParams& wind) {
  serializeFields(archive, wind);
  judge(archive, validate(wind, "wind"));
}

void serializeParams(Archive& archive, DragParams& drag, const ClothParams& cloth) {
  serializeFields(archive, drag, Grid(cloth.rows, cloth.columns, cloth.closed));
  judge(archive, validate(drag, cloth, "drag"));
}

void serializeParams(Archive& archive, AirParams& air) {
  serializeFields(archive, air);
  judge(archive, validate(air, "air"));
}

void serializeParams(Archive& archive, GraspParams& grasp, const ClothParams& cloth) {
  const Grid grid(cloth.rows, cloth.columns, cloth.closed);
  archive.atOnce([&] {
    archive.text("id", grasp.id);
    archive.finite("frame", grasp.frame);
    archive.integer("region", grasp.region, 0, 2);
    archive.finite("place", grasp.place);
    archive.number("radius", grasp.radius);
    archive.numbers("size", grasp.size);
    archive.list("nodes", grasp.nodes, [&](NodeIndex& node) { archive.node("node", node, grid); });
    archive.number("stiffness", grasp.stiffness);
    archive.number("break_force", grasp.break_force);
    archive.number("pinch_force", grasp.pinch_force);
    archive.number("friction", grasp.friction);
  });
  judge(archive, validate(grasp, cloth, "grasp"));
}

}  // namespace curtain
