// What is known beforehand of the beam at a station: how its response follows from the nodal values of the element
// there and from the loads on it.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "beam/held_element.hpp"
#include "beam/layered_track.hpp"
#include "beam/section.hpp"
#include "beam/shape.hpp"
#include "recovery/recovery.hpp"

namespace traverse::beam {

/// All forms are of the element's nodal values, the transverse ones of v1, theta1, v2, theta2.
struct RecoverySection {
  /// Of the bridge or of the rail, at x, m, which lies on it. At a node: in the element to its right.
  RecoverySection(const Line& line, double x);

  /// The beam's dead weight, `gravity` in m/s2, whose response is `weight`.
  void add_weight(const BeamModel& model, double gravity);
  /// The sleepers that stand on this element of the bridge.
  void record_riders(const Beam& beam);
  /// Adds what a load on this element does to the response, but for the element's end forces, which follow from the
  /// nodal values.
  void add_load(const ElementLoad& load, Response& r) const;

  /// A sleeper of a layered track on this element.
  struct Rider {
    Ride ride;
    double xi = 0.0;
  };

  Station at;
  Element element;
  std::array<int, 6> unknowns;  // global: u1, v1, theta1, u2, v2, theta2; -1: not there
  double EI = 0.0, EA = 0.0;    // in the element's middle, for the fixed-end deflections
  Hermite psi;
  std::array<double, 2> phi;
  SectionForms bending;                   // K_e of the beam, for nodal values less the element's rigid motion
  SectionForms stiffness, damping, mass;  // K_e and C_e of the foundation, M_e
  Response weight;                        // of the beam's own weight and temperature: deflection and forces
  /// Where a foundation acts inside the element: the deflection that the shape functions leave out, under loads, and
  /// under what the foundation and inertia do to the beam as it moves by them.
  std::optional<HeldElement> held;
  std::array<double, 4> held_by_stiffness{}, held_by_damping{}, held_by_mass{};
  std::vector<Rider> riders;

 private:
  void add_foundation(const Line& line);
  void hold(const BeamModel& model, const std::vector<InnerSpring>& springs, const std::vector<InnerSpring>& dampers);
  template <class Sum>
  void along_held(const Distribution& density, bool moments, Sum sum) const;
  void add_strains(const BeamModel& model);
  void add_weight_at_points(const Bed& bed, const Distribution& mass_per_length, double gravity);
};

}  // namespace traverse::beam
