// The beam's part of a stage in second-order form. The right-hand side is computed tile by tile as the solver's sweep
// reaches it, so that a stage reads each vector once: the numbers of a tile remain in the cache from the combination of
// the vectors to the elimination.
//
// With Rayleigh damping C = a M + b K the equation M A + C (w~ + k1 A) + K (v~ + k2 A) = P of a stage is, for
// Z = A + c w~ and c = a/(1 + a k1),
//
//   ((1 + a k1) M + (b k1 + k2) K) Z = P - K e,   e = v~ + (b - c (b k1 + k2)) w~
//
// without a product with M. Therefore Z of each stage is stored in place of A, and combinations of accelerations are
// expressed in w_n and these Z. If there are springs or dampers in addition to the beams, or a track with other
// damping, A itself is stored, the solution of
//
//   (M + k1 C + k2 K) A = P - K v~ - C w~
#pragma once

#include <initializer_list>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "base/one_step_methods.hpp"
#include "beam/internal_forces.hpp"
#include "structure/beam_operator.hpp"
#include "structure/ranges.hpp"

namespace traverse::structure {

/// A force on a local unknown.
struct NodalLoad {
  int unknown = 0;
  double force = 0.0;  // N or N m
};

class BeamMotion final : private solve::RhsCallback {
 public:
  /// dead_load: dead load on this rank's unknowns; null: none. The pointer and both references are stored.
  BeamMotion(const beam::Beam& beam, BeamOperator& op, const double* dead_load);

  /// Sets the method of the next steps, for their length; the acceleration at the start is unchanged.
  void begin(const base::Method& method);

  /// Nodal accelerations at the start of the step, this rank's unknowns.
  double* start_acceleration() { return stored_[0].data(); }
  const double* start_acceleration() const { return stored_[0].data(); }
  std::span<double> start() { return stored_[0]; }
  /// The stored vector of stage i, counted from 0: Z or A.
  double* stored(std::size_t stage) { return stored_[stage + 1].data(); }

  /// Whether stages are solved by solve(); if not, the beam has hinges or a nonlinear foundation, and predicted() is
  /// used.
  bool fused() const { return elements_.has_value(); }
  /// Whether stages are fused and the damping is Rayleigh damping only, as step_free() requires.
  bool proportional() const { return fused() && proportional_; }

  /// Collective. Computes Z of a stage under the dead load and `loads` (ascending unknowns; no contacts).
  void solve(std::size_t stage, const double* v, const double* w, const std::vector<NodalLoad>& loads);
  /// Whether the first stages of steps compute the dissipation.
  void measure(bool on) { measure_ = on; }
  /// The dissipated power w^T C w and its rate of change 2 A_0^T C w: this rank's share at the start of the step whose
  /// first stage was solved last.
  struct Dissipation {
    double power = 0.0;  // W
    double rate = 0.0;   // W/s, with Rayleigh damping only
  };
  Dissipation dissipation() const { return dissipation_; }
  /// Collective. The dissipated power and its rate for some nodes between two steps, with the acceleration at the start
  /// of the next step.
  Dissipation dissipation(const std::vector<Range>& nodes, const double* v, const double* w);
  /// Collective. The power w^T C w of a solved stage, this rank's share. Only if fused.
  double power(std::size_t stage, const double* v, const double* w);

  /// v~ and w~ of this rank's unknowns.
  void predicted(std::size_t stage, const double* v, const double* w, double* v_predicted, double* w_predicted) const;
  /// v and w of a solved stage at the unknowns [from, from + size), and at one of them.
  void states(std::size_t stage, const double* v, const double* w, std::ptrdiff_t from, int size, double* v_stage,
              double* w_stage) const;
  std::pair<double, double> state(std::size_t stage, const double* v, const double* w, int unknown) const;

  /// Collective. Strain energy of the springs and beams and kinetic energy of some nodes, J: this rank's share. Only if
  /// fused.
  struct Energy {
    double strain = 0.0, kinetic = 0.0;
  };
  Energy energy(const std::vector<Range>& nodes, const double* v, const double* w);
  /// Energy of the step's error as StepRule's embedded method estimates it, J: this rank's share. After all stages are
  /// solved, only if fused; otherwise error() computes the errors of v and w of this rank's unknowns.
  double error_energy();
  void error(const double* v, const double* w, double* error_of_v, double* error_of_w) const;
  /// v, w and the acceleration at the end of the step, which is the start of the next one.
  void finish(double* v, double* w);

  /// Computes a whole time step of the separate parts among the nodes [first, past) on which only the dead load acts.
  /// All stages of a few parts are computed while their numbers are in the cache. Adds the dissipation at the start of
  /// the step to `dissipation`.
  void step_free(int first, int past, double* v, double* w, Dissipation& dissipation);

  /// Restricts stages and ends of steps to these nodes of this rank, outside which the motion is negligible. All ranks
  /// have the same number of ranges. Only if fused.
  void set_ranges(const std::vector<Range>& ranges);
  const std::vector<Range>& ranges() const { return ranges_; }
  /// Sets the nodes [first, past) to rest: v as in `rest` (null: 0), w and all accelerations 0. Returns the energy of
  /// their motion about rest, J, this rank's share.
  double set_to_rest(int first, int past, const double* rest, double* v, double* w);

 private:
  struct Sum {  // linear combination of v_n, w_n and the stored vectors
    double v = 0.0, w = 0.0;
    base::Weights stored{};
    void add(double by, const Sum& other);
  };
  struct Stage {
    Sum v_predicted, w_predicted, a, e;
    Sum v, w;                               // displacement and rate of the solved stage
    double rate = 0.0, displacement = 0.0;  // k1, k2
  };
  struct View {  // the vectors of the nodes [first, past)
    const double *v = nullptr, *w = nullptr;
    std::array<const double*, base::most_accelerations> stored{};
    int first = 0, past = 0;
  };
  template <int outputs>
  struct Terms;

  void fill(std::ptrdiff_t first, std::ptrdiff_t past) override;
  void fill_tile(int first, int past);
  using Ghosts = std::array<double, 2 * static_cast<std::size_t>(beam::kinds)>;  // columns next to this rank's
  struct Summand {
    const Sum& sum;
    const Ghosts& ghosts;
    Tile& to;
  };
  void measure_dissipation(int first, int past, const Ghosts& ghosts, Tile& rate, Tile& force);
  template <int outputs>
  Terms<outputs> terms_of(const std::array<const Sum*, outputs>& sums, const View& view) const;
  template <std::size_t outputs>
  void combine(const std::array<Summand, outputs>& sums, int first, int past) const;
  void add_elastic(int first, int past, Tile& v, const Tile* w, Tile& force) const;
  void add_mass_damping(int first, int past, const Tile& w, Tile& force) const;
  void add_forces(int first, int past, Tile& v, Tile* w, Tile& force) const;
  static double product_of(int block, int nodes, const Tile& x, const Tile& forces);
  Energy energy_of(int first, int past, Tile& v, Tile& w) const;
  Energy energy_of(const Sum& displacement, const Sum& rate, const std::vector<Range>& nodes);
  double at(const Sum& sum, const View& view, int unknown) const;
  View view_of(const double* v, const double* w) const;
  void end_step(const View& view, int begin, int end, double* v, double* w, double* a) const;
  void exchange_borders(std::initializer_list<const Sum*> sums);

  const beam::Beam& beam_;
  BeamOperator& operator_;
  const double* dead_load_;
  int block_;
  std::optional<beam::ElementRows> elements_;                         // only if fused
  bool proportional_ = false;                                         // C = a M + b K
  std::vector<int> held_;                                             // local unknowns that supports hold at zero
  std::array<std::vector<double>, base::most_accelerations> stored_;  // A_0, then one per stage
  int n_ = 0, nodes_ = 0;
  std::vector<Range> ranges_;
  bool has_ranges_ = false;
  std::vector<Stage> stages_;
  Sum v_end_, w_end_, a_end_, v_error_, w_error_;

  // Data of the present stage
  View view_;
  const Stage* stage_ = nullptr;
  bool measure_ = false;    // compute the dissipation at the start of steps
  bool measuring_ = false;  // compute it in this stage
  const std::vector<NodalLoad>* loads_ = nullptr;
  std::array<Ghosts, 3> ghosts_{};  // neighbours' values of e, w and w~, or of the errors of v and w
  double* target_ = nullptr;        // the solution at the first unknown of the view
  Dissipation dissipation_;
  std::array<std::vector<double>, base::most_accelerations> scratch_;  // work arrays of step_free
};

}  // namespace traverse::structure
