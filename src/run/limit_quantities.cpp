// Rotations of the nodes at the bridge's ends and at joints between decks, and vertical accelerations of the heaviest
// body of every vehicle.
#include "run/limit_quantities.hpp"

#include <algorithm>
#include <cmath>

namespace traverse::run {
namespace {

constexpr int rotation = 2, rotation_right = 3;  // unknowns of a node

}  // namespace

DeckRotations::DeckRotations(const beam::Beam& beam) : beam_(beam) {
  const beam::Line& line = beam.bridge();
  const beam::Mesh& mesh = line.mesh;
  unknowns_ = {line.unknown(0, rotation), line.unknown(mesh.nodes() - 1, rotation)};
  for (int i = 1; i < mesh.spans(); ++i) {
    const auto [left, right] = mesh.nodes_at(i);
    if (left == right && !mesh.hinged(left)) continue;
    unknowns_.push_back(line.unknown(left, rotation));
    unknowns_.push_back(line.unknown(right, left == right ? rotation_right : rotation));
    x_.push_back(mesh.span_ends()[static_cast<std::size_t>(i)]);
  }
  slopes_.resize(unknowns_.size());
}

void DeckRotations::add(double t, const double* v) {
  for (std::size_t i = 0; i < unknowns_.size(); ++i) {
    const int local = beam_.local(unknowns_[i]);
    slopes_[i] = local >= 0 ? v[local] : 0.0;
  }
  MPI_Allreduce(MPI_IN_PLACE, slopes_.data(), static_cast<int>(slopes_.size()), MPI_DOUBLE, MPI_SUM, beam_.comm());
  record(t, slopes_);
}

CarAccelerations::CarAccelerations(const train::Fleet& fleet) : fleet_(fleet) {
  for (const train::Member& member : fleet.members) {
    const std::vector<multibody::Body>& bodies = member.type->mechanism.bodies;
    const auto lighter = [](const multibody::Body& a, const multibody::Body& b) { return a.mass < b.mass; };
    heaviest_.push_back(
        static_cast<std::size_t>(std::max_element(bodies.begin(), bodies.end(), lighter) - bodies.begin()));
  }
}

void CarAccelerations::add(double t) {
  for (std::size_t i = 0; i < heaviest_.size(); ++i) {
    const train::Member& member = fleet_.members[i];
    const auto body = member.first_body + static_cast<Eigen::Index>(heaviest_[i]);
    const Eigen::VectorXd& qdd = fleet_.vehicles[static_cast<std::size_t>(member.unit)].state.qdd;
    largest_.raise(std::abs(qdd[3 * body + 1]), t, i);
  }
}

const std::string& CarAccelerations::body(std::size_t vehicle) const {
  return fleet_.members[vehicle].type->mechanism.bodies[heaviest_[vehicle]].name;
}

}  // namespace traverse::run
