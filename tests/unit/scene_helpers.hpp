// A small scene for the tests of read_scene, and what it becomes with other options.
#pragma once

#include <gtest/gtest.h>

#include <initializer_list>
#include <string>
#include <utility>

#include "options/read_file.hpp"
#include "support/message.hpp"
#include "traverse/scene/scene.hpp"

namespace traverse::scene {

using options::Options;
using test::contains;
using test::message_of;

inline const std::string beam_yaml = "beam: {spans: [25.0, 30.0, 25.0], EI: 8.33e9, mass: 2303.0}\n";
inline const std::string vehicle_yaml =
    "vehicle:\n"
    "  car:\n"
    "    bodies: [body, axle]\n"
    "    joints: [guide]\n"
    "    springs: [spring]\n"
    "    wheels: [wheel]\n"
    "    body: {mass: 5750, inertia: 10, position: [0.5, 2.0], velocity: [0, 0.1, 0]}\n"
    "    axle: {mass: 1000, inertia: 1, position: [0.5, 0.46], angle: 0.2}\n"
    "    guide: {type: prismatic, bodies: [body, axle], point: [0.5, 0.46], axis: [0, 2]}\n"
    "    spring: {bodies: [body, axle], from: [0.5, 2], to: [0.5, 0.46], stiffness: 1.6e6, damping: 100, preload: "
    "-5e4}\n"
    "    wheel: {body: axle, radius: 0.46, stiffness: 3.6e10}\n";
inline const std::string train_yaml = "train: {vehicles: car, speed: 20}\n";

inline Scene scene_of(const std::string& yaml) { return read_scene(Options::from_yaml(yaml)); }
inline std::string refused(const std::string& yaml) {
  return message_of([&] { scene_of(yaml); });
}
/// The example with further options given on the command line.
inline Scene scene_with(std::initializer_list<std::pair<std::string, std::string>> values) {
  options::Entries entries;
  for (const auto& e : options::parse_yaml(beam_yaml + vehicle_yaml + train_yaml, "scene.yml")) entries.set(e);
  for (const auto& [name, value] : values) entries.set({name, value, "command line", 0});
  return read_scene(Options(entries));
}
inline std::string refused_with(const std::string& name, const std::string& value) {
  std::string message = message_of([&] { scene_with({{name, value}}); });
  EXPECT_PRED2(contains, message, name);
  return message;
}

}  // namespace traverse::scene
