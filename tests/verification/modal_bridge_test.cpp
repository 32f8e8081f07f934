// Bridges by their modes, exact in time (model_modes): against closed form series, against the full model, and what
// must not matter.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "integrate/modal_motion.hpp"
#include "support/curve.hpp"
#include "support/message.hpp"

namespace traverse::test {
namespace {

using std::numbers::pi;

// Beam of Yang and Yau 1997 (R1 of the reference cases).
constexpr double length = 25.0, EI = 2.87e9 * 2.90, mass = 2303.0;
double static_deflection(double force) { return force * std::pow(length, 3) / (48.0 * EI); }
double speed_for(double alpha) { return alpha * pi / length * std::sqrt(EI / mass); }

// Closed-form series (Fryba, ch. 1) with 401 modes; the largest deflection while the force is on the beam.
struct MovingForce {
  double alpha, amplification;
};
class ModalR1 : public testing::TestWithParam<MovingForce> {};
INSTANTIATE_TEST_SUITE_P(ReferenceCases, ModalR1,
                         testing::Values(MovingForce{0.1, 1.096454}, MovingForce{0.25, 1.257610},
                                         MovingForce{0.5, 1.705445}, MovingForce{0.617, 1.731674},
                                         MovingForce{1.0, 1.548074}));

TEST_P(ModalR1, TwentyModes) {
  const double speed = speed_for(GetParam().alpha);
  Results run = run_scene("r1_moving_force", {{"load_speed", text(speed)},
                                              {"beam_elements_per_span", "32"},
                                              {"model_modes", "20"},
                                              {"output_interval", text(length / speed / 400.0)}});
  const Peak largest = refined_peak(run.time(), run.column("/probes/deflection"));
  const double amplification = -largest.value / static_deflection(1e5);
  RecordProperty("error", text(amplification / GetParam().amplification - 1.0));
  EXPECT_NEAR(amplification, GetParam().amplification, 1e-5 * GetParam().amplification);
}

/// One span by elements, for the parts below the program.
beam::BeamModel one_span(int elements) {
  beam::BeamModel model;
  model.spans = {length};
  model.elements = {elements};
  model.EI = EI;
  model.mass = mass;
  model.supports = {beam::Support::pinned, beam::Support::roller};
  model.axial = false;
  return model;
}

// The textbook's factor of one mode alone, 1.743; and the whole motion of that mode, its free vibration included:
// q'' + w^2 q = F phi sin(pi v t/L), at rest before.
TEST(ModalMotion, OneModeInClosedForm) {
  beam::Beam beam(PETSC_COMM_SELF, one_span(40));
  beam.set_rayleigh({});
  structure::BeamOperator statics(beam);
  structure::ModalBridge bridge(beam, statics, 1, {});
  bridge.add_probes({0.5 * length}, 0.0);
  const double alpha = 0.617, speed = speed_for(alpha), omega = bridge.omega()[0], drive = pi * speed / length;
  const train::MovingLoad load{{1e5}, {0.0}, speed};
  const integrate::ForceHistory history(bridge.influence(), load);
  integrate::ModalMotion motion(bridge, history, speed, true);
  const double leaving = length / speed, scale = 2e5 / (mass * length) / (omega * omega - drive * drive);
  const auto forced = [&](double t) { return -scale * (std::sin(drive * t) - drive / omega * std::sin(omega * t)); };
  const auto forced_rate = [&](double t) { return -scale * drive * (std::cos(drive * t) - std::cos(omega * t)); };
  double largest = 0.0, error = 0.0;
  for (double t = 0.0; t < 3.0 * leaving; t += leaving / 400.0) {
    motion.advance(t);
    const double deflection = bridge.probes().deflection[0] * motion.q()[0];
    const double free = omega * (t - leaving);
    const double exact =
        t <= leaving ? forced(t) : forced(leaving) * std::cos(free) + forced_rate(leaving) / omega * std::sin(free);
    if (t <= leaving) largest = std::max(largest, std::abs(deflection));
    error = std::max(error, std::abs(deflection - exact));
  }
  EXPECT_NEAR(largest / static_deflection(1e5), 1.742875, 1e-5);
  RecordProperty("error", text(error / largest));
  EXPECT_LT(error, 1e-6 * largest) << "what the mesh's mode differs from a sine by";
}

// The last mode of the list is overdamped; a shorter way to the same place gives the same, with the same energies. What
// has decayed is zero in the end, and not a denormal number.
TEST(ModalMotion, ManyStepsAndOneAgree) {
  beam::Beam beam(PETSC_COMM_SELF, one_span(8));
  beam.set_rayleigh({1.0, 2e-3});
  structure::BeamOperator statics(beam);
  const structure::ModalBridge bridge(beam, statics, 6, {});
  ASSERT_GT(bridge.sigma()[5], bridge.omega()[5]);
  ASSERT_LT(bridge.sigma()[0], bridge.omega()[0]);
  const train::MovingLoad load{{1e5, 2e5}, {0.0, -3.0}, 40.0};
  const integrate::ForceHistory history(bridge.influence(), load);
  integrate::ModalMotion one(bridge, history, 40.0, true), many(bridge, history, 40.0, true);
  for (integrate::ModalMotion* motion : {&one, &many}) motion->integrate_energy();
  many.prepare(1e-3);
  for (int i = 1; i <= 900; ++i) many.advance(i * 1e-3);
  one.advance(0.9);
  EXPECT_NEAR(one.dissipated(), many.dissipated(), 1e-10 * one.dissipated());
  EXPECT_NEAR(one.work(), many.work(), 1e-10 * one.work());
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_NEAR(one.q()[i], many.q()[i], 1e-12 * std::abs(many.q()[0]));
    EXPECT_NEAR(one.rate()[i], many.rate()[i], 1e-12 * std::abs(many.rate()[0]));
  }
  many.advance(2.0);
  EXPECT_EQ(many.q()[5], 0.0);
}

const char* const three_spans = R"(
beam: {spans: [25.0, 32.0, 25.0], EI: 3.0e10, mass: 1.2e4, elements_per_span: 10}
support: {types: [pinned, roller, roller, roller]}
load: {forces: [2.0e5, 2.0e5, 1.5e5], positions: [2.0, -3.0, -14.0], speed: 70.0}
scene: {tail: 1.0}
output: {probes: [12.5, 25.0, 33.7, 41.0, 69.5]}
)";
const Values rayleigh = {{"beam_damping_ratios", "0.02"}};

// All modes of the mesh are the mesh: start on the bridge, passage and free vibration. What loads do inside an element
// is static with modes, with elements it follows b behind: moments under a force differ by that, when it is gone by
// what inertia does inside elements.
TEST(ModalBridge, AllModesAgainstTheFullModel) {
  Results full = run_yaml(three_spans, rayleigh + Values{{"ts_dt", "1e-4"}, {"output_interval", "5e-3"}});
  Results modal = run_yaml(three_spans, rayleigh + Values{{"model_modes", "58"}, {"output_interval", "5e-3"}});
  for (const char* name :
       {"/probes/deflection", "/probes/velocity", "/supports/reaction", "/energy/strain", "/energy/dissipated"}) {
    const double difference = relative_difference(modal(name), full(name));
    RecordProperty(name + 1, text(difference));
    EXPECT_LT(difference, 1e-7) << name;
  }
  const std::vector<double> time = full.time(), &expected = full("/probes/moment"), &found = modal("/probes/moment");
  const double largest = std::abs(peak(expected).first);
  double under_forces = 0.0, in_free_vibration = 0.0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    double& worst = time[i / 5] * 70.0 < 96.0 ? under_forces : in_free_vibration;
    worst = std::max(worst, std::abs(found[i] - expected[i]) / largest);
  }
  EXPECT_LT(under_forces, 5e-3);
  EXPECT_LT(in_free_vibration, 2e-4);
}

// Twelve modes and the others static: against the full model on the same mesh.
TEST(ModalBridge, StaticCorrection) {
  Results full = run_yaml(three_spans, rayleigh + Values{{"ts_dt", "5e-4"}, {"output_interval", "5e-3"}});
  Results modal = run_yaml(three_spans, rayleigh + Values{{"model_modes", "12"}, {"output_interval", "5e-3"}});
  EXPECT_LT(relative_difference(modal("/probes/deflection"), full("/probes/deflection")), 1e-4);
  EXPECT_LT(relative_difference(modal("/probes/moment"), full("/probes/moment")), 1e-2);
  EXPECT_LT(std::abs(peak(modal("/balance/residual")).first), 1e-9 * 5.5e5);
  EXPECT_LT(energy_error(modal), 1e-10);
}

TEST(ModalBridge, SamplesChangeNothing) {
  Results fine = run_yaml(three_spans, rayleigh + Values{{"model_modes", "9"}, {"output_interval", "1e-3"}});
  Results coarse = run_yaml(three_spans, rayleigh + Values{{"model_modes", "9"}, {"output_interval", "0.1"}});
  const std::size_t width = 5;
  for (const char* name : {"/probes/deflection", "/probes/velocity", "/probes/acceleration", "/probes/moment"}) {
    const double scale = std::abs(peak(fine(name)).first);
    for (std::size_t i = 0; i + 1 < coarse.time().size(); ++i)
      for (std::size_t p = 0; p < width; ++p)
        EXPECT_NEAR(coarse(name)[i * width + p], fine(name)[100 * i * width + p], 1e-11 * scale) << name;
  }
}

// One ratio in every mode: the free vibration of a single mode decays by it, and forces stay balanced.
TEST(ModalBridge, DampingOfEachMode) {
  const Values options = {{"beam_spans", "25"},        {"support_types", "pinned,roller"}, {"load_forces", "1e5"},
                          {"load_positions", "0"},     {"output_probes", "12.5"},          {"model_modes", "3"},
                          {"output_interval", "1e-3"}, {"beam_self_weight", "true"}};
  Results run = run_yaml(three_spans, options + Values{{"model_damping_ratios", "0.03,0.5,0.5"}, {"scene_tail", "3"}});
  const double frequency = run("/modes/frequency")[0];
  const std::vector<double> time = run.time(), velocity = run.column("/probes/velocity");
  const auto largest_after = [&](double from) {
    double value = 0.0;
    for (std::size_t i = 0; i < time.size(); ++i)
      if (time[i] >= from && time[i] < from + 1.0 / frequency) value = std::max(value, std::abs(velocity[i]));
    return value;
  };
  const double after = 5.0 / frequency;
  EXPECT_NEAR(std::log(largest_after(1.0) / largest_after(1.0 + after)), 0.03 * 2.0 * pi * frequency * after, 2e-3);
  EXPECT_LT(std::abs(peak(run("/balance/residual")).first), 1e-9 * 1.2e4 * 25.0 * 9.81);
  EXPECT_LT(energy_error(run), 1e-10);
}

// Isolated spans repeat every frequency: each has its copy, though one mode was asked for.
TEST(ModalBridge, CopiesOfAFrequency) {
  const Values options = {
      {"beam_spans", "25,25,25"}, {"beam_continuity", "simply_supported"}, {"support_types", "pinned"},
      {"model_modes", "1"},       {"output_probes", "12.5,37.5,62.5"},     {"load_forces", "1e5"},
      {"load_positions", "0"}};
  Results run = run_yaml(three_spans, options);
  EXPECT_EQ(run("/modes/frequency").size(), 3u);
  std::vector<double> peaks;
  for (std::size_t span = 0; span < 3; ++span) peaks.push_back(peak(run.column("/probes/velocity", span)).first);
  for (const double value : peaks) EXPECT_NEAR(std::abs(value), std::abs(peaks[0]), 2e-2 * std::abs(peaks[0]));
}

// A cantilever: the force jumps where it leaves at the tip.
TEST(ModalBridge, ForcesThatLeaveAFreeEnd) {
  const Values options = {{"beam_spans", "10"},   {"support_types", "clamped,free"}, {"output_probes", "5,10"},
                          {"load_forces", "1e5"}, {"load_positions", "0"},           {"load_speed", "20"}};
  Results full = run_yaml(three_spans, rayleigh + options + Values{{"ts_dt", "1e-4"}, {"output_interval", "5e-3"}});
  Results modal =
      run_yaml(three_spans, rayleigh + options + Values{{"model_modes", "20"}, {"output_interval", "5e-3"}});
  EXPECT_LT(relative_difference(modal("/probes/deflection"), full("/probes/deflection")), 1e-6);
  EXPECT_LT(std::abs(peak(modal("/balance/residual")).first), 1e-9 * 1e5);
}

TEST(ModalBridge, WhatIsRefused) {
  const auto refused = [](const Values& options) {
    return message_of([&] { run_yaml(three_spans, Values{{"model_modes", "5"}} + options); });
  };
  EXPECT_PRED2(contains, refused({{"support_types", "free"}, {"foundation_rotational_bed_k", "1e5"}}), "float");
  EXPECT_PRED2(contains, refused(rayleigh + Values{{"model_damping_ratios", "0.01"}}), "either");
  EXPECT_PRED2(contains, refused({{"model_damping_ratios", "0.01,0.02"}}),
               "has 2 entries; allowed: one, or 5 (one per mode)");
}

}  // namespace
}  // namespace traverse::test
