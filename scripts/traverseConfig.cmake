# find_package(traverse): what its library is linked to, then the library.
include(CMakeFindDependencyMacro)
find_dependency(Eigen3 3.4 NO_MODULE)
find_dependency(MPI COMPONENTS CXX)
find_dependency(PkgConfig)
foreach(module PETSc SLEPc hdf5-openmpi yaml-cpp fmt)
  pkg_check_modules(${module} REQUIRED QUIET IMPORTED_TARGET ${module})
endforeach()
include(${CMAKE_CURRENT_LIST_DIR}/traverseTargets.cmake)
