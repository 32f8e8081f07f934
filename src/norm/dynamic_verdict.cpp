// Dynamic factors phi'_dyn from the peaks of computed runs of trains, the greatest effects of trains and load models
// times their factors, and the quantities of limits of EN 1991-2.
#include "norm/dynamic_verdict.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "norm/en1991.hpp"

namespace traverse::norm {
namespace {

constexpr double min_static_share = 0.25;  // relative to the greatest static effect

}  // namespace

NormCheck::NormCheck(const beam::BeamModel& model, const options::NormRules& rules, std::vector<LoadModel> trains,
                     const std::vector<double>& probes, std::vector<double> eccentricities)
    : eccentricities_(std::move(eccentricities)),
      rules_(rules),
      lengths_(determinant_lengths(model)),
      trains_(trains.size()),
      models_(rules.load_models) {
  beam::BeamModel with_tracks = model;
  if (model.torsion) {
    std::vector<beam::ActionLine>& tracks = with_tracks.torsion->tracks;
    std::erase_if(tracks, &beam::ActionLine::sideways);
    track_ = tracks.front().lever;
    tracks.front() = {track_ + tracks.front().shift};  // of weights at rest
    if (rules.second_track) tracks.push_back({*rules.second_track});
  }
  StaticBridge bridge(with_tracks);
  n0_ = bridge.first_frequency();
  const bool continuous = lengths_ != model.spans;
  const auto selected = [&](const char* name) {
    return std::find(models_.begin(), models_.end(), name) != models_.end();
  };
  if (selected("lm71") && continuous && !selected("sw0")) models_.emplace_back("sw0");
  if (rules.length) std::fill(lengths_.begin(), lengths_.end(), *rules.length);
  std::vector<LoadModel> loads = std::move(trains);
  for (const std::string& name : models_) loads.push_back(load_model(name));
  effects_ = static_effects(bridge, std::move(loads), rules.spacing, probes, track_);
}

double NormCheck::length_at(const Place& place) const { return lengths_[place.number]; }

double NormCheck::phi_at(const Place& place) const {
  return rules_.careful ? phi2(length_at(place)) : phi3(length_at(place));
}

/// The classification factor of a load; 1 for trains.
double NormCheck::alpha(std::size_t load) const {
  return load >= trains_ && options::load_model_row(models_[load - trains_])->classified ? rules_.alpha : 1.0;
}

/// Phi and alpha of a load model.
double NormCheck::factor(std::size_t load, const Place& place) const { return phi_at(place) * alpha(load); }

bool NormCheck::is_beside_the_trains(std::size_t probe) const {
  return !eccentricities_.empty() && eccentricities_[probe] != track_;
}

DynamicFactor NormCheck::dynamic_factor(const ComputedPeaks& computed, std::size_t train, Effect effect) const {
  const std::vector<Place>& places = effects_.places[static_cast<std::size_t>(effect)];
  const std::vector<double>& peaks =
      effect == Effect::deflection ? computed.trains[train].deflection : computed.trains[train].moment;
  std::vector<double> static_effect;
  for (const double x : computed.probes) {
    const auto place = std::find_if(places.begin(), places.end(), [x](const Place& p) { return p.x == x; });
    static_effect.push_back(effects_.at(effect, train, static_cast<std::size_t>(place - places.begin())).size());
  }
  const double least = min_static_share * *std::max_element(static_effect.begin(), static_effect.end());
  DynamicFactor factor;
  for (std::size_t v = 0; v < computed.speeds.size(); ++v)
    for (std::size_t p = 0; p < computed.probes.size(); ++p) {
      if (!(static_effect[p] > 0.0 && static_effect[p] >= least) || is_beside_the_trains(p)) continue;
      const double value = peaks[v * computed.probes.size() + p] / static_effect[p] - 1.0;
      if (value > factor.value || factor.speed == 0.0)
        factor = {std::max(value, 0.0), computed.speeds[v], computed.probes[p]};
    }
  return factor;
}

void NormCheck::compare(const ComputedPeaks& computed) {
  rows_.clear();
  speed_ = *std::max_element(computed.speeds.begin(), computed.speeds.end());
  std::vector<std::size_t> models;
  for (std::size_t i = 0; i < models_.size(); ++i)
    if (options::load_model_row(models_[i])->compared) models.push_back(trains_ + i);
  for (std::size_t e = 0; e < effect_count; ++e) {
    Row row;
    row.effect = static_cast<Effect>(e);
    const std::vector<Place>& places = effects_.places[e];
    if (places.empty()) continue;
    for (std::size_t train = 0; train < trains_; ++train) {
      // Shear, reactions, rotations and twist have no computed peaks: they get the factor of the deflection.
      const DynamicFactor dynamic =
          dynamic_factor(computed, train, row.effect == Effect::moment ? Effect::moment : Effect::deflection);
      const auto factor_at = [&](const Place& p) {
        return 1.0 + dynamic.value + 0.5 * phi_of_track(speed_, length_at(p), n0_);
      };
      const std::size_t worst = effects_.worst(row.effect, train, factor_at);
      const double size = effects_.at(row.effect, train, worst).size(), value = factor_at(places[worst]) * size;
      if (train > 0 && value <= row.of_train) continue;
      row.train = train;
      row.dynamic = dynamic;
      row.of_train = value;
      row.static_train = size;
      row.train_x = places[worst].x;
    }
    for (const std::size_t model : models) {
      const auto factor_at = [&](const Place& p) { return factor(model, p); };
      const std::size_t worst = effects_.worst(row.effect, model, factor_at);
      const double size = effects_.at(row.effect, model, worst).size(), value = factor_at(places[worst]) * size;
      if (model != models.front() && value <= row.of_model) continue;
      row.model = model;
      row.of_model = value;
      row.static_model = size;
      row.model_x = places[worst].x;
    }
    if (row.of_model > 0.0) rows_.push_back(row);
  }
}

results::EvaluatedQuantity NormCheck::of_lm71(Effect effect, bool over_span) const {
  results::EvaluatedQuantity quantity;
  if (effects_.places[static_cast<std::size_t>(effect)].empty()) {
    quantity.why = effect == Effect::track_twist ? "the bridge does not twist (beam_GJ)"
                                                 : "the bridge has no joint between two decks";
    return quantity;
  }
  for (std::size_t load = trains_; load < effects_.loads.size(); ++load) {
    if (!options::load_model_row(models_[load - trains_])->compared) continue;
    const auto factor_at = [&](const Place& p) { return factor(load, p) / (over_span ? p.span : 1.0); };
    const std::size_t worst = effects_.worst(effect, load, factor_at);
    const Place& place = effects_.places[static_cast<std::size_t>(effect)][worst];
    const double value = effects_.at(effect, load, worst).size() * factor_at(place);
    if (value <= quantity.value) continue;  // false if no value was found yet
    quantity = {value, results::EvaluatedQuantity::unknown, place.x,
                fmt::format("{} with alpha = {:g} and Phi{} = {:.4g}", effects_.loads[load].name, rules_.alpha,
                            rules_.careful ? 2 : 3, phi_at(place)),
                ""};
  }
  if (std::isnan(quantity.value)) quantity.why = "LM71 is not among norm_load_models";
  return quantity;
}

results::EvaluatedQuantity NormCheck::of_trains() const {
  results::EvaluatedQuantity quantity;
  for (const Row& row : rows_) {
    if (row.ratio() <= quantity.value) continue;
    quantity = {row.ratio(), results::EvaluatedQuantity::unknown, row.train_x,
                fmt::format("{} of {} at {:.4g} km/h", effect_rows[static_cast<std::size_t>(row.effect)].words,
                            effects_.loads[row.train].name, 3.6 * row.dynamic.speed),
                ""};
  }
  if (rows_.empty()) quantity.why = "no passages of a train were compared with LM71";
  return quantity;
}

void NormCheck::find(std::vector<results::Verdict>& verdicts) const {
  for (results::Verdict& verdict : verdicts) {
    const std::string& name = verdict.limit.quantity;
    if (options::limit_quantity(name)->finder != options::LimitFinder::norm) continue;
    verdict.found = name == "train_over_lm71"       ? of_trains()
                    : name == "lm71_end_rotation"   ? of_lm71(Effect::end_rotation, false)
                    : name == "lm71_joint_rotation" ? of_lm71(Effect::joint_rotation, false)
                    : name == "lm71_track_twist"    ? of_lm71(Effect::track_twist, false)
                                                    : of_lm71(Effect::deflection, true);
    verdict.found.value *= verdict.limit.factor;
    verdict.runs = 1;
    verdict.exceeded_in = 0;
  }
}

std::string NormCheck::length_text() const {
  const auto [least, greatest] = std::minmax_element(lengths_.begin(), lengths_.end());
  const auto phi = [this](double L) { return rules_.careful ? phi2(L) : phi3(L); };
  const int kind = rules_.careful ? 2 : 3;
  const std::string track = rules_.careful ? "carefully maintained track" : "standard maintenance";
  std::string text = *least == *greatest
                         ? fmt::format("L_Phi = {:.4g} m, Phi{} = {:.4g} ({})", *least, kind, phi(*least), track)
                         : fmt::format("L_Phi = {:.4g} to {:.4g} m, Phi{} = {:.4g} to {:.4g} ({})", *least, *greatest,
                                       kind, phi(*least), phi(*greatest), track);
  text += fmt::format(", alpha = {:g}, n0 = {:.4g} Hz", rules_.alpha, n0_);
  const auto bounds = frequency_bounds(*greatest);
  if (*least == *greatest && bounds)
    text += fmt::format(", {} {:.3g} to {:.3g} Hz of figure 6.10",
                        n0_ >= bounds->first && n0_ <= bounds->second ? "within" : "outside", bounds->first,
                        bounds->second);
  if (speed_ <= 0.0) return text;
  const double of_speed = phi_of_speed(speed_, *least, n0_), of_track = phi_of_track(speed_, *least, n0_);
  return text + fmt::format("; annex C at {:.4g} km/h: phi' = {:.3g}, phi'' = {:.3g}, 1 + phi' + phi''{} = {:.4g}",
                            3.6 * speed_, of_speed, of_track, rules_.careful ? "/2" : "",
                            1.0 + of_speed + (rules_.careful ? 0.5 : 1.0) * of_track);
}

}  // namespace traverse::norm
