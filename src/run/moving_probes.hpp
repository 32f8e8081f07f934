// The probes whose responses change: those where the structure moves, or has moved at the previous instant.
#pragma once

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "base/bytes.hpp"
#include "beam/line.hpp"
#include "recovery/recovery.hpp"
#include "structure/ranges.hpp"

namespace traverse::run {

class MovingProbes {
 public:
  MovingProbes() = default;
  /// The stations of `recovery` on a line.
  MovingProbes(const recovery::Recovery& recovery, const beam::Line& line);

  /// The next instant. moving: ranges of columns outside of which the structure is at rest; none: all move.
  void update(const std::optional<std::vector<structure::Range>>& moving);
  /// Ascending.
  const std::vector<std::size_t>& now() const { return now_; }
  void keep(base::Bytes& bytes) { bytes(before_); }

 private:
  std::vector<std::size_t> all_, now_, before_;          // ascending
  std::vector<std::pair<int, std::size_t>> in_columns_;  // ascending: columns, and the probe in each
};

}  // namespace traverse::run
