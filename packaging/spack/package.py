# A recipe for Spack 1.0 and later. In a repository of recipes (`spack repo create`) it stands as packages/traverse/package.py;
# in an environment `spack develop --path CHECKOUT traverse@=1.0.0`, `spack add traverse` and `spack install` build it.
from spack.package import *
from spack_repo.builtin.build_systems.cmake import CMakePackage


class Traverse(CMakePackage):
    """Predicts how trains, lorries and mechanisms cross flexible beams: deflections, accelerations and moments of bridges,
    forces of wheels and joints, resonance over speeds, checks of EN 1991-2."""

    license("BSD-2-Clause")

    version("1.0.0")

    depends_on("c", type="build")
    depends_on("cxx", type="build")
    depends_on("cmake@3.25:", type="build")
    depends_on("pkgconfig", type="build")
    depends_on("mpi")
    depends_on("petsc@3.18:3.25 ~complex +double +mpi")
    depends_on("slepc@3.18:3.25")
    depends_on("hdf5@1.10: +mpi")
    depends_on("eigen@3.4:3.4")
    depends_on("yaml-cpp")
    depends_on("boost@1.74: +random +math", type="build")
    depends_on("fmt@9:")

    conflicts("%gcc@:11", msg="Traverse is written in C++20 as g++ 12 and later know it")

    def cmake_args(self):
        return [
            self.define("TRAVERSE_NATIVE", False),  # Spack names the processor itself
            self.define("TRAVERSE_TESTS", self.run_tests),
        ]
