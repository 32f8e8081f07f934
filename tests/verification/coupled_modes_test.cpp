// Modes that dampers, or springs that Rayleigh's b leaves undamped, couple: against matrix exponentials, against the
// full model on the same mesh, and what must not matter.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <complex>
#include <unsupported/Eigen/MatrixFunctions>

#include "integrate/modal_peaks.hpp"
#include "support/curve.hpp"
#include "support/folders.hpp"

namespace traverse::test {
namespace {

/// 25 m with a damper at 10 m.
beam::BeamModel damped_span(double c) {
  beam::BeamModel model;
  model.spans = {25.0};
  model.elements = {10};
  model.EI = 8.323e9;
  model.mass = 2303.0;
  model.supports = {beam::Support::pinned, beam::Support::roller};
  model.axial = false;
  model.foundation.vertical.push_back({.x = 10.0, .c = c});
  return model;
}

/// C of modes, as the bridge has it.
Eigen::MatrixXd damping_of(const structure::ModalBridge& bridge) {
  const auto m = static_cast<Eigen::Index>(bridge.modes());
  Eigen::MatrixXd C = bridge.coupled() ? bridge.cross_damping() : Eigen::MatrixXd::Zero(m, m);
  for (Eigen::Index i = 0; i < m; ++i) C(i, i) = 2.0 * bridge.sigma()[static_cast<std::size_t>(i)];
  return C;
}

// Two modes under a force that stands on the bridge from t = 0: q = q_s - (the free oscillation from q_s), by the
// exponential of the 4 x 4 matrix. From light dampers to one that holds the bridge as a support does.
class TwoCoupledModes : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(Dampers, TwoCoupledModes, testing::Values(1e3, 1e5, 4.0e5, 1e6, 1e9));

TEST_P(TwoCoupledModes, ByTheExponential) {
  beam::Beam beam(PETSC_COMM_SELF, damped_span(GetParam()));
  beam.set_rayleigh({});
  structure::BeamOperator statics(beam);
  const structure::ModalBridge bridge(beam, statics, 2, {});
  ASSERT_TRUE(bridge.coupled());
  const Eigen::Vector2d omega(bridge.omega()[0], bridge.omega()[1]);
  const Eigen::MatrixXd C = damping_of(bridge);
  // phi_i^T C* phi_k of one damper: the product of the shapes there.
  const std::array<double, 2> shape = {bridge.shape(0)[2 * 4], bridge.shape(1)[2 * 4]};
  for (int i = 0; i < 2; ++i)
    for (int k = 0; k < 2; ++k)
      EXPECT_NEAR(C(i, k), GetParam() * shape[i] * shape[k], 1e-9 * std::sqrt(C(i, i) * C(k, k)));

  const train::MovingLoad load{{1e5}, {7.0}, 0.0};
  const integrate::ForceHistory history(bridge.influence(), load);
  integrate::ModalMotion motion(bridge, history, 0.0, false);
  Eigen::Matrix4d A = Eigen::Matrix4d::Zero();
  A.topRightCorner<2, 2>().setIdentity();
  for (int i = 0; i < 2; ++i) A(2 + i, i) = -omega[i] * omega[i];
  A.bottomRightCorner<2, 2>() = -C;
  Eigen::Vector4d rest = Eigen::Vector4d::Zero();
  for (int i = 0; i < 2; ++i) rest[i] = history.interval(0)[i] / (omega[i] * omega[i]);
  for (double t = 0.0; t < 2.0; t += 0.037) {
    motion.advance(t);
    const Eigen::Vector4d exact = rest - (A * t).exp() * rest;
    const Eigen::Vector4d rate = -A * (A * t).exp() * rest;
    for (int i = 0; i < 2; ++i) {
      EXPECT_NEAR(motion.q()[i], exact[i], 1e-9 * rest.norm()) << t;
      EXPECT_NEAR(motion.rate()[i], exact[2 + i], 1e-9 * omega[1] * rest.norm()) << t;
      EXPECT_NEAR(motion.acceleration()[i], rate[2 + i], 1e-7 * omega[1] * omega[1] * rest.norm()) << t;
    }
  }
}

// The damper at which two complex modes become one, which have no basis of their own there.
TEST(CoupledModes, CriticallyDamped) {
  const std::vector<double> omega = {30.0, 120.0};
  const Eigen::Vector2d shape(0.9, 0.6);
  const auto modes_with = [&](double c) {
    Eigen::MatrixXd cross = c * shape * shape.transpose();
    const std::vector<double> sigma = {0.5 * cross(0, 0), 0.5 * cross(1, 1)};
    cross.diagonal().setZero();
    return structure::ComplexModes(omega, sigma, cross);
  };
  const auto overdamped = [&](double c) { return modes_with(c).lambda.size() > 2; };
  double below = 1.0, above = 200.0;
  ASSERT_FALSE(overdamped(below));
  ASSERT_TRUE(overdamped(above));
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (below + above);
    (overdamped(middle) ? above : below) = middle;
  }
  for (const double c : {below, above}) {
    const structure::ComplexModes modes = modes_with(c);
    Eigen::Matrix4d A = Eigen::Matrix4d::Zero();
    for (int i = 0; i < 2; ++i) {
      A(i, 2 + i) = omega[i];
      A(2 + i, i) = -omega[i];
    }
    A.bottomRightCorner<2, 2>() = -c * shape * shape.transpose();
    for (double t = 0.01; t < 0.5; t += 0.01) {
      const Eigen::Index count = modes.lambda.size();
      Eigen::MatrixXd turned = modes.coordinates;
      for (Eigen::Index j = 0; j < count; ++j) {
        const std::complex<double> factor = std::exp(modes.lambda[j] * t);
        turned.row(j) = factor.real() * modes.coordinates.row(j) - factor.imag() * modes.coordinates.row(count + j);
        turned.row(count + j) =
            factor.imag() * modes.coordinates.row(j) + factor.real() * modes.coordinates.row(count + j);
      }
      EXPECT_LT((modes.state * turned - Eigen::MatrixXd((A * t).exp())).norm(), 1e-7) << c << ", " << t;
    }
  }
}

// Under moving forces the equations of motion hold at every instant, and q' is the slope of q.
TEST(CoupledModes, SolveTheirEquations) {
  beam::Beam beam(PETSC_COMM_SELF, damped_span(5e4));
  beam.set_rayleigh({0.3, 1e-4});
  structure::BeamOperator statics(beam);
  const structure::ModalBridge bridge(beam, statics, 6, {});
  ASSERT_TRUE(bridge.coupled());
  const train::MovingLoad load{{1e5, 2e5}, {0.0, -3.0}, 40.0};
  const integrate::ForceHistory history(bridge.influence(), load);
  integrate::ModalMotion motion(bridge, history, 40.0, true), one(bridge, history, 40.0, true);
  motion.prepare(1e-3);
  const Eigen::Map<const Eigen::ArrayXd> omega(bridge.omega().data(), 6);
  const Eigen::MatrixXd C = damping_of(bridge);
  const auto of = [](const std::vector<double>& x) { return Eigen::Map<const Eigen::VectorXd>(x.data(), 6); };
  const double scale = 2e5 * 0.01;
  for (int i = 1; i <= 900; ++i) {
    motion.advance(i * 1e-3);
    Eigen::VectorXd force = Eigen::VectorXd::Zero(6);
    motion.add_channels(0, 6, force.data());
    const Eigen::VectorXd sum =
        of(motion.acceleration()) + C * of(motion.rate()) + (omega.square() * of(motion.q()).array()).matrix();
    EXPECT_LT((sum - force).norm(), 1e-9 * scale) << i;
    if (i % 100 != 0) continue;
    integrate::ModalMotion before(bridge, history, 40.0, true), after(bridge, history, 40.0, true);
    before.advance(i * 1e-3 - 1e-6);
    after.advance(i * 1e-3 + 1e-6);
    const Eigen::VectorXd slope = (of(after.q()) - of(before.q())) / 2e-6;
    EXPECT_LT((slope - of(motion.rate())).norm(), 1e-6 * of(motion.rate()).norm());
  }
  one.advance(0.9);
  EXPECT_LT((of(one.q()) - of(motion.q())).norm(), 1e-10 * of(motion.q()).norm());
}

const char* const bearings = R"(
beam: {spans: [25.0], EI: 3.0e10, mass: 1.2e4, elements_per_span: 10, damping_ratios: 0.02}
support: {types: [free, free]}
foundation: {vertical: {x: [0.0, 25.0], k: [3.0e8, 3.0e8]}}
load: {forces: [2.0e5, 2.0e5, 1.5e5], positions: [2.0, -3.0, -14.0], speed: 70.0}
scene: {tail: 1.0}
output: {probes: [0.0, 7.0, 12.5, 25.0], interval: 5.0e-3}
)";
const char* const damped_bearing = R"(
beam: {spans: [25.0, 20.0], EI: 3.0e10, mass: 1.2e4, elements_per_span: 8, damping_ratios: 0.01}
support: {types: [pinned, free, roller]}
foundation: {vertical: {x: [25.0, 10.0], k: [3.0e8, 0.0], c: [2.0e6, 3.0e5]}}
load: {forces: [2.0e5, 2.0e5, 1.5e5], positions: [2.0, -3.0, -14.0], speed: 70.0}
scene: {tail: 1.0}
output: {probes: [7.0, 10.0, 12.5, 25.0, 37.0], interval: 5.0e-3}
)";

class CoupledModesOf : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Bridges, CoupledModesOf, testing::Values(bearings, damped_bearing),
                         [](const auto& bridge) { return bridge.index == 0 ? "ElasticBearings" : "DampedBearing"; });

TEST_P(CoupledModesOf, AllModesAgainstTheElements) {
  Results full = run_yaml(GetParam(), {{"ts_dt", "1e-4"}});
  Results modal = run_yaml(GetParam(), {{"model_modes", "1000"}});
  for (const auto& [name, bound] : {std::pair("/probes/deflection", 1e-8),
                                    {"/foundation/vertical/force", 1e-8},
                                    {"/energy/strain", 1e-8},
                                    {"/energy/kinetic", 1e-8},
                                    {"/probes/velocity", 1e-6}}) {
    const double difference = relative_difference(modal(name), full(name));
    RecordProperty(name + 1, text(difference));
    EXPECT_LT(difference, bound) << name;
  }
  // With forces that step onto a bearing that yields, elements integrate the loss to 2e-5.
  EXPECT_LT(relative_difference(modal("/energy/dissipated"), full("/energy/dissipated")), 1e-4);
  EXPECT_LT(energy_error(modal), 1e-9);
}

// What forces and dampers do to the modes left out is taken as static: all forces balance.
TEST_P(CoupledModesOf, TheOthersAreStatic) {
  Results full = run_yaml(GetParam(), {{"ts_dt", "2e-4"}});
  Results modal = run_yaml(GetParam(), {{"model_modes", "8"}});
  EXPECT_LT(relative_difference(modal("/probes/deflection"), full("/probes/deflection")), 1e-3);
  EXPECT_LT(relative_difference(modal("/probes/moment"), full("/probes/moment")), 1e-2);
  EXPECT_LT(std::abs(peak(modal("/balance/residual")).first), 1e-9 * 5.5e5);
  EXPECT_LT(energy_error(modal), 1e-10);
}

TEST_P(CoupledModesOf, SamplesChangeNothing) {
  const Values modes = {{"model_modes", "7"}};
  Results fine = run_yaml(GetParam(), modes + Values{{"output_interval", "1e-3"}});
  Results coarse = run_yaml(GetParam(), modes + Values{{"output_interval", "0.1"}});
  const std::size_t width = coarse("/probes/deflection").size() / coarse.time().size();
  for (const char* name : {"/probes/deflection", "/probes/acceleration", "/probes/moment", "/energy/dissipated"}) {
    const std::size_t columns = std::string(name).starts_with("/probes") ? width : 1;
    const double scale = std::abs(peak(fine(name)).first);
    for (std::size_t i = 0; i + 1 < coarse.time().size(); ++i)
      for (std::size_t p = 0; p < columns; ++p)
        EXPECT_NEAR(coarse(name)[i * columns + p], fine(name)[100 * i * columns + p], 1e-10 * scale) << name;
  }
}

// What a sweep looks at, forms of the modes' coordinates and rates, is what a run shows, what dampers deflect the other
// modes by included.
TEST(CoupledModes, FormsOfProbes) {
  beam::BeamModel model = damped_span(5e5);
  beam::Beam beam(PETSC_COMM_SELF, model);
  beam.set_rayleigh({});
  structure::BeamOperator statics(beam);
  structure::ModalBridge bridge(beam, statics, 3, {});
  const std::vector<double> stations = {5.0, 10.0, 12.5};
  bridge.add_probes(stations, 0.0);
  const train::MovingLoad load{{1e5}, {0.0}, 40.0};
  const integrate::ForceHistory history(bridge.influence(), load);
  integrate::ModalMotion motion(bridge, history, 40.0, true);
  Results run = run_yaml(R"(
beam: {spans: 25.0, EI: 8.323e9, mass: 2303.0, elements_per_span: 10}
support: {types: [pinned, roller]}
foundation: {vertical: {x: 10.0, c: 5.0e5}}
load: {forces: 1.0e5, positions: 0.0, speed: 40.0}
model: {modes: 3}
output: {probes: [5.0, 10.0, 12.5], interval: 0.01}
scene: {tail: 0.3}
)");
  const structure::ModalProbes& forms = bridge.probes();
  const std::vector<double>&deflections = run("/probes/deflection"), &moments = run("/probes/moment");
  const double deepest = std::abs(peak(deflections).first), largest = std::abs(peak(moments).first);
  double others = 0.0;
  for (std::size_t k = 0; k < run.time().size(); ++k) {
    motion.advance(run.time()[k]);
    std::vector<double> deflection(3, 0.0), moment(3, 0.0);
    motion.add_channels(3, 3, deflection.data());
    motion.add_channels(6, 3, moment.data());
    for (std::size_t p = 0; p < 3; ++p) {
      for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t at = 3 * i + p;
        const double q = motion.q()[i], rate = motion.rate()[i], acceleration = motion.acceleration()[i];
        deflection[p] += forms.deflection[at] * q + forms.deflection_by_rate[at] * rate;
        moment[p] +=
            forms.moment[at] * q + forms.moment_by_rate[at] * rate + forms.moment_by_acceleration[at] * acceleration;
        others = std::max(others, std::abs(forms.deflection_by_rate[at] * rate));
      }
      EXPECT_NEAR(deflection[p], deflections[3 * k + p], 1e-9 * deepest);
      EXPECT_NEAR(moment[p], moments[3 * k + p], 1e-8 * largest);
    }
  }
  EXPECT_GT(others, 1e-4 * deepest) << "too small to be seen";
}

const std::string coaches =
    "beam: {spans: [32, 40, 32], EI: 3.795e11, mass: 3e4, elements_per_span: 8, damping_ratios: 0.02}\n"
    "support: {types: [pinned, roller, roller, roller]}\n"
    "foundation: {vertical: {x: [16.0, 52.0], k: [0.0, 1.0e8], c: [3.0e6, 2.0e6]}}\n"
    "train: {speed: 83.333, vehicles: coach*2}\n"
    "vehicle: {coach: {file: " +
    source_folder() +
    "/options/vehicles/velaro.yml}}\n"
    "ts: {dt: 5e-4}\noutput: {interval: 5e-3, probes: [20, 52, 88]}\n";

TEST(CoupledModes, UnderVehicles) {
  const Values until = {{"ts_max_time", "2.2"}};
  const Values forces = {
      {"beam_self_weight", "true"}, {"load_forces", "1e5"}, {"load_positions", "-3"}, {"load_speed", "50"}};
  for (const Values& options : {Values{}, forces, Values{{"ts_type", "genalpha"}}, Values{{"ts_type", "arkimex"}}}) {
    SCOPED_TRACE(options.empty() ? "esdirk4" : options.begin()->second);
    Results full = run_yaml(coaches, until + options);
    Results modal = run_yaml(coaches, until + options + Values{{"model_modes", "1000"}});
    for (const char* name : {"/probes/deflection", "/probes/velocity", "/supports/reaction",
                             "/vehicles/0/wheel_1/normal_force", "/energy/dissipated"}) {
      const double difference = relative_difference(modal(name), full(name));
      RecordProperty(name + 1, text(difference));
      EXPECT_LT(difference, std::string(name) == "/energy/dissipated" ? 2e-5 : 1e-7) << name;
    }
  }
  Results few = run_yaml(coaches, until + Values{{"model_modes", "10"}});
  EXPECT_LT(std::abs(peak(few("/balance/residual")).first), 1e-9 * 8.0 * 152055.0);
  EXPECT_LT(energy_error(few), 1e-8);
}

// Passages side by side, by elements with the same dampers, against passages one after the other, which look at their
// samples alone.
TEST(CoupledModes, CaseBatch) {
  const Values options = {{"beam_elements_per_span", "16"}, {"model_vehicles", "linear"},
                          {"sweep_speed", "80,90,10"},      {"ts_dt", "5e-4"},
                          {"output_interval", "5e-4"},      {"beam_damping_ratios", "0.05"}};
  Results together = run_yaml(coaches, options);
  Results alone = run_yaml(coaches, options + Values{{"sweep_lanes", "0"}});
  for (const auto& [name, bound] : {std::pair("/sweep/peak_deflection", 1e-4), {"/sweep/least_wheel_force", 1e-3}}) {
    const double difference = relative_difference(together(name), alone(name));
    RecordProperty(name + 1, text(difference));
    EXPECT_LT(difference, bound) << name;
    EXPECT_GT(difference, 0.0) << "both are the same runs";
  }
}

}  // namespace
}  // namespace traverse::test
