// Compliance against the dense inverse of the beam's matrix.
#include "structure/compliance.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "structure/nonlinear_foundation.hpp"
#include "support/beam_model.hpp"
#include "support/dense.hpp"

namespace traverse::structure {
namespace {

constexpr double precision = 1e-9;  // of the peaks of both unknowns: the dense inverse loses digits, too

struct Case {
  explicit Case(beam::BeamModel model) : beam(MPI_COMM_SELF, std::move(model)), op(prepared(beam)) {}
  static beam::Beam& prepared(beam::Beam& beam) {
    beam.set_rayleigh({0.4, 2e-4});
    return beam;
  }
  /// Every unknown of the elements prepared, and what is left out as too small to be felt.
  void expect_dense(Compliance& compliance, const Eigen::MatrixXd& inverse, const std::vector<int>& elements) const {
    const beam::Line& line = beam.running();
    const int m = 2 * line.per_node, count = static_cast<int>(elements.size());
    for (int b = 0; b < count; ++b) {
      const Compliance::Response& response = compliance.response(b);
      const auto loaded = line.unknowns(elements[b]);
      for (int a = 0; a < count; ++a) {
        const auto moved = line.unknowns(elements[a]);
        const bool responds = a >= response.first && a < response.last;
        for (int i = 0; i < m; ++i)
          for (int j = 0; j < m; ++j) {
            const double its = responds ? compliance.block(a, b)[i + j * m] : 0.0;
            const double peak = std::sqrt(inverse(moved[i], moved[i]) * inverse(loaded[j], loaded[j]));
            ASSERT_NEAR(its, inverse(moved[i], loaded[j]), precision * peak)
                << "elements " << elements[a] << ", " << elements[b] << ", unknowns " << i << ", " << j;
          }
      }
    }
    expect_dense_response(compliance, inverse, elements);
  }
  /// Of the whole beam to loads on all unknowns of these elements, on top of what was there.
  void expect_dense_response(const Compliance& compliance, const Eigen::MatrixXd& inverse,
                             const std::vector<int>& elements) const {
    const beam::Line& line = beam.running();
    std::mt19937 random(7);
    std::uniform_real_distribution<double> number(-1.0, 1.0);
    Eigen::VectorXd load = Eigen::VectorXd::Zero(beam.local_unknowns());
    Eigen::VectorXd v = Eigen::VectorXd::Constant(load.size(), 1e-9);
    std::vector<double> loads;
    for (int element : elements)
      for (int i = 0; i < 2 * line.per_node; ++i) {
        loads.push_back(number(random));
        load[line.unknowns(element)[i]] += loads.back();
      }
    const Eigen::VectorXd right = inverse * load + v;
    compliance.add_response(loads, v.data());
    for (Eigen::Index i = 0; i < v.size(); ++i)
      ASSERT_NEAR(v[i], right[i], 10.0 * precision * std::sqrt(inverse(i, i) * inverse.diagonal().maxCoeff()) + 1e-24)
          << "unknown " << i;
  }
  void expect_dense(double shift, double shift2, const std::vector<int>& elements) {
    Compliance compliance(beam, op);
    compliance.prepare(shift, shift2, nullptr, elements);
    expect_dense(compliance, test::dense_inverse(beam, test::dense_operator(beam, shift, shift2)), elements);
  }

  beam::Beam beam;
  BeamOperator op;
};

beam::BeamModel bedded(bool axial) {
  auto model = test::model_of({10.0, 14.0}, 12, axial);
  model.foundation.vertical_bed = beam::Bed{2e7, 4e4};
  model.foundation.vertical = {{4.0, 5e7, 1e5}};
  return model;
}

beam::BeamModel separate_spans(bool axial) {
  auto model = test::model_of({10.0, 14.0, 10.0}, 8, axial);
  model.joints.assign(1, beam::Joint::separate);
  return model;
}

const std::vector<int> elements = {0, 3, 4, 11, 12, 23};

TEST(Compliance, OfAContinuousBeam) {
  for (bool axial : {false, true}) {
    Case c(bedded(axial));
    ASSERT_EQ(c.op.parts(), nullptr);
    c.expect_dense(400.0, 1.6e5, elements);
    c.expect_dense(40.0, 3.2e3, elements);
    c.expect_dense(0.0, 0.0, elements);
  }
}

TEST(Compliance, OfSeparateSpans) {
  for (bool axial : {false, true}) {
    Case c(separate_spans(axial));
    if (!axial) {
      ASSERT_NE(c.op.parts(), nullptr);
    }
    c.expect_dense(400.0, 1.6e5, {0, 3, 4, 7, 8, 15, 16, 20, 23});
    c.expect_dense(0.0, 0.0, {0, 3, 4, 7, 8, 15, 16, 20, 23});
  }
}

// A load on one of them moves no other.
TEST(Compliance, SeparateSpansDoNotRespond) {
  Case c(separate_spans(false));
  Compliance compliance(c.beam, c.op);
  compliance.prepare(400.0, 1.6e5, nullptr, {2, 7, 8, 15, 20});
  const std::vector<std::pair<int, int>> spans = {{0, 2}, {0, 2}, {2, 4}, {2, 4}, {4, 5}};
  for (int b = 0; b < 5; ++b) {
    EXPECT_EQ(compliance.response(b).first, spans[b].first) << b;
    EXPECT_EQ(compliance.response(b).last, spans[b].second) << b;
  }
  EXPECT_EQ(compliance.reach(400.0, 1.6e5), 0);
}

TEST(Compliance, OfABeamWithHinges) {
  auto model = bedded(true);
  model.hinges = {5.0};
  model.joints.assign(1, beam::Joint::hinge);
  Case c(std::move(model));
  c.expect_dense(400.0, 1.6e5, elements);
  c.expect_dense(0.0, 0.0, elements);
}

// Wheels run on the rail, whose columns hold sleepers and the bridge, too.
TEST(Compliance, OfARailOnABridge) {
  auto model = test::model_of({9.0}, 1);
  beam::LayeredTrack track;
  track.rail_EI = 1.3e7;
  track.rail_EA = 3.2e9;
  track.rail_mass = 120.0;
  track.pad = {2e8, 1e5};
  track.sleeper_mass = 300.0;
  track.ballast = beam::Layer{1.5e8, 6e4};
  track.ballast_mass = 400.0;
  track.subballast = beam::Layer{1e8, 5e4};
  track.longitudinal = {1e7, 1e4};
  track.approach = 3.0;
  model.track = track;
  Case c(std::move(model));
  ASSERT_NE(c.beam.rail(), nullptr);
  c.expect_dense(400.0, 1.6e5, {0, 4, 5, 20});
  c.expect_dense(0.0, 0.0, {0, 4, 5, 20});
}

// Springs of a foundation that is not linear come on top, and others take their place.
TEST(Compliance, WithSpringsAdded) {
  auto model = bedded(true);
  beam::FoundationLaw stop;
  stop.gap = 1e-4;
  beam::FoundationLaw cubic;
  cubic.cubic = 1e12;
  model.foundation.vertical.push_back({7.3, 3e8, 2e5, false, stop});
  model.foundation.longitudinal = {{12.1, 2e8, 0.0, false, cubic}};
  Case c(std::move(model));
  constexpr double shift = 400.0, shift2 = 1.6e5;
  NonlinearFoundation foundation(c.beam, c.op, 1e5, 1e5);
  const auto points = beam::nonlinear_points(c.beam.bridge(), 0, c.beam.mesh().elements());
  ASSERT_EQ(points.size(), 2U);
  Compliance compliance(c.beam, c.op);
  for (double down : {0.0, 2e-3}) {  // the stop is open, then closed
    const std::vector<double> v(c.beam.local_unknowns(), -down), w(v.size(), 0.0);
    foundation.begin(shift, v.data(), w.data(), w.data());
    const AddedSprings& added = foundation.linearise();
    Eigen::MatrixXd A = test::dense_operator(c.beam, shift, shift2);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Eigen::VectorXd N = test::dense_shape(c.beam, points[i]);
      A += (added.k[i] + shift * added.c[i]) * N * N.transpose();
    }
    for (Eigen::Index i = 0; i < A.rows(); ++i)
      if (c.beam.fixed()[i] != 0) A.row(i).setZero(), A.col(i).setZero();
    EXPECT_EQ(added.k[0] > 0.0, down > 0.0);
    compliance.prepare(shift, shift2, &added, elements);
    c.expect_dense(compliance, test::dense_inverse(c.beam, A), elements);
  }
}

// Wheels go over to other elements, the shift changes and comes back: what was kept is still the right one.
TEST(Compliance, FollowsElementsAndShifts) {
  for (const beam::BeamModel& model : {bedded(true), separate_spans(false)}) {
    Case c(model);
    Compliance compliance(c.beam, c.op);
    const std::vector<std::vector<int>> lists = {{2, 7, 8}, {2, 8, 9, 17}, {3, 17}, {2, 7, 8}, {23}, {0, 1, 2, 3}};
    const std::vector<double> shifts = {400.0, 400.0, 37.0, 400.0, 0.0, 37.0, 37.0};
    for (double shift : shifts)
      for (const std::vector<int>& list : lists) {
        compliance.prepare(shift, shift * shift, nullptr, list);
        c.expect_dense(compliance, test::dense_inverse(c.beam, test::dense_operator(c.beam, shift, shift * shift)),
                       list);
      }
  }
}

// Short steps on a long bridge: what is left out beyond a response is nothing, and reach() says where that is.
TEST(Compliance, DiesOutOnALongBridge) {
  auto model = test::model_of({300.0}, 300, false);
  model.foundation.vertical_bed = beam::Bed{2e7, 0.0};
  Case c(std::move(model));
  constexpr double shift = 4e3, shift2 = 1.6e7;
  Compliance compliance(c.beam, c.op);
  std::vector<int> all;
  for (int e = 0; e < 300; ++e) all.push_back(e);
  compliance.prepare(shift, shift2, nullptr, all);
  const Compliance::Response& middle = compliance.response(150);
  EXPECT_GT(middle.first, 0);
  EXPECT_LT(middle.last, 300);
  EXPECT_LT(middle.first, 145);
  EXPECT_GT(middle.last, 155);
  const Eigen::MatrixXd inverse = test::dense_inverse(c.beam, test::dense_operator(c.beam, shift, shift2));
  c.expect_dense(compliance, inverse, all);
  const int reach = compliance.reach(shift, shift2), load = 2 * 150;
  ASSERT_LT(reach, 150);
  for (int node = 0; node < c.beam.columns(); ++node) {
    if (std::abs(node - 150) <= reach) continue;
    EXPECT_LT(std::abs(inverse(2 * node, load)), 1e-15 * inverse(load, load)) << node;
  }
}

}  // namespace
}  // namespace traverse::structure
