// Once a state is made and its partition chosen, an evaluation takes no memory from the heap.
#include <gtest/gtest.h>

#include "support/counted_memory.hpp"
#include "unit/mechanism_helpers.hpp"

#ifdef TRAVERSE_COUNTS_MEMORY

namespace traverse::multibody::testing {
namespace {

TEST(Evaluation, TakesNoMemory) {
  MechanismModel model = slider_crank(0.7);
  model.bodies[0].velocity.z() = 3.0;
  model.springs = {make_spring("s", ground, 1, {6.0, 0.0}, model.bodies[1].position.head<2>(), 300.0, 3.0)};
  model.springs.push_back(model.springs[0]);
  model.springs[1].stiffness = model.springs[1].damping = 0.0;
  model.springs[1].law = base::ForceLaw{base::Polyline::line(40.0), base::Polyline::line(2.0), 0.01, base::Side::both};
  model.joints[1].friction = {0.2, 1.0, 0.01};
  Motion motion(model);
  double pdd = 0.0;
  Eigen::MatrixXd product(motion.mechanism.coordinates(), 1), projector(motion.mechanism.coordinates(), 1);
  const long before = allocations;
  std::vector<double> counted(10);
  ASSERT_GT(allocations, before);  // the counting works
  const long start = allocations;
  for (int i = 0; i < 100; ++i) {
    motion.p[0] += 0.01;
    const bool converged = motion.evaluate(0.01 * i, &pdd);
    motion.mechanism.compute_forces(motion.state);
    motion.mechanism.recover(motion.state, motion.Q, &pdd);
    motion.mechanism.multiply_tangent(motion.state, -1.0, -2.0, 1.0, product);
    motion.mechanism.friction_projector(motion.state, projector);
    motion.converged = motion.converged && converged;
  }
  EXPECT_EQ(allocations, start);
  EXPECT_TRUE(motion.converged);
}

}  // namespace
}  // namespace traverse::multibody::testing

#endif
