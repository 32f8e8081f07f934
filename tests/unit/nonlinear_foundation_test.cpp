// NonlinearFoundation, used as a stage and statics use it, against Newton's method with dense matrices.
#include "structure/nonlinear_foundation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "support/beam_model.hpp"
#include "support/dense.hpp"

namespace traverse::structure {
namespace {

using Verdict = NonlinearFoundation::Verdict;

constexpr double precision = 1e-9;  // of the greatest displacement of a kind, and of the greatest force

beam::FoundationLaw law(bool one_sided, double gap, double cubic) {
  beam::FoundationLaw law;
  law.one_sided = one_sided;
  law.gap = gap;
  law.cubic = cubic;
  return law;
}

/// Every kind of law in every direction, points between linear ones.
beam::BeamModel everything() {
  auto model = test::model_of({12.0, 9.0}, 4);
  model.foundation.vertical = {{3.1, 4e7, 3e5, false, law(true, 0.0, 0.0)},
                               {4.0, 1e6, 1e4},
                               {7.4, 2e8, 1e5, false, law(false, 5e-4, 0.0)},
                               {15.2, 1e7, 2e5, false, law(true, 2e-4, 1e13)}};
  model.foundation.longitudinal = {{6.6, 5e7, 1e5, false, law(false, 0.0, 1e14)}};
  model.foundation.rotational = {{21.0, 1e8, 1e5, false, law(false, 1e-4, 0.0)}};
  model.foundation.vertical_bed = beam::Bed{3e6, 2e4, law(true, 0.0, 0.0)};
  model.foundation.longitudinal_bed = beam::Bed{2e6, 1e4, law(false, 1e-5, 0.0)};
  return model;
}

/// Lies on its bed alone, of which it lifts off beside a load.
beam::BeamModel lying() {
  auto model = test::model_of({30.0}, 12, false);
  model.supports.assign(2, beam::Support::free);
  model.foundation.vertical_bed = beam::Bed{2e6, 2e4, law(true, 0.0, 0.0)};
  return model;
}

struct Stage {
  double shift = 0.0, shift2 = 0.0;
  Eigen::VectorXd v_predicted, w_predicted, load;
};

class Founded {
 public:
  explicit Founded(beam::BeamModel model)
      : beam(MPI_COMM_SELF, std::move(model)),
        op(prepared(beam)),
        foundation(beam, op, 1e6, 1e5),
        points_(beam::nonlinear_points(beam.bridge(), 0, beam.mesh().elements())) {
    for (const beam::NonlinearPoint& point : points_) shapes_.push_back(test::dense_shape(beam, point));
  }
  static beam::Beam& prepared(beam::Beam& beam) {
    beam.set_rayleigh({0.4, 2e-4});
    return beam;
  }

  Eigen::VectorXd zero() const { return Eigen::VectorXd::Zero(beam.local_unknowns()); }
  /// A downward force at a station, or a force along x, or a moment.
  Eigen::VectorXd force(double x, beam::Direction direction, double value) const {
    beam::NonlinearPoint at;
    at.direction = direction;
    at.at = beam.mesh().locate(x);
    return free_part(value * test::dense_shape(beam, at));
  }
  Eigen::VectorXd free_part(Eigen::VectorXd x) const {
    for (Eigen::Index i = 0; i < x.size(); ++i)
      if (beam.fixed()[i] != 0) x[i] = 0.0;
    return x;
  }

  beam::FoundationForce at(std::size_t point, const Eigen::VectorXd& v, const Eigen::VectorXd& w) const {
    const beam::NonlinearPoint& p = points_[point];
    return beam::foundation_force(p.law, p.k, p.c, shapes_[point].dot(v), shapes_[point].dot(w));
  }
  std::size_t points() const { return points_.size(); }
  const beam::NonlinearPoint& point(std::size_t i) const { return points_[i]; }
  Eigen::VectorXd forces(const Eigen::VectorXd& v, const Eigen::VectorXd& w) const {
    Eigen::VectorXd sum = zero();
    for (std::size_t i = 0; i < points(); ++i) sum += shapes_[i] * at(i, v, w).force;
    return sum;
  }

  /// z from A z = load + forces(v~ + z, w~ + s z). Along each step the residual's component grows from below zero: the
  /// step ends where it vanishes, if the whole goes too far.
  Eigen::VectorXd newton(const Stage& stage) const {
    const Eigen::MatrixXd A = test::dense_operator(beam, stage.shift, stage.shift2);
    const auto residual = [&](const Eigen::VectorXd& z) -> Eigen::VectorXd {
      return free_part(A * z - stage.load - forces(stage.v_predicted + z, stage.w_predicted + stage.shift * z));
    };
    Eigen::VectorXd z = zero();
    for (int i = 0; i < 200; ++i) {
      Eigen::MatrixXd J = A;
      for (std::size_t p = 0; p < points(); ++p) {
        const beam::FoundationForce f = at(p, stage.v_predicted + z, stage.w_predicted + stage.shift * z);
        // What touches nothing gets a little, so that J has an inverse; the solution does not depend on it.
        const double k = std::max(f.by_displacement + stage.shift * f.by_rate, i < 100 ? 1e-6 * points_[p].k : 0.0);
        J += k * shapes_[p] * shapes_[p].transpose();
      }
      for (Eigen::Index j = 0; j < J.rows(); ++j)
        if (beam.fixed()[j] != 0) J.row(j).setZero(), J.col(j).setZero(), J(j, j) = 1.0;
      const Eigen::VectorXd step = J.fullPivLu().solve(-residual(z));
      if (step.norm() <= 1e-14 * z.norm()) break;
      double low = 0.0, high = 1.0;
      if (step.dot(residual(z + step)) > -0.5 * step.dot(residual(z)))
        for (int k = 0; k < 30; ++k) {
          const double middle = 0.5 * (low + high);
          (step.dot(residual(z + middle * step)) < 0.0 ? low : high) = middle;
        }
      z += high * step;
    }
    return z;
  }

  /// As the coupling does it.
  Verdict solve(const Stage& stage, Eigen::VectorXd& z) {
    if (stage.shift == 0.0)
      foundation.begin(0.0, nullptr, nullptr, nullptr);
    else
      foundation.begin(stage.shift, stage.v_predicted.data(), stage.w_predicted.data(), stage.w_predicted.data());
    for (iterations = 1;; ++iterations) {
      const AddedSprings& added = foundation.linearise();
      z = stage.load;
      foundation.add_linearised(z.data());
      z = free_part(z);
      if (stage.shift == 0.0)
        op.solve_static(z.data(), &added);
      else
        op.factored(stage.shift, stage.shift2, &added).solve(z.data());
      const Verdict verdict = foundation.check_stage(z.data());
      if (verdict != Verdict::again) return verdict;
    }
  }

  void expect_dense(const Stage& stage) {
    Eigen::VectorXd z;
    ASSERT_EQ(solve(stage, z), Verdict::converged);
    const Eigen::VectorXd right = newton(stage);
    const int block = beam.block();
    for (int kind = 0; kind < block; ++kind) {
      double greatest = 0.0;
      for (Eigen::Index i = kind; i < z.size(); i += block) greatest = std::max(greatest, std::abs(right[i]));
      for (Eigen::Index i = kind; i < z.size(); i += block) ASSERT_NEAR(z[i], right[i], precision * greatest) << i;
    }
    expect_forces(stage.v_predicted + right, stage.w_predicted + stage.shift * right);
  }

  /// What the class reports of this state.
  void expect_forces(const Eigen::VectorXd& v, const Eigen::VectorXd& w) {
    Eigen::VectorXd its = zero();
    foundation.add_forces(its.data());
    const Eigen::VectorXd right = forces(v, w);
    const double greatest = std::max(1.0, right.cwiseAbs().maxCoeff());
    EXPECT_LE((its - right).cwiseAbs().maxCoeff(), precision * greatest);
    double energy = 0.0, dissipation = 0.0;
    NonlinearForces sums;
    const beam::Foundation& f = beam.model().foundation;
    for (std::size_t i = 0; i < beam::foundation_kind_count; ++i) {
      const beam::FoundationKind& kind = beam::foundation_kinds[i];
      const std::size_t spans = present(f, kind) ? static_cast<std::size_t>(beam.mesh().spans()) : 0;
      sums.of_kind[i].assign(kind.points != nullptr ? (f.*kind.points).size() : spans, 0.0);
    }
    std::size_t loaded = 0;
    for (std::size_t i = 0; i < points(); ++i) {
      const beam::FoundationForce force = at(i, v, w);
      energy += force.energy;
      dissipation += force.dissipation;
      loaded += force.force != 0.0 ? 1 : 0;
      const beam::NonlinearPoint& p = points_[i];
      sums.of_kind[p.kind][static_cast<std::size_t>(p.index)] += force.force;
    }
    EXPECT_NEAR(foundation.energy(), energy, 10.0 * precision * std::abs(energy));
    EXPECT_NEAR(foundation.dissipation(), dissipation, 10.0 * precision * (std::abs(dissipation) + 1e-3 * energy));
    NonlinearForces reported;
    std::vector<recovery::ElementLoad> loads(1);
    foundation.report(reported, loads);
    EXPECT_EQ(loads.size(), 1 + loaded);  // appended
    for (std::size_t kind = 0; kind < beam::foundation_kind_count; ++kind) {
      ASSERT_EQ(reported.of_kind[kind].size(), sums.of_kind[kind].size());
      for (std::size_t i = 0; i < sums.of_kind[kind].size(); ++i)
        EXPECT_NEAR(reported.of_kind[kind][i], sums.of_kind[kind][i], precision * greatest);
    }
  }

  beam::Beam beam;
  BeamOperator op;
  NonlinearFoundation foundation;
  int iterations = 0;

 private:
  std::vector<beam::NonlinearPoint> points_;
  std::vector<Eigen::VectorXd> shapes_;
};

// What moves as one would expect: deflections of centimetres, rotations and displacements along x of less.
Eigen::VectorXd random_state(const Founded& founded, double size, std::mt19937& random) {
  std::normal_distribution<double> number;
  Eigen::VectorXd x = founded.zero();
  const int block = founded.beam.block();
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const beam::Kind kind = founded.beam.layout().kind[static_cast<std::size_t>(i % block)];
    x[i] = size * number(random) * (kind == beam::v ? 1.0 : 0.2);
  }
  return founded.free_part(x);
}

// One object from stage to stage: tangents that it keeps must not show.
TEST(NonlinearFoundation, StagesOfEveryLaw) {
  Founded founded(everything());
  ASSERT_GT(founded.points(), 60U);
  std::mt19937 random(3);
  int most = 0;
  for (int i = 0; i < 12; ++i) {
    SCOPED_TRACE(i);
    Stage stage;
    stage.shift = i % 3 == 2 ? 60.0 : 400.0;
    stage.shift2 = stage.shift * stage.shift;
    stage.v_predicted = random_state(founded, 2e-3, random);
    stage.w_predicted = random_state(founded, 2e-2, random);
    stage.load = founded.force(3.0 + i, beam::Direction::vertical, (i % 4 == 0 ? 1.0 : -1.0) * 4e5) +
                 founded.force(10.0, beam::Direction::longitudinal, 2e5) +
                 founded.force(18.0, beam::Direction::rotational, 3e5);
    founded.expect_dense(stage);
    most = std::max(most, founded.iterations);
  }
  EXPECT_GT(most, 2);  // the laws matter
}

TEST(NonlinearFoundation, StaticsOfEveryLaw) {
  Founded founded(everything());
  for (double force : {-1e6, 1e5, -3e4}) {
    SCOPED_TRACE(force);
    Stage stage{0.0, 0.0, founded.zero(), founded.zero(), founded.force(7.0, beam::Direction::vertical, force)};
    stage.load += founded.force(20.0, beam::Direction::rotational, 0.3 * force) +
                  founded.force(15.0, beam::Direction::longitudinal, 0.5 * force);
    founded.expect_dense(stage);
  }
}

TEST(NonlinearFoundation, StaticsOfABeamThatLiesOnItsBed) {
  Founded founded(lying());
  Stage stage{0.0, 0.0, founded.zero(), founded.zero(), founded.force(13.0, beam::Direction::vertical, -5e5)};
  founded.expect_dense(stage);
  Eigen::VectorXd z;
  (void)founded.solve(stage, z);
  std::size_t open = 0;
  for (std::size_t i = 0; i < founded.points(); ++i) open += founded.at(i, z, founded.zero()).force == 0.0 ? 1 : 0;
  EXPECT_GT(open, 4U);
  EXPECT_LT(open, founded.points() / 2);
}

TEST(NonlinearFoundation, ForcesAtAState) {
  Founded founded(everything());
  std::mt19937 random(5);
  for (int i = 0; i < 5; ++i) {
    const Eigen::VectorXd v = random_state(founded, 1e-3, random), w = random_state(founded, 0.1, random);
    founded.foundation.evaluate(v.data(), w.data());
    founded.expect_forces(v, w);
  }
}

// Nothing holds the beam from above: that is said, with the place.
TEST(NonlinearFoundation, StaticsWithoutASolution) {
  Founded founded(lying());
  const Stage stage{0.0, 0.0, founded.zero(), founded.zero(), founded.force(13.0, beam::Direction::vertical, 5e5)};
  Eigen::VectorXd z;
  EXPECT_EQ(founded.solve(stage, z), Verdict::failed);
  EXPECT_EQ(founded.foundation.worst_point().rfind("foundation_vertical_bed at x = ", 0), 0U)
      << founded.foundation.worst_point();
}

TEST(NonlinearFoundation, OfStatesThatAreNoNumbers) {
  Founded founded(everything());
  Stage stage{400.0, 1.6e5, founded.zero(), founded.zero(), founded.zero()};
  stage.load.setConstant(std::nan(""));
  Eigen::VectorXd z;
  EXPECT_EQ(founded.solve(stage, z), Verdict::failed);
}

}  // namespace
}  // namespace traverse::structure
