// The heights of the running surfaces, over the part of the track that the wheels of a run have run on.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "base/bytes.hpp"
#include "results/recorder.hpp"
#include "train/fleet.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::run {

class ProfileRecord {
 public:
  ProfileRecord() = default;
  /// Throws InputError if output_profile would store too many stations of a run until `end`, s.
  ProfileRecord(const scene::Scene& scene, const train::Fleet& fleet, double end);

  /// Evaluates the next observed instant.
  void add(const train::Fleet& fleet);
  /// x and height of each surface that is not level: /track/profile, or /track/profile_of/NAME if it is that of a
  /// train alone.
  std::vector<results::Recorder::Dataset> datasets() const;
  void keep(base::Bytes& bytes) { bytes(from_, to_); }

 private:
  struct Surface {
    const track::Profile* profile;
    std::string group;
    double spacing;  // m, of the stations
  };

  std::vector<Surface> surfaces_;
  std::vector<int> surface_of_;    // of each of Fleet::wheels; -1: level
  std::vector<double> from_, to_;  // m: least and greatest x of the wheels on each surface
};

}  // namespace traverse::run
