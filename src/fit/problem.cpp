// Residuals and their derivatives by differences.
#include <algorithm>
#include <cmath>

#include "fit/minimise.hpp"

namespace traverse::fit {
namespace {

// J. J. More, S. M. Wild, Estimating computational noise, SIAM J. Sci. Comput. 33 (2011): the mean square of k-th
// differences of noise is (2k)!/(k!)^2 times its variance.
constexpr double close = 1e-7;        // distance of the points for the noise
constexpr double of_fourth = 70.0;    // 8!/(4!)^2
constexpr double near = 1e-3;         // distance of the points for the sensitivity
constexpr double truncation = 400.0;  // third derivative over six times the first one, at most
constexpr double least_step = 1e-6, most_step = 1e-3;

}  // namespace

std::vector<double> Problem::response(const Eigen::VectorXd& u) const {
  return evaluator_.evaluate({residuals_.values(u)}).front();
}

std::vector<Eigen::VectorXd> Problem::evaluate(const std::vector<Eigen::VectorXd>& points) const {
  std::vector<Evaluator::Values> values;
  for (const Eigen::VectorXd& u : points) values.push_back(residuals_.values(u));
  const std::vector<Evaluator::Values> responses = evaluator_.evaluate(values);
  std::vector<Eigen::VectorXd> found;
  for (std::size_t i = 0; i < points.size(); ++i) found.push_back(residuals_.evaluate(responses[i], points[i]));
  return found;
}

Eigen::VectorXd Problem::evaluate(const Eigen::VectorXd& u) const { return evaluate(std::vector{u}).front(); }

void Problem::set_steps(const Eigen::VectorXd& u) {
  const auto options = static_cast<Eigen::Index>(residuals_.options());
  const auto moved = [&](double distance) {
    Eigen::VectorXd to = u;
    for (Eigen::Index j = 0; j < options; ++j) to[j] += u[j] < 0.5 ? distance : -distance;
    return to;
  };
  std::vector<Eigen::VectorXd> points;
  for (int k = 0; k <= 4; ++k) points.push_back(moved(close * k));
  points.push_back(moved(near));
  const std::vector<Eigen::VectorXd> r = evaluate(points);
  const double noise = (r[0] - 4.0 * r[1] + 6.0 * r[2] - 4.0 * r[3] + r[4]).norm() / std::sqrt(of_fourth);
  const double sensitivity = (r[5] - r[0]).norm() / near;
  const double best = sensitivity > 0.0 ? std::cbrt(noise / sensitivity / truncation) : most_step;
  step_ = std::clamp(best, least_step, most_step);
}

Eigen::MatrixXd Problem::jacobian(const Eigen::VectorXd& u) const {
  // Central differences, at a bound of second order to one side: weights of u, the near and the far point.
  struct Points {
    Eigen::VectorXd one, other;
    double of_u = 0.0, of_one = 0.5, of_other = -0.5;
  };
  std::vector<Points> of_columns;
  std::vector<Eigen::VectorXd> all = {u};
  for (Eigen::Index j = 0; j < u.size(); ++j) {
    Points points{u, u};
    const bool low = u[j]<step_, high = u[j]> 1.0 - step_;
    points.one[j] += low || !high ? step_ : -step_;
    points.other[j] += low ? 2.0 * step_ : high ? -2.0 * step_ : -step_;
    const double side = high ? -1.0 : 1.0;
    if (low || high) points.of_u = -1.5 * side, points.of_one = 2.0 * side, points.of_other = -0.5 * side;
    all.push_back(points.one);
    all.push_back(points.other);
    of_columns.push_back(std::move(points));
  }
  const std::vector<Eigen::VectorXd> r = evaluate(all);
  Eigen::MatrixXd jacobian(r[0].size(), u.size());
  for (Eigen::Index j = 0; j < u.size(); ++j) {
    const Points& points = of_columns[static_cast<std::size_t>(j)];
    const auto first = static_cast<std::size_t>(2 * j + 1);
    jacobian.col(j) = (points.of_u * r[0] + points.of_one * r[first] + points.of_other * r[first + 1]) / step_;
  }
  return jacobian;
}

}  // namespace traverse::fit
