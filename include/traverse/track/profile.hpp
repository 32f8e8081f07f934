// The track's profile h(x): the running surface before anything deflects, with its derivatives.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "traverse/track/spectrum.hpp"
#include "traverse/track/waves.hpp"

namespace traverse::track {

/// A place where the running surface lies lower, m: of a cosine, depth/2*(1 + cos(2 pi (x - middle)/length)) deep, as
/// of a weld, or with a corner, two parabolas that meet at their lowest point, depth*(1 - |x - middle|/(length/2))^2
/// deep, as of a dipped rail joint. A depth below 0 is a hump; at a corner there is none.
struct Dip {
  double middle = 0.0, length = 0.0, depth = 0.0;
  bool corner = false;
  /// The height, below 0 in a dip, and its derivatives.
  Height at(double x) const;
};

/// h(x), twice differentiable except at `kinks`.
class Profile {
 public:
  Profile() = default;  // level
  /// height/2*(1 - cos(2 pi (x - start)/length)) inside [start, start + length].
  static Profile bump(double start, double length, double height);
  /// Straight lines through a table, level with its end values outside. Each corner is rounded within 0.25 m of its
  /// row, or as far as the nearer row where that is closer: rows of a measured profile then give a smooth curve through
  /// all of them (a cubic Hermite spline), rows far apart straight lines.
  static Profile lines(std::vector<double> x, std::vector<double> h, const std::string& name);
  /// Natural cubic spline through a table, level with its end values outside. InputError where it swings far out beside
  /// a jump of the table.
  static Profile spline(std::vector<double> x, std::vector<double> h, const std::string& name);
  /// Roughness of a spectrum: a sum of 240 cosines with random phases from a seed, wavelengths from `shortest` to
  /// `longest` (m) in log spacing, each with the power of its band; faded in from `start` over 20 m, or a fifth of the
  /// longest wave where that is more, so that a train starts on level track.
  static Profile rough(const Spectrum& spectrum, double shortest, double longest, double start, std::uint64_t seed);
  /// The same between the spectrum's own wavelengths.
  static Profile rough(const Spectrum& spectrum, double start, std::uint64_t seed) {
    return rough(spectrum, spectrum.shortest, spectrum.longest, start, seed);
  }

  /// The same for somebody who looks from the other side: h(-x). Of roughness: what fades in to the right from `start`
  /// on does so to the left from -start on.
  Profile reversed() const;

  /// The same profile with a dip on top. InputError where its numbers are none of a dip.
  Profile with(const Dip& dip) const;

  /// Whether the surface is flat everywhere, and whether it is a sum of random waves.
  bool level() const { return kind_ == Kind::level && dips_.empty(); }
  bool is_rough() const { return kind_ == Kind::waves; }
  /// Whether a dip reaches into [from, to].
  bool has_dip(double from, double to) const;
  Height at(double x) const;
  /// The same at `count` places from x on, `distance` apart: of roughness in much less time.
  std::vector<Height> along(double x, double distance, std::size_t count) const;
  /// Stations where the slope or curvature jumps: integration steps end where wheels pass them.
  const std::vector<double>& kinks() const { return kinks_; }
  /// Upper bound of the curvature of valleys, h''/(1 + h'^2)^1.5 (1/m; for roughness six standard deviations of h''): a
  /// wheel of radius R with 1/R above it touches at one point only. Crests may be as sharp as they like. Infinite for a
  /// spline that meets the level ground before or behind it at a corner.
  double greatest_valley() const { return greatest_valley_; }
  /// Upper bound of |h'|, for roughness six standard deviations.
  double greatest_slope() const { return greatest_slope_; }
  /// Stations this far apart (m) show every crest and valley.
  double resolution() const { return resolution_; }
  /// The station in [from, to] where a table's curve is most sharply bent, m; `from` where there is no table.
  double sharpest_place(double from, double to) const;
  /// Of roughness the way over which it grows to its height from where it starts, m; else 0.
  double fade() const { return is_rough() ? length_ : 0.0; }
  /// The next station behind x of those that show every crest and valley more sharply bent than `curvature` (1/m): of a
  /// table the next row where it is bent less up to there.
  double next_station(double x, double curvature) const;
  /// Length of the bump, of the shortest dip or of the shortest wave of roughness, m; infinite for level tracks and
  /// tables.
  double shortest_wave() const;

 private:
  enum class Kind { level, bump, table, waves };
  Height base_at(double x) const;
  Height with_dips(double x, Height height) const;
  void check_swing(const std::string& name) const;
  void bound_table();
  /// h'' at both ends of a table's cubic between stations i and i + 1.
  std::pair<double, double> curvatures(std::size_t i) const;

  Height ahead(double x) const;

  Kind kind_ = Kind::level;
  bool reversed_ = false;
  double start_ = 0.0, length_ = 0.0, height_ = 0.0;  // length: of the bump, or of the fade
  std::vector<double> x_, h_, slope_;                 // table: between these stations the curve is a cubic
  Waves waves_;
  std::vector<Dip> dips_;  // by ascending middle
  double longest_dip_ = 0.0;
  std::vector<double> kinks_;
  double greatest_valley_ = 0.0, greatest_slope_ = 0.0, resolution_ = 0.0;
};

}  // namespace traverse::track
