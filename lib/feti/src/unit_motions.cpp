#include "unit_motions.hpp"

#include <Eigen/Dense>

#include "base/dense.hpp"

namespace mortise::feti {

RigidMotion unit_motion(int body, const BodyFrame& frame, int index, fem::Kinematics kinematics)
{
  RigidMotion motion{body, frame.centre};
  const int dimension = fem::dimension(kinematics);
  if (kinematics == fem::Kinematics::axisymmetric)
    motion.translation[1] = 1;
  else if (index < dimension)
    motion.translation[index] = 1;
  else
    motion.rotation = frame.axes.col(dimension == 2 ? 2 : index - dimension) / frame.arms[dimension == 2 ? 2 : index - dimension];
  return motion;
}

RigidMotion combine(int body, const BodyFrame& frame, const Eigen::Ref<const Eigen::VectorXd>& amplitudes,
                    fem::Kinematics kinematics)
{
  RigidMotion motion{body, frame.centre};
  for (int k = 0; k < amplitudes.size(); ++k) {
    const auto unit = unit_motion(body, frame, k, kinematics);
    motion.translation += amplitudes[k] * unit.translation;
    motion.rotation += amplitudes[k] * unit.rotation;
  }
  return motion;
}

Eigen::VectorXd amplitudes_of(const RigidMotion& motion, const BodyFrame& frame, fem::Kinematics kinematics)
{
  const Point translation = motion.at(frame.centre);
  if (kinematics == fem::Kinematics::axisymmetric) return Eigen::VectorXd::Constant(1, translation[1]);
  const int dimension = fem::dimension(kinematics);
  Eigen::VectorXd result(fem::rigid_motion_count(kinematics));
  result.head(dimension) = translation.head(dimension);
  for (int k = dimension; k < result.size(); ++k) {
    const int axis = dimension == 2 ? 2 : k - dimension;
    result[k] = frame.arms[axis] * frame.axes.col(axis).dot(motion.rotation);
  }
  return result;
}

Eigen::VectorXd sample(const RigidMotion& motion, const std::vector<Point>& points, int dimension)
{
  Eigen::VectorXd v(static_cast<Eigen::Index>(points.size()) * dimension);
  for (std::size_t n = 0; n < points.size(); ++n)
    v.segment(static_cast<Eigen::Index>(n) * dimension, dimension) = motion.at(points[n]).head(dimension);
  return v;
}

Eigen::MatrixXd complement(const Eigen::MatrixXd& given)
{
  const auto modes = given.rows();
  if (given.cols() == 0) return Eigen::MatrixXd::Identity(modes, modes);
  const Eigen::MatrixXd q = dense::orthogonal_factor(given);
  return q.rightCols(modes - given.cols());
}

void align_with_loads(Eigen::MatrixXd& basis, const Eigen::VectorXd& generalised)
{
  if (basis.cols() == 0) return;
  const Eigen::VectorXd work = basis.transpose() * generalised;
  if (!(work.norm() > 0)) return;
  Eigen::MatrixXd q = dense::orthogonal_factor(work);
  if (q.col(0).dot(work) < 0) q.col(0) *= -1;
  basis *= q;
}

void align_apart(Eigen::MatrixXd& basis, const Eigen::VectorXd& generalised, Eigen::Index rotations, double force)
{
  constexpr double turns = 1e-2, hardly = 1e-2;
  align_with_loads(basis, generalised);
  if (basis.cols() < 2 || std::abs(basis.col(0).dot(generalised)) > hardly * force) return;
  const Eigen::MatrixXd turning = basis.bottomRows(rotations);
  const auto eigen = dense::symmetric_eigenpairs(Eigen::MatrixXd(turning.transpose() * turning));
  Eigen::Index straight = 0;
  while (straight < basis.cols() && eigen.values[straight] < turns * turns) ++straight;
  if (straight == 0 || straight == basis.cols()) return;
  const Eigen::MatrixXd apart = basis * eigen.vectors;
  Eigen::MatrixXd translations = apart.leftCols(straight), rest = apart.rightCols(basis.cols() - straight);
  align_with_loads(translations, generalised);
  align_with_loads(rest, generalised);
  basis << translations, rest;
}

}  // namespace mortise::feti
