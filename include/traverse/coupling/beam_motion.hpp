// The beam's part of a stage in second-order form: the right-hand side P - C* w~ - K* v~ made tile by tile while the
// solver's sweep comes by, so that a stage reads each vector once. A tile's numbers stay in the cache from the
// combination of the accelerations until the elimination.
#pragma once

#include <optional>
#include <vector>

#include "traverse/beam/element_rows.hpp"
#include "traverse/coupling/beam_operator.hpp"
#include "traverse/coupling/motion.hpp"

namespace traverse::coupling {

/// A force on a local unknown.
struct NodalLoad {
  int unknown = 0;
  double force = 0.0;  // N or N m
};

class BeamMotion final : private solve::NodeFiller {
 public:
  /// dead_load: of this rank's unknowns; null: none. It and both references are kept.
  BeamMotion(const beam::Beam& beam, BeamOperator& op, const double* dead_load);

  /// Room for so many accelerations.
  void prepare(int count);
  /// Nodal accelerations A_j, this rank's unknowns.
  double* acceleration(int j) { return accelerations_[static_cast<std::size_t>(j)].data(); }
  const double* acceleration(int j) const { return accelerations_[static_cast<std::size_t>(j)].data(); }

  /// Whether stages are solved by solve(); where not, the beam has more than bending and Rayleigh's damping, and
  /// still() serves.
  bool fused() const { return rows_.has_value(); }

  /// Collective. A_known of a stage under the dead load and `loads` (ascending unknowns; no contacts); `before`: the
  /// weights of the accelerations in w of the state before, whose dissipation is computed on the way.
  void solve(const StageRule& rule, const Weights& before, const double* v, const double* w,
             const std::vector<NodalLoad>& loads);
  /// Of the state before the last stage solved, this rank's share, W.
  double dissipation() const { return dissipation_; }

  /// v~ and w~ of this rank's unknowns.
  void still(const StageRule& rule, const double* v, const double* w, double* v_still, double* w_still) const;
  /// v and w of a stage at one unknown, whose acceleration is in A_known.
  std::pair<double, double> state(const StageRule& rule, const double* v, const double* w, int unknown) const;

  /// v, w and A_0 at the end of the step.
  void finish(const StepRule& rule, double* v, double* w);

 private:
  struct Combination {  // of w and the accelerations
    double v = 0.0, w = 0.0;
    Weights a{};
    int known = 0;
  };
  struct Tile;  // deflections and rotations of the nodes of a tile and their neighbours

  void fill(std::ptrdiff_t first, std::ptrdiff_t past) override;
  void fill_tile(int first, int past);
  void combine(const Combination& c, int first, int past, const std::array<double, 4>& ghosts, Tile& to) const;
  std::pair<double, double> at_node(const Combination& c, int node) const;
  void exchange_borders();

  const beam::Beam& beam_;
  BeamOperator& operator_;
  const double* dead_load_;
  std::optional<beam::ElementRows> rows_;
  std::vector<int> held_;  // local unknowns that stay zero
  std::array<std::vector<double>, most_accelerations> accelerations_;
  int n_ = 0, nodes_ = 0;

  // Of the stage under way
  const double *v_ = nullptr, *w_ = nullptr;
  const std::vector<NodalLoad>* loads_ = nullptr;
  Combination elastic_, drag_, before_;            // v~ + b w~, a w~, w of the state before
  std::array<std::array<double, 4>, 3> ghosts_{};  // of these: (v, theta) left of this rank's nodes and right of them
  double scale_ = 0.0;                             // of the right-hand side: 1/displacement
  double* target_ = nullptr;
  double dissipation_ = 0.0;
};

}  // namespace traverse::coupling
