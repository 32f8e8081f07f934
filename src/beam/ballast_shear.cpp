// Models the shear between two ballast masses as n springs and n dampers in series, each with n times the coefficient,
// if a bay has n rail elements.
#include "beam/ballast_shear.hpp"

namespace traverse::beam {

bool shear_between(const Sleeper& left, const Sleeper& right, const Layout& layout) {
  if (!left.ballast_moves || !right.ballast_moves) return false;
  return layout.place[Kind::ballast] >= 0 || left.side == right.side;
}

std::vector<std::pair<Sleeper, Sleeper>> pairs_in_shear(const Line& bridge, const Layout& layout, int first, int past) {
  std::vector<std::pair<Sleeper, Sleeper>> pairs;
  const LayeredTrack& track = *bridge.model.track;
  if (track.shear.k == 0.0 && track.shear.c == 0.0) return pairs;
  const int elements_per_bay = track.elements_per_bay;
  const std::vector<Sleeper> sleepers = sleepers_of(bridge, first - elements_per_bay, past + elements_per_bay);
  for (std::size_t i = 0; i + 1 < sleepers.size(); ++i)
    if (shear_between(sleepers[i], sleepers[i + 1], layout)) pairs.emplace_back(sleepers[i], sleepers[i + 1]);
  return pairs;
}

void release_links(const Line& bridge, const Layout& layout, Slice& slice) {
  for (const auto& [left, right] : pairs_in_shear(bridge, layout, slice.first - 1, slice.first + slice.local + 1))
    visit_links(left, right, layout, [&](int unknown, double) { slice.release(unknown); });
}

void add_shear(const Line& bridge, const Layout& layout, const Slice& slice, Rows& mass, Rows& stiffness,
               Rows& damping) {
  const LayeredTrack& track = *bridge.model.track;
  const double n = track.elements_per_bay;
  const auto between = [](double k) { return std::array{k, -k, -k, k}; };
  for (const auto& [left, right] : pairs_in_shear(bridge, layout, slice.first - 1, slice.first + slice.local + 1)) {
    int previous = left.ballast_unknown(layout);
    const auto connect = [&](int unknown) {
      stiffness.add(std::array{previous, unknown}, between(n * track.shear.k));
      damping.add(std::array{previous, unknown}, between(n * track.shear.c));
      previous = unknown;
    };
    visit_links(left, right, layout, [&](int unknown, double link_mass) {
      mass.add(std::array{unknown}, std::array{link_mass});
      connect(unknown);
    });
    connect(right.ballast_unknown(layout));
  }
}

}  // namespace traverse::beam
