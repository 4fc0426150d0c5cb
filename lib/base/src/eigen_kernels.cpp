#include "base/eigen_kernels.hpp"

namespace Eigen::internal {

MORTISE_EIGEN_KERNELS(template)

}  // namespace Eigen::internal
