// SPDX-License-Identifier: BSD-3-Clause
//
// Checks a scene's values: each by itself (RangeChecker), and together (here and in check_start.cpp).
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>

#include "scene/checks.h"
#include "scene/layers.h"
#include "scene/range_checker.h"
#include "scene/ranges.h"
#include "scene/scalar.h"
#include "scene/shares.h"

namespace curtain {
namespace {

// Least density of air that has a velocity [kg/m^3]: with the strongest wind its speeds and their squares are finite.
constexpr double kThinnest = 1e-6;

// Of all cloths together, as of one.
constexpr int kMaxColumns = 4096;

// Shortest link of cloth that resists bending [m].
constexpr double kShortestThatBends = 1e-6;

std::string formatNode(const NodeIndex& node) {
  return "[" + std::to_string(node.row) + ", " + std::to_string(node.column) + "]";
}

void checkCount(const std::string& key, const std::vector<double>& values, int count, const std::string& of_what,
                ProblemLog& log) {
  if (values.empty() || values.size() == static_cast<std::size_t>(count) || !log.good(key)) return;
  log.add(key, "must have " + std::to_string(count) + " entries (" + of_what + ") or none, has " +
                   std::to_string(values.size()));
}

void checkSizes(const ClothParams& cloth, ProblemLog& log) {
  if (log.good("cloth.rows")) {
    checkCount("cloth.row_spacing", cloth.row_spacing, cloth.rows - 1, "rows - 1", log);
    checkCount("cloth.row_mass", cloth.row_mass, cloth.rows, "rows", log);
  }
  if (log.good("cloth.columns") && log.good("cloth.closed")) {
    checkCount("cloth.column_spacing", cloth.column_spacing, weftLinkCount(cloth),
               cloth.closed ? "columns" : "columns - 1", log);
    checkCount("cloth.column_mass", cloth.column_mass, cloth.columns, "columns", log);
  }
}

void checkHem(const Scene& scene, ProblemLog& log) {
  if (log.good("cloth.columns")) checkCount("hem.weights", scene.hem.weights, scene.cloth.columns, "columns", log);
}

void checkSlits(const ClothParams& cloth, ProblemLog& log) {
  if (!log.good("cloth.slits") || !log.good("cloth.rows") || !log.good("cloth.columns") || !log.good("cloth.closed"))
    return;
  std::map<int, std::size_t> seen;
  for (std::size_t i = 0; i < cloth.slits.size(); ++i) {
    const std::string key = itemKey("cloth.slits", i);
    const SlitParams& slit = cloth.slits[i];
    const auto check = [&](const std::string& name, int value, int most) {
      if (value >= 0 && value <= most) return;
      log.add(joinKey(key, name), "must be in [0, " + std::to_string(most) + "], is " + std::to_string(value));
    };
    check("column", slit.column, weftLinkCount(cloth) - 1);
    check("from_row", slit.from_row, cloth.rows - 1);
    const auto [first, inserted] = seen.emplace(slit.column, i);
    if (!inserted) {
      log.add(joinKey(key, "column"), "must be unique, " + std::to_string(slit.column) + " is taken by " +
                                          itemKey("cloth.slits", first->second));
    }
  }
  // A strip of one column would have no width, and so no mass.
  const int links = weftLinkCount(cloth);
  const auto isEdge = [&](int link) { return !cloth.closed && (link < 0 || link >= links); };
  for (const auto& [column, entry] : seen) {
    const int next = cloth.closed ? (column + 1) % links : column + 1;
    const bool alone = isEdge(column - 1) || isEdge(next) || (next != column && seen.count(next) > 0);
    if (!alone) continue;
    const int lone = isEdge(column - 1) ? column : next % cloth.columns;
    log.add(joinKey(itemKey("cloth.slits", entry), "column"),
            "must leave strips of two columns and more, leaves column " + std::to_string(lone) + " alone");
  }
}

// One direction of a block of nodes.
void checkBlock(const std::string& key, const std::vector<int>& block, int count, ProblemLog& log) {
  if (block.empty() || !log.good(key)) return;
  const std::string most = std::to_string(count - 1);
  if (block.size() != 2) {
    log.add(key, "must be [first, last], has " + std::to_string(block.size()) + " entries");
  } else if (block[0] > block[1] || block[1] >= count) {
    log.add(key, "must be [first, last] with 0 <= first <= last <= " + most + ", is [" + std::to_string(block[0]) +
                     ", " + std::to_string(block[1]) + "]");
  }
}

void checkPatches(const ClothParams& cloth, ProblemLog& log) {
  for (std::size_t k = 0; k < cloth.patches.size(); ++k) {
    const std::string key = itemKey("cloth.patches", k);
    if (log.good("cloth.rows")) checkBlock(joinKey(key, "rows"), cloth.patches[k].rows, cloth.rows, log);
    if (log.good("cloth.columns")) checkBlock(joinKey(key, "columns"), cloth.patches[k].columns, cloth.columns, log);
  }
}

// Springs of a joint are as stiff as its links' lengths are small, to the third power.
void checkBending(const Scene& scene, ProblemLog& log) {
  const ClothParams& cloth = scene.cloth;
  if (!cloth.patches.empty() && (!log.good("cloth.rows") || !log.good("cloth.columns"))) return;
  const auto any = [&](const auto& is) { return anyFabric(cloth, is); };
  if (scene.solver.method == Method::kPaper &&
      any([](const Fabric& fabric) { return fabric.shear > 0.0 || fabric.bending_bias > 0.0; }))
    log.add("solver.method", "can't be paper for cloth that resists shear or twist (cloth.shear, bending_bias > 0)");
  if (any([](const Fabric& fabric) { return fabric.bending_hysteresis > 0.0 && !fabric.bends(); }))
    log.add("cloth.bending_hysteresis", "must be 0 where bending_warp and bending_weft are 0");
  if (!any([](const Fabric& fabric) { return fabric.bends(); })) return;
  if (scene.solver.method == Method::kPaper)
    log.add("solver.method",
            "can't be paper for cloth that resists bending (cloth.bending_warp, cloth.bending_weft > 0)");
  for (const char* key :
       {"rows", "columns", "height", "width", "hem_width", "closed", "row_spacing", "column_spacing"}) {
    if (!log.good("cloth." + std::string(key))) return;
  }
  const std::vector<double> rods = shareOut(cloth.height, cloth.row_spacing, cloth.rows - 1);
  const std::vector<double> links =
      shareOut(std::min(cloth.width, hemWidth(cloth)), cloth.column_spacing, weftLinkCount(cloth));
  const double shortest =
      std::min(*std::min_element(rods.begin(), rods.end()), *std::min_element(links.begin(), links.end()));
  if (!(shortest >= kShortestThatBends))
    log.add("cloth", "must have links of at least " + formatNumber(kShortestThatBends) +
                         " m where it resists bending (bending_warp, bending_weft > 0), has one of " +
                         formatNumber(shortest) + " m");
}

void checkPins(const Scene& scene, ProblemLog& log) {
  if (scene.pins.kind != PinKind::kList) return;
  for (std::size_t i = 0; i < scene.pins.nodes.size(); ++i) {
    checkNodeOnGrid(scene.pins.nodes[i], scene.cloth, itemKey("pins", i), log);
  }
}

void checkTimes(double start, double end, const std::string& key, ProblemLog& log) {
  if (!log.good(joinKey(key, "start")) || !log.good(joinKey(key, "end")) || end > start) return;
  log.add(joinKey(key, "end"), "must be > start = " + formatNumber(start) + ", is " + formatNumber(end));
}

void checkAir(const AirParams& air, const std::string& key, ProblemLog& log) {
  if (air.law != AirLaw::kRelative || !log.good(joinKey(key, "law"))) return;
  const std::string density_key = joinKey(key, "density");
  // Winds are given as pressures; without density there is no speed of air that has one.
  if (log.good(density_key) && !(air.density >= kThinnest)) {
    log.add(density_key,
            "must be >= " + formatNumber(kThinnest) + " with law relative, is " + formatNumber(air.density));
  }
  const auto mustBeZero = [&](const char* name, double value) {
    if (value == 0.0 || !log.good(joinKey(key, name))) return;
    log.add(joinKey(key, name),
            "must be 0 with law relative, which has normal_drag and tangential_drag; is " + formatNumber(value));
  };
  mustBeZero("inside", air.inside);
  mustBeZero("border", air.border);
  mustBeZero("corner", air.corner);
}

// What only some laws and schemes can do.
void checkLaw(const Scene& scene, ProblemLog& log) {
  if (!log.good("air.law")) return;
  const bool relative = scene.air.law == AirLaw::kRelative;
  if (!relative && !scene.ambient.velocity.isZero() && log.good("ambient.velocity")) {
    log.add("ambient.velocity", "must be [0, 0, 0] unless air.law is relative: other laws know no velocity of the air");
  }
  if (relative && scene.solver.method == Method::kPaper && log.good("solver.method")) {
    log.add("air.law",
            "must be continuous or printed with solver.method paper, which has no forces of the links for it");
  }
}

void checkWind(const WindParams& wind, const std::string& key, ProblemLog& log) {
  const std::string direction_key = joinKey(key, "direction");
  // Outside of this range the squared length underflows or overflows.
  const double length = wind.direction.norm();
  if (log.good(direction_key) && !(length >= 1e-150 && length <= 1e150)) {
    log.add(direction_key, "must have a length > 0 (1e-150 to 1e+150), is " + formatVector(wind.direction));
  }
  checkTimes(wind.start, wind.end, key, log);
}

// Times of poses or points.
template <typename AtTime>
void checkIncrease(const std::vector<AtTime>& entries, const std::string& list, ProblemLog& log) {
  for (std::size_t i = 1; i < entries.size(); ++i) {
    const std::string time_key = joinKey(itemKey(list, i), "time"), before_key = joinKey(itemKey(list, i - 1), "time");
    const double before = entries[i - 1].time, time = entries[i].time;
    if (!log.good(time_key) || !log.good(before_key) || time > before) continue;
    log.add(time_key, "must be > the time before it = " + formatNumber(before) + ", is " + formatNumber(time));
  }
}

void checkDrag(const DragParams& drag, const ClothParams& cloth, const std::string& key, ProblemLog& log) {
  const std::string node_key = joinKey(key, "node");
  checkTimes(drag.start, drag.end, key, log);
  if (drag.node) checkNodeOnGrid(*drag.node, cloth, node_key, log);
  checkIncrease(drag.path, joinKey(key, "path"), log);
  if (drag.target && !drag.path.empty())
    log.add(joinKey(key, "target"), "must not be given beside path, which says where it is");
  // Last: a problem of the whole entry suppresses others below its key.
  const bool readable = log.good(node_key) && log.good(joinKey(key, "point"));
  if (drag.node.has_value() == drag.point.has_value() && (drag.node.has_value() || readable)) {
    log.add(key, std::string("must give exactly one of node and point, gives ") + (drag.node ? "both" : "neither"));
  }
}

void checkObstacle(const ObstacleParams& obstacle, const std::string& key, ProblemLog& log) {
  const std::pair<const char*, const Vec3&> steady[] = {
      {"velocity", obstacle.velocity}, {"acceleration", obstacle.acceleration}, {"spin", obstacle.spin}};
  for (const auto& [name, value] : steady) {
    if (!obstacle.motion.empty() && !value.isZero(0.0))
      log.add(joinKey(key, name), "must not be given beside motion, which says where it is");
  }
  checkIncrease(obstacle.motion, joinKey(key, "motion"), log);
}

// name: an entry's id, which setWind() and the topics address it by; seen: those before it.
void checkUnique(const std::string& name, std::size_t entry, const std::string& list, const std::string& key,
                 std::map<std::string, std::size_t>& seen, ProblemLog& log) {
  const std::string name_key = joinKey(itemKey(list, entry), key);
  if (name.empty() || !log.good(name_key)) return;
  const auto [first, inserted] = seen.emplace(name, entry);
  if (!inserted) log.add(name_key, "must be unique, " + quoted(name) + " is taken by " + itemKey(list, first->second));
}

template <typename T>
void checkUnique(const std::vector<T>& entries, const std::string& list, const std::string& key, std::string T::*name,
                 ProblemLog& log) {
  std::map<std::string, std::size_t> seen;
  for (std::size_t i = 0; i < entries.size(); ++i) checkUnique(entries[i].*name, i, list, key, seen, log);
}

void checkHand(const HandParams& hand, const Scene& scene, const ClothParams& whole, const std::string& key,
               ProblemLog& log) {
  checkTimes(hand.start, hand.end, key, log);
  checkHold(hand.grasp, whole, key, log);
  checkIncrease(hand.motion, joinKey(key, "motion"), log);
  if (scene.solver.method != Method::kPaper || !log.good("solver.method")) return;
  const std::pair<const char*, double> limits[] = {{"stiffness", hand.grasp.stiffness},
                                                   {"break_force", hand.grasp.break_force},
                                                   {"pinch_force", hand.grasp.pinch_force}};
  for (const auto& [name, value] : limits) {
    if (value <= kLargest) log.add(joinKey(key, name), "can't be given with solver.method paper, which knows no pulls");
  }
}

// Laid over something, or put somewhere: nothing may hold the cloth elsewhere.
void checkStartElsewhere(const Scene& scene, ProblemLog& log) {
  const StartParams& start = scene.hang.start;
  const bool over = start.over.has_value(), file = start.file.has_value();
  if (!over && !file) return;
  if (over && file) log.add("hang.start", "must give one of over and file, gives both");
  if (!scene.rail.path.empty())
    log.add("hang.start", "can't be given with a rail, whose carriers say where the edge is");
  if (!scene.lines.empty() || !scene.tie_back.empty())
    log.add("hang.start", "can't be given with lines or tie-backs, which begin where the cloth hangs");
  if (!over) return;
  if (scene.pins.kind != PinKind::kNone && log.good("pins"))
    log.add("hang.start.over", "needs pins: none, what is laid over something is not hung");
  if (!(scene.gravity.z() < 0.0)) log.add("hang.start.over", "needs gravity that points down");
  if (scene.cloth.closed) log.add("hang.start.over", "can't be given for closed cloth");
  const auto is_it = [&](const ObstacleParams& obstacle) { return obstacle.name == *start.over; };
  if (std::none_of(scene.obstacles.begin(), scene.obstacles.end(), is_it))
    log.add("hang.start.over", "must be the name of an obstacle, is " + quoted(*start.over));
}

void checkHands(const Scene& scene, const ClothParams& whole, ProblemLog& log) {
  std::map<std::string, std::size_t> seen;
  for (std::size_t i = 0; i < scene.hands.size(); ++i) {
    checkHand(scene.hands[i], scene, whole, itemKey("hands", i), log);
    checkUnique(scene.hands[i].grasp.id, i, "hands", "id", seen, log);
  }
  checkIncrease(scene.pins_motion, "pins_motion", log);
  if (scene.pins_motion.empty() || !log.good("pins") || !log.good("layers")) return;
  const auto pinned = [](const auto& one) {
    return one.pins.kind != PinKind::kNone && (one.pins.kind != PinKind::kList || !one.pins.nodes.empty());
  };
  const auto slides = [](const auto& one) { return !one.rail.path.empty(); };
  if (!pinned(scene) && std::none_of(scene.layers.begin(), scene.layers.end(), pinned))
    log.add("pins_motion", "needs pins, there are none");
  if (slides(scene) || std::any_of(scene.layers.begin(), scene.layers.end(), slides))
    log.add("pins_motion", "can't be given with a rail, which does not move");
}

// What belongs to one cloth, as the first of a scene.
void checkCloth(const Scene& scene, ProblemLog& log) {
  checkSizes(scene.cloth, log);
  checkSlits(scene.cloth, log);
  checkPatches(scene.cloth, log);
  checkHem(scene, log);
  if (scene.rail.path.empty()) checkStart(scene, log);
  checkPins(scene, log);
  checkRail(scene, log);
  checkBending(scene, log);
  checkStartElsewhere(scene, log);
}

bool isName(const std::string& text) {
  const auto isLetter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  return !text.empty() && isLetter(text.front()) && std::all_of(text.begin(), text.end(), [&](char c) {
    return isLetter(c) || (c >= '0' && c <= '9') || c == '_';
  });
}

void checkLayer(const Scene& scene, std::size_t number, ProblemLog& log) {
  const std::string key = itemKey("layers", number);
  const LayerParams& layer = scene.layers[number];
  const std::string name_key = joinKey(key, "name");
  if (!isName(layer.name) && log.good(name_key))
    log.add(name_key, "must be letters, digits and _, a letter first, is " + quoted(layer.name));
  if (layer.name == kFirstCloth) log.add(name_key, "must not be " + quoted(kFirstCloth) + ", which is the first cloth");
  if (!log.good(key)) return;
  ProblemLog own;
  checkCloth(layerScene(scene, number + 1), own);
  for (const Problem& problem : own.problems())
    log.add(problem.key.rfind("solver", 0) == 0 ? problem.key : joinKey(key, problem.key), problem.text);
  const auto sameAsFirst = [&](const char* name, int value, int first) {
    const std::string of_first = "cloth." + std::string(name), its = joinKey(key, of_first);
    if (value == first || !log.good(of_first) || !log.good(its)) return;
    log.add(its, "must be that of the first cloth, " + std::to_string(first) + ", is " + std::to_string(value));
  };
  sameAsFirst("rows", layer.cloth.rows, scene.cloth.rows);
  sameAsFirst("folds", layer.cloth.folds, scene.cloth.folds);
  if (layer.cloth.closed) log.add(joinKey(key, "cloth.closed"), "must be false: cloth beside others is not closed");
  if (layer.hang.start.file)
    log.add(joinKey(key, "hang.start.file"), "must not be given: the first cloth's has the nodes of all");
}

void checkLayers(const Scene& scene, ProblemLog& log) {
  if (scene.layers.empty()) return;
  checkUnique(scene.layers, "layers", "name", &LayerParams::name, log);
  for (std::size_t k = 0; k < scene.layers.size(); ++k) checkLayer(scene, k, log);
  if (!log.good("layers") || !log.good("cloth")) return;
  if (scene.cloth.closed) log.add("layers", "must be empty beside closed cloth (cloth.closed)");
  std::int64_t columns = scene.cloth.columns;
  for (const LayerParams& layer : scene.layers) columns += layer.cloth.columns;
  if (columns > kMaxColumns)
    log.add("layers", "must have " + std::to_string(kMaxColumns) + " columns at most with the first cloth's, has " +
                          std::to_string(columns));
  if (startsElsewhere(scene) && (!scene.lines.empty() || !scene.tie_back.empty()))
    log.add("layers", "can't start elsewhere (hang.start) with lines or tie-backs, which begin where the cloth hangs");
  const auto laid = [](const LayerParams& layer) { return layer.hang.start.over.has_value(); };
  const auto slides = [](const LayerParams& layer) { return !layer.rail.path.empty(); };
  if (scene.hang.start.file && std::any_of(scene.layers.begin(), scene.layers.end(), laid))
    log.add("hang.start.file", "must be the only start, it has the nodes of all layers");
  if (scene.hang.start.file && std::any_of(scene.layers.begin(), scene.layers.end(), slides))
    log.add("hang.start.file", "can't be given with a layer on a rail, whose carriers say where its edge is");
}

// Checks every value by itself, then some together.
template <typename Params, typename Check>
std::vector<Problem> problemsOf(const Params& params, const std::string& key, const Check& check) {
  ProblemLog log;
  RangeChecker checker(key, log);
  visitFields(checker, params);
  check(log);
  return log.problems();
}

}  // namespace

void checkNodeOnGrid(const NodeIndex& node, const ClothParams& cloth, const std::string& key, ProblemLog& log) {
  if (!log.good("cloth.rows") || !log.good("cloth.columns") || !log.good(key)) return;
  if (node.row >= 0 && node.row < cloth.rows && node.column >= 0 && node.column < cloth.columns) return;
  log.add(key, "must be [row, column] with row in [0, " + std::to_string(cloth.rows - 1) + "] and column in [0, " +
                   std::to_string(cloth.columns - 1) + "], is " + formatNode(node));
}

void checkScene(const Scene& scene, ProblemLog& log) {
  RangeChecker checker("", log);
  visitFields(checker, scene);
  checkCloth(scene, log);
  checkAir(scene.air, "air", log);
  checkLaw(scene, log);
  checkLayers(scene, log);
  ClothParams whole = scene.cloth;  // unless its size is wrong
  if (log.good("layers") && log.good("cloth"))
    whole = wholeCloth(scene);
  else
    whole.columns = kMaxColumns;
  checkLines(scene, whole, log);
  checkUnique(scene.lines, "lines", "id", &LineParams::id, log);
  checkUnique(scene.tie_back, "tie_back", "id", &TieBackParams::id, log);
  checkUnique(scene.wind, "wind", "id", &WindParams::id, log);
  checkUnique(scene.drag, "drag", "id", &DragParams::id, log);
  checkUnique(scene.obstacles, "obstacles", "name", &ObstacleParams::name, log);
  for (std::size_t i = 0; i < scene.wind.size(); ++i) checkWind(scene.wind[i], itemKey("wind", i), log);
  for (std::size_t i = 0; i < scene.drag.size(); ++i) checkDrag(scene.drag[i], whole, itemKey("drag", i), log);
  checkHands(scene, whole, log);
  for (std::size_t i = 0; i < scene.obstacles.size(); ++i) {
    checkObstacle(scene.obstacles[i], itemKey("obstacles", i), log);
  }
}

std::vector<Problem> validate(const Scene& scene) {
  ProblemLog log;
  checkScene(scene, log);
  return log.problems();
}

std::vector<Problem> validate(const WindParams& wind, const std::string& key) {
  return problemsOf(wind, key, [&](ProblemLog& log) { checkWind(wind, key, log); });
}

std::vector<Problem> validate(const DragParams& drag, const ClothParams& cloth, const std::string& key) {
  return problemsOf(drag, key, [&](ProblemLog& log) { checkDrag(drag, cloth, key, log); });
}

std::vector<Problem> validate(const AirParams& air, const std::string& key) {
  return problemsOf(air, key, [&](ProblemLog& log) { checkAir(air, key, log); });
}

std::vector<Problem> validate(const DriveParams& drive, const std::string& key) {
  return problemsOf(drive, key, [](ProblemLog&) {});
}

std::vector<Problem> validate(const SolverParams& solver, const std::string& key) {
  return problemsOf(solver, key, [](ProblemLog&) {});
}

std::vector<Problem> validate(const ContactParams& contact, const std::string& key) {
  return problemsOf(contact, key, [](ProblemLog&) {});
}

std::vector<Problem> validate(const ObstacleParams& obstacle, const std::string& key) {
  return problemsOf(obstacle, key, [&](ProblemLog& log) { checkObstacle(obstacle, key, log); });
}

}  // namespace curtain
