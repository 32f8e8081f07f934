// EN 1991-2 in a scene: what cannot be meant is refused in one line.
#include <gtest/gtest.h>

#include "support/folders.hpp"
#include "support/program.hpp"

namespace traverse::test {
namespace {

void refused(const std::vector<std::string>& words, const std::vector<std::string>& parts) {
  std::string all;
  for (const std::string& word : words) all += " " + word;
  SCOPED_TRACE(all);
  const Workplace workplace("beam: {spans: 20.0, EI: 2.0e10, mass: 1.5e4}\nload: {forces: 2.0e5, speed: 50.0}\n");
  expect_refusal(workplace, workplace.run(words), parts);
}

TEST(Norm, BadInputIsRefused) {
  refused({"-norm_load_models", "lm72"}, {"norm_load_models", "lm71, sw0, sw2"});
  refused({"-norm_load_models", "lm71,lm71"}, {"norm_load_models", "once"});
  refused({"-norm_load_models", "lm71", "-norm_alpha", "-1"}, {"norm_alpha", "-1"});
  refused({"-norm_load_models", "lm71", "-norm_track", "rough"}, {"norm_track", "standard, careful"});
  refused({"-norm_load_models", "lm71", "-norm_length", "0"}, {"norm_length", "above 0"});
  refused({"-norm_load_model", "lm71"}, {"norm_load_model", "norm_load_models"});
  refused({"-norm_load_models", "lm71", "-beam_spans", "20*201", "-support_types", "roller"},
          {"norm_load_models", "201", "200"});
  refused({"-norm_load_models", "lm71", "-norm_spacing", "1e-6"}, {"norm_spacing", "sections"});
  refused({"-model_damping_bound", "wood"}, {"model_damping_bound", "prestressed"});
  refused({"-model_damping_bound", "steel", "-beam_damping_ratios", "0.01"},
          {"model_damping_bound", "beam_damping_ratios"});
  refused({"-model_additional_damping"}, {"model_additional_damping", "model_damping_bound"});
}

TEST(Norm, WithoutABridgeThereAreNoStaticEffects) {
  const Workplace workplace("options_file: " + source_folder() + "/options/scenes/pendulum.yml\n");
  expect_refusal(workplace, workplace.run({"-norm_load_models", "lm71"}), {"norm_load_models", "beam_spans"});
  expect_refusal(workplace, workplace.run({"-model_damping_bound", "steel"}), {"model_damping_bound", "beam_spans"});
}

}  // namespace
}  // namespace traverse::test
