#include "post/drift.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "base/dense.hpp"

namespace mortise::post {

namespace {

using Normal = Eigen::Matrix<double, 6, 7>;  // normal equations of a rigid motion, right-hand side last

// Of translations and rotations about the centre, these by displacements at the radius.
Normal equations(const Point& x, const Point& u, const feti::BodyFrame& frame, fem::Kinematics kinematics)
{
  const Point r = (x - frame.centre) / frame.radius;
  Eigen::Matrix<double, 3, 6> v = Eigen::Matrix<double, 3, 6>::Zero();
  const bool solid = kinematics == fem::Kinematics::solid, axisymmetric = kinematics == fem::Kinematics::axisymmetric;
  for (int k = 0; k < 3; ++k) {
    if (axisymmetric ? k == 1 : k < fem::dimension(kinematics)) v.col(k) = Point::Unit(k);
    if (solid || (!axisymmetric && k == 2)) v.col(3 + k) = Point(Point::Unit(k)).cross(r);
  }
  Normal result;
  result << v.transpose() * v, v.transpose() * u;
  return result;
}

struct Sums {
  Normal normal = Normal::Zero();
  double square = 0, nodes = 0;  // |u|^2
};
static_assert(sizeof(Sums) == sizeof(double) * 44);

}  // namespace

std::vector<BodyMotion> rigid_motions(const partition::Decomposition& decomposition, fem::Kinematics kinematics,
                                      const std::vector<Eigen::VectorXd>& displacement, const Communicator& comm)
{
  const auto frames = feti::body_frames(decomposition, comm);
  const int dimension = decomposition.catalogue.dimension;
  std::vector<Sums> sums(frames.size());
  for (std::size_t s = 0; s < displacement.size(); ++s) {
    const auto& subdomain = decomposition.subdomains[s];
    const auto b = static_cast<std::size_t>(subdomain.body);
    for (std::size_t n = 0; n < subdomain.mesh.node_count(); ++n) {
      Point u = Point::Zero();
      u.head(dimension) = displacement[s].segment(static_cast<Eigen::Index>(n) * dimension, dimension);
      sums[b].normal += equations(subdomain.mesh.points[n], u, frames[b], kinematics);
      sums[b].square += u.squaredNorm();
      sums[b].nodes += 1;
    }
  }
  comm.sum_in_place({reinterpret_cast<double*>(sums.data()), sums.size() * 44});
  std::vector<BodyMotion> result;
  for (std::size_t b = 0; b < frames.size(); ++b) {
    const auto& normal = sums[b].normal;
    const Eigen::Matrix<double, 6, 1> motion = dense::minimum_norm(normal.leftCols<6>(), normal.col(6));
    const double rest = std::max(sums[b].square - motion.dot(normal.col(6)), 0.0);
    result.push_back({{static_cast<int>(b), frames[b].centre, motion.head<3>(), motion.tail<3>() / frames[b].radius},
                      motion.tail<3>().norm(),
                      std::sqrt(rest / std::max(sums[b].nodes, 1.0))});
  }
  return result;
}

Drift drift(const partition::Decomposition& decomposition, fem::Kinematics kinematics, const std::vector<double>& sizes,
            const std::vector<Eigen::VectorXd>& displacement, double allowance, const Communicator& comm)
{
  const auto frames = feti::body_frames(decomposition, comm);
  const auto motions = rigid_motions(decomposition, kinematics, displacement, comm);
  Drift result;
  feti::RigidMotion fastest;
  for (std::size_t b = 0; b < motions.size(); ++b) {
    const double length = motions[b].rigid.translation.norm() + motions[b].turning;
    const double part = std::max(length - allowance, 0.0) / std::max(sizes[b], 1e-300);
    if (part <= result.sizes) continue;  // not a number goes on
    result.sizes = part;
    fastest = motions[b].rigid;
  }
  if (result.sizes > 0) {
    const auto b = static_cast<std::size_t>(fastest.body);
    result.text =
        fmt::format("body \"{}\" {}", decomposition.catalogue.bodies[b].name, feti::describe(fastest, frames[b].radius));
  }
  return result;
}

}  // namespace mortise::post
