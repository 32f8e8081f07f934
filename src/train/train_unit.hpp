// The vehicles of a train put on the track. Vehicles that couplers join are one mechanism: a unit.
#pragma once

#include <string>
#include <vector>

#include "traverse/train/vehicle.hpp"

namespace traverse::train {

/// One mechanism with its wheels and contacts, points in the global frame at t = 0.
struct Unit {
  multibody::MechanismModel mechanism;
  std::vector<Wheel> wheels;
  std::vector<contact::BodyContact> contacts;
};

/// A vehicle of the train as part of its unit: where its parts begin there, in the order of its type.
struct Member {
  const Vehicle* type = nullptr;
  int unit = 0;
  int first_body = 0, first_joint = 0, first_spring = 0, first_torsion_spring = 0, first_wheel = 0, first_contact = 0;
};

/// A coupler between two neighbours: a joint or a spring of their unit.
struct CoupledGap {
  int coupler = 0;  // of Train::couplers
  int unit = 0;
  int part = 0;  // of the unit's joints or springs
};

struct AssembledTrain {
  std::vector<Unit> units;
  std::vector<Member> members;       // one a vehicle of the train
  std::vector<CoupledGap> couplers;  // by coupler, then from the front backwards
};

/// frozen: every drive stands still at its place at t = 0, and a free train is held: for the static start. `types` has
/// to outlive the result.
AssembledTrain assemble(const std::vector<Vehicle>& types, const Train& train, double gravity, bool frozen);

}  // namespace traverse::train
