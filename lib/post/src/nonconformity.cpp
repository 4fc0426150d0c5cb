#include "post/nonconformity.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <unordered_set>

#include "wording.hpp"

namespace mortise::post {

namespace {

// Of the solution, and of the mesh's whole error, in the energy norm.
constexpr double large_part = 0.02, large_share = 0.5;

// Of each body the least Young's modulus. Collective.
std::vector<double> least_moduli(const ElasticBodies& bodies, const Communicator& comm)
{
  std::vector<double> result(bodies.decomposition.catalogue.bodies.size(), std::numeric_limits<double>::infinity());
  for (std::size_t s = 0; s < bodies.constitution.size(); ++s) {
    auto& least = result[static_cast<std::size_t>(bodies.decomposition.subdomains[s].body)];
    const auto& materials = bodies.constitution[s].materials;
    for (std::size_t m = 0; m < materials.count(); ++m) least = std::min(least, materials[m].modulus());
  }
  for (double& modulus : result) modulus = -comm.max(-modulus);
  return result;
}

// Of each contact the least Young's modulus of its bodies. Collective.
std::vector<double> softer_bodies(std::span<const contact::Pair> pairs, const std::vector<double>& of_body,
                                  const Communicator& comm)
{
  std::vector<double> result;
  for (const auto& pair : pairs) {
    double least = std::numeric_limits<double>::infinity();
    const auto take = [&](const mesh::Surface& side) {
      for (const int b : side.body) least = std::min(least, of_body[static_cast<std::size_t>(b)]);
    };
    take(pair.secondary);
    if (pair.primary) take(*pair.primary);
    result.push_back(-comm.max(-least));
  }
  return result;
}

std::vector<contact::NodalDisplacement> displacements_of_sides(const ElasticBodies& bodies,
                                                               const std::vector<Eigen::VectorXd>& displacement,
                                                               std::span<const contact::Pair> pairs)
{
  std::unordered_set<Global> wanted;
  for (const auto& pair : pairs) {
    wanted.insert(pair.secondary.node_id.begin(), pair.secondary.node_id.end());
    if (pair.primary) wanted.insert(pair.primary->node_id.begin(), pair.primary->node_id.end());
  }
  const int dimension = bodies.decomposition.catalogue.dimension;
  std::vector<contact::NodalDisplacement> result;
  for (std::size_t s = 0; s < bodies.decomposition.subdomains.size(); ++s) {
    const auto& ids = bodies.decomposition.subdomains[s].mesh.node_id;
    for (std::size_t n = 0; n < ids.size(); ++n) {
      if (!wanted.contains(ids[n])) continue;
      contact::NodalDisplacement node{ids[n], {}};
      for (int c = 0; c < dimension; ++c)
        node.u[static_cast<std::size_t>(c)] = displacement[s][static_cast<Eigen::Index>(n) * dimension + c];
      result.push_back(node);
    }
  }
  return result;
}

}  // namespace

std::vector<ContactError> contact_errors(const ElasticBodies& bodies, const std::vector<Eigen::VectorXd>& displacement,
                                         std::span<const contact::Pair> pairs, std::span<const contact::SurfaceState> surfaces,
                                         const Communicator& comm)
{
  const auto found =
      contact::nonconformities(pairs, surfaces, displacements_of_sides(bodies, displacement, pairs), bodies.kinematics, comm);
  const auto modulus = softer_bodies(pairs, least_moduli(bodies, comm), comm);
  std::vector<ContactError> result;
  for (std::size_t c = 0; c < pairs.size(); ++c) {
    const double squared = found[c].squared > 0 ? std::numbers::pi * modulus[c] * found[c].squared : 0;
    result.push_back({squared, found[c].deepest, found[c].at});
  }
  return result;
}

std::vector<Warning> coarse_secondaries(std::span<const ContactError> errors, const MeshError& error,
                                        std::span<const contact::Pair> pairs)
{
  std::vector<Warning> result;
  for (std::size_t c = 0; c < error.of_contact.size(); ++c) {
    const double part = error.of_contact[c], limit = std::max(large_part, large_share * error.relative);
    if (!(part > limit)) continue;
    const auto& options = pairs[c].options;
    Warning w{"coarse_secondary",
              fmt::format("the sides of contact {} pass through each other between its points by up to {:.3g} at {}: some {:.2g} "
                          "% in the energy norm of the mesh's {:.2g} %, and what lies loose there may be off by far more",
                          options.name, errors[c].deepest, spell(errors[c].at), 100 * part, 100 * error.relative),
              "let the side with the smaller faces or the softer body be the secondary one, or make the secondary side's faces "
              "smaller"};
    w.at = errors[c].at;
    w.contact = options.name;
    w.boundary = options.secondary;
    w.value = part;
    w.limit = limit;
    result.push_back(std::move(w));
  }
  return worst(std::move(result), "contacts");
}

}  // namespace mortise::post
