// Load Model 71 (EN 1991-2, 6.3.2), Load Models SW/0 and SW/2 (6.3.3), and trains as a row of axle forces.
#include "norm/load_models.hpp"

#include <algorithm>
#include <iterator>

#include "traverse/base/error.hpp"
#include "traverse/options/norm_rules.hpp"

namespace traverse::norm {
namespace {

LoadModel lm71() {
  constexpr double axle = 250e3, distance = 1.6, load = 80e3, margin = 0.8;  // N, m, N/m, m
  LoadModel model{"", "EN 1991-2 6.3.2", {}, {}, load, -margin, 3.0 * distance + margin};
  for (int i = 0; i < 4; ++i) model.forces.push_back({axle, i * distance});
  return model;
}

/// Two uniform loads (N/m) of a length with a gap between them, m.
LoadModel two_loads(double load, double length, double gap) {
  return {"", "EN 1991-2 6.3.3", {}, {{load, 0.0, length}, {load, length + gap, 2.0 * length + gap}}, 0.0, 0.0, 0.0};
}

struct Loads {
  std::string_view name;
  LoadModel (*make)();
};

constexpr Loads loads_of[] = {
    {"lm71", lm71},
    {"sw0", [] { return two_loads(133e3, 15.0, 5.3); }},
    {"sw2", [] { return two_loads(150e3, 25.0, 7.0); }},
};

constexpr const Loads* loads_row(std::string_view name) {
  for (const Loads& row : loads_of)
    if (row.name == name) return &row;
  return nullptr;
}

static_assert(std::all_of(std::begin(options::load_models), std::end(options::load_models),
                          [](const options::LoadModelRow& row) { return loads_row(row.name) != nullptr; }),
              "every load model that may be asked for has its line in loads_of");

}  // namespace

LoadModel load_model(std::string_view name) {
  const options::LoadModelRow* row = options::load_model_row(name);
  if (row == nullptr) throw InputError("there is no load model '" + std::string(name) + "'");
  LoadModel model = loads_row(name)->make();
  model.name = row->title;
  return model;
}

LoadModel train_of(std::string name, const std::vector<double>& forces, const std::vector<double>& x) {
  LoadModel model;
  model.name = std::move(name);
  for (std::size_t i = 0; i < forces.size(); ++i) model.forces.push_back({forces[i], x[i]});
  return model;
}

}  // namespace traverse::norm
