// Shear springs and dampers between neighbouring masses of ballast (Zhai, Wang and Lin 2004).
//
// Masses of ballast stand a bay apart, which is several columns where the rail has several elements a bay, and only
// neighbouring columns couple. So each column between two masses has a link: an unknown on the straight line between
// them, joined to its neighbours by springs and dampers of n times the shear's, n columns apart. In balance these are
// the shear's spring and damper. A link has a millionth of the ballast's mass, so that the mass matrix is regular.
#pragma once

#include "beam/layered_track.hpp"

namespace traverse::beam {

/// Calls visit(unknown, mass) for the links between two neighbours among the sleepers whose ballast shears.
template <class Visit>
void visit_links(const Sleeper& left, const Sleeper& right, const Layout& layout, Visit visit) {
  constexpr double of_ballast = 1e-6;
  const double mass = of_ballast * 0.5 * (left.values.ballast_mass + right.values.ballast_mass);
  for (int column = left.rail_node + 1; column < right.rail_node; ++column)
    visit(column * layout.block + layout.ballast_place(), mass);
}

/// Whether shear acts between two neighbours: the ballast of both moves by itself, and no bridge whose deflection takes
/// the place of links lies between them.
bool shear_between(const Sleeper& left, const Sleeper& right, const Layout& layout);

/// Neighbours in shear whose columns or links are among the columns [first, past).
std::vector<std::pair<Sleeper, Sleeper>> sheared(const Line& bridge, const Layout& layout, int first, int past);

void release_links(const Line& bridge, const Layout& layout, Slice& slice);
/// Masses of the links, and the shear's springs and dampers.
void add_shear(const Line& bridge, const Layout& layout, const Slice& slice, Rows& mass, Rows& stiffness,
               Rows& damping);

}  // namespace traverse::beam
