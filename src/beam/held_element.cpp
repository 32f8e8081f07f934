// Green's function of an element clamped at both ends: polynomial without a bed, decaying waves on a Winkler bed. A
// small linear system determines the forces of springs inside the element.
#include "held_element.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "section.hpp"

namespace traverse::beam {
namespace {

// Lower limit of lambda: a softer bed changes the deflections of a clamped element by less than 2e-5 of their value,
// and the waves from its two ends become linearly dependent.
constexpr double min_lambda = 0.2;
constexpr double max_pieces = 64.0;

/// exp(-u) times cosine and sine of u = lambda times the distance from an end.
struct Wave {
  double cosine, sine;
  Wave(double lambda, double distance) {
    const double u = lambda * distance, decay = std::exp(-u);
    cosine = decay * std::cos(u);
    sine = decay * std::sin(u);
  }
};

// The deflection of an infinite beam on its bed under a unit force at a distance d, or its first or second derivative
// over d.
double infinite_beam(double lambda, double d, int derivative) {
  const Wave wave(lambda, std::abs(d));
  if (derivative == 0) return (wave.cosine + wave.sine) / (8.0 * lambda * lambda * lambda);
  if (derivative == 1) return (d < 0.0 ? 1.0 : -1.0) * wave.sine / (4.0 * lambda * lambda);
  return -(wave.cosine - wave.sine) / (4.0 * lambda);
}

// Green's function g without a bed at x <= s under a unit force at s, or its derivative over x, over s, or over both.
double without_bed(double x, double s, bool over_x, bool over_s) {
  const double b = 1.0 - s;
  const double cubic = over_x ? 6.0 * s * x - 3.0 * x * x * (1.0 + 2.0 * s) : x * x * (3.0 * s - x * (1.0 + 2.0 * s));
  if (!over_s) return b * b * cubic / 6.0;
  const double by_s = over_x ? 6.0 * x * (1.0 - x) : x * x * (3.0 - 2.0 * x);
  return (b * b * by_s - 2.0 * b * cubic) / 6.0;
}

}  // namespace

HeldElement::HeldElement(double xi, double h, double EI, double bed, const std::vector<InnerSpring>& springs,
                         double shear)
    : h_(h), EI_(EI), shear_(shear), lambda_(h * std::pow(0.25 * bed / EI, 0.25)) {
  if (lambda_ < min_lambda || shear_ != 0.0) lambda_ = 0.0;
  lines_.push_back(line(xi, false));
  std::vector<Line> spring_lines;
  std::vector<double> stiffness;
  for (const InnerSpring& spring : springs) {
    if (spring.k <= 0.0 || spring.xi <= 0.0 || spring.xi >= 1.0) continue;
    spring_lines.push_back(line(spring.xi, spring.rotational));
    stiffness.push_back(spring.k * h * (spring.rotational ? 1.0 : h * h) / EI);
  }
  // The forces of the springs under a unit load at xi: (1 + G k) f = k g.
  const auto n = static_cast<Eigen::Index>(spring_lines.size());
  Eigen::MatrixXd compliance(n, n);
  Eigen::VectorXd force(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const double k = stiffness[static_cast<std::size_t>(i)];
    for (Eigen::Index j = 0; j < n; ++j) {
      const Line& other = spring_lines[static_cast<std::size_t>(j)];
      compliance(i, j) =
          k * value(spring_lines[static_cast<std::size_t>(i)], other.xi, other.rotation) + (i == j ? 1.0 : 0.0);
    }
    force[i] = k * value(lines_[0], spring_lines[static_cast<std::size_t>(i)].xi,
                         spring_lines[static_cast<std::size_t>(i)].rotation);
  }
  if (n > 0) force = compliance.partialPivLu().solve(force).eval();
  for (Eigen::Index i = 0; i < n; ++i) {
    spring_lines[static_cast<std::size_t>(i)].factor = -force[i];
    lines_.push_back(spring_lines[static_cast<std::size_t>(i)]);
  }
}

std::vector<double> HeldElement::ends() const {
  const int pieces = 1 + static_cast<int>(std::min(lambda_, max_pieces));
  std::vector<double> ends;
  for (int i = 0; i <= pieces; ++i) ends.push_back(static_cast<double>(i) / pieces);
  for (const Line& line : lines_) ends.push_back(line.xi);  // the lines have a kink there
  std::sort(ends.begin(), ends.end());
  ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
  return ends;
}

// The influence line of the infinite beam, plus four decaying waves by which both ends are clamped.
HeldElement::Line HeldElement::line(double xi, bool rotation) const {
  Line line{xi, rotation};
  if (lambda_ == 0.0) return line;
  const Wave far_end(lambda_, 1.0);
  const double l = lambda_;
  Eigen::Matrix4d at_ends;                            // value and slope at 0, value and slope at 1
  at_ends << 1.0, 0.0, far_end.cosine, far_end.sine,  //
      -l, l, l * (far_end.cosine + far_end.sine), -l * (far_end.cosine - far_end.sine),  //
      far_end.cosine, far_end.sine, 1.0, 0.0,                                            //
      -l * (far_end.cosine + far_end.sine), l * (far_end.cosine - far_end.sine), l, -l;
  const int order = rotation ? 1 : 0;
  const Eigen::Vector4d free(infinite_beam(l, xi, order), -infinite_beam(l, xi, order + 1),
                             infinite_beam(l, xi - 1.0, order), -infinite_beam(l, xi - 1.0, order + 1));
  const Eigen::Vector4d ends = at_ends.partialPivLu().solve(-free);
  std::copy_n(ends.data(), 4, line.ends);
  return line;
}

double HeldElement::value(const Line& line, double load, bool slope) const {
  if (shear_ != 0.0) return clamped_timoshenko_response(line.xi, load, shear_, line.rotation, slope);
  if (lambda_ == 0.0)
    return line.xi <= load ? without_bed(line.xi, load, line.rotation, slope)
                           : without_bed(load, line.xi, slope, line.rotation);
  const int order = line.rotation ? 1 : 0;
  const Wave left(lambda_, load), right(lambda_, 1.0 - load);
  const double* c = line.ends;
  if (!slope)
    return infinite_beam(lambda_, line.xi - load, order) + c[0] * left.cosine + c[1] * left.sine + c[2] * right.cosine +
           c[3] * right.sine;
  return -infinite_beam(lambda_, line.xi - load, order + 1) +
         lambda_ * (-c[0] * (left.cosine + left.sine) + c[1] * (left.cosine - left.sine) +
                    c[2] * (right.cosine + right.sine) - c[3] * (right.cosine - right.sine));
}

double HeldElement::sum(double load, bool moment) const {
  double sum = 0.0;
  for (const Line& line : lines_) sum += line.factor * value(line, load, moment);
  return sum * h_ * h_ * (moment ? 1.0 : h_) / EI_;
}

}  // namespace traverse::beam
