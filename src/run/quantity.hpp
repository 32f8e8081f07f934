// The quantities whose peaks are evaluated and whose errors `accuracy` controls.
#pragma once

#include <array>
#include <cstddef>

namespace traverse::run {

enum Quantity : std::size_t {
  deflection,
  acceleration,
  moment,
  wheel_force,
  low_passed,
  shear_force,
  axial_displacement,
  axial_force,
  quantities
};
inline constexpr std::array<const char*, quantities> quantity_names = {
    "deflection", "acceleration",       "moment",     "wheel force", "low-passed acceleration",
    "shear",      "axial displacement", "axial force"};
/// Their names in options and in the results file.
inline constexpr std::array<const char*, quantities> stored_names = {
    "deflection", "acceleration",       "moment",     "wheel_force", "acceleration_lowpass",
    "shear",      "axial_displacement", "axial_force"};

inline constexpr std::array<const char*, quantities> quantity_units = {"m", "m/s2", "N m", "N", "m/s2", "N", "m", "N"};

/// Whether only single runs by elements evaluate its peaks, not runs by modes or in batches.
inline constexpr bool by_elements_only(std::size_t q) { return q >= shear_force; }

}  // namespace traverse::run
