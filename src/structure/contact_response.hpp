// How the structure moves under forces on elements, by a solve for all of them at once: A z = P, with A of a stage
// (ElementStructure). On one rank, and of the nodes near the forces alone where parts of the structure do not touch.
#pragma once

#include <utility>
#include <vector>

#include "response/beam_operator.hpp"

namespace traverse::structure {

class ContactResponse {
 public:
  /// Both must outlive it.
  ContactResponse(const beam::Beam& beam, const BeamOperator& op);

  /// Whether a solve is quicker than the columns of Compliance for forces on so many elements.
  bool worthwhile(std::size_t elements) const;
  /// The elements under forces, ascending, and the nodes [first, past) that are stepped.
  void place(const std::vector<int>& elements, int first, int past);
  /// z under `loads`: 2 per_node an element, N and N m.
  void solve(const BeamFactor& factor, const std::vector<double>& loads);
  /// Whether these are what it was solved for.
  bool solved_for(const std::vector<double>& loads) const { return solved_ && loads == loads_; }
  /// values += z of the elements' unknowns, 2 per_node each.
  void add_to_elements(std::vector<double>& values) const;
  /// x += factor z, of this rank's unknowns.
  void add(double factor, double* x) const;

 private:
  struct Run {  // of nodes: equal parts side by side, or a part of the whole chain
    std::ptrdiff_t first = 0, past = 0;
    const solve::Parts::Part* part = nullptr;  // the first of `count`
    int count = 1;
  };
  void find_runs(int first, int past);
  int node_of(int element) const { return line_.first_column + line_.mesh.element(element).left; }

  const beam::Beam& beam_;
  const BeamOperator& operator_;
  const beam::Line& line_;
  std::vector<int> elements_;
  std::pair<int, int> range_;
  std::vector<Run> runs_;
  std::vector<int> places_;  // of the elements' unknowns in z
  std::vector<double> z_, loads_;
  bool solved_ = false;
};

}  // namespace traverse::structure
