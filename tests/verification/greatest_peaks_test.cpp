// The greatest peaks of many runs of several trains (modal_engine/greatest_peaks.hpp) against the greatest of all runs,
// each computed by itself.
#include "modal_engine/greatest_peaks.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

namespace traverse::test {
namespace {

using modal_engine::MovingForcePassages;
using Peaks = std::vector<base::ProbePeaks>;

constexpr std::array quantities = {&base::ProbePeaks::deflection, &base::ProbePeaks::acceleration,
                                   &base::ProbePeaks::moment};

class GreatestPeaks : public testing::Test {
 protected:
  GreatestPeaks() {
    beam::BeamModel model;
    model.spans = {20.0, 20.0};
    model.elements = {10, 10};
    model.EI = 3e10;
    model.mass = 1.2e4;
    model.supports = {beam::Support::pinned, beam::Support::roller, beam::Support::roller};
    model.axial = false;
    beam_ = std::make_unique<beam::Beam>(PETSC_COMM_SELF, model);
    statics_ = std::make_unique<structure::BeamOperator>(*beam_);
    modal_ = std::make_unique<structure::ModalBridge>(*beam_, *statics_, 4, std::vector<double>{0.01});
    modal_->add_probes({10.0, 20.0, 33.0}, 9.81);  // the second one is on a support
    for (const double spacing : {13.0, 18.0, 27.0}) {
      train::MovingLoad load;
      for (int k = 0; k < 12; ++k)
        for (const double axle : {0.0, -2.5}) load.positions.push_back(axle - k * spacing);
      load.forces.assign(load.positions.size(), 1.7e5);
      load.speed = 40.0;
      ends_.push_back(40.0 - load.positions.back());
      trains_.push_back(std::make_unique<MovingForcePassages>(*modal_, load, true));
      passages_.push_back(trains_.back().get());
    }
    for (std::size_t train = 0; train < trains_.size(); ++train)
      for (double speed = 21.0; speed < 90.0; speed *= 1.02) runs_.push_back({train, speed, ends_[train] / speed});
  }

  /// The greatest of all trains, with the earliest time of equal ones.
  static base::Extreme greatest(const std::vector<Peaks>& peaks, std::size_t probe,
                                base::Extreme base::ProbePeaks::*quantity) {
    base::Extreme found{-1.0, 0.0};
    for (const Peaks& one : peaks) {
      const base::Extreme& peak = one[probe].*quantity;
      if (peak.value > found.value || (peak.value == found.value && peak.time < found.time)) found = peak;
    }
    return found;
  }
  std::vector<Peaks> found(const std::vector<modal_engine::ForceRun>& runs) const {
    return modal_engine::greatest_peaks(passages_, runs, 20.0, 8, [] { return true; });
  }

  std::unique_ptr<beam::Beam> beam_;
  std::unique_ptr<structure::BeamOperator> statics_;
  std::unique_ptr<structure::ModalBridge> modal_;
  std::vector<std::unique_ptr<MovingForcePassages>> trains_;
  std::vector<const MovingForcePassages*> passages_;
  std::vector<double> ends_;
  std::vector<modal_engine::ForceRun> runs_;
};

TEST_F(GreatestPeaks, AreThoseOfAllRuns) {
  std::vector<Peaks> all;
  for (const modal_engine::ForceRun& run : runs_)
    all.push_back(
        passages_[run.train]->peaks(std::vector{run.speed}, std::vector{run.end}, 20.0, [] { return true; })[0]);
  const std::vector<Peaks> some = found(runs_);
  ASSERT_EQ(some.size(), 3u);
  for (std::size_t p = 0; p < 3; ++p) {
    for (const auto quantity : quantities) {
      const base::Extreme expected = greatest(all, p, quantity), peak = greatest(some, p, quantity);
      EXPECT_NEAR(peak.value, expected.value, 1e-12 * expected.value) << p;  // another width of the batch
      EXPECT_NEAR(peak.time, expected.time, 1e-9) << p;
    }
    double expected = 0.0, ratio = 0.0;  // of dynamic to static deflections
    for (std::size_t run = 0; run < all.size(); ++run)
      expected = std::fmax(expected, all[run][p].deflection.value / passages_[runs_[run].train]->static_peaks()[p]);
    for (std::size_t train = 0; train < 3; ++train)
      ratio = std::fmax(ratio, some[train][p].deflection.value / passages_[train]->static_peaks()[p]);
    if (p != 1) {
      EXPECT_NEAR(ratio, expected, 1e-12 * expected) << p;
    }
  }
}

TEST_F(GreatestPeaks, DoNotDependOnTheOrder) {
  const std::vector<Peaks> forward = found(runs_);
  std::vector<modal_engine::ForceRun> runs = runs_;
  std::reverse(runs.begin(), runs.end());
  std::swap(runs[3], runs[50]);
  const std::vector<Peaks> other = found(runs);
  for (std::size_t p = 0; p < 3; ++p)
    for (const auto quantity : quantities) {
      EXPECT_EQ(greatest(other, p, quantity).value, greatest(forward, p, quantity).value) << p;
      EXPECT_EQ(greatest(other, p, quantity).time, greatest(forward, p, quantity).time) << p;
    }
}

// Of two equal trains both have the greatest peaks.
TEST_F(GreatestPeaks, EqualOnesAreAllFound) {
  std::vector<modal_engine::ForceRun> runs = runs_;
  passages_.push_back(passages_[1]);
  for (const modal_engine::ForceRun& run : runs_)
    if (run.train == 1) runs.push_back({3, run.speed, run.end});
  const std::vector<Peaks> peaks = found(runs);
  bool one_is_greatest = false;
  for (const auto quantity : quantities) {
    const base::Extreme all = greatest(peaks, 0, quantity);
    if ((peaks[1][0].*quantity).value != all.value) continue;
    one_is_greatest = true;
    EXPECT_EQ((peaks[3][0].*quantity).value, all.value);
    EXPECT_EQ((peaks[3][0].*quantity).time, (peaks[1][0].*quantity).time);
  }
  EXPECT_TRUE(one_is_greatest);
}

}  // namespace
}  // namespace traverse::test
