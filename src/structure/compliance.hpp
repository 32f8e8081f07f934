// Compliance of the beam at the elements under the wheels: columns of A^-1 for unit loads on an element's unknowns.
// They are computed when a wheel enters an element (or the shift changes) and stored, since they are constant inside
// the element.
#pragma once

#include <array>
#include <list>
#include <utility>
#include <vector>

#include "structure/beam_operator.hpp"

namespace traverse::structure {

/// Values at the unknowns of the elements under contacts. The index of unknown k of an element, in the order of
/// beam::Line::unknowns, is its slot plus offset[k].
struct ContactField {
  std::array<int, 6> offset{};
  std::vector<int> slot;                    // slot of each element
  int ground = 0;                           // a slot with zeros, for rigid ground
  bool of_list = false;                     // slots are places in the list of elements
  const double *v = nullptr, *w = nullptr;  // m and rad; their rates
  double* load = nullptr;                   // N, N m
};

/// The displacements of elements under forces on each other.
class ElementCompliance {
 public:
  /// The elements that respond to a load on one element: [first, last) of the list.
  struct Response {
    int first = 0, last = 0;
    std::size_t begin = 0;  // index of the first value of their blocks
  };
  const Response& response(int b) const { return responses_[b]; }
  /// The displacement of unknown i of element a under a unit load on unknown j of element b, at (i, j) of a matrix of
  /// 2*per_node rows stored by columns; a must be in the response to b.
  const double* block(int a, int b) const {
    const Response& r = responses_[b];
    return &blocks_[r.begin + static_cast<std::size_t>(a - r.first) * m_ * m_];
  }
  /// v += response of the elements to loads on them, 2*per_node values for each element.
  void respond(const std::vector<double>& loads, std::vector<double>& v) const;

 protected:
  explicit ElementCompliance(int per_node) : m_(2 * per_node) {}

  int m_;  // 2*per_node
  std::vector<Response> responses_;
  std::vector<double> blocks_;  // by loaded element, then by responding element
};

class Compliance final : public ElementCompliance {
 public:
  Compliance(const beam::Beam& beam, BeamOperator& op);

  /// Collective. Computes the compliance between `elements` for the factorisation of these shifts with added springs,
  /// if any.
  void prepare(double shift, double shift2, const AddedSprings* added, const std::vector<int>& elements);

  /// Like prepare(), but only for the compliance of each element under forces on itself. On one rank.
  void prepare_individual(double shift, double shift2, const AddedSprings* added, const std::vector<int>& elements);

  /// Collective. The distance in columns of the beam beyond which a response is negligible, for these shifts. 0 if the
  /// beam has connected parts, because a response ends with its part.
  int reach(double shift, double shift2);

  /// v += A^-1 loads, with 2*per_node nodal values for each element of the last prepare. This rank's slice.
  void add_response(const std::vector<double>& loads, double* v) const;
  /// Writes or reads the stored columns, for factorisations with the same stamps.
  void keep(base::Bytes& bytes);

 private:
  struct Column {
    std::size_t slot = 0;
    long stamp = 0;
    int low = 0, high = 0;       // range of unknowns whose response exceeds rounding, counted from Place::unknown
    int first = 0, last = 0;     // beam columns on all ranks that respond: [first, last); without parts
    std::vector<double> values;  // (high - low) x 2*per_node, column by column
    void keep(base::Bytes& bytes) { bytes(slot, stamp, low, high, first, last, values); }
  };
  /// The place of an element: equal elements of equal parts of the beam share a slot, and thus a column.
  struct Place {
    std::size_t slot = 0;
    int unknown = 0;  // first local unknown of the part; 0 if the beam is one part
  };
  Place place_of(int element) const;
  bool find_columns();
  void delete_columns();
  const Column& column(const BeamFactor& factor, double shift, const AddedSprings* added, int element);
  std::ptrdiff_t solve_part(const BeamFactor& factor, int element);
  std::ptrdiff_t solve_window(const BeamFactor& factor, int element);
  std::ptrdiff_t solve_statics(int element, const AddedSprings* added);
  void load_element(int element, std::ptrdiff_t first, std::ptrdiff_t past);
  void store(Column& c, std::ptrdiff_t first, int base_unknown) const;
  std::pair<int, int> reach(int element, const Column& c) const;
  void find_responses();
  void fill_blocks(bool same_factor);
  void fill_block(int a, int b, double* to) const;

  const beam::Beam& beam_;
  BeamOperator& operator_;
  const beam::Line& line_;
  bool short_parts_ = false;                          // statics by parts lose no digits
  std::vector<std::size_t> kind_slot_;                // slot of the first element of each kind of part
  std::list<Column> columns_;                         // most recent first
  std::size_t stored_values_ = 0;                     // number of stored values
  std::vector<std::list<Column>::iterator> of_slot_;  // column with the stamp of the last prepare, or the end
  struct Active {
    const Column* column;
    int unknown;      // first local unknown of its part; 0 if the beam is one part
    int first, last;  // beam columns that respond: [first, last)
  };
  std::vector<Active> active_;  // active entries for the elements of the last prepare
  std::vector<int> elements_;
  bool individual_ = false;  // the last prepare was prepare_individual
  long stamp_ = -1, reach_stamp_ = -1;
  std::ptrdiff_t margin_;  // last half width of windows, in nodes on each side of an element
  struct {                 // results of the previous prepare
    std::vector<int> elements;
    std::vector<Response> responses;
    std::vector<double> blocks;
  } before_;
  std::vector<int> previous_index_;     // index of each element in the previous list; -1: not in that list
  std::vector<double> new_blocks_;      // blocks that are not in the previous list
  std::vector<std::size_t> new_begin_;  // their positions in blocks_
  std::vector<double> work_;            // solutions: nodes x block, column by column
};

}  // namespace traverse::structure
