// Evaluates the integrals of eqs. 8 to 10 and of beds (eqs. 27, 29, 36 and 38 of the paper) in closed form or by Gauss
// quadrature, and mass terms for fourth-order accurate frequencies of Timoshenko elements.
#include "beam/element.hpp"

#include <algorithm>
#include <cstddef>

#include "beam/shape.hpp"

namespace traverse::beam {
namespace {

// If 32 rho I/(m h^2) >= 1, the mass matrix remains positive definite with the full first term of add_shear_mass.
constexpr double rotary_factor = 32.0;

template <std::size_t N>
void add_outer(std::array<double, N * N>& matrix, double c, const std::array<double, N>& s) {
  for (std::size_t i = 0; i < N; ++i) {
    for (std::size_t j = 0; j < N; ++j) matrix[i * N + j] += c * s[i] * s[j];
  }
}

/// Integral of density(x) s(x) s(x)^T.
template <std::size_t N, class Shape>
std::array<double, N * N> integral(const Distribution& density, const Element& e, Shape shape) {
  std::array<double, N * N> matrix{};
  integrate(density, e.x, e.x + e.length,
            [&](double x, double weight) { add_outer<N>(matrix, weight, shape((x - e.x) / e.length)); });
  return matrix;
}

Transverse bending_stiffness(const Distribution& EI, const Element& e) {
  const double h = e.length;
  const auto constant = constant_value(EI, e.x, e.x + h);
  if (!constant || e.shear != 0.0)
    return integral<4>(EI, e, [&](double xi) { return hermite(xi, h, e.shear).curvature; });
  const double c = *constant / (h * h * h);
  const double a = 12 * c, b = 6 * h * c, d = 4 * h * h * c, f = 2 * h * h * c;
  return {a, b, -a, b, b, d, -b, f, -a, -b, a, -b, b, f, -b, d};
}

/// Integral of GA gamma gamma^T.
void add_shear_stiffness(const Distribution& GA, const Element& e, Transverse& stiffness) {
  const auto gamma = shear_strain(e.length, e.shear);
  integrate(GA, e.x, e.x + e.length, [&](double, double weight) { add_outer<4>(stiffness, weight, gamma); });
}

/// Adds to the mass the effect of inertia inside the element on gamma and theta, which a constant gamma neglects; the
/// frequency error is then of fourth order (theory.md, "Shear and rotary inertia"). With s = 12 EI/(GA h^2),
/// f = s/(1 + s) and means over the element:
///   m h^2/12 v' gamma + f rho I (h^2/12 theta'^2 - theta gamma/s).
/// The first term is that of the mean of consistent and lumped mass of a bar. Its factor is reduced if the mass matrix
/// would otherwise not be positive definite.
void add_shear_mass(const BeamModel& model, const Element& e, Transverse& mass) {
  const double h = e.length, f = e.shear / (1.0 + e.shear);
  const auto gamma = shear_strain(h, e.shear);
  const auto add_pair = [&](double factor, const std::array<double, 4>& other) {
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = 0; j < 4; ++j) mass[4 * i + j] += 0.5 * factor * (gamma[i] * other[j] + other[i] * gamma[j]);
  };
  double total_mass = 0.0, rotary = 0.0;
  std::array<double, 4> rotary_load{};  // integral of rho I theta
  integrate(model.mass, e.x, e.x + h, [&](double, double weight) { total_mass += weight; });
  integrate(model.rotary_inertia, e.x, e.x + h, [&](double x, double weight) {
    const double xi = (x - e.x) / h;
    const auto theta = rotation(xi, h, e.shear);
    rotary += weight;
    for (std::size_t i = 0; i < 4; ++i) rotary_load[i] += weight * theta[i];
    add_outer<4>(mass, f * h * h / 12.0 * weight, hermite(xi, h, e.shear).curvature);
  });
  add_pair(std::min(1.0, rotary_factor * rotary / (total_mass * h * h)) * total_mass * h / 12.0, {-1.0, 0.0, 1.0, 0.0});
  add_pair(-f / e.shear, rotary_load);
}

Axial axial_stiffness_of(const Distribution& EA, const Element& e) {
  const double h = e.length;
  double mean = 0.0;
  integrate(EA, e.x, e.x + h, [&](double, double weight) { mean += weight / h; });
  if (const auto constant = constant_value(EA, e.x, e.x + h)) mean = *constant;
  return {mean / h, -mean / h, -mean / h, mean / h};
}

}  // namespace

Transverse transverse_bed(const Distribution& density, const Element& e) {
  const double h = e.length;
  const auto constant = constant_value(density, e.x, e.x + h);
  if (!constant || e.shear != 0.0)
    return integral<4>(density, e, [&](double xi) { return hermite(xi, h, e.shear).value; });
  const double c = *constant * h / 420;
  const double a = 156 * c, b = 22 * h * c, d = 54 * c, f = 13 * h * c, g = 4 * h * h * c, k = 3 * h * h * c;
  return {a, b, d, -f, b, g, f, -k, d, f, a, -b, -f, -k, -b, g};
}

Axial axial_bed(const Distribution& density, const Element& e) {
  const auto constant = constant_value(density, e.x, e.x + e.length);
  if (!constant) return integral<2>(density, e, [](double xi) { return linear(xi); });
  const double c = *constant * e.length / 6;
  return {2 * c, c, c, 2 * c};
}

Transverse slope_bed(const Distribution& density, const Element& e) {
  return integral<4>(density, e, [&](double xi) { return rotation(xi, e.length, e.shear); });
}

TorsionMatrices torsion_matrices(const BeamModel& model, const Element& e) {
  const Torsion& torsion = *model.torsion;
  Element twisted = e;  // its twist is that of Vlasov's theory, as the deflection is that of a beam in tension
  twisted.shear = 0.0;
  TorsionMatrices m;
  const auto add = [](const Transverse& from, double factor, Transverse& to) {
    for (std::size_t i = 0; i < to.size(); ++i) to[i] += factor * from[i];
  };
  add(slope_bed(torsion.GJ, twisted), 1.0, m.stiffness);
  if (torsion.warping) add(bending_stiffness(*torsion.warping, twisted), 1.0, m.stiffness);
  add(transverse_bed(torsion.inertia, twisted), 1.0, m.mass);
  const double c = torsion.mass_centre;
  if (c == 0.0) return m;
  add(transverse_bed(model.mass, twisted), c * c, m.mass);
  integrate(model.mass, e.x, e.x + e.length, [&](double x, double weight) {
    const double xi = (x - e.x) / e.length;
    const auto of_v = hermite(xi, e.length, e.shear).value, of_twist = hermite(xi, e.length).value;
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = 0; j < 4; ++j) m.coupling[4 * i + j] += c * weight * of_v[i] * of_twist[j];
  });
  return m;
}

std::array<double, 4> transverse_load(const Distribution& density, const Element& e) {
  const double h = e.length;
  if (const auto constant = constant_value(density, e.x, e.x + h)) {  // the same with shear
    const double force = *constant * h / 2, moment = *constant * h * h / 12;
    return {force, moment, force, -moment};
  }
  std::array<double, 4> load{};
  integrate(density, e.x, e.x + e.length, [&](double x, double weight) {
    const auto psi = hermite((x - e.x) / h, h, e.shear).value;
    for (std::size_t i = 0; i < 4; ++i) load[i] += weight * psi[i];
  });
  return load;
}

std::array<double, 2> axial_load(const Distribution& density, const Element& e) {
  const auto transverse = transverse_load(density, e);  // the same resultant and first moment about the left end
  const double force = transverse[0] + transverse[2];
  const double moment = transverse[2] * e.length + transverse[1] + transverse[3];
  return {force - moment / e.length, moment / e.length};
}

std::array<double, 4> slope_load(const Distribution& density, const Element& e) {
  const double h = e.length;
  std::array<double, 4> load{};
  integrate(density, e.x, e.x + h, [&](double x, double weight) {
    const auto theta = rotation((x - e.x) / h, h, e.shear);
    for (std::size_t i = 0; i < 4; ++i) load[i] += weight * theta[i];
  });
  return load;
}

std::array<double, 4> strain_load(const BeamModel& model, const Element& element) {
  const double curvature = model.temperature ? model.temperature->curvature() : 0.0;
  std::array<double, 4> load{};
  if (curvature == 0.0) return load;
  integrate(model.EI, element.x, element.x + element.length, [&](double x, double weight) {
    const auto curvature_shape = hermite((x - element.x) / element.length, element.length, element.shear).curvature;
    for (std::size_t i = 0; i < 4; ++i) load[i] += weight * curvature * curvature_shape[i];
  });
  return load;
}

std::array<double, 2> axial_strain_load(const BeamModel& model, const Element& element) {
  if (!model.temperature || !model.axial) return {};
  const double force = axial_stiffness_of(model.EA, element)[0] * element.length * model.temperature->strain();
  return {-force, force};
}

ElementMatrices element_matrices(const BeamModel& model, const Element& element) {
  ElementMatrices m;
  m.mass = transverse_bed(model.mass, element);
  if (model.rotary_inertia.maximum() > 0.0) {
    const Transverse rotary = slope_bed(model.rotary_inertia, element);
    for (std::size_t i = 0; i < rotary.size(); ++i) m.mass[i] += rotary[i];
    if (element.shear != 0.0) add_shear_mass(model, element, m.mass);
  }
  m.stiffness = bending_stiffness(model.EI, element);
  if (element.shear != 0.0) add_shear_stiffness(*model.GA, element, m.stiffness);
  m.axial_mass = axial_bed(model.mass, element);
  if (model.axial) m.axial_stiffness = axial_stiffness_of(model.EA, element);
  return m;
}

}  // namespace traverse::beam
