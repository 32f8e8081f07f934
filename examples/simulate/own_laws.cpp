// Laws of one's own: the contact law of a rubber tyre, a track profile, a force over time and a damper by functions. As
// bridge_and_train.cpp, which says how it is built.
#include <cmath>
#include <cstdio>
#include <memory>

#include "traverse/simulate.hpp"

/// A rubber tyre that stiffens: force = k a + k3 a^3 over the penetration a.
class Tyre : public traverse::contact::ElasticLaw {
 public:
  Tyre(double k, double k3) : k_(k), k3_(k3) {}
  double force(double a) const override { return k_ * a + k3_ * a * a * a; }
  double stiffness(double a) const override { return k_ + 3.0 * k3_ * a * a; }
  double energy(double a) const override { return 0.5 * k_ * a * a + 0.25 * k3_ * a * a * a * a; }

 private:
  double k_;   // N/m
  double k3_;  // N/m3
};

void print(const char* name, const traverse::Problem& problem) {
  const traverse::Result result = traverse::simulate(problem);
  std::printf("%-9s deflection %.3f mm, wheel %.2f to %.2f kN, energy residual %.0e\n", name,
              1e3 * result.largest(&traverse::ProbeResult::deflection).value, 1e-3 * result.least_wheel_force,
              1e-3 * result.greatest_wheel_force, result.energy_residual);
}

int main() {
  try {
    const traverse::Session session;
    const traverse::Problem plain = traverse::Problem::from_yaml(R"(
        beam: {spans: 20.0, EI: 8.323e9, mass: 2303.0}
        vehicle:
          sprung_wheel:
            {bodies: [axle, body], joints: [guide], springs: [suspension], drivers: [level], wheels: [wheel],
             axle: {mass: 1000.0, inertia: 100.0, position: [0.0, 0.46]},
             body: {mass: 5750.0, inertia: 100.0, position: [0.0, 1.5]},
             guide: {type: prismatic, bodies: [axle, body], point: [0.0, 1.0], axis: [0.0, 1.0]},
             suspension: {bodies: [axle, body], from: [0.0, 0.46], to: [0.0, 1.5], stiffness: 1.595e6, damping: 2.0e4},
             level: {body: axle, coordinate: phi, value: 0.0},
             wheel: {body: axle, radius: 0.46, law: linear, stiffness: 1.5e6}}
        train: {vehicles: sprung_wheel, speed: 30.0}
        accuracy: 1e-3)");
    print("plain", plain);

    traverse::Problem tyre = plain;
    tyre.change([law = std::make_shared<Tyre>(1.5e6, 4.0e9)](traverse::scene::Scene& scene) {
      for (traverse::train::Vehicle& vehicle : scene.vehicles)
        for (traverse::train::Wheel& wheel : vehicle.wheels) {
          wheel.law.kind = traverse::contact::LawKind::other;
          wheel.law.elastic = law;
        }
    });
    print("tyre", tyre);

    traverse::Problem profile = plain;  // a wave of 3 mm over 5 m before midspan, m over m
    profile
        .table(
            "wave.csv", [](double x) { return -1.5e-3 * (1.0 - std::cos(0.4 * M_PI * (x - 5.0))); }, 5.0, 10.0, 0.05)
        .set("track_profile", "wave.csv")
        .set("track_profile_shape", "spline");
    print("profile", profile);

    traverse::Problem damper = profile;  // blows off: N over m/s
    damper.table(
        "blow_off.csv", [](double v) { return 8e3 * std::tanh(v / 0.1); }, -1.0, 1.0, 0.02);
    damper.remove("vehicle_sprung_wheel_suspension_damping")
        .set("vehicle_sprung_wheel_suspension_damper_table", "blow_off.csv");
    print("damper", damper);

    traverse::Problem force({{"beam_spans", 20.0},
                             {"beam_EI", 8.323e9},
                             {"beam_mass", 2303.0},
                             {"load_forces", 5e4},
                             {"load_speed", 30.0},
                             {"load_table", "beat.csv"},
                             {"accuracy", 1e-3}});
    force.table(
        "beat.csv", [](double t) { return 2e4 * std::sin(60.0 * t) * std::exp(-3.0 * t); }, 0.0, 1.0, 1e-3);
    print("force", force);
  } catch (const traverse::Error& error) {
    std::fprintf(stderr, "own_laws: %s\n", error.what());
    return error.status();
  }
}
