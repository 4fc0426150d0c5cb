// Bodies of one layer of cells, and what recovered stresses do not show of them.
#pragma once

#include "post/stress_recovery.hpp"

namespace mortise::post {

/// Those that no node inside of the body is near, by what patches, nodes x 7 blocks, weigh.
std::vector<std::size_t> cells_in_a_layer(const mesh::Mesh& mesh, const fem::Materials& materials,
                                          const Eigen::MatrixXd& patches);

/// Of each subdomain, for each of its cells, the squared error of its faces between held sides (fem/held_faces.hpp), if it is in
/// one layer, and of those that end inside. Of all faces in layers of a body that is e^2 tanh(n^2 / e^2), where e is the sum as
/// if the layer went on without end, and n the norm of the solution in their cells: cells can lack no more than they have. No
/// vector where there is no face. `patches`, `averages`: of each subdomain, recovered; `loose` as in recover_stress().
/// Collective.
std::vector<Eigen::VectorXd> errors_between_held_sides(const ElasticBodies& bodies,
                                                       const std::vector<Eigen::VectorXd>& displacement,
                                                       std::span<const Eigen::MatrixXd> patches,
                                                       std::span<const Eigen::MatrixXd> averages, std::span<const Global> loose,
                                                       const Communicator& comm);

}  // namespace mortise::post
