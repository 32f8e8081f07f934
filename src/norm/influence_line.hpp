// An influence line: the value of one quantity under a unit downward force, over the position of the force; and the
// greatest value under loads that move along it together.
//
// On every piece the line is a cubic polynomial of x with one sign. The area below it up to x, and the area of its part
// above 0, are then polynomials too. Between two positions at which one of its forces passes a break, the effect of a
// train is a polynomial of its position. Therefore its greatest value is computed exactly.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "beam/shape.hpp"

namespace traverse::norm {

class InfluenceLine {
 public:
  InfluenceLine() = default;
  /// A cubic of x - breaks[i] between breaks[i] and breaks[i + 1], m; zero outside.
  InfluenceLine(std::vector<double> breaks, std::vector<beam::Cubic> pieces);

  double value(double x) const;
  /// The line times a factor.
  InfluenceLine times(double factor) const;

  const std::vector<double>& breaks() const { return breaks_; }
  /// The whole area of the line, and the area of its part above 0, in m times the unit of the line.
  double area() const { return area_.back(); }
  double area_above() const { return above_.back(); }

 private:
  friend struct MovingLoadModel;

  void trim();
  void split_at_zeros();
  void integrate();
  std::size_t piece_at(double x) const;

  std::vector<double> breaks_;
  std::vector<beam::Cubic> pieces_;
  std::vector<double> area_, above_;  // from the first break to each break
};

/// Downward loads that move together; x is relative to a common origin.
struct LoadModel {
  std::string name;    // LM71
  std::string clause;  // clause of its definition; empty: a train of the user
  struct Force {
    double force, x;  // N, m
  };
  struct Uniform {
    double load, from, to;  // N/m, m
  };
  std::vector<Force> forces;
  std::vector<Uniform> uniform;
  /// A uniform load outside [free_from, free_to], only where it is unfavourable, N/m.
  double free_load = 0.0, free_from = 0.0, free_to = 0.0;
  /// The range of positions of x = 0, m.
  double first = -std::numeric_limits<double>::infinity(), last = std::numeric_limits<double>::infinity();
};

/// The greatest effect of a load, not below 0, because it may be outside the bridge.
struct Placed {
  double value = 0.0;
  double x = 0.0;  // m, position of the model's x = 0
};
Placed greatest(const InfluenceLine& line, const LoadModel& model);

}  // namespace traverse::norm
