// A layered track that changes along x: stretches with properties of their own, missing and hanging sleepers, ballast
// in shear, a rail of two sections and with joints. Against a model of its own that is assembled densely and
// integrated by another method, and what has to hold whatever the track is.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "support/curve.hpp"
#include "support/dense.hpp"
#include "support/scene_run.hpp"
#include "support/short_bridge.hpp"

namespace traverse::test {
namespace {

using beam::TrackStretch;

TrackStretch stretch(double from, double to, const std::vector<std::pair<std::string, double>>& values) {
  TrackStretch s{"part", from, to, {}, true};
  for (const auto& [name, value] : values)
    for (std::size_t i = 0; i < beam::track_property_count; ++i)
      if (beam::track_properties[i].name == name) s.values[i] = beam::Distribution(value);
  return s;
}

/// Harmonic responses to a force on the rail, of the rail under it and elsewhere, sleepers, ballast and the bridge.
void expect_same_responses(const beam::BeamModel& model, const DenseTrack& hand, double tolerance) {
  beam::Beam beam(PETSC_COMM_SELF, model);
  beam.set_rayleigh({0.0, 0.0});
  const DenseTrackModel dense_model(hand);
  const int each = model.track->elements_per_bay, b = beam.block();
  const beam::Layout& layout = beam.layout();
  const Eigen::MatrixXd M = dense(beam.mass()), C = dense(beam.damping()), K = dense(beam.stiffness());
  for (const double f : {0.0, 8.0, 90.0, 400.0}) {
    const std::complex<double> omega(0.0, 2.0 * std::numbers::pi * f);
    Eigen::MatrixXcd A = omega * omega * M + omega * C + K;
    const Eigen::MatrixXcd B = omega * omega * dense_model.M + omega * dense_model.C + dense_model.K;
    for (Eigen::Index i = 0; i < A.rows(); ++i)
      if (beam.fixed()[static_cast<std::size_t>(i)] != 0) A(i, i) = 1.0;
    for (const int loaded : {3 * each, 12 * each + 1, 25 * each}) {
      Eigen::VectorXcd P = Eigen::VectorXcd::Zero(A.rows()), Q = Eigen::VectorXcd::Zero(B.rows());
      P[beam.rail()->unknown(loaded, 1)] = 1.0;
      Q[dense_model.rail(loaded)] = 1.0;
      const Eigen::VectorXcd x = A.partialPivLu().solve(P), y = B.partialPivLu().solve(Q);
      const double scale = std::abs(y[dense_model.rail(loaded)]);
      for (int node = 0; node <= 32 * each; ++node)
        EXPECT_LT(std::abs(x[beam.rail()->unknown(node, 1)] - y[dense_model.rail(node)]), tolerance * scale)
            << f << " Hz, node " << node << " by a force at " << loaded;
      for (int i = 0; i <= 32; ++i) {
        const DenseSleeper& s = hand.sleepers[static_cast<std::size_t>(i)];
        const int column = i * each * b;
        if (s.there) {
          EXPECT_LT(std::abs(x[column + layout.place[beam::sleeper]] - y[dense_model.sleeper(i)]), tolerance * scale);
        }
        if (hand.own_mass || s.x < -0.1 || s.x > 7.3) {
          EXPECT_LT(std::abs(x[column + layout.ballast_place()] - y[dense_model.ballast(i)]), tolerance * scale);
        }
      }
    }
  }
}

void spoil(DenseSleeper& s) {
  if (within(s.x, -3.6, -1.8)) s.pad_k = 2e7, s.c = 3e5;
  if (within(s.x, -1.2, -0.6)) s.there = false;
  if (within(s.x, 3.0, 4.2)) s.pad_k = s.pad_c = 0.0, s.ballast_mass = 700.0;
  if (within(s.x, 9.6, 11.4)) s.sub_k = 4e7, s.mass = 300.0;
}

void spoil(beam::LayeredTrack& t) {
  t.stretches = {stretch(-3.6, -1.8, {{"pad_k", 2e7}, {"ballast_c", 3e5}}), stretch(-1.2, -0.6, {}),
                 stretch(3.0, 4.2, {{"pad_k", 0.0}, {"pad_c", 0.0}, {"ballast_mass", 700.0}}),
                 stretch(9.6, 11.4, {{"subballast_k", 4e7}, {"sleeper_mass", 300.0}})};
  t.stretches[1].sleepers = false;
}

/// The program puts sleepers on the bridge at multiples of 2^-32 of an element, 2e-10.
constexpr double by_stations = 1e-8;

// Weak pads, missing sleepers, failed pads on the bridge, weak ground: the same structure as by hand.
TEST(TrackStretches, AreTheDenseAssembly) {
  for (const int each : {1, 2}) {
    beam::BeamModel model = short_bridge(each);
    spoil(*model.track);
    expect_same_responses(model, by_hand(model, [](DenseSleeper& s) { spoil(s); }), by_stations);
  }
}

// With one element a bay neighbouring masses are joined directly; with more by links, whose mass is a millionth.
TEST(TrackStretches, BallastInShearIsTheDenseAssembly) {
  for (const bool own_mass : {false, true})
    for (const int each : {1, 2, 3}) {
      beam::BeamModel model = short_bridge(each);
      spoil(*model.track);
      model.track->own_mass = own_mass;
      model.track->shear = {1.568e8, 1.6e5};
      expect_same_responses(model, by_hand(model, [](DenseSleeper& s) { spoil(s); }), each == 1 ? by_stations : 2e-6);
    }
}

TEST(TrackStretches, RailOfTwoSections) {
  beam::BeamModel model = short_bridge(2);
  model.track->rail_EI = beam::Distribution({-6.0, 3.0, 3.0, 20.0}, {1.3e7, 1.3e7, 9e6, 9e6}, "rail");
  DenseTrack hand = by_hand(model, [](DenseSleeper&) {});
  hand.rail_EI_at = [](double x) { return x < 3.0 ? 1.3e7 : 9e6; };
  expect_same_responses(model, hand, by_stations);
}

const Values hanging = {{"track_stretches", "hung,over"}, {"track_hung_from", "-2.4"}, {"track_hung_to", "-1.2"},
                        {"track_hung_gap", "2e-4"},       {"track_over_from", "3.6"},  {"track_over_to", "3.6"},
                        {"track_over_gap", "1e-4"},       {"ts_dt", "1e-4"},           {"ts_max_time", "0.38"},
                        {"output_interval", "2e-3"}};

// Three sleepers hang before the bridge, one on it; a force closes the gaps as it passes. Against Newmark's method with
// steps of 2e-5 s on the dense model.
TEST(TrackStretches, HangingSleepersAgainstAnotherIntegration) {
  Results run = run_yaml(short_bridge_scene, hanging);
  const std::vector<double> stations = run("/track/hanging/x"), time = run.time();
  ASSERT_EQ(stations.size(), 4U);
  const beam::BeamModel model = short_bridge(2);
  const DenseTrackModel m(by_hand(model, [](DenseSleeper& s) {
    if (within(s.x, -2.4, -1.2)) s.gap = 2e-4;
    if (within(s.x, 3.6, 3.6)) s.gap = 1e-4;
  }));
  ASSERT_EQ(m.gaps.size(), 4U);
  constexpr double h = 2e-5, speed = 30.0;
  DenseNewmark motion(m.M, m.C, m.K, m.gaps, h);
  motion.start(m.K.llt().solve(1e5 * m.force_at(-5.0)), 1e5 * m.force_at(-5.0));
  const std::vector<double> force = run("/track/hanging/force"), gap = run("/track/hanging/gap"),
                            bridge = run("/probes/deflection");
  double worst_force = 0.0, worst_gap = 0.0, worst_bridge = 0.0, greatest = 0.0, deepest = 0.0, closed = 0.0;
  std::size_t sample = 0;
  const Eigen::VectorXd midspan = m.bridge_at(3.6);
  for (int i = 0; sample < time.size(); ++i) {
    if (i > 0) motion.step(1e5 * m.force_at(-5.0 + speed * i * h));
    if (i * h < time[sample] - 0.5 * h) continue;
    for (std::size_t j = 0; j < 4; ++j) {
      const double d = m.gaps[j].shape.dot(motion.v) + m.gaps[j].gap;
      worst_gap = std::max(worst_gap, std::abs(gap[4 * sample + j] - d));
      closed = std::min(closed, d);
      if (i > 0)
        worst_force =
            std::max(worst_force, std::abs(force[4 * sample + j] - motion.force[static_cast<Eigen::Index>(j)]));
      greatest = std::max(greatest, force[4 * sample + j]);
    }
    worst_bridge = std::max(worst_bridge, std::abs(bridge[3 * sample + 1] - midspan.dot(motion.v)));
    deepest = std::max(deepest, std::abs(bridge[3 * sample + 1]));
    ++sample;
  }
  EXPECT_GT(greatest, 1e4) << "the gaps close";
  EXPECT_LT(closed, -2e-5);
  EXPECT_LT(worst_gap, 1e-3 * 2e-4);
  EXPECT_LT(worst_force, 1e-3 * greatest);
  EXPECT_LT(worst_bridge, 1e-3 * deepest);
  RecordProperty("gap_error", text(worst_gap / 2e-4));
  RecordProperty("force_error", text(worst_force / greatest));
  RecordProperty("bridge_error", text(worst_bridge / deepest));
  // Forces and energy are in balance, gaps included.
  EXPECT_LT(std::abs(peak(run("/balance/residual")).first), 1e-6 * 1e5);
  EXPECT_LT(energy_error(run), 1e-4);
}

// A stretch with the values of the rest, tables that are constant: nothing changes, to the last bit.
TEST(TrackStretches, OfTheSameValuesChangeNothing) {
  const Values times = {{"ts_dt", "5e-4"}, {"ts_max_time", "0.3"}, {"output_interval", "5e-3"}};
  Results plain = run_yaml(short_bridge_scene, times);
  Results same = run_yaml(short_bridge_scene, times + Values{{"track_stretches", "a"},
                                                             {"track_a_from", "-3"},
                                                             {"track_a_to", "5"},
                                                             {"track_a_pad_k", "1.3e8"},
                                                             {"track_a_ballast_c", "1.2e5"},
                                                             {"track_a_gap", "0"},
                                                             {"track_a_sleepers", "standard"}});
  for (const char* name : {"/probes/deflection", "/rail/acceleration", "/energy/dissipated"})
    EXPECT_EQ(plain(name), same(name)) << name;
}

// Forces at rest, gaps closed by them, and the mirrored track under mirrored forces.
TEST(TrackStretches, MirrorImages) {
  const Values rest = {{"scene_analysis", "static"}, {"load_speed", "0"}, {"track_shear_k", "1.5e8"}};
  const auto with = [&](const char* loads, const char* hung, const char* gone) {
    return run_yaml(short_bridge_scene,
                    rest + Values{{"load_positions", loads},
                                  {"load_forces", "1e5,8e4"},
                                  {"track_stretches", "hung,gone"},
                                  {"track_hung_from", std::string(hung).substr(0, std::string(hung).find(','))},
                                  {"track_hung_to", std::string(hung).substr(std::string(hung).find(',') + 1)},
                                  {"track_hung_gap", "1e-4"},
                                  {"track_gone_from", gone},
                                  {"track_gone_to", gone},
                                  {"track_gone_sleepers", "none"}});
  };
  Results left = with("-1.4,2.0", "-1.8,0.6", "4.8"), right = with("8.6,5.2", "6.6,9.0", "2.4");
  const std::vector<double> a = left("/rail/deflection"), b = right("/rail/deflection"),
                            f = left("/track/hanging/force"), g = right("/track/hanging/force");
  ASSERT_EQ(f.size(), 5U);
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a[i], b[a.size() - 1 - i], 1e-9 * std::abs(peak(a).first));
  for (std::size_t i = 0; i < f.size(); ++i) EXPECT_NEAR(f[i], g[f.size() - 1 - i], 1e-7 * peak(f).first);
  EXPECT_GT(peak(f).first, 1e3);
}

// What the shear's dampers take is in the balance.
TEST(TrackStretches, EnergyOfBallastInShear) {
  Results run = run_yaml(short_bridge_scene, {{"track_shear_k", "1.568e8"},
                                              {"track_shear_c", "1.6e5"},
                                              {"track_ballast_own_mass", "true"},
                                              {"beam_self_weight", "true"},
                                              {"ts_dt", "1e-4"},
                                              {"ts_max_time", "0.5"}});
  EXPECT_LT(energy_error(run), 1e-6);
  EXPECT_LT(std::abs(peak(run("/balance/residual")).first), 1e-9 * 9.81 * 12 * 5000.0);
  Results without = run_yaml(short_bridge_scene, {{"track_shear_k", "1.568e8"},
                                                  {"track_ballast_own_mass", "true"},
                                                  {"beam_self_weight", "true"},
                                                  {"ts_dt", "1e-4"},
                                                  {"ts_max_time", "0.5"}});
  EXPECT_GT(relative_difference(run("/energy/dissipated"), without("/energy/dissipated")), 1e-3);
}

// The joint carries no moment: left and right of it the rail is a half-infinite beam on a bed with half the force at
// its end, which sinks by 2 (P/2) lambda/k there (Hetenyi), twice as far as a rail that goes through.
// Sleepers instead of a bed are a trapezoidal rule that ends at the joint: its error falls with the square of their
// spacing.
TEST(TrackStretches, RailJointOnABed) {
  const double k = 1e7 / 0.1, lambda = std::pow(k / (4 * 1.32476e7), 0.25);
  const auto exact = [&](double x) { return -2e5 * lambda / k * std::exp(-lambda * x) * std::cos(lambda * x); };
  std::vector<double> errors, others;
  for (const double spacing : {0.1, 0.05}) {
    Results run = run_yaml(R"(
beam: {spans: 20.0, EI: 1.0e16, mass: 1.0e5}
support: {types: [clamped, clamped]}
track:
  rail: {EI: 1.32476e7, mass: 121.28, hinges: 10.0}
  elements_per_bay: 1
  approach: 30.0
load: {forces: 2.0e5, positions: 10.0, speed: 0.0}
scene: {analysis: static}
output: {probes: [8.0, 10.0, 12.0]}
)",
                           {{"track_spacing", text(spacing)}, {"track_pad_k", text(k * spacing)}});
    const std::vector<double> rail = run("/rail/deflection");
    EXPECT_NEAR(rail[0], rail[2], 1e-8 * std::abs(rail[1]));
    errors.push_back(rail[1] / exact(0.0) - 1.0);
    others.push_back((rail[2] - exact(2.0)) / exact(0.0));
  }
  EXPECT_NEAR(errors[0] / errors[1], 4.0, 0.1);
  EXPECT_LT(std::abs(4.0 * errors[1] - errors[0]) / 3.0, 1e-4);
  EXPECT_LT(std::abs(4.0 * others[1] - others[0]) / 3.0, 1e-4);
  RecordProperty("extrapolated_error", text((4.0 * errors[1] - errors[0]) / 3.0));
}

}  // namespace
}  // namespace traverse::test
