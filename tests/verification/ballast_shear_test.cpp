// What shear in the ballast does to its vibration.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>

#include "beam/beam.hpp"
#include "support/curve.hpp"
#include "support/dense.hpp"
#include "support/short_bridge.hpp"
#include "support/track_model.hpp"

namespace traverse::test {
namespace {

/// Zhai's track by options/tracks/zhai.yml before a short bridge.
class ZhaiTrack {
 public:
  explicit ZhaiTrack(bool shear) : beam_(PETSC_COMM_SELF, model(shear)) {
    beam_.set_rayleigh({0.0, 0.0});
    M_ = dense(beam_.mass());
    C_ = dense(beam_.damping());
    K_ = dense(beam_.stiffness());
    for (Eigen::Index i = 0; i < K_.rows(); ++i)
      if (beam_.fixed()[static_cast<std::size_t>(i)] != 0) M_(i, i) = K_(i, i) = 1.0;
    // A sleeper in the middle of the ground before the bridge.
    column_ = beam::rail_mesh(beam_.model()).first_from(-9.0) / 2 * 2;
    ballast_ = column_ * beam_.block() + beam_.layout().ballast_place();
  }

  /// Greatest acceleration of a mass of ballast as a bogie's axles pass.
  double passage(double speed) const {
    DenseNewmark motion(M_, C_, K_, {}, 2e-4);
    motion.start(K_.llt().solve(axles(-20.0)), axles(-20.0));
    double greatest = 0.0;
    for (double t = 2e-4; - 20.0 + speed * t < -3.0; t += 2e-4) {
      motion.step(axles(-20.0 + speed * t));
      if (-20.0 + speed * t > -13.0) greatest = std::max(greatest, std::abs(motion.a[ballast_]));
    }
    return greatest;
  }

  /// Its acceleration for a unit force of this frequency on the rail above it, m/s2/N.
  double response(double hertz) const {
    const std::complex<double> s(0.0, 2.0 * std::numbers::pi * hertz);
    Eigen::VectorXcd P = Eigen::VectorXcd::Zero(K_.rows());
    P[beam_.rail()->unknown(column_, 1)] = 1.0;
    const Eigen::MatrixXcd A = s * s * M_ + s * C_ + K_;
    return std::abs(s * s * A.partialPivLu().solve(P)[ballast_]);
  }

 private:
  static beam::BeamModel model(bool shear) {
    beam::BeamModel model = short_bridge(2);
    model.spans = {2.18};
    beam::LayeredTrack& t = *model.track;
    t.rail_EI = 1.32476e7;
    t.rail_mass = 121.28;
    t.spacing = 0.545;
    t.pad = {1.3e8, 1.5e5};
    t.ballast = beam::Layer{2.755e8, 1.176e5};
    t.ballast_mass = 1062.8;
    t.subballast = beam::Layer{1.55e8, 6.23e4};
    t.approach = 20.0;
    if (shear) t.shear = {1.568e8, 1.6e5};
    return model;
  }

  /// Two axles of 170 kN, the first at x.
  Eigen::VectorXd axles(double x) const {
    Eigen::VectorXd P = Eigen::VectorXd::Zero(K_.rows());
    for (const double axle : {x, x - 2.5}) {
      if (axle < beam_.rail()->mesh.start()) continue;
      const beam::Station at = beam_.rail()->mesh.locate(axle);
      const auto unknowns = beam_.rail()->transverse(at.element);
      const double s = at.xi, l = beam_.rail()->mesh.element(at.element).length;
      const std::array psi = {1 - 3 * s * s + 2 * s * s * s, l * s * (1 - s) * (1 - s), 3 * s * s - 2 * s * s * s,
                              l * s * s * (s - 1)};
      for (std::size_t i = 0; i < 4; ++i) P[unknowns[i]] -= 1.7e5 * psi[i];
    }
    return P;
  }

  beam::Beam beam_;
  Eigen::MatrixXd M_, C_, K_;
  int column_ = 0, ballast_ = 0;
};

// Shear as stiff as the ground below spreads a load over more masses, which then rise and sink more slowly.
TEST(TrackStretches, ShearCalmsTheBallast) {
  const ZhaiTrack alone(false), sheared(true);
  const double passing = sheared.passage(69.4) / alone.passage(69.4);
  double with = 0.0, without = 0.0;
  for (double f = 5.0; f <= 300.0; f += 10.0) {
    with += std::pow(sheared.response(f), 2);
    without += std::pow(alone.response(f), 2);
  }
  const double shaken = std::sqrt(with / without);
  RecordProperty("ratio_of_passing_axles", text(passing));
  RecordProperty("ratio_of_a_shaken_rail", text(shaken));
  EXPECT_LT(passing, 0.95);
  EXPECT_LT(shaken, 0.95);
  // Far above the vibration of ballast on its springs (100 Hz) inertia alone counts.
  EXPECT_NEAR(sheared.response(2000.0) / alone.response(2000.0), 1.0, 0.05);
}

}  // namespace
}  // namespace traverse::test
