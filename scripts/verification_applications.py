"""The rows of doc/verification.md on launchers, cranes, machines, chains and shaken bridges."""

from verification_check import Check, Row

APPLICATIONS = [
    Row("a missile leaves a flexible rail: deflection of the tip and rate of turn at that instant",
        "16 modes of the rail, Runge-Kutta at 1e-5 s", "Applications.Launcher",
        [Check("EXPECT_LT(tip_error, {});", "tip_error", "tip"),
         Check("EXPECT_LT(turn_error, {});", "turn_error", "rate of turn")]),
    Row("a crane hoists, travels and brakes: sway of the load, up to 0.3 m", "two coordinates of the load, Runge-Kutta",
        "Applications.OverheadCrane", [Check("EXPECT_LT(sway_error, {});", "sway_error", unit="m")]),
    Row("a precision stage: position during and after its motion", "one coordinate, Runge-Kutta at 1e-5 s",
        "Applications.PrecisionStage", [Check("EXPECT_LT(worst, {});", "worst", unit="m")]),
    Row("a chain of forty rods: place of its end after 1.5 s", "their angles, Runge-Kutta at 5e-4 s",
        "Chains.HangingChain", [Check("EXPECT_LT((end - exact).norm(), {});", "error", unit="m")]),
    Row("an escalator's chain under the polygon effect: forces in links", "M (g sin a + dv/dt)",
        "Chains.PolygonDrive", [Check("EXPECT_LT(error, {});", "error")]),
    Row("a bridge on shaking supports", "a series of 24 modes", "ShakenBridge.ModalSeries",
        [Check("EXPECT_LT(error, {} * greatest);", "error", "deflection"),
         Check("EXPECT_LT(error_of_moment, {} * greatest_moment);", "moment_error", "moment")]),
    Row("an oscillator crosses a shaking bridge", "modes and oscillator, Runge-Kutta at 2e-5 s",
        "SupportMotion.OscillatorCrosses", [Check("EXPECT_LT(error, {});", "error", unit="m")]),
    Row("a bar whose support moves along it", "a series of 24 modes, Runge-Kutta at 2e-5 s", "SupportMotion.AlongTheBeam",
        [Check("EXPECT_LT(error, {} * greatest);", "error", "displacement"),
         Check("EXPECT_LT(error_of_force, {} * greatest_force);", "force_error", "reaction")]),
]
