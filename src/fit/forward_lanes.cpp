// The runs of a fit in the lanes of batches: bridges, vehicles and speeds of the points differ, the steps in distance
// are the same, so that the computed series are smooth functions of the options.
#include <algorithm>
#include <cmath>
#include <deque>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "beam/mesh.hpp"
#include "engine/processor.hpp"
#include "ensemble/case_batch.hpp"
#include "fit/forward_model.hpp"
#include "fit/spline.hpp"
#include "traverse/options/input.hpp"

namespace traverse::fit {
namespace {

constexpr double last_change = 1e-11;  // of a force: the changes of a misfit near its minimum are small
constexpr double beyond_end = 2.0;     // spacings of the stored samples: the last instant is between two of them

/// One point: its scene and what computes it.
struct Point {
  scene::Scene scene;
  std::vector<std::string> ignored;  // notes
  run::SharedBeam shared;
  std::unique_ptr<ensemble::CaseBatch> batch;  // null: the run is computed alone

  Point(scene::Scene own, double distance) : scene(std::move(own)), shared(PETSC_COMM_SELF, scene, ignored) {
    shared.set_up(scene, !scene.model.step || scene.model.modes > 0, ignored);
    std::string why;
    batch = ensemble::CaseBatch::make(scene, shared, distance, why);
  }
};

std::optional<engine::Response> response_of(const options::MeasuredSeries& series) {
  const std::string_view name = series.dataset;
  if (!series.x) return std::nullopt;
  if (name == "/probes/deflection") return engine::Response::deflection;
  if (name == "/probes/acceleration") return engine::Response::acceleration;
  if (name == "/probes/moment") return engine::Response::moment;
  return std::nullopt;
}

}  // namespace

/// Batches compute a whole layered track, single runs only the part of it that moves: these are faster.
void ForwardModel::find_lanes(const scene::Scene& scene, const run::SharedBeam& shared) {
  if (given_.integer("sweep_lanes") == 0 || shared.beam->rail() != nullptr) return;
  if (!ensemble::CaseBatch::obstacle(scene, shared).empty()) return;
  std::vector<engine::Response> found;
  for (const options::MeasuredSeries& series : fit_.series) {
    const std::optional<engine::Response> response = response_of(series);
    if (!response) return;
    found.push_back(*response);
  }
  std::vector<double> low, high;
  for (const options::FitParameter& parameter : fit_.parameters) {
    low.push_back(parameter.low);
    high.push_back(parameter.high);
  }
  step_speed_ = scene.train.speed;
  for (const std::vector<double>& values : {start(), low, high})
    fastest_ = std::max(fastest_, scene::read_scene_of_fit(given_, fit_, values, false).train.speed);
  stored_ = std::move(found);
}

std::size_t ForwardModel::width() const { return stored_.empty() ? 1 : engine::best_width(); }

void ForwardModel::add_series_in_lanes(const std::vector<std::vector<double>>& points,
                                       std::vector<std::vector<double>>& responses) const {
  std::deque<Point> all;
  const double longest = *model_.step;
  for (const std::vector<double>& values : points)
    naming(values, [&] { all.emplace_back(scene(values, false), fastest_ * (end_ + 2.0 * beyond_end * longest)); });
  const auto end = [&](const Point& point, double spacing) {
    return end_ + beyond_end * spacing / point.scene.train.speed;
  };
  for (std::size_t i = 0; i < points.size();) {
    // The points from i on that form a batch.
    std::size_t past = i + 1;
    if (all[i].batch)
      while (past < points.size() && all[past].batch && all[past].batch->merge(*all[i].batch)) ++past;
    std::vector<engine::BatchResult> results(past - i);
    double spacing = 0.0;
    if (all[i].batch) {
      ensemble::CaseBatch::Steps steps = all[i].batch->steps();
      steps.stored = stored_;
      steps.last_change = last_change;
      spacing = ensemble::CaseBatch::spacing(steps, step_speed_);
      std::vector<ensemble::CaseBatch::Member> members;
      for (std::size_t k = i; k < past; ++k)
        members.push_back({&*all[k].batch, {all[k].scene.train.speed, end(all[k], spacing), {}, step_speed_}});
      results = ensemble::CaseBatch::ready(std::span<const ensemble::CaseBatch::Member>(members), steps).run();
    }
    for (std::size_t k = i; k < past; ++k) {
      const engine::BatchResult& run = results[k - i];
      const bool valid = all[k].batch && run.failure == engine::none &&
                         all[k].batch->residual(run) <= all[k].scene.model.residual_limit;
      if (valid)
        add_samples(run.samples, all[k].scene, spacing, responses[k]);
      else
        naming(points[k], [&] { add_series(points[k], responses[k]); });
    }
    i = past;
  }
}

/// samples: [instant][series][probe], at equal distances.
void ForwardModel::add_samples(const std::vector<double>& samples, const scene::Scene& scene, double spacing,
                               std::vector<double>& response) const {
  const std::vector<double>& probes = scene.output.probes;
  const std::size_t row = stored_.size() * probes.size(), count = samples.size() / row;
  std::vector<double> of_series(count);
  for (std::size_t s = 0; s < stored_.size(); ++s) {
    const auto probe =
        static_cast<std::size_t>(std::find(probes.begin(), probes.end(), *fit_.series[s].x) - probes.begin());
    const double ground = stored_[s] == engine::Response::deflection  // measured in space
                              ? beam::SupportLines(*scene.beam).at(*fit_.series[s].x).height(scene.beam->settlement)
                              : 0.0;
    for (std::size_t k = 0; k < count; ++k) of_series[k] = samples[k * row + s * probes.size() + probe] + ground;
    const Spline spline(of_series, spacing / scene.train.speed);
    for (std::size_t k = 0; k < instants_; ++k) response.push_back(spline(static_cast<double>(k) * interval_));
  }
}

}  // namespace traverse::fit
