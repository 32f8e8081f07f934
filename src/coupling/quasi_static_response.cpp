// Largest static deflection at a station by superposition of its influence line, which is computed by the theorem of
// Maxwell and Betti, over many positions of wheels and moving forces.
#include "coupling/quasi_static_response.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "beam/shape.hpp"

namespace traverse::coupling {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr int positions = 2000;   // of the weights along their way
constexpr double together = 0.5;  // m: weights whose distances change by less pass as one train

}  // namespace

// The deflection of a station under a unit downward force on the line that wheels run on, over the force's place. What
// the nodal values of the station's element give is a load on the structure, whose deflections are that line (Maxwell
// and Betti); a force on that element deflects it between its nodes besides.
struct QuasiStaticResponse::InfluenceLine {
  double station = 0.0;
  std::vector<double> nodal;             // deflection and rotation at both ends of every element, on every rank
  std::optional<beam::Recovery> inside;  // of the station; none where wheels run on a rail
  double of_weight = 0.0;                // m: what the beam's own weight adds

  double at(const beam::Mesh& mesh, double x) const {
    if (x < mesh.start() || x > mesh.end()) return 0.0;
    const beam::Station s = mesh.locate(x);
    const beam::Element& element = mesh.element(s.element);
    const beam::Hermite psi = beam::hermite(s.xi, element.length, element.shear);
    double sum = inside ? inside->deflection_inside(0, {s.element, s.xi, 0.0, -1.0, 0.0}) : 0.0;
    for (int i = 0; i < 4; ++i) sum += psi.value[i] * nodal[4 * static_cast<std::size_t>(s.element) + i];
    return sum;
  }
};

QuasiStaticResponse::InfluenceLine QuasiStaticResponse::influence_line(double station) {
  const beam::Beam& beam = structure_->beam();
  InfluenceLine line{
      station, std::vector<double>(4 * static_cast<std::size_t>(structure_->line().mesh.elements()), 0.0), {}, 0.0};
  std::vector<double> nodal(structure_->dead_load().size(), 0.0);
  const beam::Station s = beam.mesh().locate(station);
  if (beam.rail() != nullptr) {
    structure_->add_force(beam.bridge(), {s.element, s.xi, 0.0, -1.0, 0.0}, nodal.data());
  } else {
    line.inside.emplace(beam, std::vector<double>{station}, gravity_);
    line.of_weight = line.inside->add_deflection_form(0, -1.0, nodal.data());
  }
  structure_->release_held(nodal.data());
  structure_->statics().solve_static(nodal.data());
  double of_weight = 0.0;
  for (std::size_t i = 0; i < nodal.size(); ++i) of_weight -= nodal[i] * structure_->dead_load()[i];
  MPI_Allreduce(MPI_IN_PLACE, &of_weight, 1, MPI_DOUBLE, MPI_SUM, comm_);
  line.of_weight += of_weight;
  if (beam.model().strained()) line.of_weight = rest_at(station);
  for (int e = 0; e < structure_->line().mesh.elements(); ++e) {
    const auto unknowns = structure_->line().transverse(e);
    for (int i = 0; i < 4; ++i) {
      const int local = beam.local(unknowns[i]);
      if (local >= 0) line.nodal[4 * static_cast<std::size_t>(e) + i] = nodal[local];
    }
  }
  MPI_Allreduce(MPI_IN_PLACE, line.nodal.data(), static_cast<int>(line.nodal.size()), MPI_DOUBLE, MPI_SUM, comm_);
  return line;
}

// The deflection of a station under the dead load, the beam's strains and settlements.
double QuasiStaticResponse::rest_at(double station) {
  const std::vector<double> rest = structure_->rest(), none(rest.size(), 0.0);
  beam::Recovery recovery(structure_->beam(), {station}, gravity_);
  std::vector<beam::Response> found;
  recovery.evaluate(rest.data(), none.data(), none.data(), {}, found);
  return found.front().deflection;
}

bool QuasiStaticResponse::pass_together(const train::WheelPaths& paths) const {
  const auto otherwise = [this](const StaticLoad& w) { return w.law.speed(0.0) != weights_.front().law.speed(0.0); };
  return steady() && std::none_of(weights_.begin(), weights_.end(), otherwise) && paths.drift() < together;
}

// Whether no speed changes.
bool QuasiStaticResponse::steady() const {
  return std::all_of(weights_.begin(), weights_.end(), [](const StaticLoad& w) { return w.law.constant(); });
}

double QuasiStaticResponse::static_peak(double station, const train::WheelPaths& paths, double end) {
  if (!superpose()) return 0.0;
  const InfluenceLine line = influence_line(station);
  return pass_together(paths) ? peak_of_train(line, line.of_weight) : peak_on_the_way(line, paths, end);
}

double QuasiStaticResponse::static_energy(double station) {
  if (!superpose() || !pass_together({})) return 0.0;
  const InfluenceLine line = influence_line(station);
  const double deflection = peak_of_train(line, 0.0), compliance = std::abs(line.at(structure_->line().mesh, station));
  return compliance > 0.0 ? 0.5 * deflection * deflection / compliance : 0.0;
}

// Every weight over the station in turn (where the line peaks), and evenly along the whole way; the constant added.
double QuasiStaticResponse::peak_of_train(const InfluenceLine& line, double constant) const {
  const beam::Mesh& mesh = structure_->line().mesh;
  double front = -infinite, rear = infinite;
  for (const auto& [x, force, law] : weights_) {
    front = std::max(front, x);
    rear = std::min(rear, x);
  }
  double peak = 0.0;
  auto try_shift = [&](double shift) {
    double sum = constant;
    for (const auto& [x, force, law] : weights_) sum += force * line.at(mesh, x + shift);
    peak = std::max(peak, std::abs(sum));
  };
  for (const auto& [x, force, law] : weights_) try_shift(line.station - x);
  for (int i = 0; i <= positions; ++i)
    try_shift(mesh.start() - front + (mesh.end() - mesh.start() + front - rear) * i / positions);
  return peak;
}

// Where the weights are at the same time, from t = 0 to the end: whenever one is over the station, and evenly.
double QuasiStaticResponse::peak_on_the_way(const InfluenceLine& line, const train::WheelPaths& paths,
                                            double end) const {
  const std::size_t known = paths.instants();
  const auto place = [&](std::size_t i, std::size_t instant, double t) {
    return i < wheels_ && known > 1 ? paths.x(instant, i) : weights_[i].x + weights_[i].law.distance(t);
  };
  std::vector<double> from(weights_.size()), way(weights_.size());
  double peak = 0.0;
  const auto try_part = [&](double part) {
    double sum = line.of_weight;
    for (std::size_t i = 0; i < weights_.size(); ++i)
      sum += weights_[i].force * line.at(structure_->line().mesh, from[i] + part * way[i]);
    peak = std::max(peak, std::abs(sum));
  };
  const std::size_t stretches = known > 1 ? known - 1 : steady() ? 1 : positions;
  const auto time = [&](std::size_t k) {
    return known > 1 ? paths.time(k) : end * static_cast<double>(k) / static_cast<double>(stretches);
  };
  const int parts = std::max(1, positions / static_cast<int>(stretches));
  for (std::size_t k = 0; k < stretches; ++k) {
    const double begin = time(k), next = time(k + 1);
    for (std::size_t i = 0; i < weights_.size(); ++i) {
      from[i] = place(i, k, begin);
      way[i] = place(i, k + 1, next) - from[i];
    }
    for (std::size_t i = 0; i < weights_.size(); ++i) {
      const double part = (line.station - from[i]) / way[i];
      if (part >= 0.0 && part <= 1.0) try_part(part);
    }
    for (int i = 0; i <= parts; ++i) try_part(static_cast<double>(i) / parts);
  }
  return peak;
}

}  // namespace traverse::coupling
