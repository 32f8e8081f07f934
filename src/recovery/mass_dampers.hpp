// Travel and force of the tuned mass dampers of a beam.
#pragma once

#include <vector>

#include "base/bytes.hpp"
#include "base/extremum.hpp"
#include "base/passage_peaks.hpp"
#include "beam/beam.hpp"

namespace traverse::recovery {

class MassDampers {
 public:
  explicit MassDampers(const beam::Beam& beam);

  /// Collective. The next instant, s, from this rank's slices of the nodal displacements and their rates; complete on
  /// every rank.
  void evaluate(double t, const double* v, const double* w);

  // In the order of the beam's model.
  /// Displacement of the mass minus that of the beam, m upward.
  double travel(std::size_t i) const { return sums_[2 * i]; }
  /// Force of spring and dashpot on the beam, N upward.
  double force(std::size_t i) const;
  /// The largest magnitudes of all instants.
  std::vector<base::DamperPeaks> largest() const;
  void keep(base::Bytes& bytes) { bytes(largest_); }

 private:
  const std::vector<beam::MassDamper>& dampers() const { return beam_.model().dampers; }

  /// A local unknown in the travel of a damper.
  struct Term {
    std::size_t damper, unknown;
    double factor;
  };

  const beam::Beam& beam_;
  std::vector<Term> terms_;
  std::vector<double> sums_;            // travel, m, and its rate, m/s, of each damper
  std::vector<base::Extreme> largest_;  // travel and force of each damper
};

}  // namespace traverse::recovery
