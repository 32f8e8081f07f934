// The track's profile h(x): the height of the running surface before any deflection, with its derivatives.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "traverse/track/spectrum.hpp"
#include "traverse/track/waves.hpp"

namespace traverse::track {

/// A local depression of the running surface, m. With s = (x - middle)/(length/2), -1 <= s <= 1, its depth without a
/// corner is a cosine, depth/2*(1 + cos(pi s)), as at a weld. With a corner it is two parabolas that intersect at the
/// lowest point, depth*(1 - abs(s))^2, as at a dipped rail joint. A negative depth is a hump, which has no corner.
struct Dip {
  double middle = 0.0, length = 0.0, depth = 0.0;
  bool corner = false;
  /// The height, negative in a dip, and its derivatives.
  Height at(double x) const;
};

/// h(x), twice differentiable except at `kinks`.
class Profile {
 public:
  Profile() = default;  // level
  /// A bump of the height height/2*(1 - cos(2 pi (x - start)/length)) inside [start, start + length].
  static Profile bump(double start, double length, double height);
  /// Straight lines through a table, with the end values outside. Each corner is rounded within 0.25 m of its row, or
  /// within the distance to the nearer row if that is shorter. The rows of a measured profile then result in a smooth
  /// curve through all of them (a cubic Hermite spline), distant rows in straight lines.
  static Profile lines(std::vector<double> x, std::vector<double> h, const std::string& name);
  /// Natural cubic spline through a table, with the end values outside. Throws InputError if it overshoots far beside a
  /// jump of the table.
  static Profile spline(std::vector<double> x, std::vector<double> h, const std::string& name);
  /// Roughness of a spectrum: a sum of 240 cosines with random phases from a seed. Their wavelengths have a logarithmic
  /// spacing from `shortest` to `longest` (m), and each has the power of its band. The roughness grows from zero at
  /// `start` over 20 m, or over a fifth of the longest wave if that is more, so that a train starts on level track.
  static Profile rough(const Spectrum& spectrum, double shortest, double longest, double start, std::uint64_t seed);
  /// Roughness between the shortest and the longest wavelength of the spectrum.
  static Profile rough(const Spectrum& spectrum, double start, std::uint64_t seed) {
    return rough(spectrum, spectrum.shortest, spectrum.longest, start, seed);
  }

  /// The mirrored profile h(-x). Roughness that grows to the right from `start` then grows to the left from -start.
  Profile reversed() const;

  /// This profile with an added dip. Throws InputError if the numbers of the dip are invalid.
  Profile with(const Dip& dip) const;

  /// Whether the surface is flat everywhere, and whether it is a sum of random waves.
  bool level() const { return kind_ == Kind::level && dips_.empty(); }
  bool is_rough() const { return kind_ == Kind::waves; }
  /// Whether a dip overlaps [from, to].
  bool has_dip(double from, double to) const;
  Height at(double x) const;
  /// The heights at `count` stations from x with the spacing `distance`; for roughness much faster than `at`.
  std::vector<Height> along(double x, double distance, std::size_t count) const;
  /// Stations at which the slope or curvature jumps; time steps end when wheels pass them.
  const std::vector<double>& kinks() const { return kinks_; }
  /// Upper bound of the curvature of valleys, h''/(1 + h'^2)^1.5 (1/m; for roughness six standard deviations of h''). A
  /// wheel of radius R with 1/R above this bound touches at one point only. The curvature of crests is not limited. The
  /// bound is infinite for a spline with a corner at its end, where the level ground begins.
  double greatest_valley() const { return greatest_valley_; }
  /// Upper bound of |h'|; for roughness six standard deviations.
  double greatest_slope() const { return greatest_slope_; }
  /// The spacing of stations that resolves every crest and valley, m.
  double resolution() const { return resolution_; }
  /// The station in [from, to] at which the curve of a table has its largest curvature, m; `from` without a table.
  double sharpest_place(double from, double to) const;
  /// The distance over which roughness grows to its full height, m; 0 for other profiles.
  double fade() const { return is_rough() ? length_ : 0.0; }
  /// The next station after x in a sequence that resolves every crest and valley with a curvature above `curvature`
  /// (1/m). In a table it is the next row if the curvature is smaller up to this row.
  double next_station(double x, double curvature) const;
  /// Length of the bump, the shortest dip or the shortest wave of roughness, m; infinite for level tracks and tables.
  double shortest_wave() const;

 private:
  enum class Kind { level, bump, table, waves };
  Height base_at(double x) const;
  Height with_dips(double x, Height height) const;
  void check_overshoot(const std::string& name) const;
  void bound_table();
  /// h'' at both ends of the table's cubic between stations i and i + 1.
  std::pair<double, double> curvatures(std::size_t i) const;

  Height unmirrored_at(double x) const;

  Kind kind_ = Kind::level;
  bool reversed_ = false;
  double start_ = 0.0, length_ = 0.0,
         height_ = 0.0;                // length_: length of the bump, or length over which roughness grows
  std::vector<double> x_, h_, slope_;  // table: between neighbouring stations the curve is a cubic
  Waves waves_;
  std::vector<Dip> dips_;  // by ascending middle
  double longest_dip_ = 0.0;
  std::vector<double> kinks_;
  double greatest_valley_ = 0.0, greatest_slope_ = 0.0, resolution_ = 0.0;
};

}  // namespace traverse::track
