// A train of linear vehicles as the numbers that its crossing of spans takes, and what its being linear leaves out.
#pragma once

#include <string>
#include <vector>

#include "train/fleet.hpp"

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

enum Trouble { none = 0, contact_lost = 1, not_converged = 2, not_finite = 3 };

/// Why a train cannot be taken so, in words; empty: it can.
std::string obstacle(const train::Fleet& fleet);

/// Of a fleet whose vehicles are linear, at its start with its contact forces; it is moved and comes back.
TrainNumbers train_numbers(train::Fleet& fleet);

/// How far the mechanisms are out of balance, over their weights, at coordinates x from where they start (metres and
/// radians).
double defect(train::Fleet& fleet, const std::vector<double>& x);

}  // namespace traverse::lanes
