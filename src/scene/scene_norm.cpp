// Reads the options of EN 1991-2: load models and the check of 6.4.6.5, and lower bounds of damping.
#include <fmt/format.h>

#include <algorithm>

#include "norm/en1991.hpp"
#include "norm/static_bridge.hpp"
#include "scene_parts.hpp"

namespace traverse::scene {
namespace {

using options::Options;

constexpr double most_sections = 1e5;

options::BridgeMaterial material_of(const std::string& name) {
  const auto* row = std::find_if(std::begin(options::damping_bounds), std::end(options::damping_bounds),
                                 [&](const options::DampingBound& one) { return one.name == name; });
  return static_cast<options::BridgeMaterial>(row - std::begin(options::damping_bounds));
}

/// The option that requires static effects; empty if none does.
std::string option_of_static_effects(const Options& o, const Scene& scene) {
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
      o.refuse("model_additional_damping", "needs model_damping_bound, to which it is added");
    return;
  }
  if (!scene.beam) o.refuse("model_damping_bound", "needs a bridge (beam_spans)");
  for (const char* name : {"model_damping_ratios", "beam_damping_ratios", "beam_rayleigh"})
    if (o.has(name)) o.refuse("model_damping_bound", fmt::format("give either this or {}", name));
  const double span = *std::max_element(scene.beam->spans.begin(), scene.beam->spans.end());
  const double least = norm::least_damping(material_of(o.choice("model_damping_bound")), span);
  const double more = o.flag("model_additional_damping") ? norm::additional_damping(span) : 0.0;
  const double ratio = least + more;
  scene.notes.push_back(fmt::format("damping {:.4g} %: EN 1991-2 table 6.6, {}, span {:g} m{}", 100.0 * ratio,
                                    o.choice("model_damping_bound"), span,
                                    more > 0.0 ? fmt::format(", with {:.3g} % by 6.4.6.4", 100.0 * more) : ""));
  scene.damping.ratios = {ratio, ratio};  // of the first two modes of a bridge by elements
  scene.damping_of_modes = {ratio};
}

void read_norm(const Options& o, Scene& scene) {
  const std::string asked = option_of_static_effects(o, scene);
  if (asked.empty()) {
    for (const char* name : {"norm_alpha", "norm_track", "norm_length", "norm_spacing"})
      if (o.has(name))
        scene.notes.push_back(std::string(name) + " has no effect: norm_load_models names no load model");
    return;
  }
  if (!scene.beam) o.refuse(asked, "static effects need a bridge (beam_spans)");
  if (scene.analysis != Analysis::transient && scene.analysis != Analysis::static_envelope) {
    scene.notes.push_back(
        asked + " has no effect: static effects are computed in transient runs and with scene_analysis envelope");
    return;
  }
  if (several_courses(scene))
    o.refuse(asked, "static effects are computed for one train or load; several are given (trains, loads)");
  if (!only_axle_loads(scene.load)) {
    const std::string why = "static effects are computed for constant concentrated forces";
    if (asked == "scene_analysis") o.refuse(asked, why);
    scene.notes.push_back(asked + ": " + why + "; there is no verdict of EN 1991-2");
    return;
  }
  if (scene.beam->foundation.nonlinear()) {
    const std::string why =
        "influence lines are not valid: the foundation is one-sided, slides, has a gap or a cubic term";
    if (asked == "scene_analysis") o.refuse(asked, why);
    scene.notes.push_back(asked + ": " + why + "; static effects and the verdict of EN 1991-2 are not computed");
    return;
  }
  if (scene.beam->spans.size() > norm::StaticBridge::most_spans)
    o.refuse(asked, fmt::format("static effects of {} spans; allowed: at most {}", scene.beam->spans.size(),
                                norm::StaticBridge::most_spans));
  options::NormRules rules;
  if (o.has("norm_load_models"))
    rules.load_models = o.texts("norm_load_models");
  else if (asked == "limits" || !scene.limits.empty())
    rules.load_models = {"lm71"};
  std::vector<std::string> sorted = rules.load_models;
  std::sort(sorted.begin(), sorted.end());
  if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end())
    o.refuse("norm_load_models", "allowed: each load model once");
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
        "beam_self_weight: peaks include the bridge's own weight, so there is no verdict of EN 1991-2 6.4.6.5");
  else if (scene.beam->strained() && scene.analysis == Analysis::transient)
    scene.notes.emplace_back(
        "peaks include the effects of temperature and settlements, so there is no verdict of EN 1991-2 6.4.6.5");
  if (scene.beam->track)
    scene.notes.emplace_back("static effects: loads act directly on the bridge, without distribution by the track");
}

}  // namespace traverse::scene
