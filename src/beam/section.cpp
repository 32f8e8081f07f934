// Section forces by equilibrium of the part of the element left of the section, and Green's function of an element
// clamped at both ends: polynomial without a bed, decaying waves on a Winkler bed. A small linear system determines the
// forces of springs inside the element.
#include "section.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "beam/shape.hpp"

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

void SectionForms::add_end_forces(const Transverse& matrix) {
  const double x = xi_ * element_.length;
  for (std::size_t j = 0; j < 4; ++j) {
    shear_[j] += matrix[j];
    moment_[j] += x * matrix[j] - matrix[4 + j];
  }
}

void SectionForms::add_end_forces(const Axial& matrix) {
  for (std::size_t j = 0; j < 2; ++j) axial_force_[j] -= matrix[j];
}

void SectionForms::add_transverse_density(const Distribution& density) {
  const double h = element_.length, section = element_.x + xi_ * h;
  integrate(density, element_.x, section, [&](double x, double weight) {
    const auto psi = hermite((x - element_.x) / h, h, element_.shear).value;
    for (std::size_t j = 0; j < 4; ++j) {
      shear_[j] -= weight * psi[j];
      moment_[j] -= weight * psi[j] * (section - x);
    }
  });
}

void SectionForms::add_axial_density(const Distribution& density) {
  const double h = element_.length;
  integrate(density, element_.x, element_.x + xi_ * h, [&](double x, double weight) {
    const auto phi = linear((x - element_.x) / h);
    for (std::size_t j = 0; j < 2; ++j) axial_force_[j] += weight * phi[j];
  });
}

void SectionForms::add_vertical_spring(double c, double xi) {
  const auto psi = hermite(xi, element_.length, element_.shear).value;
  add_end_forces(outer(c, psi));
  if (!is_left(xi, xi_)) return;
  for (std::size_t j = 0; j < 4; ++j) {
    shear_[j] -= c * psi[j];
    moment_[j] -= c * psi[j] * (xi_ - xi) * element_.length;
  }
}

void SectionForms::add_rotational_spring(double c, double xi) {
  const auto theta = rotation(xi, element_.length, element_.shear);
  add_end_forces(outer(c, theta));
  if (!is_left(xi, xi_)) return;
  for (std::size_t j = 0; j < 4; ++j) moment_[j] += c * theta[j];
}

void SectionForms::add_longitudinal_spring(double c, double xi) {
  const auto phi = linear(xi);
  add_end_forces(outer(c, phi));
  if (!is_left(xi, xi_)) return;
  for (std::size_t j = 0; j < 2; ++j) axial_force_[j] += c * phi[j];
}

void SectionForms::add_rotational_density(const Distribution& density) {
  const double h = element_.length;
  integrate(density, element_.x, element_.x + xi_ * h, [&](double x, double weight) {
    const auto theta = rotation((x - element_.x) / h, h, element_.shear);
    for (std::size_t j = 0; j < 4; ++j) moment_[j] += weight * theta[j];
  });
}

void SectionForms::add_bed(Direction direction, const Distribution& density) {
  switch (direction) {
    case Direction::vertical:
      add_end_forces(transverse_bed(density, element_));
      return add_transverse_density(density);
    case Direction::longitudinal:
      add_end_forces(axial_bed(density, element_));
      return add_axial_density(density);
    case Direction::rotational:
      add_end_forces(slope_bed(density, element_));
      return add_rotational_density(density);
  }
}

void SectionForms::add_spring(Direction direction, double c, double xi) {
  switch (direction) {
    case Direction::vertical:
      return add_vertical_spring(c, xi);
    case Direction::longitudinal:
      return add_longitudinal_spring(c, xi);
    case Direction::rotational:
      return add_rotational_spring(c, xi);
  }
}

double clamped_timoshenko_response(double xi, double load, double shear, bool rotated, bool moment) {
  // From the left end on: zero up to the load; behind it w'' = M and w' = theta - V shear/12.
  struct Shape {
    double value, theta;
  };
  const auto response_behind = [&](double d) -> Shape {
    if (d <= 0.0) return {0.0, 0.0};
    return moment ? Shape{-0.5 * d * d, -d} : Shape{d * (d * d / 6.0 - shear / 12.0), 0.5 * d * d};
  };
  const Shape here = response_behind(xi - load), end = response_behind(1.0 - load);
  const auto form = rotated ? rotation(xi, 1.0, shear) : hermite(xi, 1.0, shear).value;
  return (rotated ? here.theta : here.value) - form[2] * end.value - form[3] * end.theta;
}

double fixed_end_by_force(double xi, double load, double h, double EI, double shear) {
  if (shear != 0.0) return h * h * h / EI * clamped_timoshenko_response(xi, load, shear, false, false);
  if (xi > load) return fixed_end_by_force(1.0 - xi, 1.0 - load, h, EI);
  const double b = 1.0 - load;
  return h * h * h / (6.0 * EI) * b * b * xi * xi * (3.0 * load - (1.0 + 2.0 * load) * xi);
}

double fixed_end_by_moment(double xi, double load, double h, double EI, double shear) {
  if (shear != 0.0) return h * h / EI * clamped_timoshenko_response(xi, load, shear, false, true);
  if (xi > load) return -fixed_end_by_moment(1.0 - xi, 1.0 - load, h, EI);
  return h * h / (2.0 * EI) * xi * xi * (1.0 - load) * (1.0 - 3.0 * load + 2.0 * load * xi);
}

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
