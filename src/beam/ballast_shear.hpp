// Shear springs and dampers between neighbouring ballast masses (Zhai, Wang and Lin 2004).
//
// Ballast masses are a bay apart, which is several columns if the rail has several elements per bay, and only
// neighbouring columns may be coupled. Each column between two masses therefore has a link: an unknown on the straight
// line between the masses. If the masses are n columns apart, neighbouring links are connected by springs and dampers
// with n times the coefficients of the shear; in equilibrium they act as the spring and damper of the shear. A link has
// a millionth of the ballast's mass, so that the mass matrix is regular.
#pragma once

#include "beam/layered_track.hpp"

namespace traverse::beam {

/// Calls visit(unknown, mass) for the links between two neighbouring sleepers whose ballast masses are in shear.
template <class Visit>
void visit_links(const Sleeper& left, const Sleeper& right, const Layout& layout, Visit visit) {
  constexpr double mass_ratio = 1e-6;
  const double mass = mass_ratio * 0.5 * (left.values.ballast_mass + right.values.ballast_mass);
  for (int column = left.rail_node + 1; column < right.rail_node; ++column)
    visit(column * layout.block + layout.ballast_place(), mass);
}

/// Whether shear acts between two neighbours: both have a separate ballast mass, and the deflection of a bridge does
/// not use the unknowns of the links between them.
bool shear_between(const Sleeper& left, const Sleeper& right, const Layout& layout);

/// The pairs of neighbours in shear with a column or a link among the columns [first, past).
std::vector<std::pair<Sleeper, Sleeper>> pairs_in_shear(const Line& bridge, const Layout& layout, int first, int past);

void release_links(const Line& bridge, const Layout& layout, Slice& slice);
/// Adds the masses of the links and the springs and dampers of the shear.
void add_shear(const Line& bridge, const Layout& layout, const Slice& slice, Rows& mass, Rows& stiffness,
               Rows& damping);

}  // namespace traverse::beam
