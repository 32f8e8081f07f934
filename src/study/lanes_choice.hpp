// How the runs of a sweep of trains go side by side by the lanes' kernel: modes, mesh, method and step, chosen from the
// accuracy.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "accuracy/accuracy.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::app {

struct LanesChoice {
  Scene scene;  // complete, with its modes, mesh, step and linear vehicles
  std::array<Promise, quantities> promises{};
};

/// Where the scene leaves them open: tries modes, steps and methods on the beginning of the passages at slow and at
/// fast speeds, each until halving it changes the peaks by a part of the accuracy, checks the choice on whole passages,
/// and against a run by elements with the mechanisms themselves. `notes` says what was chosen, or why the runs go one
/// by one. The same on every rank.
std::optional<LanesChoice> lanes_that_do(const Scene& given, std::vector<std::string>& notes);

}  // namespace traverse::app
