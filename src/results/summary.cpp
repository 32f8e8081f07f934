// Converts the extremes, wheel unloading, energies and step counts of a run to named attributes.
#include "summary.hpp"

#include <cmath>

namespace traverse::results {

double Summary::rest_error() const {
  return structure_energy > 0.0 ? std::sqrt(std::abs(energy_left) / structure_energy) : 0.0;
}

std::vector<Attribute> attributes_of(const Summary& summary) {
  std::vector<Attribute> list;
  const auto add = [&](const std::string& name, auto value) { list.push_back({name, value}); };
  const auto extreme = [&](const std::string& name, const Extreme& value) {
    add(name, value.value);
    add(name + "_time", value.time);
    add(name + "_place", value.place);
  };
  if (summary.probes) {
    extreme("deflection", summary.deflection);
    if (summary.relative_to_supports) add("deflection_relative_to", std::string("supports"));
    extreme("acceleration", summary.acceleration);
    if (summary.low_passed) {
      extreme("acceleration_lowpass", summary.low_passed->extreme);
      add("acceleration_lowpass_frequency", summary.low_passed->frequency);
      add("acceleration_lowpass_interval", summary.low_passed->interval);
      add("acceleration_lowpass_filter", summary.low_passed->filter);
    }
    if (summary.moments) extreme("moment", summary.moment);
    if (summary.shear) extreme("shear", *summary.shear);
    if (summary.axial_displacement) extreme("axial_displacement", *summary.axial_displacement);
    if (summary.axial_force) extreme("axial_force", *summary.axial_force);
    if (summary.static_deflection > 0.0) add("static_deflection", summary.static_deflection);
    if (summary.amplification > 0.0) add("amplification", summary.amplification);
  }
  if (!summary.least_wheel.empty()) {
    add("least_wheel_force", summary.least_wheel_force);
    add("least_wheel_force_time", summary.least_wheel_force_time);
    add("least_wheel", summary.least_wheel);
    add("greatest_wheel_force", summary.greatest_wheel_force);
  }
  if (summary.unloading) {
    add("wheel_unloading", summary.unloading->value);
    add("wheel_unloading_time", summary.unloading->time);
    add("wheel_unloading_wheel", summary.unloading->wheel);
  }
  if (summary.filtered_unloading) {
    const FilteredUnloading& filtered = *summary.filtered_unloading;
    add("wheel_unloading_lowpass", filtered.extreme.value);
    add("wheel_unloading_lowpass_time", filtered.extreme.time);
    add("wheel_unloading_lowpass_wheel", filtered.extreme.wheel);
    add("wheel_unloading_lowpass_frequency", filtered.frequency);
    add("wheel_unloading_lowpass_interval", filtered.interval);
    add("wheel_unloading_lowpass_filter", filtered.filter);
    add("unloading_level", filtered.level);
    add("unloading_longest", filtered.longest);
    if (filtered.longest > 0.0) {
      add("unloading_longest_from", filtered.longest_from);
      add("unloading_longest_wheel", filtered.longest_wheel);
    }
  }
  add("contact_losses", static_cast<long>(summary.contact_losses));
  add("longest_loss", summary.longest_loss);
  add("energy_residual", summary.energy_residual);
  add("energy_left", summary.energy_left);
  if (summary.linearisation_residual > 0.0) add("linear_defect", summary.linearisation_residual);
  add("rest_error", summary.rest_error());
  add("energy_scale", summary.energy_scale);
  add("static_error", summary.static_error);
  add("steps", summary.steps);
  add("rejected_steps", summary.rejected_steps);
  add("solves", summary.solves);
  add("factorisations", summary.factorisations);
  add("end_time", summary.end_time);
  add("wall_seconds", summary.wall_seconds);
  add("ended", summary.ended);
  for (const auto& [quantity, error] : summary.expected_errors) add("expected_error_" + quantity, error);
  return list;
}

}  // namespace traverse::results
