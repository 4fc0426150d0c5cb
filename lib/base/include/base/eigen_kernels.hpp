// Products and factors of dense matrices, compiled once: Eigen would compile its kernels, some thousand instructions each, into
// every file that multiplies two matrices or solves with one. Part of the precompiled headers; nothing else includes it, and
// without it all is the same but for the compiler's time. The kernels are internal to Eigen 3.4: for other versions there is
// nothing here.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/LU>

#if EIGEN_VERSION_AT_LEAST(3, 4, 0) && !EIGEN_VERSION_AT_LEAST(3, 4, 90)
namespace Eigen::internal {

using DoubleKernel = gebp_traits<double, double>;

#define MORTISE_EIGEN_KERNELS(instance)                                                                                          \
  instance struct gebp_kernel<double, double, Index, blas_data_mapper<double, Index, ColMajor, 0, 1>, DoubleKernel::mr,          \
                              DoubleKernel::nr, false, false>;                                                                   \
  instance struct gemm_pack_lhs<double, Index, const_blas_data_mapper<double, Index, ColMajor>, DoubleKernel::mr,                \
                                DoubleKernel::LhsProgress, DoubleKernel::LhsPacket4Packing, ColMajor>;                           \
  instance struct gemm_pack_lhs<double, Index, const_blas_data_mapper<double, Index, RowMajor>, DoubleKernel::mr,                \
                                DoubleKernel::LhsProgress, DoubleKernel::LhsPacket4Packing, RowMajor>;                           \
  instance struct gemm_pack_rhs<double, Index, const_blas_data_mapper<double, Index, ColMajor>, DoubleKernel::nr, ColMajor>;     \
  instance struct gemm_pack_rhs<double, Index, const_blas_data_mapper<double, Index, RowMajor>, DoubleKernel::nr, RowMajor>;     \
  instance struct general_matrix_vector_product<Index, double, const_blas_data_mapper<double, Index, ColMajor>, ColMajor, false, \
                                                double, const_blas_data_mapper<double, Index, RowMajor>, false>;                 \
  instance struct general_matrix_vector_product<Index, double, const_blas_data_mapper<double, Index, RowMajor>, RowMajor, false, \
                                                double, const_blas_data_mapper<double, Index, ColMajor>, false>;                 \
  instance struct triangular_solve_matrix<double, Index, OnTheLeft, Lower, false, ColMajor, ColMajor, 1>;                        \
  instance struct triangular_solve_matrix<double, Index, OnTheLeft, Upper, false, RowMajor, ColMajor, 1>;                        \
  instance struct triangular_solve_matrix<double, Index, OnTheLeft, Upper, false, ColMajor, ColMajor, 1>;                        \
  instance struct triangular_solve_matrix<double, Index, OnTheLeft, UnitLower, false, ColMajor, ColMajor, 1>;                    \
  instance struct triangular_solve_matrix<double, Index, OnTheRight, Upper, false, RowMajor, ColMajor, 1>;                       \
  instance struct triangular_solve_vector<double, double, Index, OnTheLeft, Lower, false, ColMajor>;                             \
  instance struct triangular_solve_vector<double, double, Index, OnTheLeft, Upper, false, RowMajor>;                             \
  instance struct triangular_solve_vector<double, double, Index, OnTheLeft, Upper, false, ColMajor>;                             \
  instance struct triangular_solve_vector<double, double, Index, OnTheLeft, UnitLower, false, ColMajor>;

MORTISE_EIGEN_KERNELS(extern template)

}  // namespace Eigen::internal

namespace Eigen {

#define MORTISE_EIGEN_FACTORS(instance)                                                              \
  instance LLT<MatrixXd>& LLT<MatrixXd>::compute<MatrixXd>(const EigenBase<MatrixXd>&);              \
  instance LLT<MatrixXd>::LLT(const EigenBase<MatrixXd>&);                                           \
  instance void PartialPivLU<MatrixXd>::compute();                                                   \
  instance PartialPivLU<MatrixXd>::PartialPivLU(const EigenBase<MatrixXd>&);

MORTISE_EIGEN_FACTORS(extern template)

}  // namespace Eigen
#endif
