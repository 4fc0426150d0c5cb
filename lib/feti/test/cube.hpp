// A cube cut into eight, as tests of the dual problem take it.
#pragma once

#include "qp/face_newton.hpp"
#include "testing/blocks.hpp"

namespace mortise::feti {

inline qp::Solution by_face_newton(const DualProblem& problem, const qp::Programme& programme, double tolerance)
{
  const auto preconditioner = problem.system().make_preconditioner();
  return qp::FaceNewton(programme, preconditioner.get())
      .solve(*problem.right_hand_side(), programme.set.radii(), nullptr, {}, {tolerance, {}}, {});
}

struct Cube : Blocks {
  // Young's modulus jumps from subdomain to subdomain by `jump`. Held at z = 0, unless it floats; pulled at z = 1.
  explicit Cube(double jump, bool prescribed, const MPI_Comm mpi = MPI_COMM_WORLD, int subdomains_per_cluster = 1)
      : Blocks(
            {{"cube", {{0, 0, 0}, {1, 1, 1}, {4, 4, 4}, "hex8"}}}, {{"cube", {2, 2, 2}}},
            [jump](int id) { return (id + id / 2 + id / 4) % 2 == 0 ? 1.0 : jump; }, mpi, subdomains_per_cluster)
  {
    add_traction("cube.zmax", Point(0.1, 0, 1));
    if (prescribed) dirichlet_rows({{"cube.zmin", {0, 0, 0.25}}});
  }
};

}  // namespace mortise::feti
