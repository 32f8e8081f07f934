// The bridge under static vertical loads: its influence lines, each by one solution with a common factorisation.
//
// The coefficients of the nodal values in a quantity are the nodal forces of a load on the structure. The deflections
// under this load are the influence line of the quantity (Maxwell and Betti). A force on that element has an additional
// direct effect between its nodes, which is added.
#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "norm/influence_line.hpp"
#include "recovery/recovery.hpp"
#include "structure/beam_operator.hpp"

namespace traverse::norm {

class StaticBridge {
 public:
  static constexpr std::size_t most_spans = 200;

  /// The bridge with linear foundations, on this rank only, with its own mesh. A layered track contributes its mass
  /// only, and loads act on the bridge. InputError if the beam has no support.
  explicit StaticBridge(const beam::BeamModel& model);
  StaticBridge(const StaticBridge&) = delete;
  StaticBridge& operator=(const StaticBridge&) = delete;

  /// Lines at a station: deflection (m/N, upward), moment (m, sagging) and shear (1, d moment/dx).
  std::array<InfluenceLine, 3> lines_at(double x);
  /// A support or a point spring, whose force on the bridge under a unit force is positive upward.
  struct Bearing {
    double x = 0.0;
    int span_end = -1;       // number of a support's span end; -1: a spring
    double stiffness = 0.0;  // stiffness of a spring, N/m
  };
  const std::vector<Bearing>& bearings() const { return bearings_; }
  InfluenceLine reaction(const Bearing& bearing);
  /// Rotation of the deck at the left or right end of the bridge, 1/N.
  InfluenceLine end_rotation(bool right);
  /// Inner span ends at which the slope may jump, and the difference of the rotations of both sides there, 1/N.
  std::vector<int> joints() const;
  InfluenceLine joint_rotation(int span_end);

  const beam::BeamModel& model() const { return beam_.model(); }
  /// The first bending frequency, Hz.
  double first_frequency() const;

 private:
  InfluenceLine rotation_of(const std::vector<std::pair<int, double>>& form);
  InfluenceLine line_of(std::vector<double> nodal, const recovery::Recovery* recovery,
                        double recovery::Response::*direct);

  beam::Beam beam_;
  structure::BeamOperator statics_;
  std::vector<Bearing> bearings_;
};

}  // namespace traverse::norm
