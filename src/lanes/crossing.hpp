// Passages side by side: runs that differ in numbers only, one in each lane of the processor's vectors. What PETSc's TS
// does for a single run with the same methods; runs that need more than this (a contact lost, a step that does not
// converge) say so and are to be taken by themselves.
#pragma once

#include <span>
#include <vector>

#include "engine/processor.hpp"
#include "lanes/crossing_task.hpp"
#include "methods/one_step_methods.hpp"
#include "structure/modal_bridge.hpp"

namespace traverse::lanes {

/// Linear vehicles with the same numbers (train/linear_dynamics.hpp): M x'' + C x' + K x + r0 = G^T F; matrices by
/// rows.
struct VehicleNumbers {
  int freedom = 0, wheels = 0;
  std::vector<double> M, C, K, r0, G;
  std::vector<double> G_along;  // of the wheels' motion along the track
  /// Of every coordinate x: by the square of bend*x the mechanism is out of balance, over its weight (1/m or 1/rad).
  std::vector<double> bend;
  std::vector<double> driven;  // N s: driven x'' is the power that holds the masses' speed along the track
};

/// A train of such vehicles as it stands at t = 0.
struct TrainNumbers {
  struct Vehicle {
    std::size_t kind = 0;
    int first_coordinate = 0, first_wheel = 0;
  };
  std::vector<VehicleNumbers> kinds;
  std::vector<Vehicle> vehicles;
  int coordinates = 0;
  std::vector<double> x, penetration;  // m: of every wheel
  std::vector<double> arm;             // m: its radius less that
  std::vector<double> follow;          // of every coordinate: its rate at t = 0 over the speed
  std::vector<double> stiffness;       // of its contact, N/m^1.5 or N/m
  std::vector<char> hertz;             // whether it is the former
  double force_scale = 0.0;            // N, contact forces are judged by
  double radius = 0.0;                 // m, of all wheels
};

/// Heights of the track that wheels follow: TaskHeights.
struct TrackNumbers {
  double start = 0.0, distance = 1.0;  // m
  std::vector<double> values;          // [station][height, slope*distance]; empty: level
};

/// Moving forces.
struct ForceNumbers {
  std::vector<double> x, force;  // m at t = 0; N, downward
};

/// What the runs of a group have in common: shapes and places.
struct CrossingPlan {
  const structure::ModalBridge* bridge = nullptr;
  structure::Method method;  // for steps of 1 s
  bool exact_modes = false;  // of a method with one solve a step: it steps vehicles and contacts alone
  std::vector<TaskStretch> stretches;
  std::vector<double> kinks;  // m: stations at which the surface has a corner, ascending
  double level_until = 0.0;   // m: before it the track is level and the ground rigid
};

/// What is one run's own. In all runs of a group vehicles with as many coordinates and wheels at the same places.
struct CrossingRun {
  const TrainNumbers* train = nullptr;  // null: none
  const TrackNumbers* track = nullptr;  // null: level
  const ForceNumbers* forces = nullptr;
  const std::vector<double>* q = nullptr;  // of the modes at t = 0
  double speed = 0.0, end_time = 0.0;      // m/s; s: peaks count until then
};

struct CrossingPeak {
  double value = 0.0, time = 0.0;
};
struct CrossingResult {
  Trouble trouble = none;
  std::vector<CrossingPeak> deflection, acceleration, moment;  // of each probe
  std::vector<double> kept;                                    // accelerations, a row of probes at each place
  std::vector<CrossingPeak> low_passed;                        // of each probe, where somebody has filtered these
  double least_force = 0.0, greatest_force = 0.0;              // N, of all wheels
  std::vector<double> bent;  // coordinates of every vehicle where it was farthest from linear
  // m2: the angle of a corner by the square of how far ahead of it a wheel passed it, at most.
  double edge = 0.0;
};

/// At most `engine::widest` runs.
std::vector<CrossingResult> cross(const CrossingPlan& plan, std::span<const CrossingRun> runs);

}  // namespace traverse::lanes
