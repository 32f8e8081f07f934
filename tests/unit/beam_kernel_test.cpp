// The structure of runs side by side (engine/beam_kernel.hpp) against dense matrices, lane by lane.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <optional>
#include <random>
#include <utility>
#include <vector>

#include "engine/batch_kernel.hpp"
#include "engine/processor.hpp"
#include "engine/structure_lanes.hpp"

namespace traverse::engine {
namespace {

using Eigen::Index;

/// A chain of columns with three symmetric positive matrices and some held unknowns. own: the lanes have different
/// chains, whose first columns differ and whose last ones are equal. sparse: some unknowns are coupled within their
/// column only, and some not at all.
struct Chain {
  struct Lane {
    Eigen::MatrixXd M, C, K;
    double by_mass = 0.0, by_stiffness = 0.0;
  };
  Chain(int block, int columns, bool proportional, bool own, bool sparse)
      : size(block * columns), held(static_cast<std::size_t>(size), 0), of_lane(lanes) {
    const auto coupled = [&](int i, int j) {
      const auto reach = [&](int k) { return sparse ? (k / block + (k % block) * (k % block)) % 3 : 2; };
      return std::min(reach(i), reach(j)) > (i / block == j / block ? 0 : 1);
    };
    for (Eigen::MatrixXd Lane::*A : {&Lane::M, &Lane::C, &Lane::K}) {
      for (Lane& lane : of_lane) (lane.*A).setZero(size, size);
      for (int c = 0; c + 1 < columns; ++c) {
        Eigen::MatrixXd sum = 0.1 * Eigen::MatrixXd::Identity(2 * block, 2 * block);
        for (int i = 0; i < 2 * block; ++i)
          for (int j = 0; j < i; ++j) {
            if (!coupled(c * block + i, c * block + j)) continue;
            Eigen::VectorXd direction = Eigen::VectorXd::Zero(2 * block);
            direction[i] = random();
            direction[j] = random();
            sum += direction * direction.transpose();
          }
        for (int l = 0; l < lanes; ++l)
          (of_lane[static_cast<std::size_t>(l)].*A).block(c * block, c * block, 2 * block, 2 * block) +=
              (own && c < columns / 2 ? 1.0 + 0.1 * l : 1.0) * sum;
      }
    }
    task.shared = !own;
    double *by_mass = rows_of(1), *by_stiffness = rows_of(1), *own_dead = rows_of(size);
    for (int l = 0; l < lanes; ++l) {
      Lane& lane = of_lane[static_cast<std::size_t>(l)];
      lane.by_mass = by_mass[l] = own ? 0.3 + 0.01 * l : 0.3;
      lane.by_stiffness = by_stiffness[l] = own ? 0.02 + 0.001 * l : 0.02;
      if (proportional) lane.C = lane.by_mass * lane.M + lane.by_stiffness * lane.K;
    }
    for (const int i : {0, (columns / 2) * block, size - block}) held[static_cast<std::size_t>(i)] = 1;
    for (int i = 0; i < size; ++i) {
      dead.push_back(random());
      std::fill_n(own_dead + i * lanes, lanes, dead.back());
    }
    for (int e = 0; e + 1 < columns; ++e) first_column.push_back(e);
    task.block = block;
    task.columns = columns;
    std::vector<ColumnBlocks> blocks;
    for (const Lane& lane : of_lane)
      blocks.push_back({blocks_of(lane.M), proportional ? nullptr : blocks_of(lane.C), blocks_of(lane.K)});
    matrices.emplace(block, held, std::move(blocks));
    matrices->set(task);
    task.proportional = proportional;
    task.by_mass = by_mass;
    task.by_stiffness = by_stiffness;
    task.dead = own ? own_dead : dead.data();
    const int bb = block * block;
    task.pivot = rows_of(size);
    task.factor = rows_of(static_cast<int>(matrices->factor_size()));
    task.inverse = rows_of(2 * columns * bb);
    task.compliance = rows_of(10 * columns);
    task.unknowns = size;
    task.middle = columns / 2;
    for (double** of : {&task.v, &task.w, &task.a[0], &task.a[1], &task.v_predicted, &task.w_predicted, &task.residual,
                        &task.solution, &task.work, &task.v_stage})
      *of = rows_of(size);
    task.elements = columns - 1;
    task.first_column = first_column.data();
    for (int i = 0; i < size * lanes; ++i) {
      task.v[i] = random();
      task.w[i] = held[static_cast<std::size_t>(i / lanes)] != 0 ? 0.0 : random();
    }
  }

  double random() { return std::uniform_real_distribution<double>(-0.5, 0.5)(generator); }
  double* rows_of(int count) {
    memory.push_back(std::make_unique<Aligned>(static_cast<std::size_t>(count * lanes)));
    return memory.back()->data();
  }
  const double* blocks_of(const Eigen::MatrixXd& A) {
    const int b = task.block;
    double* const first = rows_of(2 * task.columns * b * b);
    double* to = first;
    for (int c = 0; c < task.columns; ++c)
      for (int next = c; next < c + 2; ++next, to += b * b)
        if (next < task.columns) Eigen::Map<Eigen::MatrixXd>(to, b, b) = A.block(c * b, next * b, b, b);
    return first;
  }
  /// (M + rate C + displacement K)^-1 of the unknowns that are not held, 0 of others.
  Eigen::MatrixXd inverse(const Lane& lane, double rate, double displacement) const {
    Eigen::MatrixXd J = lane.M + rate * lane.C + displacement * lane.K;
    for (int i = 0; i < size; ++i) {
      if (held[static_cast<std::size_t>(i)] == 0) continue;
      J.row(i).setZero();
      J.col(i).setZero();
      J(i, i) = 1.0;
    }
    J = J.inverse().eval();
    for (int i = 0; i < size; ++i)
      if (held[static_cast<std::size_t>(i)] != 0) J(i, i) = 0.0;
    return J;
  }

  std::mt19937 generator{7};
  int size;
  std::vector<char> held;
  std::vector<Lane> of_lane;
  std::optional<MatrixLanes> matrices;
  std::vector<double> dead;
  std::vector<int> first_column;
  BeamTask task;
  std::vector<std::unique_ptr<Aligned>> memory;
};

// A track of five unknowns a column: the rail's deflection and rotation, which are coupled with the next column, and a
// chain of sleeper, ballast and sub-ballast below the deflection.
TEST(EliminationOrder, OfATrackHasNoOtherLinks) {
  constexpr int block = 5, columns = 4;
  const EliminationOrder order(block, columns, [](int i, int j) {
    const int one = i % block, other = j % block;
    if (i / block != j / block || (one < 2 && other < 2)) return one < 2 && other < 2;
    return std::min(one, other) != 1 && std::abs(one - other) <= (std::min(one, other) == 0 ? 2 : 1);
  });
  BeamTask task;
  order.set(task);
  for (int c = 0; c < columns; ++c) {
    const ColumnOrder& own = *task.order[c];
    EXPECT_EQ(std::vector<int>(own.unknown, own.unknown + own.count), (std::vector<int>{4, 3, 2, 0, 1}));
    EXPECT_EQ(std::vector<int>(own.earlier, own.earlier + own.links), (std::vector<int>{4, 3, 2, 0}));
    EXPECT_EQ(std::vector<int>(own.later, own.later + own.links), (std::vector<int>{3, 2, 0, 1}));
  }
  EXPECT_EQ(order.factor_size(), static_cast<std::size_t>(4 * columns + 4 * (columns - 1)));  // 8 a column, then 4
}

/// One wheel in every lane, on an element.
struct Wheels {
  Wheels(const BeamTask& beam, int element) : slot(2 * lanes, -1) {
    for (int l = 0; l < lanes; ++l) slot[static_cast<std::size_t>(l)] = element * beam.block * lanes + l;
    task.wheels = 1;
    task.ground = -1;
    task.patch[0].slot = slot.data();
    task.patch[1].slot = slot.data() + lanes;
  }
  std::vector<int> slot;
  TrainTask task;
};

class BeamKernel : public testing::TestWithParam<std::tuple<int, int, bool, bool, bool>> {};

TEST_P(BeamKernel, SolvesAStageAsDenseMatricesDo) {
  const auto [block, columns, proportional, own, sparse] = GetParam();
  Chain chain(block, columns, proportional, own, sparse);
  BeamTask& t = chain.task;
  Row rate{}, displacement{};
  for (int l = 0; l < lanes; ++l) {
    Rows::numbers(rate)[l] = 0.1 + 0.01 * l;
    Rows::numbers(displacement)[l] = 0.2 + 0.02 * l;
  }
  const auto column = [&](const double* numbers, int l) {
    Eigen::VectorXd x(chain.size);
    for (int i = 0; i < chain.size; ++i) x[i] = numbers[i * lanes + l];
    return x;
  };
  std::vector<Eigen::VectorXd> v, w;
  for (int l = 0; l < lanes; ++l) {
    v.push_back(column(t.v, l));
    w.push_back(column(t.w, l));
  }
  // In a window about the middle, and in one that is far from it, so that it moves there.
  for (const int element : {columns / 2 - 1, 0, columns - 2}) {
    Wheels wheels(t, element);
    StageRows& stage = wheels.task.stage[0];  // from v and w at its start
    for (int l = 0; l < lanes; ++l) {
      stage.rate[l] = Rows::numbers(rate)[l];
      stage.displacement[l] = Rows::numbers(displacement)[l];
    }
    with_structure(t, [&](const auto& structure) {
      structure.factorise(rate, displacement);
      structure.set_window(wheels.task, rate, displacement);
      structure.find_residual(wheels.task, 0);
      structure.begin_passes();
      structure.clear_loads();
      structure.solve(displacement, ~RowMask{});
      structure.end_passes(wheels.task, 0);
    });
    EXPECT_TRUE(t.first <= element && element + 1 <= t.last && t.first <= t.middle && t.middle <= t.last);
    if (columns > 50) {
      EXPECT_LT(t.last - t.first, columns - 1);
    }
    for (int l = 0; l < lanes; ++l) {
      const double d = Rows::numbers(displacement)[l];
      const Chain::Lane& lane = chain.of_lane[static_cast<std::size_t>(l)];
      const Eigen::MatrixXd inverse = chain.inverse(lane, Rows::numbers(rate)[l], d);
      const Eigen::VectorXd P = Eigen::Map<const Eigen::VectorXd>(chain.dead.data(), chain.size);
      const Eigen::VectorXd exact =
          inverse * (P - lane.C * w[static_cast<std::size_t>(l)] - lane.K * v[static_cast<std::size_t>(l)]);
      EXPECT_LT((column(t.a[1], l) - exact).cwiseAbs().maxCoeff(), 1e-13);
      // v~ and what the accelerations add is where the structure is.
      const Eigen::VectorXd there = column(t.v_predicted, l) + d * column(t.solution, l);
      EXPECT_LT((there - v[static_cast<std::size_t>(l)] - d * exact).cwiseAbs().maxCoeff(), 1e-13);
      for (int e = 0; e + 1 < columns; ++e) {
        const int first = e * block;
        const int unknown[4] = {first, first + 1, first + block, first + block + 1};
        for (int i = 0, n = 0; i < 4; ++i)
          for (int j = i; j < 4; ++j, ++n)
            EXPECT_NEAR(t.compliance[(10 * e + n) * lanes + l],
                        (i == j ? 1.0 : 2.0) * d * inverse(unknown[i], unknown[j]), 1e-13);
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Chains, BeamKernel,
                         testing::Combine(testing::Values(2, 3, 5), testing::Values(2, 3, 6, 27, 80), testing::Bool(),
                                          testing::Bool(), testing::Bool()));

}  // namespace
}  // namespace traverse::engine
