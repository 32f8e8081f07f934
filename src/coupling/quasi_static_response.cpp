// Largest static deflection at a station by superposition of its influence line, which is computed by the theorem of
// Maxwell and Betti, over many positions of wheels and moving forces.
#include "coupling/quasi_static_response.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "base/gauss.hpp"
#include "beam/shape.hpp"

namespace traverse::coupling {
namespace {

constexpr double unbounded = std::numeric_limits<double>::infinity();
constexpr int positions = 2000;            // number of positions of the weights along their path
constexpr double constant_distance = 0.5;  // m: weights whose distances change by less move as one train

}  // namespace

// The deflection of a station under a unit downward force on the line of the wheels, over the position of the force. By
// the theorem of Maxwell and Betti it is the deflection of that line under a load. The nodal forces of this load are
// the coefficients of the nodal values of the station's element in the deflection at the station. A force on that
// element adds a deflection between its nodes.
struct QuasiStaticResponse::InfluenceLine {
  double station = 0.0;
  std::vector<double> nodal;                 // deflection and rotation at both ends of every element, on every rank
  std::optional<recovery::Recovery> inside;  // recovery inside the station's element; none if wheels run on a rail
  double weight_deflection = 0.0;            // m: deflection under the beam's own weight

  double at(const beam::Line& on, double x, int track) const {
    const beam::Mesh& mesh = on.mesh;
    if (x < mesh.start() || x > mesh.end()) return 0.0;
    const beam::Station s = mesh.locate(x);
    const beam::Element& element = mesh.element(s.element);
    const int number = mesh.on_track(s, track).element;
    const auto first = 4 * static_cast<std::size_t>(number);
    const beam::Hermite psi = beam::hermite(s.xi, element.length, element.shear);
    recovery::ElementLoad unit = {s.element, s.xi, 0.0, -1.0, 0.0};
    unit.move_from(on.action_line(number));
    double sum = inside ? inside->deflection_inside(0, unit) : 0.0;
    for (int i = 0; i < 4; ++i) sum += psi.value[i] * nodal[first + static_cast<std::size_t>(i)];
    return sum;
  }

  /// The mean over the length of a load about x, 0 outside the mesh; length 0: the value at x.
  double mean(const beam::Line& on, const StaticLoad& load, double x) const {
    const beam::Mesh& mesh = on.mesh;
    const double length = load.length;
    if (length == 0.0) return at(on, x, load.track);
    const double from = std::max(x - 0.5 * length, mesh.start()), to = std::min(x + 0.5 * length, mesh.end());
    if (!(to > from)) return 0.0;
    double sum = 0.0;
    const auto add = [&](double place, double weight) { sum += weight * at(on, place, load.track); };
    for (int e = mesh.locate(from).element; e <= mesh.locate(to).element; ++e) {
      const beam::Element& element = mesh.element(e);
      const double left = std::max(from, element.x), right = std::min(to, element.x + element.length);
      if (!(right > left)) continue;
      const double middle = std::clamp(station, left, right);
      if (middle > left) base::at_gauss_points<3>(left, middle, add);
      if (right > middle) base::at_gauss_points<3>(middle, right, add);
    }
    return sum / length;
  }
};

QuasiStaticResponse::InfluenceLine QuasiStaticResponse::influence_line(double station) {
  const beam::Beam& beam = structure_->beam();
  const int elements = structure_->line().tracks() * structure_->line().mesh.elements();
  InfluenceLine line{station, std::vector<double>(4 * static_cast<std::size_t>(elements), 0.0), {}, 0.0};
  std::vector<double> nodal(structure_->dead_load().size(), 0.0);
  const beam::Station s = beam.mesh().locate(station);
  if (beam.rail() != nullptr) {
    structure_->add_force(beam.bridge(), {s.element, s.xi, 0.0, -1.0, 0.0}, nodal.data());
  } else {
    line.inside.emplace(beam, std::vector<double>{station}, gravity_);
    line.weight_deflection = line.inside->add_deflection_form(0, -1.0, nodal.data());
  }
  structure_->release_held(nodal.data());
  structure_->statics().solve_static(nodal.data());
  double weight_deflection = 0.0;
  for (std::size_t i = 0; i < nodal.size(); ++i) weight_deflection -= nodal[i] * structure_->dead_load()[i];
  MPI_Allreduce(MPI_IN_PLACE, &weight_deflection, 1, MPI_DOUBLE, MPI_SUM, comm_);
  line.weight_deflection += weight_deflection;
  if (beam.model().strained()) line.weight_deflection = permanent_deflection(station);
  for (int e = 0; e < elements; ++e) {
    const int along = structure_->per_node() - 2;  // unknowns of a node along x
    structure_->line().for_unknowns(e, [&](int k, int unknown, double factor) {
      const int local = beam.local(unknown), place = k % (along + 2) - along;
      if (local >= 0 && place >= 0)
        line.nodal[4 * static_cast<std::size_t>(e) + static_cast<std::size_t>(2 * (k / (along + 2)) + place)] +=
            factor * nodal[local];
    });
  }
  MPI_Allreduce(MPI_IN_PLACE, line.nodal.data(), static_cast<int>(line.nodal.size()), MPI_DOUBLE, MPI_SUM, comm_);
  return line;
}

// The deflection of a station relative to the line through the supports, under the dead load, the beam's strains and
// settlements.
double QuasiStaticResponse::permanent_deflection(double station) {
  const std::vector<double> permanent = structure_->displacements_without_traffic(), zeros(permanent.size(), 0.0);
  recovery::Recovery recovery(structure_->beam(), {station}, gravity_);
  std::vector<recovery::Response> responses;
  recovery.evaluate(permanent.data(), zeros.data(), zeros.data(), {}, responses);
  return responses.front().relative_deflection;
}

bool QuasiStaticResponse::pass_together(const train::WheelPaths& paths) const {
  if (paths.instants() > 1 && weights_.front().law.direction() == 0.0) return false;  // a free train starts from rest
  const auto other_speed = [this](const StaticLoad& w) { return w.law.speed(0.0) != weights_.front().law.speed(0.0); };
  return steady() && std::none_of(weights_.begin(), weights_.end(), other_speed) && paths.drift() < constant_distance;
}

// Whether all speeds are constant.
bool QuasiStaticResponse::steady() const {
  return std::all_of(weights_.begin(), weights_.end(), [](const StaticLoad& w) { return w.law.constant(); });
}

double QuasiStaticResponse::static_peak(double station, const train::WheelPaths& paths, double end) {
  if (!superpose()) return 0.0;
  const InfluenceLine line = influence_line(station);
  return pass_together(paths) ? peak_of_train(line, line.weight_deflection) : peak_along_paths(line, paths, end);
}

double QuasiStaticResponse::static_energy(double station) {
  if (!superpose() || !pass_together({})) return 0.0;
  const InfluenceLine line = influence_line(station);
  const double deflection = peak_of_train(line, 0.0), compliance = std::abs(line.at(structure_->line(), station, 0));
  return compliance > 0.0 ? 0.5 * deflection * deflection / compliance : 0.0;
}

// Each weight above the station, where the influence line has its peak, and equidistant positions along the whole path.
// The constant is added.
double QuasiStaticResponse::peak_of_train(const InfluenceLine& line, double constant) const {
  const beam::Mesh& mesh = structure_->line().mesh;
  double front = -unbounded, rear = unbounded;
  for (const StaticLoad& w : weights_) {
    front = std::max(front, w.x + 0.5 * w.length);
    rear = std::min(rear, w.x - 0.5 * w.length);
  }
  double peak = 0.0;
  auto evaluate_shift = [&](double shift) {
    double sum = constant;
    for (const StaticLoad& w : weights_) sum += w.force * line.mean(structure_->line(), w, w.x + shift);
    peak = std::max(peak, std::abs(sum));
  };
  if (weights_.front().law.direction() == 0.0) {  // the loads do not move
    evaluate_shift(0.0);
    return peak;
  }
  for (const StaticLoad& w : weights_) evaluate_shift(line.station - w.x);
  for (int i = 0; i <= positions; ++i)
    evaluate_shift(mesh.start() - front + (mesh.end() - mesh.start() + front - rear) * i / positions);
  return peak;
}

// Positions of all weights at the same time, from t = 0 to the end: whenever one is above the station, and equidistant.
double QuasiStaticResponse::peak_along_paths(const InfluenceLine& line, const train::WheelPaths& paths,
                                             double end) const {
  const std::size_t instants = paths.instants();
  const auto position = [&](std::size_t i, std::size_t instant, double t) {
    return i < wheels_ && instants > 1 ? paths.x(instant, i) : weights_[i].x + weights_[i].law.distance(t);
  };
  std::vector<double> from(weights_.size()), travel(weights_.size());
  double peak = 0.0;
  const auto evaluate_at = [&](double fraction) {
    double sum = line.weight_deflection;
    for (std::size_t i = 0; i < weights_.size(); ++i)
      sum += weights_[i].force * line.mean(structure_->line(), weights_[i], from[i] + fraction * travel[i]);
    peak = std::max(peak, std::abs(sum));
  };
  const std::size_t stretches = instants > 1 ? instants - 1 : steady() ? 1 : positions;
  const auto time = [&](std::size_t k) {
    return instants > 1 ? paths.time(k) : end * static_cast<double>(k) / static_cast<double>(stretches);
  };
  const int fractions = std::max(1, positions / static_cast<int>(stretches));
  for (std::size_t k = 0; k < stretches; ++k) {
    const double begin = time(k), next = time(k + 1);
    for (std::size_t i = 0; i < weights_.size(); ++i) {
      from[i] = position(i, k, begin);
      travel[i] = position(i, k + 1, next) - from[i];
    }
    for (std::size_t i = 0; i < weights_.size(); ++i) {
      const double fraction = (line.station - from[i]) / travel[i];
      if (fraction >= 0.0 && fraction <= 1.0) evaluate_at(fraction);
    }
    for (int i = 0; i <= fractions; ++i) evaluate_at(static_cast<double>(i) / fractions);
  }
  return peak;
}

}  // namespace traverse::coupling
