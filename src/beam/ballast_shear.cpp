// Shear between two ballast masses as n springs and n dampers in series, each with n times the coefficient, where a bay
// has n rail elements.
#include "beam/ballast_shear.hpp"

namespace traverse::beam {

bool shear_between(const Sleeper& left, const Sleeper& right, const Layout& layout) {
  if (!left.ballast_moves || !right.ballast_moves) return false;
  return layout.place[Kind::ballast] >= 0 || left.side == right.side;
}

std::vector<std::pair<Sleeper, Sleeper>> sheared(const Line& bridge, const Layout& layout, int first, int past) {
  std::vector<std::pair<Sleeper, Sleeper>> pairs;
  const LayeredTrack& track = *bridge.model.track;
  if (track.shear.k == 0.0 && track.shear.c == 0.0) return pairs;
  const int each = track.elements_per_bay;
  const std::vector<Sleeper> all = sleepers_of(bridge, first - each, past + each);
  for (std::size_t i = 0; i + 1 < all.size(); ++i)
    if (shear_between(all[i], all[i + 1], layout)) pairs.emplace_back(all[i], all[i + 1]);
  return pairs;
}

void release_links(const Line& bridge, const Layout& layout, Slice& slice) {
  for (const auto& [left, right] : sheared(bridge, layout, slice.first - 1, slice.first + slice.local + 1))
    visit_links(left, right, layout, [&](int unknown, double) { slice.release(unknown); });
}

void add_shear(const Line& bridge, const Layout& layout, const Slice& slice, Rows& mass, Rows& stiffness,
               Rows& damping) {
  const LayeredTrack& track = *bridge.model.track;
  const double n = track.elements_per_bay;
  const auto between = [](double k) { return std::array{k, -k, -k, k}; };
  for (const auto& [left, right] : sheared(bridge, layout, slice.first - 1, slice.first + slice.local + 1)) {
    int before = left.ballast_unknown(layout);
    const auto merge = [&](int unknown) {
      stiffness.add(std::array{before, unknown}, between(n * track.shear.k));
      damping.add(std::array{before, unknown}, between(n * track.shear.c));
      before = unknown;
    };
    visit_links(left, right, layout, [&](int unknown, double its_mass) {
      mass.add(std::array{unknown}, std::array{its_mass});
      merge(unknown);
    });
    merge(right.ballast_unknown(layout));
  }
}

}  // namespace traverse::beam
