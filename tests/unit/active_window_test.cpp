// ActiveWindow: what it opens and closes, what that takes away, and the motion within it against that of the whole
// beam.
#include "structure/active_window.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "beam/shape.hpp"
#include "structure/compliance.hpp"
#include "support/beam_model.hpp"
#include "support/dense.hpp"

namespace traverse::structure {
namespace {

using Vector = Eigen::VectorXd;

// Of all that moves; both 0 where nothing does.
int first_of(const ActiveWindow& window) { return window.moving().empty() ? 0 : window.moving().front().first; }
int past_of(const ActiveWindow& window) { return window.moving().empty() ? 0 : window.moving().back().past; }

/// A beam of bending alone with its state.
struct Moving {
  explicit Moving(beam::BeamModel model, bool own_weight = false)
      : beam(MPI_COMM_SELF, std::move(model)),
        op(damped(beam)),
        dead(Vector::Zero(beam.local_unknowns())),
        rest(dead),
        motion(beam, op, own_weight ? dead.data() : nullptr),
        compliance(beam, op) {
    if (own_weight) {
      beam.add_self_weight(9.81, dead.data());
      rest = dead;
      for (Eigen::Index i = 0; i < rest.size(); ++i)
        if (beam.fixed()[i] != 0) rest[i] = 0.0;
      op.solve_static(rest.data());
    }
    v = rest;
    w = Vector::Zero(rest.size());
    base::Method method = base::esdirk4();
    method.scale_to(h);
    rule = method.stages.front();
    stages = method.stages.size();
    motion.begin(method);
  }
  static beam::Beam& damped(beam::Beam& beam) {
    beam.set_rayleigh({20.0, 1e-4});
    return beam;
  }

  int columns() const { return beam.columns(); }
  /// A smooth bump of deflection, rotation and their rates on the columns (first, past).
  void add_bump(int first, int past, double size) {
    for (int c = first; c < past; ++c) {
      const double phase = M_PI * (c - first + 0.5) / (past - first);
      v[2 * c] += size * std::sin(phase);
      v[2 * c + 1] += 0.3 * size * std::cos(phase);
      w[2 * c] += 20.0 * size * std::sin(phase);
      w[2 * c + 1] -= 6.0 * size * std::cos(phase);
    }
    for (int i = 2 * first; i < 2 * past; ++i)
      if (beam.fixed()[i] != 0) v[i] = w[i] = 0.0;
  }
  /// Of what stands on these columns alone, J.
  double energy(int first, int past) const {
    Vector dv = Vector::Zero(v.size()), dw = dv;
    dv.segment(2 * first, 2 * (past - first)) = (v - rest).segment(2 * first, 2 * (past - first));
    dw.segment(2 * first, 2 * (past - first)) = w.segment(2 * first, 2 * (past - first));
    return 0.5 * (dv.dot(test::dense(beam.beam_stiffness()) * dv) + dw.dot(test::dense(beam.mass()) * dw));
  }
  bool at_rest(int first, int past) const {
    const int from = 2 * first, count = 2 * (past - first);
    return v.segment(from, count) == rest.segment(from, count) && w.segment(from, count).isZero(0.0) &&
           Eigen::Map<const Vector>(motion.start_acceleration() + from, count).isZero(0.0);
  }

  /// The columns of the element under a force, or of its span where spans do not touch; none beside the beam.
  std::pair<int, int> columns_under(double x) const {
    if (x < 0.0 || x > beam.mesh().end()) return {0, 0};
    const int left = beam.mesh().element(beam.mesh().locate(x).element).left;
    if (op.parts() == nullptr) return {left, left + 2};
    const auto end = std::upper_bound(beam.parts().begin(), beam.parts().end(), left);
    return {end[-1], end[0]};
  }
  /// A step under a force that moves; with the window, of what moves.
  void step(double x, double speed, ActiveWindow* window) {
    if (window != nullptr) {
      const auto [low, high] = columns_under(x);
      const auto [low_end, high_end] = columns_under(x + speed * h);
      std::vector<Range> loaded = {{low, high}, {low_end, high_end}};
      merge(loaded);
      window->open(loaded, compliance.reach(rule.rate / rule.displacement, 1.0 / rule.displacement));
      motion.set_ranges(window->moving());
    }
    base::Method method = base::esdirk4();
    method.scale_to(h);
    for (std::size_t i = 0; i < stages; ++i)
      motion.solve(i, v.data(), w.data(), loads(x + speed * method.stages[i].time));
    motion.finish(v.data(), w.data());
    if (window != nullptr) window->close(motion, v.data(), w.data());
  }
  std::vector<NodalLoad> loads(double x) const {
    std::vector<NodalLoad> list;
    if (x < 0.0 || x > beam.mesh().end()) return list;
    const beam::Station at = beam.mesh().locate(x);
    const auto shape = beam::hermite(at.xi, beam.mesh().element(at.element).length);
    const auto unknowns = beam.bridge().transverse(at.element);
    for (int i = 0; i < 4; ++i)
      if (beam.fixed()[unknowns[i]] == 0) list.push_back({unknowns[i], -1e5 * shape.value[i]});
    return list;
  }

  static constexpr double h = 5e-3;
  beam::Beam beam;
  BeamOperator op;
  Vector dead, rest;
  BeamMotion motion;
  Compliance compliance;
  base::StageRule rule;
  std::size_t stages = 0;
  Vector v, w;
};

beam::BeamModel continuous() { return test::model_of(std::vector<double>(40, 20.0), 10, false); }

beam::BeamModel separate() {
  beam::BeamModel model = test::model_of(std::vector<double>(20, 20.0), 10, false);
  model.joints.assign(1, beam::Joint::separate);
  return model;
}

// ------------------------------------------------------------------------------------------------- what it closes

TEST(ActiveWindow, ClosesAroundWhatMoves) {
  Moving m(continuous());
  m.add_bump(83, 97, 1e-3);
  ActiveWindow window(m.beam, m.op, {1e-4, 1e-4}, {}, nullptr);
  window.begin(m.motion, m.v.data(), m.w.data(), {});
  EXPECT_EQ(first_of(window), 83);
  EXPECT_EQ(past_of(window), 97);
  EXPECT_EQ(window.energy_left(), 0.0);
  EXPECT_EQ(window.tolerance(), 1e-4);
}

TEST(ActiveWindow, PutsToRestWhatIsBelowItsTolerance) {
  for (double tolerance : {1e-4, 1e-6}) {
    Moving m(continuous());
    m.add_bump(83, 97, 1e-3);
    m.add_bump(32, 38, 1e-8);
    m.add_bump(152, 158, 2e-8);
    const double left = m.energy(32, 38) + m.energy(152, 158);
    ActiveWindow window(m.beam, m.op, {tolerance, tolerance}, {}, nullptr);
    window.begin(m.motion, m.v.data(), m.w.data(), {});
    if (tolerance == 1e-6) {
      EXPECT_EQ(first_of(window), 32);
      EXPECT_EQ(past_of(window), 158);
      EXPECT_EQ(window.energy_left(), 0.0);
      continue;
    }
    EXPECT_EQ(first_of(window), 83);
    EXPECT_EQ(past_of(window), 97);
    EXPECT_NEAR(window.energy_left(), left, 1e-9 * left);
    EXPECT_TRUE(m.at_rest(0, 83));
    EXPECT_TRUE(m.at_rest(97, m.columns()));
    EXPECT_GT(m.energy(83, 97), 1e6 * left);
  }
}

// Deflections, rotations and their rates each count for themselves.
TEST(ActiveWindow, LooksAtEveryKind) {
  for (int kind = 0; kind < 4; ++kind) {
    SCOPED_TRACE(kind);
    Moving m(continuous());
    m.add_bump(83, 97, 1e-3);
    Vector& x = kind < 2 ? m.v : m.w;
    double largest = 0.0;
    for (int c = 0; c < m.columns(); ++c) largest = std::max(largest, std::abs(x[2 * c + kind % 2]));
    x[2 * 44 + kind % 2] = 1.01e-4 * largest;
    x[2 * 131 + kind % 2] = -0.99e-4 * largest;
    ActiveWindow window(m.beam, m.op, {1e-4, 1e-4}, {}, nullptr);
    window.begin(m.motion, m.v.data(), m.w.data(), {});
    EXPECT_EQ(first_of(window), 44);
    EXPECT_EQ(past_of(window), 97);
  }
}

TEST(ActiveWindow, KeepsWhatIsLoadedOrWatched) {
  Moving m(continuous());
  m.add_bump(83, 97, 1e-3);
  m.add_bump(32, 38, 1e-8);
  m.add_bump(152, 158, 1e-14);
  ActiveWindow loaded(m.beam, m.op, {1e-4, 1e-4}, {}, nullptr);
  loaded.begin(m.motion, m.v.data(), m.w.data(), {{60, 120}});
  EXPECT_EQ(first_of(loaded), 60);
  EXPECT_EQ(past_of(loaded), 120);
  EXPECT_TRUE(m.at_rest(0, 60));

  m.add_bump(32, 38, 1e-8);
  ActiveWindow watching(m.beam, m.op, {1e-4, ActiveWindow::quiet}, {155, 35},
                        nullptr);  // what is there counts down to 1e-9
  watching.begin(m.motion, m.v.data(), m.w.data(), {{60, 120}});
  EXPECT_EQ(first_of(watching), 35);
  EXPECT_EQ(past_of(watching), 120);
}

TEST(ActiveWindow, ClosesWholeSpansThatDoNotTouch) {
  Moving m(separate());
  ASSERT_NE(m.op.parts(), nullptr);
  const int span = m.beam.parts()[1];
  m.add_bump(5 * span + 3, 5 * span + 7, 1e-3);
  m.add_bump(7 * span + 3, 7 * span + 7, 1e-3);
  m.add_bump(9 * span + 2, 9 * span + 5, 1e-9);
  const double left = m.energy(9 * span, 10 * span);
  ActiveWindow window(m.beam, m.op, {1e-4, 1e-4}, {}, nullptr);
  window.begin(m.motion, m.v.data(), m.w.data(), {});
  EXPECT_EQ(first_of(window), 5 * span);
  EXPECT_EQ(past_of(window), 8 * span);
  EXPECT_NEAR(window.energy_left(), left, 1e-9 * left);
}

// Under its own weight a beam at rest is deflected.
TEST(ActiveWindow, RestsUnderItsOwnWeight) {
  Moving m(continuous(), true);
  ASSERT_LT(m.rest.minCoeff(), -1e-4);
  m.add_bump(83, 97, 1e-3);
  m.add_bump(32, 38, 1e-8);
  const double left = m.energy(32, 38);
  ActiveWindow window(m.beam, m.op, {1e-4, ActiveWindow::quiet}, {}, m.rest.data());
  window.begin(m.motion, m.v.data(), m.w.data(), {});
  EXPECT_EQ(first_of(window), 83);
  EXPECT_EQ(past_of(window), 97);
  EXPECT_NEAR(window.energy_left(), left, 1e-6 * left);  // of what rounding leaves of the deflection
  EXPECT_TRUE(m.at_rest(0, 83));
}

// -------------------------------------------------------------------------------------------------- what it opens

TEST(ActiveWindow, OpensByTheReachOfTheLoads) {
  Moving m(continuous());
  ActiveWindow window(m.beam, m.op, {1e-4, 1e-4}, {}, nullptr);
  window.begin(m.motion, m.v.data(), m.w.data(), {});
  EXPECT_GE(first_of(window), past_of(window));  // nothing moves
  window.open({{60, 62}}, 10);
  EXPECT_EQ(first_of(window), 50);
  EXPECT_EQ(past_of(window), 72);
  window.open({{64, 66}}, 10);  // what moves spreads, too
  EXPECT_EQ(first_of(window), 40);
  EXPECT_EQ(past_of(window), 82);
  window.open({}, 10);  // no loads
  EXPECT_EQ(first_of(window), 30);
  EXPECT_EQ(past_of(window), 92);
  window.open({{390, 395}}, 400);
  EXPECT_EQ(first_of(window), 0);
  EXPECT_EQ(past_of(window), m.columns());
}

TEST(ActiveWindow, OpensAroundEachOfSeveralLoads) {
  Moving m(continuous());
  ActiveWindow window(m.beam, m.op, {1e-4, 1e-4}, {}, nullptr);
  window.begin(m.motion, m.v.data(), m.w.data(), {});
  window.open({{60, 62}, {200, 204}}, 10);
  EXPECT_EQ(window.moving(), (std::vector<Range>{{50, 72}, {190, 214}}));
  window.open({{60, 62}, {200, 204}}, 60);  // both feel each other
  EXPECT_EQ(window.moving(), (std::vector<Range>{{0, 274}}));
}

// Trains that have met leave a stretch between them that comes to rest.
TEST(ActiveWindow, IsPartedWhereItRestsBetweenLoads) {
  for (const bool apart : {true, false}) {
    Moving m(apart ? separate() : continuous());
    ActiveWindow window(m.beam, m.op, {1e-4, 1e-4}, {}, nullptr);
    const int span = apart ? m.beam.parts()[1] : 0;
    const std::vector<Range> loads = apart ? std::vector<Range>{{2 * span, 3 * span}, {15 * span, 16 * span}}
                                           : std::vector<Range>{{30, 34}, {300, 304}};
    window.open(loads, 5);
    window.begin(m.motion, m.v.data(), m.w.data(), loads);
    EXPECT_EQ(window.moving(), loads) << apart;
  }
}

// --------------------------------------------------------------------------------------------- against all of it

/// How far the motion in the window is from that of the whole beam under a force that crosses it, over the peak.
struct Comparison {
  double difference = 0.0, energy_left = 0.0;
  int least_first = 0, greatest_past = 0, widest = 0;
  int last_first = 0;  // when the force has left
};

Comparison compare(const beam::BeamModel& model, double tolerance, bool own_weight = false) {
  constexpr double speed = 90.0;
  const int steps = static_cast<int>(1.05 * model.length() / (speed * Moving::h));
  Moving whole(model, own_weight), part(model, own_weight);
  ActiveWindow window(part.beam, part.op, {tolerance, ActiveWindow::quiet}, {},
                      own_weight ? part.rest.data() : nullptr);
  window.begin(part.motion, part.v.data(), part.w.data(), {});
  Comparison result;
  double peak = 0.0;
  for (int i = 0; i < steps; ++i) {
    const double x = speed * Moving::h * i - 1.0;
    whole.step(x, speed, nullptr);
    part.step(x, speed, &window);
    const auto [low, high] = part.columns_under(x + speed * Moving::h);
    if (low < high) {
      EXPECT_LE(first_of(window), low);
      EXPECT_GE(past_of(window), high);
    }
    if (first_of(window) < past_of(window)) {
      EXPECT_TRUE(part.at_rest(0, first_of(window))) << i;
      EXPECT_TRUE(part.at_rest(past_of(window), part.columns())) << i;
      result.widest = std::max(result.widest, past_of(window) - first_of(window));
    }
    if (i == 100) result.greatest_past = past_of(window);
    peak = std::max(peak, (whole.v - whole.rest).cwiseAbs().maxCoeff());
    result.difference = std::max(result.difference, (part.v - whole.v).cwiseAbs().maxCoeff());
  }
  result.difference /= peak;
  result.last_first = first_of(window);
  result.energy_left = window.energy_left();
  return result;
}

TEST(ActiveWindow, OfAContinuousBeamKeepsItsTolerance) {
  double energy = 0.0;
  for (double tolerance : {1e-7, 1e-5, 1e-3}) {
    SCOPED_TRACE(tolerance);
    const Comparison c = compare(continuous(), tolerance);
    EXPECT_LT(c.difference, 2.0 * tolerance);
    EXPECT_GT(c.difference, 0.0);
    EXPECT_LT(c.greatest_past, 401);
    EXPECT_GT(c.last_first, 0);
    EXPECT_GT(c.energy_left, energy);
    energy = c.energy_left;
  }
}

TEST(ActiveWindow, OfSeparateSpansKeepsItsTolerance) {
  for (bool own_weight : {false, true}) {
    const Comparison c = compare(separate(), 1e-6, own_weight);
    EXPECT_LT(c.difference, 2e-6);
    EXPECT_LT(c.widest, 220);
    EXPECT_EQ(c.greatest_past % 11, 0);
    EXPECT_LT(c.greatest_past, 220);
  }
}

}  // namespace
}  // namespace traverse::structure
