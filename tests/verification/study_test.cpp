// Studies: every run is that of its scene alone, whatever is varied beside it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/curve.hpp"
#include "support/folders.hpp"
#include "support/record.hpp"

namespace traverse::test {
namespace {

const std::string bridge = R"(
beam: {spans: [20.0, 25.0], EI: 1.0e10, mass: 1.0e4, damping_ratios: 0.02, elements_per_span: 6}
support: {types: [pinned, roller, roller]}
output: {probes: [10.0, 31.0]}
)";
const std::string forces = bridge + "load: {forces: 1.0e5*3, positions: [0, -3, -20], speed: 40.0}\nts_dt: 2.0e-3\n";
const std::string coach = "options_file: " + source_folder() +
                          "/options/scenes/three_span_train.yml\n"
                          "train_vehicles: coach\nscene_tail: 0.1\nbeam_elements_per_span: 8\n";
const char* const peaks[] = {"deflection", "acceleration", "moment"};

/// The largest of the probes of a run of the study against the summary of the scene alone.
void expect_run(Results& study, std::size_t run, const Results& alone, double bound) {
  for (const char* name : peaks) {
    const std::vector<double>& all = study(std::string("/study/peak_") + name);
    const std::size_t probes = study("/probes/x").size();
    const auto own = all.begin() + static_cast<std::ptrdiff_t>(run * probes);
    const double wanted = std::abs(alone.attribute("/summary", name));
    EXPECT_NEAR(*std::max_element(own, own + static_cast<std::ptrdiff_t>(probes)), wanted, bound * wanted)
        << name << " of run " << run;
  }
}

double wheels(const Results& alone) { return alone.attribute("/summary", "least_wheel_force"); }

TEST(Study, RunsOfAGridAreThoseOfTheScenesAlone) {
  const std::string scene = forces + "foundation: {vertical: {x: 12.0}}\n";
  Results study = run_yaml(scene, {{"study_vary_foundation_vertical_k", "1e7,1e9"},
                                   {"study_vary_load_speed_from", "108 km/h"},
                                   {"study_vary_load_speed_to", "50"},
                                   {"study_vary_load_speed_step", "10"},
                                   {"study_vary_beam_EI", "1e10,2e10"}});
  EXPECT_EQ(study("/study/shape"), (std::vector<double>{2, 3, 2}));
  EXPECT_EQ(study("/study/finished"), std::vector<double>(12, 1.0));
  std::size_t run = 0;
  for (const char* k : {"1e7", "1e9"})
    for (const char* speed : {"30", "40", "50"})
      for (const char* EI : {"1e10", "2e10"}) {
        EXPECT_EQ(study("/study/foundation_vertical_k")[run], std::stod(k));
        EXPECT_NEAR(study("/study/load_speed")[run], std::stod(speed), 1e-12);
        EXPECT_EQ(study("/study/beam_EI")[run], std::stod(EI));
        const Results alone = run_yaml(scene, {{"foundation_vertical_k", k}, {"load_speed", speed}, {"beam_EI", EI}});
        expect_run(study, run++, alone, 1e-9);
      }
}

TEST(Study, OfOptionsSideBySide) {
  const std::string one_span =
      "beam: {spans: 20.0, EI: 1.0e10, mass: 1.0e4, damping_ratios: 0.02, elements_per_span: 6}\n"
      "support: {types: [pinned, roller]}\nload: {forces: 1.0e5, speed: 40.0}\nts_dt: 2.0e-3\n";
  Results study = run_yaml(one_span, {{"study_combine", "together"},
                                      {"study_vary_beam_mass", "1e4,1.5e4"},
                                      {"study_vary_beam_damping_ratios", "0.01,0.03"},
                                      {"study_vary_beam_spans", "20,24"}});
  EXPECT_EQ(study("/study/probes_x"), (std::vector<double>{10.0, 12.0}));
  const Values runs[] = {{{"beam_mass", "1e4"}, {"beam_damping_ratios", "0.01"}, {"beam_spans", "20"}},
                         {{"beam_mass", "1.5e4"}, {"beam_damping_ratios", "0.03"}, {"beam_spans", "24"}}};
  for (const std::size_t run : {0u, 1u}) expect_run(study, run, run_yaml(one_span, runs[run]), 1e-9);
}

TEST(Study, OfAVehiclesFileAndOfWhatTakesTheSameValue) {
  const Values step = {{"ts_dt", "2e-3"}, {"step_probes", "true"}};
  Results study = run_yaml(coach, step + Values{{"study_vary_vehicle_coach_car_mass", "4e4,5e4"},
                                                {"study_vary_vehicle_coach_front_secondary_damping", "2e4,8e4"},
                                                {"study_vary_vehicle_coach_front_secondary_damping_also",
                                                 "vehicle_coach_rear_secondary_damping"}});
  std::size_t run = 0;
  for (const char* mass : {"4e4", "5e4"})
    for (const char* damping : {"2e4", "8e4"}) {
      const Results alone = run_yaml(coach, step + Values{{"vehicle_coach_car_mass", mass},
                                                          {"vehicle_coach_front_secondary_damping", damping},
                                                          {"vehicle_coach_rear_secondary_damping", damping}});
      expect_run(study, run, alone, 1e-9);
      EXPECT_NEAR(study("/study/least_wheel_force")[run], wheels(alone), 1e-9 * wheels(alone));
      ++run;
    }
}

const Values by_elements = {{"beam_elements_per_span", "12"},
                            {"model_vehicles", "linear"},
                            {"ts_dt", "8e-4"},
                            {"step_probes", "true"},
                            {"track_profile", "german_low"}};

// Eight tracks in eight lanes, at two speeds of one class and one of another.
TEST(Study, TracksInLanesAreThoseOfRunsAlone) {
  Results study =
      run_yaml(coach, by_elements + Values{{"study_vary_track_seed", "1:10"}, {"study_vary_train_speed", "60,76,80"}});
  EXPECT_EQ(study("/study/shape"), (std::vector<double>{10, 3}));
  double worst = 0.0;
  for (const std::size_t seed : {1u, 4u, 10u}) {
    Results single =
        run_yaml(coach, by_elements + Values{{"track_seed", std::to_string(seed)}, {"sweep_speed", "76,80,4"}});
    for (std::size_t i = 0; i < 2; ++i) {
      const std::size_t run = 3 * (seed - 1) + 1 + i;
      for (const char* name : {"peak_deflection", "peak_acceleration", "peak_moment"}) {
        const std::vector<double>&all = study(std::string("/study/") + name),
              &alone = single(std::string("/sweep/") + name);
        const std::size_t probes = alone.size() / 2;
        for (std::size_t p = 0; p < probes; ++p)
          worst = std::max(worst, std::abs(all[run * probes + p] / alone[i * probes + p] - 1.0));
      }
      for (const char* name : {"least_wheel_force", "greatest_wheel_force"})
        worst = std::max(
            worst,
            std::abs(study(std::string("/study/") + name)[run] / single(std::string("/sweep/") + name)[i] - 1.0));
    }
  }
  record("runs side by side and alone", worst);
  EXPECT_LT(worst, 1e-9);
  const std::vector<double>& forces_of_seeds = study("/study/least_wheel_force");
  EXPECT_GT(std::abs(forces_of_seeds[1] / forces_of_seeds[4] - 1.0), 1e-4) << "tracks differ";
}

// Eight trains whose vehicles differ in a number in eight lanes.
TEST(Study, TrainsInLanesAreThoseOfRunsAlone) {
  const Values draws = {{"study_vary_vehicle_coach_car_mass_normal", "47800,3000"},
                        {"study_vary_vehicle_coach_wheelset_1_mass_uniform", "1500,2000"},
                        {"study_draws", "5"}};
  testing::internal::CaptureStdout();
  Results study = run_yaml(coach, by_elements + draws + Values{{"verbose", "true"}});
  const std::string said = testing::internal::GetCapturedStdout();
  EXPECT_NE(said.find("runs that differ in speed, track and vehicle parameters only are advanced together"), said.npos)
      << said;
  double worst = 0.0;
  for (const std::size_t run : {0u, 2u, 4u}) {
    Results alone = run_yaml(
        coach, by_elements +
                   Values{{"vehicle_coach_car_mass", text(study("/study/vehicle_coach_car_mass")[run])},
                          {"vehicle_coach_wheelset_1_mass", text(study("/study/vehicle_coach_wheelset_1_mass")[run])},
                          {"study_vary_track_seed", "1"}});
    for (const char* name : {"peak_deflection", "peak_acceleration", "peak_moment", "least_wheel_force"}) {
      const std::vector<double>&all = study(std::string("/study/") + name), &one = alone(std::string("/study/") + name);
      for (std::size_t p = 0; p < one.size(); ++p)
        worst = std::max(worst, std::abs(all[run * one.size() + p] / one[p] - 1.0));
    }
  }
  record("trains side by side and alone", worst);
  EXPECT_LT(worst, 1e-9);
}

// Nine speeds of one class are two batches of one train, whose wheels follow the deflected bridge at the start.
TEST(Study, LaterBatchesStartLikeTheFirst) {
  const Values on_the_bridge = by_elements + Values{{"train_positions", "20"}};
  Results all =
      run_yaml(coach, on_the_bridge + Values{{"study_vary_train_speed", "77,77.5,78,78.5,79,79.5,80,80.5,81"}});
  Results two = run_yaml(coach, on_the_bridge + Values{{"study_vary_train_speed", "77,81"}});
  double worst = 0.0;
  for (const char* name : {"peak_deflection", "peak_acceleration", "peak_moment", "greatest_wheel_force"}) {
    const std::vector<double>&of_all = all(std::string("/study/") + name), &of_two = two(std::string("/study/") + name);
    const std::size_t width = of_two.size() / 2;
    for (std::size_t p = 0; p < width; ++p)
      worst = std::max(worst, std::abs(of_all[8 * width + p] / of_two[width + p] - 1.0));
  }
  record("later batches", worst);
  EXPECT_LT(worst, 1e-12);
}

// Bridges whose stiffness and damping differ in lanes of one batch.
TEST(Study, BridgesInLanesAreThoseOfRunsAlone) {
  testing::internal::CaptureStdout();
  Results study = run_yaml(coach, by_elements + Values{{"study_vary_beam_EI", "2e10,2.5e10,3e10"},
                                                       {"study_vary_beam_damping_ratios", "0.01,0.02"},
                                                       {"verbose", "true"}});
  const std::string said = testing::internal::GetCapturedStdout();
  EXPECT_NE(said.find("parameters of vehicles and bridge only are advanced together"), said.npos) << said;
  double worst = 0.0;
  std::size_t run = 0;
  for (const char* EI : {"2e10", "2.5e10", "3e10"})
    for (const char* damping : {"0.01", "0.02"}) {
      Results alone =
          run_yaml(coach, by_elements + Values{{"study_vary_beam_EI", EI}, {"beam_damping_ratios", damping}});
      for (const char* name : {"peak_deflection", "peak_acceleration", "peak_moment", "least_wheel_force"}) {
        const std::vector<double>&all = study(std::string("/study/") + name),
              &one = alone(std::string("/study/") + name);
        for (std::size_t p = 0; p < one.size(); ++p)
          worst = std::max(worst, std::abs(all[run * one.size() + p] / one[p] - 1.0));
      }
      ++run;
    }
  record("bridges side by side and alone", worst);
  EXPECT_LT(worst, 1e-9);
}

// Each by itself, driven by TS: steps lie elsewhere, so that what is left falls with their length.
TEST(Study, TracksInLanesAgainstEachByItself) {
  double errors[2] = {};
  for (const int finer : {0, 1}) {
    const Values study = by_elements + Values{{"beam_elements_per_span", "24"},
                                              {"study_vary_track_seed", "3,7"},
                                              {"ts_dt", finer == 1 ? "2e-4" : "8e-4"}};
    Results beside = run_yaml(coach, study),
            alone = run_yaml(coach, study + Values{{"sweep_lanes", "0"}, {"ts_dt", "2e-4"}});
    for (const char* name : {"peak_deflection", "peak_moment", "greatest_wheel_force"})
      errors[finer] = std::max(errors[finer], relative_difference(beside(std::string("/study/") + name),
                                                                  alone(std::string("/study/") + name)));
  }
  record("against TS", errors[1]);
  EXPECT_LT(errors[1], 2e-5);
  EXPECT_LT(errors[1], 0.5 * errors[0]);
}

// What is drawn of a quantity depends on its name and the seed alone.
TEST(Study, DrawsKeepToTheirStreams) {
  const Values mass = {{"study_vary_beam_mass_normal", "1e4,500"}, {"study_draws", "6"}};
  Results one = run_yaml(forces, mass);
  Results beside = run_yaml(forces, mass + Values{{"study_vary_beam_EI_lognormal", "1e10,1e9"},
                                                  {"study_vary_load_speed_uniform", "30,50"},
                                                  {"study_draws", "9"}});
  ASSERT_EQ(beside("/study/beam_mass").size(), 9u);
  for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(beside("/study/beam_mass")[i], one("/study/beam_mass")[i]);
  Results other = run_yaml(forces, mass + Values{{"study_seed", "2"}});
  EXPECT_NE(other("/study/beam_mass")[0], one("/study/beam_mass")[0]);
  // Drawn values times a grid: every draw at every speed.
  Results grid = run_yaml(forces, mass + Values{{"sweep_speed", "30,40,10"}});
  EXPECT_EQ(grid("/study/shape"), (std::vector<double>{2, 6}));
  EXPECT_EQ(grid("/study/beam_mass")[6], one("/study/beam_mass")[0]);
  EXPECT_EQ(grid("/study/statistics/load_speed"), (std::vector<double>{30, 40}));
  // The statistics are those of the stored peaks.
  const std::vector<double>& all = grid("/study/peak_deflection");  // [run, probe]
  double sum = 0.0;
  for (std::size_t draw = 0; draw < 6; ++draw) sum += all[2 * (6 + draw)];
  EXPECT_NEAR(grid("/study/statistics/peak_deflection_mean")[2], sum / 6.0, 1e-12 * sum);
}

// EN 1991-2: a study takes up what sweep_hslm_a and sweep_speed ask for.
TEST(Study, TakesUpASweep) {
  Results sweep = run_yaml(bridge, {{"model_modes", "4"}, {"sweep_speed", "30,60,10"}, {"sweep_hslm_a", "2,7"}});
  Results study = run_yaml(
      bridge,
      {{"model_modes", "4"}, {"sweep_speed", "30,60,10"}, {"sweep_hslm_a", "2,7"}, {"study_vary_beam_mass", "1e4"}});
  EXPECT_EQ(study("/study/shape"), (std::vector<double>{2, 4, 1}));
  EXPECT_LT(relative_difference(study("/study/peak_deflection"), sweep("/sweep/peak_deflection")), 1e-12);
  EXPECT_LT(relative_difference(study("/study/peak_acceleration"), sweep("/sweep/peak_acceleration")), 1e-12);
}

}  // namespace
}  // namespace traverse::test
