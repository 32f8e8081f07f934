// Deflections between nodes where a foundation acts inside the elements.
#include <gtest/gtest.h>

#include <cmath>

#include "support/scene_run.hpp"
#include "support/static_case.hpp"

namespace traverse::test {
namespace {

using beam::BeamModel;
using beam::Support;

constexpr double g = 9.81;

// A uniform beam that rests on a uniform bed sinks in by q/k everywhere: the bed carries the weight, not the bending.
constexpr double rail_EI = 6.2e6, rail_mass = 113.0, bed_k = 2.35e7, sunk = rail_mass * g / bed_k;

const std::string resting_rail = R"(
beam: {spans: 60.0, elements_per_span: 10, EI: 6.2e6, mass: 113.0, self_weight: true}
support: {types: free}
foundation: {vertical_bed: {k: 2.35e7}}
scene: {analysis: static}
output: {probes: [0.0, 0.4, 30.0, 31.0, 33.0, 34.5, 60.0]}
)";

TEST(RecoveryOnFoundation, ABedCarriesTheWeightBetweenNodes) {
  for (const char* one_sided : {"false", "true"}) {
    Results run = run_yaml(resting_rail, {{"foundation_vertical_bed_one_sided", one_sided}});
    for (const double v : run("/probes/deflection")) EXPECT_NEAR(v, -sunk, 1e-9 * sunk) << one_sided;
    for (const double moment : run("/probes/moment")) EXPECT_NEAR(moment, 0.0, 1e-6);
    EXPECT_NEAR(run.attribute("/summary", "deflection"), -sunk, 1e-9 * sunk);
  }
}

// A long beam that heaves on its bed stays straight: inertia inside the elements balances the bed.
TEST(RecoveryOnFoundation, AHeavingBeamStaysStraight) {
  BeamModel model;
  model.spans = {60.0};
  model.elements = {10};
  model.supports = {Support::free, Support::free};
  model.EI = rail_EI;
  model.mass = rail_mass;
  model.axial = false;
  model.foundation.vertical_bed = beam::Bed{bed_k, 1e4};
  const beam::Beam beam(PETSC_COMM_SELF, model);
  std::vector<double> v(beam.local_unknowns(), 0.0), w = v, a = v;
  const double rate = 0.3, lift = 0.01;
  for (std::size_t i = 0; i < v.size(); i += 2) {
    v[i] = lift;
    w[i] = rate;
    a[i] = -(bed_k * lift + 1e4 * rate) / rail_mass;
  }
  std::vector<recovery::Response> out;
  recovery::Recovery(beam, {30.0, 31.0, 33.0, 35.7}, 0.0).evaluate(v.data(), w.data(), a.data(), {}, out);
  for (const recovery::Response& r : out) EXPECT_NEAR(r.deflection, lift, 1e-9 * lift);
}

/// Clamped at both ends: one element knows all of its deflection, whatever stands inside.
BeamModel clamped(double bed, int elements, const std::vector<beam::PointFoundation>& vertical,
                  const std::vector<beam::PointFoundation>& rotational) {
  BeamModel model;
  model.spans = {6.0};
  model.elements = {elements};
  model.supports = {Support::clamped, Support::clamped};
  model.EI = rail_EI;
  model.mass = rail_mass;
  model.axial = false;
  if (bed > 0.0) model.foundation.vertical_bed = beam::Bed{bed, 0.0};
  model.foundation.vertical = vertical;
  model.foundation.rotational = rotational;
  return model;
}

double deflection_error(double bed, const std::vector<beam::PointFoundation>& vertical,
                        const std::vector<beam::PointFoundation>& rotational) {
  const auto loaded = [&](int elements) {
    Case c(clamped(bed, elements, vertical, rotational));
    c.load(2.1, -1e5).load(4.5, 3e4, 2e5).weight(g).solve();
    return c;
  };
  Case one = loaded(1), many = loaded(240);  // 25 mm: all that stands inside the one stands at nodes of the many
  double error = 0.0, largest = 0.0;
  for (const double x : {0.3, 1.5, 2.1, 2.7, 3.0, 4.5, 5.1}) {
    error = std::max(error, std::abs(one.at(x).deflection - many.at(x).deflection));
    largest = std::max(largest, std::abs(many.at(x).deflection));
  }
  return error / largest;
}

// From a bed that hardly counts to one in which the held ends are not felt, 0.1 to 30 waves' lengths an element.
TEST(RecoveryOnFoundation, OneHeldElementIsExactOnAnyBed) {
  for (const double bed : {1.0, 1e2, 1e3, 1e5, 2.35e7, 2e9}) EXPECT_LT(deflection_error(bed, {}, {}), 3e-5) << bed;
}

TEST(RecoveryOnFoundation, OneHeldElementIsExactWithSpringsInside) {
  for (const double k : {1e5, 1e7, 1e9, 1e13}) {
    EXPECT_LT(deflection_error(0.0, {{1.5, k, 0.0}, {3.9, 0.3 * k, 0.0}}, {}), 1e-7) << k;
    EXPECT_LT(deflection_error(0.0, {}, {{2.7, k, 0.0}}), 1e-7) << k;
    EXPECT_LT(deflection_error(2.35e6, {{2.7, k, 0.0}}, {{4.8, k, 0.0}}), 1e-6) << k;
  }
}

// A bridge by its modes shows the same: its modes bend between nodes as the bed lets them.
TEST(RecoveryOnFoundation, AnElementOnABedByModes) {
  const std::string text = R"(
beam: {spans: 30.0, elements_per_span: 6, EI: 6.2e7, mass: 1000.0, self_weight: true}
support: {types: [pinned, roller]}
foundation: {vertical_bed: {k: 4.0e6}}
load: {forces: 1.0e5, positions: 0.0, speed: 30.0}
ts: {max_time: 1.0}
output: {interval: 0.005, probes: [12.5]}
)";
  Results modal = run_yaml(text, {{"model_modes", "12"}});
  Results fine = run_yaml(text, {{"ts_dt", "2e-4"}});
  EXPECT_LT(relative_difference(modal("/probes/deflection"), fine("/probes/deflection")), 2e-5);
}

}  // namespace
}  // namespace traverse::test
