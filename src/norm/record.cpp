// Static effects and the verdict of EN 1991-2 as tables on the terminal and in the results file.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "norm/dynamic_verdict.hpp"
#include "norm/en1991.hpp"
#include "results/terminal.hpp"

namespace traverse::norm {
namespace {

/// "11.25 mm", "5082 kN m".
std::string size_text(Effect effect, double value) {
  return results::in_engineering_units(effect_rows[static_cast<std::size_t>(effect)].quantity, value, 5);
}

std::vector<std::string> first_words(const std::vector<std::pair<std::string, std::string>>& rows) {
  std::vector<std::string> words;
  for (const auto& [first, second] : rows) words.push_back(first);
  return words;
}

std::string at_text(double x) { return fmt::format(" @ {:.4g}", 1e-3 * std::round(1e3 * x)); }

}  // namespace

void NormCheck::print() const {
  if (effects_.loads.empty()) return;
  if (!models_.empty()) fmt::print("EN 1991-2: {}\n", length_text());
  rows_.empty() ? print_static() : print_rows();
  std::fflush(stdout);
}

void NormCheck::print_static() const {
  fmt::print("largest static effects over all positions of the load, each @ x in m{}\n",
             models_.empty() ? "" : ", without alpha and Phi");
  std::vector<std::vector<std::string>> rows = {{"load"}};
  for (std::size_t e = 0; e < effect_count; ++e)
    if (!effects_.places[e].empty()) rows[0].emplace_back(effect_rows[e].words);
  for (std::size_t load = 0; load < effects_.loads.size(); ++load) {
    rows.push_back({effects_.loads[load].name});
    for (std::size_t e = 0; e < effect_count; ++e) {
      if (effects_.places[e].empty()) continue;
      const auto effect = static_cast<Effect>(e);
      const std::size_t worst = effects_.worst(effect, load, [](const Place&) { return 1.0; });
      rows.back().push_back(size_text(effect, effects_.at(effect, load, worst).size()) +
                            at_text(effects_.places[e][worst].x));
    }
  }
  results::print_columns(std::move(rows));
}

void NormCheck::print_rows() const {
  fmt::print(
      "6.4.6.5: (1 + phi'_dyn + phi''/2) times the worst train against alpha Phi times LM71 \"+\" SW/0, each @ x in "
      "m\n");
  std::vector<std::vector<std::string>> rows = {
      {"effect", "train", "phi'_dyn", "static", "dynamic", "model", "static", "with Phi", "train/model", "governs"}};
  for (const Row& row : rows_) {
    const Effect e = row.effect;
    rows.push_back({std::string(effect_rows[static_cast<std::size_t>(e)].words), effects_.loads[row.train].name,
                    fmt::format("{:.3f} @ {:.4g} km/h", row.dynamic.value, 3.6 * row.dynamic.speed),
                    size_text(e, row.static_train), size_text(e, row.of_train) + at_text(row.train_x),
                    effects_.loads[row.model].name, size_text(e, row.static_model),
                    size_text(e, row.of_model) + at_text(row.model_x), fmt::format("{:.3f}", row.ratio()),
                    effects_.loads[row.ratio() > 1.0 ? row.train : row.model].name});
  }
  results::print_columns(std::move(rows));
}

void NormCheck::record(results::Recorder& recorder) const {
  using Dataset = results::Recorder::Dataset;
  if (effects_.loads.empty()) return;
  std::vector<Dataset> sets;
  std::vector<std::pair<std::string, std::string>> loads;
  for (const LoadModel& load : effects_.loads) loads.emplace_back(load.name, load.clause);
  for (std::size_t e = 0; e < effect_count; ++e) {
    const std::vector<Place>& places = effects_.places[e];
    if (places.empty()) continue;
    const std::string name = "/static/" + std::string(effect_rows[e].name);
    const bool at_section = static_cast<Effect>(e) <= Effect::track_twist;
    Dataset x{at_section ? "/static/x" : name + "_x", {places.size()}, {}, "m"};
    for (const Place& place : places) x.values.push_back(place.x);
    if (e == 0 || !at_section) sets.push_back(std::move(x));
    Dataset values{name, {loads.size(), places.size(), 2}, {}, std::string(effect_rows[e].unit)};
    for (const Extremes& one : effects_.values[e])
      values.values.insert(values.values.end(), {one.least.value, one.greatest.value});
    sets.push_back(std::move(values));
  }
  recorder.names("/static_load", first_words(loads));
  recorder.tables({{"/static/load", loads}});
  std::vector<results::Attribute> rules = {{"n0", n0_}};
  if (!models_.empty()) {
    Dataset length{"/norm/determinant_length", {lengths_.size()}, lengths_, "m"},
        phi{"/norm/phi", length.shape, {}, "1"};
    for (const double L : lengths_) phi.values.push_back(rules_.careful ? phi2(L) : phi3(L));
    sets.push_back(std::move(length));
    sets.push_back(std::move(phi));
    Dataset factor{"/static/alpha", {loads.size()}, {}, "1"};
    for (std::size_t load = 0; load < loads.size(); ++load) factor.values.push_back(alpha(load));
    sets.push_back(std::move(factor));
    rules.push_back({"alpha", rules_.alpha});
    rules.push_back({"words", length_text()});
  }
  std::vector<std::pair<std::string, std::string>> effect, train, model, governs;
  for (const Row& row : rows_) {
    const EffectRow& e = effect_rows[static_cast<std::size_t>(row.effect)];
    effect.emplace_back(e.name, e.unit);
    train.emplace_back(effects_.loads[row.train].name, "");
    model.emplace_back(effects_.loads[row.model].name, effects_.loads[row.model].clause);
    governs.emplace_back(row.ratio() > 1.0 ? "train" : "model",
                         effects_.loads[row.ratio() > 1.0 ? row.train : row.model].name);
  }
  if (!rows_.empty()) {
    recorder.names("/norm_effect", first_words(effect));
    recorder.tables(
        {{"/norm/effect", effect}, {"/norm/train", train}, {"/norm/model", model}, {"/norm/governs", governs}});
    const auto column = [&](const char* name, const char* unit, auto value) {
      Dataset set{std::string("/norm/") + name, {rows_.size()}, {}, unit};
      for (const Row& row : rows_) set.values.push_back(value(row));
      sets.push_back(std::move(set));
    };
    const char* own = "as /norm/effect";
    column("phi_dyn", "1", [](const Row& r) { return r.dynamic.value; });
    column("phi_dyn_speed", "m/s", [](const Row& r) { return r.dynamic.speed; });
    column("phi_dyn_x", "m", [](const Row& r) { return r.dynamic.x; });
    column("train_static", own, [](const Row& r) { return r.static_train; });
    column("train_dynamic", own, [](const Row& r) { return r.of_train; });
    column("train_x", "m", [](const Row& r) { return r.train_x; });
    column("model_static", own, [](const Row& r) { return r.static_model; });
    column("model_with_phi", own, [](const Row& r) { return r.of_model; });
    column("model_x", "m", [](const Row& r) { return r.model_x; });
    column("train_over_model", "1", [](const Row& r) { return r.ratio(); });
  }
  recorder.datasets(sets);
  recorder.attributes(models_.empty() ? "/static" : "/norm", rules);
}

}  // namespace traverse::norm
