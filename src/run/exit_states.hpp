// The state of each vehicle at the instant at which its last wheel passes an end of the beam beyond which there is no
// running surface: what a launcher is judged by.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "results/recorder.hpp"
#include "run/outputs.hpp"
#include "train/fleet.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::run {

class ExitStates {
 public:
  ExitStates() = default;
  explicit ExitStates(const scene::Scene& scene);

  /// Whether there is an end to leave, so that every instant needs the motion of all bodies.
  bool needs_bodies() const { return !ends_.empty(); }
  /// Evaluates the next observed instant t, s. Between two instants, positions and the deflections of the probes are
  /// interpolated by cubics; the tip that a guided wheel leaves has the motion of the instant before.
  void add(double t, const train::Fleet& fleet, const std::vector<recovery::Response>& probes);
  /// The exits in the order of time: /exit/time, position, velocity, and tip_deflection, tip_velocity of a probe at
  /// this end (NaN without such a probe).
  std::vector<results::Recorder::Dataset> datasets() const;
  /// Number of the vehicle and name of the body for each row.
  std::vector<std::pair<std::string, std::string>> bodies(const train::Fleet& fleet) const;
  bool empty() const { return records_.empty(); }
  void keep(base::Bytes& bytes) { bytes(before_, tips_before_, has_left_, records_, time_before_); }

 private:
  /// A coordinate or deflection and its rate.
  struct Motion {
    double value = 0.0, rate = 0.0;
  };
  struct Record {
    double time = 0.0;  // s
    int member = 0, body = 0;
    std::array<Motion, 3> motion;  // x, y (m), angle (rad)
    Motion tip;                    // m, m/s
  };
  /// An end of the beam without a surface beyond it.
  struct OpenEnd {
    double x = 0.0, outward = 1.0;  // m; 1: to the right
    int probe = -1;                 // at this end; -1: none
  };
  static Motion between(const Motion& a, const Motion& b, double h, double s);
  bool leaves_guide(const train::Member& member) const;
  double share_before_exit(const OpenEnd& end, const train::Fleet& fleet, const train::Member& member, double h) const;

  std::vector<OpenEnd> ends_;
  std::vector<std::array<Motion, 3>> before_;  // of all bodies at the last instant, vehicle by vehicle
  std::vector<Motion> tips_before_;            // one for each of ends_
  std::vector<char> has_left_;                 // one for each of the fleet's members
  std::vector<Record> records_;
  double time_before_ = 0.0;
  bool steps_end_before_exits_ = false;
};

}  // namespace traverse::run
