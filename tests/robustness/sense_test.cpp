// What runs without an error but cannot be meant is refused; what is possible but unusual is noted.
#include <gtest/gtest.h>

#include "support/folders.hpp"
#include "support/program.hpp"

namespace traverse::test {
namespace {

struct Case {
  std::vector<std::string> words;  // after the scene
  std::vector<std::string> parts;  // of the message or of a note
};

void expect_refusals(const Workplace& workplace, const std::vector<Case>& cases) {
  for (const Case& c : cases) {
    std::string words;
    for (const std::string& word : c.words) words += " " + word;
    SCOPED_TRACE(words);
    expect_refusal(workplace, workplace.run(c.words), c.parts);
  }
}

/// The line of the output that holds the first part; empty when none does.
std::string line_with(const Outcome& outcome, const std::string& part) {
  for (const std::string& line : lines_of(outcome.out))
    if (line.find(part) != std::string::npos) return line;
  return "";
}

void expect_notes(const Workplace& workplace, const std::vector<Case>& cases) {
  for (const Case& c : cases) {
    std::string words;
    for (const std::string& word : c.words) words += " " + word;
    SCOPED_TRACE(words);
    const Outcome outcome = workplace.run(c.words);
    expect_success(outcome);
    const std::string line = line_with(outcome, c.parts.front());
    EXPECT_NE(line, "") << outcome.out;
    for (const std::string& part : c.parts)
      EXPECT_NE(line.find(part), std::string::npos) << "no '" << part << "' in: " << line;
  }
}

std::string forces_only(const std::string& more = "") {
  return std::string(two_spans) + "load: {forces: 1.0e5, speed: 40.0}\nts_dt: 0.01\noutput: {file: none}\n" + more;
}

// --- the surface's ends ----------------------------------------------------------------------------------------------

TEST(SurfaceEnds, WheelsThatStartWhereThereIsNone) {
  const Workplace workplace(small_scene());
  expect_refusals(workplace, {{{"-surface_left", "none", "-train_positions", "-1"},
                               {"surface_left", "x = -1 m, where there is no surface", "allowed: rigid"}},
                              {{"-surface_right", "nothing"}, {"surface_right", "one of rigid, none"}}});
  const Workplace nothing("load: {forces: 1.0e5, speed: 40.0}\n");
  expect_refusals(nothing, {{{"-surface_right", "none"}, {"surface_right", "no beam"}}});
}

// --- PETSc's options -------------------------------------------------------------------------------------------------

TEST(PetscOptions, NamesThatNothingAsksFor) {
  const Workplace workplace(small_scene());
  for (const std::string name : {"petscfoo",  "dm_bar",   "mpifoo",     "tmpx",     "versionx",  "hdf5_nonsense",
                                 "viewx",     "x_foo",    "draw_bar",   "is_foo",   "sf_foo",    "displayx",
                                 "pythonfoo", "slepcx",   "infox",      "debugx",   "log_viewx", "on_error_foo",
                                 "devicefoo", "saws_foo", "citationsx", "cuda_foo", "fp_trapx",  "nonsense_vec_type",
                                 "vec_type",  "mat_typ",  "bv_foo"}) {
    SCOPED_TRACE(name);
    expect_refusal(workplace, workplace.run({"-" + name, "nonsense"}), {"option " + name, "= nonsense"});
  }
}

TEST(PetscOptions, SolversThatAreNotThereHaveNone) {
  const Workplace workplace(small_scene());
  expect_refusals(workplace, {{{"-snes_monitor"}, {"option snes_monitor", "did you mean ts_monitor?"}},
                              {{"-ksp_rtol", "1e-3"}, {"option ksp_rtol = 1e-3"}},
                              {{"-pc_factor_mat_solver_type", "mumps"}, {"option pc_factor_mat_solver_type = mumps"}},
                              {{"-st_type", "foo"}, {"option st_type = foo"}},
                              {{"-eps_type", "foo"}, {"option eps_type = foo"}},
                              {{"-eps_tol", "1e-3", "-scene_analysis", "modes"}, {"option eps_tol = 1e-3"}}});
}

TEST(PetscOptions, ThoseListedPass) {
  const Workplace workplace(forces_only("ts_max_time: 0.05\n"));
  for (const std::vector<std::string>& words : std::vector<std::vector<std::string>>{
           {"-malloc_debug"}, {"-log_view"}, {"-ts_monitor"}, {"-ts_view"}, {"-skip_petscrc"}}) {
    SCOPED_TRACE(words.front());
    EXPECT_EQ(workplace.run(words).status, 0);
  }
  EXPECT_NE(workplace.run({"-log_view"}).out.find("PETSc Performance Summary"), std::string::npos);
}

TEST(PetscOptions, ValuesThatItRefusesAreNamed) {
  const Workplace workplace(small_scene());
  for (const char* option : {"ts_adapt_type", "ts_adapt_dt_min", "ts_rtol", "ts_monitor"}) {
    SCOPED_TRACE(option);
    const Outcome outcome = workplace.run({"-" + std::string(option), "nonsense"});
    expect_refusal(workplace, outcome, {std::string(option) + " = nonsense (command line)", "allowed: "});
  }
  expect_refusal(workplace, workplace.run({"-ts_adapt_clip", "5"}), {"traverse: ts_adapt_clip = 5"});
  const Outcome outcome = workplace.run({"-ts_type", "rk", "-ts_rk_type", "nonsense"});
  expect_refusal(workplace, outcome,
                 {"traverse: ts_rk_type = nonsense (command line): PETSc does not allow it: Unknown"});
}

TEST(PetscOptions, StepsAreCountedFromOne) {
  const Workplace workplace(small_scene());
  expect_refusals(workplace, {{{"-ts_max_steps", "0"}, {"ts_max_steps = 0", "whole number from 1"}},
                              {{"-ts_max_steps", "-5"}, {"ts_max_steps = -5", "whole number from 1"}},
                              {{"-ts_max_steps", "1.5"}, {"ts_max_steps = 1.5", "whole number"}},
                              {{"-ts_max_steps", "many"}, {"ts_max_steps = many", "whole number"}}});
}

// --- quantities ------------------------------------------------------------------------------------------------------

TEST(Quantities, BelowAnyBeam) {
  const Workplace workplace(forces_only());
  for (const char* analysis : {"transient", "modes", "static"}) {
    SCOPED_TRACE(analysis);
    expect_refusals(workplace,
                    {{{"-beam_EI", "1e-14", "-scene_analysis", analysis}, {"beam_EI = 1e-14", "allowed: ", "N m2"}},
                     {{"-beam_spans", "1e-49*2", "-scene_analysis", analysis}, {"beam_spans = 1e-49*2", "allowed: "}},
                     {{"-beam_mass", "1e-12", "-scene_analysis", analysis}, {"beam_mass = 1e-12", "allowed: "}},
                     {{"-beam_EA", "1e-20", "-scene_analysis", analysis}, {"beam_EA = 1e-20", "allowed: "}}});
  }
  workplace.write("EI.csv", "0 1e9\n40 1e-14\n");
  expect_refusals(workplace, {{{"-beam_EI", "EI.csv"}, {"beam_EI = EI.csv", "contains 1e-14", "allowed: "}}});
}

// Stiffnesses below PETSc's idea of a pivot that is zero: a matter of units. f1 = pi/(2 L^2) sqrt(EI/m).
TEST(Quantities, WeakBeamsHaveFrequencies) {
  const Workplace workplace(
      "beam: {spans: 1.0e6, EI: 1.0e-6, mass: 2303.0}\nsupport: {types: [pinned, roller]}\n"
      "scene: {analysis: modes}\nmodes: {count: 3}\noutput: {file: none}\n");
  const Outcome outcome = workplace.run({"-beam_elements_per_span", "40"});
  expect_success(outcome);
  EXPECT_NE(outcome.out.find("3.273"), std::string::npos) << outcome.out;
}

TEST(Quantities, DeflectionsBeyondAnyBeam) {
  const Workplace workplace(forces_only("sweep_speed: [30.0, 40.0, 10.0]\n"));
  const Outcome absurd = workplace.run({"-load_forces", "1e13", "-model_modes", "3"});
  EXPECT_EQ(absurd.status, 3);
  ASSERT_EQ(lines_of(absurd.err).size(), 1U) << absurd.err;
  EXPECT_NE(absurd.err.find("no beam does; check the units of beam_EI"), std::string::npos) << absurd.err;
  expect_notes(workplace, {{{"-load_forces", "3e8"}, {"note: the bridge deflects", "small displacements"}}});
}

TEST(Quantities, SpeedsInKilometresAnHour) {
  const Workplace workplace(forces_only("ts_max_time: 0.05\n"));
  expect_notes(
      workplace,
      {{{"-ts_dt", "1e-3", "-sweep_speed", "140,420,140"}, {"sweep_speed: 420 m/s is 1512 km/h", "speeds are in m/s"}},
       {{"-ts_dt", "1e-3", "-load_speed", "300"}, {"load_speed: 300 m/s", "faster than any train"}}});
  EXPECT_EQ(workplace.run({"-load_speed", "119"}).out.find("faster than any"), std::string::npos);
}

// --- values that break a line ----------------------------------------------------------------------------------------

// Between two speeds a limit may be exceeded; a search adds no speeds.
TEST(Quantities, SpeedsFartherApartThanAResonance) {
  const Workplace workplace(forces_only("beam_damping_ratios: 0.01\nlimits: " + source_folder() +
                                        "/options/limits/en1990.yml\nstudy_vary_load_speed: [20, 30, 40]\n"));
  expect_notes(workplace,
               {{{"-describe"}, {"load_speed: the step from 108 to 144 km/h", "2.16 km/h", "study_refine"}}});
  const Outcome search = workplace.run({"-describe", "-find_option", "beam_EI", "-find_between", "1e9,1e11"});
  EXPECT_NE(line_with(search, "the step from 108 to 144 km/h"), "") << search.out;
  EXPECT_EQ(line_with(search, "study_refine"), "");
}

TEST(OneLine, WhateverTheValueHolds) {
  const Workplace workplace(small_scene());
  workplace.write("folded.yml", "train_speed: |\n  4\n  x\n");
  workplace.write("block.yml", "train_speed: |\n  40.0\nts_max_time: 0.05\noutput_file: none\n");
  expect_refusals(workplace, {
                                 {{"-train_speed", "4\nx"}, {"train_speed = 4\\nx", "not a finite number"}},
                                 {{"-options_file", "folded.yml"}, {"train_speed = 4\\nx", "folded.yml:1"}},
                                 {{"-options_file", "no\nfile.yml"}, {"no\\nfile.yml"}},
                                 {{"-train_vehicles", "c\nar"}, {"c\\nar"}},
                                 {{"-ts_type", "b\ndf"}, {"b\\ndf"}},
                                 {{"-vehicle_car_file", "\xfc\x1b[31m.yml"}, {"\\xfc\\x1b[31m.yml"}},
                             });
  expect_success(workplace.run({"-options_file", "block.yml"}));  // only its end breaks the line
}

TEST(OneLine, TablesNameTheirFileAndLine) {
  const Workplace workplace(small_scene());
  workplace.write("back.csv", "# time force\n0 0\n2 1\n1 0\n");
  workplace.write("short.csv", "0 0\n");
  const std::vector<std::string> push = {"-vehicle_car_actuators", "push", "-vehicle_car_push_body", "body",
                                         "-vehicle_car_push_table"};
  for (const std::string file : {"back.csv", "short.csv"}) {
    std::vector<std::string> words = push;
    words.push_back(file);
    const char* part = file == "back.csv" ? "back.csv:4: " : "two rows";
    expect_refusals(workplace, {{words, {"vehicle_car_push_table = " + file, part}},
                                {{"-vehicle_car_level_table", file}, {"vehicle_car_level_table = " + file, part}},
                                {{"-vehicle_car_springs", "suspension,second", "-vehicle_car_second_bodies",
                                  "body,axle", "-vehicle_car_second_from", "0,2", "-vehicle_car_second_to", "0,0.5",
                                  "-vehicle_car_second_table", file},
                                 {"vehicle_car_second_table = " + file, part}}});
  }
}

// --- scenes that say something else than they seem to ----------------------------------------------------------------

TEST(Sense, KeysThatSayNothingOrTwoThings) {
  const Workplace workplace(small_scene());
  workplace.write("empty.yml", "train:\n  vehicles:\n");
  workplace.write("include.yml", "options_file: ''\n");
  workplace.write("twice.yml", "beam: {mass: 1.0e4}\nbeam_mass: 3.0e4\n");
  expect_refusals(workplace, {{{"-options_file", "empty.yml"}, {"train_vehicles (empty.yml:2)", "has no value"}},
                              {{"-options_file", "include.yml"}, {"options_file (include.yml:1)", "has no value"}},
                              {{"-options_file", "twice.yml"}, {"twice.yml:2: beam_mass is given twice", "line 1"}}});
}

TEST(Sense, WhereATrainStarts) {
  const Workplace workplace(small_scene() + "output_file: none\n");
  expect_refusals(workplace, {{{"-train_positions", "1e5", "-ts_max_time", "0.1"},
                               {"train_positions = 1e5", "every wheel starts beyond the bridge", "40 m"}},
                              {{"-train_positions", "50"}, {"every wheel starts beyond the bridge"}}});
  expect_notes(
      workplace,
      {{{"-train_positions", "-1.1e3", "-ts_max_time", "28"}, {"starts 1100 m before the bridge", "27.5 s"}},
       {{"-train_positions", "-50", "-ts_max_time", "0.1"}, {"the run ends at 0.1 s", "1.25 s"}},
       {{"-train_positions", "50", "-scene_analysis", "static"}, {"beyond the bridge", "no load on the bridge"}}});
  const Workplace forces(forces_only());
  expect_refusals(forces, {{{"-load_positions", "41", "-ts_max_time", "0.1"}, {"load_positions = 41", "every force"}}});
  expect_success(forces.run({"-load_positions", "39", "-ts_max_time", "0.1"}));
}

TEST(Sense, VehiclesInEachOther) {
  const Workplace workplace(small_scene() + "output_file: none\nts_max_time: 0.05\n");
  expect_notes(workplace, {{{"-train_vehicles", "car*3", "-vehicle_car_length", "20", "-train_spacing", "15"},
                            {"vehicles 0 and 1 of the train overlap and 1 more pairs, by up to 5 m"}},
                           {{"-train_vehicles", "car*2", "-train_positions", "0,0", "-vehicle_car_length", "2"},
                            {"vehicles 0 and 1 of the train overlap", "2 m"}}});
  const Outcome apart = workplace.run({"-train_vehicles", "car*3", "-vehicle_car_length", "20"});
  expect_success(apart);
  EXPECT_EQ(apart.out.find("overlap"), std::string::npos) << apart.out;
}

TEST(Sense, VehiclesInNoTrain) {
  const Workplace workplace(small_scene() + "output_file: none\nts_max_time: 0.05\n");
  workplace.write("spare.yml", "vehicle: {spare: {bodies: [b], b: {mass: 1.0, inertia: 1.0, position: [0.0, 0.0]}}}\n");
  expect_notes(workplace, {{{"-options_file", "spare.yml"}, {"not in the train", "spare"}}});
  EXPECT_EQ(workplace.run().out.find("not in the train"), std::string::npos);
}

TEST(Sense, TablesThatAreNoneOfTheBeam) {
  const Workplace workplace(forces_only("ts_max_time: 0.05\n"));
  workplace.write("short.csv", "0 1e10\n10 1e10\n");
  workplace.write("late.csv", "5 1e3\n40 1e3\n");
  workplace.write("long.csv", "0 1e10\n40000 1e10\n");
  workplace.write("good.csv", "0 1e10\n40 1e10\n");
  expect_notes(workplace,
               {{{"-beam_EI", "short.csv"}, {"beam_EI: the table goes from 0 to 10 m", "to 40 m", "last value"}},
                {{"-foundation_vertical_bed_k", "late.csv"}, {"bed_k: the table goes from 5", "first value"}},
                {{"-beam_mass", "long.csv"}, {"beam_mass: the table goes from 0 to 40000 m", "beyond the beam"}}});
  EXPECT_EQ(workplace.run({"-beam_EI", "good.csv"}).out.find("the table goes"), std::string::npos);
}

}  // namespace
}  // namespace traverse::test
