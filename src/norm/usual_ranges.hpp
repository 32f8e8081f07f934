// Usual ranges of the numbers of bridges and trains, and which unit a number outside may have been given in. Each
// function returns a sentence about an unusual number, or an empty text.
#pragma once

#include <string>

namespace traverse::norm {

inline constexpr double earth = 9.81;            // m/s2
inline constexpr double fast_speed = 128.0;      // m/s: 1.2 times a line speed of 384 km/h
inline constexpr double min_bridge_span = 4.0;   // m: shortest span of a bridge
inline constexpr double lightest_bridge = 50.0;  // kg/m, of a bridge
inline constexpr double heaviest_axle = 40e3;    // kg, on rails

/// The first frequency, Hz, of a bridge with this determinant length, m, compared with EN 1991-2, figure 6.10. EI and
/// mass: what the input calls them.
std::string unusual_frequency(double n0, double length, const char* EI, const char* mass);
/// The mass of a bridge, kg/m, whose shortest span has this length, m. mass: what the input calls it.
std::string unusual_bridge_mass(double value, double span, const char* mass);
/// A damping ratio of a bridge.
std::string unusual_damping(double ratio);
/// A speed in m/s. what: what has it.
std::string unusual_speed(const std::string& what, double speed);
/// Whether a load is so light that it is rather a number of kN or t than of N: less than the heaviest axle in kN.
bool is_possibly_in_kilonewtons(double force);

}  // namespace traverse::norm
