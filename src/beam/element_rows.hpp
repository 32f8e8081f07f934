// Elastic forces of the elements of bridge and rail, K_aa x, for many elements at a time. A time step computes this
// product for a few nodes in the cache. The coefficients of elements that repeat along the beam are stored once.
#pragma once

#include <array>
#include <vector>

#include "beam/beam.hpp"
#include "beam/planes.hpp"
#include "solve/repeats.hpp"

namespace traverse::beam {

class ElementRows {
 public:
  /// Whether the beam has no hinges and no expansion devices, whose nodes have an additional unknown.
  static bool fit(const Beam& beam) {
    const auto& place = beam.layout().place;
    return place[theta_right] < 0 && place[rail_theta_right] < 0 && place[rail_u_right] < 0;
  }
  explicit ElementRows(const Beam& beam);

  /// r += K_aa x for this rank's nodes [first, past), at most `tile`. x begins at node first - 1 and ends at node past;
  /// its values outside the beam have no effect but must be finite. `r` begins at node first.
  void add(int first, int past, const Planes& x, const Planes& r) const;

 private:
  // The coefficients h, A, B, C, D and S of internal_forces.hpp for each element. Element j is between the local nodes
  // j - 1 and j; its coefficients are zero if there is no element.
  static constexpr int numbers = 6;
  struct Run {
    int u, v, theta;  // places in a column
    std::array<std::vector<double>, numbers> coefficients;
    solve::StoredSequence stored;
  };
  static Run run_of(const Beam& beam, const Line& line);
  template <bool axial>
  static void add_run(const Run& run, int first, int past, const Planes& x, const Planes& r);

  std::vector<Run> runs_;
};

}  // namespace traverse::beam
