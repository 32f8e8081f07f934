// A program with a contact law of its own, over the installed library: all wheels of a scene get rubber tyres.
//
//   cmake --install build --prefix PREFIX
//   cmake -S examples/contact_law -B build-contact-law -DCMAKE_PREFIX_PATH=PREFIX && cmake --build build-contact-law
//   build-contact-law/contact_law -options_file options/scenes/wheel_over_a_bump.yml
#include <slepceps.h>

#include <cstdio>
#include <exception>
#include <memory>

#include "traverse/app/run.hpp"
#include "traverse/base/error.hpp"
#include "traverse/contact/law.hpp"
#include "traverse/options/input.hpp"
#include "traverse/scene/scene.hpp"

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

int main(int argc, char** argv) {
  try {
    traverse::options::Input input = traverse::options::read_input(argc, argv);
    traverse::options::Arguments petsc(input.petsc_words);
    if (SlepcInitialize(petsc.argc(), petsc.argv(), nullptr, nullptr) != 0) return 1;
    traverse::options::put_into_petsc(input);
    traverse::app::Scene scene = traverse::app::read_scene();
    const auto tyre = std::make_shared<Tyre>(1.5e6, 4.0e9);
    for (traverse::app::Vehicle& vehicle : scene.vehicles)
      for (traverse::app::Wheel& wheel : vehicle.wheels) {
        wheel.law.kind = traverse::contact::LawKind::other;
        wheel.law.elastic = tyre;
      }
    const int status = traverse::app::run(PETSC_COMM_WORLD, scene);
    return SlepcFinalize() == 0 ? status : 1;
  } catch (const traverse::Error& error) {
    std::fprintf(stderr, "contact_law: %s\n", error.what());
    return error.status();
  }
}
