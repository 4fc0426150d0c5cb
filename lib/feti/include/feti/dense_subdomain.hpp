// A subdomain whose operator is a dense matrix: boundary elements.
#pragma once

#include "feti/subdomain_operator.hpp"

namespace mortise::feti {

/// K^+ = (K + r N)^-1 as ElasticSubdomain has it, stored as a matrix: K and K^+ share n (n + 1) numbers, and a product reads half
/// of a dense matrix.
class DenseSubdomain : public SubdomainOperator {
 public:
  /// `matrix`: K, symmetric; only its lower triangle is read. `kernel`: orthonormal rigid motions. Throws Error(bad_input) if
  /// K + r N is not positive definite.
  DenseSubdomain(const Eigen::MatrixXd& matrix, Eigen::MatrixXd kernel, std::span<const Point> points, int dimension);
  /// Bytes that such a subdomain keeps.
  static std::size_t foreseen_bytes(std::size_t unknowns) { return sizeof(double) * unknowns * (unknowns + 1); }

  int size() const override { return static_cast<int>(matrices_.rows()); }
  const Eigen::MatrixXd& kernel() const override { return kernel_; }
  void apply_inverse(std::span<double* const> columns) const override;
  Eigen::VectorXd apply(const Eigen::VectorXd& u) const override;
  /// K u for several columns.
  Eigen::MatrixXd apply_to_columns(const Eigen::MatrixXd& u) const;
  SparseMatrix lower() const override;
  SparseMatrix regularised() const override { return lower() + fixing_; }
  Eigen::VectorXd diagonal() const override { return matrices_.leftCols(matrices_.rows()).diagonal(); }
  std::unique_ptr<const InterfaceStiffness> interface_stiffness(const std::vector<int>& unknowns, bool condensed,
                                                                const std::string& factorization) const override;
  std::size_t factor_bytes() const override { return foreseen_bytes(static_cast<std::size_t>(size())); }

 private:
  Eigen::MatrixXd matrices_;  // n x (n + 1): K in the lower triangle of the first n columns, K^+ in the upper one of the last n
  SparseMatrix fixing_;       // r N, lower triangle
  Eigen::MatrixXd kernel_;
};

}  // namespace mortise::feti
