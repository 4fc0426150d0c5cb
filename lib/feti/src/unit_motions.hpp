// The rigid motions of a body by their amplitudes.
#pragma once

#include "feti/free_motions.hpp"

namespace mortise::feti {

/// v of the rigid motions of one body, scaled so that |v| is about 1 on it: 3 translations and 3 rotations about its principal
/// axes, each by the nodes' distance from that axis (the spin of a slender bar has a short arm), or 2 and 1, or 1 along the axis
/// of revolution.
RigidMotion unit_motion(int body, const BodyFrame& frame, int index, fem::Kinematics kinematics);

/// The sum of unit motions times their amplitudes.
RigidMotion combine(int body, const BodyFrame& frame, const Eigen::Ref<const Eigen::VectorXd>& amplitudes,
                    fem::Kinematics kinematics);

/// The amplitudes of a rigid motion, of a body with that frame; the reverse of combine().
Eigen::VectorXd amplitudes_of(const RigidMotion& motion, const BodyFrame& frame, fem::Kinematics kinematics);

/// The velocities of a motion at points, one after the other.
Eigen::VectorXd sample(const RigidMotion& motion, const std::vector<Point>& points, int dimension);

/// An orthonormal basis of what is orthogonal to the orthonormal columns of `given`.
Eigen::MatrixXd complement(const Eigen::MatrixXd& given);

/// Turns an orthonormal basis so that the loads drive its first vector alone, and in its own sense: of many motions together,
/// that is the one to tell.
void align_with_loads(Eigen::MatrixXd& basis, const Eigen::VectorXd& generalised);

/// The same of motions that loads hardly drive, which a later state may: translations, whose loads are known exactly, apart from
/// what turns. `rotations`: how many of the amplitudes are those of rotations, the last ones; `force`: sum of sizes of the loads.
void align_apart(Eigen::MatrixXd& basis, const Eigen::VectorXd& generalised, Eigen::Index rotations, double force);

}  // namespace mortise::feti
