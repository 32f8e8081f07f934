// Products of many elements at a time, and parts of a matrix that do not touch, against the matrices themselves.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "beam/internal_forces.hpp"
#include "structure/beam_operator.hpp"
#include "structure/block_rows.hpp"

namespace traverse {
namespace {

std::vector<double> numbers(int count, unsigned seed) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  std::vector<double> x(static_cast<std::size_t>(count));
  for (double& value : x) value = uniform(generator);
  return x;
}

beam::BeamModel spans(const std::vector<double>& lengths, int elements, bool separate) {
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

// r += factor A x.
void add_product(const solve::BlockTridiagonal& A, double factor, const std::vector<double>& x,
                 std::vector<double>& r) {
  const int b = A.block;
  for (int i = 0; i < A.nodes; ++i)
    for (int row = 0; row < b; ++row)
      for (int column = 0; column < b; ++column) {
        const int place = i * b * b + row + column * b, next = (i + 1) * b;
        r[i * b + row] += factor * A.diagonal[place] * x[i * b + column];
        if (i + 1 == A.nodes) continue;
        r[i * b + row] += factor * A.upper[place] * x[next + column];
        r[next + column] += factor * A.upper[place] * x[i * b + row];
      }
}

// The operator's products C* y + K* x and M y against the matrices' blocks and the assembled stiffness.
void expect_products_of_blocks(const structure::BeamOperator& op, const beam::Beam& beam, const std::vector<double>& x,
                               const std::vector<double>& y, const std::vector<double>& forces,
                               const std::vector<double>& inertia) {
  const int b = op.block();
  std::vector<double> by_blocks(x.size()), mass(x.size()), largest(static_cast<std::size_t>(b)), heaviest(largest);
  add_product(op.mass().rows, 1.0, y, mass);
  add_product(solve::BlockTridiagonal::from(beam.stiffness(), b), 1.0, x, by_blocks);
  add_product(solve::BlockTridiagonal::from(beam.damping(), b), 1.0, y, by_blocks);
  for (int i = 0; i < op.unknowns(); ++i) {
    largest[i % b] = std::max(largest[i % b], std::abs(by_blocks[i]));
    heaviest[i % b] = std::max(heaviest[i % b], std::abs(mass[i]));
  }
  for (int i = 0; i < op.unknowns(); ++i) {
    if (beam.fixed()[i] != 0) continue;
    ASSERT_NEAR(forces[i], by_blocks[i], 1e-11 * largest[i % b]) << "unknown " << i;
    ASSERT_NEAR(inertia[i], mass[i], 1e-14 * heaviest[i % b]) << "unknown " << i;
  }
}

// K* x + C* y + M y in tiles of every size against the operator's products.
void expect_same_products(const beam::BeamModel& model) {
  beam::Beam beam(PETSC_COMM_SELF, model);
  beam.set_rayleigh({0.3, 2e-3});
  ASSERT_TRUE(beam::ElementRows::fit(beam));
  const structure::BeamOperator op(beam);
  const beam::ElementRows elements(beam);
  const structure::BlockRows& mass = op.mass().products;
  std::vector<const structure::BlockRows*> others;
  for (const auto* m : {op.springs(), op.drag()})
    if (m != nullptr) others.push_back(&m->products);
  const bool springs = op.springs() != nullptr;
  const int nodes = beam.local_columns(), n = op.unknowns(), b = op.block();
  std::vector<double> x = numbers(n, 1), y = numbers(n, 2), expected(x.size()), inertia(x.size());
  for (int i = 0; i < n; ++i)
    if (beam.fixed()[i] != 0) x[i] = y[i] = 0.0;
  op.multiply(1.0, nullptr, y.data(), x.data(), expected.data());
  op.multiply(1.0, y.data(), nullptr, nullptr, inertia.data());
  expect_products_of_blocks(op, beam, x, y, expected, inertia);
  std::vector<double> largest(static_cast<std::size_t>(b), 0.0);
  for (int i = 0; i < n; ++i) largest[i % b] = std::max(largest[i % b], std::abs(expected[i] += inertia[i]));
  using Tile = std::array<std::vector<double>, beam::kinds>;
  const auto planes = [](Tile& of) {
    beam::Planes result;
    for (std::size_t c = 0; c < of.size(); ++c) result[c] = of[c].data();
    return result;
  };
  for (int size : {1, 7, 64, beam::tile}) {
    for (int first = 0; first < nodes; first += size) {
      const int past = std::min(nodes, first + size);
      Tile damped, plain, rates, heavy, forces;  // x + b y, x, y, y with what M takes of it for damping
      for (int c = 0; c < b; ++c) {
        for (Tile* of : {&damped, &plain, &rates, &heavy})
          (*of)[c].assign(static_cast<std::size_t>(past - first) + 2 + beam::nodes_per_chunk, 0.5);
        forces[c].assign(static_cast<std::size_t>(past - first), 0.0);
        for (int node = std::max(first - 1, 0); node < std::min(past + 1, nodes); ++node) {
          const int i = node - first + 1, k = b * node + c;
          plain[c][i] = x[k];
          rates[c][i] = y[k];
          heavy[c][i] = (1.0 + op.mass_damping().value_or(0.0)) * y[k];
          damped[c][i] = x[k] + op.stiffness_damping()[c] * y[k];
        }
      }
      elements.add(first, past, planes(damped), planes(forces));
      mass.add(first, past, planes(heavy), planes(forces));
      for (std::size_t i = 0; i < others.size(); ++i)
        others[i]->add(first, past, planes(springs && i == 0 ? plain : rates), planes(forces));
      for (int k = b * first; k < b * past; ++k)
        if (beam.fixed()[k] == 0) {
          ASSERT_NEAR(forces[k % b][k / b - first], expected[k], 1e-12 * largest[k % b])
              << "column " << k / b << ", unknown " << k % b << " in tiles of " << size;
        }
    }
  }
}

beam::BeamModel on_track(beam::BeamModel model) {
  model.track.emplace();
  model.track->rail_EI = 1.2e7;
  model.track->rail_mass = 120.0;
  model.track->ballast = beam::Layer{3e7, 4e4};
  model.track->subballast = beam::Layer{1e8, 3e4};
  model.track->pad = {6e7, 2e4};
  model.track->sleeper_mass = 300.0;
  model.track->ballast_mass = 500.0;
  return model;
}

TEST(ElementRows, ContinuousUniform) { expect_same_products(spans({20, 20, 20}, 50, false)); }
TEST(ElementRows, SeparateSpans) { expect_same_products(spans({20, 20, 20, 20}, 9, true)); }
TEST(ElementRows, SpansOfDifferentLengths) { expect_same_products(spans({20, 31, 20, 17}, 60, false)); }

TEST(ElementRows, ManyEqualSpans) { expect_same_products(spans(std::vector<double>(60, 20.0), 10, false)); }
TEST(ElementRows, AlongTheBeamToo) {
  beam::BeamModel model = spans({20, 31, 20}, 60, false);
  model.axial = true;
  model.EA = 4e10;
  expect_same_products(model);
}
TEST(ElementRows, OnABedWithSprings) {
  beam::BeamModel model = spans(std::vector<double>(40, 20.0), 10, false);
  model.foundation.vertical_bed = beam::Bed{2e6, 3e4};
  expect_same_products(model);
}
TEST(ElementRows, UnderALayeredTrack) { expect_same_products(on_track(spans({18, 24, 18}, 10, false))); }

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

  struct Copy final : solve::RhsCallback {
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
