// Elastic forces of the bridge's and the rail's elements, K_aa x, many elements at a time: the product that a time step
// needs, on a few nodes in the cache. Where elements repeat along the beam their numbers are kept once.
#pragma once

#include <array>
#include <vector>

#include "beam/beam.hpp"
#include "beam/planes.hpp"
#include "solve/repeats.hpp"

namespace traverse::beam {

class ElementRows {
 public:
  /// Whether a beam is of this kind: without hinges and expansion devices, whose nodes have an unknown more.
  static bool fit(const Beam& beam) {
    const auto& place = beam.layout().place;
    return place[theta_right] < 0 && place[rail_theta_right] < 0 && place[rail_u_right] < 0;
  }
  explicit ElementRows(const Beam& beam);

  /// r += K_aa x for this rank's nodes [first, past), at most `tile`. x begins at node first - 1 and ends at node past;
  /// what it holds beyond the beam has no effect but has to be finite. `r` begins at node first.
  void add(int first, int past, const Planes& x, const Planes& r) const;

 private:
  // Of an element from its left node to its right one h, A, B, C, D and S of internal_forces.hpp; element j leads from
  // local node j - 1 to j, and is zero where there is none.
  static constexpr int numbers = 6;
  struct Run {
    int u, v, theta;  // places in a column
    std::array<std::vector<double>, numbers> of;
    solve::StoredSteps stored;
  };
  static Run run_of(const Beam& beam, const Line& line);
  template <bool axial>
  static void add_run(const Run& run, int first, int past, const Planes& x, const Planes& r);

  std::vector<Run> runs_;
};

}  // namespace traverse::beam
