// Properties of a foundation: whether it is nonlinear, which kinds and directions it has, and the decay rate of bending
// on a bed.
#include "traverse/beam/foundation.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "traverse/base/error.hpp"

namespace traverse::beam {

bool Foundation::nonlinear() const {
  bool found = false;
  for_points(*this, [&](const FoundationKind&, const std::vector<PointFoundation>& points) {
    for (const PointFoundation& p : points) found = found || p.law.nonlinear();
  });
  for_beds(*this, [&](const FoundationKind&, const Bed& bed) { found = found || bed.law.nonlinear(); });
  return found;
}

std::size_t foundation_kind(std::string_view name) {
  const auto same = [&](const FoundationKind& kind) { return kind.name == name; };
  const auto kind = std::find_if(foundation_kinds.begin(), foundation_kinds.end(), same);
  if (kind == foundation_kinds.end()) throw InputError("there is no foundation_" + std::string(name));
  return static_cast<std::size_t>(kind - foundation_kinds.begin());
}

double bending_decay_rate(Direction direction, double k, double EI) {
  if (direction == Direction::vertical) return std::pow(k / (4.0 * EI), 0.25);
  return direction == Direction::rotational ? std::sqrt(std::abs(k) / EI) : 0.0;
}

bool present(const Foundation& foundation, const FoundationKind& kind) {
  return kind.points != nullptr ? !(foundation.*kind.points).empty() : (foundation.*kind.bed).has_value();
}

bool present(const Foundation& foundation, Direction direction) {
  return std::any_of(foundation_kinds.begin(), foundation_kinds.end(), [&](const FoundationKind& kind) {
    return kind.direction == direction && present(foundation, kind);
  });
}

}  // namespace traverse::beam
