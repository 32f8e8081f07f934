// Shape functions (equation 3 of the paper), tables along the beam, element matrices against fine quadrature (equations
// 8 and 9), meshes, checks of input, and rigid-body motions.
#include "support/beam_model.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "beam/beam.hpp"
#include "beam/mesh.hpp"
#include "beam/shape.hpp"

namespace traverse {
namespace {

using beam::Beam;
using beam::BeamModel;
using beam::Distribution;
using beam::Support;
using test::model_of;

// --- the line through the supports

TEST(SupportLine, GoesThroughSupportsAndSpringsAtSpanEnds) {
  const std::vector<double> ground = {0.01, 0.05, -0.03, 0.0};
  BeamModel model = model_of({10.0, 20.0, 5.0}, 2, false);
  const auto height = [&](double x) { return beam::SupportLines(model).at(x).height(ground); };
  model.supports = {Support::pinned, Support::roller, Support::roller, Support::free};
  EXPECT_NEAR(height(5.0), 0.03, 1e-15);
  EXPECT_NEAR(height(10.0), 0.05, 1e-15);
  EXPECT_NEAR(height(20.0), 0.01, 1e-15);
  EXPECT_NEAR(height(35.0), -0.05, 1e-15);  // beyond the last support
  model.supports[1] = Support::free;
  EXPECT_NEAR(height(15.0), -0.01, 1e-15);
  model.foundation.vertical.push_back({.x = 10.0, .k = 1.0e8});
  EXPECT_NEAR(height(15.0), 0.03, 1e-15);
  model.supports[2] = Support::clamped;
  EXPECT_NEAR(height(35.0), -0.03, 1e-15);  // it does not turn
  model.foundation.vertical.clear();
  model.supports = {Support::free, Support::clamped, Support::free, Support::free};
  EXPECT_NEAR(height(0.0), 0.05, 1e-15);
  EXPECT_NEAR(height(35.0), 0.05, 1e-15);
  model.supports[1] = Support::free;
  EXPECT_EQ(height(20.0), 0.0);
}

// --- shape functions

TEST(Shape, NodalConditionsOfEquation3) {
  const double h = 2.5;
  const auto left = beam::hermite(0.0, h), right = beam::hermite(1.0, h);
  const std::array<double, 4> e0{1, 0, 0, 0}, e1{0, 1, 0, 0}, e2{0, 0, 1, 0}, e3{0, 0, 0, 1};
  EXPECT_EQ(left.value, e0);
  EXPECT_EQ(left.slope, e1);
  EXPECT_EQ(right.value, e2);
  EXPECT_EQ(right.slope, e3);
}

TEST(Shape, DerivativesAgainstDifferences) {
  const double h = 2.5, d = 1e-5;
  for (double xi : {0.1, 0.5, 0.83}) {
    const auto s = beam::hermite(xi, h), m = beam::hermite(xi - d, h), p = beam::hermite(xi + d, h);
    for (int i = 0; i < 4; ++i) {
      EXPECT_NEAR(s.slope[i], (p.value[i] - m.value[i]) / (2 * d * h), 1e-9);
      EXPECT_NEAR(s.curvature[i], (p.slope[i] - m.slope[i]) / (2 * d * h), 1e-9);
      EXPECT_NEAR(s.third[i], (p.curvature[i] - m.curvature[i]) / (2 * d * h), 1e-9);
    }
  }
}

// --- distributions

TEST(Distributions, TableWithAStep) {
  const Distribution d({0, 10, 10, 20}, {1, 3, 7, 5}, "beam_EI");
  EXPECT_EQ(d.at(5, 6), 2.0);
  EXPECT_EQ(d.at(10, 9), 3.0);
  EXPECT_EQ(d.at(10, 11), 7.0);
  EXPECT_EQ(d.at(-4, 0), 1.0);
  EXPECT_EQ(d.at(25, 20), 5.0);
  EXPECT_EQ(d.minimum(), 1.0);
  EXPECT_EQ(d.maximum(), 7.0);
  EXPECT_EQ(d.breaks(0, 20), std::vector<double>{10.0});
  EXPECT_EQ(d.breaks(-1, 21), (std::vector<double>{0, 10, 20}));
  EXPECT_FALSE(d.uniform());
  EXPECT_TRUE(Distribution(4.0).uniform());
}

TEST(Distributions, BadTables) {
  EXPECT_THROW(Distribution({0, 1}, {1}, "beam_EI"), InputError);
  EXPECT_THROW(Distribution({}, {}, "beam_EI"), InputError);
  EXPECT_THROW(Distribution({0, 2, 1}, {1, 1, 1}, "beam_EI"), InputError);
  EXPECT_THROW(Distribution({0, 1, 1, 1}, {1, 1, 1, 1}, "beam_EI"), InputError);
  EXPECT_THROW(Distribution({0, std::nan("")}, {1, 1}, "beam_EI"), InputError);
  try {
    Distribution({0, 2, 1}, {1, 1, 1}, "beam_EI");
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("beam_EI"), std::string::npos);
  }
}

// --- element matrices

/// Integral over an element by a rule so fine that it knows nothing of steps and kinks.
template <class F>
double fine_integral(const beam::Element& e, F f) {
  const int n = 20000;
  double sum = 0.0;
  for (int i = 0; i < n; ++i) sum += f(e.x + e.length * (i + 0.5) / n) * e.length / n;
  return sum;
}

TEST(ElementMatrices, TablesAreIntegratedExactly) {
  auto m = model_of({20}, 4);
  m.EI = Distribution({0, 6, 6, 8, 20}, {1e9, 3e9, 2e9, 2.5e9, 1e9}, "beam_EI");
  m.EA = Distribution({5, 7}, {1e10, 2e10}, "beam_EA");
  m.mass = Distribution({0, 9, 9, 20}, {1000, 2000, 500, 600}, "beam_mass");
  const beam::Element e{1, 0, 5.0, 5.0};
  const auto matrices = beam::element_matrices(m, e);
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      const double k = fine_integral(e, [&](double x) {
        const auto s = beam::hermite((x - e.x) / e.length, e.length);
        return m.EI.at(x, x + 1e-9) * s.curvature[i] * s.curvature[j];
      });
      const double mass = fine_integral(e, [&](double x) {
        const auto s = beam::hermite((x - e.x) / e.length, e.length);
        return m.mass.at(x, x + 1e-9) * s.value[i] * s.value[j];
      });
      EXPECT_NEAR(matrices.stiffness[4 * i + j], k, 1e-7 * 2e9);
      EXPECT_NEAR(matrices.mass[4 * i + j], mass, 1e-7 * 2e4);
    }
  }
  const double EA = fine_integral(e, [&](double x) { return m.EA.at(x, x + 1e-9); }) / 25.0;
  EXPECT_NEAR(matrices.axial_stiffness[0], EA, 1e-7 * EA);
}

TEST(ElementMatrices, ClosedFormIsTheIntegral) {
  auto uniform = model_of({20}, 4), table = uniform;
  // Constant where the element lies, to within rounding, so that it is integrated.
  const double bit = 1.0 + 1e-15;
  table.EI = Distribution({0, 20}, {2e9, 2e9 * bit}, "beam_EI");
  table.EA = Distribution({0, 20}, {1e10, 1e10 * bit}, "beam_EA");
  table.mass = Distribution({0, 20}, {2000, 2000 * bit}, "beam_mass");
  const beam::Element e{1, 0, 5.0, 5.0};
  const auto a = beam::element_matrices(uniform, e), b = beam::element_matrices(table, e);
  for (int i = 0; i < 16; ++i) EXPECT_NEAR(a.stiffness[i], b.stiffness[i], 1e-13 * 1e10);
  for (int i = 0; i < 16; ++i) EXPECT_NEAR(a.mass[i], b.mass[i], 1e-13 * 1e4);
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(a.axial_mass[i], b.axial_mass[i], 1e-13 * 1e4);
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(a.axial_stiffness[i], b.axial_stiffness[i], 1e-13 * 1e10);
}

// --- mesh

TEST(Mesh, LocateAtNodes) {
  auto m = model_of({0.3, 0.7, 1.1}, 7);
  const beam::Mesh mesh(m);
  EXPECT_EQ(mesh.nodes(), 22);
  EXPECT_EQ(mesh.elements(), 21);
  for (int node = 0; node < mesh.nodes(); ++node) {
    const auto right = mesh.locate(mesh.x(node)), left = mesh.locate(mesh.x(node), true);
    if (node + 1 < mesh.nodes()) {
      EXPECT_EQ(right.element, node);
      EXPECT_EQ(right.xi, 0.0);
    }
    if (node > 0) {
      EXPECT_EQ(left.element, node - 1);
      EXPECT_EQ(left.xi, 1.0);
    }
  }
  EXPECT_EQ(mesh.locate(mesh.end()).element, 20);
  EXPECT_EQ(mesh.locate(mesh.end()).xi, 1.0);
  EXPECT_EQ(mesh.locate(99.0).xi, 1.0);
  EXPECT_EQ(mesh.locate(-99.0).element, 0);
  EXPECT_NEAR(mesh.locate(0.45).xi, 0.5, 1e-12);
}

TEST(Mesh, IsolatedSpansHaveTwoNodesAtInnerEnds) {
  auto m = model_of({10, 20}, 4);
  m.joints = {beam::Joint::separate};
  const beam::Mesh mesh(m);
  EXPECT_EQ(mesh.nodes(), 10);
  EXPECT_EQ(mesh.nodes_at(0), (std::pair{0, 0}));
  EXPECT_EQ(mesh.nodes_at(1), (std::pair{4, 5}));
  EXPECT_EQ(mesh.nodes_at(2), (std::pair{9, 9}));
  EXPECT_EQ(mesh.element(mesh.locate(10.0).element).left, 5);
  EXPECT_EQ(mesh.element(mesh.locate(10.0, true).element).left, 3);
  EXPECT_EQ(mesh.element(4).span, 1);
}

// --- checks

TEST(Checks, MessagesNameTheOption) {
  const double nan = std::nan(""), inf = std::numeric_limits<double>::infinity();
  const auto complains = [](const std::string& option, auto change) {
    auto m = model_of({10, 20}, 4);
    change(m);
    try {
      const Beam beam(PETSC_COMM_SELF, m);
      ADD_FAILURE() << option << " was not refused";
    } catch (const InputError& e) {
      EXPECT_EQ(std::string(e.what()).rfind(option, 0), 0u) << e.what();
    }
  };
  complains("beam_spans", [](auto& m) { m.spans[1] = 0.0; });
  complains("beam_spans", [&](auto& m) { m.spans[1] = inf; });
  complains("beam_spans", [](auto& m) { m.spans.clear(); });
  complains("beam_elements_per_span", [](auto& m) { m.elements[0] = 0; });
  complains("beam_elements_per_span", [](auto& m) { m.elements.pop_back(); });
  complains("beam_elements_per_span", [](auto& m) { m.elements[0] = 2000000000; });
  complains("support_types", [](auto& m) { m.supports.pop_back(); });
  complains("beam_EI", [](auto& m) { m.EI = 0.0; });
  complains("beam_EI", [&](auto& m) { m.EI = nan; });
  complains("beam_EI", [](auto& m) { m.EI = Distribution({0, 30}, {1e9, -1.0}, "beam_EI"); });
  complains("beam_EA", [](auto& m) { m.EA = -1.0; });
  complains("beam_mass", [&](auto& m) { m.mass = inf; });
  complains("foundation_vertical_x", [](auto& m) { m.foundation.vertical = {{30.1, 1.0, 0.0}}; });
  complains("foundation_vertical_k", [](auto& m) { m.foundation.vertical = {{3.0, -1.0, 0.0}}; });
  complains("foundation_vertical_c", [&](auto& m) { m.foundation.vertical = {{3.0, 1.0, nan}}; });
  complains("foundation_longitudinal_x", [](auto& m) { m.foundation.longitudinal = {{-0.1, 1.0, 0.0}}; });
  complains("foundation_rotational_k", [](auto& m) { m.foundation.rotational = {{3.0, -1.0, 0.0}}; });
  complains("foundation_vertical_bed_k", [](auto& m) { m.foundation.vertical_bed = beam::Bed{-1.0, 0.0}; });
  complains("foundation_longitudinal_bed_c", [](auto& m) { m.foundation.longitudinal_bed = beam::Bed{1.0, -1.0}; });

  complains("foundation_vertical_gap", [](auto& m) { m.foundation.vertical = {{3.0, 1.0, 0.0, false, {true, -1.0}}}; });
  complains("foundation_rotational_cubic", [](auto& m) {
    m.foundation.rotational = {{3.0, 1.0, 0.0, false, {false, 0.0, -1.0}}};
  });
  complains("foundation_vertical_bed_cubic", [&](auto& m) {
    m.foundation.vertical_bed = beam::Bed{1.0, 1.0, {false, 0.0, nan}};
  });

  auto no_axial = model_of({10}, 2, false);
  no_axial.EA = 0.0;
  EXPECT_NO_THROW(Beam(PETSC_COMM_SELF, no_axial));
}

TEST(Checks, FloatingMotions) {
  auto m = model_of({10, 20}, 4);
  const auto motion = [&](std::vector<Support> supports, beam::Foundation foundation = {}) {
    auto other = m;
    other.supports = std::move(supports);
    other.foundation = std::move(foundation);
    return beam::floating_motion(other);
  };
  const auto free = Support::free, roller = Support::roller, pinned = Support::pinned, guided = Support::guided;
  EXPECT_EQ(motion({pinned, roller, roller}), "");
  EXPECT_EQ(motion({Support::clamped, free, free}), "");
  EXPECT_EQ(motion({roller, roller, roller}), "the beam can move along x");
  EXPECT_EQ(motion({free, free, free}), "the beam can move vertically and rotate");
  EXPECT_EQ(motion({free, pinned, free}), "the beam can rotate about x = 10 m");
  EXPECT_EQ(motion({guided, free, free}), "the beam can move vertically");
  EXPECT_EQ(motion({guided, free, roller}), "");
  beam::Foundation springs;
  springs.vertical = {{4.0, 1e6, 0.0}, {4.0, 1e6, 0.0}, {9.0, 0.0, 1e3}};
  EXPECT_EQ(motion({free, free, free}, springs), "the beam can rotate about x = 4 m");
  springs.rotational = {{0.0, 1e6, 0.0}};
  springs.longitudinal = {{0.0, 1e6, 0.0}};
  EXPECT_EQ(motion({free, free, free}, springs), "");
  beam::Foundation bed;
  bed.vertical_bed = beam::Bed{1e6, 0.0};
  EXPECT_EQ(motion({free, free, free}, bed), "the beam can move along x");
  bed.longitudinal_bed = beam::Bed{Distribution({0, 25, 25, 30}, {0, 0, 1, 1}, "k"), 0.0};
  EXPECT_EQ(motion({free, free, free}, bed), "");

  // What is one-sided or has a gap may hold; the matrices do not know of it.
  springs.vertical = {{4.0, 1e6, 0.0, false, {true}}, {9.0, 0.0, 0.0, false, {false, 0.01, 1e9}}};
  EXPECT_EQ(motion({pinned, free, free}, springs), "");
  auto known = m;
  known.supports = {pinned, free, free};
  known.foundation.vertical = springs.vertical;
  EXPECT_EQ(beam::rigid_motions(known).size(), 1u);
  springs.vertical = {{4.0, 0.0, 1e3, false, {true, 0.01}}};
  springs.rotational.clear();
  EXPECT_EQ(motion({pinned, free, free}, springs), "the beam can rotate about x = 0 m");

  m.joints = {beam::Joint::separate};
  EXPECT_EQ(motion({pinned, roller, roller}), "");
  EXPECT_EQ(motion({roller, roller, free}), "span 2 can rotate about x = 10 m");
  EXPECT_EQ(motion({free, free, guided}), "span 1 can move vertically and rotate");
  m.axial = false;
  EXPECT_EQ(motion({roller, roller, roller}), "");
}

TEST(Mesh, HingesDivideSpansAndBendTheSurface) {
  auto m = model_of({10, 20}, 4);
  m.hinges = {15.0};
  const beam::Mesh mesh(m);
  EXPECT_EQ(mesh.elements(), 4 + 1 + 3);  // a quarter and three quarters of the second span
  EXPECT_TRUE(mesh.hinged(5));
  EXPECT_FALSE(mesh.hinged(4));
  EXPECT_EQ(mesh.kinks(), (std::vector<double>{0.0, 15.0, 30.0}));
  EXPECT_EQ(mesh.smooth_reach(2), (std::pair{0.0, 15.0}));
  EXPECT_EQ(mesh.smooth_reach(5), (std::pair{15.0, 30.0}));
  EXPECT_EQ(mesh.locate(15.0).element, 5);
  EXPECT_EQ(mesh.locate(15.0, true).element, 4);
}

TEST(Mesh, NodesComeToStepsOfTheSection) {
  auto m = model_of({10.0}, 4);
  const auto nodes = [&] {
    const beam::Mesh mesh(m);
    std::vector<double> x;
    for (int i = 0; i < mesh.nodes(); ++i) x.push_back(mesh.x(i));
    return x;
  };
  const std::vector<double> equal = {0.0, 2.5, 5.0, 7.5, 10.0};
  m.EI = {{0.0, 4.0, 4.0, 10.0}, {1.0, 1.0, 2.0, 2.0}, "EI"};
  EXPECT_EQ(nodes(), (std::vector<double>{0.0, 2.0, 4.0, 7.0, 10.0}));
  m.mass = {{0.0, 7.0, 7.0, 10.0}, {1.0, 1.0, 2.0, 2.0}, "mass"};
  EXPECT_EQ(nodes(), (std::vector<double>{0.0, 2.0, 4.0, 7.0, 10.0})) << "two elements, one and one";
  m.mass = {{0.0, 4.1, 4.1, 10.0}, {1.0, 1.0, 2.0, 2.0}, "mass"};
  EXPECT_EQ(nodes(), (std::vector<double>{0.0, 2.0, 4.0, 7.0, 10.0})) << "too close to the other one";
  m.EI = {{0.0, 2.0, 2.0, 6.0, 6.0, 8.0, 8.0, 10.0}, {1.0, 1.0, 2.0, 2.0, 3.0, 3.0, 2.0, 2.0}, "EI"};
  m.mass = 1.0;
  EXPECT_EQ(nodes(), equal) << "more than every second node";
  m.EI = {{0.0, 5.0, 10.0}, {1.0, 2.0, 1.0}, "EI"};
  EXPECT_EQ(nodes(), equal) << "a kink is no step";
}

/// The promise of the numbering (doc/decisions/004): a sleeper stands on an element of the bridge beside its own
/// column.
TEST(Mesh, SleepersStandBesideTheirOwnColumn) {
  for (const double offset : {0.0, 0.1, 0.37, 0.5999}) {
    for (const bool separate : {false, true}) {
      auto m = model_of({7.3, 12.0, 3.1, 25.25}, 1);
      if (separate) m.joints = {beam::Joint::separate};
      m.hinges = {9.9};
      m.track.emplace();
      m.track->rail_EI = m.track->rail_EA = m.track->rail_mass = 1e6;
      m.track->pad.k = m.track->longitudinal.k = 1e8;
      m.track->offset = offset;
      m.track->approach = 5.0;
      const beam::Beam b(PETSC_COMM_SELF, m);
      const beam::RailMesh rail = beam::rail_mesh(m);
      EXPECT_LE(rail.start, -5.0);
      EXPECT_GE(rail.x(rail.elements), m.length() + 5.0);
      for (int node = 0; node <= rail.elements; node += m.track->elements_per_bay) {
        const double x = rail.x(node);
        if (x < 0.0 || x > m.length()) continue;
        // At the end of two separate spans it stands on the right-hand one, whatever the rounding of x.
        const int element = b.mesh().locate(x + 1e-9 * rail.element).element;
        const int left = b.bridge().first_column + b.mesh().element(element).left;
        EXPECT_GE(left, node - 1) << x;
        EXPECT_LE(left, node) << x;
      }
    }
  }
}

}  // namespace
}  // namespace traverse
