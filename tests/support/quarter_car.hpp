// The quarter car of most papers: a body on a spring and a damper above an axle with one wheel.
#pragma once

#include <fmt/format.h>

#include <string>

namespace traverse::test {

/// The YAML of vehicle `car`; masses in kg, stiffness in N/m, damping in N s/m. `wheel`: options of its wheel in
/// addition to body and radius.
inline std::string quarter_car_with(double body, double axle, double stiffness, double damping,
                                    const std::string& wheel) {
  return fmt::format(R"(
vehicle:
  car:
    bodies:  [body, axle]
    joints:  [guide]
    springs: [suspension]
    wheels:  [wheel]
    drivers: [level]
    body:    {{mass: {}, inertia: 1.0, position: [0.0, 2.0]}}
    axle:    {{mass: {}, inertia: 1.0, position: [0.0, 0.46]}}
    guide:   {{type: prismatic, bodies: [body, axle], point: [0.0, 0.46], axis: [0.0, 1.0]}}
    suspension: {{bodies: [body, axle], from: [0.0, 2.0], to: [0.0, 0.46], stiffness: {}, damping: {}}}
    wheel:   {{body: axle, radius: 0.46, {}}}
    level:   {{body: body, coordinate: phi}}
)",
                     body, axle, stiffness, damping, wheel);
}

}  // namespace traverse::test
