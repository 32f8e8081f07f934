// Statics with every support and every foundation against the exact chain (support/exact_beam.hpp), Clapeyron's
// three-moment equation and Hetenyi's closed form. With EI constant in each element and springs at nodes, cubic
// elements and the recovery inside them are exact: 1e-8 stands for rounding. On a bed they are not: fourth order.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "support/exact_model.hpp"
#include "support/static_case.hpp"

namespace traverse {
namespace {

using beam::BeamModel;
using beam::Support;
using test::Case;
using test::exact::chain_of;
using test::exact::Load;
using test::exact::Motion;

constexpr double EI = 2.5e9, EA = 1.0e10, m = 1000.0, L = 20.0, g = 9.81, tolerance = 1e-8;

BeamModel model_of(std::vector<double> spans, std::vector<Support> supports, int elements) {
  BeamModel model;
  model.elements.assign(spans.size(), elements);
  model.spans = std::move(spans);
  model.supports = std::move(supports);
  model.EI = EI;
  model.EA = EA;
  model.mass = m;
  return model;
}

/// Largest errors, each relative to the largest value of its kind.
struct Errors {
  double v = 0.0, moment = 0.0, shear = 0.0, u = 0.0, axial = 0.0, reaction = 0.0;
};

/// Response at `stations` (none of which is a load's or a spring's: there shear or moment jump) and the reactions.
Errors errors_of(const BeamModel& model, const std::vector<Load>& loads, double gravity,
                 const std::vector<double>& stations) {
  Case c(model);
  for (const Load& load : loads) c.load(load.x, load.fy, load.moment, load.fx);
  c.weight(gravity).solve();
  const auto bending = chain_of(model, Motion::bending, loads, gravity, stations);
  const auto axial = chain_of(model, Motion::axial, loads, gravity, stations);
  const auto exact = test::exact::statics(bending.chain), along = test::exact::statics(axial.chain);
  Errors error, largest;
  const auto compare = [](double value, double reference, double& worst, double& size) {
    worst = std::max(worst, std::abs(value - reference));
    size = std::max(size, std::abs(reference));
  };
  for (double x : stations) {
    const auto r = c.at(x);
    const auto &e = exact[bending.joint(x)], &a = along[axial.joint(x)];
    compare(r.deflection, e.v, error.v, largest.v);
    const bool end = x == model.length();  // at nodes the recovery looks to the right, here to the left
    compare(r.moment, end ? e.moment_left : e.moment_right, error.moment, largest.moment);
    compare(r.shear, end ? e.shear_left : e.shear_right, error.shear, largest.shear);
    compare(r.axial_displacement, a.u, error.u, largest.u);
    compare(r.axial_force, end ? a.axial_left : a.axial_right, error.axial, largest.axial);
  }
  // A support takes what the section forces on its two sides, springs and loads leave over.
  const auto R = c.reactions();
  double x = 0.0;
  Errors scale;
  for (std::size_t i = 0; i < R.size(); ++i) {
    const std::size_t j = bending.joint(x), k = axial.joint(x);
    const auto& joint = bending.chain.joints[j];
    const auto& bar = axial.chain.joints[k];
    compare(R[i][0], bar.held[0] ? along[k].axial_left - along[k].axial_right - bar.load[0] : 0.0, error.reaction,
            scale.shear);
    compare(R[i][1], joint.held[0] ? exact[j].shear_right - exact[j].shear_left - joint.load[0] : 0.0, error.reaction,
            scale.shear);
    compare(R[i][2] / L, joint.held[1] ? (exact[j].moment_left - exact[j].moment_right - joint.load[1]) / L : 0.0,
            error.reaction, scale.shear);
    if (i + 1 < R.size()) x += model.spans[i];
  }
  const auto relative = [](double value, double size) { return size > 0.0 ? value / size : value; };
  return {relative(error.v, largest.v),         relative(error.moment, largest.moment),
          relative(error.shear, largest.shear), relative(error.u, largest.u),
          relative(error.axial, largest.axial), relative(error.reaction, std::max(scale.shear, largest.shear))};
}

void expect_exact(const BeamModel& model, const std::vector<Load>& loads, double gravity,
                  const std::vector<double>& stations) {
  const Errors e = errors_of(model, loads, gravity, stations);
  EXPECT_LT(e.v, tolerance);
  EXPECT_LT(e.moment, tolerance);
  EXPECT_LT(e.shear, tolerance);
  EXPECT_LT(e.u, tolerance);
  EXPECT_LT(e.axial, tolerance);
  EXPECT_LT(e.reaction, tolerance);
}

// Two loads and a moment inside elements; stations next to them on either side, at nodes and elsewhere.
const std::vector<Load> loads{{3.7, -1e5, 0.0, 2e4}, {8.1, 0.0, 3e5}, {12.6, -6e4, -2e5, -5e4}};
const std::vector<double> stations{0.0,       1.1,  3.7 - 0.1,  3.7 + 0.1,  5.0,  8.1 - 0.1,
                                   8.1 + 0.1, 10.0, 12.6 - 0.1, 12.6 + 0.1, 17.3, 20.0};

class StaticMeshes : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Statics, StaticMeshes, testing::Values(1, 2, 6));

// --- supports --------------------------------------------------------------------------------------------------------

TEST_P(StaticMeshes, EveryPairOfSupports) {
  int cases = 0;
  for (const auto left : {Support::free, Support::roller, Support::pinned, Support::clamped, Support::guided}) {
    for (const auto right : {Support::free, Support::roller, Support::pinned, Support::clamped, Support::guided}) {
      const BeamModel model = model_of({L}, {left, right}, GetParam());
      if (!beam::floating_motion(model).empty()) continue;
      SCOPED_TRACE("supports " + std::to_string(static_cast<int>(left)) + " " +
                   std::to_string(static_cast<int>(right)));
      expect_exact(model, loads, 0.0, stations);
      expect_exact(model, {}, g, stations);
      ++cases;
    }
  }
  // Of 25: the nine with nothing that holds v, or nothing but one v, or nothing along x float.
  EXPECT_EQ(cases, 16);
}

/// Support moments (sagging positive) of a continuous beam by Clapeyron's three-moment equation,
///   L_i M_(i-1) + 2 (L_i + L_(i+1)) M_i + L_(i+1) M_(i+1) = -6 (A_i a_i/L_i + A_(i+1) b_(i+1)/L_(i+1)),
/// right-hand sides: q L^3/4 of a uniform load downward, F a (L^2 - a^2)/L of a force, a from the far support.
Eigen::VectorXd three_moments(const std::vector<double>& spans, double q, const std::vector<Load>& forces) {
  const Eigen::Index n = static_cast<Eigen::Index>(spans.size());
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(n - 1, n - 1);
  Eigen::VectorXd b = Eigen::VectorXd::Zero(n - 1);
  double start = 0.0;
  for (Eigen::Index i = 0; i < n; ++i) {  // span i between supports i and i + 1; M_i in row i - 1
    const double l = spans[static_cast<std::size_t>(i)];
    double at_left = q * l * l * l / 4, at_right = at_left;
    for (const Load& f : forces) {
      const double a = f.x - start;
      if (a < 0.0 || a > l) continue;
      at_right += -f.fy * a * (l * l - a * a) / l;
      at_left += -f.fy * (l - a) * (l * l - (l - a) * (l - a)) / l;
    }
    if (i > 0) {
      A(i - 1, i - 1) += 2 * l;
      b(i - 1) -= at_left;
    }
    if (i + 1 < n) {
      A(i, i) += 2 * l;
      b(i) -= at_right;
    }
    if (i > 0 && i + 1 < n) A(i - 1, i) = A(i, i - 1) = l;
    start += l;
  }
  return A.fullPivLu().solve(b);
}

TEST_P(StaticMeshes, ContinuousSpansByThreeMoments) {
  const std::vector<double> spans{15, 25, 30, 22, 18};
  const auto roller = Support::roller;
  const BeamModel model = model_of(spans, {Support::pinned, roller, roller, roller, roller, roller}, GetParam());
  const std::vector<Load> forces{{6.3, -1e5}, {33.0, -2e5}, {55.5, -5e4}, {101.9, 3e4}};
  const auto M = three_moments(spans, m * g, forces);
  Case c(model);
  for (const Load& f : forces) c.load(f.x, f.fy);
  c.weight(g).solve();
  const auto R = c.reactions();
  double x = 0.0, sum = 0.0;
  for (int i = 0; i < 6; ++i) {
    const double here = i == 0 || i == 5 ? 0.0 : M(i - 1);
    EXPECT_NEAR(c.at(x).moment, here, tolerance * M.cwiseAbs().maxCoeff()) << "support " << i;
    // Equilibrium of each span about its other end.
    double exact = 0.0;
    for (int side : {-1, 0}) {
      const int s = i + side;
      if (s < 0 || s > 4) continue;
      const double l = spans[static_cast<std::size_t>(s)], from = side < 0 ? x - l : x;
      const double there = side < 0 ? (s == 0 ? 0.0 : M(s - 1)) : (s == 4 ? 0.0 : M(s));
      exact += m * g * l / 2 + (there - here) / l;
      for (const Load& f : forces) {
        if (f.x < from || f.x > from + l) continue;
        exact -= f.fy * (side < 0 ? f.x - from : from + l - f.x) / l;
      }
    }
    EXPECT_NEAR(R[static_cast<std::size_t>(i)][1], exact, tolerance * m * g * L) << "support " << i;
    sum += R[static_cast<std::size_t>(i)][1];
    if (i < 5) x += spans[static_cast<std::size_t>(i)];
  }
  EXPECT_NEAR(sum, m * g * 110 + 1e5 + 2e5 + 5e4 - 3e4, 1e-9 * m * g * 110);
  expect_exact(model, forces, g, {0.0, 2.0, 14.9, 20.0, 40.0, 61.7, 80.0, 91.9, 100.0, 110.0});
}

// --- foundations -----------------------------------------------------------------------------------------------------

// The support in the middle of two spans gives way: R = (5 q (2L)^4/(384 EI))/((2L)^3/(48 EI) + 1/k), from equal
// deflections of beam and spring.
TEST_P(StaticMeshes, MiddleSupportThatSettles) {
  const double q = m * g, l = 2 * L;
  for (const double k : {1e4, 1e6, 1e8, 1e10}) {
    BeamModel model = model_of({L, L}, {Support::pinned, Support::free, Support::roller}, GetParam());
    model.foundation.vertical = {{L, k, 0.0}};
    Case c(model);
    c.weight(g).solve();
    const double R = 5 * q * std::pow(l, 4) / (384 * EI) / (std::pow(l, 3) / (48 * EI) + 1 / k);
    EXPECT_NEAR(c.at(L).deflection, -R / k, tolerance * R / k) << k;
    EXPECT_NEAR(c.at(L).moment, q * l * l / 8 - R * l / 4, tolerance * q * l * l / 8) << k;
    EXPECT_NEAR(c.reactions()[0][1], (q * l - R) / 2, tolerance * q * l) << k;
    EXPECT_NEAR(c.reactions()[1][1], 0.0, tolerance * q * l) << "a spring is no support";
  }
}

std::vector<BeamModel> on_springs(int elements) {
  const auto free = Support::free, roller = Support::roller;
  std::vector<BeamModel> models;
  const auto add = [&](Support left, Support right, auto fill) {
    models.push_back(model_of({L / 2, L / 2}, {left, free, right}, elements));
    fill(models.back().foundation);
  };
  add(free, free, [](auto& f) {
    f.vertical = {{0.0, 3e7, 1e5}, {L, 5e7, 1e5}};
    f.longitudinal = {{0.0, 1e8, 0.0}};
  });
  add(Support::pinned, roller, [](auto& f) { f.rotational = {{0.0, 5e8, 1e5}, {L / 2, 2e8, 0.0}, {L, 1e9, 0.0}}; });
  add(roller, roller, [](auto& f) { f.longitudinal = {{0.0, 4e8, 0.0}, {L / 2, 1e8, 1e4}, {L, 2e8, 0.0}}; });
  add(Support::guided, free, [](auto& f) {
    f.vertical = {{L / 2, 3e7, 1e5}, {L, 1e7, 0.0}};
    f.rotational = {{L / 2, 3e8, 0.0}};
    f.longitudinal = {{L / 2, 1e8, 1e4}, {L, 2e8, 0.0}};
  });
  add(Support::pinned, free, [](auto& f) { f.rotational = {{0.0, 1e9, 0.0}}; });
  return models;
}

TEST_P(StaticMeshes, SpringsOfEveryKind) {
  for (const BeamModel& model : on_springs(GetParam())) {
    expect_exact(model, loads, 0.0, stations);
    expect_exact(model, loads, g, stations);
  }
}

/// Springs of every kind and both beds.
BeamModel on_everything(int elements) {
  BeamModel model = on_springs(elements)[3];
  model.foundation.vertical_bed = beam::Bed{beam::Distribution({0, L / 2, L / 2, L}, {4e6, 4e6, 9e6, 9e6}, "k"), 1e4};
  model.foundation.longitudinal_bed = beam::Bed{5e7, 1e4};
  return model;
}

// Displacements and forces on beds: fourth order in bending, second along the beam. (Moments and shears follow from
// equilibrium, with the bed's pressure under the deflections.)
TEST(StaticOrder, BedsAndSpringsTogether) {
  const std::vector<Load> at_nodes{{5.0, -1e5, 0.0, 2e4}, {15.0, -6e4, 2e5, -5e4}};
  // At nodes: in between the error has another factor at each place.
  const std::vector<double> nodes{0.0, 2.5, 7.5, 12.5, 17.5, 20.0};
  const Errors a = errors_of(on_everything(8), at_nodes, g, nodes),
               b = errors_of(on_everything(16), at_nodes, g, nodes);
  EXPECT_NEAR(std::log2(a.v / b.v), 4.0, 0.1);
  EXPECT_NEAR(std::log2(a.moment / b.moment), 4.0, 0.1);
  EXPECT_NEAR(std::log2(a.shear / b.shear), 4.0, 0.1);
  EXPECT_NEAR(std::log2(a.u / b.u), 2.0, 0.1);
  EXPECT_NEAR(std::log2(a.axial / b.axial), 2.0, 0.1);
  const std::vector<double> where{0.0, 1.1, 5.0 + 0.1, 7.5, 12.5, 14.3, 18.0, 20.0};
  const Errors fine = errors_of(on_everything(64), at_nodes, g, where);
  EXPECT_LT(fine.v, 1e-8);
  EXPECT_LT(fine.moment, 1e-8);
  EXPECT_LT(fine.shear, 1e-8);
  EXPECT_LT(fine.reaction, 1e-4) << "along the beam: second order";
}

// Hetenyi 1946, Beams on Elastic Foundation, ch. II: an infinite beam under a force,
//   v = P l/(2k) A(l x), M = P/(4 l) C(l x), Q = -P/2 D(l x); A = e^-y (cos y + sin y), C = e^-y (cos y - sin y),
//   D = e^-y cos y. 120/l of beam are infinite to exp(-60).
TEST(StaticOrder, HetenyisInfiniteBeam) {
  const double k = 1.2e7, lambda = std::pow(k / (4 * EI), 0.25), P = 1e5, length = 120 / lambda;
  const auto errors = [&](int elements, double offset) {
    BeamModel model = model_of({length}, {Support::free, Support::free}, elements);
    model.axial = false;
    model.foundation.vertical_bed = beam::Bed{k, 0.0};
    Case c(model);
    const double at = 0.5 * length + offset * length / elements;
    c.load(at, -P).solve();
    Errors e;
    for (double y : {-4.0, -1.3, -0.21, 1e-6, 0.33, 0.9, 2.0, 5.0}) {
      const double s = std::abs(y), decay = std::exp(-s);
      const auto r = c.at(at + y / lambda);
      e.v = std::max(e.v, std::abs(r.deflection / (P * lambda / (2 * k)) + decay * (std::cos(s) + std::sin(s))));
      e.moment = std::max(e.moment, std::abs(r.moment / (P / (4 * lambda)) - decay * (std::cos(s) - std::sin(s))));
      const double side = y < 0.0 ? 1.0 : -1.0;
      e.shear = std::max(e.shear, std::abs(r.shear / (P / 2) - side * decay * std::cos(s)));
    }
    return e;
  };
  const Errors a = errors(240, 0.0), b = errors(480, 0.0);  // lambda h = 0.5 and 0.25
  EXPECT_NEAR(std::log2(a.v / b.v), 4.0, 0.5);
  EXPECT_NEAR(std::log2(a.moment / b.moment), 4.0, 0.5);
  EXPECT_NEAR(std::log2(a.shear / b.shear), 4.0, 0.5);
  EXPECT_LT(b.v, 3e-5);
  EXPECT_LT(b.moment, 1e-4);
  // Under a force inside an element too: the recovery adds the deflection of the held element on its bed.
  const Errors c = errors(240, 0.37), d = errors(480, 0.37);
  EXPECT_NEAR(std::log2(c.v / d.v), 4.0, 0.5);
  EXPECT_LT(d.v, 3e-5);
  EXPECT_LT(d.moment, 1e-3);
}

// A spring inside an element meets shape functions without its jump of the shear: the deflection is of third order.
TEST(StaticOrder, SpringInsideAnElement) {
  const auto error = [](int elements) {
    BeamModel model = model_of({L}, {Support::pinned, Support::roller}, elements);
    model.foundation.vertical = {{L / 3, 2e7, 0.0}};
    return errors_of(model, {{L / 2, -1e5}}, 0.0, {5.0, 15.0});
  };
  EXPECT_NEAR(std::log2(error(8).v / error(32).v) / 2, 3.0, 0.2);
  EXPECT_LT(error(32).v, 1e-5);
  EXPECT_LT(error(32).reaction, 1e-4);
}

}  // namespace
}  // namespace traverse
