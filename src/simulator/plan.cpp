// SPDX-License-Identifier: BSD-3-Clause
//
// Not a plan that is followed: it asks the parts that decide in each frame what they would decide now.
#include "curtain_sim/plan.h"

#include "scene/ranges.h"
#include "simulator/simulator_impl.h"

namespace curtain {
namespace {

const char* wordsFor(ObstacleStanding standing) {
  if (standing == ObstacleStanding::kAbsent) return "absent";
  return standing == ObstacleStanding::kFar ? "away from the cloth: boxes are compared, nothing more"
                                            : "near: what of the cloth may touch it is searched";
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
  const bool pulls = motion.step.stringsPull();
  plan.push_back({"weft", true,
                  pulls ? "strings pull: all taut ones are solved for at once"
                        : "no string pulls: looked at, and nothing more unless one gets taut"});
  const bool estimates = ErrorControl::wanted(solver);
  plan.push_back({"estimate", estimates,
                  estimates ? "position_tolerance is asked for: a reference run moves for one second in four, as far "
                              "as the budget lets it"
                            : "no position_tolerance is asked for"});
  plan.push_back({"budget", budget.any(),
                  budget.any() ? formatNumber(solver.budget_ms) + " ms a frame" +
                                     (motion.statistics.shortened_frames > 0 ? "; frames have ended early" : "")
                               : "budget_ms is 0: frames take what they need"});
  const int threads = motion.workers.threads();
  const char* const alone =
      solver.threads == 1 ? "one was asked for" : "one: cloth of this size, or this machine, gains nothing by more";
  plan.push_back({"threads", threads > 1, threads > 1 ? std::to_string(threads) + " of them" : alone});
}

}  // namespace

Plan Simulator::plan() const {
  Impl& im = *impl_;
  im.motion.step.beginElastic();
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
  bool acts = false;
  for (const Part* const part : im.motion.parts.all)
    acts = part->explain(im.motion.state, im.motion.statistics.time, plan) || acts;
  plan.push_back(
      {"force field", acts, acts ? "weight and what is above" : "gravity alone: one acceleration for all nodes"});
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
