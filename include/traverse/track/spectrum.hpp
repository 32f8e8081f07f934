// Displacement spectra of running surfaces, with one formula for roads and rails,
//
//   S(Omega) = strength/((Omega^2 + Omega_r^2) (1 + Omega^2/Omega_c^2)),  m2/(rad/m),
//
// one-sided (Omega > 0 only): its integral over a band is the mean square height of the waves in the band.
#pragma once

#include <optional>
#include <string_view>

namespace traverse::track {

struct Spectrum {
  double strength = 0.0;                 // m rad
  double flat_below = 0.0;               // Omega_r, rad/m; 0: the density increases without limit towards long waves
  double steep_above = 0.0;              // Omega_c, rad/m; infinite: the density remains proportional to Omega^-2
  double shortest = 0.0, longest = 0.0;  // m: default wavelengths

  /// One-sided power spectral density at a wavenumber (rad/m), m2/(rad/m).
  double density(double wavenumber) const;
  /// Integral of the density over wavenumbers from low to high (rad/m), m2.
  double power(double low, double high) const;
};

/// Roads, ISO 8608 (table C.1, geometric mean of the class): Gd(n) = Gd(n0)(n/n0)^-2 over n in cycles/m, n0 = 0.1,
/// Gd(n0) = 16e-6 m3 for class 'A' and four times as much for each following class; classes 'A' to 'E', 0.1 to 100 m.
Spectrum iso8608(char grade);

/// German railways, vertical profile, low or high disturbance: A_v Omega_c^2/((Omega^2 + Omega_r^2)(Omega^2 +
/// Omega_c^2)), A_v = 4.032e-7 or 1.080e-6 m rad, Omega_c = 0.8246, Omega_r = 0.0206 rad/m (after ORE B 176; in Claus
/// and Schiehlen, Modeling and simulation of railway bogie structural vibrations, Vehicle System Dynamics 29 (1998) S1,
/// 538-552). Used as a one-sided density, as in programs that sum cosines of amplitude sqrt(2 S dOmega). 0.5 to 80 m.
Spectrum german(bool high_disturbance);

/// US Federal Railroad Administration, vertical profile of track class 1 (poor) to 6 (good): k A_v Omega_c^2/(Omega^2
/// (Omega^2 + Omega_c^2)), k = 0.25, Omega_c = 0.8245 rad/m, A_v = 1.2107, 1.0181, 0.6816, 0.5376, 0.2095, 0.0339 cm2
/// rad/m (after Hamid and others, Analytical descriptions of track geometry variations, FRA/ORD-83/03.1; in Fryba,
/// Dynamics of Railway Bridges, 1996). Used as a one-sided density, as above. 1.5 to 300 m.
Spectrum fra(int grade);

/// A spectrum that users name, or several that differ by their grade.
struct SpectrumRow {
  std::string_view name;     // that the user writes, before the grade if there are several
  std::string_view grades;   // a letter each; empty: a single spectrum
  std::string_view surface;  // for -help
  Spectrum (*make)(char grade);
};

inline constexpr SpectrumRow spectra[] = {
    {"iso8608_", "ABCDE", "roads", iso8608},
    {"german_low", "", "rails", [](char) { return german(false); }},
    {"german_high", "", "rails", [](char) { return german(true); }},
    {"fra_", "123456", "rails", [](char grade) { return fra(grade - '0'); }},
};

/// The spectrum with this name; none for other names.
std::optional<Spectrum> spectrum_of(std::string_view name);

}  // namespace traverse::track
