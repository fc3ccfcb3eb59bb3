// SPDX-License-Identifier: BSD-3-Clause
//
// The constants of the exact schemes: purpose, origin and effect of each. Shares and factors have no unit. Constants of
// the line solvers' arithmetic (smallest pivots, block widths) are where they are used.
#pragma once

namespace curtain {

// ---- Sweeps: convergence and step length

// Tolerance used inside the solver, as a share of the user's: what the last half-sweep disturbs must still fit.
constexpr double kInnerTolerance = 0.5;
// Share of the user's tolerance that the compliance of links may take.
constexpr double kMaxGive = 0.2;
// Share of the tolerance below which strings and contacts are not corrected in the first sweep. Far below 1: a link
// that drifts through the whole tolerance and is then corrected at once gets a velocity jump.
constexpr double kFirstSweepShare = 1e-4;
// Newton stops at an iteration that starts with this relative residual: convergence is quadratic, so it ends near the
// square of it (times a factor that grows with the column's height).
constexpr double kNewtonStop = 1e-3;
// The same where strings pull and in later sweeps, where the next sweep checks again. Smaller values make rods that
// strings shake gain energy: vibrating pins, a hem 1e6 times as heavy (test/stress).
constexpr double kNewtonStopLater = 1e-2;
// The same for SubstepPlan::precise: only rounding is left.
constexpr double kPreciseStop = 1e-7;
constexpr int kNewtonIterations = 12;
// Share of the tolerance within which a block of columns is not solved again in a later sweep.
constexpr double kLeaveAlone = 0.1;
// A relative violation beyond this is a failed step: slow convergence starts nearer.
constexpr double kMaxViolation = 4.0;
// Conjugate gradients stop at this share of the initial residual, or of the tolerance. Without contact they go on to
// the square of the relative residual, which is the accuracy of the linearisation, and the active set changes
// meanwhile: a sweep is then a Newton step. (Not in the last resort, where a row between vibrating pins gains energy by
// it.)
constexpr double kReduction = 0.3;
// The same with contact. At 0.3 cloth resting on a ball trembles at 1 mm/s.
constexpr double kContactReduction = 0.05;
constexpr int kGradientIterations = 12;
// A sweep that would move a node by more than this share of a link is scaled down to it: larger moves leave the range
// of the linearisation.
constexpr double kLargestMove = 0.1;
constexpr double kWatchMoves = 1e-3;  // relative violation below which no solve can exceed kLargestMove
// Sweeps of a substep that turn the slides of contacts that may slip. In later ones a slide only goes with what pushes.
// Without an end some would turn to and fro, and every turn disturbs the links. Where links follow there is none: there
// a substep does not start with the last one's pushes, and a strap over a bar would slip at half of what it holds.
constexpr int kFrictionSweeps = 3;
// The residual turns into motion, so the tolerance of contacts follows the motion: this share of the displacement of
// nodes in the substep (RMS, relative to their mean), at most kMaxTouch contact tolerances; more would save no sweeps.
// Not in the last resort: objects thrown at cloth at 50 m/s pierced it.
constexpr double kShareOfPath = 0.01;
constexpr double kMaxTouch = 4.0;
// Cloth at rest on something moves little: the first sweeps aim at this share of the tolerance. With 6 of them fewer
// limp drapes come to rest. Fewer than kStallWindow.
constexpr double kStrictShare = 0.2;
constexpr int kStrictSweeps = 12;
constexpr int kStrictSweepsOfLinks = 6;  // where nothing touches
// Where strings pull and substeps are short, the tolerance of a link exceeds the displacement by weight, and a flat net
// amplifies it tenfold across the strings: it would never come to rest. So the aim is this share of the displacement by
// weight, but at least kMinShare of the tolerance.
constexpr double kShareOfWeight = 0.3;
constexpr double kMinShare = 0.01;
// The same for the last resort, whose substeps are long. 1: taut sheets never come to rest. 0.01: rows drawn straight
// rise by as much as they may sag, without energy to pay for it.
constexpr double kLastResortShare = 0.1;
// The solve has stalled when the residual after a window of sweeps is more than this factor of that before.
constexpr int kStallWindow = 16;
constexpr double kStallFactor = 0.8;
// Levenberg-Marquardt term of the strings' solve, relative to the diagonal: proportional to the residual, so that it
// vanishes at convergence. A constant term makes near-singular combinations converge by only a few percent a sweep.
constexpr double kDampingPerResidual = 0.05;
// Its bound where sweeps are not undone. With 1e3 sweeps creep to another configuration within the tolerance: a sheet
// held by one pin gained 0.36 m g H (test/judge/cases/everyday_700040.yaml).
constexpr double kLargestDamping = 0.1;
// Its bound in the last resort, whose sweeps must reduce the sum of squares: if a step a thousand times shorter than
// Jacobi's does not, the solve has stalled.
constexpr double kMaxDamping = 1e3;
// Change of the damping after a sweep that made things worse, and after one that improved them.
constexpr double kDampingGrowth = 8.0;
constexpr double kDampingShrink = 2.0;

// ---- Substeps: verification and energy

// Largest motion of a touched obstacle's surface in a substep, over the shortest link: with more, the solve could not
// bring links to their lengths.
constexpr double kMaxSurfaceMotion = 0.2;
// Largest angle by which the normal of what pushes turns in a substep [rad]: impulses act along those of its start. Of
// 128 places of a bar at 10 to 50 revolutions a second 11 gave the cloth up to 0.24 m g H too much. With this, and what
// arrives moving no further than the distance that it is kept at, none gives more than 3e-4. Of 900 strips that slide
// off edges and bars none gains; with twice the angle 2 do, up to 0.03 m g L.
constexpr double kMaxTurn = 0.125;
// A substep this many times as long as these ask for is made again.
constexpr double kTooLong = 2.0;
// Ratio of kinetic energies, with and without the work of links, above which the links are assumed to have jumped to
// another configuration. Otherwise links only take energy out, but leapfrog's energy wavers by the square of the angle
// that links turn by: 0.03 at 0.17 rad. An excess that a shorter step would not reduce is taken out of the velocities
// instead.
constexpr double kMaxAdded = 1.03;
// Share of the tolerance that LastResort::bound() fills: the rest is for rounding of lengths.
constexpr double kBoundShare = 1.0 - 1e-6;
// Positions beyond this [m] count as diverged: damping takes the cube of a speed and energy the square times a mass,
// and the next substep would go further.
constexpr double kBeyond = 1e60;

// ---- Last resort

// Trust radius after the first failure, in links: a link may turn by about half a radian. Other values were not tried.
constexpr double kFirstReach = 0.5;
// Factors of the trust radius after a failed substep and after a converged one. It shrinks fast, since stopped substeps
// lose momentum, and grows slowly, since a failure costs three quarters of it. Other values were not tried.
constexpr double kReachShrink = 0.25;
constexpr double kReachGrowth = 1.2;
// Trust radius, in links, from which the scheme's own substeps are tried again.
constexpr double kUnbounded = 2.0;
// Least trust radius: nodes move by a hundredth of the links' tolerance, so there is nothing left to solve.
constexpr double kMinReach = 1e-5;
// Links that exceed their bound by this factor at the start of a path were pulled there by pins that moved apart, or
// put there by setState(). Then any result counts that is not worse than kForcedGrowth times the start.
constexpr double kForced = 10.0;
constexpr double kForcedGrowth = 2.0;

// ---- Velocities at the time of the positions

// Most rounds of the linear velocity projection; it ends earlier when the constraint rates are down to
// kVelocityReduction. More than two without contact make rows between vibrating pins gain energy.
constexpr int kVelocityRounds = 2;
constexpr int kContactRounds = 8;  // with contact, whose rows are damped
constexpr double kVelocityReduction = 1e-3;
constexpr double kVelocityDamping = 1e-4;
constexpr int kVelocityIterations = 24;

// ---- Step control

// h * omega_max that substeps are chosen for. Leapfrog is stable below 2; 1.7 leaves room for tensions to grow by a
// factor of 1.4 within a substep. Faster growth is caught by mass scaling.
constexpr double kPhasePerStep = 1.7;
// Mass scaling: where a few nodes alone ask for short substeps (the corners a sheet hangs by), their inertia is
// increased, by at most this share of the cloth's mass in total. A sheet of 44 x 40 hung by two corners takes 12
// substeps a frame with it and 22 without.
constexpr double kMassScalingShare = 0.02;
// h * omega at which mass scaling sets in, below leapfrog's limit of 2. At 1.7 a swing in two fixed substeps
// gains 2.5e-2 of its energy in 20 s.
constexpr double kStablePhase = 1.9;
// Factor on kPhasePerStep, kStablePhase and kLongestPhase for cloth with lines or tie-backs (Grid::end_rows). A load
// keeps its lines as taut as its weight, so that transverse oscillations reach the bound of h * omega. Where the energy
// has to be bounded, a substep loses its velocities; what is left, x' = (1 - (h omega)^2) x, is stable only for
// h * omega below sqrt(2). With 1 a load of 25 times the cloth's mass shook.
constexpr double kShareWithEnds = 0.73;
// h * turning rate that substeps are chosen for where only rods act and the motion is smooth. Leapfrog's error is about
// (h * turning)^2 / 24 of the displacement: 1 mm in 5 m at 0.07. Chains of 2 m then end a second's fall with 0.2 to 0.9
// mm (RMS) for any number of rods. The cost of smooth motion is inversely proportional to it.
constexpr double kTurnPerStep = 0.07;
// h * omega for the reference run of the error estimate.
constexpr double kLongestPhase = 1.8;
// Finding the step for mass scaling costs as much as a sweep, so substeps longer than this share of a frame are kept.
constexpr double kWorthScaling = 0.25;
// After kGoodToGrow accepted substeps the limit from rejections grows by this factor.
constexpr double kLimitGrowth = 1.4;
constexpr int kGoodToGrow = 8;
// Substeps of implicit with `substeps: auto`: only accuracy limits its step.
constexpr int kImplicitSubsteps = 8;
// What elastic forces may take of h^2 omega^2 at least, where tensions take all that they may: up to leapfrog's limit.
constexpr double kMinForElastic = 4.0 - kStablePhase * kStablePhase;
// What tensions may take of it at least, where steps can't follow explicit elastic forces. 1: a node whose links and
// cells are at their bounds alike.
constexpr double kMinForTensions = 1.0;
// The same as kMinForElastic where links follow, which then take none. There they act where the step leads to, which
// is stable below 4 / 3; at 1 a line that gives way takes backward Euler's step.
constexpr double kElasticBackward = 1.0;
// The same of the paper's scheme. First order: 27 mm after a second of a swing of 43 rods. Its weft overlength falls
// with the number of passes: 0.5 at most for a flag in the wind, 1.8 at 4 substeps. Its energy is bounded at any
// number.
constexpr int kPaperSubsteps = 16;
// With a computing budget substeps may be longer by this factor; beyond it their solve costs all that is saved.
constexpr double kMaxStretch = 2.0;
// A fixed substep that fails is divided by at most this before the last resort takes over.
constexpr int kRoomBelowFixed = 16;
// Substeps a frame of the last resort; the bound motion converges at any step. Of 8 to 128, on 40 wild scenes, 8 take
// the least time and stop the cloth least often. Fewer would slow it down: it moves two links a substep at most.
constexpr int kLastResortSubsteps = 8;

// ---- Friction

// A contact that stuck in the last substep with less than this share of the friction bound is solved for as sticking.
// Those nearer to it may slip: their slide is turned against the slip, and goes with what pushes.
constexpr double kSticksBelow = 0.5;
// Slip of a sticking contact in a substep, as a share of its penetration tolerance; the next substep corrects it.
constexpr double kStickShare = 0.25;

// ---- Contact rows

// Least damping of contact rows, relative to the diagonal. Many contacts are nearly redundant; solved exactly, some
// would pull so that others can push.
constexpr float kMinDamping = 0.2F;

}  // namespace curtain
