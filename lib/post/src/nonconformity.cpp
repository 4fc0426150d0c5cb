#include "post/nonconformity.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <unordered_set>

#include "wording.hpp"

namespace mortise::post {

namespace {

constexpr double least_part = 1e-3;   // of the whole solution, in the energy norm,
constexpr double large_part = 0.05;   // of the solution in the softer bodies,
constexpr double large_share = 0.65;  // and of what stresses show there
constexpr double about_as_soft = 4;   // times the modulus of the softest body of a contact, or less

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
                                         const StressField& stress, std::span<const contact::Pair> pairs,
                                         std::span<const contact::SurfaceState> surfaces, const Communicator& comm)
{
  const auto found =
      contact::nonconformities(pairs, surfaces, displacements_of_sides(bodies, displacement, pairs), bodies.kinematics, comm);
  const auto modulus = least_moduli(bodies, comm);
  auto energy = stress.body_energy, error = stress.body_error;
  comm.sum_in_place(energy);
  comm.sum_in_place(error);
  const auto bodies_of_contact = bodies_of_contacts(pairs, comm);
  std::vector<ContactError> result;
  for (std::size_t c = 0; c < pairs.size(); ++c) {
    auto& contact = result.emplace_back(ContactError{0, 0, 0, found[c].largest, found[c].at});
    double softest = std::numeric_limits<double>::infinity();
    for (const int body : bodies_of_contact[c]) softest = std::min(softest, modulus[static_cast<std::size_t>(body)]);
    if (found[c].squared > 0) contact.squared = std::numbers::pi * softest * found[c].squared;
    for (const int body : bodies_of_contact[c]) {
      const auto b = static_cast<std::size_t>(body);
      if (modulus[b] > about_as_soft * softest) continue;
      contact.squared_beside += error[b];
      contact.squared_norm += 2 * energy[b];
    }
    contact.squared_norm += contact.squared_beside + contact.squared;
  }
  return result;
}

std::vector<Warning> coarse_secondaries(std::span<const ContactError> errors, double squared_norm,
                                        std::span<const contact::Pair> pairs)
{
  std::vector<Warning> result;
  for (std::size_t c = 0; c < errors.size(); ++c) {
    const auto& [squared, beside, norm, largest, at] = errors[c];
    const double limit = std::max(large_part * std::sqrt(norm), large_share * std::sqrt(beside));
    if (!(squared > std::max(limit * limit, least_part * least_part * squared_norm))) continue;
    const double part = std::sqrt(squared / norm);
    const auto& options = pairs[c].options;
    Warning w{"coarse_secondary",
              fmt::format(
                  "between its points the sides of contact {} miss each other by up to {:.3g} at {}: some {:.2g} % in the energy "
                  "norm of the softer body, and forces, and what lies loose there, may be off by far more",
                  options.name, largest, spell(at), 100 * part),
              options.exchanged
                  ? fmt::format("make the faces of {} smaller", options.secondary)
                  : "let the side with the smaller faces or the softer body be the secondary one, or make the secondary side's "
                    "faces smaller"};
    w.at = at;
    w.contact = options.name;
    w.boundary = options.secondary;
    w.value = part;
    w.limit = limit / std::sqrt(norm);
    result.push_back(std::move(w));
  }
  return worst(std::move(result), "contacts");
}

}  // namespace mortise::post
