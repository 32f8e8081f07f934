// Bad input: one line that names the option, its value and what is allowed, before anything is computed.
#include <gtest/gtest.h>

#include "support/program.hpp"

namespace traverse::test {
namespace {

struct Case {
  std::vector<std::string> words;  // after the small scene
  std::vector<std::string> parts;  // of the message
};

void expect_refusals(const Workplace& workplace, const std::vector<Case>& cases) {
  for (const Case& c : cases) {
    std::string words;
    for (const std::string& word : c.words) words += " " + word;
    SCOPED_TRACE(words);
    expect_refusal(workplace, workplace.run(c.words), c.parts);
  }
}

TEST(BadNumbers, NegativeZeroInfiniteAndWords) {
  struct Number {
    const char* name;
    bool zero_is_allowed, negative_is_allowed;
  };
  const Workplace workplace(small_scene());
  std::vector<Case> cases;
  for (const Number& number : {
           Number{"beam_spans", false, false},
           {"beam_EI", false, false},
           {"beam_mass", false, false},
           {"beam_elements_per_span", false, false},
           {"beam_damping_ratios", true, false},
           {"foundation_vertical_bed_k", true, false},
           {"gravity", true, false},
           {"train_speed", true, true},
           {"train_positions", true, true},
           {"ts_dt", false, false},
           {"ts_max_time", false, false},
           {"scene_tail", true, false},
           {"accuracy", false, false},
           {"output_interval", false, false},
           {"output_probes", true, false},
           {"vehicle_car_length", false, false},
           {"vehicle_car_body_mass", false, false},
           {"vehicle_car_axle_inertia", false, false},
           {"vehicle_car_body_angle", true, true},
           {"vehicle_car_suspension_stiffness", true, false},
           {"vehicle_car_suspension_preload", true, true},
           {"vehicle_car_wheel_radius", false, false},
           {"vehicle_car_wheel_stiffness", false, false},
           {"vehicle_car_wheel_friction", true, false},
           {"vehicle_car_level_rate", true, true},
       }) {
    const std::string option = std::string("-") + number.name;
    std::vector<std::string> values = {"nan", "inf"};
    if (!number.zero_is_allowed) values.emplace_back("0");
    if (!number.negative_is_allowed) values.emplace_back("-1");
    for (const std::string& value : values) {
      cases.push_back({{option, value}, {std::string(number.name) + " = " + value, "command line", "allowed: "}});
    }
  }
  expect_refusals(workplace, cases);
}

TEST(BadNumbers, NoNumbersAtAll) {
  const Workplace workplace(small_scene());
  expect_refusals(workplace, {
                                 {{"-train_speed", "fast"}, {"train_speed = fast", "'fast'", "allowed: a number"}},
                                 {{"-train_speed", "40kn"}, {"train_speed = 40kn", "allowed: a number"}},
                                 {{"-ts_dt", "1,0e-3"}, {"ts_dt = 1,0e-3", "allowed: a number"}},
                                 {{"-gravity", "1e400"}, {"gravity = 1e400", "allowed: a number"}},
                                 {{"-gravity"}, {"gravity", "has no value", "a number"}},
                                 {{"-beam_spans", "20,,20"}, {"beam_spans = 20,,20", "empty entry"}},
                                 {{"-beam_spans", "20*x"}, {"beam_spans = 20*x", "whole number"}},
                                 {{"-beam_spans", "1e9"}, {"beam_spans = 1e9", "at most"}},
                                 {{"-beam_elements_per_span", "2.5"}, {"2.5", "whole numbers"}},
                                 {{"-beam_elements_per_span", "1e9"}, {"1e9", "whole numbers"}},
                                 {{"-accuracy", "0.5"}, {"accuracy = 0.5", "from 1e-10 to 0.1"}},
                                 {{"-beam_damping_ratios", "1.5"}, {"1.5", "from 0 to 0.999"}},
                                 {{"-output_quiet", "perhaps"}, {"perhaps", "true or false"}},
                                 {{"-load_hslm_a", "11"}, {"load_hslm_a = 11", "from 1 to 10"}},
                                 {{"-modes_count", "0"}, {"modes_count = 0", "whole number"}},
                                 {{"-vehicle_car_wheel_restitution", "2"}, {"= 2", "above 0, at most 1"}},
                                 {{"-vehicle_car_suspension_gap", "-0.1"}, {"gap = -0.1", "not below 0"}},
                                 {{"-vehicle_car_suspension_side", "up"}, {"side = up", "compression, tension"}},
                                 {{"-vehicle_car_suspension_table", "none.csv"}, {"table = none.csv", "file"}},
                             });
}

// f2 is four times f1, but for the mesh: elements, modes, sweeps and checks alike name the second ratios that are
// possible.
TEST(BadNumbers, DampingThatFeedsEnergy) {
  const Workplace workplace("beam: {spans: 20.0, EI: 2.0e10, mass: 1.5e4}\nload: {forces: 2.0e5, speed: 50.0}\n");
  const std::vector<std::string> falls = {"beam_damping_ratios = 0.05,0.01", "negative b", "from 0.0124", "to 0.2000"};
  expect_refusals(
      workplace, {
                     {{"-beam_damping_ratios", "0.05,0.01"}, falls},
                     {{"-beam_damping_ratios", "0.05,0.01", "-model_modes", "4"}, falls},
                     {{"-beam_damping_ratios", "0.05,0.01", "-sweep_speed", "40,50,5"}, falls},
                     {{"-beam_damping_ratios", "0.05,0.01", "-describe"}, falls},
                     {{"-beam_damping_ratios", "0.05,0"}, {"beam_damping_ratios = 0.05,0", "from 0.0124", "to 0.2000"}},
                     {{"-beam_damping_ratios", "0.01,0.05"}, {"beam_damping_ratios = 0.01,0.05", "negative a"}},
                     {{"-beam_damping_ratios", "0.01,0.02", "-beam_damping_frequencies", "5,6"}, {"0.01,0.02"}},
                     {{"-beam_rayleigh", "0.1,-1e-4"}, {"beam_rayleigh = 0.1,-1e-4", "not below 0"}},
                     {{"-beam_rayleigh", "-0.1,1e-4"}, {"beam_rayleigh = -0.1,1e-4", "not below 0"}},
                     {{"-model_modes", "2", "-model_damping_ratios", "-0.1"}, {"model_damping_ratios = -0.1"}},
                 });
}

TEST(BadNames, MisspeltOnesGetAProposal) {
  const Workplace workplace(small_scene());
  expect_refusals(workplace,
                  {
                      {{"-beam_spnas", "3"}, {"beam_spnas = 3", "did you mean beam_spans?"}},
                      {{"-ts_tpye", "bdf"}, {"ts_tpye = bdf", "did you mean ts_type?"}},
                      {{"-ts_type", "bdf", "-ts_bdf_ordr", "2"}, {"ts_bdf_ordr = 2", "did you mean ts_bdf_order?"}},
                      {{"-vehicle_car_body_mas", "3"}, {"vehicle_car_body_mas = 3", "vehicle_car_body_mass?"}},
                      {{"-train_vehicles", "cra"}, {"train_vehicles = cra", "not defined", "did you mean car?"}},
                      {{"-support_types", "pined"}, {"support_types = pined", "one of free, roller, pinned"}},
                      {{"-scene_analysis", "static_"}, {"scene_analysis = static_", "transient, modes, static"}},
                      {{"-model_axial", "maybe"}, {"model_axial = maybe", "one of auto, true, false"}},
                      {{"-vehicle_car_wheel_law", "square"}, {"wheel_law = square", "one of hertz, linear"}},
                      {{"-vehicle_car_guide_type", "hinge"}, {"guide_type = hinge", "one of revolute, prismatic"}},
                      {{"-track_profile", "bumpy"}, {"track_profile = bumpy", "none, bump"}},
                      {{"astray"}, {"astray", "is not the value of an option"}},
                  });
}

TEST(BadNames, CouplersThatJoinNothing) {
  const Workplace workplace(small_scene());
  const auto coupler = [](std::vector<std::string> more) {
    std::vector<std::string> all = {"-train_vehicles", "car*2", "-train_spacing",        "10",
                                    "-train_couplers", "gear",  "-train_gear_from",      "-4,1",
                                    "-train_gear_to",  "4,1",   "-train_gear_stiffness", "1e6"};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  };
  expect_refusals(
      workplace,
      {
          {coupler({"-train_gear_bodies", "body,bogie"}), {"vehicle 1", "no body 'bogie'"}},
          {coupler({"-train_gear_bodies", "body,body", "-train_gear_after", "1"}), {"after = 1", "from 0 to 0"}},
          {coupler({"-train_gear_bodies", "body,body", "-train_vehicles", "car"}),
           {"gear needs a train of at least two vehicles"}},
          {coupler({"-train_gear_bodies", "body,body", "-train_gear_typ", "slot"}), {"gear_type?"}},
      });
}

TEST(BadNames, PartsThatNoListNames) {
  const Workplace workplace(small_scene());
  expect_refusals(workplace, {
                                 {{"-vehicle_car_springs", ""}, {"suspension", "list"}},
                                 {{"-vehicle_car_wheels", ""}, {"vehicle_car_wheel_", "list"}},
                             });
}

TEST(BadCounts, ListsOfTheWrongLength) {
  const Workplace workplace(small_scene());
  expect_refusals(
      workplace,
      {
          {{"-support_types", "pinned,roller"}, {"support_types = pinned,roller", "2 entries", "3 (one per span end)"}},
          {{"-beam_damping_ratios", "0.1,0.1,0.1"}, {"beam_damping_ratios", "3 entries", "2 (zeta1 and zeta2)"}},
          {{"-beam_rayleigh", "1"}, {"beam_rayleigh = 1", "2 numbers"}},
          {{"-beam_elements_per_span", "4,4,4"}, {"3 entries", "2 (one per span)"}},
          {{"-train_positions", "1,2"}, {"train_positions = 1,2", "2 entries"}},
          {{"-train_vehicles", "car*3", "-train_positions", "1,2"}, {"2 entries", "3 (one per vehicle)"}},
          {{"-train_vehicles", "car*2"}, {"train_spacing", "missing", "vehicle_car_length"}},
          {{"-vehicle_car_body_position", "1"}, {"vehicle_car_body_position = 1", "2 numbers"}},
          {{"-vehicle_car_body_position", "1,2,3"}, {"vehicle_car_body_position = 1,2,3", "2 numbers"}},
          {{"-vehicle_car_guide_bodies", "body"}, {"vehicle_car_guide_bodies = body", "2 names"}},
          {{"-foundation_vertical_x", "1,2", "-foundation_vertical_k", "1,2,3"}, {"foundation_vertical_k", "2"}},
          {{"-foundation_vertical_k", "1"}, {"foundation_vertical_k = 1", "needs foundation_vertical_x"}},
          {{"-load_forces", "1,2"}, {"load_positions", "missing"}},
      });
}

TEST(BadFoundations, LawsThatAreNotLinear) {
  const Workplace workplace(small_scene());
  const auto point = [](std::vector<std::string> words) {
    words.insert(words.end(), {"-foundation_vertical_x", "5,15", "-foundation_vertical_k", "1e7"});
    return words;
  };
  expect_refusals(
      workplace,
      {
          {point({"-foundation_vertical_gap", "-1e-3"}), {"foundation_vertical_gap = -1e-3", "not below 0"}},
          {point({"-foundation_vertical_cubic", "nan"}), {"foundation_vertical_cubic = nan", "allowed: "}},
          {point({"-foundation_vertical_one_sided", "maybe"}), {"one_sided = maybe", "one of true, false"}},
          {point({"-foundation_vertical_one_sided", "true,true,true"}), {"3 entries", "2 (one per station)"}},
          {point({"-foundation_vertical_side", "middle"}), {"side = middle", "one of right, left, both"}},
          {point({"-foundation_vertical_side", "both"}), {"side = both", "at 5 m", "allowed there: right"}},
          {{"-foundation_vertical_gap", "1e-3"}, {"foundation_vertical_gap", "needs foundation_vertical_x"}},
          {{"-foundation_rotational_x", "5", "-foundation_rotational_gap", "1e-3"},
           {"foundation_rotational_x", "needs foundation_rotational_k"}},
          {{"-foundation_rotational_one_sided", "true"}, {"foundation_rotational_one_sided", "did you mean"}},
          {{"-foundation_vertical_bed_one_sided", "true"}, {"bed_one_sided = true", "needs foundation_vertical_bed_k"}},
          {{"-foundation_longitudinal_bed_gap", "1e-3"}, {"needs foundation_longitudinal_bed_k"}},
      });
}

// What nothing holds in the end is found out in statics, and named.
TEST(BadFoundations, NoEquilibriumOnThem) {
  const Workplace workplace(
      "beam: {spans: 20.0, elements_per_span: 4, EI: 1.0e9, mass: 2000.0}\n"
      "support: {types: [roller, free]}\n"
      "foundation: {vertical: {x: 15.0, k: 1.0e7, one_sided: true}}\n"
      "load: {forces: -1.0e5, positions: 18.0, speed: 1.0}\nts_max_time: 0.1\n");
  const Outcome outcome = workplace.run({});
  EXPECT_NE(outcome.status, 0);
  EXPECT_NE(outcome.err.find("no static equilibrium"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("foundation_vertical at x = 15 m"), std::string::npos) << outcome.err;
}

TEST(BadPlaces, OffTheBeam) {
  const Workplace workplace(small_scene());
  expect_refusals(workplace,
                  {
                      {{"-output_probes", "40.001"}, {"output_probes = 40.001", "from 0 to 40 m"}},
                      {{"-foundation_vertical_x", "41", "-foundation_vertical_k", "1"}, {"= 41", "from 0 to 40 m"}},
                  });
}

TEST(BadFiles, MissingOnes) {
  const Workplace workplace(small_scene());
  workplace.write("tables/EI.csv", "0 1.0e10\n40 1.0e10\n");
  expect_refusals(workplace, {
                                 {{"-options_file", "none.yml"}, {"options_file = none.yml", "no such file"}},
                                 {{"-vehicle_car_file", "none.yml"}, {"vehicle_car_file = none.yml", "no such file"}},
                                 {{"-beam_EI", "none.csv"}, {"beam_EI = none.csv", "neither a number nor a file"}},
                                 {{"-track_profile", "none.csv"}, {"track_profile = none.csv", "no such file"}},
                                 {{"-beam_EI", "tables"}, {"beam_EI = tables", "folder"}},
                             });
}

TEST(BadFiles, TheirErrorsNameFileAndLine) {
  const Workplace workplace(small_scene());
  workplace.write("flow.yml", "beam:\n  spans: [1.0, 2.0\n  EI: 3.0\n");
  workplace.write("tab.yml", "beam:\n\tspans: 3.0\n");
  workplace.write("twice.yml", "gravity: 9.81\nbeam:\n  EI: 1.0e9\n  EI: 2.0e9\n");
  workplace.write("nested.yml", "gravity: 9.81\noptions_file: none.yml\n");
  workplace.write("vehicle.yml", "bodies: [body]\nbody: {mass: heavy, inertia: 1.0, position: [0.0, 1.0]}\n");
  workplace.write("word.csv", "0 1.0e10\n# comment\n20 stiff\n");
  workplace.write("three.csv", "0 1.0e10\n20 1.0e10 3\n");
  workplace.write("negative.csv", "0 1.0e10\n20 -1.0\n");
  workplace.write("backward.csv", "5 1.0e10\n3 1.0e10\n");
  workplace.write("empty.csv", "# nothing\n");
  expect_refusals(workplace, {
                                 {{"-options_file", "flow.yml"}, {"flow.yml:3: ", "YAML"}},
                                 {{"-options_file", "tab.yml"}, {"tab.yml:2: ", "YAML", "tab"}},
                                 {{"-options_file", "twice.yml"}, {"twice.yml:4: ", "beam_EI", "line 3"}},
                                 {{"-options_file", "nested.yml"}, {"options_file = none.yml", "nested.yml:2"}},
                                 {{"-vehicle_truck_file", "vehicle.yml", "-train_vehicles", "truck"},
                                  {"vehicle_truck_body_mass = heavy", "vehicle.yml:2", "allowed: a number above 0"}},
                                 {{"-beam_EI", "word.csv"}, {"word.csv:3: ", "'stiff'"}},
                                 {{"-beam_EI", "three.csv"}, {"three.csv:2: ", "3 numbers, expected 2"}},
                                 {{"-beam_EI", "negative.csv"}, {"beam_EI = negative.csv", "-1", "above 1e-07"}},
                                 {{"-beam_EI", "backward.csv"}, {"backward.csv", "row 2", "must not decrease"}},
                                 {{"-beam_EI", "empty.csv"}, {"empty.csv", "no numbers"}},
                             });
}

TEST(BadMechanisms, BodiesAndJoints) {
  const Workplace workplace(small_scene());
  expect_refusals(
      workplace,
      {
          {{"-vehicle_car_guide_bodies", "body,axel"}, {"guide_bodies = body,axel", "'axel'", "did you mean axle?"}},
          {{"-vehicle_car_guide_bodies", "body,body"}, {"guide_bodies = body,body", "two different bodies"}},
          {{"-vehicle_car_wheel_body", "ground"}, {"wheel_body = ground", "vehicle_car_bodies"}},
          {{"-vehicle_car_guide_axis", "0,0"}, {"guide_axis = 0,0", "a direction"}},
          {{"-vehicle_car_suspension_to", "0,2"}, {"suspension_to = 0,2", "same point"}},
          {{"-vehicle_car_bodies", "body,axle,body"}, {"bodies = body,axle,body", "'body'"}},
          {{"-vehicle_car_joints", "guide,body"}, {"joints = guide,body", "'body'", "name"}},
      });
}

TEST(BadMechanisms, ConstraintsThatContradictEachOther) {
  const Workplace workplace(small_scene());
  const std::string high = "-vehicle_car_high_";
  const std::string pin = "-vehicle_car_pin_";
  expect_refusals(workplace, {
                                 {{"-vehicle_car_drivers", "level,high", high + "body", "body", high + "coordinate",
                                   "phi", high + "rate", "1"},
                                  {"'high'", "contradicts", "'level'"}},
                                 {{"-vehicle_car_drivers", "level,high", high + "body", "axle", high + "coordinate",
                                   "phi", high + "value", "0.1"},
                                  {"'guide'", "contradicts", "'high'"}},
                                 {{"-vehicle_car_joints", "guide,pin", pin + "type", "revolute", pin + "bodies",
                                   "body,ground", pin + "point", "0,1"},
                                  {"'pin'", "contradicts", "driver"}},
                             });
}

TEST(BadMechanisms, RedundantJointsRunAndAreNamed) {
  const Workplace workplace(small_scene());
  const std::string second = "-vehicle_car_second_";
  const Outcome outcome =
      workplace.run({"-vehicle_car_joints", "guide,second", second + "type", "prismatic", second + "bodies",
                     "body,axle", second + "point", "0,1", second + "axis", "0,1"});
  expect_success(outcome);
  EXPECT_NE(outcome.out.find("second has redundant equations"), std::string::npos) << outcome.out;
}

TEST(BadStructures, WhatCanFloatAway) {
  const Workplace workplace(small_scene());
  expect_refusals(workplace,
                  {
                      {{"-support_types", "free"}, {"support_types", "float away", "vertically and rotate"}},
                      {{"-support_types", "free,roller,free"}, {"support_types", "rotate about x = 20 m"}},
                      {{"-support_types", "roller", "-model_axial", "true"}, {"support_types", "move along x"}},
                      {{"-support_types", "roller", "-vehicle_car_wheel_friction", "0.3"}, {"move along x"}},
                  });
}

TEST(BadStructures, ForceAgainstNothing) {
  const Workplace workplace(small_scene());
  expect_refusals(workplace, {{{"-vehicle_car_suspension_stiffness", "0"}, {"no static equilibrium", "scene_start"}}});
}

TEST(BadRuns, NoEnd) {
  const Workplace workplace(small_scene());
  expect_refusals(workplace, {
                                 {{"-train_speed", "0"}, {"ts_max_time", "train_speed is 0"}},
                                 {{"-train_drive", "free", "-train_positions", "50"}, {"ts_max_time"}},
                             });
  const Workplace beamless(quarter_car);
  expect_refusals(beamless, {{{}, {"ts_max_time"}}});
}

TEST(BadRuns, NothingToSimulate) {
  const Workplace workplace("gravity: 9.81\n");
  expect_refusals(workplace, {
                                 {{}, {"nothing to simulate", "beam_spans", "train_vehicles"}},
                                 {{"-load_forces", "1e5"}, {"beam_spans"}},
                                 {{"-support_types", "pinned"}, {"support_types", "no beam without beam_spans"}},
                             });
}

TEST(BadRuns, Integrators) {
  const Workplace workplace(small_scene());
  expect_refusals(workplace, {
                                 {{"-ts_type", "rosw"}, {"ts_type", "rosw", "allowed: esdirk4, genalpha, arkimex"}},
                                 {{"-ts_type", "alpha"}, {"ts_type", "alpha", "allowed: esdirk4, genalpha, arkimex"}},
                                 {{"-ts_type", "alpha2"}, {"ts_type", "alpha2", "allowed: esdirk4, genalpha, arkimex"}},
                                 {{"-ts_type", "cn"}, {"ts_type = cn", "allowed: esdirk4, genalpha, arkimex, bdf"}},
                                 {{"-ts_type", "beuler"}, {"ts_type = beuler", "rk (explicit, small scenes)"}},
                                 {{"-ts_theta_theta", "0.5"}, {"ts_theta_theta"}},
                                 {{"-ts_arkimex_fully_implicit", "0"}, {"ts_arkimex_fully_implicit"}},
                                 {{"-ts_type", "bdf", "-ts_bdf_order", "3"}, {"ts_bdf_order", "3", "allowed: 1, 2"}},
                                 {{"-ts_type", "bfd"}, {"ts_type", "bfd", "allowed"}},
                                 {{"-ts_type", "bdf", "-ts_bdf_order", "9"}, {"ts_bdf_order", "9", "allowed"}},
                                 {{"-ts_arkimex_type", "7"}, {"ts_arkimex_type", "7", "4"}},
                                 {{"-ts_dt", "1e-30"}, {"ts_dt = 1e-30", "allowed"}},
                             });
}

TEST(BadInputOnTwoRanks, IsSaidOnce) {
  const Workplace workplace(small_scene());
  const std::string high = "-vehicle_car_high_";
  for (const Case& c : std::vector<Case>{
           {{"-options_file", "none.yml"}, {"options_file = none.yml"}},
           {{"-beam_EI", "-1"}, {"beam_EI = -1", "allowed"}},
           {{"-ts_tpye", "bdf"}, {"ts_tpye", "ts_type"}},
           {{"-ts_type", "rosw"}, {"ts_type", "rosw"}},
           {{"-support_types", "free"}, {"support_types"}},
           {{"-vehicle_car_suspension_stiffness", "0"}, {"no static equilibrium"}},
           {{"-vehicle_car_drivers", "level,high", high + "body", "body", high + "coordinate", "phi", high + "rate",
             "1"},
            {"contradicts"}},
       }) {
    SCOPED_TRACE(c.words.front());
    expect_refusal(workplace, workplace.run(c.words, 2), c.parts);
  }
}

}  // namespace
}  // namespace traverse::test
