// Track-bridge interaction of UIC 774-3: effects of temperature, a train's weight and its braking or traction on rail
// and bridge, for every position of the train: separately and added, in sequence, and at once.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "rail/rail_bridge.hpp"
#include "results/recorder.hpp"
#include "results/verdict.hpp"
#include "traverse/options/analyses.hpp"

namespace traverse::rail {

/// The largest value of a quantity over the track and all positions of the train, signed.
struct Peak {
  double value = 0.0;
  double x = 0.0;      // m
  double front = 0.0;  // position of the train's front, m

  void update(double new_value, double new_x, double new_front) {
    if (std::abs(new_value) > std::abs(value)) *this = {new_value, new_x, new_front};
  }
};

struct CaseResult {
  std::string_view name;                // name in the results file
  std::string_view words;               // name on the terminal
  bool computed = false;                // it was computed
  std::vector<double> least, greatest;  // additional stress of each rail element, Pa
  std::vector<double> least_slip,
      greatest_slip;           // displacement of the rail relative to deck or ground at each sleeper, m
  Peak tension, compression;   // Pa
  Peak slip, end;              // m; end: displacement of the running surface at deck ends
  Peak opening;                // opening of expansion devices, m
  std::vector<Peak> bearings;  // force along x of each bearing, N
  std::vector<Peak> openings;  // opening of each expansion device, m
};

/// Index in RailForces::cases_.
enum LoadCase : std::size_t { temperature, bending, braking, traction, separate, in_sequence, at_once, case_count };

class RailForces {
 public:
  RailForces(const beam::BeamModel& model, const options::RailLoads& loads);

  const CaseResult& of(LoadCase load_case) const { return cases_[load_case]; }
  const RailBridge& bridge() const { return bridge_; }
  /// Largest |sum of all forces along x| of all states, relative to the largest force.
  double residual() const { return residual_; }

  /// Sets the quantities of the limits that are evaluated here.
  void find(std::vector<results::Verdict>& verdicts) const;
  void print() const;
  /// /rail_forces of the results file.
  void record(results::Recorder& recorder) const;

 private:
  /// The loads of a train with its front at x that runs in a direction, 1 or -1.
  Loads train_loads(double front, double direction) const;
  Loads with_longitudinal_force(Loads train, double direction, bool brakes) const;
  State equilibrium(const Loads& loads, const State* earlier = nullptr);
  void update(LoadCase which, const State& state, double front);
  void update_stress(LoadCase which, const std::vector<double>& stress, double front);
  void update_sum(const State& a, const State& b, const State* c, double front);
  void compute_position(double front, double direction);

  options::RailLoads loads_;
  RailBridge bridge_;
  State thermal_;  // state under temperature only
  std::vector<CaseResult> cases_;
  double length_;  // length of the bridge, m
  double residual_ = 0.0;
};

}  // namespace traverse::rail
