"""The rows of doc/verification.md: what is checked, against what, where the bound stands and which figures belong to it."""

import math
from typing import Callable, NamedTuple, Optional, Union

HEAD = """# Verification

What the program is checked against. Each row names the case, where its reference comes from, the bound that the test
asserts, the largest error that the test measured, and the test. Errors are relative to the peak or to the exact value
unless a unit stands beside them. "Asserted only" means that the test compares and does not record.

This page is written by `scripts/verification.py`. Bounds are read from the tests' sources, measured errors from
`doc/verification_figures.csv`, which holds what the tests recorded when they were last run for this page:

    /usr/bin/python3 scripts/verification.py --measure    # after ./test.sh: measures anew and writes the page
    /usr/bin/python3 scripts/measured.py build '*R1*'     # what some of the tests record, without writing anything

A row is run by `./test.sh -R NAME`, with the name in its last column; rows of `tests/mpi` by
`mpirun -n 2 build/tests/mpi_tests --gtest_filter='NAME'`. Measured errors near rounding differ from machine to machine.

The references are Fryba's moving force (closed-form series), the beam of Yang and Yau 1997, the example of VBI-2D, the IVP
test set, textbook formulas and independent modal or Runge-Kutta computations. No reference is an earlier output of this
program."""


class Check(NamedTuple):
    """One assertion. {} in `assertion` is the bound; `figure` a pattern of recorded figures, or a function of them."""
    assertion: str
    figure: Union[None, str, Callable] = None
    what: str = ""                  # the quantity, where a row has several
    bound: str = ""                 # how the bound is written, with {} for the number
    unit: str = ""                  # of the bound and of the figure
    file: Optional[str] = None      # where the assertion stands, if not in the test's file
    instance: str = ""              # only parameters that fit
    each: bool = False              # show every parameter instead of the largest value
    below: bool = True              # the figure is to be below the bound


class Row(NamedTuple):
    case: str
    reference: str
    test: str  # the name, or a pattern with *
    checks: list


NEWTON = Check("EXPECT_LT(worst.force, {});", "newton_(force|moment)", file="tests/support/newton_law.cpp",
               what="Newton's law for every body")
CONVERGENCE = "tests/support/convergence.hpp"
FREQUENCY = Check("scatter = 0.1, error = {}, limit", "error", file=CONVERGENCE)


def number(figures, name):
    return float(figures[name]) if name in figures else None


def order_in_time(figures):
    return math.log2(number(figures, "error_1") / number(figures, "error_2"))


def order_in_space(figures):
    return math.log2(number(figures, "error_6") / number(figures, "error_48")) / 3.0


def over_tolerance(name, tolerances):
    return lambda figures: max(number(figures, f"{name}_{t}") / float(t) for t in tolerances)


def over_accuracy(figures, left_out=()):
    """The largest error over the accuracy asked for, of what has to be promised: deflections, and the rest to 1e-3."""
    parts = [(*name.rsplit("_", 1), abs(float(value))) for name, value in figures.items()]
    return max(error / float(wanted) for quantity, wanted, error in parts
               if quantity not in left_out and (quantity == "deflection" or float(wanted) > 5e-4))


def over_accuracy_but_acceleration(figures):
    return over_accuracy(figures, ("acceleration",))


def over_the_turns(figures):
    turned = float(figures["turns_with_and_without"].split()[0]) * 6.283
    return max(number(figures, "implicit_error"), number(figures, "explicit_error")) / turned


SECTIONS = [
    ("Published and independent cases", [
        Row("R1, a moving force at five speeds: peak over static", "closed-form series of 401 modes (Fryba, ch. 1)",
            "R1.PeakWhileTheForceIsOnTheBeam",
            [Check("GetParam().amplification, {} * GetParam().amplification);", "error")]),
        Row("R1 at half the critical speed: the whole curve", "the same series", "R1.CurveAtHalfTheCriticalSpeed",
            [Check("EXPECT_LT(difference, {});", "error")]),
        Row("R2, a sprung mass (Yang and Yau 1997)", "modal equations, adaptive Runge-Kutta to 1e-10",
            "R2.PeaksAndCurves",
            [Check("-2.40731635e-3, {} * 2.40731635e-3);", "error", "peak deflection"),
             Check("0.147967, {} * 0.147967);", "acceleration_error", "the body's acceleration")]),
        Row("R3, the sprung mass of VBI-2D: peak deflection", "the same method", "R3.Peak",
            [Check("-4.18626809e-4, {} * 4.18626809e-4);", "error")]),
        Row("R4, a Hertz wheel under a sprung body", "the same method", "R4.PeaksAndCurves",
            [Check("-2.8324443e-3, {} * 2.8324443e-3);", "error", "peak deflection"),
             Check("0.98124, {});", None, "least wheel force")]),
        Row("R5, a mass moving on the beam, two masses, three speeds: peak over static",
            "30 modes with all convective terms", "R5.PeakWhileTheContactIsClosed",
            [Check("GetParam().amplification, {} * GetParam().amplification);", "error")]),
        Row("R6, three spans: the first six frequencies", "independent modal computation", "R6.Frequencies",
            [Check("reference[i], {} * reference[i]);")]),
        Row("R6, three spans under a force: peaks at the midspans", "independent modal computation",
            "R6.PeaksAtTheMidspans", [Check("reference[i], {} * std::abs(reference[i]));", "error_[0-9]")]),
        Row("R8, a coach on Zhai's track and Xia's bridge", "a converged computation of its own",
            "LayeredTrack.BallastedBridge",
            [Check("midspan / -5.38333e-4, 1.0, {});", "midspan_error", "midspan"),
             Check("EXPECT_NEAR(least, 107950.0, {});", None, "wheel forces of 109 kN", unit="N")]),
        Row("R9, Andrews' squeezing mechanism at 0.03 s", "IVP test set, PSIDE at 1e-14",
            "R9.AndrewsSqueezingMechanism",
            [Check("EXPECT_LT(worst_angle, {});", "k[0-9]", "angles (up to 15.8 rad)", unit="rad"),
             Check("EXPECT_LT(worst_rate, {});", None, "rates", unit="rad/s")]),
        Row("R10, a force along a beam on a damped bed, 0.5 to 1.3 of the critical speed",
            "steady state of an infinite beam", "R10.SteadyShape",
            [Check("EXPECT_LT(error, {} * largest);", "error", "deflection"),
             Check("EXPECT_LT(moment_error, {} * largest_moment);", "moment_error", "moment")]),
        Row("ten HSLM-A trains at 131 speeds: peaks", "another program (tests/data/hslm_peaks.csv)",
            "Sweep.HslmTrainsAgainstAnotherProgram",
            [Check("EXPECT_LT(errors[0], {});", "deflections", "deflection"),
             Check("EXPECT_LT(errors[1], {});", "accelerations", "acceleration")]),
    ]),
    ("Influence lines, load models, EN 1991-2", [
        Row("a simple span, sections and forces inside elements", "closed forms", "InfluenceLines.OfASimpleSpan",
            [Check("-deflection, {} * span * span * span / EI)", None, "deflection"),
             Check("low * (span - high) / span, {})", None, "moment", unit="m")]),
        Row("two spans: moment over the inner support, its reaction", "closed forms", "InfluenceLines.OfTwoSpans",
            [Check("EXPECT_NEAR(lines[1].value(x), moment, {});", None, "moment", unit="m")]),
        Row("a haunched girder of three spans under a force", "elements an eighth as long, at rest",
            "InfluenceLines.OfAHaunchedGirder",
            [Check("EXPECT_LT(deflection_error, {});", "deflection_error", "deflection"),
             Check("EXPECT_LT(moment_error, {});", "moment_error", "moment")]),
        Row("six D2 wagons on 25 m, wherever they stand", "EN 15528's check case by influence lines",
            "StaticEffects.CheckCaseOfEN15528",
            [Check("1.125392e-2, {} * 1.125392e-2);", "deflection_error", "deflection at midspan"),
             Check("5.00494e6, {} * 5.00494e6);", "moment_error", "moment there"),
             Check("5.08219e6, {} * 5.08219e6);", "anywhere_error", "moment anywhere")]),
        Row("LM71 as a uniform load of 148.8, 121.5, 98.4 kN/m on 10, 20, 50 m", "published, four figures",
            "StaticEffects.UniformLoadLikeLM71",
            [Check("EXPECT_NEAR(found, uniform, {})", "error_.*", unit="kN/m")]),
        Row("the verdict of 6.4.6.5 of a force on a simple span: static effects", "by hand", "NormVerdict.OfOneForce",
            [Check("by_hand[e], {} * by_hand[e])", "static_error")]),
    ]),
    ("Accuracy, orders and what is left out", [
        Row("the promise of `accuracy` at 1e-2, 1e-3 and 1e-4, five scenes: error over what was asked",
            "runs refined far beyond", "Promise.IsKeptAtEveryAccuracy",
            [Check("EXPECT_LE(error, wanted) << quantity;", over_accuracy, "", "1", instance="/(?!undamped)"),
             Check("EXPECT_LE(error, wanted) << quantity;", over_accuracy_but_acceleration,
                   "without damping, where accelerations are not promised", "1", instance="/undamped")]),
        Row("the promise in every run of a sweep, by elements and by modes",
            "fine elements", "SweepAccuracy.HoldsInEveryRun",
            [Check("EXPECT_LT(worst, std::stod(GetParam())) << name", ".*_by_.*", "asked for 1e-2", "1e-2", instance="/0"),
             Check("EXPECT_LT(worst, std::stod(GetParam())) << name", ".*_by_.*", "for 1e-3", "1e-3", instance="/1")]),
        Row("order in time, a half car on Hertz wheels", "the methods' authors", "OrderInTime.AsItsAuthorsSay",
            [Check("method.order, {})", order_in_time, "", "within {} of the order", each=True)]),
        Row("order in space under a sprung mass, from 6 to 48 elements", "R2's figures", "OrderInSpace.SprungMass",
            [Check("EXPECT_GT(std::log2(first / last) / 3.0, {});", order_in_space, "", "above {}", below=False),
             Check("EXPECT_LT(peak_last, {});", "peak_error_48", "peak on 48 elements")]),
        Row("esdirk4 against ARKIMEX 4 in six scenes", "PETSc's ARKIMEX, of the same numbers",
            "SameAsArkimex.ToRounding",
            [Check("double bound = {}; // of each curve's peak", "probes/.*|supports/.*|energy/strain", "curves",
                   instance="/(?!layered_track)"),
             Check('{"output_interval", "0.02"}}, {}}', "probes/.*|supports/.*|energy/strain", "layered track",
                   instance="/layered_track"),
             Check("integral ? {} : c.bound)", "energy/(dissipated|work)", "dissipated energy and work")]),
        Row("separate spans with and without those at rest", "every span stepped", "Window.OfSeparateSpansChangesNothing",
            [Check("EXPECT_LE(difference, {}) << curve;", ".*")]),
        Row("a continuous bridge with `model_window`: error of deflections over the tolerance", "every span stepped",
            "Window.OfAContinuousBridgeKeepsItsTolerance",
            [Check("EXPECT_LE(deflection, {} * std::stod(tolerance));",
                   over_tolerance("deflection", ["1e-3", "1e-4", "1e-5"]))]),
        Row("axial unknowns left out where nothing acts along the beam", "the same with them", "LeftOut.AxialUnknowns",
            [Check("EXPECT_LT(difference, {}) << name;", "probes/.*")]),
        Row("steps of the ladder: error of deflections over the tolerance", "a run with much shorter steps",
            "StepLadder.ErrorsFallWithTheTolerance",
            [Check("EXPECT_LT(of_deflection, {} * std::stod(tolerance)) << tolerance;",
                   over_tolerance("deflection", ["1e-2", "1e-3", "1e-5", "1e-6"]))]),
        Row("a smooth crossing by the ladder: deflection and moment", "a fine run",
            "StepLadder.ASmoothCrossingHasThePeaksOfAFineRun",
            [Check("EXPECT_LT(difference, {}) << curve;", "probes/.*")]),
    ]),
    ("Balances", [
        Row("energy that does not balance, of the largest term besides the train's forward motion, nine scenes",
            "conservation", "Energy.*", [Check("EXPECT_LT(b.residual, {} * b.scale);", "residual_over_scale")]),
        Row("energy where wheels turn about the corners at span ends, J, at 0.5 ms", "conservation",
            "Corners.EnergyIsOfHighOrderWhereWheelsTurnAboutThem",
            [Check("EXPECT_LT(left, {}) << law;", None, unit="J"),
             Check('(one_span, "[pinned, roller]", law), "esdirk4", left), {}) << law;', None, "order", "above {}")]),
        Row("sum of all forces on bridge and layered track, of the weight", "Newton's law", "LayeredTrack.*",
            [Check("EXPECT_LT(left, {} * weight);", "residual_over_weight")]),
        Row("Newton's law for every body of vehicles on bridges and in flight, from the results", "Newton's law",
            "VehicleForces.*", [Check("EXPECT_LT(worst.force, {});", "(force|moment)_[0-9]")]),
        Row("six free bodies: momentum, angular momentum", "conservation", "FreeFloating.*",
            [Check("EXPECT_LT(worst, {} * scale);", "momentum|angular_momentum"),
             Check("EXPECT_LT(energy, {});", "energy", "energy")]),
        Row("spinning balls that meet off centre with friction: angular momentum, energy", "conservation",
            "ObliqueImpact.*",
            [Check("EXPECT_LT(worst.z(), {});", "angular_momentum", "angular momentum", unit="kg m2/s"),
             Check("0.5 in all EXPECT_LT(energy_error(run), {});", "energy", "energy")]),
        Row("a train over end bearings that open and close: energy missing", "conservation",
            "OneSidedPoints.TrainAndItsEnergy", [Check("EXPECT_LT(missing, {});", "train_energy_missing")]),
    ]),
    ("Mechanisms", [
        Row("a pendulum over ten periods", "elliptic functions", "Pendulum.TenPeriodsAtALargeAmplitude",
            [Check("EXPECT_LT(worst_angle, {} * amplitude);", "error", "angle"),
             Check("EXPECT_LT(worst_force, {} * largest_force);", "force_error", "force of the pin"), NEWTON]),
        Row("a double pendulum: angles", "Runge-Kutta on its two angles", "DoublePendulum.AgainstItsTwoAngles",
            [Check("EXPECT_LT(worst, {} * swung);", "error"), NEWTON]),
        Row("a slider-crank over ten turns: angle", "Runge-Kutta on its reduced equation",
            "SliderCrank.TurnedByATorqueAgainstASpring",
            [Check("EXPECT_LT(worst.angle, {} * worst.turned);", "error"), NEWTON]),
        Row("a four-bar over five turns: angle", "Runge-Kutta on its reduced equation",
            "FourBar.CrankAndRockerOverSeveralTurns",
            [Check("EXPECT_LT(worst.angle, {} * worst.turned);", "error"), NEWTON]),
        Row("rows of 2, 10 and 40 four-bars through their singular positions for 10 s", "exact motion of one crank",
            "FourBars.RunThroughTheirSingularPositions",
            [Check("EXPECT_LT(worst, {});", "error", "position", unit="m"),
             Check("n == 40 ? {} : 1e-5);", "energy_drift", "energy, 40 of them", unit="J", instance="/[78]"),
             Check("n == 40 ? 1e-4 : {});", "energy_drift", "energy, 2 and 10", unit="J", instance="/[0-6]"),
             Check("EXPECT_LT(worst_pin(run, n), {} * n);", "pins", "pins", "{} m times their number", "m")]),
        Row("a parallelogram that a driver turns through its flat positions", "the driver",
            "Parallelogram.DrivenThroughItsFlatPositions",
            [Check("EXPECT_LT(worst, {});", "driven_angle", "angle", unit="rad")]),
        Row("a slider-crank with dry friction in its guide over ten turns: angle", "Runge-Kutta on its reduced equation",
            "SlidingFriction.SliderCrankAgainstItsReducedEquation",
            [Check("EXPECT_LT(worst, {} * (y[0] - start));",
                   over_the_turns), NEWTON]),
        Row("a rail that falls with a sled that rubs on it, implicit against explicit methods", "the other method",
            "SlidingFriction.ImplicitAndExplicitMethodsAgree", [Check("EXPECT_LT(error, {}) << name;", "/vehicles.*")]),
        Row("a spring with play", "straight flights and half sines", "SpringWithPlay.ThreeTurnsOfAnOscillator",
            [Check("EXPECT_LT(fine.position, {} * gap);", "error", "position"),
             Check("EXPECT_LT(fine.force, {} * speed * std::sqrt(stiffness * mass));", "force_error", "force")]),
        Row("a bump stop: speed given back", "closed form", "BumpStop.GivesBackWhatItsDamperLeaves",
            [Check("EXPECT_NEAR(v, restitution * speed, {} * speed);", "error")]),
        Row("a damper that blows off: speed", "two exponentials", "BlowOffDamper.DecaysByTwoExponentials",
            [Check("EXPECT_LT(worst, {} * speed);", "error")]),
        Row("vehicles that couplers join", "the same bodies as one vehicle", "Couplers.JoinedVehiclesAreOneMechanism",
            [Check("EXPECT_LT(difference, {}) << a;", "joined_against_one_vehicle")]),
    ]),
    ("Contacts, impacts and wheels", [
        Row("elastic impacts of balls by Hertz' law, k 1e6 to 1e12, steps of 1 ms", "closed form", "ElasticImpact.Hertz",
            [Check('expect_near(what + "_rebound", seen.speed, speed, {}); '
                   'expect_near(what + "_duration", seen.duration, 2.943275', ".*_rebound", "rebound"),
             Check("2.943275 * deepest / speed, {});", ".*_duration", "duration"),
             Check("deepest, {});", ".*_depth", "depth"),
             Check("k * std::pow(deepest, 1.5), {});", ".*_force", "force")]),
        Row("the same by the linear law", "half a sine", "ElasticImpact.Linear",
            [Check('expect_near(what + "_rebound", seen.speed, speed, {}); '
                   'expect_near(what + "_duration", seen.duration, pi', ".*_rebound", "rebound"),
             Check("seen.duration, pi / omega, {});", ".*_duration", "duration"),
             Check("mass * omega * speed, {});", ".*_force", "force")]),
        Row("impacts with a damper", "closed form", "DampedImpact.LinearSpringAndDamper",
            [Check("seen.speed, leaves, {});", ".*_rebound", "rebound"),
             Check("-mass * derivative(2, crest), {});", ".*_force", "force")]),
        Row("restitution of 0.9, 0.5 and 0.2 as asked", "the value asked for", "Restitution.AsAsked",
            [Check('expect_near("hertz", on_floor("stiffness: 1.0e9, " + asked).speed, GetParam() * speed, {});',
                   "hertz|linear|balls")]),
        Row("twenty bounces of a ball at steps of 10 ms: energy gained a bounce", "conservation",
            "BouncingBall.TwentyBouncesKeepTheirHeight", [Check("EXPECT_LT(std::abs(usual), {});", "drift_a_bounce")]),
        Row("twelve losses of contact over a bump on the ground: times", "Runge-Kutta of two degrees of freedom",
            "Separations.OverABumpOnRigidGround", [Check("EXPECT_LT(difference, {});", "time_error", unit="s")]),
        Row("four losses of contact on a bridge: times", "much shorter steps", "Separations.OverABumpOnABridge",
            [Check("EXPECT_LT(time_difference(seen, exact), {});", "time_difference", unit="s")]),
        Row("a disc that rolls down an incline: creep", "closed form with the creep of tanh", "Disc.RollsDownAnIncline",
            [Check("creep, {} * creep);", "creep_error")]),
        Row("a bowling ball that slides, then rolls: speed", "closed form", "BowlingBall.SlidesThenRolls",
            [Check("EXPECT_LT(worst, {} * d.speed);", "speed_error")]),
        Row("a polygonal wheel's force without damping", "exact motion", "PolygonalWheel.ExactForceWithoutDamping",
            [Check("EXPECT_LT(worst, {} * stiffness * A);", "force_error_over_kA")]),
        Row("a wheel with a flat at 20 m/s: force, of the greatest", "an integration of its own",
            "Flat.AgainstAnIntegrationOfItsOwn", [Check("EXPECT_LT(worst, {} * greatest);", "force_error_over_greatest")]),
        Row("a hard wheel's centre over a bump of 10 mm on 0.1 m, of its height", "roll-over curve",
            "SharpTrack.CentreFollowsTheRollOverCurve",
            [Check("EXPECT_LT(worst, {} * 0.01);", "worst_over_height")]),
        Row("a wheel at rest in a valley: forces", "statics", "SharpTrack.AtRestInAValley",
            [Check("(mass * g), 1.0, {});", lambda f: abs(number(f, "force_over_statics") - 1.0))]),
    ]),
    ("Beams: frequencies and statics", [
        Row("frequencies of all 25 pairs of supports", "exact dynamic stiffness", "EndConditions.Bending", [FREQUENCY]),
        Row("springs at the ends", "exact dynamic stiffness", "Frequencies.SpringsAtEnds", [FREQUENCY]),
        Row("beds under every pair of ends", "exact dynamic stiffness", "Frequencies.BedUnderEveryPairOfEnds", [FREQUENCY]),
        Row("2 to 5 continuous spans", "exact dynamic stiffness", "ContinuousSpans.FourthOrder", [FREQUENCY]),
        Row("tapered beams", "Ritz' method", "Tapered.FourthOrder", [FREQUENCY]),
        Row("order of the frequencies with the mesh, one span", "theory of the cubic element", "SingleSpan.FourthOrder",
            [Check("EXPECT_NEAR(std::log2(e1 / e2), 4.0, {})", None, "", "within {} of 4")]),
        Row("damped (complex) frequencies, dampers at midspan, at the tip and against rotation",
            "roots of the complex frequency equation", "DampedBending.FourthOrder", [Check("EXPECT_LT(e2, {})")]),
        Row("statics at nodes and between them, reactions included", "textbook formulas", "Meshes.*",
            [Check("EA = 1.0e10, tolerance = {};")]),
        Row("statics on all pairs of supports, on springs and beds", "exact static chain", "StaticMeshes.*",
            [Check("g = 9.81, tolerance = {};")]),
        Row("statics of one span of 10 to 50,000 elements", "textbook formula", "LongChain.StaticErrorIsEstimatedHonestly",
            [Check("EXPECT_LT(error, {}) << n;", "error_.*"),
             Check("EXPECT_LT(error, {} * estimate", None, "error over its estimate")]),
        Row("a beam that lifts off its bed: deflection", "exact piecewise solution", "OneSidedBed.LiftOffOfAnInfiniteBeam",
            [Check("EXPECT_LT(errors.back(), {});", "deflection_error")]),
        Row("a beam on a cubic spring vibrates freely", "Duffing's solution", "Cubic.FreeVibrationIsDuffings",
            [Check("EXPECT_LT(worst.back(), {});", "duffing_error")]),
        Row("a beam that bounces between two buffers", "straight flights and half sines", "Gap.BeamBetweenBuffers",
            [Check("EXPECT_LT(worst, {});", "buffer_error")]),
    ]),
    ("Bridges by their modes", [
        Row("a force by one mode with its free vibration", "closed form", "ModalMotion.OneModeInClosedForm",
            [Check("EXPECT_LT(error, {} * largest)", "error")]),
        Row("R1 by twenty modes: peak over static", "closed-form series", "ModalR1.TwentyModes",
            [Check("GetParam().amplification, {} * GetParam().amplification);", "error")]),
        Row("all modes of three spans at steps of 0.1 ms: deflection, reactions, energies", "the elements",
            "ModalBridge.AllModesAgainstTheFullModel", [Check("EXPECT_LT(difference, {}) << name;", ".*/.*")]),
        Row("all modes of three spans under two coaches, by three integrators: deflection, wheel force, reactions",
            "the elements", "ModalVehicle.AllModesAgainstTheElements",
            [Check("expect_equal(modal, full, {});", ".*")]),
        Row("the same train over a bump that lifts its wheels", "the elements",
            "ModalVehicle.LosesContactAndGainsItAgain",
            [Check('EXPECT_LT(relative_difference(modal("/probes/deflection"), full("/probes/deflection")), {});')]),
    ]),
    ("Linear vehicles", [
        Row("two coaches over three spans", "the mechanisms", "LinearVehicle.CoachesOverThreeSpans", [
            Check('{{"/probes/deflection", "{}"},', ".*deflection", "deflection"),
            Check('{"/probes/acceleration", "{}"},', ".*probes/acceleration", "the bridge's acceleration"),
            Check('{"/vehicles/0/wheel_1/normal_force", "{}"},', ".*normal_force", "wheel force")]),
        Row("six hinged cars", "the mechanism", "LinearVehicle.ArticulatedTrain", [
            Check('{{"/probes/deflection", "{}"},', ".*deflection", "deflection"),
            Check('{"/vehicles/2/wheel_1/normal_force", "{}"}', ".*normal_force", "wheel force")]),
        Row("a train that brakes", "the mechanisms", "LinearVehicle.BrakingTrain", [
            Check('{{"/probes/deflection", "{}"},', ".*deflection", "deflection"),
            Check('{"/vehicles/1/front_wheel/normal_force", "{}"}', ".*normal_force", "wheel force")]),
        Row("contact lost over a bump: its times", "the mechanism", "LinearVehicle.LosesContactAndGainsItAgain",
            [Check('EXPECT_LT(relative_difference(run("/separations/start"), full("/separations/start")), {});')]),
    ]),
    ("Runs side by side", [
        Row("two coaches over three spans at three speeds: all peaks", "the same runs, each driven by TS",
            "SideBySide.CoachesOverThreeSpans", [Check('"1e-3", "2.5e-4", {});', "three_span_train")]),
        Row("six hinged cars at four speeds: all peaks", "the same runs, each driven by TS",
            "SideBySide.OneVehicleOfManyCars", [Check('"60,72,4", "2e-3", "5e-4", {});', "articulated_train")]),
        Row("a coach on a rough track at three speeds: all peaks", "the same runs, each driven by TS",
            "SideBySide.RoughTrack", [Check('"76,84,4", "8e-4", "2e-4", {});', "three_span_train")]),
        Row("one solve a step, modes exact: greatest wheel force", "a fine step of esdirk4", "SideBySide.OneSolveAStep",
            [Check("EXPECT_LT(errors[1], {});", "error")]),
        Row("modes, step and method found by `accuracy` 5e-3: all peaks", "fine elements, mechanisms",
            "SideBySide.ChosenByTheAccuracy", [Check("EXPECT_LT(error, {});", "error")]),
        Row("other neighbours, four lanes, two lanes", "eight lanes", "SideBySide.NeighboursAndWidthsChangeNothing",
            [Check('EXPECT_LT(difference(run("77,84,1", "4"), eight), {});')]),
        Row("forces over nine bridges, 20 instants a period: all peaks", "the exact motion at 2,000",
            "ForcePassages.AgainstTheExactMotion", [
                Check("EXPECT_LT(difference(usual[i], exact), {}) << speeds[i];", None, "20 instants"),
                Check("EXPECT_LT(difference(fine[i], exact), {}) << speeds[i];", None, "200 instants")]),
    ]),
    ("Single runs stepped by the lanes' kernel", [
        Row("two coaches over three spans: forces, deflections, moments, reactions", "the same run step by step in full",
            "SteppedApart.CoachesOverThreeSpans", [Check('{"ts_dt", "2.5e-4"}}, {}, 3e-5);', "three spans")]),
        Row("a coach on a rough track: the same", "the same run in full", "SteppedApart.RoughTrack",
            [Check("                     {}, 1e-3);", "rough track")]),
        Row("modes and linear vehicles found by `accuracy` 1e-3: deflection", "fine elements, mechanisms",
            "SteppedApart.ChosenByTheAccuracy", [Check("EXPECT_LT(off, {}) << name;", "deflection")]),
        Row("two coaches over spans that do not touch, all modes of each", "the elements", "SpansApart.AreWhatTheirElementsAre",
            [Check("EXPECT_LT(train, {});", "train", "train"), Check("EXPECT_LT(bridge, {});", "bridge", "bridge")]),
    ]),
    ("Envelopes", [
        Row("a force that creeps over a span, samples 0.47 m and 0.33 m apart: moment, shear on both sides, and with each other",
            "statics", "Envelope.OfACreepingForce", [
                Check("EXPECT_LT(between, {});", "between passages"),
                Check("EXPECT_LT(at_passages, {});", "at every fifth passage")]),
    ]),
    ("Wheels that lose their force", [
        Row("low-passed forces of two coaches on a rough track: the part lost", "the stored forces, filtered",
            "WheelUnloadingOfARun.IsThatOfItsStoredForces", [
                Check('"wheel_unloading_lowpass"), filtered, {} * filtered)', "filtered.*")]),
    ]),
    ("Speeds near peaks, resonance and cancellation", [
        Row("speeds added where 36 km/h apart miss the peak: all peaks", "a dense sweep",
            "RefinedSweep.FindsTheResonanceThatTheGridMisses", [
                Check("EXPECT_LT(of_a_hundredth, {});", "of a hundredth"),
                Check("EXPECT_LT(of_a_thousandth, {});", "of a thousandth")]),
        Row("peaks of judged quantities, speeds added to 2e-3", "a dense sweep", "RefinedSweep.KnowsThePeaksOfJudgedQuantities",
            [Check("EXPECT_LE(wanted, (1.0 + {}) * greatest(fine, train, limit)) << train")]),
        Row("two masses of the bridge, speeds added to 2e-3", "a dense study", "RefinedStudy.FindsThePeakOfEveryCombination",
            [Check("EXPECT_LT(worst, {});", "of a study")]),
        Row("speeds of resonance f1 d", "the sweep's own peaks", "Resonances.ArePredictedAndFound",
            [Check("EXPECT_LT(worst, {});", "found over predicted")]),
        Row("free motion after a force at 2 f_n L/(n + 2k), of that while it crosses", "0",
            "Cancellations.LeaveTheSpanAtRest", [Check("EXPECT_LT(worst, {});", "left behind")]),
    ]),
    ("Studies", [
        Row("tracks and speeds side by side: all peaks", "each run alone", "Study.TracksInLanesAreThoseOfRunsAlone",
            [Check("EXPECT_LT(worst, {});", "runs side by side and alone")]),
        Row("trains with other masses side by side: all peaks", "each run alone", "Study.TrainsInLanesAreThoseOfRunsAlone",
            [Check("EXPECT_LT(worst, {});", "trains side by side and alone")]),
        Row("filtered accelerations and rotations of a judged sweep by modes", "each run alone", "JudgedRuns.OfASweepByModes",
            [Check("EXPECT_NEAR(found[l], wanted[l], {} * wanted[l]) << run")]),
    ]),
    ("A rail between its nodes", [
        Row("a wheel on two elements a bay", "twelve elements a bay", "RailBetweenNodes.TwoElementsABayFollowAMovingWheel", [
            Check("EXPECT_LT(of_two, {}) << quantity;", "normal_force", "wheel force"),
            Check("EXPECT_LT(of_two, {}) << quantity;", "acceleration", "bridge's acceleration")]),
        Row("energy that is missing, of what the rail stores in a bay", "0", "RailBetweenNodes.ItsEnergyComesBack",
            [Check("EXPECT_LT(residual, {} * stored);", "residual_over_stored")]),
    ]),
    ("Modes that dampers couple", [
        Row("elastic bearings with Rayleigh damping, a damped bearing; all modes", "the elements",
            "CoupledModesOf.AllModesAgainstTheElements", [
                Check('{std::pair("/probes/deflection", {}),', "probes/deflection", "deflection")]),
        Row("coaches over dampers, all modes", "the elements", "CoupledModes.UnderVehicles", [
            Check('? 2e-5 : {}) << name;', ".*wheel_1/normal_force", "wheel force")]),
    ]),
    ("One rank against two and three", [
        Row("every dataset of all other scenes, of its peak", "the same scene on one rank", "Ranks.*",
            [Check("double at_rest = 0.0, double bound = {}) {")]),
        Row("an articulated train", "the same scene on one rank", "Ranks.ArticulatedTrain", [Check("60, {});")]),
        Row("linear vehicles", "the same scene on one rank", "Ranks.LinearVehicles", [Check("35, {});")]),
        Row("a prop below a layered track", "the same scene on one rank", "Ranks.PropBelowALayeredTrack",
            [Check("20, {});")]),
        Row("losses of contact and impacts", "the same scene on one rank", "Ranks.ContactLossAndImpacts",
            [Check("20, {});")]),
        Row("steps chosen by their errors, two scenes", "the same scenes on one rank", "Ranks.StepsChosenByTheirErrors",
            [Check("20, {});", None, "a wheel over a bump"), Check("35, {});", None, "two coaches")]),
        Row("wheels out of round over a sharp bump", "the same scene on one rank", "Ranks.WheelsOutOfRoundOverASharpBump",
            [Check("35, {});")]),
        Row("vehicles that lose contact, shared by the ranks", "the same scene on one rank",
            "Ranks.SharedVehiclesThatLoseContact", [Check("100, {});")]),
        Row("statics: accelerations are rounding on any number of ranks", "0", "Ranks.StaticResponse",
            [Check("expect_same(one, all, 35, {});", None, unit="m/s2")]),
        Row("sweeps by modes, by elements and of vehicles", "the same sweep on one rank", "Ranks.SweepByModes",
            [Check('EXPECT_EQ(all("/sweep/" + name), one("/sweep/" + name)) << name;', None, "", "the same bits")]),
    ]),
]
