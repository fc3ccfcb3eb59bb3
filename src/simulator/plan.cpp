// SPDX-License-Identifier: BSD-3-Clause
//
// Not a plan that is followed: it asks the parts that decide in each frame what they would decide now.
#include "curtain_sim/plan.h"

#include <sstream>

#include "simulator/simulator_impl.h"

namespace curtain {
namespace {

std::string number(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

template <typename Source>
std::string whenItActs(const Source& source, double time) {
  if (time < source.start) return "begins at " + number(source.start) + " s";
  if (time >= source.end) return "ended at " + number(source.end) + " s";
  return "";
}

PlanEntry planOf(const WindParams& wind, double time, bool reaches) {
  PlanEntry entry{"wind '" + wind.id + "'", false, whenItActs(wind, time)};
  if (!entry.why.empty()) return entry;
  if (wind.pressure + wind.node_force + wind.unsteadiness <= 0.0) {
    entry.why = "has no pressure";
    return entry;
  }
  entry.runs = reaches;
  if (!reaches)
    entry.why = "reaches nothing of the cloth";
  else
    entry.why =
        wind.unsteadiness > 0.0 ? "reaches the cloth, with gusts" : "reaches the cloth; no gusts, so no random numbers";
  return entry;
}

PlanEntry planOf(const DragParams& drag, double time) {
  PlanEntry entry{"drag '" + drag.id + "'", false, whenItActs(drag, time)};
  entry.runs = entry.why.empty();
  if (entry.runs) entry.why = drag.target ? "pulls by a spring" : "pulls";
  return entry;
}

const char* wordsFor(ObstacleStanding standing) {
  switch (standing) {
    case ObstacleStanding::kAbsent:
      return "absent";
    case ObstacleStanding::kFar:
      return "away from the cloth: boxes are compared, nothing more";
    case ObstacleStanding::kNear:
      return "near: what of the cloth may touch it is searched";
  }
  return "";
}

void planForces(const Motion& motion, Plan& plan) {
  const ForceField& forces = motion.forces;
  const double time = motion.statistics.time;
  bool windy = false, acts = false, normals = false;
  if (forces.winds().empty()) plan.push_back({"winds", false, "there are none"});
  if (forces.drags().empty()) plan.push_back({"drags", false, "there are none"});
  for (const WindParams& wind : forces.winds()) {
    plan.push_back(planOf(wind, time, forces.reaches(wind.id, time, motion.state.position)));
    windy = windy || plan.back().runs;
    normals = normals || (plan.back().runs && wind.pressure + wind.node_force > 0.0);
  }
  for (const DragParams& drag : forces.drags()) {
    plan.push_back(planOf(drag, time));
    acts = acts || plan.back().runs;
  }
  plan.push_back({"normals", normals, normals ? "a wind needs them, in the rows it reaches" : "no wind reads them"});
  const bool relative = forces.readsPulls(), blows = relative && !forces.ambient().still();
  const char* const ambient = !blows                     ? "the air around is still"
                              : forces.ambient().gusty() ? "blows everywhere, with gusts"
                                                         : "blows everywhere; no gusts, so no table of them";
  plan.push_back({"ambient wind", blows, ambient});
  plan.push_back({"relative air", relative,
                  relative ? "the force of the air's velocity relative to the cloth, with normals of all rows"
                           : "another law is asked for (air.law), or no drag"});
  const bool damps = !relative && forces.dampingPerMass() > 0.0;
  plan.push_back({"air damping", damps,
                  damps ? "by " + number(forces.dampingPerMass()) + " 1/s at most" : "all coefficients are 0"});
  plan.push_back(
      {"force field", windy || acts || relative,
       windy || acts || relative ? "weight and what is above" : "gravity alone: one acceleration for all nodes"});
}

void planContact(const Motion& motion, Plan& plan) {
  const Scene& scene = motion.scene;
  for (int index = 0; index < motion.obstacles.count(); ++index) {
    const ObstacleStanding standing = motion.contact.standing(index, motion.state.position);
    plan.push_back({"obstacle '" + scene.obstacles[static_cast<std::size_t>(index)].name + "'",
                    standing == ObstacleStanding::kNear, wordsFor(standing)});
  }
  if (scene.obstacles.empty()) plan.push_back({"obstacles", false, "there are none"});
  plan.push_back({"self-contact", scene.contact.self,
                  scene.contact.self ? "but not where the cloth is provably flat" : "contact.self is false"});
}

void planSolver(const Motion& motion, const Budget& budget, Plan& plan) {
  const SolverParams& solver = motion.scene.solver;
  const std::string substeps =
      solver.substeps > 0 ? std::to_string(solver.substeps) + " substeps a frame" : "substeps from the tensions";
  plan.push_back({"warp", true, toString(solver.method) + ", " + substeps});
  const Bending& bending = motion.bending;
  const char* const bends = bending.gives() ? "where lines are stiffer than the substeps bear, nodes give way"
                                            : "explicit: substeps bear all of its stiffness";
  plan.push_back({"bending", bending.any(), bending.any() ? bends : "bending_warp and bending_weft are 0"});
  const bool pulls = motion.exact.stringsPull();
  plan.push_back({"weft", true,
                  pulls ? "strings pull: all taut ones are solved for at once"
                        : "no string pulls: looked at, and nothing more unless one gets taut"});
  const std::size_t carriers = motion.carriers.all().size();
  const bool draws = motion.carriers.drive().draws;
  plan.push_back({"rail", carriers > 0,
                  carriers == 0 ? "there is none"
                                : std::to_string(carriers) + " carriers slide" +
                                      (draws ? ", and the drive draws them" : "; the drive has let go")});
  const CordsPattern& cords = motion.pattern.cords;
  plan.push_back({"lines", !cords.empty(),
                  cords.empty() ? "there are none"
                                : std::to_string(cords.cords.size()) + " cords of " +
                                      std::to_string(cords.ends.size() - cords.loops.size()) + " lines and " +
                                      std::to_string(cords.loops.size()) + " tie-backs"});
  const bool estimates = ErrorControl::wanted(solver);
  plan.push_back(
      {"estimate", estimates,
       estimates ? "position_tolerance is asked for: a companion moves one second in four, as far as the budget lets it"
                 : "no position_tolerance is asked for"});
  plan.push_back({"budget", budget.any(),
                  budget.any() ? number(1e3 * budget.seconds()) + " ms a frame" +
                                     (motion.statistics.shortened_frames > 0 ? "; frames have ended early" : "")
                               : "budget_ms is 0: frames take what they need"});
  const int threads = motion.workers.threads();
  const char* const alone =
      solver.threads == 1 ? "one was asked for" : "one: cloth of this size, or this machine, gains nothing by more";
  plan.push_back({"threads", threads > 1, threads > 1 ? std::to_string(threads) + " of them" : alone});
}

}  // namespace

Plan Simulator::plan() const {
  const Impl& im = *impl_;
  Plan plan;
  const bool sleeps = im.sleep.asleep();
  if (im.scene.solver.rest_speed <= 0.0) {
    plan.push_back({"rest", false, "rest_speed is 0: the cloth never sleeps"});
  } else if (im.scene.gravity.isZero()) {
    plan.push_back({"rest", false, "no gravity: the cloth never sleeps"});
  } else if (!im.sleep.rest().can()) {
    plan.push_back({"rest", false, "fewer than 20 frames a second: the cloth never sleeps"});
  } else {
    plan.push_back({"rest", true,
                    sleeps ? "the cloth sleeps: nothing below runs until something wakes it"
                           : "the cloth falls asleep when it has stayed in place for half a second"});
  }
  planForces(im.motion, plan);
  planSolver(im.motion, im.budget, plan);
  planContact(im.motion, plan);
  plan.push_back({"fine mesh", false, "made when it is asked for"});
  for (PlanEntry& entry : plan) {
    if (!sleeps || !entry.runs || entry.stage == "rest") continue;
    entry.runs = false;
    entry.why = "the cloth sleeps";
  }
  return plan;
}

std::string describe(const Plan& plan) {
  std::string text;
  for (const PlanEntry& entry : plan) text += (entry.runs ? "+ " : "- ") + entry.stage + ": " + entry.why + "\n";
  return text;
}

}  // namespace curtain
