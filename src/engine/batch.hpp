// Batches of runs: passages of trains with different parameter values (speeds, tracks, masses, springs) over one
// structure, or over structures that differ in parameter values too (stiffness, mass, damping, foundation), one run in
// each SIMD lane. They have the same stages of the same methods as a single run
// (coupling/system.hpp), and the kernel of its linear train (train_kernel.hpp).
#pragma once

#include <deque>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/one_step_methods.hpp"
#include "base/passage_peaks.hpp"
#include "beam/beam.hpp"
#include "engine/batch_task.hpp"
#include "engine/surfaces.hpp"
#include "recovery/recovery.hpp"
#include "structure/modal_bridge.hpp"
#include "track/height_table.hpp"
#include "train/fleet.hpp"

namespace traverse::engine {

/// A nodal unknown, or its difference to another one.
struct NodalRotation {
  int unknown = 0, other = none;
  static constexpr int none = -1;
};

/// The structure, its surface and the probes of one run or of several.
class BatchStructure {
 public:
  /// The reason why a structure cannot be computed in a batch; empty: it can. modal: its modes, null for elements.
  static std::string obstacle(const beam::Beam& beam, const structure::ModalBridge* modal);

  /// The fleet's wheels at their positions on the structure; rest: nodal displacements at rest, without the wheels;
  /// probes: of the beam; rotations: nodal rotations that are observed. Beam and modes must outlive this object.
  BatchStructure(const beam::Beam& beam, const structure::ModalBridge* modal, const train::Fleet& fleet,
                 const std::vector<double>& rest, const recovery::Recovery& probes,
                 const std::vector<NodalRotation>& rotations = {});
  /// Whether the other structure has the same mesh, supports and probes, so that both can be in lanes of one batch.
  bool same_layout(const BatchStructure& other) const;
  BatchStructure(const BatchStructure&) = delete;
  BatchStructure& operator=(const BatchStructure&) = delete;

 private:
  friend class Batch;
  friend class StructureLanes;
  void read_matrices(const std::vector<double>& rest);
  void read_modes(const std::vector<double>& rest);
  void find_columns();
  void add_probe(const recovery::Recovery& recovery, std::size_t station);
  void add_rotation(const NodalRotation& rotation, const std::vector<double>& rest);
  void find_inner_responses(const recovery::Recovery& recovery, std::size_t station, int element, ProbeForms& p,
                            std::vector<double>& inside) const;
  const double* keep(const std::vector<double>& numbers) { return numbers_.emplace_back(numbers).data(); }
  std::vector<double> form_of_unknowns(const recovery::StationForms& forms, const std::vector<double>& form) const;

  const beam::Beam& beam_;
  const structure::ModalBridge* modal_;
  const beam::Line& line_;                     // the line that carries the wheels
  BeamTask task_;                              // without entries and the arrays of the runs
  double by_mass_ = 0.0, by_stiffness_ = 0.0;  // of Rayleigh's damping, 1/s and s
  std::vector<double> mass_, damping_, stiffness_, dead_load_, shape_;
  std::vector<char> held_;
  std::vector<int> first_column_;
  double lever_ = 0.0;  // m, of the track
  Surfaces surfaces_;
  std::vector<ProbeForms> probes_;
  std::vector<LinearForm> rotations_;
  std::deque<std::vector<double>> numbers_;  // storage for the coefficients of probes_ and rotations_
  std::deque<std::vector<int>> lists_;       // storage for the indices of their unknowns
  std::vector<double> kinks_;
  bool has_shear_ = false;
};

/// A series of equal steps.
struct EqualSteps {
  double to = 0.0;  // m travelled since t = 0, at the end
  long steps = 0;
  bool ends_at_event = true;  // whether a wheel is at a kink of the surface or at a probe at the end
  bool stores = false;        // whether responses at the end are stored
};

/// A body of a vehicle of the fleet.
struct BodyOfVehicle {
  std::size_t vehicle = 0;
  Eigen::Index body = 0;
};

/// One run: a train in its initial state, on its own track. The vehicles of all runs differ in parameter values only,
/// and their structures have the same layout.
struct BatchRun {
  const BatchStructure* structure = nullptr;
  const train::Fleet* fleet = nullptr;
  const track::HeightTable* track = nullptr;  // with the same stations in all runs
  // Displacements v and velocities w of the structure at t = 0; w belongs to the fleet's speed and is scaled to
  // `speed`.
  const std::vector<double>* state = nullptr;
  double speed = 0.0, end_time = 0.0;        // m/s; s: end of the peaks' interval
  std::span<const BodyOfVehicle> cars = {};  // bodies whose vertical accelerations are observed, as many in all runs
};

enum class Response { deflection, acceleration, moment };

struct BatchPlan {
  std::vector<Response> stored;  // at the start and at the end of the series that store
  bool stores_wheels = false;    // normal forces of all wheels there too
  base::Method method;           // coefficients for a step of 1 s, scaled to each run's step
  std::vector<EqualSteps> equal_steps;
  double last_change = 1e-7;  // of a force in the last pass of a stage, over the vehicle's weight
  double level_until = 0.0;   // m: up to here track and ground are level and rigid; vehicles are at rest
};

struct BatchResult : base::PassagePeaks {
  RunFailure failure = none;
  std::vector<double> samples;  // [instant][stored response][probe]; deflections relative to the line of the supports
  std::vector<double> wheel_samples;                        // [instant][wheel], N
  std::vector<base::Extreme> rotations, car_accelerations;  // largest magnitudes: rad; m/s2
  base::Extreme unloading;                                  // largest loss of a wheel's force, relative to its start
  std::vector<double> coordinates_at_largest;  // for each vehicle the coordinates at its largest linearisation residual
};

/// At most as many runs as there are lanes (best_width()).
std::vector<BatchResult> run_batch(const BatchPlan& plan, std::span<const BatchRun> runs);

}  // namespace traverse::engine
