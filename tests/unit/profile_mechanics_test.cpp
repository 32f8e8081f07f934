// Track profiles: derivatives against differences, kinks, the levels of the spectra.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <fstream>
#include <iterator>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "support/folders.hpp"
#include "traverse/base/error.hpp"
#include "traverse/track/profile.hpp"

namespace traverse::track {
namespace {

constexpr double pi = std::numbers::pi;

void expect_derivatives(const Profile& p, const std::vector<double>& stations, double d = 1e-5) {
  const double bound = p.greatest_valley();
  for (double x : stations) {
    const Height h = p.at(x), right = p.at(x + d), left = p.at(x - d);
    EXPECT_NEAR(h.slope, (right.value - left.value) / (2.0 * d), 1e-5 * bound * 1.0 + 1e-10) << "x = " << x;
    EXPECT_NEAR(h.curvature, (right.slope - left.slope) / (2.0 * d), 1e-4 * bound + 1e-10) << "x = " << x;
    EXPECT_LE(h.curvature / std::pow(1.0 + h.slope * h.slope, 1.5), bound * (1.0 + 1e-12));
    EXPECT_LE(std::abs(h.slope), p.greatest_slope() * (1.0 + 1e-12));
  }
}

TEST(Profile, LevelByDefault) {
  const Profile p;
  EXPECT_TRUE(p.level());
  EXPECT_EQ(p.at(3.0).value, 0.0);
  EXPECT_TRUE(p.kinks().empty());
}

TEST(Profile, Bump) {
  const Profile p = Profile::bump(10.0, 1.0, 0.01);
  EXPECT_FALSE(p.level());
  EXPECT_DOUBLE_EQ(p.at(10.5).value, 0.01);
  EXPECT_NEAR(p.at(10.25).value, 0.005, 1e-15);
  EXPECT_EQ(p.at(9.999).value, 0.0);
  EXPECT_EQ(p.at(11.001).value, 0.0);
  EXPECT_EQ(p.kinks(), (std::vector<double>{10.0, 11.0}));
  EXPECT_NEAR(p.greatest_valley(), 0.005 * 4.0 * pi * pi, 1e-12);
  expect_derivatives(p, {9.5, 10.1, 10.3, 10.5, 10.77, 12.0});
  EXPECT_THROW(Profile::bump(0.0, 0.0, 0.01), InputError);
  EXPECT_THROW(Profile::bump(0.0, 1.0, std::numeric_limits<double>::quiet_NaN()), InputError);
}

TEST(Profile, TableIsANaturalSpline) {
  std::vector<double> x, h;
  for (int i = 0; i <= 40; ++i) {
    x.push_back(0.5 * i);
    h.push_back(0.002 * std::sin(0.6 * x.back()));
  }
  const Profile p = Profile::spline(x, h, "t.csv");
  for (std::size_t i = 0; i < x.size(); ++i) EXPECT_NEAR(p.at(x[i]).value, h[i], 1e-16);
  // away from the ends the spline's error is of order (0.6*0.5)^4/384
  EXPECT_NEAR(p.at(9.7).value, 0.002 * std::sin(0.6 * 9.7), 0.002 * 3e-5);
  expect_derivatives(p, {0.3, 1.2, 5.1, 10.4, 19.9});
  EXPECT_EQ(p.at(-5.0).value, h.front());
  EXPECT_EQ(p.at(50.0).value, h.back());
  EXPECT_EQ(p.at(50.0).slope, 0.0);
  EXPECT_EQ(p.kinks(), (std::vector<double>{0.0, 20.0}));
  EXPECT_NEAR(p.at(0.0).curvature, 0.0, 1e-15);
}

// Rows far apart are joined by straight lines; a corner is rounded within 0.25 m of its row, without a jump of the
// slope.
TEST(Profile, FewRowsAreStraightLines) {
  const Profile p = Profile::lines({-400.0, 0.0, 100.0}, {20.0, 0.0, 0.0}, "ramp.csv");
  EXPECT_DOUBLE_EQ(p.at(-200.0).value, 10.0);
  EXPECT_DOUBLE_EQ(p.at(-200.0).slope, -0.05);
  EXPECT_NEAR(p.at(-0.2501).value, 0.05 * 0.2501, 1e-12);
  EXPECT_EQ(p.at(0.2501).value, 0.0);
  EXPECT_EQ(p.at(0.0).value, 0.0);
  EXPECT_NEAR(p.at(0.0).slope, -0.025, 1e-15);
  EXPECT_EQ(p.at(-401.0).value, 20.0);
  EXPECT_EQ(p.kinks(), (std::vector<double>{-400.25, 100.0 + 0.25}));
  EXPECT_DOUBLE_EQ(p.greatest_valley(), 0.05 / 0.25 * 2.0);  // the corner's curvature, which falls to both sides
  EXPECT_DOUBLE_EQ(p.sharpest_place(-100.0, 50.0), 0.0);
  EXPECT_DOUBLE_EQ(p.reversed().sharpest_place(-50.0, 100.0), 0.0);
  expect_derivatives(p, {-400.1, -400.0 + 1e-3, -300.0, -0.2, -0.1, 0.1, 0.2, 50.0});
  for (const double x : {-400.25, -400.0, -399.75, -0.25, 0.0, 0.25})
    EXPECT_NEAR(p.at(x - 1e-9).slope, p.at(x + 1e-9).slope, 1e-8) << x;
}

// A measured profile passes through its rows as a smooth curve: of equal distances a cubic Hermite spline whose slopes
// are central differences. Its error is of order (0.6*0.25)^3. Events of a run are its ends only.
TEST(Profile, DenseRowsAreASmoothCurve) {
  std::vector<double> x, h;
  for (int i = 0; i <= 80; ++i) {
    x.push_back(0.25 * i);
    h.push_back(0.002 * std::sin(0.6 * x.back()));
  }
  const Profile p = Profile::lines(x, h, "t.csv");
  for (std::size_t i = 1; i + 1 < x.size(); ++i) {
    EXPECT_NEAR(p.at(x[i]).value, h[i], 1e-16);
    EXPECT_NEAR(p.at(x[i]).slope, (h[i + 1] - h[i - 1]) / 0.5, 1e-15);
  }
  for (const double at : {0.8, 7.1, 9.7}) EXPECT_NEAR(p.at(at).value, 0.002 * std::sin(0.6 * at), 0.002 * 1e-4);
  expect_derivatives(p, {0.3, 1.2, 5.1, 10.4, 19.9});
  EXPECT_EQ(p.kinks().size(), 2U);
  EXPECT_DOUBLE_EQ(p.resolution(), 0.0625);
}

// A step of height within a millimetre stays a step: what is beside it stays within a fifteenth of it.
TEST(Profile, AStepStaysAStep) {
  const Profile p = Profile::lines({0.0, 1.0, 1.001, 2.0}, {0.0, 0.0, 0.01, 0.01}, "kerb.csv");
  EXPECT_EQ(p.at(0.998).value, 0.0);
  EXPECT_DOUBLE_EQ(p.at(1.0025).value, 0.01);
  for (int i = 0; i <= 400; ++i) {
    const double value = p.at(0.998 + 1e-5 * i).value;
    EXPECT_GT(value, -0.01 / 13.0);
    EXPECT_LT(value, 0.01 + 0.01 / 13.0);
  }
  expect_derivatives(p, {0.5, 0.9996, 1.0003, 1.0007, 1.0013}, 1e-8);
}

// Crests do not count, and a steep valley is less sharp than its second derivative: a parabola's h'' over
// (1 + h'^2)^1.5, where a natural spline through it keeps away from its ends.
TEST(Profile, BoundsOfTables) {
  const Profile crest = Profile::spline({0.0, 1.0, 2.0}, {0.0, 1.0, 0.0}, "t.csv");
  EXPECT_EQ(crest.greatest_valley(), std::numeric_limits<double>::infinity());  // corners at its feet
  EXPECT_EQ(Profile::spline({0.0, 1.0, 2.0}, {0.0, 0.001, 0.0}, "t.csv").greatest_valley(), 0.0);  // hardly any
  EXPECT_DOUBLE_EQ(crest.greatest_slope(), 1.5);  // h'' = -3 at the top, straight at the ends
  const Profile valley = Profile::spline({0.0, 1.0, 2.0}, {0.0, -1.0, 0.0}, "t.csv");
  EXPECT_DOUBLE_EQ(valley.greatest_valley(), 3.0);
  for (const Profile& p :
       {Profile::spline({0.0, 0.3, 1.0, 1.2, 2.0}, {0.0, 0.3, 0.2, -0.1, 0.4}, "t.csv"), crest, valley}) {
    double slope = 0.0, sharpest = 0.0;
    for (int i = 0; i <= 20000; ++i) {
      const Height h = p.at(1e-4 * i);
      slope = std::max(slope, std::abs(h.slope));
      sharpest = std::max(sharpest, h.curvature / std::pow(1.0 + h.slope * h.slope, 1.5));
    }
    EXPECT_NEAR(p.greatest_slope(), slope, 1e-6 * slope);
    EXPECT_GE(p.greatest_valley(), sharpest * (1.0 - 1e-12));
  }
}

// On top of a bump: values by hand, derivatives by differences, stations where they jump.
TEST(Profile, DipsOnTop) {
  const Profile weld = Profile().with({3.0, 1.0, -2e-3, false}), joint = Profile().with({3.0, 1.0, 2e-3, true});
  EXPECT_FALSE(weld.level());
  EXPECT_DOUBLE_EQ(weld.at(3.0).value, 2e-3);
  EXPECT_NEAR(weld.at(3.25).value, 1e-3, 1e-15);
  EXPECT_DOUBLE_EQ(joint.at(3.0).value, -2e-3);
  EXPECT_DOUBLE_EQ(joint.at(3.25).value, -5e-4);
  EXPECT_NEAR(joint.at(3.0 + 1e-12).slope - joint.at(3.0 - 1e-12).slope, 8.0 * 2e-3 / 1.0, 1e-12);
  EXPECT_EQ(weld.at(3.5001).value, 0.0);
  EXPECT_EQ(weld.kinks(), (std::vector<double>{2.5, 3.5}));
  EXPECT_EQ(joint.kinks(), (std::vector<double>{2.5, 3.0, 3.5}));
  EXPECT_TRUE(std::isinf(joint.greatest_valley()));
  EXPECT_DOUBLE_EQ(joint.shortest_wave(), 1.0);
  const Profile all = Profile::bump(1.0, 4.0, 5e-3).with({3.0, 1.0, 2e-3, true}).with({2.5, 0.6, 1e-3, false});
  constexpr double h = 1e-5;
  for (const double x : {1.3, 2.3, 2.51, 2.9, 3.1, 3.4, 4.2}) {
    const track::Height a = all.at(x - h), b = all.at(x), c = all.at(x + h);
    EXPECT_NEAR(b.slope, (c.value - a.value) / (2 * h), 1e-9) << x;
    EXPECT_NEAR(b.curvature, (c.slope - a.slope) / (2 * h), 1e-6) << x;
    const double alone = Profile::bump(1.0, 4.0, 5e-3).at(x).value +
                         Profile().with({3.0, 1.0, 2e-3, true}).at(x).value +
                         Profile().with({2.5, 0.6, 1e-3, false}).at(x).value;
    EXPECT_DOUBLE_EQ(b.value, alone);
  }
  EXPECT_THROW(Profile().with({3.0, 1.0, -1e-3, true}), InputError);
  EXPECT_THROW(Profile().with({3.0, 0.0, 1e-3, false}), InputError);
}

// Whichever way round it is looked at, and at many places at once.
TEST(Profile, DipsOnARoughTrack) {
  const track::Dip joint{41.0, 1.0, 2e-3, true}, weld{43.5, 0.8, -3e-4, false};
  const Profile rough = Profile::rough(track::german(false), 0.0, 1), both = rough.with(joint).with(weld);
  EXPECT_TRUE(both.is_rough());
  EXPECT_DOUBLE_EQ(both.shortest_wave(), track::german(false).shortest);
  EXPECT_EQ(both.kinks().size(), 5U);
  const Profile back = both.reversed(),
                as_seen = rough.reversed().with({-41.0, 1.0, 2e-3, true}).with({-43.5, 0.8, -3e-4, false});
  const std::vector<track::Height> at_once = both.along(40.0, 0.01, 400);
  for (std::size_t i = 0; i < at_once.size(); ++i) {
    const double x = 40.0 + 0.01 * static_cast<double>(i);
    const track::Height a = rough.at(x), b = joint.at(x), c = weld.at(x), sum = both.at(x);
    EXPECT_DOUBLE_EQ(sum.value, a.value + b.value + c.value);
    EXPECT_DOUBLE_EQ(sum.slope, a.slope + b.slope + c.slope);
    EXPECT_DOUBLE_EQ(sum.curvature, a.curvature + b.curvature + c.curvature);
    EXPECT_NEAR(at_once[i].value, sum.value, 1e-12);
    EXPECT_NEAR(at_once[i].slope, sum.slope, 1e-10);
    for (const Profile& turned : {back, as_seen}) {
      EXPECT_DOUBLE_EQ(turned.at(-x).value, sum.value);
      EXPECT_DOUBLE_EQ(turned.at(-x).slope, -sum.slope);
    }
    EXPECT_EQ(both.has_dip(x - 0.05, x + 0.05), (x > 40.45 && x < 41.55) || (x > 43.05 && x < 43.95)) << x;
    EXPECT_EQ(both.has_dip(x - 0.05, x + 0.05), back.has_dip(-x - 0.05, -x + 0.05)) << x;
  }
}

TEST(Profile, TwoPointsAreALine) {
  const Profile p = Profile::spline({0.0, 2.0}, {0.0, 0.1}, "t.csv");
  EXPECT_DOUBLE_EQ(p.at(1.0).value, 0.05);
  EXPECT_DOUBLE_EQ(p.at(1.0).slope, 0.05);
}

TEST(Profile, BadTablesAreRefusedByName) {
  EXPECT_THROW(Profile::spline({0.0}, {0.0}, "t.csv"), InputError);
  EXPECT_THROW(Profile::spline({0.0, 0.0}, {0.0, 1.0}, "t.csv"), InputError);
  try {
    Profile::spline({0.0, 1.0, 0.5}, {0.0, 0.0, 0.0}, "level.csv");
    FAIL();
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("level.csv"), std::string::npos);
  }
}

TEST(Profile, IsoStartsLevelAndIsSmooth) {
  const Profile p = Profile::rough(iso8608('C'), 5.0, 7);
  EXPECT_EQ(p.at(5.0).value, 0.0);
  EXPECT_EQ(p.at(-100.0).value, 0.0);
  expect_derivatives(p, {5.3, 9.0, 18.2, 24.999, 25.0, 25.001, 60.0, 777.7});
  EXPECT_NEAR(p.at(25.0 - 1e-12).curvature, p.at(25.0 + 1e-12).curvature, 1e-7);
  EXPECT_NE(p.at(60.0).value, Profile::rough(iso8608('C'), 5.0, 8).at(60.0).value);
  EXPECT_EQ(p.at(60.0).value, Profile::rough(iso8608('C'), 5.0, 7).at(60.0).value);
  EXPECT_THROW(iso8608('F'), InputError);
}

// The variance between 0.01 and 10 cycles/m is the integral of Gd(n0) (n0/n)^2: Gd(n0) 0.01 (100 - 0.1).
TEST(Profile, IsoVarianceAndClasses) {
  const double mean_square = 16e-6 * 0.01 * (100.0 - 0.1);
  double sum = 0.0;
  const int samples = 40000, seeds = 8;
  for (int seed = 0; seed < seeds; ++seed) {
    const Profile p = Profile::rough(iso8608('A'), 0.0, seed);
    for (int i = 0; i < samples / seeds; ++i) {
      const double h = p.at(100.0 + 7.3 * i).value;
      sum += h * h;
    }
  }
  EXPECT_NEAR(sum / samples, mean_square, 0.05 * mean_square);
  const double a = Profile::rough(iso8608('A'), 0.0, 3).at(333.0).value,
               e = Profile::rough(iso8608('E'), 0.0, 3).at(333.0).value;
  EXPECT_NEAR(e / a, 16.0, 1e-9);
}

// Spectrum level by a finite Fourier sum over a band around n0 = 0.1 cycles/m, against Gd(n0) = 16e-6 m3 (class A).
TEST(Profile, IsoSpectrumLevel) {
  const double length = 4000.0, dx = 0.25;
  const int n = static_cast<int>(length / dx);
  double power = 0.0;
  const double first = 0.09, last = 0.11;
  const int seeds = 3;
  for (int seed = 0; seed < seeds; ++seed) {
    const Profile p = Profile::rough(iso8608('A'), -50.0, 40 + seed);
    std::vector<double> h(n);
    for (int i = 0; i < n; ++i) h[i] = p.at(i * dx).value;
    for (int k = static_cast<int>(first * length); k < static_cast<int>(last * length); ++k) {
      double re = 0.0, im = 0.0;
      const double c = std::cos(2.0 * pi * k / n), s = std::sin(2.0 * pi * k / n);
      double wr = 1.0, wi = 0.0;
      for (int i = 0; i < n; ++i) {
        const double window = std::sin(pi * (i + 0.5) / n);  // sine window: mean square 1/2
        re += h[i] * window * wr;
        im += h[i] * window * wi;
        const double r = wr * c - wi * s;
        wi = wr * s + wi * c;
        wr = r;
      }
      power += 2.0 * 2.0 * (re * re + im * im) / (double(n) * n);
    }
  }
  // integral of 16e-6 (0.1/n)^2 over the band; the waves are 240 in three decades, 7 of them in this band
  const double expected = 16e-6 * 0.01 * (1.0 / first - 1.0 / last);
  EXPECT_NEAR(power / seeds, expected, 0.2 * expected);
}

/// The names of all spectra that users may write.
std::vector<std::string> spectrum_names() {
  std::vector<std::string> names;
  for (const SpectrumRow& row : spectra) {
    if (row.grades.empty()) names.emplace_back(row.name);
    for (const char grade : row.grades) names.push_back(std::string(row.name) + grade);
  }
  return names;
}

std::vector<Spectrum> all_spectra() {
  std::vector<Spectrum> all;
  for (const std::string& name : spectrum_names()) all.push_back(spectrum_of(name).value());
  return all;
}

TEST(Spectrum, IsFoundByItsName) {
  EXPECT_EQ(spectrum_names().size(), 13U);
  EXPECT_EQ(spectrum_of("iso8608_C")->strength, iso8608('C').strength);
  EXPECT_EQ(spectrum_of("fra_4")->strength, fra(4).strength);
  EXPECT_EQ(spectrum_of("german_high")->strength, german(true).strength);
  for (const char* name :
       {"", "none", "iso8608_", "iso8608_F", "iso8608_AB", "german", "german_low1", "fra_0", "fra_7"})
    EXPECT_FALSE(spectrum_of(name).has_value()) << name;
}

TEST(Spectrum, IsInTheGuide) {
  std::ifstream file(source_folder() + "/doc/guide/roughness.md");
  const std::string text(std::istreambuf_iterator<char>(file), {});
  for (const SpectrumRow& row : spectra) EXPECT_NE(text.find(std::string(row.name)), std::string::npos) << row.name;
}

// The spectra's closed integrals against Simpson's rule, and their values where the literature can be read off.
TEST(Spectrum, PowerIsTheIntegralOfTheDensity) {
  for (const Spectrum& s : all_spectra()) {
    for (double low : {0.01, 0.3, 7.0}) {
      const double high = 1.7 * low;
      const int n = 200;  // even
      double sum = s.density(low) + s.density(high);
      for (int i = 1; i < n; ++i) sum += (i % 2 == 1 ? 4.0 : 2.0) * s.density(low + (high - low) * i / n);
      sum *= (high - low) / (3.0 * n);
      EXPECT_NEAR(s.power(low, high), sum, 1e-9 * sum);
    }
  }
  const double c = 0.8246 * 0.8246, r = 0.0206 * 0.0206;
  EXPECT_NEAR(german(false).density(0.5), 4.032e-7 * c / ((0.25 + r) * (0.25 + c)), 1e-20);
  EXPECT_NEAR(german(true).density(1.0) / german(false).density(1.0), 10.80 / 4.032, 1e-12);
  EXPECT_NEAR(fra(4).density(1.0), 0.25 * 0.5376e-4 * 0.8245 * 0.8245 / (1.0 + 0.8245 * 0.8245), 1e-18);
  EXPECT_NEAR(iso8608('A').density(2.0 * pi * 0.1) * 2.0 * pi, 16e-6, 1e-18);
  EXPECT_THROW(fra(0), InputError);
  EXPECT_THROW(fra(7), InputError);
}

// Mean square of the part of a profile between the wavenumbers low and 2 low, averaged over seeds: by projection on the
// harmonics of a window 48 waves long (of Hann's shape, mean square 3/8, which keeps long waves out of short ones), the
// two at the ends by half.
double octave_variance(const Spectrum& spectrum, double low) {
  constexpr int first = 48, last = 96, seeds = 40;
  const double length = first * 2.0 * pi / low;
  const int n = static_cast<int>(length / (0.4 * spectrum.shortest)) + 1;
  double power = 0.0;
  for (int seed = 0; seed < seeds; ++seed) {
    const Profile p = Profile::rough(spectrum, -1000.0, static_cast<std::uint64_t>(seed));
    std::vector<double> h(static_cast<std::size_t>(n));
    for (int i = 0; i < n; ++i)
      h[static_cast<std::size_t>(i)] = p.at(i * length / n).value * std::pow(std::sin(pi * i / n), 2);
    for (int k = first; k <= last; ++k) {
      std::complex<double> sum = 0.0, turn = 1.0;
      const std::complex<double> step = std::polar(1.0, -2.0 * pi * k / n);
      for (double value : h) {
        sum += value * turn;
        turn *= step;
      }
      const double weight = k == first || k == last ? 0.5 : 1.0;
      power += weight * 2.0 * std::norm(sum) / (double(n) * n) / (3.0 / 8.0);
    }
  }
  return power / seeds;
}

TEST(Spectrum, TrackHasItsVarianceBandByBand) {
  for (const Spectrum& s : {german(false), german(true), fra(3), fra(6)}) {
    for (double low : {0.1, 0.4, 1.6}) {
      const double expected = s.power(low, 2.0 * low);
      EXPECT_NEAR(octave_variance(s, low) / expected, 1.0, 0.05) << "from " << low << " rad/m";
    }
  }
}

TEST(Spectrum, RoughRails) {
  for (const Spectrum& s : {german(false), fra(2)}) {
    const Profile p = Profile::rough(s, 5.0, 7);
    EXPECT_EQ(p.at(5.0).value, 0.0);
    EXPECT_EQ(p.at(-100.0).value, 0.0);
    expect_derivatives(p, {5.3, 18.2, 25.0, 64.99, 65.0, 200.0, 777.7});
    EXPECT_EQ(p.at(60.0).value, Profile::rough(s, 5.0, 7).at(60.0).value);
    EXPECT_NE(p.at(60.0).value, Profile::rough(s, 5.0, 8).at(60.0).value);
  }
}

// All power of a narrow band: amplitude sqrt(2 power) of what is nearly one wave, whose length is the band's.
TEST(Spectrum, WavelengthsCanBeChosen) {
  const double power = german(true).power(2.0 * pi / 3.03, 2.0 * pi / 3.0);
  double sum = 0.0;
  const int seeds = 8000;
  for (int seed = 0; seed < seeds; ++seed) {
    const Height h = Profile::rough(german(true), 3.0, 3.03, 0.0, static_cast<std::uint64_t>(seed)).at(1000.0);
    sum += h.value * h.value / seeds;
    const double k = 2.0 * pi / 3.015;
    EXPECT_NEAR(h.curvature, -h.value * k * k, 0.02 * k * k * 5.0 * std::sqrt(power));
  }
  EXPECT_NEAR(sum, power, 0.05 * power);
  EXPECT_THROW(Profile::rough(german(true), 3.0, 3.0, 0.0, 1), InputError);
  EXPECT_THROW(Profile::rough(german(true), 0.0, 3.0, 0.0, 1), InputError);
}

}  // namespace
}  // namespace traverse::track
