// Scenes whose promise `accuracy` once broke, each for a reason of its own.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "support/curve.hpp"
#include "support/folders.hpp"
#include "support/promised.hpp"

namespace traverse::test {
namespace {

std::string coaches(const std::string& bridge, const std::string& type, const std::string& train) {
  return bridge + "support: {types: [pinned, roller]}\nvehicle: {coach: {file: " + source_folder() +
         "/options/vehicles/" + type + ".yml}}\ntrain: {" + train + "}\nscene: {tail: 1.0}\n";
}

/// A mass on a spring and a damper on one wheel. Bodies in kg, spring in N/m, damper in N s/m, wheel as its law has it.
std::string one_wheel(const std::string& body, const std::string& axle, const std::string& spring,
                      const std::string& damper, const std::string& wheel, const std::string& law = "hertz") {
  return "vehicle:\n"
         "  car:\n"
         "    bodies: [body, axle]\n"
         "    joints: [guide]\n"
         "    springs: [suspension]\n"
         "    wheels: [wheel]\n"
         "    drivers: [level]\n"
         "    body: {mass: " +
         body +
         ", inertia: 1.0, position: [0.0, 2.0]}\n"
         "    axle: {mass: " +
         axle +
         ", inertia: 1.0, position: [0.0, 0.46]}\n"
         "    guide: {type: prismatic, bodies: [body, axle], point: [0.0, 0.46], axis: [0.0, 1.0]}\n"
         "    suspension: {bodies: [body, axle], from: [0.0, 2.0], to: [0.0, 0.46], stiffness: " +
         spring + ", damping: " + damper +
         "}\n"
         "    wheel: {body: axle, radius: 0.46, law: " +
         law + ", stiffness: " + wheel +
         "}\n"
         "    level: {body: body, coordinate: phi}\n";
}

const std::string car = one_wheel("15000.0", "1200.0", "1.5e6", "2e4", "3e10");
const std::string heavy_axle = one_wheel("24395.6", "5986.65", "1.47532e+07", "0.0", "1.41364e+10");

/// That the peaks are promised and as near to those of a finer run.
void expect_kept(const Results& chosen, const Results& finer, const std::vector<std::string>& peaks, double accuracy) {
  for (const std::string& quantity : peaks) {
    ASSERT_TRUE(expected(chosen, quantity)) << quantity;
    EXPECT_LE(*expected(chosen, quantity), accuracy) << quantity;
    const double error = std::abs(peak_of(chosen, quantity) / peak_of(finer, quantity) - 1.0);
    testing::Test::RecordProperty(quantity, text(error));
    EXPECT_LT(error, accuracy) << quantity;
  }
}

/// That peaks which are promised are; some of them have to be.
void expect_kept_if_promised(const Results& chosen, const Results& finer, std::vector<std::string> peaks,
                             double accuracy) {
  std::erase_if(peaks, [&](const std::string& quantity) { return !expected(chosen, quantity); });
  EXPECT_FALSE(peaks.empty());
  expect_kept(chosen, finer, peaks, accuracy);
}

Values finer(const std::string& elements, const std::string& step) {
  return {{"beam_elements_per_span", elements}, {"ts_dt", step}, {"step_probes", "true"}};
}

// The wheel vibrates on its contact at 57 Hz, near the seventh mode: four modes and six agree on what they both leave
// out.
TEST(MendedPromise, ModesReachOverTheContacts) {
  const Results chosen = run_scene("r7_two_masses", {{"accuracy", "1e-3"}, {"accuracy_of", "deflection,moment"}});
  expect_kept(chosen, run_scene("r7_two_masses", finer("128", "1e-4")), {"deflection", "moment"}, 1e-3);
}

// Six modes and nine agree by steps that do not follow the sixth, and differ by 2 % by those that six modes ask for.
TEST(MendedPromise, ModesAreComparedAgainByShorterSteps) {
  const std::string scene = coaches("beam: {spans: 55.5, EI: 8.25658e+11, mass: 11463.6, damping_ratios: 0.0234}\n",
                                    "s300", "vehicles: coach, speed: 22.5");
  expect_kept(run_yaml(scene, {{"accuracy", "1e-2"}}), run_yaml(scene, finer("44", "2e-4")), {"acceleration"}, 1e-2);
}

// Without damping accelerations are not promised, and forces are judged alone: steps that hardly follow the contacts
// agree on a force that is 1.6 % off.
TEST(MendedPromise, ForcesWithoutAccelerationsTakeShorterSteps) {
  const std::string scene =
      coaches("beam: {spans: 16.7, EI: 7.42483e+10, mass: 26876.9}\n", "manchester", "vehicles: coach*3, speed: 36.2");
  const Results exact = run_yaml(scene, finer("44", "2e-4"));
  for (const char* accuracy : {"1e-2", "1e-3"})
    expect_kept(run_yaml(scene, {{"accuracy", accuracy}}), exact, {"wheel_force"}, std::stod(accuracy));
}

// Two changes, of 0.12 and 0.023, say an order of 2.4, by which 0.006 was expected of steps of 2.3 ms that were 0.0096
// off.
TEST(MendedPromise, ThirdChangeConfirmsAnOrder) {
  const std::string scene =
      "beam: {spans: 24.7, EI: 9.23241e+10, mass: 24119.3, damping_ratios: 0.009}\n"
      "support: {types: [pinned, roller]}\n"
      "load: {forces: 5.948e+04*4, positions: [0.0, -6.69, -11.5, -14.68], speed: 73.7}\nscene: {tail: 0.0}\n";
  const Results chosen = run_yaml(scene, {{"accuracy", "1e-2"}});
  expect_kept(chosen, run_yaml(scene, finer("56", "1e-4")), {"acceleration"},
              expected(chosen, "acceleration").value_or(0.0));
}

// Eight elements were tried and found too few, and were taken nevertheless, by the order in which finer ones settle.
TEST(MendedPromise, FewerElementsAreThoseThatWereTried) {
  const std::string scene =
      "beam: {spans: [30.0, 30.0], EI: 1.05101e+11, mass: 12848.1, damping_ratios: 0.0207, continuity: "
      "simply_supported}\n"
      "support: {types: [pinned, roller, roller]}\n"
      "load: {forces: 1.333e+05*2, positions: [0.0, -2.8], speed: 18.7}\nscene: {tail: 0.0}\n";
  const Results chosen = run_yaml(scene, {{"accuracy", "1e-4"}});
  expect_kept(chosen, run_yaml(scene, finer("64", "3.8e-4")), {"deflection", "moment"}, 1e-4);
}

// A damper that lets go makes accelerations jump within a step: at 0.3 ms a low-passed one was 2e-4 off where 5e-5 was
// expected.
TEST(MendedPromise, LowPassedWhereADamperLetsGo) {
  const std::string scene =
      "beam: {spans: [30.0, 30.0, 30.0, 30.0], EI: 2e10, mass: 1e4, damping_ratios: 0.02}\n"
      "support: {types: [pinned, roller, roller, roller, roller]}\n"
      "foundation: {vertical: {x: 105.0, k: 2.0e8, c: 1.0e5, one_sided: true}}\n" +
      car + "train: {vehicles: car, positions: -2.0, speed: 45.0}\n";
  const char* const low_passed = "acceleration_lowpass";
  const Values wanted = {{"accuracy", "1e-4"}, {"accuracy_of", "deflection,moment,wheel_force,acceleration_lowpass"}};
  const Results chosen = run_yaml(scene, wanted);
  const Results exact = run_yaml(scene, finer("50", "7.5e-5") + Values{{"output_lowpass", "30"}});
  const double error = std::abs(peak_of(chosen, low_passed) / peak_of(exact, low_passed) - 1.0);
  EXPECT_LT(error, expected(chosen, low_passed).value_or(1e-3));
}

// Errors of genalpha's steps come and go with where these end: at 0.542 ms an acceleration was 1.01e-3 off where 7e-4
// was expected. The report's finer run by elements had genalpha's steps too, which are 8e-3 off without the modes'
// exact motion.
TEST(MendedPromise, StepsOfOneSolveCountMore) {
  const std::string scene =
      "beam: {spans: 14.1, EI: 1.04571e+10, mass: 6185.48, damping_ratios: 0.0104}\n"
      "support: {types: [clamped, roller]}\n" +
      heavy_axle + "train: {vehicles: car, speed: 63.1}\nscene: {tail: 0.3}\n";
  const Results chosen = run_yaml(scene, {{"accuracy", "1e-3"}, {"accuracy_report", "true"}});
  expect_kept(chosen, run_yaml(scene, finer("100", "5e-5")), {"deflection", "acceleration", "moment", "wheel_force"},
              1e-3);
}

// A heavy wheel vibrates at 167 Hz between its contact and a stiff spring, not at 102 Hz on its contact alone, and is
// seen in accelerations up to twice that: four modes agreed with six to 3e-3 where they were 1.1e-2 off.
TEST(MendedPromise, StiffSpringsCountWithTheContact) {
  const std::string scene =
      "beam: {spans: 21.4, EI: 2.8052e+10, mass: 9054.57, damping_ratios: 0.016}\n"
      "support: {types: [pinned, roller]}\n" +
      one_wheel("29804.3", "4496.35", "3.101e+09", "57707.8", "7.52796e+10") + "train: {vehicles: car, speed: 49.2}\n";
  expect_kept(run_yaml(scene, {{"accuracy", "1e-2"}}), run_yaml(scene, finer("100", "1e-4")),
              {"deflection", "acceleration", "moment", "wheel_force"}, 1e-2);
}

// Wheels touch the bridge's slopes ahead of their centres and move along the track, which runs by modes once left out:
// accelerations of a short span were 1.5e-3 off, whatever the number of modes.
TEST(MendedPromise, SlopesOfShortSpansCountMore) {
  const std::string scene =
      "beam: {spans: [13.4, 10.8], EI: 3.37012e+09, mass: 4079.67, damping_ratios: 0.0062}\n"
      "support: {types: [pinned, roller, roller]}\n"
      "vehicle: {coach: {file: " +
      source_folder() +
      "/options/vehicles/manchester.yml}}\n"
      "train: {vehicles: coach*2, speed: 20.4}\nscene: {tail: 0.3}\n";
  expect_kept(run_yaml(scene, {{"accuracy", "1e-3"}}), run_yaml(scene, finer("64", "2e-4")), {"acceleration"}, 1e-3);
}

// What a mesh leaves of an acceleration comes and goes with where its nodes are: by the fourth power fewer elements
// were foreseen, which left 1.4e-4.
TEST(MendedPromise, AccelerationsSettleWithTheSquareOfTheMesh) {
  const std::string scene = coaches("beam: {spans: 42.5, EI: 3.12257e+11, mass: 16893.2, damping_ratios: 0.013}\n",
                                    "velaro", "vehicles: coach, speed: 90.3");
  const Values wanted = {{"accuracy", "1e-4"}, {"accuracy_of", "deflection,moment,acceleration"}};
  expect_kept(run_yaml(scene, wanted), run_yaml(scene, finer("400", "1e-4")), {"acceleration"}, 1e-4);
}

// Nodes pass this wheel as fast as it vibrates on its contact: 64 elements and 128 are 2e-4 and 3e-4 off to either
// side, and by what halving them changed 5e-5 was expected.
TEST(MendedPromise, MeshesBetweenTell) {
  const std::string scene =
      "beam: {spans: 32.9, EI: 4.49202e+10, mass: 3560.25, damping_ratios: 0.0032}\n"
      "support: {types: [pinned, roller]}\n" +
      one_wheel("18149.8", "4784.76", "1.04317e+07", "57478.7", "1.26602e+11") +
      "train: {vehicles: car, positions: 0, speed: 29.6}\nscene: {tail: 0.0}\n";
  expect_kept_if_promised(run_yaml(scene, {{"accuracy", "1e-4"}}), run_yaml(scene, finer("320", "1e-4")),
                          {"deflection", "acceleration", "moment", "wheel_force"}, 1e-4);
}

// Steps of 7 ms leave 0.03 to 1.3 % of an acceleration, by where they end: no trial tells, but the run itself has
// another peak than the better trial.
TEST(MendedPromise, RunsAreComparedWithTheBetterTrial) {
  const std::string soft = one_wheel("11331.4", "3580.75", "709425", "33433.8", "4.42511e+06", "linear");
  for (const char* speed : {"105.0", "105.8", "106.4"}) {
    const std::string scene =
        "beam: {spans: 42.0*3, EI: 3.98389e+11, mass: 23579.2, damping_ratios: 0.0334, continuity: simply_supported}\n"
        "support: {types: [pinned, roller, roller, roller]}\n" +
        soft + "train: {vehicles: car, positions: -6, speed: " + speed + "}\nscene: {tail: 1.0}\n";
    SCOPED_TRACE(speed);
    expect_kept_if_promised(run_yaml(scene, {{"accuracy", "1e-2"}}), run_yaml(scene, finer("28", "5e-4")),
                            {"deflection", "acceleration", "moment", "wheel_force"}, 1e-2);
  }
}

// A wheel's force that steps of genalpha left 1.1e-2 off: two steps of esdirk4, both longer than those of the better
// trial now, had agreed by chance.
TEST(MendedPromise, TheBetterTrialTakesShorterSteps) {
  const std::string scene =
      "beam: {spans: [59.1, 45.0, 47.7, 50.7], EI: 3.53771e+11, mass: 9308.31, damping_ratios: 0.0177}\n"
      "support: {types: [clamped, roller, roller, roller, roller]}\n"
      "vehicle: {coach: {file: " +
      source_folder() +
      "/options/vehicles/manchester.yml}}\ntrain: {vehicles: coach*3, speed: 56.2}\nscene: {tail: 0.0}\n";
  expect_kept(run_yaml(scene, {{"accuracy", "1e-2"}}), run_yaml(scene, finer("30", "5e-4")), {"wheel_force"}, 1e-2);
}

// The acceleration under a force depends on where steps end: three of them agreed on a peak that was 1.3e-2 off.
TEST(MendedPromise, StepsThatEndElsewhereTell) {
  const std::string scene =
      "beam: {spans: 13.3, EI: 1.96025e+10, mass: 17405.3, damping_ratios: 0.0418}\n"
      "support: {types: [pinned, roller]}\n"
      "load: {forces: 2.148e+05*4, positions: [0.0, -3.67, -6.51, -13.37], speed: 35.9}\nscene: {tail: 1.0}\n";
  expect_kept(run_yaml(scene, {{"accuracy", "1e-2"}}), run_yaml(scene, finer("64", "2e-4")), {"acceleration"}, 1e-2);
}

// Steps of 6.4 ms, which do not follow the contact's vibration of 4.2 ms, agreed on an acceleration by chance, after
// steps of 3.2 ms had not; 6.5 ms were 1.7e-3 off.
TEST(MendedPromise, LongerStepsAreNotBetter) {
  const std::string one = one_wheel("16355.8", "762.108", "9.4744e+06", "86985.6", "1.71091e+09", "linear");
  const std::string scene =
      "beam: {spans: [42.9, 49.8, 54.7], EI: 1.19361e+12, mass: 23708.1, damping_ratios: 0.0354}\n"
      "support: {types: [clamped, roller, roller, roller]}\n" +
      one + "train: {vehicles: car, positions: -6.0, speed: 27.4}\nscene: {tail: 1.0}\n";
  expect_kept(run_yaml(scene, {{"accuracy", "1e-3"}}), run_yaml(scene, finer("36", "8e-4")), {"acceleration"}, 1e-3);
}

// On a mesh twice as dense as that which was tried steps of 0.46 ms leave 1.06e-3 of a low-passed acceleration, where
// 5e-4 was expected.
TEST(MendedPromise, StepsAreTriedOnTheMeshThatIsTaken) {
  const std::string scene =
      "beam: {spans: 60.0, EI: 1.3e7, mass: 120.0, damping_ratios: 0.02}\nsupport: {types: free}\n"
      "foundation: {vertical_bed: {k: 4.0e7, c: 3.0e4}}\n" +
      one_wheel("12000.0", "900.0", "1.2e6", "2e4", "9e10") +
      "train: {vehicles: car, positions: 10.0, speed: 50.0}\nts: {max_time: 0.8}\n";
  const Values wanted = {{"accuracy", "1e-3"}, {"accuracy_of", "deflection,moment,wheel_force,acceleration_lowpass"}};
  const Values fine = finer("928", "1.15e-4") + Values{{"output_lowpass", "137.832"}};
  expect_kept(run_yaml(scene, wanted), run_yaml(scene, fine), {"acceleration_lowpass"}, 1e-3);
}

// An axle between two stiff springs passes nodes about as fast as it vibrates: a wheel's force agreed by 32 and 64
// elements, which leave 7.7e-5 of it, and was promised to 1e-5.
TEST(MendedPromise, MeshesBetweenTellOfForces) {
  const std::string scene =
      "beam: {spans: [67.6, 61.5, 42.4, 48.1], EI: 7.91082e+10, mass: 2353.86, damping_ratios: 0.0279}\n"
      "support: {types: [pinned, roller, roller, roller, roller]}\n" +
      one_wheel("12999.2", "1695.94", "2.48262e+09", "92714.4", "1.08855e+11") +
      "train: {vehicles: car, speed: 48.7}\nscene: {tail: 1.0}\n";
  const Results chosen = run_yaml(scene, {{"accuracy", "1e-5"}});
  const Results exact = run_yaml(scene, finer("256", "1.15e-3"));
  const double error = std::abs(peak_of(chosen, "wheel_force") / peak_of(exact, "wheel_force") - 1.0);
  EXPECT_LT(error, expected(chosen, "wheel_force") ? 1e-5 : 1e-3);
}

// A body presses its wheel most a quarter of a second behind the bridge, where a vibration that the corner at its end
// stirs is on top: trial runs ended before, by steps of 2.2 ms, which leave 1.06e-5.
TEST(MendedPromise, TrialsOfMostOfARunSeeItsEnd) {
  const std::string scene =
      "beam: {spans: [40.2, 46.2, 60.3, 41.3], EI: 1.58712e+11, mass: 4302.84, damping_ratios: 0.0112}\n"
      "support: {types: [pinned, roller, roller, roller, roller]}\n" +
      one_wheel("6788.1", "150.431", "694377", "0.0", "7.22841e+10") +
      "train: {vehicles: car, speed: 18.4}\nscene: {tail: 1.0}\n";
  const Values wanted = {{"accuracy", "1e-5"}, {"accuracy_of", "wheel_force"}};
  expect_kept(run_yaml(scene, wanted), run_yaml(scene, finer("64", "2e-4")), {"wheel_force"}, 1e-5);
}

// A tenth of a second later than trial runs saw, the force of a wheel was 2.1e-4 off, where 3e-5 was expected.
TEST(MendedPromise, TrialsSeeTheSwingBehindTheBridge) {
  const std::string scene =
      "beam: {spans: [30.0, 31.4, 32.2, 33.4], EI: 1.0508e+11, mass: 6372.16, damping_ratios: 0.0224}\n"
      "support: {types: [pinned, roller, roller, roller, roller]}\n" +
      one_wheel("10025.3", "1503.42", "3.97415e+06", "0.0", "7.76868e+10") +
      "train: {vehicles: car, positions: -6.0, speed: 54.0}\nscene: {tail: 1.0}\n";
  const Values wanted = {{"accuracy", "1e-4"}, {"accuracy_of", "deflection,moment,wheel_force"}};
  expect_kept(run_yaml(scene, wanted), run_yaml(scene, finer("64", "2e-4")), {"wheel_force"}, 1e-4);
}

// Stiff springs that nothing damps vibrate on over four spans, and steps that agreed on the first take 3.4e-5 of the
// wheel's force by the end, where 4e-6 were expected.
TEST(MendedPromise, VibrationThatNothingDampsAddsUp) {
  const std::string scene =
      "beam: {spans: 23.6*4, EI: 5.65279e+09, mass: 2224.72, damping_ratios: 0.0065, continuity: simply_supported}\n" +
      one_wheel("28135.1", "1549.65", "1.37809e+10", "0.0", "7.49663e+10") +
      "train: {vehicles: car, positions: -6.0, speed: 45.4}\nscene: {tail: 0.3}\n";
  const Values wanted = {{"accuracy", "1e-5"}, {"accuracy_of", "deflection,wheel_force"}};
  expect_kept_if_promised(run_yaml(scene, wanted), run_yaml(scene, finer("64", "4e-5")), {"deflection", "wheel_force"},
                          1e-5);
}

// A body that swings on undamped springs presses its wheel most behind the bridge, when genalpha has taken all
// vibration out of it: trial runs ended before, and by two steps of genalpha they would have agreed. The force
// was 2.2e-2 off.
TEST(MendedPromise, ForcesAtTheEndOfTheRun) {
  const std::string one = one_wheel("9150.25", "251.124", "3.41941e+06", "0.0", "8.78403e+08", "linear");
  const std::string scene =
      "beam: {spans: 19.8, EI: 9.94826e+09, mass: 3318.81, damping_ratios: 0.0253}\n"
      "support: {types: [pinned, roller]}\n" +
      one + "train: {vehicles: car, speed: 81.8}\nscene: {tail: 0.3}\n";
  expect_kept(run_yaml(scene, {{"accuracy", "1e-2"}}), run_yaml(scene, finer("64", "1e-4")), {"wheel_force"}, 1e-2);
}

// Eight modes, twelve and twenty agree to 5e-5 on an acceleration of which the next ten make 9e-4.
TEST(MendedPromise, FewModesMayAgree) {
  const std::string scene =
      "beam: {spans: 25.4, EI: 1.28974e+10, mass: 4009.51, damping_ratios: 0.0458}\n"
      "support: {types: [pinned, roller]}\n" +
      one_wheel("12611.6", "5312.01", "1.81976e+06", "0.0", "5.77984e+10") +
      "train: {vehicles: car, positions: -6.0, speed: 41.7}\nscene: {tail: 0.3}\n";
  expect_kept(run_yaml(scene, {{"accuracy", "1e-3"}}), run_yaml(scene, finer("120", "1e-4")), {"acceleration"}, 1e-3);
}

// An acceleration that falls hardly faster than with the first power of the number of modes, as these yield less under
// a wheel than the bridge does: 48 modes left 1.1e-3 of it, where 7e-4 was expected.
TEST(MendedPromise, ModesMayConvergeSlowly) {
  const std::string scene =
      "beam: {spans: [66.3, 59.2, 41.1], EI: 6.16718e+10, mass: 2466.56, damping_ratios: 0.0185}\n"
      "support: {types: [pinned, roller, roller, roller]}\n" +
      one_wheel("11178.2", "4701.53", "3.48561e+06", "0.0", "1.05274e+10") +
      "train: {vehicles: car, positions: -6.0, speed: 35.2}\nscene: {tail: 0.3}\n";
  expect_kept(run_yaml(scene, {{"accuracy", "1e-3"}}), run_yaml(scene, finer("64", "5e-4")), {"acceleration"}, 1e-3);
}

// Linear vehicles that are found out of balance at the end of the run give way to the mechanisms, for which modes left
// out are static: the moment was 2.6e-4 off, where 2e-5 was expected. The run is repeated by elements.
TEST(MendedPromise, MechanismsInPlaceOfLinearVehicles) {
  std::string scene = coaches("beam: {spans: 24.0, EI: 2.07006e+10, mass: 2969.06, damping_ratios: 0.0251}\n", "s300",
                              "vehicles: coach*3, speed: 74.0");
  scene.replace(scene.find("pinned"), 6, "clamped");
  const Results chosen = run_yaml(scene, {{"accuracy", "3e-4"}});
  expect_kept(chosen, run_yaml(scene, finer("128", "1e-4")), {"moment"}, expected(chosen, "moment").value());
}

// Wheels go on striking on a rough track: runs of the first span alone expected 7e-4 of a moment that was 1.1e-2 off.
TEST(MendedPromise, WheelsThatGoOnStriking) {
  const std::string scene =
      "beam: {spans: 30.0*4, EI: 2e11, mass: 20000.0, damping_ratios: 0.01, continuity: simply_supported}\n"
      "support: {types: roller*5}\n" +
      car + "train: {vehicles: car, speed: 80.0}\ntrack: {profile: german_high, seed: 4}\n";
  expect_kept(run_yaml(scene, {{"accuracy", "1e-2"}}), run_yaml(scene, finer("64", "5e-5")), {"deflection", "moment"},
              1e-2);
}

// A stop is touched far along the bridge: with another road a moment was 1.9 times off what was wanted.
TEST(MendedPromise, StopThatIsTouchedLate) {
  std::string with_stop = car;
  with_stop.replace(with_stop.find("[suspension]"), 12, "[suspension, stop]");
  with_stop +=
      "    stop: {bodies: [body, axle], from: [0.0, 2.0], to: [0.0, 0.46], stiffness: 2e8, side: compression, gap: "
      "0.107}\n";
  const std::string scene =
      "beam: {spans: 30.0*6, EI: 2e11, mass: 20000.0, damping_ratios: 0.01, continuity: simply_supported}\n"
      "support: {types: roller*7}\n" +
      with_stop + "train: {vehicles: car, speed: 50.0}\ntrack: {profile: german_low, seed: 1}\n";
  expect_kept(run_yaml(scene, {{"accuracy", "1e-2"}}), run_yaml(scene, finer("32", "2e-4")),
              {"deflection", "acceleration", "moment", "wheel_force"}, 1e-2);
}

}  // namespace
}  // namespace traverse::test
