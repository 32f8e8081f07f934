// How the structure moves under forces on elements, by a solve for all of them at once: A z = P, with A of a stage
// (ElementStructure). On one rank, and of the nodes near the forces alone where parts of the structure do not touch.
#pragma once

#include <vector>

#include "structure/beam_operator.hpp"
#include "structure/contact_field.hpp"
#include "structure/ranges.hpp"

namespace traverse::structure {

class ContactResponse {
 public:
  /// Both must outlive it.
  ContactResponse(const beam::Beam& beam, const BeamOperator& op);

  /// Whether a solve is quicker than the columns of Compliance for forces on so many elements.
  bool worthwhile(std::size_t elements) const;
  /// The elements under forces, ascending, and the nodes that are stepped.
  void place(const std::vector<int>& elements, const std::vector<Range>& stepped);
  /// Values by this rank's unknowns.
  const ContactField& field() const { return field_; }
  /// evaluate(from, size, v, w) writes where those unknowns are without forces.
  template <class Evaluate>
  void set_free(Evaluate evaluate) {
    for_runs([&](std::ptrdiff_t from, std::ptrdiff_t size) {
      evaluate(from, static_cast<int>(size), &v_free_[static_cast<std::size_t>(from)],
               &w_free_[static_cast<std::size_t>(from)]);
    });
  }
  void clear();
  /// z of the field's loads, in their place, and the field's v.
  void solve(const BeamFactor& factor);
  /// The field's w, `shift` (1/s) times what v has changed by.
  void find_rates(double shift);
  /// x += factor z, of this rank's unknowns.
  void add(double factor, double* x) const;

 private:
  struct Run {  // of nodes: equal parts side by side, or a part of the whole chain
    std::ptrdiff_t first = 0, past = 0;
    const solve::Parts::Part* part = nullptr;  // the first of `count`
    int count = 1;
  };
  void find_runs();
  int node_of(int element) const { return line_.first_column + line_.mesh.element(element).left; }
  /// use(unknown, count) of every run.
  template <class Use>
  void for_runs(Use use) const {
    for (const Run& run : runs_) use(run.first * beam_.block(), (run.past - run.first) * beam_.block());
  }

  const beam::Beam& beam_;
  const BeamOperator& operator_;
  const beam::Line& line_;
  bool uniform_ = true;  // an element's unknowns stand alike everywhere
  std::vector<int> elements_;
  std::vector<Range> stepped_;
  std::vector<Run> runs_;
  std::vector<std::size_t> held_;  // of the elements' unknowns
  ContactField field_;
  std::vector<double> z_, v_free_, w_free_, v_, w_;
};

}  // namespace traverse::structure
