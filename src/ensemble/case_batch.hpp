// Batched runs of a sweep or a study in the lanes of the processor's vectors (engine/batch.hpp): one train of linear
// vehicles over a bridge, at several speeds and over several tracks.
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

namespace traverse::ensemble {

/// Parameters of one run.
struct LaneRun {
  double speed = 0.0, end = 0.0;      // speed in m/s; duration in s
  std::optional<std::uint64_t> seed;  // seed of its track; none: the scene's track
  double step_speed = 0.0;            // m/s: the speed whose steps the run has; 0: its own

  double speed_of_steps() const { return step_speed > 0.0 ? step_speed : speed; }
};

/// The method of a sweep's runs, with its coefficients for a step of 1 s.
base::Method method_of(const scene::Scene& scene);

class CaseBatch {
 public:
  /// The reason why a scene's runs cannot be batched, in words, as far as it is known without its vehicles at rest;
  /// empty: none.
  static std::string obstacle(const scene::Scene& scene, const run::SharedBeam& shared);
  /// The train of a scene at its start, with the tracks of all runs up to this distance (m), so that no track depends
  /// on the order of runs. Null if the runs cannot be batched; `why` is the reason in words. Throws the errors of a
  /// single run. Scene and beam must outlive the object.
  static std::unique_ptr<CaseBatch> make(const scene::Scene& scene, const run::SharedBeam& shared, double distance,
                                         std::string& why);
  struct Steps {
    base::Method method;   // coefficients for a step of 1 s
    double longest = 0.0;  // s
    bool trial = false;    // all runs have the same distance, whose end is sampled exactly; a batch may have one run
    /// Responses that are stored at positions at the distance `spacing`, at which time steps end too.
    std::vector<engine::Response> stored = {};
    bool stores_wheels = false;                            // normal forces of the wheels too
    long stored_each = 1;                                  // `spacing` in steps
    double last_change = engine::BatchPlan().last_change;  // BatchPlan
  };
  /// The steps that the scene defines.
  Steps steps() const;
  /// Runs that any thread may compute while others compute theirs; their CaseBatch must outlive it.
  class Ready {
   public:
    std::vector<engine::BatchResult> run() const;

   private:
    friend class CaseBatch;
    void add_equal_steps(const std::vector<double>& events, double spacing, double distance, const Steps& steps);

    engine::BatchPlan plan_;
    std::vector<std::shared_ptr<const track::HeightTable>> tracks_;
    std::vector<engine::BatchRun> runs_;
  };
  /// At most engine::widest runs with steps of one step group (engine/speed_class.hpp).
  Ready ready(std::span<const LaneRun> runs, const Steps& steps);
  const train::Fleet& fleet() const { return fleet_; }
  const beam::Beam& beam() const { return *shared_.beam; }
  std::size_t wheels() const { return wheels_.size(); }
  /// Distance, m, between the positions at which runs of this speed's step group store responses.
  static double spacing(const Steps& steps, double speed);
  /// A run of a common batch of trains with different parameters. `lanes` of all members were merged with the same
  /// batch.
  struct Member {
    CaseBatch* lanes;
    LaneRun run;
  };
  static Ready ready(std::span<const Member> members, const Steps& steps);
  /// Makes the runs compatible with the runs of another scene on the same bridge, by use of the other's common data.
  /// Returns false if the trains differ in more than parameters.
  bool merge(const CaseBatch& other);
  /// The largest linearisation residual of a run, relative to the weight (train::linearisation_residual).
  double residual(const engine::BatchResult& result);
  /// The largest static deflection at each probe while the train passes, m.
  std::vector<double> static_deflection();

 private:
  CaseBatch(const scene::Scene& scene, const run::SharedBeam& shared);
  /// Collects what the batches of a train without obstacles need.
  void set_up();
  /// Prepares the tracks up to this distance. Returns the reason why batched runs are not possible there; empty: they
  /// are.
  std::string prepare_tracks(double distance);
  const structure::ModalBridge* modal() const { return shared_.modal ? &*shared_.modal : nullptr; }
  std::vector<double> events(double distance) const;
  std::pair<double, double> touched_range() const;
  using Track = std::shared_ptr<const track::HeightTable>;
  Track track(const std::optional<std::uint64_t>& seed, double distance);

  const scene::Scene& scene_;
  const run::SharedBeam& shared_;
  coupling::SystemInput input_;
  std::vector<double> unloaded_;  // m, rad: displacements of the bridge without vehicles
  coupling::System system_;
  train::Fleet fleet_;
  std::vector<double> wheels_;  // m: position of every wheel at the start
  /// The last used tracks, which the next runs probably need too.
  std::deque<std::pair<std::optional<std::uint64_t>, Track>> tracks_;
  double track_range_ = 0.0;     // m: distance that the tracks cover
  double track_distance_ = 0.0;  // m: distance of their stations
  std::vector<double> state_;    // initial state of the bridge, v and w
  std::shared_ptr<const engine::BatchStructure> structure_;
  engine::BatchPlan plan_;
  std::vector<double> kinks_;                // m: stations at which the surface has a kink
  std::vector<engine::BodyOfVehicle> cars_;  // whose accelerations have a limit
};

}  // namespace traverse::ensemble
