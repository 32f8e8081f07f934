// Runs side by side: passages of trains that differ in numbers only (speeds, tracks, masses, springs) over one
// structure by its elements, one run in each lane of the processor's vectors. The same stages of the same methods as a
// run by itself has (coupling/system.hpp), by the kernel that its train has, too (train_kernel.hpp).
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

/// What all runs have in common: the structure, the surface on it, the stations that are looked at.
class BatchStructure {
 public:
  /// Why a structure cannot be taken so, in words; empty: it can. modal: its modes, null by elements.
  static std::string obstacle(const beam::Beam& beam, const structure::ModalBridge* modal);

  /// The fleet's wheels as they stand on the structure; rest: its nodal displacements without them; probes in m;
  /// gravity of its own weight, m/s2 (0: it has none). Beam and modes must outlive it.
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
  std::vector<double> by_unknowns(const beam::StationForms& forms, const std::vector<double>& form) const;

  const beam::Beam& beam_;
  const structure::ModalBridge* modal_;
  const beam::Line& line_;  // that wheels run on
  BeamTask task_;           // but for the rows
  std::vector<double> mass_, damping_, stiffness_, dead_, shape_;
  std::vector<char> held_;
  std::vector<int> first_column_;
  int offset_[most_nodal] = {};  // of an element's unknowns, counted from its first column
  Surfaces surfaces_;
  std::vector<ProbeForms> probes_;
  std::deque<std::vector<double>> numbers_;  // of their forms
  std::deque<std::vector<int>> lists_;       // of their unknowns
  std::vector<double> kinks_;
  bool shears_ = false;
};

/// A stretch of equal steps.
struct BatchStretch {
  double to = 0.0;  // m travelled since t = 0
  long steps = 0;
  bool kink = true;    // a wheel meets a corner of the surface or a probe at its end
  bool keeps = false;  // accelerations at its end are kept
};

/// One run: a train as it starts, with vehicles as those of the other runs but for their numbers, on its own track.
struct BatchRun {
  const train::Fleet* fleet = nullptr;
  const track::HeightTable* track = nullptr;   // stations as in all runs
  const std::vector<double>* state = nullptr;  // of the structure at t = 0, v and w; w of the fleet's own speed
  double speed = 0.0, end_time = 0.0;          // m/s; s: peaks count until then
};

struct BatchPlan {
  const BatchStructure* structure = nullptr;
  structure::Method method;  // for steps of 1 s
  std::vector<BatchStretch> stretches;
  double level_until = 0.0;  // m: before it the track is level and the ground rigid, so that a vehicle stands still
};

struct BatchResult : base::PassagePeaks {
  Trouble trouble = none;
  std::vector<double> kept;      // accelerations, a row of probes at each place
  std::vector<double> farthest;  // coordinates of every vehicle where it was farthest from linear
};

/// At most as many runs as the processor's vectors have numbers (best_width()).
std::vector<BatchResult> run_batch(const BatchPlan& plan, std::span<const BatchRun> runs);

}  // namespace traverse::engine
