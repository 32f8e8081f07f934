// The tables of outputs: what a row says of a dataset is what it fills, and the datasets of a scene are those of
// doc/results_file.md.
#include "run/outputs.hpp"

#include <gtest/gtest.h>
#include <hdf5.h>

#include <array>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "recorder_helpers.hpp"
#include "support/folders.hpp"
#include "support/scene_run.hpp"

namespace traverse::run {
namespace {

struct Top {
  double angle = 0.0;
  std::array<double, 2> tip{};
};
constexpr Row<Top> top_rows[] = {
    {"angle", "rad", of<&Top::angle>},
    {"tip", "m, m", of<&Top::tip>},
    {"twice", "rad", [](const Top& top) { return 2.0 * top.angle; }},
};

TEST(Outputs, ARowDescribesWhatItFills) {
  Outputs outputs;
  outputs.add("/top/", top_rows, [](const Observed&) { return Top{1.0, {2.0, 3.0}}; });
  outputs.add_each("/tops/", top_rows, 2, [](const Observed&, std::size_t i) {
    const double x = 10.0 * static_cast<double>(i + 1);
    return Top{x, {x + 1.0, x + 2.0}};
  });
  outputs.add_numbers("/numbers", "1", 3, [](const Observed&, std::size_t i) { return static_cast<double>(i); });
  outputs.add_constant("/x", {4.0}, "m");

  const results::Layout& layout = outputs.layout();
  using Shape = std::vector<std::size_t>;
  const std::vector<std::pair<std::string, Shape>> expected = {
      {"/top/angle", {}},    {"/top/tip", {2}},    {"/top/twice", {}}, {"/tops/angle", {2}},
      {"/tops/tip", {2, 2}}, {"/tops/twice", {2}}, {"/numbers", {3}}};
  ASSERT_EQ(layout.fields.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(layout.fields[i].name, expected[i].first);
    EXPECT_EQ(layout.fields[i].row, expected[i].second) << layout.fields[i].name;
  }
  EXPECT_EQ(layout.fields[1].unit, "m, m");
  EXPECT_EQ(layout.constants.front().name, "/x");

  std::vector<double> values = {99.0};  // of an earlier sample
  outputs.fill({}, values);
  EXPECT_EQ(values, (std::vector{1.0, 2.0, 3.0, 2.0, 10.0, 20.0, 11.0, 12.0, 21.0, 22.0, 20.0, 40.0, 0.0, 1.0, 2.0}));
  EXPECT_EQ(values.size(), layout.width());
}

/// Name and unit of every dataset of numbers that has a row a sample, of a file with a single sample.
std::map<std::string, std::string> units_of(const std::string& path) {
  std::map<std::string, std::string> units;
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  const auto visit = [](hid_t group, const char* name, const H5L_info_t* link, void* data) -> herr_t {
    if (link->type == H5L_TYPE_SOFT) return 0;  // to the time
    const hid_t object = H5Oopen(group, name, H5P_DEFAULT);
    if (H5Iget_type(object) == H5I_DATASET) (*static_cast<std::map<std::string, std::string>*>(data))[name];
    return H5Oclose(object);
  };
  H5Lvisit(file, H5_INDEX_NAME, H5_ITER_NATIVE, visit, &units);
  H5Fclose(file);
  const results::testing::Reader reader(path);
  for (auto& [name, unit] : units) unit = reader.text("/" + name, "unit");
  return units;
}

using Units = std::map<std::string, std::string>;

void expect_part(const Units& all, const std::string& group, const Units& expected) {
  Units part;
  for (const auto& [name, unit] : all)
    if (name.rfind(group, 0) == 0) part[name.substr(group.size())] = unit;
  EXPECT_EQ(part, expected) << group;
}

// doc/results_file.md names every quantity.
void expect_documented(const Units& all) {
  std::ifstream file(source_folder() + "/doc/results_file.md");
  std::stringstream text;
  text << file.rdbuf();
  for (const auto& [name, unit] : all) {
    const std::string quantity = name.substr(name.rfind('/') + 1);
    EXPECT_NE(text.str().find(quantity), std::string::npos) << name;
  }
}

const Units body = {{"position", "m, m, rad"}, {"velocity", "m/s, m/s, rad/s"}, {"acceleration", "m/s2, m/s2, rad/s2"}};
const Units wheel = {{"normal_force", "N"}, {"friction_force", "N"}, {"penetration", "m"}};
const Units response = {{"deflection", "m"}, {"velocity", "m/s"},         {"acceleration", "m/s2"},
                        {"moment", "N m"},   {"axial_displacement", "m"}, {"axial_force", "N"}};

TEST(Outputs, OfAHalfCarOnABridgeWithAFoundation) {
  test::Results run = test::run_scene("three_span_half_car", {{"scene_analysis", "static"},
                                                              {"train_vehicles", "half_car"},
                                                              {"train_positions", "12.0"},
                                                              {"foundation_vertical_x", "5.0,10.0"},
                                                              {"foundation_vertical_k", "1e7"},
                                                              {"foundation_rotational_x", "80.0"},
                                                              {"foundation_rotational_k", "1e9"},
                                                              {"foundation_vertical_bed_k", "1e5"}});
  const Units units = units_of(run.file());
  expect_documented(units);
  Units probes = response;
  probes.insert({{"shear", "N"}, {"x", "m"}});
  expect_part(units, "probes/", probes);
  expect_part(units, "supports/", {{"x", "m"}, {"reaction", "N, N, N m"}});
  expect_part(units, "rail/", {});
  expect_part(units, "couplers/", {});
  expect_part(units, "foundation/",
              {{"vertical/x", "m"},
               {"vertical/force", "N"},
               {"rotational/x", "m"},
               {"rotational/moment", "N m"},
               {"vertical_bed/force", "N"}});
  expect_part(units, "balance/",
              {{"load", "N, N"},
               {"support", "N, N"},
               {"foundation", "N, N"},
               {"inertia", "N, N"},
               {"drag", "N, N"},
               {"residual", "N, N"}});
  expect_part(
      units, "energy/",
      {{"kinetic", "J"}, {"strain", "J"}, {"potential", "J"}, {"dissipated", "J"}, {"work", "J"}, {"residual", "J"}});
  for (const char* name : {"car", "front_axle", "rear_axle"})
    expect_part(units, "vehicles/0/" + std::string(name) + "/", body);
  for (const char* name : {"front_wheel", "rear_wheel"})
    expect_part(units, "vehicles/0/" + std::string(name) + "/", wheel);
  expect_part(units, "vehicles/0/front_guide/", {{"reaction", "N, N, N m"}});
  expect_part(units, "vehicles/0/rear_suspension/", {{"force", "N"}});
  expect_part(units, "vehicles/1/", {});

  const results::testing::Reader reader(run.file());
  using Shape = std::vector<hsize_t>;
  EXPECT_EQ(reader.shape("/probes/moment"), (Shape{1, 3}));
  EXPECT_EQ(reader.shape("/supports/reaction"), (Shape{1, 4, 3}));
  EXPECT_EQ(reader.shape("/foundation/vertical/force"), (Shape{1, 2}));
  EXPECT_EQ(reader.shape("/foundation/vertical_bed/force"), (Shape{1, 3}));
  EXPECT_EQ(reader.shape("/balance/load"), (Shape{1, 2}));
  EXPECT_EQ(reader.shape("/vehicles/0/front_wheel/normal_force"), (Shape{1}));
  EXPECT_EQ(reader.shape("/vehicles/0/car/position"), (Shape{1, 3}));
  EXPECT_EQ(run("/vehicles/0/car/position")[0], 12.0);
  // At rest the wheels carry the weight, and what is on the bridge is what they press with.
  const double wheels = run("/vehicles/0/front_wheel/normal_force")[0] + run("/vehicles/0/rear_wheel/normal_force")[0];
  const double weight = 9.81 * (17735.0 + 1500.0 + 1000.0);
  EXPECT_NEAR(wheels, weight, 1e-6 * weight);
  EXPECT_NEAR(run("/balance/load")[1], -weight, 1e-6 * weight);
}

TEST(Outputs, OfARailAndOfCouplers) {
  const test::Values at_rest = {{"scene_analysis", "static"}};
  const Units bridge = units_of(test::run_scene("r8_ballasted_bridge", at_rest).file());
  Units of_rail = response;
  of_rail["x"] = "m";  // a link to the probes
  expect_part(bridge, "rail/", of_rail);
  expect_documented(bridge);
  const Units train = units_of(test::run_scene("articulated_train", at_rest).file());
  expect_documented(train);
  expect_part(train, "couplers/",
              {{"pivot/gap", "1"},
               {"pivot/fx", "N"},
               {"pivot/fy", "N"},
               {"pivot/moment", "N m"},
               {"secondary/gap", "1"},
               {"secondary/force", "N"}});
}

TEST(Outputs, OfTorsionSpringsAndOfContactsBetweenBodies) {
  test::Results run = test::run_yaml(
      "vehicle:\n"
      "  toy:\n"
      "    bodies: [ball, bar]\n"
      "    joints: [hinge]\n"
      "    torsion_springs: [coil]\n"
      "    contacts: [floor]\n"
      "    ball: {mass: 1, inertia: 1, position: [0, 0.5]}\n"
      "    bar: {mass: 1, inertia: 1, position: [5, 0]}\n"
      "    hinge: {type: revolute, bodies: [ground, bar], point: [4, 0]}\n"
      "    coil: {bodies: [ground, bar], stiffness: 100}\n"
      "    floor: {type: arc_line, bodies: [ball, ground], radii: 0.5, centres: [0, 0], line: [-10, 0, 10, 0],"
      " stiffness: 1.0e6}\n"
      "train: {vehicles: toy, drive: free}\n"
      "scene: {start: given}\n"
      "ts_max_time: 0.01\n"
      "output: {interval: 0.01}\n");
  const Units units = units_of(run.file());
  expect_documented(units);
  expect_part(units, "vehicles/0/coil/", {{"moment", "N m"}});
  expect_part(units, "vehicles/0/floor/", wheel);
  expect_part(units, "probes/", {});
  expect_part(units, "balance/", {});
  EXPECT_EQ(run("/vehicles/0/floor/normal_force").size(), 2U);
}

}  // namespace
}  // namespace traverse::run
