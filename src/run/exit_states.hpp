// The state of each vehicle at the instant at which its last wheel passes an end of the beam beyond which there is no
// running surface, what a launcher is judged by; and when each wheel passes given places of the track with its normal
// force there, as axle load scales in the track measure it. If the speed is prescribed, these times are known in
// advance and steps end at them.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "base/bytes.hpp"
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

/// Future times at which wheels pass the places of output_passages, ascending, s.
std::vector<double> axle_passage_times(const scene::Scene& scene);

/// Records when each wheel passes given places of the track, and its normal force there.
class AxleLoadRecords {
 public:
  AxleLoadRecords() = default;
  /// time_step: the longest one, s.
  AxleLoadRecords(const scene::Scene& scene, double time_step);

  /// Evaluates the next observed instant; the first one sets the static forces.
  void add(double t, const train::Fleet& fleet);
  /// The records, for the results file.
  std::vector<results::Recorder::Dataset> datasets() const;
  /// Number of the vehicle and name of the wheel for each record.
  std::vector<std::pair<std::string, std::string>> wheels(const train::Fleet& fleet) const;
  bool empty() const { return records_.empty(); }
  void keep(base::Bytes& bytes) { bytes(records_, at_start_, next_); }

 private:
  struct Event {
    double time = 0.0, place = 0.0;  // s, m
    std::size_t wheel = 0;           // in the order of the fleet, without further contact points
  };
  struct Record {
    double time = 0.0, place = 0.0;            // s, m
    double speed = 0.0;                        // m/s
    double force = 0.0, force_at_start = 0.0;  // N, normal
    std::size_t wheel = 0;
  };
  static std::vector<Event> events_of(const scene::Scene& scene);
  friend std::vector<double> axle_passage_times(const scene::Scene& scene);

  std::vector<Event> events_;  // in the order of time
  double tolerance_ = 0.0;     // s
  std::size_t next_ = 0;
  std::vector<double> at_start_;  // N
  std::vector<Record> records_;
};

}  // namespace traverse::run
