// What a coupled system has at an accepted instant.
#pragma once

#include <array>
#include <vector>

#include "structure/structure.hpp"

namespace traverse::coupling {

/// Stored energies and the integrals of the powers, J.
struct Energy {
  double kinetic = 0.0, strain = 0.0, potential = 0.0, dissipated = 0.0, work = 0.0;
  double structure = 0.0;  // kinetic and strain energy of the structure alone
  // The magnitudes of all loads times the largest displacement and rotation: the work of loads that do not cancel.
  double largest_work = 0.0;
};

/// The point of the running surface under the centre of a wheel: x and y, and their rates along the wheel's path. NaN
/// where there is no surface.
struct ContactPoint {
  std::array<double, 2> position{}, velocity{}, acceleration{};  // m, m/s, m/s2
};

/// An accepted instant, complete on every rank except for the nodal values.
struct Observation {
  structure::NodalMotion beam;
  std::vector<recovery::ElementLoad> loads;  // loads of wheels and forces, on their line
  /// All concentrated loads on the bridge: `loads` if they run on the bridge, and the nonlinear foundation. Inside an
  /// element a bed is represented by forces at its integration points.
  std::vector<recovery::ElementLoad> bridge_loads;
  std::vector<ContactPoint> contact_points;  // of each of Fleet::wheels, if the input wants them; further ones unused
  Energy energy;
};

}  // namespace traverse::coupling
