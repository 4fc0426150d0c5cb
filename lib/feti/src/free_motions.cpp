#include "feti/free_motions.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "base/dense.hpp"
#include "body_rows.hpp"
#include "free_motion_search.hpp"
#include "unit_motions.hpp"

namespace mortise::feti {

std::string describe(const RigidMotion& motion, double size)
{
  const auto print = [](const Point& p) { return fmt::format("({:.4g}, {:.4g}, {:.4g})", p[0], p[1], p[2]); };
  const auto clean = [](Point p) { return Point((p.array().abs() < 1e-4 * p.cwiseAbs().maxCoeff()).select(0.0, p)); };
  const double rotation_part = motion.rotation.norm() * size;
  if (rotation_part < 2e-2 * motion.translation.norm() || rotation_part == 0)
    return "moves along " + print(clean(motion.translation.normalized()));
  if (rotation_part < 0.5 * motion.translation.norm())
    return "moves along " + print(clean(motion.translation.normalized())) + ", turning as it goes";
  const Point axis = motion.centre + motion.rotation.cross(motion.translation) / motion.rotation.squaredNorm();
  return "rotates about the axis through " + print(clean(axis)) + " along " + print(clean(motion.rotation.normalized()));
}

std::vector<BodyFrame> body_frames(const partition::Decomposition& decomposition, const Communicator& comm)
{
  const auto count = decomposition.catalogue.bodies.size();
  std::vector<double> sums(count * 5, 0.0);  // nodes, x, y, z, |x|^2 about the body's mean in a second pass
  for (const auto& subdomain : decomposition.subdomains)
    for (const auto& p : subdomain.mesh.points) {
      double* sum = &sums[static_cast<std::size_t>(subdomain.body) * 5];
      sum[0] += 1;
      for (int c = 0; c < 3; ++c) sum[1 + c] += p[c];
    }
  comm.sum_in_place(sums);
  std::vector<BodyFrame> frames(count);
  std::vector<double> squares(count * 9, 0.0);  // sums of (x - centre)(x - centre)'
  for (std::size_t b = 0; b < count; ++b)
    frames[b].centre = Point(sums[b * 5 + 1], sums[b * 5 + 2], sums[b * 5 + 3]) / std::max(sums[b * 5], 1.0);
  for (const auto& subdomain : decomposition.subdomains)
    for (const auto& p : subdomain.mesh.points) {
      const auto b = static_cast<std::size_t>(subdomain.body);
      const Point x = p - frames[b].centre;
      Eigen::Map<Eigen::Matrix3d>(&squares[b * 9]) += x * x.transpose();
    }
  comm.sum_in_place(squares);
  const bool solid = decomposition.catalogue.dimension == 3;
  for (std::size_t b = 0; b < count; ++b) {
    const Eigen::Matrix3d moments = Eigen::Map<Eigen::Matrix3d>(&squares[b * 9]) / std::max(sums[b * 5], 1.0);
    frames[b].radius = std::sqrt(moments.trace());
    if (solid) frames[b].axes = dense::space_eigenpairs(moments).vectors;
    for (int k = 0; k < 3; ++k) {
      const Point axis = frames[b].axes.col(k);
      const double square = moments.trace() - axis.dot(moments * axis);
      frames[b].arms[k] = std::sqrt(std::max(square, 1e-6 * moments.trace()));
    }
  }
  return frames;
}

RigidMotion rigid_part(const partition::Decomposition& decomposition, const Clusters& clusters, fem::Kinematics kinematics,
                       const BodyFrame& frame, int body, const Eigen::VectorXd& coordinates, const Communicator& comm)
{
  const int dimension = fem::dimension(kinematics);
  const int modes = clusters.modes();
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(modes, modes + 1);
  for (std::size_t s = 0; s < decomposition.subdomains.size(); ++s) {
    const auto& subdomain = decomposition.subdomains[s];
    if (subdomain.body != body) continue;
    Eigen::MatrixXd a(modes, modes);
    for (int k = 0; k < modes; ++k)
      a.col(k) = clusters.subdomains()[s]->kernel().transpose() *
                 sample(unit_motion(body, frame, k, kinematics), subdomain.mesh.points, dimension);
    normal.leftCols(modes) += a.transpose() * a;
    normal.rightCols(1) += a.transpose() * clusters.own_coordinates(s, coordinates.segment(clusters.first(s), modes));
  }
  comm.sum_in_place({normal.data(), static_cast<std::size_t>(normal.size())});
  const Eigen::VectorXd amplitudes = dense::solve_symmetric(normal.leftCols(modes), normal.rightCols(1));
  return combine(body, frame, amplitudes, kinematics);
}

std::vector<FreeMotion> find_free_motions(const partition::Decomposition& decomposition, const JumpOperator& jump,
                                          const Clusters& clusters, fem::Kinematics kinematics, const SparseMatrix& g,
                                          const constraint::Constraints& constraints, std::span<const Unknown> unknowns,
                                          std::span<const constraint::SlidingSurface> sliding_surfaces,
                                          const std::vector<Eigen::VectorXd>& load, const Communicator& comm)
{
  Bodies bodies = loaded_bodies(decomposition, clusters, kinematics, load, comm);
  const BodyRows rows = body_rows(jump, bodies, g, constraints, unknowns, comm);
  FreeMotionSearch search(bodies, rows, constraints.contacts, sliding_surfaces, comm);
  for (const auto& unit : units(rows, constraints.contacts, constraints.contacts.bonded, bodies, comm)) search.find(unit);
  search.find_joint();
  return std::move(search.found);
}

std::vector<FreeMotion> motions_of_unit(const Bodies& bodies, const BodyRows& rows, const constraint::Contacts& contacts,
                                        const std::vector<int>& unit,
                                        std::span<const constraint::SlidingSurface> sliding_surfaces, const Communicator& comm)
{
  FreeMotionSearch search(bodies, rows, contacts, sliding_surfaces, comm);
  search.find(unit);
  return std::move(search.found);
}

FreeMotion loaded_by(FreeMotion motion, const partition::Decomposition& decomposition, const std::vector<Eigen::VectorXd>& load,
                     const Communicator& comm)
{
  const int dimension = decomposition.catalogue.dimension;
  std::array<double, 2> sums{0, 0};  // work, sum of |nodal forces|
  for (std::size_t s = 0; s < decomposition.subdomains.size(); ++s) {
    const auto& subdomain = decomposition.subdomains[s];
    for (const auto& part : motion.motions) {
      if (part.body != subdomain.body) continue;
      sums[0] += load[s].dot(sample(part, subdomain.mesh.points, dimension));
      sums[1] += load[s].reshaped(dimension, load[s].size() / dimension).colwise().norm().sum();
    }
  }
  comm.sum_in_place(sums);
  motion.force = sums[1];
  motion.work = sums[1] > 0 ? std::abs(sums[0]) / sums[1] : 0;
  return motion;
}

}  // namespace mortise::feti
