// SPDX-License-Identifier: BSD-3-Clause
#include "judge/court.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <limits>
#include <optional>
#include <sstream>

#include "clear_caches.h"
#include "curtain_sim/simulator.h"
#include "drawn/scene_maker.h"
#include "judge/held_crossings.h"
#include "testing.h"

namespace curtain_test {
namespace {

using namespace curtain;

// Twice the tolerance: motion through contact may leave so much.
constexpr double kToleranceShare = 2.0;
constexpr double kMaxSolves = 2000.0;
// Brute force looks at every frame, but of long trials of large cloth: at so many nodes in a trial, some 2 us each.
constexpr double kNodesLookedAt = 3e5;
// Leapfrog knows the energy of what turns or swings at omega to a share of (h omega)^2 / 4: the work of a rod whose
// force acts along its direction before. With h omega <= 1.7 that is 0.72 at most. Where more sets in than a step
// foresees, nothing less is promised, and of wild scenes nothing at all: it is in the table. Else what comes of it is
// of the first order at least: with steps of a sixteenth no more is left than what links may hide.
constexpr double kStepKnows = 0.72;
constexpr int kFiner = 16;
constexpr double kMaxFrames = 1e4;  // a second, that a scene may have
// Of the paper's rods, relative: they are rebuilt to rounding (5e-15 is measured), that of the places apart.
constexpr double kPaperRods = 1e-12;
// After a hand that may have pulled them apart [s]: links come back at the speed of a fall. But not from beyond this
// share of their length: cloth that is torn so far may jam.
constexpr double kComesBack = 0.5;
constexpr double kTorn = 0.1;
// A node deeper than this is inside [m]: a tenth of the thickness may lack, the rest is rounding.
constexpr double kInside = 1e-6;

// In finer steps, and with so much slower depenetration: what that puts into cloth that starts too near to itself falls
// with the square of its speed.
Scene withFrames(Scene scene, double times) {
  scene.solver.frame_rate = std::min(times * scene.solver.frame_rate, kMaxFrames);
  scene.contact.recovery_speed /= times;
  return scene;
}

class Court {
 public:
  /// finer: frames as many times as short.
  Court(const Drawn& drawn, const Rigour& rigour, int finer = 1)
      : drawn_(drawn),
        rigour_(rigour),
        finer_(finer),
        simulator_(withFrames(drawn.scene, finer), resolveTestMesh),
        carriers_(simulator_.carriers()),
        paper_(drawn.scene.solver.method == Method::kPaper),
        watch_(simulator_, 60 * static_cast<std::size_t>(finer)) {
    for (int i = 0; i < simulator_.rows(); ++i) {
      for (int j = 0; j < simulator_.columns(); ++j) {
        if (simulator_.pinned({i, j})) pins_.push_back({{i, j}, simulator_.position({i, j})});
        if (i > 0)
          shortest_rod_ =
              std::min(shortest_rod_, (simulator_.position({i, j}) - simulator_.position({i - 1, j})).norm());
      }
    }
    for (const LineParams& line : drawn.scene.lines) ends_.push_back(*simulator_.lineEnd(line.id));
    const Happenings& happenings = drawn.happenings;
    took_.resize(happenings.hands.size());
    taken_at_.resize(happenings.hands.size());
    pulls_known_ = handless() &&  // hands put in what they like
                   (pinsStay() || !linksStraightBetweenPins());
    every_ = std::max(1, static_cast<int>(simulator_.rows() * simulator_.columns() * drawn.seconds *
                                          drawn.scene.solver.frame_rate / kNodesLookedAt));
    simulator_.countWork(rigour.energy && !paper_);
    for (int o = 0; o < simulator_.obstacleCount(); ++o) {
      judged_.push_back(clear(o));
      places_.push_back(simulator_.obstaclePose(o));
    }
    crossings_judged_ = drawn.scene.contact.self && simulator_.selfCrossings() == 0;
  }

  /// Once more: interrupted by a snapshot in the middle, and with caches cleared at random.
  TrialVerdict run(bool once_more) {
    bool interrupted = !once_more;
    if (once_more) CacheClearing::atRandom(simulator_, drawn_.seed + 1);
    while (simulator_.time() < drawn_.seconds - 1e-9 && verdict_.faults.empty()) {
      if (!interrupted && simulator_.time() > 0.5 * drawn_.seconds) {
        interrupted = true;
        const std::string kept = simulator_.snapshot();
        Simulator other(drawn_.scene, resolveTestMesh);
        CacheClearing::atRandom(other, drawn_.seed + 2);
        const std::vector<Problem> problems = other.restore(kept);
        if (!problems.empty()) verdict_.fault("snapshot refused: " + describe(problems));
        simulator_ = std::move(other);
      }
      happen();
      const std::clock_t before = std::clock();
      simulator_.step();
      const double took = static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC;
      look();
      seconds_ += took;
      verdict_.seconds = seconds_;  // of the processor: what else runs does not count
      verdict_.slowest = slowest_ = std::max(slowest_, took);
      if (rigour_.max_seconds > 0.0 && verdict_.seconds > rigour_.max_seconds) {
        verdict_.fault("took longer than it may");
      }
    }
    verdict_.hash = simulator_.stateHash();
    return verdict_;
  }

 private:
  struct Pin {
    NodeIndex node;
    Vec3 place;
  };
  void happen() {
    const Happenings& happenings = drawn_.happenings;
    const double time = simulator_.time();
    const bool after = time >= happenings.at;
    if (after && !happened_) {
      happened_ = true;
      if (!happenings.gravity.isZero()) simulator_.setGravity(happenings.gravity);
      if (happenings.opening >= 0.0) simulator_.setOpening(happenings.opening);
      if (happenings.tie_back >= 0 && !drawn_.scene.tie_back.empty())
        simulator_.setTieBack(drawn_.scene.tie_back[0].id, happenings.tie_back == 1);
      if (happenings.other_rate > 0.0) simulator_.setFrameRate(std::min(finer_ * happenings.other_rate, kMaxFrames));
    }
    for (std::size_t k = 0; k < happenings.hands.size(); ++k) moveHand(k);
    if (pinsStay()) return;
    const double frame = 1.0 / simulator_.scene().solver.frame_rate;
    Vec3 move = std::sin(2.0 * kPi * happenings.pin_frequency * (time + frame)) * happenings.pin_swing;
    if (after)
      move +=
          (finer_ == 1 ? 1.0 : std::min(1.0, (time + frame - happenings.at) / (finer_ * frame))) * happenings.pin_jerk;
    for (const Pin& pin : pins_) simulator_.movePin(pin.node, pin.place + move);
    for (std::size_t k = 0; k < drawn_.scene.lines.size(); ++k)  // with the pins, or lines would be drawn apart
      simulator_.setLineEnd(drawn_.scene.lines[k].id, ends_[k] + move);
  }

  void moveHand(std::size_t index) {
    const Hand& hand = drawn_.happenings.hands[index];
    const std::string id = "hand" + std::to_string(index);
    const double frame = 1.0 / simulator_.scene().solver.frame_rate, time = simulator_.time();
    if (time >= hand.until) simulator_.releaseGrasp(id);
    if (time < hand.from || time >= hand.until) return;
    if (!took_[index]) {
      took_[index] = true;
      taken_at_[index] = simulator_.position(hand.node);
      GraspParams grasp;
      grasp.id = id;
      grasp.frame.position = taken_at_[index];
      grasp.radius = hand.radius;
      if (hand.stiffness > 0.0) grasp.stiffness = hand.stiffness;
      if (hand.pinch_force > 0.0) grasp.pinch_force = hand.pinch_force;
      if (hand.break_force > 0.0) grasp.break_force = hand.break_force;
      simulator_.setGrasp(grasp);  // refused where everything is held
    }
    const double phase = std::sin(2.0 * kPi * hand.frequency * (time + frame - hand.from));
    const Vec3 axis = hand.swing.isZero() ? Vec3(Vec3::UnitZ()) : Vec3(hand.swing.normalized());
    simulator_.moveGrasp(id,
                         {taken_at_[index] + phase * hand.swing, Rotation(Eigen::AngleAxisd(phase * hand.turn, axis))});
  }

  // A hand that does not give can pull the cloth apart, and push it through what is in its way. Links that it has
  // pulled too long come back within a while.
  void lookAtHands() {
    const auto look = [&](const std::string& id, bool gives) {
      const auto state = simulator_.graspState(id);
      if (gives || !state || state->nodes.empty()) return;
      const Statistics& s = simulator_.statistics();
      const bool torn = std::max(s.warp_stretch, s.weft_stretch) > kTorn;
      forced_until_ =
          std::max(forced_until_, torn ? std::numeric_limits<double>::infinity() : simulator_.time() + kComesBack);
      std::fill(judged_.begin(), judged_.end(), false);
    };
    const std::vector<Hand>& hands = drawn_.happenings.hands;
    for (std::size_t k = 0; k < hands.size(); ++k)
      look("hand" + std::to_string(k), hands[k].stiffness > 0.0 || hands[k].pinch_force > 0.0);
    for (const HandParams& hand : drawn_.scene.hands)
      look(hand.grasp.id, std::isfinite(hand.grasp.stiffness) || std::isfinite(hand.grasp.pinch_force));
  }
  bool pinsStay() const { return drawn_.happenings.pin_swing.isZero() && drawn_.happenings.pin_jerk.isZero(); }
  bool handless() const { return drawn_.happenings.hands.empty() && drawn_.scene.hands.empty(); }

  // Links drawn straight between two pins of a column or row: what they pull has no one answer, so the work of pins
  // that move has none.
  bool linksStraightBetweenPins() const {
    const double tolerance = kToleranceShare * drawn_.scene.solver.stretch_tolerance;
    const auto straight = [&](const Pin& from, int down, int right) {
      double links = 0.0;
      NodeIndex last = from.node;
      for (NodeIndex node{last.row - down, last.column - right}; node.row >= 0 && node.column >= 0;
           node.row -= down, node.column -= right) {
        links += (simulator_.position(node) - simulator_.position(last)).norm();
        last = node;
        if (!simulator_.pinned(node)) continue;
        const bool apart = from.node.row - node.row + from.node.column - node.column > 1;
        return apart && (simulator_.position(node) - from.place).norm() > (1.0 - tolerance) * links;
      }
      return false;
    };
    return std::any_of(pins_.begin(), pins_.end(),
                       [&](const Pin& pin) { return straight(pin, 1, 0) || straight(pin, 0, 1); });
  }

  bool clear(int obstacle) const {
    const Piercings found = simulator_.piercings(obstacle, kInside);
    return found.nodes + found.edges + found.faces == 0;
  }

  bool pinsStand() const { return carriers_.empty() && pinsStay(); }

  // A pin is so near, here or on the way here, that what hangs on it may have no room. Where both stand there is the
  // room that there was at the start.
  bool reachesPins(int obstacle) const {
    const Pose &from = places_[static_cast<std::size_t>(obstacle)], &to = simulator_.obstaclePose(obstacle);
    const ClothParams& cloth = drawn_.scene.cloth;
    const double gap = 2.0 * drawn_.scene.contact.thickness;
    const double links = 2.0 * (cloth.height / (cloth.rows - 1) + cloth.width / (cloth.columns - 1));
    const double way = (to.position - from.position).norm();
    const bool stands = way == 0.0 && to.orientation.coeffs() == from.orientation.coeffs();
    const double near = stands && pinsStand() ? gap : links + gap;
    const int looks = static_cast<int>(std::clamp(way / near, 1.0, 1000.0));
    for (int look = 1; look <= looks; ++look) {
      const double share = static_cast<double>(look) / looks;
      if (isNearPins(
              obstacle,
              {from.position + share * (to.position - from.position), from.orientation.slerp(share, to.orientation)},
              near))
        return true;
    }
    return false;
  }
  bool isNearPins(int obstacle, const Pose& pose, double distance) const {
    const ObstacleShape& shape = simulator_.obstacleShape(obstacle);
    const auto isNear = [&](NodeIndex node) {
      const Vec3 local = pose.orientation.conjugate() * (simulator_.position(node) - pose.position);
      SurfacePoint surface;
      return shape.query(local, local, distance, surface) && surface.distance < distance;
    };
    return std::any_of(pins_.begin(), pins_.end(), [&](const Pin& pin) { return isNear(pin.node); }) ||
           std::any_of(carriers_.begin(), carriers_.end(), isNear);
  }
  // Which obstacles can still be judged.
  void lookAtObstacles() {
    for (int o = 0; o < simulator_.obstacleCount(); ++o) {
      const auto at = static_cast<std::size_t>(o);
      if (judged_[at] && (reachesPins(o) || meetsAnother(o))) judged_[at] = false;
      places_[at] = simulator_.obstaclePose(o);
    }
  }

  // Cloth between two obstacles that meet has no room.
  bool meetsAnother(int obstacle) const {
    const auto reachOf = [&](int o) { return simulator_.obstacleShape(o).bounds().sizes().norm(); };
    for (int other = 0; other < simulator_.obstacleCount(); ++other) {
      if (other == obstacle) continue;
      const bool swap = !std::isfinite(reachOf(other));
      const int seen = swap ? obstacle : other, from = swap ? other : obstacle;
      if (!std::isfinite(reachOf(seen))) continue;
      const Pose &at = simulator_.obstaclePose(seen), &pose = simulator_.obstaclePose(from);
      const Vec3 middle = at.position + at.orientation * simulator_.obstacleShape(seen).bounds().center();
      const Vec3 local = pose.orientation.conjugate() * (middle - pose.position);
      const double limit = 0.5 * reachOf(seen) + 4.0 * drawn_.scene.contact.thickness;
      SurfacePoint surface;
      if (simulator_.obstacleShape(from).query(local, local, limit, surface) && surface.distance < limit) return true;
    }
    return false;
  }

  // Between two pins of a column one pass can't keep every rod, nor where something touches; and where it stopped pins
  // have gone on.
  void lookAtPaper(const Statistics& s) {
    const Scene& scene = drawn_.scene;
    if (scene.contact.self || !scene.obstacles.empty() || scene.pins.kind == PinKind::kList || s.stops > 0) return;
    double farthest = 0.0;
    for (int j = 0; j < simulator_.columns(); ++j) {
      for (int i = 0; i < simulator_.rows(); ++i) farthest = std::max(farthest, simulator_.position({i, j}).norm());
    }
    // 4 kEps: eight roundings of places, by half of kEps each. Besides, a pin that moves is rounded in every substep of
    // its way to where it is put at the frame's end.
    const double roundings = 8.0 + (pinsStay() && scene.pins_motion.empty() ? 0.0 : s.substeps_last);
    verdict_.atMost(kPaperRods + 0.5 * roundings * kEps * farthest / shortest_rod_, "rods of paper",
                    std::max(s.warp_stretch, s.warp_compression));
  }

  // Cloth that is crossed stays so: from then on it is not judged.
  void lookAtCrossings() {
    if (!drawn_.scene.contact.self) return;
    ++verdict_.crossings;
    if (crossings_judged_ && simulator_.selfCrossings() > 0) {
      crossings_judged_ = !heldPartsCross(simulator_);
      if (crossings_judged_) verdict_.fault("crosses itself");
    }
    if (!crossings_judged_) ++verdict_.crossings_excused;
  }

  void look() {
    const Statistics& s = simulator_.statistics();
    watch_.look(simulator_, verdict_);
    lookAtHands();
    const bool forced = simulator_.time() <= forced_until_;
    if (paper_ && handless())
      lookAtPaper(s);
    else if (!paper_ && forced)
      ++verdict_.links_excused;
    else if (!paper_)
      verdict_.atMost(kToleranceShare * drawn_.scene.solver.stretch_tolerance, "stretch", worstLink(s));
    verdict_.atMost(kMaxSolves, "solves in a frame", static_cast<double>(verdict_.max_solves));
    if (rigour_.energy || rigour_.brute_force) lookAtObstacles();
    // Cloth that is jammed is pushed at by no known force.
    const bool free = std::all_of(judged_.begin(), judged_.end(), [](bool judged) { return judged; });
    verdict_.obstacles_excused += std::count(judged_.begin(), judged_.end(), false);
    verdict_.obstacles += static_cast<std::int64_t>(judged_.size());
    if (rigour_.energy && !paper_ && free && pulls_known_) {
      ++verdict_.energy_judged;
      watch_.lookAtEnergy(simulator_, !drawn_.happenings.gravity.isZero(), verdict_);
    }
    if (!rigour_.brute_force || s.frames % every_ != 0) return;
    ++verdict_.brute_forced;
    lookAtCrossings();
    for (int o = 0; o < simulator_.obstacleCount(); ++o) {
      if (judged_[static_cast<std::size_t>(o)] && !clear(o))
        verdict_.fault("pierced by " + drawn_.scene.obstacles[static_cast<std::size_t>(o)].name);
    }
  }

  const Drawn& drawn_;
  const Rigour rigour_;
  const int finer_;
  Simulator simulator_;
  std::vector<Pin> pins_;
  std::vector<NodeIndex> carriers_;  // of the rail, across which they can't give way either
  std::vector<Vec3> ends_;           // of the lines at the start [m]
  std::vector<bool> judged_;  // by obstacle: the cloth started clear of it, and it has met no pin or carrier, which
                              // can't give way, and no other
  std::vector<Pose> places_;  // by obstacle, a frame ago
  const bool paper_;
  double shortest_rod_ = std::numeric_limits<double>::infinity();  // [m]
  Watch watch_;
  bool crossings_judged_ = false;  // the cloth started clear of itself, and no held parts of it have met
  bool happened_ = false;
  bool pulls_known_ = true;
  int every_ = 1;
  std::vector<bool> took_;                // by hand
  std::vector<Vec3> taken_at_;            // the same [m]
  double forced_until_ = -1.0;            // [s]
  double seconds_ = 0.0, slowest_ = 0.0;  // of the processor, for all frames and for the slowest [s]
  TrialVerdict verdict_;
};

}  // namespace

TrialVerdict judge(const Drawn& drawn, const Rigour& rigour) {
  if (!validate(drawn.scene).empty()) {
    TrialVerdict verdict;
    verdict.faults.push_back("no scene: " + describe(validate(drawn.scene)));
    return verdict;
  }
  TrialVerdict verdict = Court(drawn, rigour).run(false);
  const double links_hide = kSchemeGain + slackGain(kToleranceShare * drawn.scene.solver.stretch_tolerance);
  const double max_gain = drawn.kind == Kind::kEveryday ? links_hide
                          : drawn.kind == Kind::kSudden ? kStepKnows
                                                        : std::numeric_limits<double>::infinity();
  // Cloth that stays where it is for a while has links that can't hold: these pull by no known force.
  if (verdict.holds() && verdict.stops == 0 && !(verdict.energy_gain <= max_gain)) {
    Rigour of_energy;
    of_energy.brute_force = false;
    of_energy.max_seconds = kFiner * rigour.max_seconds;
    verdict.energy_finer = Court(drawn, of_energy, kFiner).run(false).energy_gain;
    if (!(verdict.energy_finer <= max_gain)) {
      std::ostringstream text;
      text << "energy " << verdict.energy_gain << ", in steps of a " << kFiner << "th " << verdict.energy_finer;
      verdict.faults.push_back(text.str());
    }
  }
  if (verdict.holds() && rigour.repeats) {
    Rigour again = rigour;
    again.brute_force = again.energy = false;
    if (Court(drawn, again).run(true).hash != verdict.hash) verdict.faults.push_back("other bits after a snapshot");
  }
  return verdict;
}

}  // namespace curtain_test
