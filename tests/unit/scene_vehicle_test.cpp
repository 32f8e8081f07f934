// read_scene: vehicles, their parts and files, and what is refused of them.
#include <algorithm>
#include <cmath>

#include "scene_helpers.hpp"
#include "support/folders.hpp"
#include "support/temporary_folder.hpp"

namespace traverse::scene {
namespace {

TEST(SceneVehicle, Parts) {
  const Scene s = scene_with({{"gravity", "1.6"}});
  ASSERT_EQ(s.vehicles.size(), 1u);
  const multibody::MechanismModel& m = s.vehicles[0].mechanism;
  ASSERT_EQ(m.bodies.size(), 2u);
  EXPECT_EQ(m.bodies[1].position, Eigen::Vector3d(0.5, 0.46, 0.2));
  EXPECT_EQ(m.bodies[0].velocity.y(), 0.1);
  EXPECT_EQ(m.gravity, 1.6);
  EXPECT_EQ(m.joints[0].type, multibody::JointType::prismatic);
  EXPECT_EQ(m.joints[0].axis, Eigen::Vector2d(0.0, 1.0));
  EXPECT_EQ(m.springs[0].preload, -5e4);
  EXPECT_FALSE(m.springs[0].free_length);
  const Wheel& wheel = s.vehicles[0].wheels.at(0);
  EXPECT_EQ(wheel.body, 1);
  EXPECT_EQ(wheel.law.kind, contact::LawKind::hertz);
  EXPECT_EQ(wheel.law.transition_speed, 0.01);
  EXPECT_EQ(s.train.positions, (std::vector<double>{-0.5})) << "the front wheel stands at x = 0";
}

TEST(SceneVehicle, HertzStiffnessFromMaterials) {
  const std::string yaml = "bodies: b\nwheels: w\nb: {mass: 1, inertia: 1, position: [0, 0.46]}\n";
  const test::TemporaryFolder folder;
  const std::string file = folder.write("v.yml", yaml + "w: {body: b, radius: 0.46, young: 2.1e11}\n");
  const Scene s = scene_of(beam_yaml + "vehicle: {v: {file: " + file + "}}\ntrain: {speed: 1}\n");
  EXPECT_NEAR(s.vehicles[0].wheels[0].law.stiffness, contact::hertz_stiffness(0.46, 2.1e11, 0.3, 2.1e11, 0.3), 1.0);
}

TEST(SceneVehicle, FilesLieBelowTheOptions) {
  const test::TemporaryFolder folder;
  folder.write("vehicles/v.yml",
               "bodies: [b]\nwheels: [w]\n\nb: {mass: 100, inertia: 1, position: [0, 0.46]}\n"
               "w: {body: b, radius: 0.46, stiffness: 1e9}\n");
  const std::string scene = folder.write("scenes/s.yml", beam_yaml + "vehicle:\n  v: {file: ../vehicles/v.yml}\n" +
                                                             "train: {vehicles: v*3, speed: 1, spacing: 10}\n");
  options::Entries entries;
  for (const auto& e : options::read_options_file(scene)) entries.set(e);
  EXPECT_EQ(read_scene(Options(entries)).vehicles[0].mechanism.bodies[0].mass, 100.0);
  entries.set({"vehicle_v_b_mass", "4e4", "command line", 0});
  const Scene s = read_scene(Options(entries));
  EXPECT_EQ(s.vehicles[0].mechanism.bodies[0].mass, 4e4);
  EXPECT_EQ(s.train.positions, (std::vector<double>{0.0, -10.0, -20.0}));
  EXPECT_TRUE(std::any_of(s.options.begin(), s.options.end(),
                          [](const auto& o) { return o.first == "vehicle_v_w_radius" && o.second == "0.46"; }));
  entries.set({"vehicle_v_b_inertia", "-1", "command line", 0});
  EXPECT_THROW(read_scene(Options(entries)), InputError);
}

TEST(SceneVehicle, ErrorsInFilesNameTheirLine) {
  const test::TemporaryFolder folder;
  const auto refused_file = [&](const std::string& text) {
    const std::string file = folder.write("v.yml", text);
    return refused(beam_yaml + "vehicle: {v: {file: " + file + "}}\ntrain: {speed: 1}\n");
  };
  EXPECT_PRED2(contains, refused_file("bodies: [b]\nb: {mass: 0, inertia: 1, position: [0, 1]}\n"), "v.yml:2");
  EXPECT_PRED2(contains, refused_file("bodies: [b]\nb: {mas: 1}\n"), "did you mean vehicle_v_b_mass?");
  EXPECT_PRED2(contains, refused_file("vehicle: {v: {bodies: b}}\n"), "without vehicle:");
  EXPECT_PRED2(contains, refused_file("file: w.yml\n"), "another file");
  EXPECT_PRED2(contains, refused_file("length: 10\n"), "needs at least one body");
}

TEST(SceneVehicle, Refusals) {
  EXPECT_PRED2(contains, refused_with("vehicle_car_guide_bodies", "body,axel"), "did you mean axle?");
  EXPECT_PRED2(contains, refused_with("vehicle_car_guide_bodies", "body,body"), "two different bodies");
  EXPECT_PRED2(contains, refused_with("vehicle_car_guide_axis", "0,0"), "a direction");
  EXPECT_PRED2(contains, refused_with("vehicle_car_wheel_body", "ground"), "ground does not move");
  EXPECT_PRED2(contains, refused_with("vehicle_car_wheel_stiffness", "0"), "above 0");
  EXPECT_PRED2(contains, refused_with("vehicle_car_spring_free_length", "1"),
               "give either this or vehicle_car_spring_free_length");
  EXPECT_PRED2(contains, refused_with("vehicle_car_spring_to", "0.5,2"), "the same point");
  EXPECT_PRED2(contains, refused_with("vehicle_car_springs", "spring,axle"), "'axle' is already the name of a body");
  EXPECT_PRED2(contains, refused_with("vehicle_car_bodies", "body,axle,ground"), "'ground' cannot be a part's name");
  EXPECT_PRED2(contains, message_of([] {
                 scene_with({{"vehicle_car_joints", "guide,second"}});
               }),
               "vehicle_car_second_type is missing");
  EXPECT_PRED2(contains, message_of([] {
                 scene_with({{"vehicle_car_wheels", "wheel,other"}});
               }),
               "vehicle_car_other_body is missing");
}

TEST(SceneVehicle, ActuatorsAndDrivers) {
  const test::TemporaryFolder folder;
  const Scene s = scene_with({{"vehicle_car_actuators", "push,turn"},
                              {"vehicle_car_push_body", "body"},
                              {"vehicle_car_push_force", "100,-5"},
                              {"vehicle_car_turn_bodies", "body,axle"},
                              {"vehicle_car_turn_table", folder.write("m.csv", "0 1\n1 3\n")},
                              {"vehicle_car_drivers", "level"},
                              {"vehicle_car_level_body", "axle"},
                              {"vehicle_car_level_coordinate", "phi"}});
  const multibody::MechanismModel& m = s.vehicles[0].mechanism;
  EXPECT_EQ(m.actuators[0].action[0].value(3.0), 100.0);
  EXPECT_EQ(m.actuators[0].reaction_body, multibody::ground);
  EXPECT_EQ(m.actuators[1].reaction_body, 1);
  EXPECT_DOUBLE_EQ(m.actuators[1].action[2].value(0.5), 2.0);
  EXPECT_EQ(m.drivers[0].coordinate, 2);
  EXPECT_EQ(m.drivers[0].value.value(7.0), 0.2) << "left out: as at t = 0";
}

TEST(SceneVehicle, WheelsOutOfRound) {
  const auto shape = [](std::initializer_list<std::pair<std::string, std::string>> values) {
    return scene_with(values).vehicles[0].wheels[0].shape;
  };
  EXPECT_TRUE(shape({}).round());
  EXPECT_DOUBLE_EQ(shape({{"vehicle_car_wheel_flat_length", "0.05"}}).flat_length, 0.05);
  EXPECT_DOUBLE_EQ(shape({{"vehicle_car_wheel_flat_length", "0.05"}}).flat_angle, std::acos(-1.0));
  const track::WheelShape polygon =
      shape({{"vehicle_car_wheel_polygon_order", "18"}, {"vehicle_car_wheel_polygon_amplitude", "2e-5"}});
  EXPECT_EQ(polygon.polygon_order, 18);
  EXPECT_DOUBLE_EQ(polygon.polygon_amplitude, 2e-5);
  EXPECT_PRED2(contains, refused_with("vehicle_car_wheel_flat_length", "0.5"), "the wheel's radius");
  EXPECT_PRED2(contains, refused_with("vehicle_car_wheel_flat_angle", "1"), "needs vehicle_car_wheel_flat_length");
  EXPECT_PRED2(contains, message_of([] {
                 scene_with({{"vehicle_car_wheel_polygon_order", "3"}});
               }),
               "needs vehicle_car_wheel_polygon_amplitude");
  EXPECT_PRED2(contains, message_of([] {
                 scene_with({{"vehicle_car_wheel_polygon_amplitude", "1e-5"}});
               }),
               "needs vehicle_car_wheel_polygon_order");
  EXPECT_PRED2(contains, refused_with("vehicle_car_wheel_polygon_phase", "1"), "needs vehicle_car_wheel_polygon_order");
  EXPECT_PRED2(
      contains, message_of([] {
        scene_with({{"vehicle_car_wheel_polygon_order", "10"}, {"vehicle_car_wheel_polygon_amplitude", "5e-3"}});
      }),
      "concave; allowed: below 0.0046 m");
}

TEST(Coach, VelaroMasses) {
  options::Entries entries;
  for (const auto& e : options::read_options_file(source_folder() + "/options/scenes/three_span_train.yml")) {
    entries.set(e);
  }
  const Scene s = read_scene(Options(entries));
  double mass = 0.0;
  for (const multibody::Body& body : s.vehicles.at(0).mechanism.bodies) mass += body.mass;
  EXPECT_EQ(mass, 47800.0 + 2 * 3500.0 + 4 * 1800.0);
  EXPECT_EQ(s.vehicles[0].wheels.size(), 4u);
  EXPECT_EQ(s.train.vehicles.size(), 8u);
  EXPECT_NEAR(s.vehicles[0].wheels[0].law.stiffness, 2.0 * std::pow(4.57e-8 * std::pow(0.46, -0.149), -1.5), 1e8);
}

}  // namespace
}  // namespace traverse::scene
