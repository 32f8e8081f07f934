// Assembled matrices of beams and foundations against shape functions and rigid-body mass, and reactions against rows
// of the unconstrained matrices (equation 18 of the paper as corrected in doc/theory.md).
#include "beam/beam.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "beam/shape.hpp"
#include "support/beam_model.hpp"
#include "support/rows.hpp"

namespace traverse {
namespace {

using beam::Beam;
using beam::Distribution;
using beam::Support;
using test::model_of;

// --- assembly

double form(const std::vector<std::vector<double>>& A, const std::vector<double>& x, const std::vector<double>& y) {
  double sum = 0.0;
  for (std::size_t i = 0; i < A.size(); ++i) {
    for (std::size_t j = 0; j < A.size(); ++j) sum += x[i] * A[i][j] * y[j];
  }
  return sum;
}

TEST(Assembly, MassOfRigidMotion) {
  auto m = model_of({10, 20}, 5);
  m.supports.assign(3, Support::free);
  m.mass = Distribution({0, 30}, {1000, 3000}, "beam_mass");
  const Beam b(PETSC_COMM_SELF, m);
  const auto M = test::local_rows(b.mass()), K = test::local_rows(b.beam_stiffness());
  std::vector<double> up(M.size(), 0.0), along = up, turn = up;
  for (int n = 0; n < b.mesh().nodes(); ++n) {
    along[3 * n] = up[3 * n + 1] = turn[3 * n + 2] = 1.0;
    turn[3 * n + 1] = b.mesh().x(n);
  }
  EXPECT_NEAR(form(M, up, up), 60000.0, 1e-7);
  EXPECT_NEAR(form(M, along, along), 60000.0, 1e-7);
  EXPECT_NEAR(form(M, up, turn), 1000 * 450.0 + 2000.0 / 30 * 9000, 1e-5);  // integral of m x
  EXPECT_NEAR(form(K, turn, turn), 0.0, 1e-3);
  std::vector<double> P(M.size(), 0.0);
  b.add_self_weight(9.81, P.data());
  double weight = 0.0, moment = 0.0;
  for (std::size_t i = 0; i < P.size(); ++i) {
    weight += up[i] * P[i];
    moment += turn[i] * P[i];
  }
  EXPECT_NEAR(weight, -9.81 * 60000.0, 1e-6);
  EXPECT_NEAR(moment, -9.81 * (1000 * 450.0 + 2000.0 / 30 * 9000), 1e-5);
}

TEST(Assembly, HeldUnknownsAreEmpty) {
  auto m = model_of({10, 20}, 3);
  m.foundation.vertical_bed = beam::Bed{1e6, 1e3};
  Beam b(PETSC_COMM_SELF, m);
  b.set_rayleigh({0.1, 0.2});
  for (Mat A : {b.mass(), b.beam_stiffness(), b.stiffness(), b.damping()}) {
    const auto rows = test::local_rows(A);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      for (std::size_t j = 0; j < rows.size(); ++j) {
        EXPECT_EQ(rows[i][j], rows[j][i]);
        if (b.fixed()[i] || b.fixed()[j]) {
          EXPECT_EQ(rows[i][j], 0.0);
        }
      }
      if (b.fixed()[i]) {
        EXPECT_EQ(test::stored(A, static_cast<PetscInt>(i)), 0);
      }
    }
    MatInfo info;
    base::check(MatGetInfo(A, MAT_LOCAL, &info));
    EXPECT_EQ(info.mallocs, 0.0);
    EXPECT_EQ(info.nz_unneeded, 0.0);
  }
  // u and v of node 0, v of nodes 3 and 6.
  const std::vector<int> held{0, 1, 10, 19};
  for (std::size_t i = 0; i < b.fixed().size(); ++i) {
    EXPECT_EQ(b.fixed()[i] != 0, std::find(held.begin(), held.end(), i) != held.end()) << i;
  }
}

TEST(Assembly, PointFoundationsInsideAnElement) {
  auto m = model_of({10}, 2);
  m.supports.assign(2, Support::free);
  m.foundation.vertical = {{6.5, 3e6, 2e3}};
  m.foundation.rotational = {{6.5, 4e6, 0.0}, {5.0, 1e6, 0.0}};
  m.foundation.longitudinal = {{6.5, 0.0, 7e3}};
  const Beam b(PETSC_COMM_SELF, m);
  const auto& f = b.foundation();
  EXPECT_EQ(f.of("longitudinal")[0], nullptr);
  EXPECT_EQ(f.of("rotational")[1], nullptr);
  EXPECT_EQ(f.of("vertical_bed")[0], nullptr);
  const auto s = beam::hermite(0.3, 5.0);
  const auto k = test::local_rows(f.of("vertical")[0]), c = test::local_rows(f.of("vertical")[1]);
  const auto r = test::local_rows(f.of("rotational")[0]), u = test::local_rows(f.of("longitudinal")[1]);
  const int unknown[] = {4, 5, 7, 8};
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      const double node = unknown[i] == 5 && unknown[j] == 5 ? 1e6 : 0.0;
      EXPECT_NEAR(k[unknown[i]][unknown[j]], 3e6 * s.value[i] * s.value[j], 1e-8);
      EXPECT_NEAR(c[unknown[i]][unknown[j]], 2e3 * s.value[i] * s.value[j], 1e-11);
      EXPECT_NEAR(r[unknown[i]][unknown[j]], 4e6 * s.slope[i] * s.slope[j] + node, 1e-8);
    }
  }
  EXPECT_NEAR(u[3][6], 7e3 * 0.7 * 0.3, 1e-9);
  EXPECT_EQ(k[0][0], 0.0);
  // With a plus sign in K*.
  const auto K = test::local_rows(b.beam_stiffness()), all = test::local_rows(b.stiffness());
  for (std::size_t i = 0; i < K.size(); ++i) {
    for (std::size_t j = 0; j < K.size(); ++j) EXPECT_NEAR(all[i][j], K[i][j] + k[i][j] + r[i][j], 1e-6);
  }
}

TEST(Assembly, BedsAreMassMatrices) {
  auto m = model_of({10}, 2);
  m.supports.assign(2, Support::free);
  const Distribution table({0, 4, 4, 10}, {1e6, 2e6, 5e5, 1e6}, "k");
  m.foundation.vertical_bed = beam::Bed{table, 0.0};
  m.foundation.longitudinal_bed = beam::Bed{0.0, table};
  m.mass = table;  // the mesh has nodes at its steps
  Beam b(PETSC_COMM_SELF, m);
  const auto M = test::local_rows(b.mass()), k = test::local_rows(b.foundation().of("vertical_bed")[0]),
             c = test::local_rows(b.foundation().of("longitudinal_bed")[1]);
  EXPECT_EQ(b.foundation().of("vertical_bed")[1], nullptr);
  for (std::size_t i = 0; i < M.size(); ++i) {
    for (std::size_t j = 0; j < M.size(); ++j) {
      EXPECT_EQ(k[i][j], i % 3 == 0 || j % 3 == 0 ? 0.0 : M[i][j]);
      EXPECT_EQ(c[i][j], i % 3 == 0 && j % 3 == 0 ? M[i][j] : 0.0);
    }
  }
  // C* = a M + b K_aa + C_LC, without the foundation's stiffness. A second call of set_rayleigh replaces the first.
  b.set_rayleigh({5.0, 5.0});
  b.set_rayleigh({0.3, 0.02});
  const auto C = test::local_rows(b.damping()), K = test::local_rows(b.beam_stiffness());
  for (std::size_t i = 0; i < M.size(); ++i) {
    for (std::size_t j = 0; j < M.size(); ++j) {
      EXPECT_NEAR(C[i][j], 0.3 * M[i][j] + 0.02 * K[i][j] + c[i][j], 1e-6);
    }
  }
}

TEST(Assembly, IsolatedSpansDoNotCouple) {
  auto m = model_of({10, 20, 10}, 2);
  m.joints = {beam::Joint::separate};
  m.foundation.vertical = {{10.0, 1e6, 0.0}, {40.0, 2e6, 0.0}};
  m.supports.assign(4, Support::free);
  const Beam b(PETSC_COMM_SELF, m);
  const auto K = test::local_rows(b.stiffness()), f = test::local_rows(b.foundation().of("vertical")[0]);
  for (int i = 0; i < 9; ++i) {
    for (int j = 9; j < 18; ++j) EXPECT_EQ(K[i][j], 0.0);
  }
  EXPECT_EQ(f[3 * 2 + 1][3 * 2 + 1], 0.0) << "the left span's end";
  EXPECT_EQ(f[3 * 3 + 1][3 * 3 + 1], 1e6) << "the right span's end";
  EXPECT_EQ(f[3 * 8 + 1][3 * 8 + 1], 2e6) << "the end of the beam";
  // Every span has a fixed bearing; one with a longitudinal spring of its own has not.
  for (int span = 0; span < 3; ++span) EXPECT_TRUE(b.fixed()[9 * span]);
  m.foundation.longitudinal = {{10.0, 1e6, 0.0}};
  const Beam spring(PETSC_COMM_SELF, m);
  EXPECT_TRUE(spring.fixed()[0]);
  EXPECT_FALSE(spring.fixed()[9]);
  EXPECT_TRUE(spring.fixed()[18]);
}

// --- reactions

TEST(Reactions, AreTheRowsOfTheFullMatrices) {
  auto m = model_of({10, 20, 15}, 3);
  m.supports = {Support::clamped, Support::roller, Support::guided, Support::pinned};
  m.foundation.vertical = {{1.0, 3e8, 2e5}, {10.0, 1e8, 1e5}, {44.0, 2e8, 1e5}};
  m.foundation.rotational = {{2.0, 4e8, 1e5}};
  m.foundation.longitudinal_bed = beam::Bed{1e7, 1e5};
  auto loose = m;
  loose.supports.assign(4, Support::free);
  Beam b(PETSC_COMM_SELF, m), full(PETSC_COMM_SELF, loose);
  b.set_rayleigh({0.3, 0.02});
  full.set_rayleigh({0.3, 0.02});

  std::mt19937 random(7);
  std::uniform_real_distribution<double> between(-1.0, 1.0);
  const std::size_t n = b.fixed().size();
  std::vector<double> v(n), w(n), a(n), P(n);
  for (std::size_t i = 0; i < n; ++i) {
    P[i] = 1e5 * between(random);
    if (b.fixed()[i]) continue;
    v[i] = 1e-3 * between(random), w[i] = 0.1 * between(random), a[i] = 10 * between(random);
  }
  std::vector<beam::Reaction> R;
  b.reactions(v.data(), w.data(), a.data(), P.data(), R);
  ASSERT_EQ(R.size(), 4u);
  const auto M = test::local_rows(full.mass()), C = test::local_rows(full.damping()),
             K = test::local_rows(full.stiffness());
  for (int end = 0; end < 4; ++end) {
    for (int kind = 0; kind < 3; ++kind) {
      const int row = 3 * b.mesh().nodes_at(end).first + kind;
      double expected = 0.0, size = 0.0;
      for (std::size_t j = 0; j < n && b.fixed()[row]; ++j) {
        const double part = M[row][j] * a[j] + C[row][j] * w[j] + K[row][j] * v[j];
        expected += part;
        size += std::abs(part);
      }
      if (b.fixed()[row]) expected -= P[row];
      EXPECT_NEAR(R[end][kind], expected, 1e-13 * size + 1e-9) << end << ", " << kind;
    }
  }
}

}  // namespace
}  // namespace traverse
