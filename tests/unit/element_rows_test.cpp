// Products of many elements at a time, and parts of a matrix that do not touch, against the matrices themselves.
#include "beam/element_rows.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "response/beam_operator.hpp"

namespace traverse {
namespace {

std::vector<double> numbers(int count, unsigned seed) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  std::vector<double> x(static_cast<std::size_t>(count));
  for (double& value : x) value = uniform(generator);
  return x;
}

beam::BeamModel spans(std::vector<double> lengths, int elements, bool separate) {
  beam::BeamModel model;
  model.spans = lengths;
  model.elements.assign(lengths.size(), elements);
  model.EI = 3e9;
  model.mass = 2000.0;
  model.axial = false;
  model.supports.assign(lengths.size() + 1, beam::Support::roller);
  model.joints.assign(lengths.size() - 1, separate ? beam::Joint::separate : beam::Joint::continuous);
  return model;
}

// Rows in tiles of every size against the operator's products.
void expect_same_products(const beam::BeamModel& model) {
  beam::Beam beam(PETSC_COMM_SELF, model);
  beam.set_rayleigh({0.3, 2e-3});
  ASSERT_TRUE(beam::ElementRows::fit(beam));
  const beam::ElementRows rows(beam);
  const structure::BeamOperator op(beam);
  const int nodes = beam.local_columns(), n = op.unknowns();
  std::vector<double> x = numbers(n, 1), y = numbers(n, 2), expected(x.size()), inertia(x.size());
  for (int i = 0; i < n; ++i)
    if (beam.fixed()[i] != 0) x[i] = y[i] = 0.0;
  op.multiply(1.0, nullptr, nullptr, x.data(), expected.data());
  op.multiply(1.0, y.data(), nullptr, nullptr, inertia.data());
  double largest = 0.0;
  for (int i = 0; i < n; ++i) largest = std::max(largest, std::abs(expected[i] += inertia[i]));
  for (int size : {1, 7, 64, beam::ElementRows::tile}) {
    for (int first = 0; first < nodes; first += size) {
      const int past = std::min(nodes, first + size), count = past - first;
      std::array<std::vector<double>, 6> apart;
      for (auto& part : apart) part.assign(static_cast<std::size_t>(count) + 2, 0.5);
      for (int node = std::max(first - 1, 0); node < std::min(past + 1, nodes); ++node)
        for (int which = 0; which < 2; ++which) {
          apart[which][node - first + 1] = x[2 * node + which];
          apart[2 + which][node - first + 1] = y[2 * node + which];
        }
      rows.multiply(first, past, {apart[0].data(), apart[1].data()}, {apart[2].data(), apart[3].data()},
                    {apart[4].data(), apart[5].data()});
      for (int node = first; node < past; ++node)
        for (int which = 0; which < 2; ++which)
          if (beam.fixed()[2 * node + which] == 0) {
            ASSERT_NEAR(apart[4 + which][node - first], expected[2 * node + which], 1e-12 * largest)
                << "node " << node << " in tiles of " << size;
          }
    }
  }
}

TEST(ElementRows, ContinuousUniform) { expect_same_products(spans({20, 20, 20}, 50, false)); }
TEST(ElementRows, SeparateSpans) { expect_same_products(spans({20, 20, 20, 20}, 9, true)); }
TEST(ElementRows, SpansOfDifferentLengths) { expect_same_products(spans({20, 31, 20, 17}, 60, false)); }

// Parts of a kind share a factor: solutions with and without, and a run of spans alone.
TEST(SeparateParts, SolveAsTheWhole) {
  beam::BeamModel model = spans({20, 20, 31, 20, 20, 20, 20, 20, 20, 20, 20, 20, 31, 31}, 5, true);
  beam::Beam beam(PETSC_COMM_SELF, model);
  beam.set_rayleigh({0.3, 2e-3});
  structure::BeamOperator op(beam);
  ASSERT_NE(op.parts(), nullptr);
  EXPECT_EQ(op.parts()->parts.size(), 14u);
  EXPECT_EQ(op.parts()->of_kind.size(), 2u);
  solve::BlockTridiagonal A = solve::BlockTridiagonal::from(beam.mass(), 2);
  A.combine(4e4, A, 200.0, solve::BlockTridiagonal::from(beam.damping(), 2), 1.0,
            solve::BlockTridiagonal::from(beam.stiffness(), 2));
  solve::SubstructuredCholesky whole(PETSC_COMM_SELF, 2, beam.local_columns());
  whole.factor(A, beam.fixed());
  const std::vector<double> b = numbers(op.unknowns(), 3);
  std::vector<double> x = b, expected = b;
  whole.solve(expected.data());
  const structure::BeamFactor& factor = op.factored(200.0, 4e4);
  factor.solve(x.data());
  double largest = 0.0;
  for (double value : expected) largest = std::max(largest, std::abs(value));
  for (std::size_t i = 0; i < x.size(); ++i) ASSERT_NEAR(x[i], expected[i], 1e-12 * largest);

  struct Copy final : solve::NodeFiller {
    const std::vector<double>* from = nullptr;
    double* to = nullptr;
    void fill(std::ptrdiff_t first, std::ptrdiff_t past) override {
      std::copy(from->begin() + 2 * first, from->begin() + 2 * past, to + 2 * first);
    }
  } copy;
  std::vector<double> window(x.size(), 7.0);
  copy.from = &b;
  copy.to = window.data();
  const auto &first = op.parts()->parts[2], &last = op.parts()->parts[11];
  factor.solve_window(window.data(), first.first, last.past, copy);
  for (std::ptrdiff_t i = 0; i < std::ssize(x); ++i) {
    const bool inside = i >= 2 * first.first && i < 2 * last.past;
    ASSERT_NEAR(window[i], inside ? expected[i] : 7.0, 1e-12 * largest);
  }
}

}  // namespace
}  // namespace traverse
