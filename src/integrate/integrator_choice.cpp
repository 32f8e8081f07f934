#include "integrator_choice.hpp"

#include <petscts.h>

#include <algorithm>
#include <array>

#include "traverse/base/error.hpp"
#include "traverse/base/petsc.hpp"
#include "traverse/integrate/second_order.hpp"

namespace traverse::integrate {
namespace {

using base::check;

std::string option(const char* name, const char* otherwise) {
  std::array<char, 128> text{};
  PetscBool given = PETSC_FALSE;
  check(PetscOptionsGetString(nullptr, nullptr, name, text.data(), text.size(), &given));
  return given == PETSC_TRUE ? text.data() : otherwise;
}

bool is_given(const char* name) {
  PetscBool given = PETSC_FALSE;
  check(PetscOptionsHasName(nullptr, nullptr, name, &given));
  return given == PETSC_TRUE;
}

}  // namespace

std::string chosen_type() {
  const std::string adapt = option("-ts_adapt_type", TSADAPTNONE);
  const bool for_arkimex = (adapt != TSADAPTNONE && adapt != ladder_adapt) || is_given("-ts_arkimex_type") ||
                           is_given("-ts_arkimex_fully_implicit");
  const std::string type = option("-ts_type", for_arkimex ? TSARKIMEX : esdirk4_type);
  constexpr std::array allowed = {esdirk4_type, genalpha_type, TSARKIMEX, TSCN, TSBDF, TSTHETA, TSBEULER, TSRK};
  if (std::find(allowed.begin(), allowed.end(), type) == allowed.end())
    throw InputError("ts_type = " + type +
                     ": does not integrate this system rightly; allowed: esdirk4, genalpha, arkimex, cn, bdf, theta, "
                     "beuler (implicit), rk (explicit, small scenes)");
  if (adapt == ladder_adapt && type != esdirk4_type)
    throw InputError("ts_adapt_type = ladder: estimates the errors of esdirk4 alone; ts_type is " + type);
  if (adapt != TSADAPTNONE && adapt != ladder_adapt && (type == esdirk4_type || type == genalpha_type))
    throw InputError("ts_adapt_type = " + adapt + ": does not fit " + type +
                     "; allowed: none, ladder (with esdirk4), or a ts_type of PETSc's own such as arkimex");
  PetscReal tolerance = 1.0;
  check(PetscOptionsGetReal(nullptr, nullptr, "-ts_rtol", &tolerance, nullptr));
  if (adapt == ladder_adapt && !(tolerance > 0.0))
    throw InputError("ts_rtol = " + std::to_string(tolerance) + ": allowed: above 0");
  PetscInt order = 2;
  check(PetscOptionsGetInt(nullptr, nullptr, "-ts_bdf_order", &order, nullptr));
  if (order < 1 || order > 2)
    throw InputError("ts_bdf_order = " + std::to_string(order) +
                     ": orders above 2 are unstable for lightly damped bridges; allowed: 1, 2");
  PetscReal radius = 1.0;
  check(PetscOptionsGetReal(nullptr, nullptr, "-ts_genalpha_radius", &radius, nullptr));
  if (!(radius >= 0.0 && radius <= 1.0))
    throw InputError("ts_genalpha_radius = " + std::to_string(radius) + ": allowed: 0 to 1");
  return type;
}

}  // namespace traverse::integrate
