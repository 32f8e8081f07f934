// Batches of runs: passages of trains with different parameter values (speeds, tracks, masses, springs) over one
// structure, one run in each SIMD lane. They have the same stages of the same methods as a single run
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

/// The data that all runs share: the structure, its surface, the probes.
class BatchStructure {
 public:
  /// The reason why a structure cannot be computed in a batch; empty: it can. modal: its modes, null for elements.
  static std::string obstacle(const beam::Beam& beam, const structure::ModalBridge* modal);

  /// The fleet's wheels at their positions on the structure; rest: nodal displacements without them; probes in m;
  /// gravity for the self-weight, m/s2 (0: none). Beam and modes must outlive this object.
  BatchStructure(const beam::Beam& beam, const structure::ModalBridge* modal, const train::Fleet& fleet,
                 const std::vector<double>& rest, const std::vector<double>& probes, double gravity);
  BatchStructure(const BatchStructure&) = delete;
  BatchStructure& operator=(const BatchStructure&) = delete;

 private:
  friend class Batch;
  void read_matrices(const std::vector<double>& rest);
  void read_modes(const std::vector<double>& rest);
  void find_columns();
  void add_probe(const beam::Recovery& recovery, std::size_t station);
  void find_inner_responses(const beam::Recovery& recovery, std::size_t station, int element, ProbeForms& p) const;
  const double* keep(const std::vector<double>& numbers) { return numbers_.emplace_back(numbers).data(); }
  std::vector<double> form_of_unknowns(const beam::StationForms& forms, const std::vector<double>& form) const;

  const beam::Beam& beam_;
  const structure::ModalBridge* modal_;
  const beam::Line& line_;  // of the wheels
  BeamTask task_;           // without the arrays of the runs
  std::vector<double> mass_, damping_, stiffness_, dead_load_, shape_;
  std::vector<char> held_;
  std::vector<int> first_column_;
  int offset_[most_nodal] = {};  // of an element's unknowns, from its first column
  Surfaces surfaces_;
  std::vector<ProbeForms> probes_;
  std::deque<std::vector<double>> numbers_;  // of the probes' forms
  std::deque<std::vector<int>> lists_;       // of the probes' unknowns
  std::vector<double> kinks_;
  bool shears_ = false;
};

/// A series of equal steps.
struct BatchStretch {
  double to = 0.0;  // m travelled since t = 0, at the end
  long steps = 0;
  bool kink = true;    // at the end a wheel is at a kink of the surface or a probe
  bool keeps = false;  // accelerations at the end are stored
};

/// One run: a train in its initial state, on its own track. The vehicles of all runs differ in parameter values only.
struct BatchRun {
  const train::Fleet* fleet = nullptr;
  const track::HeightTable* track = nullptr;   // with the same stations in all runs
  const std::vector<double>* state = nullptr;  // structure at t = 0, v and w; w for the fleet's speed
  double speed = 0.0, end_time = 0.0;          // m/s; s: end of the peaks' interval
};

struct BatchPlan {
  const BatchStructure* structure = nullptr;
  structure::Method method;  // for steps of 1 s
  std::vector<BatchStretch> stretches;
  double level_until = 0.0;  // m: up to here track and ground are level and rigid; vehicles are at rest
};

struct BatchResult : base::PassagePeaks {
  Trouble trouble = none;
  std::vector<double> kept;      // accelerations, a row of probes at each stored instant
  std::vector<double> farthest;  // coordinates of every vehicle at its largest departure
};

/// At most as many runs as there are lanes (best_width()).
std::vector<BatchResult> run_batch(const BatchPlan& plan, std::span<const BatchRun> runs);

}  // namespace traverse::engine
