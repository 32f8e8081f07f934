// What a scene cannot tell is left out of the model, and said so: the answer is the same as with it.
// (Spans at rest: rest windows in mpi and unit tests; modes instead of elements: SweepAccuracy.)
#include <gtest/gtest.h>

#include <cmath>

#include "support/curve.hpp"
#include "support/folders.hpp"

namespace traverse::test {
namespace {

const std::string coaches =
    "options_file: " + source_folder() +
    "/options/scenes/three_span_train.yml\n"
    "train_vehicles: coach*2\nscene_tail: 0.2\nbeam_elements_per_span: 8\nts_dt: 2.0e-3\noutput_interval: 0.02\n";

struct Said {
  Results results;
  std::string text;
};
Said run_and_listen(const std::string& scene, const Values& options) {
  testing::internal::CaptureStdout();
  Results results = run_yaml(scene, options);
  return {results, testing::internal::GetCapturedStdout()};
}

// Nothing acts along the beam but what inclined normal forces have along it, a millionth of them.
TEST(LeftOut, AxialUnknowns) {
  const Values stiff = {{"beam_EA", "2e11"}, {"verbose", "true"}};
  Said without = run_and_listen(coaches, stiff),
       with = run_and_listen(coaches, stiff + Values{{"model_axial", "true"}});
  EXPECT_NE(without.text.find("axial unknowns: none, nothing acts along the beam"), std::string::npos) << without.text;
  EXPECT_NE(without.text.find("2 unknowns a node"), std::string::npos);
  EXPECT_NE(with.text.find("3 unknowns a node"), std::string::npos);
  for (const char* name : {"/probes/deflection", "/probes/acceleration", "/probes/moment"}) {
    const double difference = relative_difference(without.results(name), with.results(name));
    RecordProperty(name + 1, text(difference));
    EXPECT_LT(difference, 1e-6) << name;
  }
}

// Without damping there is no damping matrix: the same, to the last bit, as coefficients of 0.
TEST(LeftOut, Damping) {
  const std::string undamped =
      "beam: {spans: 20.0, EI: 1.0e10, mass: 6000.0, elements_per_span: 8}\nsupport: {types: [pinned, roller]}\n"
      "load: {forces: 1.0e5, positions: 0.0, speed: 40.0}\nts_dt: 1.0e-3\n";
  Results without = run_yaml(undamped), with = run_yaml(undamped, {{"beam_rayleigh", "0,0"}});
  for (const char* name : {"/probes/deflection", "/probes/acceleration", "/probes/moment"})
    EXPECT_EQ(without(name), with(name)) << name;
}

// Vehicles that never come onto the bridge, because the run ends before, move but do not change it.
TEST(LeftOut, VehiclesThatDoNotCome) {
  const Values until = {{"ts_max_time", "0.25"}};
  Results two = run_yaml(coaches, until), one = run_yaml(coaches, until + Values{{"train_vehicles", "coach"}});
  EXPECT_LT(relative_difference(two("/probes/deflection"), one("/probes/deflection")), 1e-12);
}

}  // namespace
}  // namespace traverse::test
