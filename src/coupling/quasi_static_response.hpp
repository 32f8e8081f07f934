// The moving weights of wheels and forces, and the largest static deflection under them, the reference of the dynamic
// amplification.
#pragma once

#include <mpi.h>

#include <vector>

#include "structure/structure.hpp"
#include "train/wheel_paths.hpp"
#include "traverse/base/speed_law.hpp"

namespace traverse::coupling {

/// A moving downward force and its position at t = 0.
struct StaticLoad {
  double x = 0.0;      // m
  double force = 0.0;  // N
  base::SpeedLaw law;
  double length = 0.0;  // m, over which the force is spread, x its centre
  int track = 0;        // of beam::Torsion::tracks
};

class QuasiStaticResponse {
 public:
  /// structure: null without a structure; then there are no deflections. gravity: gravity on the structure's mass,
  /// m/s2; 0: no self-weight.
  QuasiStaticResponse(MPI_Comm comm, structure::Structure* structure, double gravity)
      : comm_(comm), structure_(structure), gravity_(gravity) {}

  /// weights: the weights on the fleet's wheels in their order, then the moving forces.
  void set(std::vector<StaticLoad> weights, std::size_t wheels) {
    weights_ = std::move(weights);
    wheels_ = wheels;
  }

  const std::vector<StaticLoad>& all() const { return weights_; }

  /// Whether the distances between the weights are constant.
  bool pass_together(const train::WheelPaths& paths) const;
  /// Collective. Largest magnitude of the static deflection at a station, relative to the line through the supports,
  /// under all weights, including the structure's own weight if it acts. If the distances are constant, the weights are
  /// in the most unfavourable position, otherwise in their positions along `paths` until `end`, s. 0 if the foundation
  /// is not linear.
  double static_peak(double station, const train::WheelPaths& paths, double end);
  /// Collective. The work of a single load at the station that causes the largest deflection under the weights, J; 0
  /// without a deflection.
  double static_energy(double station);

 private:
  struct InfluenceLine;
  InfluenceLine influence_line(double station);
  double permanent_deflection(double station);
  double peak_of_train(const InfluenceLine& line, double constant) const;
  bool steady() const;
  double peak_along_paths(const InfluenceLine& line, const train::WheelPaths& paths, double end) const;
  bool superpose() const { return structure_ != nullptr && !weights_.empty() && structure_->linear(); }

  MPI_Comm comm_;
  structure::Structure* structure_;
  double gravity_;
  std::vector<StaticLoad> weights_;
  std::size_t wheels_ = 0;  // number of wheels, the first weights
};

}  // namespace traverse::coupling
