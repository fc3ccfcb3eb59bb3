// SPDX-License-Identifier: BSD-3-Clause
//
// The constants of the exact schemes, in one table: what each is for, where it comes from and what changes with it.
// Shares and factors have no unit. Those of a line solver's arithmetic (smallest pivots, widths of blocks) stand where
// they are used.
#pragma once

namespace curtain {

// ---- Sweeps: when a solve has done enough, and how far a step of it may go
// -------------------------------------------

// The tolerance inside: what the last half-sweep stirs up again must still fit below the user's.
constexpr double kInnerTolerance = 0.5;
// Share of the tolerance below which the weft is not touched in a substep's first sweep. Far smaller than 1: a link
// left to drift through the tolerance and then pulled back at once would be kicked.
constexpr double kFirstSweepShare = 1e-4;
// Newton converges quadratically: an iteration that starts this close ends near the square of it, times a factor that
// grows with the column's height.
constexpr double kNewtonStop = 1e-3;
// Where strings pull and in later sweeps the next one looks again, so a start this close is left at that. Closer, rods
// that strings shake gain energy: pins that vibrate, a hem 1e6 times as heavy (test/stress).
constexpr double kNewtonStopLater = 1e-2;
// For what is left to be rounding.
constexpr double kPreciseStop = 1e-7;
constexpr int kNewtonIterations = 12;
// Share of the tolerance below which a block of columns is not solved again in a later sweep.
constexpr double kLeaveAlone = 0.1;
// A relative violation beyond this is a step that failed, not one that converges slowly: what it converges to lies
// elsewhere.
constexpr double kMostViolation = 4.0;
// Conjugate gradients go on until the residual is this share of what it was, or of the tolerance. Without contact,
// whose rows are damped, they go on to what their first-order picture is worth, the square of the relative residual,
// and strings leave and join meanwhile: a sweep is a step of Newton's. (In the last resort a row between trembling pins
// gains energy by that.)
constexpr double kReduction = 0.3;
// In contact along given directions, which are not linearised anew: to this share. At 0.3 what lies on a ball trembles
// by 1 mm/s.
constexpr double kContactReduction = 0.05;
constexpr int kGradientIterations = 12;
// A sweep that moves a node by more than this share of a link at once is cut back to it [1].
constexpr double kLargestMove = 0.1;
constexpr double kWatchMoves = 1e-3;  // relative violation below which no solve moves a node too far
// Friction takes turns with the solve, for so many sweeps: what sticks under load converges over the substeps, its
// multipliers carry over.
constexpr int kRubSweeps = 3;
// What is left over becomes motion, so contact is aimed at in proportion to the motion: to this share of the way that
// nodes go in the substep (RMS, past their mean), but no further than so many tolerances, beyond which there are no
// fewer sweeps. Never in the last resort: what is thrown at cloth at 50 m/s pierced it.
constexpr double kShareOfPath = 0.01;
constexpr double kMostTouch = 4.0;
// Cloth that lies on something has little motion, so there a share of the tolerance is aimed at for the first sweeps:
// it moves by
// 0.3 mm/s instead of 0.8 (RMS), for a fifth more sweeps.
constexpr double kStrictShare = 0.2;
constexpr int kStrictSweeps = 6;
// Where strings pull, in short substeps, what a link may lack is more than its weight moves it by, and a flat net makes
// ten times that of it across the strings: it would never come to rest. So this share of the way of its weight is aimed
// at, but not less than that share of the tolerance.
constexpr double kShareOfWeight = 0.3;
constexpr double kLeastShare = 0.01;
// The same in the last resort, whose long substeps would leave more. 1: taut sheets never come to rest; 0.01: rows
// drawn straight are lifted by what they may sag, at no expense.
constexpr double kLastResortShare = 0.1;
// Sweeps that must bring at least this improvement, or the iteration has stalled.
constexpr int kStallWindow = 16;
constexpr double kStallFactor = 0.8;
// Levenberg-Marquardt term of the weft's solve, over the diagonal: in proportion to the residual, so that it vanishes
// as the solve ends. Constant, it leaves combinations that hardly move anything to creep by a few percent a sweep.
constexpr double kDampingPerResidual = 0.05;
// Its largest where sweeps are not undone: damped by 1e3 they creep to within the tolerance somewhere else, and a sheet
// held by one pin gained 0.36 m g H (test/judge/cases/everyday_700040.yaml).
constexpr double kLargestDamping = 0.1;
// In the last resort sweeps must make the sum of squares smaller: a step a thousand times shorter than Jacobi's that
// does not has nothing left to gain.
constexpr double kMostDamping = 1e3;
constexpr double kMoreCaution = 8.0;
constexpr double kLessCaution = 2.0;
// bdf2 is stable while steps grow by less than 1 + sqrt(2) at once (Grigorieff 1983); after a longer one it begins
// anew.
constexpr double kMostGrowth = 2.0;

// ---- Substeps: verification and energy
// -------------------------------------------------------------------------------

// Way of an obstacle's surface in a substep that links could not be brought to their lengths in, over the shortest
// link.
constexpr double kMostWayOfSurface = 0.2;
// Kinetic energy of a step over that without the work of links, from which it has found another way for the links to
// lie: where it follows the motion links take energy out. Links turn in a step, and leapfrog's energy wavers, or bdf2's
// base lies off them, by the square of that angle: 0.03 where they turn by 0.17 rad. What no shorter step would lack
// less is taken out of the velocities instead.
constexpr double kMostAdded = 1.03;
// bdf2 would go on with what a blow has stopped, as a rebound (by a third of it a step; two thirds came back from a
// string that snapped taut). So the step of the blow, the next one, in which the rest of the speed goes, and the one
// after are made from one step: then the last two know nothing of it.
constexpr int kStepsAfterBlow = 3;
// Share of the tolerance that bounded links reach: the rest is for the rounding of their lengths.
constexpr double kBoundShare = 1.0 - 1e-6;
// What is this far away [m] was thrown there by a force beyond all measure: damping takes the cube of its speed,
// energies the square of it times a mass, and the next substep would go further.
constexpr double kBeyond = 1e60;

// ---- Last resort
// -----------------------------------------------------------------------------------------------------

// Reach after the first failure, in links: a link may turn by about half a radian. Not varied.
constexpr double kFirstReach = 0.5;
// Reach over that of a substep that failed, or of one that settled: down in few substeps, for stops cost motion; up in
// more, for a failure costs three quarters. Not varied.
constexpr double kReachShrink = 0.25;
constexpr double kReachGrowth = 1.2;
// Reach, in links, from which a scheme's own substeps are tried again.
constexpr double kUnbounded = 2.0;
// Least reach: nodes go a hundredth of the links' tolerance, which asks for no solve.
constexpr double kLeastReach = 1e-5;
// Links so many times beyond their bound where a path begins were brought there by pins that were pulled apart, or put
// there. They come back, or share what pins ask of them, by whatever the solve finds that is not worse than so many
// times what was.
constexpr double kForced = 10.0;
constexpr double kForcedGrowth = 2.0;

// ---- Velocities at the time of the positions
// -------------------------------------------------------------------------

// Rounds of the linear velocity projection at most, until the rate of what it takes out is this share of what it was.
// More than two without contact: rows between trembling pins gain energy.
constexpr int kVelocityRounds = 2;
constexpr int kContactRounds = 8;  // whose rows are damped
constexpr double kVelocityReduction = 1e-3;
constexpr double kVelocityDamping = 1e-4;
constexpr int kVelocityIterations = 24;

// ---- Step control
// ----------------------------------------------------------------------------------------------------

// h * omega_max that substeps are chosen for. Leapfrog is stable below 2; from 1.7 tensions may grow by
// 1.4 within a substep, and what outgrows even that is caught by heavier nodes.
constexpr double kPhasePerStep = 1.7;
// Where a few nodes alone ask for short substeps (the corners a sheet hangs by), they are made heavier instead: by so
// much altogether, as a share of the cloth's mass. A sheet of 44 x 40 hung by two corners takes 12 substeps a frame
// with it and
// 22 without.
constexpr double kHeavierShare = 0.02;
// From here on nodes are heavier: leapfrog would soon blow up. At 1.7 a swing in two fixed substeps gains 2.5e-2 of its
// energy in 20 s.
constexpr double kStablePhase = 1.9;
// h * turning that substeps are chosen for where rods alone act, and the motion is smooth. Leapfrog is off by about
// (h * turning)^2 / 24 of the way that it goes: with 0.07, a millimetre in 5 m. Chains of 2 m then end a second's fall
// with
// 0.2 to 0.9 mm (RMS) whatever their number of rods; the cost of smooth motion is inversely proportional to it.
constexpr double kTurnPerStep = 0.07;
// What a motion that is only compared with may use.
constexpr double kLongestPhase = 1.8;
// Looking for such a step costs as much as a sweep; substeps longer than this share of a frame are left alone.
constexpr double kWorthLooking = 0.25;
constexpr double kLimitGrowth = 1.4;
constexpr int kGoodToGrow = 8;
// Substeps of the schemes whose step nothing but accuracy limits, when the scene leaves the choice.
constexpr int kImplicitSubsteps = 8;
// The paper's: of first order, 27 mm after a second of a swing of 43 rods (measured), and its wefts come as near as its
// passes are many: of a flag in the wind 0.5 too long at most, at 4 substeps 1.8. Its energy is bounded at any.
constexpr int kPaperSubsteps = 16;
// Where there is no time for more substeps they are up to so many times longer: beyond that their solve takes all that
// is saved.
constexpr double kMostStretch = 2.0;
// A fixed step that fails may be divided so far before the last resort takes over.
constexpr int kRoomBelowFixed = 16;
// Substeps a frame of the last resort. What they are cut to settles at any step; of 8 to 128 measured on 40 wild scenes
// 8 take the least time and stop the cloth least often. Fewer would slow it: it goes two links a substep at most.
constexpr int kLastResortSubsteps = 8;

// ---- Friction
// --------------------------------------------------------------------------------------------------------

// Share of friction's bound below which a point that stuck in the last substep is solved for as held. Points near the
// bound would change between sticking and slipping from sweep to sweep; they take turns.
constexpr double kSticksBelow = 0.5;
// What such a point may slip in a substep, as a share of what it may enter: the next substep takes it up.
constexpr double kStickShare = 0.25;

// ---- Contact rows
// ----------------------------------------------------------------------------------------------------

// Many contacts say nearly the same; solved to the last, some would pull so that others can push. Over the diagonal.
constexpr float kLeastDamping = 0.2F;

}  // namespace curtain
