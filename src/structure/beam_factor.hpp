// A factorisation of one of the beam's matrices, split over the ranks: as one chain, or part by part if its spans do
// not touch.
#pragma once

#include <optional>
#include <utility>

#include "solve/separate_parts.hpp"

namespace traverse::structure {

class BeamFactor {
 public:
  explicit BeamFactor(solve::SubstructuredCholesky whole) : whole_(std::move(whole)) {}
  explicit BeamFactor(solve::SeparateParts parts) : parts_(std::move(parts)) {}

  solve::SubstructuredCholesky& whole() { return *whole_; }
  solve::SeparateParts& parts() { return *parts_; }
  const solve::SeparateParts& parts() const { return *parts_; }

  /// Collective; see SubstructuredCholesky.
  void solve(double* x, int columns = 1) const { parts_ ? parts_->solve(x, columns) : whole_->solve(x, columns); }
  void solve(double* x, solve::RhsCallback& right_side) const {
    parts_ ? parts_->solve(x, right_side) : whole_->solve(x, right_side);
  }
  void solve_window(double* x, std::ptrdiff_t first, std::ptrdiff_t past, solve::RhsCallback& right_side) const {
    parts_ ? parts_->solve_window(x, first, past, right_side) : whole_->solve_window(x, first, past, right_side);
  }
  void solve_local(double* x, int columns, std::ptrdiff_t first, std::ptrdiff_t past) const {
    parts_ ? parts_->solve_local(x, columns, first, past) : whole_->solve_local(x, columns, first, past);
  }

 private:
  std::optional<solve::SubstructuredCholesky> whole_;
  std::optional<solve::SeparateParts> parts_;
};

}  // namespace traverse::structure
