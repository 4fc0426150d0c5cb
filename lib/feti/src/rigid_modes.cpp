#include "feti/rigid_modes.hpp"

#include "row_scaling.hpp"
#include "unit_motions.hpp"

namespace mortise::feti {

RigidModes rigid_modes(const partition::Decomposition& decomposition, const Clusters& clusters, fem::Kinematics kinematics,
                       const Communicator& comm)
{
  RigidModes bodies{kinematics, fem::rigid_motion_count(kinematics), body_frames(decomposition, comm), {}};
  const int dimension = fem::dimension(kinematics);
  struct Entry {
    int row, column;
    double value;
  };
  std::vector<Entry> entries;
  for (std::size_t s = 0; s < decomposition.subdomains.size(); ++s) {
    const auto& subdomain = decomposition.subdomains[s];
    for (int k = 0; k < bodies.modes; ++k) {
      const auto v =
          sample(unit_motion(subdomain.body, bodies.frames[subdomain.body], k, kinematics), subdomain.mesh.points, dimension);
      const Eigen::VectorXd coordinates = clusters.coordinates(s, v);
      for (int i = 0; i < coordinates.size(); ++i)
        entries.push_back({clusters.first(s) + i, subdomain.body * bodies.modes + k, coordinates[i]});
    }
  }
  std::vector<Eigen::Triplet<double>> triplets;
  for (const auto& entry : comm.all_gather(entries)) triplets.emplace_back(entry.row, entry.column, entry.value);
  bodies.aggregate.resize(clusters.kernel_dimension(), static_cast<Eigen::Index>(bodies.frames.size()) * bodies.modes);
  bodies.aggregate.setFromTriplets(triplets.begin(), triplets.end());
  return bodies;
}

SparseMatrix rows_of_bodies(const JumpOperator& jump, const SparseMatrix& g, const RigidModes& bodies)
{
  const Local first = jump.ranges().dirichlet, count = jump.ranges().end - first;
  const Eigen::VectorXd unscale = RowScaling::of(jump).segment(first, count).cwiseInverse();
  const SparseMatrix rows = SparseMatrix(g.middleCols(first, count)).transpose();
  return unscale.asDiagonal() * SparseMatrix(rows.leftCols(bodies.aggregate.rows()) * bodies.aggregate);
}

}  // namespace mortise::feti
