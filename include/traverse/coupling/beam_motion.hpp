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

  /// Collective. A_known of a stage under the dead load and `loads` (ascending unknowns; no contacts).
  void solve(const StageRule& rule, const double* v, const double* w, const std::vector<NodalLoad>& loads);
  /// What is lost in damping, w^T C w, and its rate of change, 2 A_0^T C w: this rank's share at the start of the step
  /// whose first stage was solved last.
  struct Dissipation {
    double power = 0.0;  // W
    double rate = 0.0;   // W/s
  };
  Dissipation dissipation() const { return dissipation_; }

  /// v~ and w~ of this rank's unknowns.
  void still(const StageRule& rule, const double* v, const double* w, double* v_still, double* w_still) const;
  /// v and w of a stage at one unknown, whose acceleration is in A_known.
  std::pair<double, double> state(const StageRule& rule, const double* v, const double* w, int unknown) const;

  /// v, w and A_0 at the end of the step.
  void finish(const StepRule& rule, double* v, double* w);

  /// Where parts of the beam do not touch: a whole step of those among the nodes [first, past) on which nothing but the
  /// dead load acts, a few parts at a time through all stages while their numbers are in the cache. Adds to
  /// `dissipation`, of the start of the step.
  void step_free(const Method& method, int first, int past, double* v, double* w, Dissipation& dissipation);

  /// Stages and the ends of steps are for these nodes of this rank alone, beyond which nothing of them is felt. Only
  /// where fused.
  void set_range(int first, int past);
  int first() const { return first_; }
  int past() const { return past_; }
  /// Puts the nodes [first, past) to rest: v as in `rest` (null: 0), w and all accelerations 0. Returns the energy that
  /// they had beyond rest, J, this rank's share.
  double put_to_rest(int first, int past, const double* rest, double* v, double* w);

 private:
  struct Combination {  // of w and the accelerations
    double v = 0.0, w = 0.0;
    Weights a{};
    int known = 0;
  };
  struct Setup {                // of a stage
    Combination elastic, drag;  // v~ + b w~, a w~
    double scale = 0.0;         // of the right-hand side: 1/displacement
    bool measuring = false;     // the dissipation at the start of the step
  };
  struct View {  // the vectors of the nodes [first, past)
    const double *v = nullptr, *w = nullptr;
    std::array<const double*, most_accelerations> a{};
    int first = 0, past = 0;
  };
  struct Tile;  // deflections and rotations of the nodes of a tile and their neighbours

  void fill(std::ptrdiff_t first, std::ptrdiff_t past) override;
  void fill_tile(int first, int past);
  using Ghosts = std::array<double, 4>;  // (v, theta) of the nodes next to this rank's, left and right
  void measure_dissipation(int first, int past, Tile& elastic, Tile& drag, Tile& force);
  void combine(const Combination& a, const Combination& b, int first, int past, const Ghosts& ghosts_a,
               const Ghosts& ghosts_b, Tile& to_a, Tile& to_b) const;
  std::pair<double, double> at_node(const Combination& c, int node) const;
  Setup set_up(const StageRule& rule) const;
  void exchange_borders();

  const beam::Beam& beam_;
  BeamOperator& operator_;
  const double* dead_load_;
  std::optional<beam::ElementRows> rows_;
  std::vector<int> held_;  // local unknowns that stay zero
  std::array<std::vector<double>, most_accelerations> accelerations_;
  int n_ = 0, nodes_ = 0;
  int first_ = 0, past_ = 0;
  bool windowed_ = false;

  // Of the stage under way
  View view_;
  Setup setup_;
  const std::vector<NodalLoad>* loads_ = nullptr;
  std::array<Ghosts, 3> ghosts_{};  // of its combinations, and of w
  double* target_ = nullptr;        // where the view begins
  Dissipation dissipation_;

  std::vector<Setup> setups_;  // of step_free
  std::array<std::vector<double>, most_accelerations> scratch_;
};

}  // namespace traverse::coupling
