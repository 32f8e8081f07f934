// Cost of one evaluation of the equations of motion (positions, velocities, forces, accelerations) of typical vehicles.
#include <benchmark/benchmark.h>

#include <string>
#include <vector>

#include "multibody/mechanism.hpp"

namespace {

using namespace traverse::multibody;

Body body(const std::string& name, double mass, double inertia, double x, double y) {
  Body b;
  b.name = name;
  b.mass = mass;
  b.inertia = inertia;
  b.position = {x, y, 0.0};
  b.velocity = {80.0, 0.0, 0.0};
  return b;
}

Joint guide(JointType type, int first, int second, double x, double y) {
  Joint j;
  j.name = "guide_" + std::to_string(first) + "_" + std::to_string(second);
  j.type = type;
  j.bodies = {first, second};
  j.point = {x, y};
  return j;
}

Spring suspension(int first, int second, double x, double from, double to, double stiffness, double damping) {
  Spring s;
  s.name = "suspension_" + std::to_string(second);
  s.bodies = {first, second};
  s.from = {x, from};
  s.to = {x, to};
  s.stiffness = stiffness;
  s.damping = damping;
  return s;
}

/// A coach of 10 degrees of freedom: heave and pitch of the car and of two bogies, heave of four axles.
MechanismModel coach() {
  MechanismModel model;
  model.name = "coach";
  model.bodies = {body("car", 4.0e4, 2.0e6, 0.0, 1.8)};
  for (const double x : {9.5, -9.5}) model.bodies.push_back(body("bogie", 3000.0, 4000.0, x, 0.6));
  for (const double x : {10.75, 8.25, -8.25, -10.75}) model.bodies.push_back(body("axle", 1800.0, 100.0, x, 0.46));
  for (int bogie = 1; bogie <= 2; ++bogie) {
    const double x = model.bodies[bogie].position.x();
    model.joints.push_back(guide(JointType::slot, 0, bogie, x, 0.9));
    for (const double side : {-0.5, 0.5}) {
      model.springs.push_back(suspension(0, bogie, x + side, 1.2, 0.7, 2.5e5, 3.0e4));
    }
  }
  for (int axle = 3; axle <= 6; ++axle) {
    const int bogie = axle <= 4 ? 1 : 2;
    const double x = model.bodies[axle].position.x();
    model.joints.push_back(guide(JointType::prismatic, bogie, axle, x, 0.46));
    model.springs.push_back(suspension(bogie, axle, x, 0.8, 0.46, 1.2e6, 1.0e4));
  }
  Driver driver;
  driver.name = "speed";
  driver.value = traverse::base::TimeFunction(0.0, 80.0);
  model.drivers = {driver};
  return model;
}

/// A four-bar linkage: little sparsity, all positions nonlinear.
MechanismModel four_bar() {
  MechanismModel model;
  model.name = "four_bar";
  model.bodies = {body("crank", 1.0, 0.1, 0.0, 0.5), body("coupler", 2.0, 0.5, 1.0, 1.25),
                  body("rocker", 1.5, 0.3, 2.0, 0.75)};
  model.joints = {guide(JointType::revolute, ground, 0, 0.0, 0.0), guide(JointType::revolute, 0, 1, 0.0, 1.0),
                  guide(JointType::revolute, 1, 2, 2.0, 1.5), guide(JointType::revolute, ground, 2, 2.0, 0.0)};
  for (Body& b : model.bodies) b.velocity.setZero();
  return model;
}

// Floating-point operations of one evaluation: +, -, *, / and square roots count one each, a fused pair two, changes of
// sign, comparisons and moves nothing. What the sparse factorisations take follows from their index lists; what a part
// takes is counted from its source, as below. Checked against the machine: valgrind's callgrind with --dump-instr=yes
// on 2000 and on 4000 evaluations of the coach, its execution counts multiplied with the arithmetic that objdump shows
// at each address (a vector as many as it is wide), gave 2467 an evaluation, 252 of them in the C library's sine and
// cosine; this count gives 2425.
constexpr long sine_and_cosine = 36;  // of one angle, as measured
constexpr long spring = 55;           // arms 12, line and its rate 14, length 4, tension 11, forces 8, added to g 6
constexpr long weight = 1;
constexpr long driver_residual = 3;

struct JointOperations {
  long residual, jacobian, gamma;
};
JointOperations operations(JointType type) {
  if (type == JointType::slot) return {20, 22, 39};  // the placement of its normal is 16 of each
  if (type == JointType::prismatic) return {22, 22, 39};
  return {16, 12, 20};  // revolute
}

/// `corrections`: Newton steps on positions.
double operations(const Mechanism& mechanism, const MechanismState& s, double corrections) {
  const MechanismModel& model = mechanism.model();
  const BlockOperations block = s.dependent_block.operations();
  const MassOperations mass = s.reduced_mass.operations(s.dependent_block);
  const auto bodies = static_cast<double>(model.bodies.size());
  const long n = mechanism.coordinates(), f = mechanism.freedom(), rows = s.dependent_block.size();
  long residual = static_cast<long>(model.drivers.size()) * driver_residual + rows, jacobian = 0, gamma = 0;
  for (const Joint& joint : model.joints) {
    const JointOperations count = operations(joint.type);
    residual += count.residual;
    jacobian += count.jacobian;
    gamma += count.gamma;
  }
  const double positions = static_cast<double>(f + block.expand) + bodies * sine_and_cosine +
                           (1.0 + corrections) * static_cast<double>(residual) +
                           corrections * static_cast<double>(block.solve + 2 * rows);
  const long velocities = jacobian + block.factor + block.sensitivity + 2 * block.solve + block.expand + gamma;
  const long forces = static_cast<long>(model.springs.size()) * spring;
  const long accelerations = mass.factor + 3 * n + block.expand + mass.solve + block.expand + 3 * n + block.solve;
  return positions + static_cast<double>(velocities + forces + accelerations) + bodies * weight;
}

/// Evaluates along a prescribed small motion so that every call has new positions.
void evaluate(benchmark::State& bench, const MechanismModel& model, bool derivatives) {
  Mechanism mechanism(model);
  MechanismState s = mechanism.make_state();
  mechanism.choose_partition(s, 0.0);
  const int f = mechanism.freedom();
  const std::vector<int>& independent = mechanism.partition().independent;
  Eigen::VectorXd p0(f), p(f), pd(f), pdd(f);
  for (int k = 0; k < f; ++k) {
    p0[k] = s.q[independent[k]];
    pd[k] = s.qd[independent[k]];
  }
  const Eigen::VectorXd Q = Eigen::VectorXd::Zero(mechanism.coordinates());
  Eigen::MatrixXd product;
  const double dt = 1e-3;
  double t = 0.0;
  double sway = 0.0;
  for (auto _ : bench) {
    t += dt;
    sway = sway > 1e-3 ? -1e-3 : sway + 3e-6;
    for (int k = 0; k < f; ++k) p[k] = p0[k] + (k % 2 == 0 ? sway : -sway);
    if (!mechanism.set_positions(s, t, p.data())) bench.SkipWithError("positions did not converge");
    mechanism.set_velocities(s, t, pd.data());
    mechanism.compute_forces(s);
    mechanism.accelerations(s, Q, pdd.data());
    if (derivatives) mechanism.multiply_tangent(s, -1.0, -1e3, 1.0, product);
    benchmark::DoNotOptimize(pdd.data());
  }
  bench.counters["freedom"] = f;
  if (derivatives) return;
  const auto evaluations = static_cast<double>(bench.iterations());
  const double count = operations(mechanism, s, static_cast<double>(s.corrections) / evaluations);
  bench.counters["operations"] = count;
  bench.counters["operations_per_second"] = benchmark::Counter(count * evaluations, benchmark::Counter::kIsRate);
}

void coach_evaluation(benchmark::State& bench) { evaluate(bench, coach(), false); }
void coach_with_derivatives(benchmark::State& bench) { evaluate(bench, coach(), true); }
void four_bar_evaluation(benchmark::State& bench) { evaluate(bench, four_bar(), false); }

void free_coach_evaluation(benchmark::State& bench) {
  MechanismModel model = coach();
  model.joints.clear();
  model.drivers.clear();
  evaluate(bench, model, false);
}

void coach_partition(benchmark::State& bench) {
  Mechanism mechanism(coach());
  MechanismState s = mechanism.make_state();
  for (auto _ : bench) mechanism.choose_partition(s, 0.0);
}

BENCHMARK(coach_evaluation);
BENCHMARK(coach_with_derivatives);
BENCHMARK(free_coach_evaluation);
BENCHMARK(four_bar_evaluation);
BENCHMARK(coach_partition);

}  // namespace
