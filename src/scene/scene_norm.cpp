// EN 1991-2 in a scene: its load models and verdict, and its lower bounds of damping.
#include <fmt/format.h>

#include <algorithm>

#include "norm/en1991.hpp"
#include "norm/static_bridge.hpp"
#include "scene_parts.hpp"

namespace traverse::app {
namespace {

using options::Options;

constexpr double most_sections = 1e5;

options::BridgeMaterial material_of(const std::string& name) {
  const auto* row = std::find_if(std::begin(options::damping_bounds), std::end(options::damping_bounds),
                                 [&](const options::DampingBound& one) { return one.name == name; });
  return static_cast<options::BridgeMaterial>(row - std::begin(options::damping_bounds));
}

/// What asks for static effects; empty: nothing does.
std::string asks_for_static_effects(const Options& o, const Scene& scene) {
  if (o.has("norm_load_models")) return "norm_load_models";
  if (scene.analysis == Analysis::static_envelope) return "scene_analysis";
  const bool limited = std::any_of(scene.limits.begin(), scene.limits.end(), [](const options::VerdictLimit& limit) {
    return options::limit_quantity(limit.quantity)->finder == options::LimitFinder::norm;
  });
  return limited ? "limits" : "";
}

}  // namespace

void read_damping_bound(const Options& o, Scene& scene) {
  if (!o.has("model_damping_bound")) {
    if (o.has("model_additional_damping"))
      o.refuse("model_additional_damping", "needs model_damping_bound, which it is added to");
    return;
  }
  if (!scene.beam) o.refuse("model_damping_bound", "needs a bridge (beam_spans)");
  for (const char* name : {"model_damping_ratios", "beam_damping_ratios", "beam_rayleigh"})
    if (o.has(name)) o.refuse("model_damping_bound", fmt::format("give either this or {}", name));
  const double span = *std::max_element(scene.beam->spans.begin(), scene.beam->spans.end());
  const double least = norm::least_damping(material_of(o.choice("model_damping_bound")), span);
  const double more = o.flag("model_additional_damping") ? norm::additional_damping(span) : 0.0;
  const double ratio = least + more;
  scene.notes.push_back(
      fmt::format("damping {:.4g} %: EN 1991-2 table 6.6, {}, span {:g} m{}; of the first two frequencies, Rayleigh's "
                  "of all others",
                  100.0 * ratio, o.choice("model_damping_bound"), span,
                  more > 0.0 ? fmt::format(", with {:.3g} % by 6.4.6.4", 100.0 * more) : ""));
  scene.damping.ratios = {ratio, ratio};  // one law, which elements and modes have alike
}

void read_norm(const Options& o, Scene& scene) {
  const std::string asked = asks_for_static_effects(o, scene);
  if (asked.empty()) {
    for (const char* name : {"norm_alpha", "norm_track", "norm_length", "norm_spacing"})
      if (o.has(name))
        scene.notes.push_back(std::string(name) + " has no effect: norm_load_models names no load model");
    return;
  }
  if (!scene.beam) o.refuse(asked, "static effects are those of a bridge: there is none (beam_spans)");
  if (scene.analysis != Analysis::transient && scene.analysis != Analysis::static_envelope) {
    scene.notes.push_back(asked +
                          " has no effect: static effects belong to transient runs and to scene_analysis envelope");
    return;
  }
  if (several_courses(scene))
    o.refuse(asked, "static effects are of one train or load wherever it stands; several run here (trains, loads)");
  if (scene.beam->foundation.nonlinear()) {
    const std::string why =
        "influence lines do not hold: the foundation is one-sided, slides, has a gap or a cubic term";
    if (asked == "scene_analysis") o.refuse(asked, why);
    scene.notes.push_back(asked + ": " + why + "; there are no static effects and no verdict of EN 1991-2");
    return;
  }
  if (scene.beam->spans.size() > norm::StaticBridge::most_spans)
    o.refuse(asked, fmt::format("static effects of {} spans; allowed: {}", scene.beam->spans.size(),
                                norm::StaticBridge::most_spans));
  options::NormRules rules;
  if (o.has("norm_load_models"))
    rules.load_models = o.texts("norm_load_models");
  else if (asked == "limits" || !scene.limits.empty())
    rules.load_models = {"lm71"};
  std::vector<std::string> sorted = rules.load_models;
  std::sort(sorted.begin(), sorted.end());
  if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end())
    o.refuse("norm_load_models", "allowed: every load model once");
  rules.alpha = o.number("norm_alpha");
  rules.careful = o.choice("norm_track") == "careful";
  rules.length = o.optional_number("norm_length");
  rules.spacing = o.optional_number("norm_spacing").value_or(0.0);
  if (const double sections = rules.spacing > 0.0 ? scene.beam->length() / rules.spacing : 0.0;
      sections > most_sections)
    o.refuse("norm_spacing", fmt::format("{:.3g} sections; allowed: at most {:g}", sections, most_sections));
  scene.norm = rules;
  if (scene.self_weight && scene.analysis == Analysis::transient)
    scene.notes.emplace_back(
        "beam_self_weight: peaks hold the bridge's own weight, so there is no verdict of EN 1991-2 6.4.6.5");
  else if (scene.beam->strained() && scene.analysis == Analysis::transient)
    scene.notes.emplace_back(
        "peaks hold what temperature and settlements do, so there is no verdict of EN 1991-2 6.4.6.5");
  if (scene.beam->track)
    scene.notes.emplace_back("static effects: loads stand on the bridge itself, the track spreads none");
}

}  // namespace traverse::app
