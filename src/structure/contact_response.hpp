// The response of the structure to forces on elements, by one solution A z = P for all forces, with the matrix A of a
// stage (ElementStructure). It is for one rank; on separate parts only nodes near the forces are included.
#pragma once

#include <vector>

#include "structure/beam_operator.hpp"
#include "structure/compliance.hpp"
#include "structure/ranges.hpp"

namespace traverse::structure {

class ContactResponse {
 public:
  /// Beam and operator must outlive this object.
  ContactResponse(const beam::Beam& beam, const BeamOperator& op);

  /// Whether this is faster than the columns of Compliance for forces on so many elements.
  bool worthwhile(std::size_t elements) const;
  /// Sets the elements under forces, ascending, and the nodes in the step.
  void place(const std::vector<int>& elements, const std::vector<Range>& stepped);
  /// Values for this rank's unknowns.
  const ContactField& field() const { return field_; }
  /// evaluate(from, size, v, w) computes v and w of these unknowns without forces.
  template <class Evaluate>
  void set_free(Evaluate evaluate) {
    for_runs([&](std::ptrdiff_t from, std::ptrdiff_t size) {
      evaluate(from, static_cast<int>(size), &v_free_[static_cast<std::size_t>(from)],
               &w_free_[static_cast<std::size_t>(from)]);
    });
  }
  void clear();
  /// Replaces the field's loads by z, and computes the field's v.
  void solve(const BeamFactor& factor);
  /// Computes the field's w: its change is `shift` (1/s) times the change of v.
  void find_rates(double shift);
  /// x += factor z, of this rank's unknowns.
  void add(double factor, double* x) const;

 private:
  struct Run {  // nodes of equal neighbouring parts, or of a range of the whole chain
    std::ptrdiff_t first = 0, past = 0;
    const solve::Parts::Part* part = nullptr;  // the first of `count`
    int count = 1;
  };
  void find_runs();
  int node_of(int element) const { return line_.first_column + line_.mesh.element(element).left; }
  /// Calls use(unknown, count) for every run.
  template <class Use>
  void for_runs(Use use) const {
    for (const Run& run : runs_) use(run.first * beam_.block(), (run.past - run.first) * beam_.block());
  }

  const beam::Beam& beam_;
  const BeamOperator& operator_;
  const beam::Line& line_;
  bool uniform_ = true;  // all elements have their unknowns in the same order
  std::vector<int> elements_;
  std::vector<Range> stepped_;
  std::vector<Run> runs_;
  std::vector<std::size_t> held_;  // indices of held unknowns among the elements' unknowns
  ContactField field_;
  std::vector<double> z_, v_free_, w_free_, v_, w_;
};

}  // namespace traverse::structure
