// The runs of a sweep or a study that go side by side in the lanes of the processor's vectors (engine/batch.hpp): one
// train of linear vehicles over a bridge, at several speeds and over several tracks.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "coupling/system.hpp"
#include "engine/batch.hpp"
#include "run/shared_beam.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::app {

/// What is one run's own.
struct LaneRun {
  double speed = 0.0, end = 0.0;      // m/s; s: when it ends
  std::optional<std::uint64_t> seed;  // of its track; none: the scene's own
};

/// Of the runs of a sweep, for steps of 1 s.
structure::Method method_of(const Scene& scene);

class CaseBatch {
 public:
  /// The train of a scene without batch_obstacle, at its start. Errors as a run by itself would throw them. Scene and
  /// beam must outlive it.
  CaseBatch(const Scene& scene, const SharedBeam& shared);

  /// Why these vehicles on this bridge cannot; empty: they can.
  const std::string& obstacle() const { return obstacle_; }
  struct Steps {
    structure::Method method;  // for steps of 1 s
    double longest = 0.0;      // s
    bool trial = false;        // all runs go equally far, and are to be seen there exactly; one may go by itself
    bool keeps = false;        // accelerations at places `spacing` apart, where steps end too
  };
  /// Those that the scene asks for.
  Steps steps() const;
  /// Tracks shall be known at once for all runs up to this distance gone (m), so that none depends on which runs come
  /// first. Returns what on this way runs side by side cannot follow, in words; empty: nothing.
  std::string expect(double past);
  /// Runs that any thread may take, while others take theirs; their trains must outlive it.
  class Ready {
   public:
    std::vector<engine::BatchResult> run() const;

   private:
    friend class CaseBatch;
    void stretch(const std::vector<double>& events, double ds, double past, const Steps& steps);

    engine::BatchPlan plan_;
    std::vector<std::shared_ptr<const track::HeightTable>> tracks_;
    std::vector<engine::BatchRun> runs_;
  };
  /// At most engine::widest runs with speeds of a class (engine/speed_class.hpp).
  Ready ready(std::span<const LaneRun> runs, const Steps& steps);
  /// m: between the places where runs of the class of such a speed keep accelerations.
  static double spacing(const Steps& steps, double speed);
  /// The same of runs whose trains have numbers of their own; those of different trains have joined one and the same.
  struct Member {
    CaseBatch* lanes;
    LaneRun run;
  };
  static Ready ready(std::span<const Member> members, const Steps& steps);
  /// From now on its runs may go beside those of another scene on the same bridge: what all lanes have in common it
  /// takes from there. False where the trains differ in more than numbers.
  bool merge(const CaseBatch& other);
  /// How far the mechanisms were out of balance in a run, at most, over their weight (train::linearisation_residual).
  double defect(const engine::BatchResult& result);
  /// The largest deflection at rest of each probe while the train passes, m.
  std::vector<double> static_deflection();

 private:
  const structure::ModalBridge* modal() const { return shared_.modal ? &*shared_.modal : nullptr; }
  std::vector<double> events(double past) const;
  std::pair<double, double> track_reach() const;
  using Track = std::shared_ptr<const track::HeightTable>;
  Track track(const std::optional<std::uint64_t>& seed, double past);

  const Scene& scene_;
  const SharedBeam& shared_;
  coupling::SystemInput input_;
  std::vector<double> rest_;  // m, rad: of the bridge without vehicles
  coupling::System system_;
  train::Fleet fleet_;
  std::string obstacle_;
  std::vector<double> wheels_;  // m: of every wheel at the start
  /// Tracks made last, which the next runs are likely to go over too.
  std::deque<std::pair<std::optional<std::uint64_t>, Track>> tracks_;
  double track_past_ = 0.0;      // m: distance that tracks are known for
  double track_distance_ = 0.0;  // m: between their stations
  std::vector<double> state_;    // of the bridge at the start, v and w
  std::shared_ptr<const engine::BatchStructure> structure_;
  engine::BatchPlan plan_;
  std::vector<double> kinks_;  // m: stations at which the surface has a corner
};

}  // namespace traverse::app
