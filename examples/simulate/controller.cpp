// An observer that controls the run: it reads the velocity of a probe and sets a force against it, an active damper. As
// bridge_and_train.cpp, which says how it is built.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "traverse/simulate.hpp"

/// A force -gain times the velocity at midspan, of at most 50 kN.
class Controller : public traverse::Observer {
 public:
  explicit Controller(double gain) : gain_(gain) {}

  void begin(traverse::Instant& now) override {
    last_ = 0.0;
    sample(now);
  }
  bool sample(traverse::Instant& now) override {
    last_ = std::max(last_, now.time() > last_passage ? std::abs(now.read("/probes/deflection")[0]) : 0.0);
    now.set_beam_force(15.0, std::clamp(-gain_ * now.read("/probes/velocity")[0], -5e4, 5e4));
    return true;
  }
  double last_deflection() const { return last_; }  // m, the largest one after last_passage

 private:
  static constexpr double last_passage = 3.5;  // s
  double gain_, last_ = 0.0;
};

int main() {
  try {
    const traverse::Session session;
    const traverse::Problem problem({
        {"beam_spans", 30.0},
        {"beam_EI", 1e10},
        {"beam_mass", 8e3},
        {"beam_damping_ratios", 0.005},
        {"load_forces", {1e5, 1e5, 1e5, 1e5, 1e5}},
        {"load_positions", {0.0, -18.0, -36.0, -54.0, -72.0}},
        {"load_speed", 35.1},       // m/s, at resonance: 1.95 Hz times 18 m
        {"scene_tail", 3.0},        // s, after the last force has left
        {"model_modes", 0},         // forces act on elements
        {"output_interval", 2e-3},  // s, of the controller
    });
    for (const double gain : {0.0, 5e4, 2e5}) {  // N s/m
      Controller controller(gain);
      const traverse::Result result = traverse::simulate(problem, {&controller});
      std::printf("gain %6.0f N s/m: peak %.3f mm, free vibration %.3f mm\n", gain,
                  1e3 * result.largest(&traverse::ProbeResult::deflection).value, 1e3 * controller.last_deflection());
    }
  } catch (const traverse::Error& error) {
    std::fprintf(stderr, "controller: %s\n", error.what());
    return error.status();
  }
}
