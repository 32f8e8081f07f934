// Vehicles and wheels in the rows of a train's task (train_task.hpp): the input of the kernel, and its memory.
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
  /// The reason why the vehicles of a fleet cannot be stored in rows; empty: they can.
  static std::string obstacle(const train::Fleet& fleet);
  /// The vehicles of each block, lane by lane: at most as many as there are lanes.
  static std::vector<std::vector<const train::MovingVehicle*>> side_by_side(
      std::span<const train::MovingVehicle> vehicles);

  /// The vehicles of a block have equal numbers of coordinates and wheels. The vehicles need not outlive this object.
  TrainArrays(std::span<const std::vector<const train::MovingVehicle*>> blocks, int per_node, double surface_height);

  static constexpr double infinite = std::numeric_limits<double>::infinity();
  static constexpr double no_surface = -1e3;  // m: height of the surface if there is none
  static constexpr double no_station = -1e9;  // m: profile_station without an evaluated profile, far from any track

  /// Sets the method, scaled to steps of h[lane] seconds.
  void set_rules(const base::Method& method, std::span<const double> h);
  /// Sets the weights for the initial guess of the contact forces of each stage, from the forces of the previous
  /// stages, at the start of the step, and at the start of the previous step, which began `before` earlier in the
  /// method's unit of time (0: there was none).
  void set_guesses(const base::Method& method, double before);

  /// Sets the contact of the wheel with that index to its initial state.
  void start_contact(std::size_t at, const train::WheelContact& c);

  /// Sets the steady motion of a vehicle to that at t, from s(t).
  void move(std::size_t block, std::size_t lane, const base::TimeFunction& travel, double t);

  /// Allocates rows, or integers, that are zero and exist as long as this object.
  double* add(std::size_t rows);
  int* add_integers(std::size_t rows);

  const std::size_t lanes = best_width();  // numbers of a row
  TrainTask task;
  std::vector<VehicleBlock> blocks;
  /// The steady motion of every block's vehicles, for its lanes: s', s'', m travelled and its rate (VehicleBlock), and
  /// the distance per unit of s.
  std::vector<double*> rate, acceleration, distance, speed, per_travel;
  std::vector<char> touches_two_patches, level;  // one for each row of wheels, as in TrainTask
  std::deque<char> active;                       // one for each block: VehicleBlock::active

 private:
  void fill_block(std::size_t block, const std::vector<const train::MovingVehicle*>& vehicles);
  bool equal_matrices(const VehicleBlock& a, const VehicleBlock& b) const;
  SparseRows sparse(const std::vector<Eigen::MatrixXd>& of_lanes);
  PairedRows paired(const std::vector<Eigen::MatrixXd>& A,
                    const std::vector<Eigen::MatrixXd>& B);  // matrices of the lanes
  void make_rows(std::span<const std::vector<const train::MovingVehicle*>> vehicles);

  std::vector<std::unique_ptr<Aligned>> numbers_;  // memory of the task's arrays
  std::vector<std::unique_ptr<std::vector<int>>> integers_;
  std::vector<char> hertz_;
};

}  // namespace traverse::engine
