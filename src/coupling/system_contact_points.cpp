// The running surface under the centre of each wheel, Y(t) = y(X(t), t) with y = v + h, of the deflection v and the
// profile h, and its total derivatives along the path X of the wheel:
//
//   Y' = v_t + X' (v_x + h_x)
//   Y'' = v_tt + 2 X' v_xt + X'^2 (v_xx + h_xx) + X'' (v_x + h_x)
//
// v is the cubic of the element, and if the wheel deflects the element between its nodes, s(X) f less: the compliance s
// (wheel_on_track.hpp) times the force f. The rates of f follow from its stiffness over the penetration, whose rates
// are those of surface and wheel. A surface above the axis is treated as one on the axis, for small rotations.
#include <cmath>
#include <limits>

#include "beam/shape.hpp"
#include "coupling/system.hpp"
#include "train/element_surface.hpp"

namespace traverse::coupling {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

/// A quantity along the path of a wheel, and its first and second rate.
using Path = std::array<double, 3>;

/// The path of a quantity from its rates at a fixed station (value, d/dt, d2/dt2), and from its slope, the rate of this
/// slope, and its curvature. x: the path of the station.
Path along(const Path& x, const Path& fixed, double slope, double slope_rate, double curvature) {
  return {fixed[0], fixed[1] + x[1] * slope,
          fixed[2] + 2.0 * x[1] * slope_rate + x[1] * x[1] * curvature + x[2] * slope};
}

/// The path of an element's deflection, from the values, rates and accelerations of its unknowns.
Path deflection_along(const Path& x, const beam::Element& element, double xi, int per_node, const double* v,
                      const double* w, const double* a) {
  const beam::Hermite shape = beam::hermite(xi, element.length, element.shear);
  const auto sum = [per_node](const std::array<double, 4>& form, const double* values) {
    const double *left = values + per_node - 2, *right = left + per_node;  // (v, theta) of both nodes
    return form[0] * left[0] + form[1] * left[1] + form[2] * right[0] + form[3] * right[1];
  };
  return along(x, {sum(shape.value, v), sum(shape.value, w), sum(shape.value, a)}, sum(shape.slope, v),
               sum(shape.slope, w), sum(shape.curvature, v));
}

/// The penetration's second rate of a wheel out of round by its shape alone, m/s2.
double shape_acceleration(const train::Fleet& fleet, const train::WheelContact& c) {
  const train::Wheel& wheel = fleet.wheel(c);
  if (wheel.shape.round()) return 0.0;
  const double rate = c.turns ? fleet.velocities(c).z() : fleet.velocities(c).x() / wheel.radius;
  return track::radius_gain(wheel.shape, wheel.radius, fleet.rolled_angle(c)).curvature * rate * rate;
}

/// Subtracts the deflection of the element between its nodes under the force of the wheel.
void subtract_local_deflection(const train::Fleet& fleet, const train::WheelContact& c, const train::Patch& patch,
                               double xi, const Path& x, double body_acceleration, Path& y) {
  const auto s = train::local_compliance_at<train::Surface::general>(xi, patch.length, patch.shear, patch.compliance);
  const Path compliance = along(x, {s.value, 0.0, 0.0}, s.by_x, 0.0,
                                train::local_compliance_by_xx(xi, patch.length, patch.shear, patch.compliance));
  const double stiffness = c.force.normal_by_penetration;
  const double penetration_acceleration = y[2] - body_acceleration + shape_acceleration(fleet, c);
  Path f = {fleet.load(c).normal, 0.0, 0.0};
  f[1] = stiffness * (c.kinematics.penetration_rate - compliance[1] * f[0]);
  f[2] = stiffness * (penetration_acceleration - compliance[2] * f[0] - 2.0 * compliance[1] * f[1]);
  y[0] -= compliance[0] * f[0];
  y[1] -= compliance[1] * f[0] + compliance[0] * f[1];
  y[2] -= compliance[2] * f[0] + 2.0 * compliance[1] * f[1] + compliance[0] * f[2];
}

/// Adds the motion of the ground before or behind the beam, which moves with the first or the last support.
void add_ground(const structure::SupportMotion* supports, const beam::Mesh& mesh, double x, Path& y) {
  const bool before = x < mesh.start();
  if (!(before ? mesh.ground_before() : mesh.ground_behind())) return y.fill(unknown);
  if (supports == nullptr) return;
  const structure::Movement& ground = before ? supports->upward().front() : supports->upward().back();
  y = {y[0] + ground.displacement, y[1] + ground.velocity, y[2] + ground.acceleration};
}

}  // namespace

/// Collective. The values of the unknowns of elements in this rank's nodal values, as Structure::gather has them.
std::vector<double> System::values_on(const std::vector<int>& elements, const double* nodal) const {
  const std::size_t m = 2 * static_cast<std::size_t>(per_node());
  std::vector<double> values(elements.size() * m, 0.0);
  for (std::size_t e = 0; e < elements.size(); ++e) {
    const auto unknowns = line_->unknowns(elements[e]);
    for (std::size_t i = 0; i < m; ++i)
      if (const int local = unknowns[i] < 0 ? -1 : beam()->local(unknowns[i]); local >= 0)
        values[e * m + i] = nodal[local];
  }
  MPI_Allreduce(MPI_IN_PLACE, values.data(), static_cast<int>(values.size()), MPI_DOUBLE, MPI_SUM, beam()->comm());
  return values;
}

void System::find_contact_points(const double* y, Observation& out) {
  std::vector<beam::Station> at(fleet_.wheels.size());
  std::vector<int> elements;  // one for each wheel on the beam
  for (std::size_t i = 0; i < at.size(); ++i) {
    const train::WheelContact& c = fleet_.wheels[i];
    const double x = fleet_.coordinates(c).x();
    const bool on_line = line_ != nullptr && x >= line_->mesh.start() && x <= line_->mesh.end();
    at[i].element = -1;
    if (!on_line || c.is_further) continue;
    at[i] = line_->mesh.on_track(line_->mesh.locate(x), c.track);
    elements.push_back(at[i].element);
  }
  std::vector<double> v, w, a;
  if (!elements.empty()) {
    structure_->gather(elements, y, y + n_, v, w);
    a = values_on(elements, out.beam.a);
  }
  out.contact_points.assign(at.size(), {});
  std::size_t first = 0;  // index of the element's values
  for (std::size_t i = 0; i < at.size(); ++i) {
    const train::WheelContact& c = fleet_.wheels[i];
    if (c.is_further) continue;
    const Eigen::VectorXd& accelerations = fleet_.vehicles[c.vehicle].state.qdd;
    const Path x = {fleet_.coordinates(c).x(), fleet_.velocities(c).x(), accelerations[3 * c.body]};
    const track::Height h = fleet_.profile(c).at(x[0]);
    Path surface = along(x, {h.value, 0.0, 0.0}, h.slope, 0.0, h.curvature);
    const train::Patch& patch = c.patches[c.active];
    if (at[i].element >= 0) {
      const Path deflection = deflection_along(x, line_->mesh.element(at[i].element), at[i].xi, per_node(), &v[first],
                                               &w[first], &a[first]);
      for (std::size_t k = 0; k < surface.size(); ++k) surface[k] += deflection[k];
      if (patch.element == at[i].element && patch.compliance > 0.0)
        subtract_local_deflection(fleet_, c, patch, at[i].xi, x, accelerations[3 * c.body + 1], surface);
      first += 2 * static_cast<std::size_t>(per_node());
    } else if (line_ != nullptr) {
      add_ground(structure_->support_motion(), line_->mesh, x[0], surface);
    }
    if (share_.distributed() && !fleet_.owns(c)) continue;  // the rank of the vehicle knows its contacts
    out.contact_points[i] = {{x[0], surface[0]}, {x[1], surface[1]}, {x[2], surface[2]}};
  }
  if (!share_.distributed()) return;
  static_assert(sizeof(ContactPoint) == 6 * sizeof(double));
  MPI_Allreduce(MPI_IN_PLACE, out.contact_points.data(), 6 * static_cast<int>(at.size()), MPI_DOUBLE, MPI_SUM, comm_);
}

}  // namespace traverse::coupling
