// Records when each wheel passes given places of the track, and its normal force there, as axle load scales in the
// track measure it. If the speed is prescribed, the times are known in advance and steps end at them.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "base/bytes.hpp"
#include "results/recorder.hpp"
#include "train/fleet.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::run {

/// Future times at which wheels pass the places of output_passages, ascending, s.
std::vector<double> axle_passage_times(const scene::Scene& scene);

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
