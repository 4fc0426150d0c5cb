#include "base/eigen_kernels.hpp"

#ifdef MORTISE_EIGEN_KERNELS
namespace Eigen::internal {

MORTISE_EIGEN_KERNELS(template)

}  // namespace Eigen::internal

namespace Eigen {

MORTISE_EIGEN_FACTORS(template)

}  // namespace Eigen
#endif
