// The weights that pass, wheels' and moving forces', and the largest static deflection under them: what dynamic
// amplification is measured by.
#pragma once

#include <mpi.h>

#include <vector>

#include "structure/structure.hpp"
#include "train/wheel_paths.hpp"
#include "traverse/base/speed_law.hpp"

namespace traverse::coupling {

/// A downward force that passes, where it is at t = 0.
struct StaticLoad {
  double x = 0.0;      // m
  double force = 0.0;  // N
  base::SpeedLaw law;
};

class QuasiStaticResponse {
 public:
  /// structure: null where there is none, and then no deflections. gravity: on its own mass, m/s2; 0: none.
  QuasiStaticResponse(MPI_Comm comm, structure::Structure* structure, double gravity)
      : comm_(comm), structure_(structure), gravity_(gravity) {}

  /// weights: of the fleet's wheels, in its order, then of moving forces.
  void set(std::vector<StaticLoad> weights, std::size_t wheels) {
    weights_ = std::move(weights);
    wheels_ = wheels;
  }

  const std::vector<StaticLoad>& all() const { return weights_; }

  /// Whether they keep their distances.
  bool pass_together(const train::WheelPaths& paths) const;
  /// Collective. Largest magnitude of the static deflection at a station under all of them, the structure's own weight
  /// included where it acts: where they keep their distances, placed wherever it is worst; where they do not, as they
  /// were along `paths` until `end`, s. 0 where the foundation is not linear.
  double static_peak(double station, const train::WheelPaths& paths, double end);
  /// Collective. What a single load does that deflects the station at most as they do, J; 0: there is none.
  double static_energy(double station);

 private:
  struct InfluenceLine;
  InfluenceLine influence_line(double station);
  double rest_at(double station);
  double peak_of_train(const InfluenceLine& line, double constant) const;
  bool steady() const;
  double peak_on_the_way(const InfluenceLine& line, const train::WheelPaths& paths, double end) const;
  bool superpose() const { return structure_ != nullptr && !weights_.empty() && structure_->linear(); }

  MPI_Comm comm_;
  structure::Structure* structure_;
  double gravity_;
  std::vector<StaticLoad> weights_;
  std::size_t wheels_ = 0;  // of them, from the first on
};

}  // namespace traverse::coupling
