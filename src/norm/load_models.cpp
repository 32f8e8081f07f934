// Load Model 71 (EN 1991-2, 6.3.2), Load Models SW/0 and SW/2 (6.3.3), and trains as a row of axle forces.
#include "norm/load_models.hpp"

namespace traverse::norm {

LoadModel load_model(std::string_view name) {
  if (name == "lm71") {
    constexpr double axle = 250e3, distance = 1.6, load = 80e3, margin = 0.8;  // N, m, N/m, m
    LoadModel model{"LM71", "EN 1991-2 6.3.2", {}, {}, load, -margin, 3.0 * distance + margin};
    for (int i = 0; i < 4; ++i) model.forces.push_back({axle, i * distance});
    return model;
  }
  const bool heavy = name == "sw2";
  const double load = heavy ? 150e3 : 133e3, length = heavy ? 25.0 : 15.0, gap = heavy ? 7.0 : 5.3;
  return {heavy ? "SW/2" : "SW/0",
          "EN 1991-2 6.3.3",
          {},
          {{load, 0.0, length}, {load, length + gap, 2.0 * length + gap}},
          0.0,
          0.0,
          0.0};
}

bool classified(std::string_view name) { return name != "sw2"; }

LoadModel train_of(std::string name, const std::vector<double>& forces, const std::vector<double>& x) {
  LoadModel model;
  model.name = std::move(name);
  for (std::size_t i = 0; i < forces.size(); ++i) model.forces.push_back({forces[i], x[i]});
  return model;
}

}  // namespace traverse::norm
