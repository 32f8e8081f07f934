// Vehicles and wheels in the rows of a train's task (train_task.hpp): what the kernel reads of them, and the memory it
// works in.
#pragma once

#include <cstddef>
#include <deque>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/one_step_methods.hpp"
#include "engine/processor.hpp"
#include "engine/train_task.hpp"
#include "train/fleet.hpp"

namespace traverse::engine {

class TrainArrays {
 public:
  /// Why the vehicles of a fleet have no place in rows, in words; empty: they have.
  static std::string obstacle(const train::Fleet& fleet);
  /// The vehicles of each block, lane by lane: as many of a fleet as there are lanes.
  static std::vector<std::vector<const train::MovingVehicle*>> side_by_side(const train::Fleet& fleet);

  /// Vehicles with as many coordinates and wheels in each block; what they are made of need not outlive this.
  TrainArrays(std::span<const std::vector<const train::MovingVehicle*>> blocks, int per_node, double surface_height);

  static constexpr double infinite = std::numeric_limits<double>::infinity();
  static constexpr double no_surface = -1e3;  // m: height of what is under a wheel with no surface

  /// The method, scaled to steps of h[lane] seconds.
  void set_rules(const structure::Method& method, std::span<const double> h);
  /// What the contact forces of each stage are guessed from: those of the stages before, of the step's start and of the
  /// start of the step before, which began `before` earlier in the method's unit of time (0: there was none).
  void set_guesses(const structure::Method& method, double before);

  /// The contact of the wheel with that number as it is at the start.
  void start_contact(std::size_t at, const train::WheelContact& c);

  /// Zeros that live as long as this: so many rows, so many integers.
  double* add(std::size_t rows);
  int* add_integers(std::size_t rows);

  const std::size_t lanes = best_width();  // numbers of a row
  TrainTask task;
  std::vector<VehicleBlock> blocks;
  std::vector<double*> distance;    // m, of every block's lanes: travelled
  std::vector<double*> speed;       // m/s, of every block's lanes
  std::vector<char> second, level;  // one a row of wheels, as the TrainTask's
  std::deque<char> active;          // one a block: VehicleBlock::awake

 private:
  void fill_block(std::size_t block, const std::vector<const train::MovingVehicle*>& vehicles);
  bool is_alike(const VehicleBlock& a, const VehicleBlock& b) const;
  SparseRows sparse(const std::vector<Eigen::MatrixXd>& of_lanes);
  PairedRows paired(const std::vector<Eigen::MatrixXd>& A, const std::vector<Eigen::MatrixXd>& B);  // of lanes
  void make_rows(std::span<const std::vector<const train::MovingVehicle*>> vehicles);

  std::vector<std::unique_ptr<Aligned>> numbers_;  // what the arrays of the task are
  std::vector<std::unique_ptr<std::vector<int>>> integers_;
  std::vector<char> hertz_;
};

}  // namespace traverse::engine
