// Saltelli's design by the Sobol' sequence of Boost.Random, and Morris' trajectories from a random stream.
#include "base/sampling_design.hpp"

#include <algorithm>
#include <boost/random/sobol.hpp>
#include <cmath>
#include <numeric>

#include "base/random_stream.hpp"

namespace traverse::base {

std::vector<double> saltelli_design(std::size_t samples, std::size_t factors, std::uint64_t seed) {
  boost::random::sobol sequence(2 * factors);
  const double scale = 1.0 / (static_cast<double>(boost::random::sobol::max()) + 1.0);
  const RandomStream shift(seed, "sobol");
  std::vector<double> points, both(2 * factors);
  for (std::size_t s = 0; s < samples; ++s) {
    for (std::size_t k = 0; k < both.size(); ++k) {
      const double x = (static_cast<double>(sequence()) + 0.5) * scale + shift.uniform(k);
      both[k] = x - std::floor(x);
    }
    const double *a = both.data(), *b = a + factors;
    points.insert(points.end(), a, b);
    for (std::size_t i = 0; i < factors; ++i) {
      points.insert(points.end(), a, b);
      *(points.end() - static_cast<std::ptrdiff_t>(factors - i)) = b[i];
    }
    points.insert(points.end(), b, b + factors);
  }
  return points;
}

std::vector<double> morris_design(std::size_t trajectories, std::size_t factors, std::uint64_t seed) {
  const RandomStream random(seed, "morris");
  std::uint64_t draw = 0;
  const auto below = [&](std::size_t n) {
    return static_cast<std::size_t>(random.uniform(draw++) * static_cast<double>(n));
  };
  std::vector<double> points, at(factors);
  std::vector<std::size_t> order(factors);
  for (std::size_t t = 0; t < trajectories; ++t) {
    for (double& x : at) x = static_cast<double>(below(4)) / 3.0;
    std::iota(order.begin(), order.end(), std::size_t{0});
    for (std::size_t i = factors; i > 1; --i) std::swap(order[i - 1], order[below(i)]);
    points.insert(points.end(), at.begin(), at.end());
    for (const std::size_t factor : order) {
      at[factor] += at[factor] < 0.5 ? morris_step : -morris_step;
      points.insert(points.end(), at.begin(), at.end());
    }
  }
  return points;
}

}  // namespace traverse::base
