// UIC 774-3: what temperature, a train's weight and its braking or traction do to rail and bridge, for every place of
// the train: each by itself and added up, one after the other as they come, and all at once.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "rail/rail_bridge.hpp"
#include "results/recorder.hpp"
#include "results/verdict.hpp"
#include "traverse/options/rail_loads.hpp"

namespace traverse::rail {

/// The largest of a quantity over the track and over all places of the train, signed.
struct Peak {
  double value = 0.0;
  double x = 0.0;      // m
  double front = 0.0;  // m, of the train

  void see(double its_value, double its_x, double its_front) {
    if (std::abs(its_value) > std::abs(value)) *this = {its_value, its_x, its_front};
  }
};

struct Case {
  std::string_view name;                          // in the results file
  std::string_view words;                         // on the terminal
  bool there = false;                             // it was computed
  std::vector<double> least, greatest;            // Pa, of each rail element: additional stress
  std::vector<double> least_slip, greatest_slip;  // m, of each sleeper: the rail against deck or ground
  Peak tension, compression;                      // Pa
  Peak slip, end;                                 // m, the latter of the running surface at deck ends
  Peak opening;                                   // m, of expansion devices
  std::vector<Peak> bearings;                     // N along x, of each
  std::vector<Peak> openings;                     // m, of each expansion device
};

/// In the order of RailForces::cases.
enum Which : std::size_t { temperature, bending, braking, traction, separate, in_sequence, at_once, case_count };

class RailForces {
 public:
  RailForces(const beam::BeamModel& model, const options::RailLoads& loads);

  const Case& of(Which which) const { return cases_[which]; }
  const RailBridge& bridge() const { return bridge_; }
  /// Largest |sum of all forces along x| over the largest force, of all states.
  double residual() const { return residual_; }

  /// Puts findings in the place of those of limits that this finds.
  void find(std::vector<results::Verdict>& verdicts) const;
  void print() const;
  /// /rail_forces of the file.
  void record(results::Recorder& recorder) const;

 private:
  /// A train of which the front is at x and which runs in a direction, 1 or -1.
  Loads standing(double front, double direction) const;
  Loads acting(Loads train, double direction, bool brakes) const;
  State rest(const Loads& loads, const State* before = nullptr);
  void see(Which which, const State& state, double front);
  void observe_stress(Which which, const std::vector<double>& stress, double front);
  void observe_sum(const State& a, const State& b, const State* c, double front);
  void stand(double front, double direction);

  options::RailLoads loads_;
  RailBridge bridge_;
  State warm_;  // under temperature alone
  std::vector<Case> cases_;
  double length_;  // m, of the bridge
  double residual_ = 0.0;
};

}  // namespace traverse::rail
