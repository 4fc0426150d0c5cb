#include "gauge.hpp"

#include <array>
#include <cmath>
#include <utility>

#include "unit_motions.hpp"

namespace mortise::feti {

namespace {

// The motion with its rotation about the centre of its nodes' stiffness, if it is a rotation rather than a translation.
// Collective.
RigidMotion about_centre_of_stiffness(RigidMotion motion, const partition::Decomposition& decomposition,
                                      const std::vector<std::vector<double>>& nodal_stiffness, const Communicator& comm)
{
  constexpr double turns = 0.5;               // of the velocity of the centre: less is a translation, as in describe()
  std::array<double, 5> sums{0, 0, 0, 0, 0};  // of stiffness times x, of stiffness, of stiffness times |x - centre|^2
  for (std::size_t s = 0; s < decomposition.subdomains.size(); ++s) {
    const auto& mesh = decomposition.subdomains[s].mesh;
    if (decomposition.subdomains[s].body != motion.body) continue;
    for (std::size_t n = 0; n < mesh.points.size(); ++n) {
      for (int c = 0; c < 3; ++c) sums[static_cast<std::size_t>(c)] += nodal_stiffness[s][n] * mesh.points[n][c];
      sums[3] += nodal_stiffness[s][n];
      sums[4] += nodal_stiffness[s][n] * (mesh.points[n] - motion.centre).squaredNorm();
    }
  }
  comm.sum_in_place(sums);
  const double spin = motion.rotation.norm();
  if (!(sums[3] > 0) || spin == 0) return motion;
  const Point centre = Point(sums[0], sums[1], sums[2]) / sums[3], velocity = motion.at(centre);
  if (spin * std::sqrt(sums[4] / sums[3]) < turns * velocity.norm()) return motion;
  const Point axis = motion.rotation / spin;
  motion.centre = centre;
  motion.translation = axis.dot(velocity) * axis;
  return motion;
}

}  // namespace

SubdomainRow gauge(const FreeMotion& motion, bool alone, const partition::Decomposition& decomposition,
                   const std::vector<std::vector<double>>& nodal_stiffness, const Communicator& comm)
{
  const int dimension = decomposition.catalogue.dimension;
  auto parts = motion.motions;
  if (alone)
    for (auto& part : parts) part = about_centre_of_stiffness(part, decomposition, nodal_stiffness, comm);
  SubdomainRow row;
  double square = 0;  // in D^-1
  for (std::size_t s = 0; s < decomposition.subdomains.size(); ++s) {
    const auto& subdomain = decomposition.subdomains[s];
    row.coefficients.emplace_back();
    for (const auto& part : parts) {
      if (part.body != subdomain.body) continue;
      Eigen::VectorXd v = sample(part, subdomain.mesh.points, dimension);
      for (Eigen::Index i = 0; i < v.size(); ++i) {
        const double stiffness = nodal_stiffness[s][static_cast<std::size_t>(i / dimension)];
        square += stiffness * v[i] * v[i];
        v[i] *= stiffness;
      }
      row.coefficients.back() = std::move(v);
    }
  }
  row.scale = std::sqrt(comm.sum(square));
  for (auto& coefficients : row.coefficients) coefficients /= row.scale;
  return row;
}

}  // namespace mortise::feti
