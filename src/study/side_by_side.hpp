// The runs of a sweep that go side by side in the lanes of the processor's vectors (lanes/crossing.hpp): one train of
// linear vehicles over the modes of the bridge, at several speeds.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "coupling/system.hpp"
#include "lanes/train_numbers.hpp"
#include "run/shared_beam.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::app {

class SideBySide {
 public:
  /// The train of a scene without lanes_obstacle, at its start. Errors as a run by itself would throw them. Scene and
  /// beam must outlive it.
  SideBySide(const Scene& scene, const SharedBeam& shared);

  /// Why these vehicles on this bridge cannot; empty: they can.
  const std::string& obstacle() const { return obstacle_; }
  struct Steps {
    structure::Method method;  // for steps of 1 s
    double longest = 0.0;      // s
  };
  /// Those that the scene asks for.
  Steps steps() const;
  /// At most lanes::widest speeds of a class (lanes/speed_class.hpp), and when each run ends.
  std::vector<lanes::CrossingResult> run(std::span<const double> speeds, std::span<const double> ends,
                                         const Steps& steps);
  /// How far the mechanisms were out of balance in a run: lanes::defect.
  double defect(const lanes::CrossingResult& result) { return lanes::defect(fleet_, result.bent); }
  /// The largest deflection at rest of each probe while the train passes, m.
  std::vector<double> static_deflection();

 private:
  std::vector<double> events(double past) const;
  void make_track(double past);

  const Scene& scene_;
  const SharedBeam& shared_;
  coupling::SystemInput input_;
  coupling::System system_;
  train::Fleet fleet_;
  std::string obstacle_;
  lanes::TrainNumbers train_;
  lanes::TrackNumbers track_;
  double track_past_ = 0.0;  // m: distance that the track is known for
  std::vector<double> q_;
  lanes::CrossingPlan plan_;
};

}  // namespace traverse::app
