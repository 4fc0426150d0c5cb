#include "layers.hpp"

#include <algorithm>
#include <cmath>

namespace mortise::post {

namespace {

// Whether a node that patches know lies inside the body (fem/patches.hpp) shares a cell with one of the nodes of this cell. If
// none does, as in one layer of cells, recovered stresses are those of cells along the layer.
bool near_inside(const Eigen::MatrixXd& patches, const mesh::Mesh& mesh, const fem::Materials& materials, std::size_t cell)
{
  constexpr double last_resort = 1e-3;  // patches at the border weigh much less
  const auto weight = 7 * static_cast<Eigen::Index>(materials.index(cell)) + 6;
  return std::ranges::any_of(mesh.cells[cell], [&](Local n) { return patches(n, weight) > last_resort; });
}

// Marks those that have a node which is loose, at any of its copies. Collective.
void mark_loose(const ElasticBodies& bodies, std::span<const Global> loose, std::vector<std::vector<fem::HeldFace>>& faces,
                const Communicator& comm)
{
  const auto& subdomains = bodies.decomposition.subdomains;
  std::vector<Eigen::MatrixXd> is_loose;
  for (const auto& subdomain : subdomains) {
    const auto& ids = subdomain.mesh.node_id;
    auto& own = is_loose.emplace_back(Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(ids.size()), 1));
    for (const Global node : loose)
      if (const auto at = std::ranges::lower_bound(ids, node); at != ids.end() && *at == node) own(at - ids.begin(), 0) = 1;
  }
  partition::sum_over_copies(bodies.decomposition, bodies.interface, is_loose, comm);
  for (std::size_t s = 0; s < faces.size(); ++s)
    for (auto& face : faces[s]) {
      const auto& cells = subdomains[s].mesh.cells;
      const auto c = static_cast<std::size_t>(face.cell);
      for (const int k : mesh::faces(cells.type[c])[static_cast<std::size_t>(face.face)].nodes)
        face.slides = face.slides || is_loose[s](cells[c][static_cast<std::size_t>(k)], 0) > 0;
    }
}

// Of each subdomain; none of any if no rank has one. Collective.
std::vector<std::vector<fem::HeldFace>> held_faces_in_layers(const ElasticBodies& bodies,
                                                             std::span<const Eigen::MatrixXd> patches,
                                                             std::span<const Global> loose, const Communicator& comm)
{
  if (!bodies.symmetric) return {};
  auto faces = bodies.symmetric->held_faces;
  for (std::size_t s = 0; s < faces.size(); ++s)
    std::erase_if(faces[s], [&](const fem::HeldFace& face) {
      return !face.ends_inside && near_inside(patches[s], bodies.decomposition.subdomains[s].mesh,
                                              bodies.constitution[s].materials, static_cast<std::size_t>(face.cell));
    });
  const bool has_faces = std::ranges::any_of(faces, [](const auto& own) { return !own.empty(); });
  if (comm.any(has_faces) && comm.any(!loose.empty())) mark_loose(bodies, loose, faces, comm);
  return faces;
}

}  // namespace

std::vector<std::size_t> cells_in_a_layer(const mesh::Mesh& mesh, const fem::Materials& materials, const Eigen::MatrixXd& patches)
{
  std::vector<std::size_t> layer;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c)
    if (!near_inside(patches, mesh, materials, c)) layer.push_back(c);
  return layer;
}

std::vector<Eigen::VectorXd> errors_between_held_sides(const ElasticBodies& bodies,
                                                       const std::vector<Eigen::VectorXd>& displacement,
                                                       std::span<const Eigen::MatrixXd> patches,
                                                       std::span<const Eigen::MatrixXd> averages, std::span<const Global> loose,
                                                       const Communicator& comm)
{
  const auto& subdomains = bodies.decomposition.subdomains;
  const auto held_faces = held_faces_in_layers(bodies, patches, loose, comm);
  const auto body_count = bodies.decomposition.catalogue.bodies.size();
  std::vector<double> sums(2 * body_count, 0.0);  // of each body, in layers: squared errors, squared norm
  std::vector<fem::HeldFaceErrors> found(held_faces.size());
  for (std::size_t s = 0; s < held_faces.size(); ++s) {
    if (held_faces[s].empty()) continue;
    const auto& own = bodies.constitution[s];
    found[s] = fem::errors_of_held_faces(subdomains[s].mesh, own.materials, bodies.kinematics, displacement[s], averages[s],
                                         held_faces[s], own.formulation, own.temperature_change);
    const auto body = static_cast<std::size_t>(subdomains[s].body);
    for (std::size_t f = 0; f < held_faces[s].size(); ++f)
      if (!held_faces[s][f].ends_inside) sums[body] += found[s].squared[static_cast<Eigen::Index>(f)];
    sums[body_count + body] += found[s].norm;
  }
  comm.sum_in_place(sums);
  std::vector<Eigen::VectorXd> result(subdomains.size());
  for (std::size_t s = 0; s < held_faces.size(); ++s) {
    if (held_faces[s].empty()) continue;
    const auto body = static_cast<std::size_t>(subdomains[s].body);
    const double bounded = sums[body] > 0 ? std::tanh(sums[body_count + body] / sums[body]) : 1;
    result[s] = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(subdomains[s].mesh.cells.size()));
    for (std::size_t f = 0; f < held_faces[s].size(); ++f) {
      const auto& face = held_faces[s][f];
      result[s][face.cell] += (face.ends_inside ? 1 : bounded) * found[s].squared[static_cast<Eigen::Index>(f)];
    }
  }
  return result;
}

}  // namespace mortise::post
