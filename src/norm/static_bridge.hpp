// The bridge at rest under vertical loads: its influence lines, from one factorisation and one solution each.
//
// What the nodal values of a section's element give of a quantity is a load on the structure, whose deflections are the
// influence line (Maxwell and Betti); a force on that element does more between its nodes, which is added.
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

  /// Of linear foundations, on this rank alone, with a mesh of its own. A layered track counts by its mass alone: loads
  /// stand on the bridge. InputError where the beam floats.
  explicit StaticBridge(const beam::BeamModel& model);
  StaticBridge(const StaticBridge&) = delete;
  StaticBridge& operator=(const StaticBridge&) = delete;

  /// At a station: deflection (m/N, upward), moment (m, sagging) and shear (1, d moment/dx).
  std::array<InfluenceLine, 3> lines_at(double x);
  /// What a support or a spring at a station bears of a unit force, upward on the bridge.
  struct Bearing {
    double x = 0.0;
    int span_end = -1;       // of a support; -1: a spring
    double stiffness = 0.0;  // N/m, of a spring
  };
  const std::vector<Bearing>& bearings() const { return bearings_; }
  InfluenceLine reaction(const Bearing& bearing);
  /// Rotation of the deck at the left or right end of the bridge, 1/N.
  InfluenceLine end_rotation(bool right);
  /// Inner span ends at which the slope may jump, and the difference of the rotations on both sides there, 1/N.
  std::vector<int> joints() const;
  InfluenceLine joint_rotation(int span_end);

  const beam::BeamModel& model() const { return beam_.model(); }
  /// Hz, of bending.
  double first_frequency() const;

 private:
  InfluenceLine rotation_of(const std::vector<std::pair<int, double>>& form);
  InfluenceLine line_of(std::vector<double> nodal, const beam::Recovery* recovery, double beam::Response::*direct);

  beam::Beam beam_;
  structure::BeamOperator statics_;
  std::vector<Bearing> bearings_;
};

}  // namespace traverse::norm
