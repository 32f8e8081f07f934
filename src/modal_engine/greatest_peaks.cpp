// Bounds of all runs first. Then the runs with the largest bounds, which probably have the greatest peaks, and at last
// all runs whose bounds exceed these peaks.
#include "modal_engine/greatest_peaks.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "engine/speed_class.hpp"

namespace traverse::modal_engine {
namespace {

constexpr double not_known = std::numeric_limits<double>::quiet_NaN();
// Peaks that equal the greatest one are found, so that the earliest of them is the same in any order of the runs.
constexpr double not_quite = 1.0 - 1e-12;

/// Replaces a peak by a greater one, or by the earlier one of two that are equal.
void take_greater(base::Extreme& peak, const base::Extreme& other) {
  if (other.value == peak.value) peak.time = std::min(peak.time, other.time);
  if (std::isnan(peak.value) || other.value > peak.value) peak = other;
}

class GreatestPeaks {
 public:
  GreatestPeaks(const std::vector<const MovingForcePassages*>& trains, std::span<const ForceRun> runs, double samples,
                std::size_t width, const std::function<bool()>& proceed)
      : trains_(trains),
        runs_(runs),
        samples_(samples),
        width_(width),
        proceed_(proceed),
        bounds_(runs.size()),
        done_(runs.size()) {}

  std::vector<std::vector<base::ProbePeaks>> find() {
    find_bounds();
    if (stopped_) return {};
    const std::size_t probes = bounds_.front().size();
    const base::Extreme none{not_known, not_known};
    greatest_.assign(trains_.size(), std::vector<base::ProbePeaks>(probes, {none, none, none}));
    constexpr base::Extreme below_all{-1.0, 0.0};
    least_.assign(probes, {below_all, below_all, below_all});
    amplification_.assign(probes, 0.0);
    compute(leaders());
    compute(others());
    if (stopped_) return {};
    return std::move(greatest_);
  }

 private:
  using Batch = std::vector<std::size_t>;  // indices of runs

  /// Runs of the same train and the same class or octave, in batches.
  std::vector<Batch> batches(const std::vector<std::size_t>& runs, int (*class_of)(double)) const {
    std::map<std::pair<std::size_t, int>, std::vector<Batch>> found;
    for (const std::size_t run : runs) {
      std::vector<Batch>& own = found[{runs_[run].train, class_of(runs_[run].speed)}];
      if (own.empty() || own.back().size() == width_) own.emplace_back();
      own.back().push_back(run);
    }
    std::vector<Batch> all;
    for (auto& [key, own] : found) std::move(own.begin(), own.end(), std::back_inserter(all));
    return all;
  }
  void set_speeds(const Batch& batch) {
    speeds_.clear();
    ends_.clear();
    for (const std::size_t run : batch) {
      speeds_.push_back(runs_[run].speed);
      ends_.push_back(runs_[run].end);
    }
  }

  void find_bounds() {
    std::vector<std::size_t> all(runs_.size());
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
    for (const Batch& batch : batches(all, engine::speed_octave)) {
      set_speeds(batch);
      auto bounds = trains_[runs_[batch.front()].train]->bounds(speeds_, ends_, samples_, proceed_);
      stopped_ = stopped_ || bounds.empty();
      if (stopped_) return;
      for (std::size_t i = 0; i < batch.size(); ++i) bounds_[batch[i]] = std::move(bounds[i]);
    }
  }

  double static_deflection(std::size_t train, std::size_t probe) const { return trains_[train]->static_peaks()[probe]; }

  /// The runs with the largest bounds of the responses and of the ratios to static deflections.
  std::vector<std::size_t> leaders() const {
    std::vector<std::size_t> found;
    const auto add_largest = [&](auto bound) {
      std::size_t largest = 0;
      for (std::size_t run = 1; run < runs_.size(); ++run)
        if (bound(run) > bound(largest)) largest = run;
      if (std::find(found.begin(), found.end(), largest) == found.end()) found.push_back(largest);
    };
    for (std::size_t p = 0; p < bounds_.front().size(); ++p) {
      for (const auto response : responses)
        add_largest([&](std::size_t run) { return (bounds_[run][p].*response).value; });
      add_largest(
          [&](std::size_t run) { return bounds_[run][p].deflection.value / static_deflection(runs_[run].train, p); });
    }
    return found;
  }

  /// Peaks of a train that are of interest: those above the greatest so far.
  std::vector<base::ProbePeaks> least_of(std::size_t train) const {
    std::vector<base::ProbePeaks> least = least_;
    for (std::size_t p = 0; p < least.size(); ++p) {
      double& deflection = least[p].deflection.value;
      deflection = std::min(deflection, amplification_[p] * static_deflection(train, p));
      for (const auto response : responses) (least[p].*response).value *= not_quite;
    }
    return least;
  }
  /// The other runs that may have greater peaks.
  std::vector<std::size_t> others() const {
    std::vector<std::vector<base::ProbePeaks>> least;
    for (std::size_t train = 0; train < trains_.size(); ++train) least.push_back(least_of(train));
    std::vector<std::size_t> found;
    for (std::size_t run = 0; run < runs_.size(); ++run)
      if (!done_[run] && exceeds(bounds_[run], least[runs_[run].train])) found.push_back(run);
    return found;
  }
  static bool exceeds(const std::vector<base::ProbePeaks>& bounds, const std::vector<base::ProbePeaks>& least) {
    for (std::size_t p = 0; p < least.size(); ++p)
      for (const auto response : responses)
        if ((bounds[p].*response).value > (least[p].*response).value) return true;
    return false;
  }

  void compute(const std::vector<std::size_t>& runs) {
    for (const Batch& batch : batches(runs, engine::speed_class)) {
      const std::size_t train = runs_[batch.front()].train;
      set_speeds(batch);
      const auto peaks = trains_[train]->peaks(speeds_, ends_, samples_, proceed_, least_of(train));
      stopped_ = stopped_ || peaks.empty();
      if (stopped_) return;
      for (const std::vector<base::ProbePeaks>& run : peaks) add(train, run);
      for (const std::size_t run : batch) done_[run] = 1;
    }
  }
  void add(std::size_t train, const std::vector<base::ProbePeaks>& run) {
    for (std::size_t p = 0; p < run.size(); ++p) {
      for (const auto response : responses) {
        take_greater(greatest_[train][p].*response, run[p].*response);
        if ((run[p].*response).value > (least_[p].*response).value) least_[p].*response = run[p].*response;
      }
      const double at_rest = static_deflection(train, p);
      if (at_rest > 0.0 && run[p].deflection.value / at_rest > amplification_[p])
        amplification_[p] = run[p].deflection.value / at_rest;
    }
  }

  const std::vector<const MovingForcePassages*>& trains_;
  std::span<const ForceRun> runs_;
  double samples_;
  std::size_t width_;
  const std::function<bool()>& proceed_;
  std::vector<std::vector<base::ProbePeaks>> bounds_, greatest_;  // of each run, of each train
  std::vector<char> done_;
  std::vector<base::ProbePeaks> least_;  // the greatest peaks so far
  std::vector<double> amplification_;    // the greatest ratios so far
  std::vector<double> speeds_, ends_;
  bool stopped_ = false;
};

}  // namespace

std::vector<std::vector<base::ProbePeaks>> greatest_peaks(const std::vector<const MovingForcePassages*>& trains,
                                                          std::span<const ForceRun> runs, double samples,
                                                          std::size_t width, const std::function<bool()>& proceed) {
  return GreatestPeaks(trains, runs, samples, width, proceed).find();
}

}  // namespace traverse::modal_engine
