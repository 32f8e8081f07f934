// Passages of moving forces side by side (modal_engine/moving_force_batch.hpp): against the exact motion of each run by
// itself, seen at instants far closer, and that what is beside a run does not change it.
#include "modal_engine/moving_force_batch.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include "engine/speed_class.hpp"
#include "integrate/modal_motion.hpp"
#include "support/curve.hpp"

namespace traverse::test {
namespace {

using Peak = base::Extreme;
using base::ProbePeaks;
using ResponseExtremes = std::vector<ProbePeaks>;

const std::vector<double> speeds = {38.1, 39.0, 40.25, 41.0, 42.0, 43.0, 44.5, 45.2};  // m/s, of one class

struct Case {
  const char* name;
  std::vector<double> spans;
  std::vector<beam::Support> supports;
  std::vector<beam::Joint> joints;
  int modes;
  std::vector<double> ratios;  // empty: Rayleigh damping
  std::vector<double> probes, positions;
  bool equilibrium;
  double gravity, until;  // m/s2; m travelled when the slowest run ends
};
/// s: each run ends at a distance of its own.
double end_of(const Case& c, double speed) { return c.until * (1.0 - 0.04 * (speed - speeds.front())) / speed; }

void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

constexpr auto pinned = beam::Support::pinned, roller = beam::Support::roller;
const std::vector<double> axles = {0.0, -3.0, -14.0, -17.0};  // m

const std::vector<Case> cases = {
    {"TwoSpans", {20, 20}, {pinned, roller, roller}, {}, 3, {0.01}, {4, 9, 10, 13.3, 20, 31}, axles, true, 0, 97},
    {"ASpanEach", {18, 22}, {pinned, roller, roller}, {beam::Joint::hinge}, 4, {0.02}, {9, 29}, axles, true, 0, 97},
    {"OverdampedMode",
     {25},
     {pinned, roller},
     {},
     6,
     {0.01, 0.02, 0.1, 0.9, 0.99, 50.0},
     {6, 12.5},
     axles,
     true,
     0,
     82},
    {"RayleighOverdamped", {25}, {pinned, roller}, {}, 6, {}, {6, 12.5}, axles, true, 0, 82},
    {"StartsOnTheBridge", {25}, {pinned, roller}, {}, 3, {0.01}, {7, 12.5}, {12.0, 3.0, -9.0}, true, 0, 74},
    {"StartsUndeflected", {25}, {pinned, roller}, {}, 3, {0.01}, {7, 12.5}, {12.0, 3.0, -9.0}, false, 0, 74},
    {"EndsAsForcesPass", {25}, {pinned, roller}, {}, 3, {0.01}, {7, 12.5}, axles, true, 0, 9.77},
    {"FreeEnd", {10}, {beam::Support::clamped, beam::Support::free}, {}, 3, {0.02}, {5, 10}, axles, true, 0, 40},
    {"OwnWeight", {25}, {pinned, roller}, {}, 3, {0.01}, {7, 12.5}, axles, true, 9.81, 60},
};

class Bridge {
 public:
  explicit Bridge(const Case& c) : load_{std::vector<double>(c.positions.size(), 2e5), c.positions, 40.0} {
    beam::BeamModel model;
    model.spans = c.spans;
    model.elements.assign(c.spans.size(), 10);
    model.EI = 3e10;
    model.mass = 1.8e4;
    model.supports = c.supports;
    model.joints = c.joints;
    model.axial = false;
    beam_ = std::make_unique<beam::Beam>(PETSC_COMM_SELF, model);
    beam_->set_rayleigh(c.ratios.empty() ? beam::Rayleigh{0.5, 4e-3} : beam::Rayleigh{});
    statics_ = std::make_unique<structure::BeamOperator>(*beam_);
    modal_ = std::make_unique<structure::ModalBridge>(*beam_, *statics_, c.modes, c.ratios);
    modal_->add_probes(c.probes, c.gravity);
  }

  const structure::ModalBridge& modal() const { return *modal_; }
  const train::MovingLoad& load() const { return load_; }

 private:
  std::unique_ptr<beam::Beam> beam_;
  std::unique_ptr<structure::BeamOperator> statics_;
  std::unique_ptr<structure::ModalBridge> modal_;
  train::MovingLoad load_;
};

void note(double value, double time, Peak& peak) {
  if (std::abs(value) > peak.value) peak = {std::abs(value), time};
}

/// The largest responses at instants so many a period of the fastest mode, and just before and after every event.
ResponseExtremes seen_closely(const Bridge& bridge, const Case& c, double speed, double instants) {
  const structure::ModalBridge& modal = bridge.modal();
  const structure::ModalProbes& probes = modal.probes();
  const integrate::ForceHistory history(modal.influence(), bridge.load());
  integrate::ModalMotion motion(modal, history, speed, c.equilibrium);
  const std::size_t n = probes.count;
  ResponseExtremes peaks(n);
  const auto look = [&] {
    std::vector<double> predicted(2 * n, 0.0);
    motion.add_channels(modal.modes(), 2 * n, predicted.data());
    for (std::size_t p = 0; p < n; ++p) {
      double deflection = probes.weight_deflection[p] + predicted[p], acceleration = 0.0;
      double moment = probes.weight_moment[p] + predicted[n + p];
      for (std::size_t i = 0; i < modal.modes(); ++i) {
        const std::size_t at = i * n + p;
        deflection += probes.deflection[at] * motion.q()[i];
        acceleration += probes.deflection[at] * motion.acceleration()[i];
        moment += probes.moment[at] * motion.q()[i] + probes.moment_by_rate[at] * motion.rate()[i] +
                  probes.moment_by_acceleration[at] * motion.acceleration()[i];
      }
      note(deflection, motion.time(), peaks[p].deflection);
      note(acceleration, motion.time(), peaks[p].acceleration);
      note(moment, motion.time(), peaks[p].moment);
    }
  };
  const double fastest = *std::max_element(modal.omega().begin(), modal.omega().end());
  const double interval = 2.0 * std::numbers::pi / fastest / instants, end = end_of(c, speed);
  look();
  for (double next = interval; motion.time() < end;) {
    motion.advance(std::min({next, end, motion.next_event()}));
    look();
    if (motion.time() >= next) next += interval;
    if (motion.time() < motion.next_event() || motion.time() >= end) continue;
    motion.pass_event();
    motion.advance(motion.time());  // sees what has jumped
    look();
  }
  return peaks;
}

std::vector<double> ends_of(const Case& c, const std::vector<double>& of) {
  std::vector<double> ends;
  for (const double speed : of) ends.push_back(end_of(c, speed));
  return ends;
}

std::vector<ResponseExtremes> side_by_side(const Bridge& bridge, const Case& c, const std::vector<double>& of,
                                           double instants) {
  const modal_engine::MovingForcePassages passages(bridge.modal(), bridge.load(), c.equilibrium);
  return passages.peaks(of, ends_of(c, of), instants, [] { return true; });
}

constexpr auto quantities = {&ProbePeaks::deflection, &ProbePeaks::acceleration, &ProbePeaks::moment};

/// The largest of all probes.
double largest(const ResponseExtremes& peaks, Peak ProbePeaks::*quantity) {
  double value = 0.0;
  for (const ProbePeaks& p : peaks) value = std::max(value, (p.*quantity).value);
  return value;
}

/// The largest difference, of the largest of all probes.
double difference(const ResponseExtremes& a, const ResponseExtremes& b) {
  double worst = 0.0;
  for (const auto quantity : quantities)
    for (std::size_t p = 0; p < a.size(); ++p)
      worst = std::max(worst, std::abs((a[p].*quantity).value - (b[p].*quantity).value) / largest(b, quantity));
  return worst;
}

class MovingForcePassages : public testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(Bridges, MovingForcePassages, testing::ValuesIn(cases),
                         [](const auto& bridge) { return std::string(bridge.param.name); });

TEST_P(MovingForcePassages, AgainstTheExactMotion) {
  const Case& c = GetParam();
  const Bridge bridge(c);
  const std::vector<ResponseExtremes> usual = side_by_side(bridge, c, speeds, 20.0),
                                      fine = side_by_side(bridge, c, speeds, 200.0);
  for (const std::size_t i : {0u, 3u, 7u}) {
    const ResponseExtremes exact = seen_closely(bridge, c, speeds[i], 2000.0);
    EXPECT_LT(difference(usual[i], exact), 5e-3) << speeds[i];
    EXPECT_LT(difference(fine[i], exact), 1e-5) << speeds[i];
    for (const auto quantity : quantities)
      for (std::size_t p = 0; p < exact.size(); ++p) {
        const Peak found = fine[i][p].*quantity, expected = exact[p].*quantity;
        EXPECT_GE(found.time, 0.0);
        EXPECT_LE(found.time, end_of(c, speeds[i]) * (1.0 + 1e-9));
        if (expected.value > 0.1 * largest(exact, quantity)) {
          EXPECT_NEAR(found.time, expected.time, 2e-4) << p;
        }
      }
  }
}

// Alone, beside three, beside seven: each run is the same, whatever else ends earlier or later than it.
TEST_P(MovingForcePassages, NeighboursChangeNothing) {
  const Case& c = GetParam();
  const Bridge bridge(c);
  const std::vector<ResponseExtremes> eight = side_by_side(bridge, c, speeds, 20.0);
  for (std::size_t i = 0; i < speeds.size(); ++i) {
    const std::vector<double> reversed = {speeds[7 - i], speeds[i], speeds[0]};
    for (const ResponseExtremes& other :
         {side_by_side(bridge, c, {speeds[i]}, 20.0)[0], side_by_side(bridge, c, reversed, 20.0)[1]}) {
      EXPECT_LT(difference(other, eight[i]), 1e-12);
      for (const auto quantity : quantities)
        for (std::size_t p = 0; p < other.size(); ++p)
          if ((other[p].*quantity).value > 0.1 * largest(other, quantity)) {
            EXPECT_NEAR((other[p].*quantity).time, (eight[i][p].*quantity).time, 1e-9);
          }
    }
  }
}

// Bounds are numbers that no peak exceeds, and that are of use: close to the largest peak where damping is usual.
TEST_P(MovingForcePassages, NoPeakExceedsItsBound) {
  const Case& c = GetParam();
  const Bridge bridge(c);
  const modal_engine::MovingForcePassages passages(bridge.modal(), bridge.load(), c.equilibrium);
  const auto bounds = passages.bounds(speeds, ends_of(c, speeds), 20.0, [] { return true; });
  const std::vector<ResponseExtremes> fine = side_by_side(bridge, c, speeds, 200.0);
  const bool usual = *std::max_element(bridge.modal().sigma().begin(), bridge.modal().sigma().end()) <
                     0.1 * bridge.modal().omega().back();
  for (std::size_t i = 0; i < speeds.size(); ++i)
    for (const auto quantity : quantities) {
      for (std::size_t p = 0; p < c.probes.size(); ++p)
        EXPECT_GE((bounds[i][p].*quantity).value, (fine[i][p].*quantity).value) << speeds[i] << " " << p;
      if (!usual) continue;
      EXPECT_LT(largest(bounds[i], quantity) / largest(fine[i], quantity), 2.5) << speeds[i];
    }
}

// Peaks above the limit of interest are the same numbers as without one; others are not searched for.
TEST_P(MovingForcePassages, SmallPeaksAreLeftOut) {
  const Case& c = GetParam();
  const Bridge bridge(c);
  const modal_engine::MovingForcePassages passages(bridge.modal(), bridge.load(), c.equilibrium);
  const auto go_on = [] { return true; };
  const std::vector<ResponseExtremes> all = passages.peaks(speeds, ends_of(c, speeds), 20.0, go_on);
  ResponseExtremes least = all[3];
  const std::vector<ResponseExtremes> large = passages.peaks(speeds, ends_of(c, speeds), 20.0, go_on, least);
  for (std::size_t i = 0; i < speeds.size(); ++i)
    for (std::size_t p = 0; p < least.size(); ++p)
      for (const auto quantity : quantities) {
        const Peak expected = all[i][p].*quantity, found = large[i][p].*quantity;
        if (expected.value > (least[p].*quantity).value) {
          EXPECT_EQ(found.value, expected.value);
          EXPECT_EQ(found.time, expected.time);
        } else {
          EXPECT_TRUE(std::isnan(found.value)) << found.value << " of " << expected.value;
        }
      }
}

TEST(MovingForcePassages, StopsWhenItIsTold) {
  const Case& c = cases.front();
  const Bridge bridge(c);
  const modal_engine::MovingForcePassages passages(bridge.modal(), bridge.load(), true);
  int asked = 0;
  const auto twice = [&] { return ++asked <= 2; };
  EXPECT_TRUE(passages.peaks(std::vector<double>{40.0}, std::vector<double>{1e6}, 20.0, twice).empty());
  EXPECT_EQ(asked, 3);
}

TEST(SpeedClass, HoldsItsSpeeds) {
  for (const double speed : {1.0, 27.8, 38.0546276800871, 100.0, 128.0}) {
    const int number = engine::speed_class(speed);
    EXPECT_LE(engine::speed_of_class(number), speed * (1.0 + 1e-9));
    EXPECT_GT(engine::speed_of_class(number + 1), speed * (1.0 + 1e-9));
  }
  for (const double speed : speeds) EXPECT_EQ(engine::speed_class(speed), engine::speed_class(speeds.front()));
}

}  // namespace
}  // namespace traverse::test
