// Moment, shear and deflection of moving beams at any station.
#include "recovery/recovery.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <optional>
#include <random>

#include "support/statics.hpp"

namespace traverse {
namespace {

using beam::Beam;
using beam::BeamModel;
using beam::Support;
using std::numbers::pi;

constexpr double EI = 2e9, mass = 2000.0, L = 20.0;

BeamModel span(int elements, bool axial = false) {
  BeamModel m;
  m.spans = {L};
  m.elements = {elements};
  m.supports = {Support::pinned, Support::roller};
  m.EI = EI;
  m.EA = 1e10;
  m.mass = mass;
  m.axial = axial;
  return m;
}

/// Largest errors of moment and shear over many stations, relative to their largest values, when the nodes move
/// exactly as the simple span's mode: v = sin(n pi x/L) q, with q = 1, q' = rate, q'' from the mode's equation.
std::pair<double, double> errors_of_mode(int elements, int n, beam::Rayleigh ab, double rate) {
  Beam b(PETSC_COMM_SELF, span(elements));
  b.set_rayleigh(ab);
  const double k = n * pi / L, omega2 = std::pow(k, 4) * EI / mass;
  const double acceleration = -(ab.a + ab.b * omega2) * rate - omega2;
  std::vector<double> v, w, a, stations;
  for (int node = 0; node < b.mesh().nodes(); ++node) {
    const double x = b.mesh().x(node);
    for (double s : {std::sin(k * x), k * std::cos(k * x)}) {
      v.push_back(s);
      w.push_back(rate * s);
      a.push_back(acceleration * s);
    }
  }
  for (int i = 0; i <= 200; ++i) stations.push_back(L * i / 200);
  std::vector<recovery::Response> out;
  recovery::Recovery(b, stations, 0.0).evaluate(v.data(), w.data(), a.data(), {}, out);
  double moment = 0.0, shear = 0.0;
  for (std::size_t i = 0; i < stations.size(); ++i) {
    moment = std::max(moment, std::abs(out[i].moment + EI * k * k * std::sin(k * stations[i])) / (EI * k * k));
    shear = std::max(shear, std::abs(out[i].shear + EI * k * k * k * std::cos(k * stations[i])) / (EI * k * k * k));
  }
  return {moment, shear};
}

// With exact nodal motion the inertia inside an element is off by h^4, its moment by h^6 and its shear by h^5. (Nodal
// motion computed on the mesh is off by h^4 itself.) The second derivative of the shape functions would be off by h^2.
TEST(Recovery, MomentAndShearOfAModeConvergeAtEveryStation) {
  for (int n : {1, 2, 3}) {
    const auto [m1, q1] = errors_of_mode(4 * n, n, {}, 0.0);
    const auto [m2, q2] = errors_of_mode(8 * n, n, {}, 0.0);
    EXPECT_NEAR(std::log2(m1 / m2), 6.0, 0.3) << "moment, mode " << n;
    EXPECT_NEAR(std::log2(q1 / q2), 5.0, 0.3) << "shear, mode " << n;
    EXPECT_LT(m1, 1e-3);
    EXPECT_LT(q1, 1e-3);
  }
}

TEST(Recovery, MassProportionalDampingCostsNoAccuracy) {
  const double omega = std::pow(pi / L, 2) * std::sqrt(EI / mass);
  const auto [m1, q1] = errors_of_mode(4, 1, {0.2 * omega, 0.0}, omega);
  const auto [m2, q2] = errors_of_mode(8, 1, {0.2 * omega, 0.0}, omega);
  EXPECT_NEAR(std::log2(m1 / m2), 6.0, 0.3);
  EXPECT_NEAR(std::log2(q1 / q2), 5.0, 0.3);
}

TEST(Recovery, StiffnessProportionalDampingIsNotBending) {
  // 5 % of critical, at full speed: what is left is the damping's own share of the inertia inside an element.
  const double omega = std::pow(pi / L, 2) * std::sqrt(EI / mass);
  const auto [m1, q1] = errors_of_mode(4, 1, {0.0, 0.1 / omega}, omega);
  const auto [m2, q2] = errors_of_mode(8, 1, {0.0, 0.1 / omega}, omega);
  EXPECT_GT(std::log2(m1 / m2), 1.9);
  EXPECT_LT(m2, 0.1 * std::pow(pi / 8, 2) / 8);
}

/// A beam of every kind of foundation, uneven, loaded and moving at random.
struct Wild {
  explicit Wild(int elements) {
    BeamModel m = span(elements, true);
    m.EI = beam::Distribution({0, 7, 7, 20}, {1e9, 3e9, 2e9, 1e9}, "EI");
    m.mass = beam::Distribution({0, 9, 9, 20}, {1000, 2000, 3000, 2500}, "mass");
    m.supports = {Support::clamped, Support::free};
    auto& f = m.foundation;
    f.vertical = {{3.1, 3e8, 1e5}, {10.0, 2e8, 1e5}, {17.7, 4e8, 0.0}};
    f.rotational = {{4.4, 3e9, 1e6}};
    f.longitudinal = {{11.3, 1e8, 1e5}};
    f.vertical_bed = beam::Bed{beam::Distribution({0, 6, 6, 20}, {1e7, 2e7, 0, 1e7}, "k"), 1e4};
    f.longitudinal_bed = beam::Bed{1e6, 1e3};
    b.emplace(PETSC_COMM_SELF, m);
    b->set_rayleigh({0.4, 0.0});
    P.resize(b->local_unknowns());
    b->add_self_weight(9.81, P.data());
    for (double x : {2.2, 8.8, 15.0}) loads.push_back(test::add_load(*b, x, -1e5, 2e5, 3e4, P.data()));
    std::mt19937 random(3);
    std::uniform_real_distribution<double> between(-1.0, 1.0);
    for (std::size_t i = 0; i < P.size(); ++i) {
      v.push_back(b->fixed()[i] ? 0.0 : 1e-3 * between(random));
      w.push_back(b->fixed()[i] ? 0.0 : 0.1 * between(random));
    }
    a = test::solve_free(*b, b->mass(), residual());
  }
  /// P - C* w - K* v.
  std::vector<double> residual() const {
    std::vector<double> r = P;
    const auto subtract = [&](Mat A, const std::vector<double>& y) {
      for (PetscInt i = 0; i < b->local_unknowns(); ++i) {
        PetscInt count = 0;
        const PetscInt* columns = nullptr;
        const PetscScalar* values = nullptr;
        base::check(MatGetRow(A, i, &count, &columns, &values));
        for (PetscInt j = 0; j < count; ++j) r[i] -= values[j] * y[columns[j]];
        base::check(MatRestoreRow(A, i, &count, &columns, &values));
      }
    };
    subtract(b->damping(), w);
    subtract(b->stiffness(), v);
    return r;
  }

  std::optional<Beam> b;
  std::vector<double> P, v, w, a;
  std::vector<recovery::ElementLoad> loads;
};

// Whatever stands inside the elements, moment, shear and axial force of two neighbours agree at their node when the
// equations of motion hold: every term of the recovery has its counterpart in the matrices.
TEST(Recovery, SectionForcesPassThroughNodes) {
  Wild s(5);
  std::vector<double> stations{0.0};
  for (int node = 1; node < 5; ++node) {
    stations.push_back(s.b->mesh().x(node) - 1e-9);
    stations.push_back(s.b->mesh().x(node));
  }
  stations.push_back(L);
  std::vector<recovery::Response> r;
  recovery::Recovery(*s.b, stations, 9.81).evaluate(s.v.data(), s.w.data(), s.a.data(), s.loads, r);
  for (std::size_t i = 1; i + 1 < r.size(); i += 2) {
    EXPECT_NEAR(r[i].moment, r[i + 1].moment, 0.1) << "of some 1e6";
    EXPECT_NEAR(r[i].axial_force, r[i + 1].axial_force, 0.1);
    EXPECT_NEAR(r[i].deflection, r[i + 1].deflection, 1e-9);
    EXPECT_NEAR(r[i].acceleration, r[i + 1].acceleration, 1e-3);
    EXPECT_NEAR(r[i].shear, r[i + 1].shear, 0.1);
  }
  EXPECT_NEAR(r.back().moment, 0.0, 1e-2);
  EXPECT_NEAR(r.back().shear, 0.0, 1e-2);
  EXPECT_NEAR(r.back().axial_force, 0.0, 1e-2);
  std::vector<beam::Reaction> R;
  s.b->reactions(s.v.data(), s.w.data(), s.a.data(), s.P.data(), R);
  EXPECT_NEAR(R[0][0], -r[0].axial_force, 1e-2);
  EXPECT_NEAR(R[0][1], r[0].shear, 1e-2);
  EXPECT_NEAR(R[0][2], -r[0].moment, 1e-2);
}

TEST(Recovery, StationsOutsideTheBeamAreRefused) {
  const Beam b(PETSC_COMM_SELF, span(4));
  EXPECT_THROW(recovery::Recovery(b, {20.1}, 0.0), InputError);
  EXPECT_THROW(recovery::Recovery(b, {5.0, -0.1}, 0.0), InputError);
  EXPECT_THROW(recovery::Recovery(b, {std::nan("")}, 0.0), InputError);
}

// Statically determinate: the moment follows from statics alone, whatever EI does inside the one element.
TEST(Recovery, MomentOfAnUnevenBeam) {
  auto m = span(1);
  m.EI = beam::Distribution({0, 7, 7, 20}, {1e9, 3e9, 2e9, 1e9}, "EI");
  Beam b(PETSC_COMM_SELF, m);
  b.set_rayleigh({});
  std::vector<double> P(b.local_unknowns(), 0.0);
  const std::vector<recovery::ElementLoad> loads{test::add_load(b, 13.0, -1e5, 0.0, 0.0, P.data())};
  const auto v = test::static_solution(b, P);
  const std::vector<double> zero(v.size(), 0.0);
  std::vector<recovery::Response> r;
  recovery::Recovery(b, {5.0, 13.0, 18.0}, 0.0).evaluate(v.data(), zero.data(), zero.data(), loads, r);
  EXPECT_NEAR(r[0].moment, 1e5 * 7 / 20 * 5, 1e-2);
  EXPECT_NEAR(r[1].moment, 1e5 * 7 / 20 * 13, 1e-2);
  EXPECT_NEAR(r[2].moment, 1e5 * 13 / 20 * 2, 1e-2);
}

}  // namespace
}  // namespace traverse
