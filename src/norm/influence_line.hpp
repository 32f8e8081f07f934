// An influence line: what a unit downward force does to one quantity, over the place of the force; and the greatest
// that loads which move along it together can do.
//
// On every piece the line is a cubic polynomial of x and of one sign. Its area up to x, and that of its part above 0,
// are then polynomials too, and what a train does is a polynomial of its way between the places where one of its
// forces passes a break. The greatest of it is found exactly.
#pragma once

#include <string>
#include <vector>

#include "beam/cubic.hpp"

namespace traverse::norm {

class InfluenceLine {
 public:
  InfluenceLine() = default;
  /// A cubic of x - breaks[i] between breaks[i] and breaks[i + 1], m; outside it is zero.
  InfluenceLine(std::vector<double> breaks, std::vector<beam::Cubic> pieces);

  double value(double x) const;
  /// The line times a factor.
  InfluenceLine times(double factor) const;

  const std::vector<double>& breaks() const { return breaks_; }
  /// m times its unit: the whole area, and that of what lies above 0.
  double area() const { return area_.back(); }
  double area_above() const { return above_.back(); }

 private:
  friend struct Passing;

  void trim();
  void split_where_it_changes_sign();
  void integrate();
  std::size_t piece_at(double x) const;

  std::vector<double> breaks_;
  std::vector<beam::Cubic> pieces_;
  std::vector<double> area_, above_;  // from the first break to each break
};

/// Downward loads that pass together; x from a place that they share.
struct LoadModel {
  std::string name;    // LM71
  std::string clause;  // where it is defined; empty: a train of the user's
  struct Force {
    double force, x;  // N, m
  };
  struct Uniform {
    double load, from, to;  // N/m, m
  };
  std::vector<Force> forces;
  std::vector<Uniform> uniform;
  /// Beyond [free_from, free_to] a uniform load stands wherever it is unfavourable, N/m.
  double free_load = 0.0, free_from = 0.0, free_to = 0.0;
};

/// The greatest value of what a load does, not below 0: it need not be on the bridge.
struct Placed {
  double value = 0.0;
  double x = 0.0;  // m, where the model's x = 0 stands
};
Placed greatest(const InfluenceLine& line, const LoadModel& model);

}  // namespace traverse::norm
