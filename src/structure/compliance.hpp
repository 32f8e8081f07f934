// Compliance of the beam at the elements under the wheels: columns of A^-1 for unit loads on an element's unknowns,
// computed when a wheel enters an element (or the shift changes) and kept, since they do not change inside it.
#pragma once

#include <list>
#include <utility>
#include <vector>

#include "structure/beam_operator.hpp"

namespace traverse::structure {

/// How elements yield to forces on each other.
class ElementCompliance {
 public:
  /// The elements that respond to a load on one of them: [first, last) of their list.
  struct Response {
    int first = 0, last = 0;
    std::size_t begin = 0;  // of their blocks
  };
  const Response& response(int b) const { return responses_[b]; }
  /// Displacement of unknown i of the element a from a unit load on unknown j of the element b, at (i, j) of a matrix
  /// of 2*per_node rows stored by columns; a in the response to b.
  const double* block(int a, int b) const {
    const Response& r = responses_[b];
    return &blocks_[r.begin + static_cast<std::size_t>(a - r.first) * m_ * m_];
  }
  /// v += the elements' response to loads on them, 2*per_node values an element.
  void respond(const std::vector<double>& loads, std::vector<double>& v) const;

 protected:
  explicit ElementCompliance(int per_node) : m_(2 * per_node) {}

  int m_;  // 2*per_node
  std::vector<Response> responses_;
  std::vector<double> blocks_;  // by the element loaded, then by the one that responds
};

class Compliance final : public ElementCompliance {
 public:
  Compliance(const beam::Beam& beam, BeamOperator& op);

  /// Collective. Prepares the compliance between `elements` for the factorisation of these shifts, with springs added
  /// where there are some.
  void prepare(double shift, double shift2, const AddedSprings* added, const std::vector<int>& elements);

  /// The same of each element by itself, its block() with itself alone; on one rank.
  void prepare_alone(double shift, double shift2, const AddedSprings* added, const std::vector<int>& elements);

  /// Collective. Columns of the beam beyond which nothing is left of a response, for these shifts; 0 where parts of the
  /// beam do not touch: it ends with the part.
  int reach(double shift, double shift2);

  /// v += A^-1 loads, where loads holds 2*per_node nodal values an element of the last prepare. This rank's slice.
  void add_response(const std::vector<double>& loads, double* v) const;
  /// The columns that are kept, of factorisations with the same stamps.
  void keep(base::Bytes& bytes);

 private:
  struct Column {
    std::size_t slot = 0;
    long stamp = 0;
    int low = 0, high = 0;       // unknowns that respond above rounding, counted from the place's
    int first = 0, last = 0;     // the columns of the beam on all ranks that do: [first, last); without parts
    std::vector<double> values;  // (high - low) x 2*per_node, column by column
    void keep(base::Bytes& bytes) { bytes(slot, stamp, low, high, first, last, values); }
  };
  /// Where an element is: equal elements of equal parts of the beam share a slot, and with it a column.
  struct Place {
    std::size_t slot = 0;
    int unknown = 0;  // local, of the part's beginning; 0 where the beam is one part
  };
  Place place_of(int element) const;
  bool find_columns();
  void forget_columns();
  const Column& column(const BeamFactor& factor, double shift, const AddedSprings* added, int element);
  std::ptrdiff_t solve_part(const BeamFactor& factor, int element);
  std::ptrdiff_t solve_window(const BeamFactor& factor, int element);
  std::ptrdiff_t solve_statics(int element, const AddedSprings* added);
  void load_element(int element, std::ptrdiff_t first, std::ptrdiff_t past);
  void keep(Column& c, std::ptrdiff_t first, int base_unknown) const;
  std::pair<int, int> reach(int element, const Column& c) const;
  void find_responses();
  void fill_blocks(bool same_factor);
  void fill_block(int a, int b, double* to) const;

  const beam::Beam& beam_;
  BeamOperator& operator_;
  const beam::Line& line_;
  bool short_parts_ = false;                          // statics part by part lose no digits
  std::vector<std::size_t> kind_slot_;                // of the first element of each kind of part
  std::list<Column> columns_;                         // most recent first
  std::size_t kept_ = 0;                              // doubles in them
  std::vector<std::list<Column>::iterator> of_slot_;  // the column of the last prepare's stamp, or the end
  struct Active {
    const Column* column;
    int unknown;      // its place's
    int first, last;  // the columns of the beam that respond: [first, last)
  };
  std::vector<Active> active_;  // of the elements of the last prepare
  std::vector<int> elements_;
  bool alone_ = false;  // the last prepare was prepare_alone
  long stamp_ = -1, reach_stamp_ = -1;
  std::ptrdiff_t margin_;  // nodes on either side of an element within which its response dies out, as found last
  struct {                 // of the prepare before
    std::vector<int> elements;
    std::vector<Response> responses;
    std::vector<double> blocks;
  } before_;
  std::vector<int> known_as_;           // of every element, its number in the list before; -1: it was not there
  std::vector<double> new_blocks_;      // those that were not known
  std::vector<std::size_t> new_begin_;  // where they go
  std::vector<double> work_;            // the columns under way: nodes x block, column by column
};

}  // namespace traverse::structure
