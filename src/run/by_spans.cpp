#include "run/by_spans.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>

#include "integrate/integrator_choice.hpp"
#include "lanes/train_numbers.hpp"
#include "recovery/viscous_lag.hpp"
#include "run/span_modes.hpp"

namespace traverse::app {
namespace {

constexpr double same_instant = 1e-10;  // s
constexpr int most_modes = 64;          // of a span: beyond, its elements take less

class BySpans final : public coupling::SteppedApart {
 public:
  BySpans(const Scene& scene, const SharedBeam& shared, lanes::SpanPlan plan, train::Fleet fleet, const double* y,
          std::vector<double> kinks)
      : speed_(scene.train.speed),
        parts_(*shared.statics->parts()),
        kinds_(plan.kinds),
        fleet_(std::move(fleet)),
        coordinates_(static_cast<std::size_t>(fleet_.freedom())),
        unknowns_(static_cast<std::size_t>(shared.statics->unknowns())),
        kinks_(std::move(kinks)),
        crossing_(plan, lanes::train_numbers(fleet_), modal_coordinates(*shared.beam, *shared.statics, plan, y),
                  speed_),
        recovery_(*shared.beam, scene.output.probes, 0.0) {
    for (std::size_t s = 0, element = 0; s < plan.spans.size(); ++s) {
      first_element_.push_back(static_cast<int>(element));
      element += static_cast<std::size_t>(plan.kinds[plan.spans[s].kind].elements);
      span_kind_.push_back(plan.spans[s].kind);
    }
    modes_.resize(3 * static_cast<std::size_t>(crossing_.stride()));
    for (std::vector<double>* nodal : {&v_, &w_, &a_}) nodal->resize(unknowns_);
    for (const double x : scene.output.probes) {
      const int element = shared.beam->mesh().locate(x).element;
      watched_.push_back(shared.beam->mesh().element(element).span);
    }
    std::sort(watched_.begin(), watched_.end());
    watched_.erase(std::unique(watched_.begin(), watched_.end()), watched_.end());
    loads_.reserve(fleet_.wheels.size());
    moment_lag_ = shared.rayleigh.b;
    if (moment_lag_ > 0.0) lag_.emplace(recovery_, moment_lag_);
  }

  bool step(double t, double h) override {
    const bool from_kink = at_kink(t), to_kink = at_kink(t + h);
    const lanes::Trouble trouble = crossing_.step(t + h, from_kink, to_kink);
    if (trouble == lanes::not_finite)
      throw StepTooLong(fmt::format(
          "the motion has grown beyond all bounds by t = {} s: the step is too long; take a smaller -ts_dt", t + h));
    return trouble == lanes::none;
  }
  void tell(double* y) const override {
    const auto [first, past] = crossing_.moving();
    double *v = y, *w = y + unknowns_;
    for (double* nodal : {v, w}) put_to_rest(nodal, told_, first);
    told_ = first;
    for (int span = first; span < past; ++span) nodal_motion(span, v, w, nullptr);
    double* p = w + unknowns_;
    for (std::size_t i = 0; i < coordinates_; ++i) {
      p[i] = crossing_.coordinate(i);
      p[coordinates_ + i] = crossing_.coordinate_rate(i);
    }
  }
  bool tell_rate(const structure::ElementLoads& contacts, double* ydot) const override {
    const auto [first, past] = crossing_.moving();
    for (double* nodal : {ydot, ydot + unknowns_}) put_to_rest(nodal, told_rate_, first);
    told_rate_ = first;
    for (int span = first; span < past; ++span) {
      modal_motion(span);
      push(span, contacts);
      write(span, modes_.data() + crossing_.stride(), ydot);
      write(span, modes_.data() + 2 * static_cast<std::ptrdiff_t>(crossing_.stride()), ydot + unknowns_);
    }
    return true;
  }
  std::optional<structure::StructureEnergy> energy() const override {
    structure::StructureEnergy e;
    const auto [first, past] = crossing_.moving();
    for (int span = first; span < past; ++span) {
      const auto [kinetic, strain] = crossing_.energy_now(span);
      e.kinetic += kinetic;
      e.strain += strain;
    }
    return e;
  }
  double dissipated() const override { return crossing_.lost(); }
  double worked() const override { return crossing_.given(); }
  Wheel wheel(std::size_t wheel) const override { return {crossing_.x(wheel), crossing_.wheel(wheel).force}; }
  void see(std::span<beam::Response> probes) const override {
    const auto [first, past] = crossing_.moving();
    for (const int span : watched_) {
      if (span >= first && span < past) {
        nodal_motion(span, v_.data(), w_.data(), a_.data());
      } else {
        for (std::vector<double>* nodal : {&v_, &w_, &a_}) put_to_rest(nodal->data(), span, span + 1);
      }
    }
    loads_.clear();
    for (std::size_t j = 0; j < fleet_.wheels.size(); ++j) {
      const lanes::SpanCrossing::Shown& at = crossing_.wheel(j);
      if (at.span < 0) continue;
      loads_.push_back(
          {first_element_[static_cast<std::size_t>(at.span)] + at.element, at.xi, 0.0, -at.force, 0.0, speed_});
    }
    recovery_.evaluate(v_.data(), w_.data(), a_.data(), loads_, seen_);
    if (lag_) lag_->apply(crossing_.time(), loads_, seen_);
    std::copy(seen_.begin(), seen_.end(), probes.begin());
  }
  double moment_lag() const override { return moment_lag_; }
  double defect() override { return lanes::defect(fleet_, crossing_.bent()); }
  void keep(base::Archive& archive) override {
    archive.same(crossing_, next_kink_, told_, told_rate_, v_, w_, a_, loads_, seen_);
    if (lag_) archive.same(*lag_);
  }

 private:
  /// Of times that ascend, but for the last one.
  bool at_kink(double t) {
    while (next_kink_ < kinks_.size() && kinks_[next_kink_] < t - same_instant) ++next_kink_;
    return next_kink_ < kinks_.size() && kinks_[next_kink_] <= t + same_instant;
  }
  /// The first unknown of a span, or of what follows the last one.
  std::size_t begin_of(int span) const {
    const auto s = static_cast<std::size_t>(span);
    return s < parts_.parts.size() ? 2 * static_cast<std::size_t>(parts_.parts[s].first) : unknowns_;
  }
  /// Of spans: [first, past).
  void put_to_rest(double* nodal, int first, int past) const {
    if (first < past) std::fill(nodal + begin_of(first), nodal + begin_of(past), 0.0);
  }
  const lanes::SpanKind& kind_of(int span) const { return kinds_[span_kind_[static_cast<std::size_t>(span)]]; }
  /// The modes' coordinates, their rates, and accelerations, one behind the other in modes_.
  void modal_motion(int span) const {
    double *q = modes_.data(), *rate = q + crossing_.stride();
    crossing_.motion(span, q, rate, rate + crossing_.stride());
  }
  /// The accelerations in modes_ under the contacts' loads in place of those that the steps have found.
  void push(int span, const structure::ElementLoads& contacts) const {
    const lanes::SpanKind& kind = kind_of(span);
    const int first = first_element_[static_cast<std::size_t>(span)], modes = kind.modes();
    const double *q = modes_.data(), *rate = q + crossing_.stride();
    double* a = modes_.data() + 2 * static_cast<std::ptrdiff_t>(crossing_.stride());
    for (int i = 0; i < modes; ++i)
      a[i] = -kind.damping[static_cast<std::size_t>(i)] * rate[i] - kind.omega2[static_cast<std::size_t>(i)] * q[i];
    for (std::size_t e = 0; e < contacts.elements.size(); ++e) {
      const int element = contacts.elements[e] - first;
      if (element < 0 || element >= kind.elements) continue;
      for (int row = 0; row < 4; ++row) {
        const double load = contacts.values[4 * e + static_cast<std::size_t>(row)];
        const double* shape = kind.shape.data() + static_cast<std::ptrdiff_t>(2 * element + row) * modes;
        for (int i = 0; i < modes; ++i) a[i] += shape[i] * load;
      }
    }
  }
  /// Nodal values of what a span's modes are at, into a vector of all unknowns.
  void write(int span, const double* of, double* nodal) const {
    const lanes::SpanKind& kind = kind_of(span);
    using ByRows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    const Eigen::Index unknowns = 2 * static_cast<Eigen::Index>(kind.elements + 1), modes = kind.modes();
    Eigen::Map<Eigen::VectorXd>(nodal + begin_of(span), unknowns).noalias() =
        Eigen::Map<const ByRows>(kind.shape.data(), unknowns, modes) * Eigen::Map<const Eigen::VectorXd>(of, modes);
  }
  /// Of a span, into vectors of all unknowns; null: not asked for.
  void nodal_motion(int span, double* v, double* w, double* a) const {
    modal_motion(span);
    int i = 0;
    for (double* nodal : {v, w, a}) {
      if (nodal != nullptr) write(span, modes_.data() + static_cast<std::ptrdiff_t>(i) * crossing_.stride(), nodal);
      ++i;
    }
  }

  double speed_;
  const solve::Parts& parts_;
  std::vector<lanes::SpanKind> kinds_;
  train::Fleet fleet_;  // as it started
  std::size_t coordinates_, unknowns_;
  std::vector<double> kinks_;  // s, ascending: when a wheel is at a kink of the surface
  std::size_t next_kink_ = 0;
  lanes::SpanCrossing crossing_;
  std::vector<std::size_t> span_kind_;
  std::vector<int> first_element_, watched_;  // of every span; spans with probes
  mutable int told_ = 0, told_rate_ = 0;      // the first span that moved when y, and y', were told last
  // What probes see, in vectors of which only the spans watched are filled.
  mutable beam::Recovery recovery_;
  double moment_lag_ = 0.0;
  mutable std::optional<beam::ViscousLag> lag_;
  mutable std::vector<double> v_, w_, a_, modes_;
  mutable std::vector<beam::ElementLoad> loads_;
  mutable std::vector<beam::Response> seen_;
};

}  // namespace

std::string spans_obstacle(const Scene& scene) {
  if (!scene.beam || !scene.beam->all_separate() || scene.beam->spans.size() < 2) return "its spans touch";
  if (!scene.beam->hinges.empty() || !scene.beam->cracks.empty() || scene.beam->track || scene.beam->axial)
    return "its spans do not bend alone";
  if (scene.model_modes > 0) return "the bridge goes by modes of the whole";
  if (scene.vehicles.empty()) return "no vehicles run";
  if (!scene.load.forces.empty()) return "forces move beside the vehicles";
  if (scene.vehicle_model == VehicleModel::full) return "vehicles are mechanisms, not linear";
  if (!scene.train.steady()) return "the train's speed is not prescribed";
  if (!scene.profile.level()) return "the track is not level";
  if (scene.start != Start::equilibrium) return "the run does not start in equilibrium";
  if (scene.self_weight) return "the bridge's own weight bends it";
  if (scene.beam->ground != std::array{true, true}) return "the running surface ends with the bridge";
  if (scene.beam->strained()) return "temperature or settlements bend the bridge";
  if (scene.beam->GA) return "the bridge shears";
  if (scene.beam->surface_height != 0.0) return "wheels run above the beam's axis";
  if (!scene.output.passages.empty()) return "steps end where wheels pass the places of output_passages";
  const int elements = *std::max_element(scene.beam->elements.begin(), scene.beam->elements.end());
  if (2 * elements > most_modes) return "its spans have too many elements";
  return integrate::own_method(scene.integrator) ? "" : "ts_type is one of PETSc's own";
}

std::unique_ptr<coupling::SteppedApart> by_spans(const Scene& scene, const SharedBeam& shared,
                                                 const coupling::System& system, const double* y, double end_time) {
  if (!scene.step_lanes || scene.all_ranks || scene.vehicle_model != VehicleModel::linear ||
      !spans_obstacle(scene).empty() || !lanes::obstacle(system.fleet()).empty())
    return nullptr;
  const structure::BeamOperator& op = *shared.statics;
  const auto spans = scene.beam->spans.size();
  if (op.shared() || op.parts() == nullptr || op.parts()->parts.size() != spans || !op.mass_damping() ||
      op.springs() != nullptr || op.drag() != nullptr)
    return nullptr;
  lanes::SpanPlan plan = spans_of(*shared.beam, op);
  plan.method = *integrate::own_method(scene.integrator);
  plan.all = scene.rest_tolerance == 0.0;
  return std::make_unique<BySpans>(scene, shared, std::move(plan), system.fleet(), y,
                                   system.known_events(end_time, scene.step_kinks));
}

}  // namespace traverse::app
