// What the dual problem needs of a floating subdomain, whatever discretizes it: finite elements here, boundary elements in
// dense_subdomain.hpp.
#pragma once

#include <Eigen/Core>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "base/cholesky.hpp"
#include "base/types.hpp"
#include "feti/direct_solver.hpp"

namespace mortise::feti {

/// What preconditioners need of a subdomain: a symmetric operator on some of its unknowns.
class InterfaceStiffness {
 public:
  virtual ~InterfaceStiffness() = default;
  /// The forces of displacements u, both of those unknowns: unknowns x columns.
  virtual Eigen::MatrixXd apply(const Eigen::MatrixXd& u) const = 0;
};

/// The symmetric positive semidefinite operator K of one subdomain with `size()` unknowns.
class SubdomainOperator {
 public:
  virtual ~SubdomainOperator() = default;
  /// Unknowns: dimension * nodes.
  virtual int size() const = 0;
  /// R, size() x dim Ker K, orthonormal columns.
  virtual const Eigen::MatrixXd& kernel() const = 0;
  /// columns[c], of size(), becomes K^+ columns[c] with a generalised inverse: K K^+ b = b for every b in Im K.
  virtual void apply_inverse(std::span<double* const> columns) const = 0;
  /// The same by what the factor has been rounded to, if it has: K~^+, symmetric to rounding, with an error in the energy norm of
  /// rounding().
  virtual void apply_rounded_inverse(std::span<double* const> columns) const { apply_inverse(columns); }
  virtual double rounding() const { return 0; }
  /// What double precision changes of a rough v = K^+ K v, relative to it; 0 if nobody asked for refined solutions. Much where a
  /// subdomain is soft in some motions beside the stiffness of its cells: 2e-4 for a strip a thousand times as long as thick.
  virtual double inaccuracy() const { return 0; }
  /// K u.
  virtual Eigen::VectorXd apply(const Eigen::VectorXd& u) const = 0;
  /// The lower triangle of K, and that of a positive definite matrix whose inverse K^+ is.
  virtual SparseMatrix lower() const = 0;
  virtual SparseMatrix regularised() const = 0;
  /// Of K; of a rotated copy, that of its original.
  virtual Eigen::VectorXd diagonal() const = 0;
  /// On the unknowns b (ascending, whole nodes): K_bb, or, if `condensed`, its Schur complement K_bb - K_bi K_ii^-1 K_ib, with
  /// K_ii factorized by the DirectSolver of that name. Refers to this. Of a rotated copy, that of its original. Throws as
  /// DirectSolver.
  virtual std::unique_ptr<const InterfaceStiffness> interface_stiffness(const std::vector<int>& unknowns, bool condensed,
                                                                        const std::string& factorization) const = 0;
  /// Bytes of its own factor in double precision; 0 for a rotated copy, which uses that of its original.
  virtual std::size_t factor_bytes() const = 0;

  /// What a rotated copy is a copy of: K = T K_original T', T a rotation of every node. Itself for others.
  virtual const SubdomainOperator& original() const { return *this; }
  /// v becomes T' v, and T v; it stays where there is no T.
  virtual void rotate_back(Eigen::VectorXd&) const {}
  virtual void rotate(Eigen::VectorXd&) const {}
};

/// Above this inaccuracy() solutions are refined; and above the other one where a residual is asked for: products take longer so,
/// and are needed by hundreds then, while sheets 1,000 times as wide as thick, of 1e-5 and more, are wrong without.
constexpr double inaccurate = 3e-8, inaccurate_for_residuals = 5e-6;

/// The operators of this rank's subdomains, in the order of Decomposition::subdomains. Copies by translation have the same one.
using Subdomains = std::vector<std::shared_ptr<const SubdomainOperator>>;

/// Whether rounding bends one of them: solutions are refined.
bool any_slender(const Subdomains& subdomains);

/// The places of this rank's subdomains, by what they are copies of.
std::map<const SubdomainOperator*, std::vector<std::size_t>> by_original(const Subdomains& subdomains);

/// v_s = K_s^+ v_s for every subdomain, or K~_s^+ if that is `rounded`. Vectors of the same original go through its factor
/// together.
void apply_inverse(const Subdomains& subdomains, std::vector<Eigen::VectorXd>& v, bool rounded = false);

/// Finite elements. K^+ = (K + r N)^-1 with N = E R_I (R_I'R_I)^-1 R_I'E', where R_I is the kernel at a few fixing nodes and r
/// the mean of diag K: multiplied by R' it shows that R_I'u_I = 0 when f is in Im K, so that K u = f exactly for every r > 0.
///
/// Where the factor is rounded to single precision, apply_inverse() refines its solutions with K + r N, in double precision.
/// Where double precision is inaccurate, both inverses refine them with residuals in extended precision.
class ElasticSubdomain : public SubdomainOperator {
 public:
  /// `lower`: lower triangle of K, unknown dimension * node + component. `kernel`: orthonormal rigid motions. Throws as
  /// DirectSolver, which says what `most_rounded` is. `refined_from`: the inaccuracy above which solutions are refined.
  ElasticSubdomain(SparseMatrix lower, Eigen::MatrixXd kernel, std::span<const Point> points, int dimension,
                   const std::string& factorization, std::optional<double> most_rounded = {}, double refined_from = inaccurate);
  /// Bytes that the factor of such a subdomain will take, from the analysis of its pattern alone.
  static std::size_t foreseen_factor_bytes(const SparseMatrix& lower, const Eigen::MatrixXd& kernel,
                                           std::span<const Point> points, int dimension);

  int size() const override { return static_cast<int>(stiffness_.cols()); }
  const Eigen::MatrixXd& kernel() const override { return kernel_; }
  void apply_inverse(std::span<double* const> columns) const override;
  void apply_rounded_inverse(std::span<double* const> columns) const override;
  double rounding() const override { return solver_->rounding(); }
  double inaccuracy() const override { return inaccuracy_; }
  Eigen::VectorXd apply(const Eigen::VectorXd& u) const override;
  SparseMatrix lower() const override { return stiffness_; }
  SparseMatrix regularised() const override { return stiffness_ + fixing_; }
  Eigen::VectorXd diagonal() const override;
  std::unique_ptr<const InterfaceStiffness> interface_stiffness(const std::vector<int>& unknowns, bool condensed,
                                                                const std::string& factorization) const override;
  /// The lower triangle of K.
  const SparseMatrix& stiffness() const { return stiffness_; }
  std::size_t factor_bytes() const override { return solver_->factor_bytes(); }

 private:
  double measured_inaccuracy() const;
  Eigen::VectorXd residual(const double* b, const double* x) const;
  void refine(std::span<double* const> columns) const;

  SparseMatrix stiffness_;
  SparseMatrix fixing_;  // r N, lower triangle
  Eigen::MatrixXd kernel_;
  int dimension_;
  int column_block_;  // of the stiffness: the dimension, or 1 where columns of a node differ
  std::unique_ptr<DirectSolver> solver_;
  double inaccuracy_ = 0;
};

/// A copy of another subdomain, rotated in space: its vectors are rotated back, go through the original's factor and
/// are rotated again.
class RotatedSubdomain : public SubdomainOperator {
 public:
  /// `rotation`: points of the copy = rotation * points of the original + a translation.
  RotatedSubdomain(std::shared_ptr<const SubdomainOperator> original, const Eigen::Matrix3d& rotation, int dimension);

  int size() const override { return original_->size(); }
  const Eigen::MatrixXd& kernel() const override { return kernel_; }
  void apply_inverse(std::span<double* const> columns) const override;
  double rounding() const override { return original_->rounding(); }
  double inaccuracy() const override { return original_->inaccuracy(); }
  Eigen::VectorXd apply(const Eigen::VectorXd& u) const override;
  SparseMatrix lower() const override { return rotated(original_->lower()); }
  SparseMatrix regularised() const override { return rotated(original_->regularised()); }
  Eigen::VectorXd diagonal() const override { return original_->diagonal(); }
  std::unique_ptr<const InterfaceStiffness> interface_stiffness(const std::vector<int>& unknowns, bool condensed,
                                                                const std::string& factorization) const override
  {
    return original_->interface_stiffness(unknowns, condensed, factorization);
  }
  std::size_t factor_bytes() const override { return 0; }
  const SubdomainOperator& original() const override { return *original_; }
  void rotate_back(Eigen::VectorXd& v) const override;
  void rotate(Eigen::VectorXd& v) const override;

 private:
  SparseMatrix rotated(const SparseMatrix& lower) const;

  std::shared_ptr<const SubdomainOperator> original_;
  Eigen::MatrixXd rotation_;  // dimension x dimension
  Eigen::MatrixXd kernel_;
};

/// A few local nodes, spread over the subdomain, whose rows of the kernel have full column rank with a good condition.
std::vector<Local> fixing_nodes(std::span<const Point> points, const Eigen::MatrixXd& kernel, int dimension);

/// r N of ElasticSubdomain, its lower triangle, from the diagonal of K.
SparseMatrix fixing_term(const Eigen::VectorXd& diagonal, const Eigen::MatrixXd& kernel, std::span<const Point> points,
                         int dimension);

/// trace(K_nn) / dimension of each node, from the diagonal of K: the stiffness by which the copies of a node share what acts on
/// it.
std::vector<double> nodal_stiffness(const Eigen::VectorXd& diagonal, int dimension);

}  // namespace mortise::feti
