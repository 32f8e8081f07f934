// Springs and beds from 1 to 1e15 N/m: at each decade the exact frequency or deflection (support/exact_beam.hpp), and
// at both ends of the range the limits, free and rigid.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "support/convergence.hpp"
#include "support/curve.hpp"
#include "support/one_span.hpp"
#include "support/static_case.hpp"

namespace traverse {
namespace {

using beam::BeamModel;
using beam::PointFoundation;
using beam::Support;
using std::numbers::pi;
using test::axial_frequencies;
using test::frequencies;
using test::exact::chain_of;
using test::exact::Motion;

using namespace test::one_span;

std::vector<double> decades() {
  std::vector<double> k;
  for (int power = 0; power <= 15; ++power) k.push_back(std::pow(10.0, power));
  return k;
}

/// What rounding of the stiffness matrix does to a motion that only a spring k holds: eps 12 EI/h^3 against k, some
/// entries of it.
double rounding(double k, int elements) { return 16 * 2.2e-16 * 12 * EI * std::pow(elements / L, 3) / k; }

// --- frequencies -----------------------------------------------------------------------------------------------------

/// Three frequencies against the exact ones at each decade; returns those of the last.
template <class Fill>
std::vector<double> at_each_decade(Support left, Support right, Fill fill, double first, double last) {
  constexpr int n = 32;
  std::vector<double> found;
  double before = 0.0;
  for (double k : decades()) {
    BeamModel model = span(left, right, n);
    fill(model.foundation, k);
    found = frequencies(model, 3);
    const auto exact = test::exact::frequencies(chain_of(model).chain, 3);
    // omega of a motion without strain is that much off; (beta h)^4/1440 for beta L = 11 is 1e-5.
    for (int i = 0; i < 3; ++i) {
      EXPECT_NEAR(found[i] / exact[i], 1.0, (i == 2 ? 2e-5 : 3e-6) + rounding(k, n))
          << "k = " << k << ", mode " << i + 1;
    }
    EXPECT_GT(found[0], before * (1 - 1e-8)) << "stiffer is higher, k = " << k;
    before = found[0];
    if (k == 1.0 && first > 0.0) {
      EXPECT_NEAR(found[0] / first, 1.0, 1e-5 + rounding(k, n));
    }
  }
  EXPECT_NEAR(found[0] / last, 1.0, 1e-5);
  return found;
}

TEST(Decades, TipSpringFromFreeToPinned) {
  at_each_decade(
      Support::clamped, Support::free,
      [](auto& f, double k) {
        f.vertical = {PointFoundation{L, k, 0.0}};
      },
      unit * std::pow(1.875104068711961, 2), unit * std::pow(3.926602312047919, 2));
}

TEST(Decades, EndSpringFromHingeToClamp) {
  at_each_decade(
      Support::pinned, Support::roller,
      [](auto& f, double k) {
        f.rotational = {PointFoundation{0.0, k, 0.0}};
      },
      unit * pi * pi, unit * std::pow(3.926602312047919, 2));
}

// From a beam that hovers, sqrt(2 k/(m L)), to one on two supports.
TEST(Decades, FreeBeamOnTwoSprings) {
  at_each_decade(
      Support::free, Support::free,
      [](auto& f, double k) {
        f.vertical = {PointFoundation{0.0, k, 0.0}, PointFoundation{L, k, 0.0}};
      },
      std::sqrt(2.0 / (m * L)), unit * pi * pi);
}

// From one span to two.
TEST(Decades, MiddleSpring) {
  const auto found = at_each_decade(
      Support::pinned, Support::roller,
      [](auto& f, double k) {
        f.vertical = {PointFoundation{L / 2, k, 0.0}};
      },
      unit * pi * pi, unit * 4 * pi * pi);
  EXPECT_NEAR(found[1] / (unit * std::pow(2 * 3.926602312047919, 2)), 1.0, 1e-5);
}

// omega^2 = (n pi/L)^4 EI/m + k/m. At 1e15 N/m2 the beam's own part is 1e-10 of it, below the rounding of sums.
TEST(Decades, Bed) {
  for (double k : decades()) {
    BeamModel model = span(Support::pinned, Support::roller, 32);
    model.foundation.vertical_bed = beam::Bed{k, 0.0};
    const auto found = frequencies(model, 3);
    ASSERT_EQ(found.size(), 3u);
    for (int i = 0; i < 3; ++i) {
      const double own = unit * std::pow((i + 1) * pi, 2);
      EXPECT_NEAR(found[i] / std::hypot(own, std::sqrt(k / m)), 1.0, 1e-5) << "k = " << k << ", mode " << i + 1;
    }
    model.supports = {Support::free, Support::free};
    EXPECT_NEAR(frequencies(model, 1)[0] / std::sqrt(k / m), 1.0, 1e-9 + rounding(k * L, 32)) << "k = " << k;
  }
}

// Along the beam: from a bar that slides, sqrt(k/(m L)), to one that is held; linear elements are off by (beta h)^2/24.
TEST(Decades, LongitudinalSpringAndBed) {
  constexpr int n = 64;
  for (double k : decades()) {
    BeamModel model = span(Support::roller, Support::roller, n, true);
    model.foundation.longitudinal = {{L, k, 0.0}};
    const auto exact = test::exact::frequencies(chain_of(model, Motion::axial).chain, 2);
    const auto found = axial_frequencies(model, 2);
    // A symmetric eigenvalue is right to the rounding of the largest, 12 EA n^2/(m L^2), beside k/(m L); half in omega.
    const double lost = 6 * 2.2e-16 * EA * n * n / L / k;
    EXPECT_NEAR(found[0] / exact[0], 1.0, 1e-4 + lost) << "k = " << k;
    EXPECT_NEAR(found[1] / exact[1], 1.0, 1e-3) << "k = " << k;
    if (k == 1.0) {
      EXPECT_NEAR(found[0] / std::sqrt(k / (m * L)), 1.0, 1e-6 + lost);
    }
    if (k == 1e15) {
      EXPECT_NEAR(found[0] / (pi / (2 * L) * std::sqrt(EA / m)), 1.0, 1e-4);
    }
    model.foundation.longitudinal.clear();
    model.foundation.longitudinal_bed = beam::Bed{k, 0.0};
    EXPECT_NEAR(axial_frequencies(model, 1)[0] / std::sqrt(k / m), 1.0, 1e-9 + lost) << "bed k = " << k;
  }
}

// --- statics ---------------------------------------------------------------------------------------------------------

// A force in the middle of a beam on two springs: P/(2k) + P L^3/(48 EI).
TEST(Decades, StaticsOnTwoSprings) {
  const double P = 1e5, own = P * L * L * L / (48 * EI);
  for (double k : decades()) {
    BeamModel model = span(Support::free, Support::free, 8);
    model.foundation.vertical = {{0.0, k, 0.0}, {L, k, 0.0}};
    test::Case c(model);
    c.load(L / 2, -P).solve();
    EXPECT_NEAR(-c.at(L / 2).deflection / (P / (2 * k) + own), 1.0, 1e-8 + rounding(k, 8)) << "k = " << k;
    EXPECT_NEAR(-c.at(0.0).deflection * 2 * k / P, 1.0, 1e-8 + rounding(k, 8)) << "k = " << k;
    EXPECT_NEAR(c.at(L / 2).moment / (P * L / 4), 1.0, 1e-6 + rounding(k, 8)) << "k = " << k;
  }
}

TEST(Decades, StaticsOnOtherSpringsAndBeds) {
  const std::vector<test::exact::Load> loads{{7.0, -1e5, 0.0, 3e4}};
  const std::vector<double> where{0.0, 5.0, 12.0, 20.0};
  for (double k : decades()) {
    BeamModel turning = span(Support::guided, Support::free, 8, true), lying = span(Support::free, Support::roller, 64);
    turning.supports = {Support::pinned, Support::free};
    turning.foundation.rotational = {{0.0, k, 0.0}};
    test::Case a(turning);
    a.load(7.0, -1e5).solve();
    // Turns by M/k, whatever the beam does.
    const double exact = -1e5 * 7.0 / k * L - 1e5 * 49.0 / (6 * EI) * (3 * L - 7.0);
    EXPECT_NEAR(a.at(L).deflection / exact, 1.0, 1e-8 + rounding(k / (L * L), 8)) << "k = " << k;
    EXPECT_NEAR(a.at(0.0).moment / (-7e5), 1.0, 1e-6 + rounding(k / (L * L), 8)) << "k = " << k;

    if (k > 1e10) continue;  // a bed whose waves are shorter than an element: its own test below
    lying.foundation.vertical_bed = beam::Bed{k, 0.0};
    test::Case b(lying);
    b.load(7.5, -1e5).solve();
    const auto reference = chain_of(lying, Motion::bending, {{7.5, -1e5}}, 0.0, where);
    const auto sections = test::exact::statics(reference.chain);
    const double scale = std::abs(sections[reference.joint(7.5)].v);
    for (double x : where) {
      EXPECT_NEAR(b.at(x).deflection, sections[reference.joint(x)].v, (1e-3 + rounding(k * L, 64)) * scale)
          << "k = " << k << ", x = " << x;
    }
  }
}

// On 1e15 N/m2 the wave is 0.05 m long and the mesh sees nothing of it; what lies on the beam must still reach the
// ground: the deflection under a uniform load is q/k.
TEST(Decades, WeightOnAStiffBed) {
  for (double k : decades()) {
    BeamModel model = span(Support::free, Support::free, 16);
    model.foundation.vertical_bed = beam::Bed{k, 0.0};
    test::Case c(model);
    c.weight(9.81).solve();
    for (double x : {0.0, 3.0, 10.0}) {
      // The recovery adds the deflection of a clamped element without its bed, q h^4/(384 EI).
      EXPECT_NEAR(c.at(x).deflection, -m * 9.81 / k,
                  (1e-9 + rounding(k * L, 16)) * m * 9.81 / k + m * 9.81 * 2.5 / (384 * EI))
          << "k = " << k;
    }
    EXPECT_NEAR(c.v[0] / (-m * 9.81 / k), 1.0, 1e-9 + rounding(k * L, 16)) << "k = " << k;
  }
}

// --- whole runs ------------------------------------------------------------------------------------------------------

std::string scene(const std::string& supports, const std::string& foundation) {
  return "beam: {spans: 20.0, EI: 1.96e9, mass: 1000.0, elements_per_span: 8}\nsupport: {types: [" + supports + "]}\n" +
         (foundation.empty() ? "" : "foundation: {" + foundation + "}\n") +
         "load: {forces: 1.0e5, speed: 40.0}\nts: {dt: 2.0e-3, max_time: 0.5}\noutput: {interval: 0.01, probes: [5, "
         "10, 20]}\n";
}

// Springs and dampers of 1e15 are supports, of 0 are none; in between nothing breaks, and the energy balances (the run
// throws otherwise).
TEST(Decades, RunsBetweenFreeAndPropped) {
  const auto deflections = [](const std::string& supports, const std::string& foundation) {
    return test::run_yaml(scene(supports, foundation))("/probes/deflection");
  };
  const auto free = deflections("clamped, free", ""), propped = deflections("clamped, roller", "");
  const double largest = std::abs(test::peak(free).first);
  for (const char* kind : {"k", "c"}) {
    for (int power = 0; power <= 15; power += 3) {
      const auto found = deflections(
          "clamped, free", "vertical: {x: 20.0, " + std::string(kind) + ": 1.0e" + std::to_string(power) + "}");
      EXPECT_LT(std::abs(test::peak(found).first), largest * (1 + 1e-6)) << kind << " 1e" << power;
      // EI/L^3 = 2.45e5 N/m; 12.3 rad/s times 3e5 N s/m are as much.
      if (power == 0) {
        EXPECT_LT(test::relative_difference(found, free), 1e-4) << kind;
      }
      if (power == 15) {
        EXPECT_LT(test::relative_difference(found, propped), 1e-6) << kind;
      }
    }
  }
}

// 1 N: on springs of 1 N/m the usual 100 kN would sink by 50 km, which the program refuses.
TEST(Decades, StaticsOfAScene) {
  const double own = L * L * L / (48 * EI);
  for (int power = 0; power <= 15; power += 3) {
    const double k = std::pow(10.0, power);
    auto results =
        test::run_yaml(scene("free, free", "vertical: {x: [0.0, 20.0], k: 1.0e" + std::to_string(power) + "}"),
                       {{"scene_analysis", "static"}, {"load_positions", "10"}, {"load_forces", "1.0"}});
    EXPECT_NEAR(-results("/probes/deflection")[1] / (1 / (2 * k) + own), 1.0, 1e-8 + rounding(k, 8)) << k;
  }
}

}  // namespace
}  // namespace traverse
