// Bridges as they are found: settled supports, temperature, cracks, supports that yield. Against closed forms and exact
// frequencies, and what of them moving loads must not change.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "modes/modes.hpp"
#include "support/beam_model.hpp"
#include "support/curve.hpp"
#include "support/exact_beam.hpp"
#include "support/exact_timoshenko.hpp"
#include "support/folders.hpp"
#include "support/scene_run.hpp"
#include "traverse/base/error.hpp"

namespace traverse::test {
namespace {

constexpr double L = 25.0, EI = 8.0e9, EA = 2.0e10;

const std::string two_spans = R"(
beam: {spans: [25.0, 25.0], EI: 8.0e9, EA: 2.0e10, mass: 2303.0, elements_per_span: 6}
scene: {analysis: static}
output: {probes: [5.0, 12.5, 25.0, 31.0]}
)";
const std::string one_span = R"(
beam: {spans: 25.0, EI: 8.0e9, EA: 2.0e10, mass: 2303.0, elements_per_span: 6}
scene: {analysis: static}
output: {probes: [5.0, 12.5, 21.0]}
)";

// The middle support of two spans has gone down by s: it pulls by 6 EI s/L^3, the moment there is 3 EI s/L^2.
TEST(Settlement, MiddleSupportOfTwoSpans) {
  constexpr double s = 0.01;
  Results run = run_yaml(two_spans, {{"support_settlement", "0,-0.01,0"}});
  const std::vector<double> R = run("/supports/reaction"), M = run("/probes/moment"), v = run("/probes/deflection");
  const double end = 3.0 * EI * s / (L * L * L);
  EXPECT_NEAR(R[1], end, 1e-9 * end);
  EXPECT_NEAR(R[4], -2.0 * end, 1e-9 * end);
  EXPECT_NEAR(R[7], end, 1e-9 * end);
  EXPECT_NEAR(M[0], 5.0 * end, 1e-8 * end * L);
  EXPECT_NEAR(M[2], 3.0 * EI * s / (L * L), 1e-9 * end * L);
  EXPECT_NEAR(v[2], -s, 1e-15);
  EXPECT_NEAR(v[1], -s * 12.5 * (3.0 * L * L - 12.5 * 12.5) / (2.0 * L * L * L), 1e-12);
  EXPECT_NEAR(run("/balance/residual")[1], 0.0, 1e-6 * end);
}

TEST(Settlement, DeterminateBeamsTurnWithoutForces) {
  Results run = run_yaml(one_span, {{"support_settlement", "0.0,-0.02"}});
  for (const double moment : run("/probes/moment")) EXPECT_NEAR(moment, 0.0, 1e-5);
  for (const double force : run("/supports/reaction")) EXPECT_NEAR(force, 0.0, 1e-5);
  EXPECT_NEAR(run("/probes/deflection")[0], -0.02 * 5.0 / L, 1e-14);
}

// A clamped end that settles: 12 EI s/L^3 and 6 EI s/L^2.
TEST(Settlement, ClampedEnds) {
  Results run = run_yaml(one_span, {{"support_types", "clamped"}, {"support_settlement", "0.0,-0.02"}});
  const std::vector<double> R = run("/supports/reaction");
  const double force = 12.0 * EI * 0.02 / (L * L * L);
  EXPECT_NEAR(R[1], force, 1e-9 * force);
  EXPECT_NEAR(R[4], -force, 1e-9 * force);
  EXPECT_NEAR(std::abs(R[2]), 0.5 * force * L, 1e-9 * force * L);
}

Values with(Values first, const Values& more) {
  first.insert(first.end(), more.begin(), more.end());
  return first;
}

// Determinate beams that settle turn and bend nothing: peaks, limits and amplifications are those without settlement,
// also of a tip beyond the last support and of a cantilever.
TEST(Settlement, DeflectionsAreRelativeToTheSupports) {
  const Values moving = {{"scene_analysis", "transient"}, {"load_forces", "1e5"},      {"load_speed", "30"},
                         {"beam_damping_ratios", "0.02"}, {"output_interval", "0.01"}, {"ts_dt", "2e-3"}};
  const std::string overhang =
                        "beam: {spans: [20.0, 5.0], EI: 8.0e9, mass: 2303.0, elements_per_span: 4}\n"
                        "support: {types: [pinned, roller, free]}\noutput: {probes: [10.0, 25.0]}\n",
                    cantilever =
                        "beam: {spans: 10.0, EI: 8.0e9, mass: 2303.0, elements_per_span: 4}\n"
                        "support: {types: [clamped, free]}\noutput: {probes: [5.0, 10.0]}\n";
  for (const auto& [scene, settlement] :
       {std::pair(one_span, "0,-0.02"), {overhang, "-0.02,0,0"}, {overhang, "0.01,-0.02,0"}, {cantilever, "-0.02,0"}}) {
    Results level = run_yaml(scene, moving),
            settled = run_yaml(scene, with(moving, {{"support_settlement", settlement}}));
    for (const char* name : {"deflection", "static_deflection", "amplification"})
      EXPECT_NEAR(settled.attribute("/summary", name) / level.attribute("/summary", name), 1.0, 1e-8) << settlement;
    EXPECT_LT(relative_difference(settled.column("/envelope/deflection", 0), level.column("/envelope/deflection", 0)),
              1e-8);
    EXPECT_LT(relative_difference(settled("/shape/deflection"), level("/shape/deflection")), 1e-8);
    EXPECT_LT(relative_difference(settled("/probes/relative_deflection"), level("/probes/deflection")), 1e-8);
    EXPECT_GT(relative_difference(settled("/probes/deflection"), level("/probes/deflection")), 0.1);
  }
}

// A continuous beam that settles bends: its middle support goes down by s, and the spans depart from the lines to it.
TEST(Settlement, BendingOfContinuousBeamsCounts) {
  Results run = run_yaml(two_spans, {{"support_settlement", "0,-0.01,0"}});
  const double at_support = -0.01 * 12.5 / L, in_space = -0.01 * 12.5 * (3.0 * L * L - 12.5 * 12.5) / (2.0 * L * L * L);
  EXPECT_NEAR(run("/probes/relative_deflection")[1], in_space - at_support, 1e-12);
  EXPECT_NEAR(run("/probes/relative_deflection")[2], 0.0, 1e-15);
}

// Batches of runs have the same peaks as single runs of a bridge that has settled.
TEST(Settlement, InABatch) {
  const std::string scene =
      "beam: {spans: [25.0, 25.0], EI: 8.0e9, mass: 2303.0, elements_per_span: 6, "
      "damping_ratios: 0.02}\nsupport: {settlement: [0.0, -0.02, 0.0]}\n"
      "vehicle: {coach: {file: " +
      source_folder() +
      "/options/vehicles/manchester.yml}}\n"
      "train: {vehicles: coach, speed: 40.0}\nts: {dt: 1.0e-3}\nmodel: {vehicles: linear}\n"
      "output: {interval: 0.01, probes: [12.5, 25.0]}\n";
  Results sweep = run_yaml(scene, {{"sweep_speed", "40,44,4"}}), single = run_yaml(scene);
  EXPECT_NEAR(sweep("/sweep/peak_deflection")[0], std::abs(single.attribute("/summary", "deflection")), 1e-7);
  EXPECT_NEAR(sweep("/sweep/static_deflection")[0], single.attribute("/summary", "static_deflection"), 1e-9);
}

// On a bed the ground does not go down with the support: one span of many elements against the exact chain, whose end
// is pushed down by the reaction that was found.
TEST(Settlement, BesideABed) {
  Results run = run_yaml(
      one_span,
      {{"support_settlement", "0.0,-0.02"}, {"foundation_vertical_bed_k", "2.0e6"}, {"beam_elements_per_span", "40"}});
  const std::vector<double> R = run("/supports/reaction");
  exact::Chain chain{exact::Motion::bending, {{L, EI, 2303.0, 2.0e6}}, {exact::on_roller, exact::free_end}};
  chain.joints[1].load[0] = R[4];
  const auto sections = exact::statics(chain);
  EXPECT_NEAR(sections[1].v, -0.02, 1e-6 * 0.02);
  EXPECT_NEAR(run("/balance/residual")[1], 0.0, 1e-6 * std::abs(R[4]));
}

const Values warm_top = {{"beam_temperature_gradient", "10.0"}, {"beam_temperature_depth", "2.0"}};
constexpr double warm_curvature = 1.2e-5 * 10.0 / 2.0;

TEST(Temperature, GradientBetweenClampedEnds) {
  Results run = run_yaml(one_span, with(warm_top, {{"support_types", "clamped"}}));
  const double M = EI * warm_curvature;
  for (const double moment : run("/probes/moment")) EXPECT_NEAR(moment, M, 1e-10 * M);
  for (const double v : run("/probes/deflection")) EXPECT_NEAR(v, 0.0, 1e-15);
  EXPECT_NEAR(std::abs(run("/supports/reaction")[2]), M, 1e-10 * M);
}

TEST(Temperature, GradientCurvesASimpleSpanUpward) {
  for (const Values& more : {Values{}, Values{{"beam_GA", "3.0e9"}}}) {
    Results run = run_yaml(one_span, with(warm_top, more));
    EXPECT_NEAR(run("/probes/deflection")[1], warm_curvature * L * L / 8.0, 1e-13);
    for (const double moment : run("/probes/moment")) EXPECT_NEAR(moment, 0.0, 1e-5);
    for (const double shear : run("/probes/shear")) EXPECT_NEAR(shear, 0.0, 1e-5);
  }
}

TEST(Temperature, GradientOnTwoSpans) {
  Results run = run_yaml(two_spans, warm_top);
  const double M = 1.5 * EI * warm_curvature;
  EXPECT_NEAR(run("/probes/moment")[2], M, 1e-9 * M);
  EXPECT_NEAR(run("/supports/reaction")[4], -2.0 * M / L, 1e-9 * M);
}

// Uniform: nothing on a roller but length; between fixed ends -EA alpha T; against a spring k the strain is shared.
TEST(Temperature, UniformLengthensOrPushes) {
  constexpr double strain = 1.2e-5 * 35.0, k = 4.0e8;
  const Values warm = {{"beam_temperature_uniform", "35.0"}};
  Results loose = run_yaml(one_span, warm), fixed = run_yaml(one_span, with(warm, {{"support_types", "pinned"}}));
  Results sprung =
      run_yaml(one_span, with(warm, {{"foundation_longitudinal_x", "25.0"}, {"foundation_longitudinal_k", "4.0e8"}}));
  EXPECT_NEAR(loose("/supports/reaction")[0], 0.0, 1e-4);
  EXPECT_NEAR(fixed("/supports/reaction")[0], EA * strain, 1e-9 * EA * strain);
  EXPECT_NEAR(fixed("/supports/reaction")[3], -EA * strain, 1e-9 * EA * strain);
  const double force = strain * L / (L / EA + 1.0 / k);
  EXPECT_NEAR(sprung("/supports/reaction")[0], force, 1e-9 * force);
}

// What settlements and temperature do adds to what forces do, at all times.
TEST(AsFound, AddsToMovingForces) {
  const Values moving = {{"scene_analysis", "transient"},
                         {"load_forces", "1e5,2e5"},
                         {"load_positions", "0,-4"},
                         {"load_speed", "60"},
                         {"ts_dt", "1e-3"},
                         {"output_interval", "0.01"},
                         {"scene_tail", "0.2"},
                         {"beam_damping_ratios", "0.02"}};
  const Values bed = {{"foundation_vertical_bed_k", "5e5"}};
  const Values found = with(with(warm_top, bed), {{"support_settlement", "0,-0.01,0.004"}});
  Results plain = run_yaml(two_spans, with(bed, moving)), bent = run_yaml(two_spans, with(found, moving));
  Results rest = run_yaml(two_spans, found);
  for (const char* name : {"/probes/deflection", "/probes/moment", "/probes/shear"}) {
    const std::vector<double> at_rest = rest(name);
    double largest = 0.0;
    for (const double value : at_rest) largest = std::max(largest, std::abs(value));
    for (std::size_t p = 0; p < at_rest.size(); ++p) {
      const std::vector<double> a = plain.column(name, p), b = bent.column(name, p);
      for (std::size_t i = 0; i < a.size(); ++i) ASSERT_NEAR(b[i] - a[i], at_rest[p], 1e-8 * largest) << name << i;
    }
  }
  const std::vector<double> R = rest("/supports/reaction");
  EXPECT_NEAR(bent.column("/supports/reaction", 4)[3] - plain.column("/supports/reaction", 4)[3], R[4],
              1e-7 * std::abs(R[4]));
  EXPECT_LT(energy_error(bent), 1e-6);
}

// A prop in the element that a settled support turns: it bears as a spring does where the beam comes down on it, and
// nothing where it goes up.
TEST(AsFound, OneSidedFoundationsStartFromIt) {
  const Values prop = {
      {"foundation_vertical_x", "20"}, {"foundation_vertical_k", "5e7"}, {"beam_elements_per_span", "2"}};
  const Values one_sided = with(prop, {{"foundation_vertical_one_sided", "true"}});
  const Values down = {{"support_settlement", "0,-0.02"}}, up = {{"support_settlement", "0,0.02"}};
  Results spring = run_yaml(one_span, with(prop, down)), pressed = run_yaml(one_span, with(one_sided, down));
  Results apart = run_yaml(one_span, with(one_sided, up));
  const double force = spring("/foundation/vertical/force")[0];
  EXPECT_GT(force, 1e3);
  EXPECT_NEAR(pressed("/foundation/vertical/force")[0], force, 1e-7 * force);
  for (const std::size_t p : {0U, 1U})
    EXPECT_NEAR(pressed("/probes/deflection")[p], spring("/probes/deflection")[p], 1e-11) << p;
  for (std::size_t p = 0; p < 3; ++p) {
    EXPECT_NEAR(apart("/probes/deflection")[p], 0.02 * apart("/probes/x")[p] / L, 1e-11) << p;
  }
  EXPECT_EQ(apart("/foundation/vertical/force")[0], 0.0);
}

// What is at rest on settled supports, bent by the sun, stays out of the steps and stays where it is.
TEST(AsFound, RestsOutsideTheWindow) {
  const std::string scene = R"(
beam: {spans: 20.0*8, EI: 4.0e9, mass: 2000.0, continuity: simply_supported, elements_per_span: 6, damping_ratios: 0.05}
support: {settlement: [0, 0, -0.01, 0, 0, 0.02, 0, 0, 0]}
load: {forces: [1.0e5, 1.0e5], positions: [0.0, -6.0], speed: 60.0}
ts: {dt: 1.0e-3}
output: {interval: 0.02, probes: [30.0, 50.0, 90.0, 130.0]}
)";
  Results all = run_yaml(scene, with(warm_top, {{"model_window", "0"}})),
          window = run_yaml(scene, with(warm_top, {{"model_window", "1e-6"}}));
  EXPECT_LT(relative_difference(window("/probes/deflection"), all("/probes/deflection")), 1e-5);
  EXPECT_LT(relative_difference(window("/supports/reaction"), all("/supports/reaction")), 1e-4);
  EXPECT_LT(energy_error(window), 1e-5);
}

// A coach starts in equilibrium on the bent bridge and the balance of energy holds; linear vehicles agree.
TEST(AsFound, VehiclesSeeIt) {
  const std::string scene = std::string(R"(
beam: {spans: [25.0, 25.0], EI: 8.0e9, mass: 2303.0, elements_per_span: 8, damping_ratios: 0.02}
support: {settlement: [0.0, -0.02, 0.0]}
vehicle: {coach: {file: )") +
                            source_folder() + R"(/options/vehicles/manchester.yml}}
train: {vehicles: coach, speed: 40.0}
ts: {dt: 1.0e-3}
output: {interval: 0.01}
)";
  Results full = run_yaml(scene, {{"model_vehicles", "full"}}),
          linear = run_yaml(scene, {{"model_vehicles", "linear"}});
  Results plain = run_yaml(scene, {{"support_settlement", "0.0"}});
  EXPECT_LT(energy_error(full), 1e-4);
  EXPECT_LT(energy_error(linear), 1e-4);
  EXPECT_LT(relative_difference(linear.column("/probes/deflection", 0), full.column("/probes/deflection", 0)), 1e-3);
  EXPECT_GT(relative_difference(plain("/vehicles/0/car/position"), full("/vehicles/0/car/position")), 1e-5);
}

// Cracks are springs between two sides: exact frequencies for every pair of supports.
TEST(Crack, FrequenciesOfAllPairsOfSupports) {
  using beam::Support;
  constexpr double at = 9.0, k = 5.0e8;
  double worst = 0.0;
  for (const Support left : {Support::free, Support::pinned, Support::clamped, Support::guided})
    for (const Support right : {Support::free, Support::roller, Support::clamped, Support::guided}) {
      beam::BeamModel model = model_of({L}, 60, false);
      model.EI = EI;
      model.mass = 2303.0;
      model.supports = {left, right};
      model.cracks = {{at, k}};
      const auto exact = exact::frequencies({L, EI, 0.0L, 2303.0L, 0.0L, at, k}, left, right, 3);
      std::vector<double> omega = modes::natural_modes(beam::Beam(PETSC_COMM_WORLD, model), 6, false).omega;
      std::erase(omega, 0.0);
      for (std::size_t i = 0; i < exact.size(); ++i) {
        EXPECT_NEAR(omega[i] / exact[i], 1.0, 1e-6) << static_cast<int>(left) << static_cast<int>(right);
        worst = std::max(worst, std::abs(omega[i] / exact[i] - 1.0));
      }
    }
  RecordProperty("error", text(worst));
}

// Force at midspan of a simple span: the crack turns by M/k there.
TEST(Crack, SpringDeflectsASpan) {
  const Values force = {{"load_forces", "1e5"}, {"load_positions", "12.5"}, {"load_speed", "0"}};
  Results plain = run_yaml(one_span, force);
  Results cracked = run_yaml(one_span, with(force, {{"beam_cracks_x", "9.0"}, {"beam_cracks_k", "5e8"}}));
  const double moment = 0.5e5 * 9.0, unit = 0.5 * 9.0;  // at the crack, of the force and of a unit force at midspan
  EXPECT_NEAR(cracked("/probes/deflection")[1] - plain("/probes/deflection")[1], -moment * unit / 5e8, 1e-12);
  EXPECT_NEAR(cracked("/probes/moment")[0], plain("/probes/moment")[0], 1e-5);
}

// A crack of a width: by the virtual work of the moments over it, whatever the mesh.
TEST(Crack, OfAWidthIsTheSameOnEveryMesh) {
  const Values force = {{"load_forces", "1e5"}, {"load_positions", "12.5"}, {"load_speed", "0"}};
  const Values crack = {{"beam_cracks_x", "9.0"}, {"beam_cracks_width", "0.4"}, {"beam_cracks_EI_factor", "0.3"}};
  const auto cube = [](double x) { return x * x * x / 3.0; };
  const double more = 0.25e5 * (cube(9.2) - cube(8.8)) / EI * (1.0 / 0.3 - 1.0);
  for (const char* elements : {"2", "5", "16"}) {
    const Values mesh = {{"beam_elements_per_span", elements}};
    Results plain = run_yaml(one_span, with(force, mesh)), cracked = run_yaml(one_span, with(with(force, crack), mesh));
    EXPECT_NEAR(plain("/probes/deflection")[1] - cracked("/probes/deflection")[1], more, 1e-9 * more * 100.0)
        << elements;
  }
}

// A pier on its soil that loses 30 % of it: two spans on a spring, exact.
TEST(Scour, ShiftsFrequencies) {
  const Values pier = {{"scene_analysis", "modes"},
                       {"modes_count", "3"},
                       {"support_stiffness", "0,3e7,0"},
                       {"model_axial", "false"},
                       {"beam_elements_per_span", "40"}};
  for (const double scour : {0.0, 0.3}) {
    Results run = run_yaml(two_spans, with(pier, {{"support_scour", scour == 0.0 ? "0" : "0,0.3,0"}}));
    exact::Chain chain{
        exact::Motion::bending, {{L, EI, 2303.0}, {L, EI, 2303.0}}, {exact::on_roller, {}, exact::on_roller}};
    chain.joints[1].k[0] = 3e7 * (1.0 - scour);
    const std::vector<double> exact = exact::frequencies(chain, 3), found = run("/modes/frequency");
    for (std::size_t i = 0; i < exact.size(); ++i)
      EXPECT_NEAR(2.0 * std::numbers::pi * found[i] / exact[i], 1.0, 1e-6) << i;
  }
}

TEST(AsFound, IsRefusedInOneLine) {
  const auto message = [](const Values& options) {
    try {
      run_yaml(two_spans, options);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("none");
  };
  const auto names = [&](const Values& options, const char* option) {
    const std::string told = message(options);
    EXPECT_EQ(told.rfind(option, 0), 0U) << told;
    EXPECT_EQ(told.find('\n'), std::string::npos) << told;
  };
  names({{"beam_cracks_x", "60"}, {"beam_cracks_k", "1e8"}}, "beam_cracks_x");
  names({{"beam_cracks_x", "6"}}, "beam_cracks_x");
  names({{"beam_cracks_k", "6"}}, "beam_cracks_k");
  names({{"beam_cracks_x", "6"}, {"beam_cracks_width", "1"}}, "beam_cracks_width");
  names({{"beam_cracks_x", "0.1"}, {"beam_cracks_width", "1"}, {"beam_cracks_EI_factor", "0.5"}}, "beam_cracks_width");
  names({{"beam_temperature_gradient", "5"}}, "beam_temperature_gradient");
  names({{"beam_temperature_depth", "5"}}, "beam_temperature_depth");
  names({{"beam_temperature_uniform", "5"}, {"model_axial", "false"}}, "beam_temperature_uniform");
  names({{"support_settlement", "0,1"}}, "support_settlement");
  names({{"support_types", "pinned,free,roller"}, {"support_settlement", "0,0.1,0"}}, "support_settlement");
  names({{"support_scour", "0,0.1,0"}}, "support_scour");
  names({{"support_scour", "0.1"}, {"support_stiffness", "0,1e8,0"}}, "support_scour");
  names({{"support_stiffness", "0,1e8,0"}, {"beam_continuity", "simply_supported"}}, "support_stiffness");
  names({{"support_stiffness", "0,1e8,0"}, {"support_settlement", "0,0.1,0"}}, "support_settlement");
  names(with(warm_top,
             {{"scene_analysis", "transient"}, {"load_forces", "1e5"}, {"load_speed", "50"}, {"model_modes", "4"}}),
        "model_modes");
}

}  // namespace
}  // namespace traverse::test
