// The vehicles of a train on the track. Vehicles joined by couplers are one mechanism: a unit. They are described as
// running to the right; a vehicle that runs to the left is the mirror image.
#pragma once

#include <string>
#include <vector>

#include "traverse/train/vehicle.hpp"

namespace traverse::train {

/// One mechanism with its wheels and contacts; points in the global frame at t = 0.
struct Unit {
  multibody::MechanismModel mechanism;
  std::vector<Wheel> wheels;
  std::vector<contact::BodyContact> contacts;
  std::vector<int> drives;  // the mechanism's drivers that prescribe the train's speed
  base::SpeedLaw speed;     // this speed
};

/// One vehicle of the train as part of its unit, which may contain several coupled vehicles: the first indices of its
/// parts there, in the order of its type.
struct Member {
  const Vehicle* type = nullptr;
  int unit = 0;
  int first_body = 0, first_joint = 0, first_spring = 0, first_torsion_spring = 0, first_rope = 0, first_wheel = 0,
      first_contact = 0;
};

/// A coupler between two neighbours: a joint or a spring of their unit.
struct CoupledGap {
  int coupler = 0;  // index in Train::couplers
  int unit = 0;
  int part = 0;  // index in the unit's joints or springs
};

struct AssembledTrain {
  std::vector<Unit> units;
  std::vector<Member> members;       // one for each vehicle of the train
  std::vector<CoupledGap> couplers;  // by coupler, then from front to rear
};

/// frozen: for the static start, every drive remains at its position at t = 0, and a free train is fixed. `types` must
/// outlive the result.
AssembledTrain assemble(const std::vector<Vehicle>& types, const Train& train, double gravity, bool frozen);

/// Reverses the signs of x, angles and moments, also in tables. The name remains.
Vehicle mirrored(Vehicle vehicle);
Coupler mirrored(Coupler coupler);

}  // namespace traverse::train
