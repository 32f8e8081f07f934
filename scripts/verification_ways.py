"""The rows of doc/verification.md on other ways to the same motion: by modes, side by side, in studies, on many ranks."""

from verification_check import Check, Row

WAYS = [
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
        Row("two coaches over three spans at three speeds: peaks of deflection and wheel forces", "the same runs, each driven by TS",
            "SideBySide.CoachesOverThreeSpans", [Check('"1e-3", "2.5e-4", {});', "three_span_train")]),
        Row("six hinged cars at four speeds: peaks of deflection and wheel forces", "the same runs, each driven by TS",
            "SideBySide.OneVehicleOfManyCars", [Check('"60,72,4", "2e-3", "5e-4", {});', "articulated_train")]),
        Row("a coach on a rough track at three speeds: peaks of deflection and wheel forces", "the same runs, each driven by TS",
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
        Row("two coaches over three spans: wheel forces, reactions, accelerations of bogies", "the same run step by step in full",
            "SteppedApart.CoachesOverThreeSpans", [Check('{"ts_dt", "2.5e-4"}}, {}, 3e-5);', "three spans")]),
        Row("two coaches over three spans by 24 modes: curves at the probes", "fine elements", "SteppedApart.ModesLeftOut", [
            Check('{std::tuple("/probes/deflection", {}, 2.0),', "probes/deflection", "deflection"),
            Check('{"/probes/acceleration", {}, 0.5},', "probes/acceleration", "acceleration"),
            Check('{"/probes/moment", {}, 0.15}}', "probes/moment", "moment")]),
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
        Row("a bridge as found, a span that shears", "the same scenes on one rank", "Ranks.BridgesAsFoundAndThatShear",
            [Check("30, {});")]),
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
