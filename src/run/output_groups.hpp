// The groups of outputs. A new group is a function and its entry in the list.
#pragma once

#include "run/outputs.hpp"

namespace traverse::run {

using OutputGroup = void (*)(const Source& source, Outputs& outputs);

void add_couplers(const Source& source, Outputs& outputs);  // outputs_train.cpp
void add_vehicles(const Source& source, Outputs& outputs);  // outputs_train.cpp
void add_energy(const Source& source, Outputs& outputs);    // outputs.cpp
void add_probes(const Source& source, Outputs& outputs);    // outputs_beam.cpp
void add_supports(const Source& source, Outputs& outputs);  // outputs_beam.cpp
void add_balance(const Source& source, Outputs& outputs);   // outputs_beam.cpp
void add_dampers(const Source& source, Outputs& outputs);   // outputs_beam.cpp
void add_rail(const Source& source, Outputs& outputs);      // outputs_beam.cpp
/// The quantities of given modes other than deflections.
void add_outputs_of_modes(const Source& source, Outputs& outputs);  // outputs_beam.cpp
void add_foundation(const Source& source, Outputs& outputs);        // outputs.cpp
void add_hanging(const Source& source, Outputs& outputs);           // outputs.cpp
void add_sleepers(const Source& source, Outputs& outputs);          // outputs.cpp

inline constexpr OutputGroup output_groups[] = {add_couplers, add_vehicles, add_energy};
inline constexpr OutputGroup output_groups_of_a_bridge[] = {add_probes,           add_supports, add_foundation,
                                                            add_balance,          add_dampers,  add_rail,
                                                            add_outputs_of_modes, add_hanging,  add_sleepers};

}  // namespace traverse::run
