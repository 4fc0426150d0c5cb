#include "base/eigen_kernels.hpp"

#ifdef MORTISE_EIGEN_KERNELS
namespace Eigen::internal {

MORTISE_EIGEN_KERNELS(template)

}  // namespace Eigen::internal
#endif
