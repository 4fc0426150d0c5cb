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

Eigen::MatrixXd complement(const Eigen::MatrixXd& given)
{
  const auto modes = given.rows();
  if (given.cols() == 0) return Eigen::MatrixXd::Identity(modes, modes);
  const Eigen::MatrixXd q = dense::orthogonal_factor(given);
  return q.rightCols(modes - given.cols());
}

}  // namespace mortise::feti
