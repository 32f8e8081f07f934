// The vehicles' initial velocities, with which they follow the surface under their wheels: p'^T K p' (lasting slopes)
// or p'^T M p' (short slopes) is least subject to G p' = v h', by a complete orthogonal decomposition of the Lagrange
// multiplier equations.
#include <Eigen/Dense>
#include <algorithm>

#include "coupling/system.hpp"
#include "traverse/track/profile.hpp"

namespace traverse::coupling {
namespace {

/// The initial velocities of a vehicle that follows the surface. In equilibrium its coordinates are p(s), with its
/// position s on the track; moving in equilibrium at the speed v it has p' = v dp/ds. With the slopes h' under its
/// wheels, and contacts that are stiff compared with its springs, the contact forces balance K dp/ds, and G dp/ds = h',
/// where G gives the upward displacements of the wheels for p: the motion with the least strain energy of the springs.
///
/// Suspended masses follow a long slope, such as a ramp, but not a slope that a measured track has over a metre. There
/// only the wheels follow, as under an impulse at the contacts: the motion with the least kinetic energy. Therefore p'
/// = v (A h_lasting' + C (h' - h_lasting')), with G A = G C = 1.
class Following {
 public:
  /// M and K (f x f, kg and N/m) of the following coordinates, and G (r x f) of the contacts.
  Following(const Eigen::MatrixXd& M, const Eigen::MatrixXd& K, const Eigen::MatrixXd& G);
  /// The initial rates of the following coordinates, from the actual and the lasting rise of the surface under each
  /// wheel in time, m/s.
  Eigen::VectorXd rates(const Eigen::VectorXd& rise, const Eigen::VectorXd& lasting) const {
    return lasting_ * lasting + sudden_ * (rise - lasting);
  }

 private:
  Eigen::MatrixXd lasting_, sudden_;  // A and C
};

constexpr double long_stretch =
    20.0;  // m: length over which a slope is lasting; the fade-in of spectra has this length

/// p with the least p^T A p / 2 and G p = 1, by columns: A p + G^T lambda = 0. Coordinates that A and G do not
/// determine remain zero, and dependent contact conditions are satisfied together.
Eigen::MatrixXd least_energy_motion(const Eigen::MatrixXd& A, const Eigen::MatrixXd& G) {
  const Eigen::Index f = A.rows(), r = G.rows();
  Eigen::MatrixXd system = Eigen::MatrixXd::Zero(f + r, f + r), right = Eigen::MatrixXd::Zero(f + r, r);
  const double scale = A.diagonal().cwiseAbs().maxCoeff();
  if (scale > 0.0) system.topLeftCorner(f, f) = A / scale;
  system.topRightCorner(f, r) = G.transpose();
  system.bottomLeftCorner(r, f) = G;
  right.bottomRows(r).setIdentity();
  return system.completeOrthogonalDecomposition().solve(right).topRows(f);
}

Following::Following(const Eigen::MatrixXd& M, const Eigen::MatrixXd& K, const Eigen::MatrixXd& G)
    : lasting_(least_energy_motion(K, G)), sudden_(least_energy_motion(M, G)) {}

/// The lasting part of a profile's slope at x: the median of this slope and the mean slopes before and behind.
double lasting_slope(const track::Profile& profile, double x, double slope) {
  const double height = profile.at(x).value;
  const double before = (height - profile.at(x - long_stretch).value) / long_stretch;
  const double ahead = (profile.at(x + long_stretch).value - height) / long_stretch;
  return std::clamp(slope, std::min(before, ahead), std::max(before, ahead));
}

/// The wheels' contacts that carry the vehicle.
std::vector<const train::WheelContact*> loaded_contacts(const train::Fleet& fleet,
                                                        const train::MovingVehicle& vehicle) {
  std::vector<const train::WheelContact*> contacts;
  for (const int i : vehicle.touching)
    if (i < static_cast<int>(fleet.wheels.size()) && fleet.wheels[static_cast<std::size_t>(i)].force.normal > 0.0)
      contacts.push_back(&fleet.wheels[static_cast<std::size_t>(i)]);
  return contacts;
}

/// Indices in p of all coordinates but those along the track, whose speed is given.
std::vector<int> following_coordinates(const train::MovingVehicle& vehicle) {
  std::vector<int> following;
  const std::vector<int>& independent = vehicle.mechanism.partition().independent;
  for (int i = 0; i < static_cast<int>(independent.size()); ++i)
    if (independent[static_cast<std::size_t>(i)] % 3 != 0) following.push_back(i);
  return following;
}

/// Sets p' so that the vehicle's contacts keep their penetrations, with v and w of the surface unchanged.
void follow(const train::Fleet& fleet, train::MovingVehicle& vehicle) {
  const std::vector<const train::WheelContact*> contacts = loaded_contacts(fleet, vehicle);
  const std::vector<int> coordinates = following_coordinates(vehicle);
  if (contacts.empty() || coordinates.empty()) return;
  multibody::MechanismState& state = vehicle.state;
  vehicle.mechanism.compute_B(state);
  const Eigen::MatrixXd B = state.B(Eigen::all, coordinates);
  const auto r = static_cast<Eigen::Index>(contacts.size());
  Eigen::MatrixXd G(r, B.cols());
  Eigen::VectorXd rise(r), lasting(r);
  vehicle.Q.setZero();
  for (Eigen::Index j = 0; j < r; ++j) {
    const train::WheelContact& c = *contacts[static_cast<std::size_t>(j)];
    const Eigen::Index row = 3 * static_cast<Eigen::Index>(c.body);
    const Eigen::Vector3d& n = c.touch.normal_on_body;
    G.row(j) = -n.transpose() * B.middleRows(row, 3);
    rise[j] = c.touch.kinematics.penetration_rate - n.y() * state.qd[row + 1];
    const track::Profile& profile = fleet.profile(c);
    const double slope = profile.at(c.touch.station).slope;
    const double sudden = slope - lasting_slope(profile, c.touch.station, slope);
    lasting[j] = rise[j] + n.y() * sudden * state.qd[row];
    train::Fleet::add_load(c, c.force.normal, 0.0, vehicle.Q);
  }
  if (rise.isZero(0.0)) return;
  const multibody::Mechanism& mechanism = vehicle.mechanism;
  const Eigen::VectorXd at_rest = Eigen::VectorXd::Zero(vehicle.freedom());
  mechanism.compute_forces(state);
  mechanism.recover(state, vehicle.Q, at_rest.data());
  Eigen::MatrixXd tangent;
  mechanism.multiply_tangent(state, -1.0, 0.0, 1.0, tangent);
  const Eigen::MatrixXd K = B.transpose() * tangent(Eigen::all, coordinates);
  const Eigen::MatrixXd M = B.transpose() * mechanism.mass_diagonal().asDiagonal() * B;
  const std::vector<int>& independent = mechanism.partition().independent;
  Eigen::VectorXd pd = state.qd(independent);
  pd(coordinates) += Following(M, K, G).rates(rise, lasting);
  mechanism.set_velocities(state, state.time, pd.data());
}

}  // namespace

void System::follow_surface(const double* y) {
  fleet_.place_wheels();
  if (structure_) structure_->gather(fleet_.elements(), y, y + n_, v_, w_);
  const bool touched = fleet_.touch(per_node(), v_.data(), w_.data());
  if (share_.exchange(touched ? 0U : train::VehicleShare::failed) != 0) return;
  for (int i = 0; i < fleet_.contacts(); ++i) fleet_.contact(i).kinematics = fleet_.contact(i).touch.kinematics;
  fleet_.contact_forces();
  for (train::MovingVehicle& vehicle : fleet_.own()) follow(fleet_, vehicle);
  if (!share_.distributed()) return;
  std::vector<double> p(static_cast<std::size_t>(fleet_.freedom())), pd = p;
  fleet_.coordinates_of_state(0.0, p.data(), pd.data());
  share_.coordinates(fleet_, pd);
  for (train::MovingVehicle& vehicle : fleet_.vehicles)
    vehicle.mechanism.set_velocities(vehicle.state, vehicle.state.time, pd.data() + vehicle.offset);
}

}  // namespace traverse::coupling
