// When each wheel passes given places of the track, and the force that it presses with there, as scales in a track
// weigh a train that goes over them. A train whose speed is prescribed passes at times known beforehand, at which steps
// end.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "base/bytes.hpp"
#include "results/recorder.hpp"
#include "train/fleet.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::app {

/// Times at which wheels pass the places of output_passages, ascending, s; as far as these are ahead of them.
std::vector<double> axle_passage_times(const Scene& scene);

class AxleLoadRecords {
 public:
  AxleLoadRecords() = default;
  /// time_step: the longest, s.
  AxleLoadRecords(const Scene& scene, double time_step);

  /// The next instant that was observed; the first one tells the forces at rest.
  void add(double t, const train::Fleet& fleet);
  /// What has been found, for the results file.
  std::vector<results::Recorder::Dataset> datasets() const;
  /// Number of the vehicle and name of the wheel, a row a passage.
  std::vector<std::pair<std::string, std::string>> wheels(const train::Fleet& fleet) const;
  bool empty() const { return found_.empty(); }
  void keep(base::Bytes& bytes) { bytes(found_, at_start_, next_); }

 private:
  struct Due {
    double time = 0.0, place = 0.0;  // s, m
    std::size_t wheel = 0;           // in the order of the fleet, without further points of contact
  };
  struct Found {
    double time = 0.0, place = 0.0;            // s, m
    double speed = 0.0;                        // m/s
    double force = 0.0, force_at_start = 0.0;  // N, normal
    std::size_t wheel = 0;
  };
  static std::vector<Due> due_of(const Scene& scene);
  friend std::vector<double> axle_passage_times(const Scene& scene);

  std::vector<Due> due_;    // in the order of their times
  double tolerance_ = 0.0;  // s
  std::size_t next_ = 0;
  std::vector<double> at_start_;  // N
  std::vector<Found> found_;
};

}  // namespace traverse::app
