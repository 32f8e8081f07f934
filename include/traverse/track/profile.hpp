// The track's profile h(x): the running surface before anything deflects, with its derivatives.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace traverse::track {

struct Height {
  double value = 0.0;      // m
  double slope = 0.0;      // 1
  double curvature = 0.0;  // 1/m
};

/// h(x), twice differentiable except at `kinks`.
class Profile {
 public:
  Profile() = default;  // level
  /// height/2*(1 - cos(2 pi (x - start)/length)) inside [start, start + length].
  static Profile bump(double start, double length, double height);
  /// Natural cubic spline through a table, level with its end values outside.
  static Profile table(std::vector<double> x, std::vector<double> h, const std::string& name);
  /// ISO 8608 class 'A'..'E': a sum of cosines with random phases from a seed, spatial frequencies 0.01 to 10
  /// cycles/m in log spacing, displacement spectrum Gd(n) = Gd(n0)(n/n0)^-2, n0 = 0.1 cycles/m, geometric mean of
  /// the class; faded in over the first 20 m from `start` so that a train starts on level track.
  static Profile iso8608(char grade, double start, std::uint64_t seed);

  bool level() const { return kind_ == Kind::level; }
  Height at(double x) const;
  /// Stations where the slope or curvature jumps: integration steps end where wheels pass them.
  const std::vector<double>& kinks() const { return kinks_; }
  /// Upper bound of |curvature| (1/m; for ISO 8608 six standard deviations of it): a wheel of radius R needs 1/R above
  /// it to touch at one point only.
  double greatest_curvature() const { return greatest_curvature_; }

 private:
  enum class Kind { level, bump, table, waves };
  Kind kind_ = Kind::level;
  double start_ = 0.0, length_ = 0.0, height_ = 0.0;
  std::vector<double> x_, h_, h2_;                     // table
  std::vector<double> amplitude_, frequency_, phase_;  // waves: m, cycles/m, cycles
  std::vector<double> kinks_;
  double greatest_curvature_ = 0.0;
};

}  // namespace traverse::track
