// Hybrid TFETI: the subdomains of a cluster are joined by averages over the faces between them, B0 u = 0, so that a cluster has
// one kernel, its rigid motions, and the coarse problem as many unknowns as clusters have. Their gluing rows stay in B: they
// contain those of B0, so that F has a kernel on which neither d nor e depends [Klawonn and Rheinbach, ZAMM 90 (2010); Dostal et
// al., Scalable Algorithms for Contact Problems, 2nd ed., Springer (2023)]. What a cluster answers to forces f is
//
//     K u + B0' mu = f,  B0 u = 0:     u = K^+ (f - B0' mu) + R alpha,
//     F0 mu - G0' alpha = B0 K^+ f,  G0 mu = R'f,     F0 = B0 K^+ B0',  G0 = R'B0',
//
// K, K^+ and R those of its subdomains side by side. F0 is sparse and positive definite, since rows of B0 that depend on others
// are left out. Its Schur complement G0 F0^-1 G0' is dense; its kernel is A with B0 R A = 0, the rigid motions R A of the
// cluster, and is filled by + rho A A': A'alpha = 0 where f does not move the cluster, and so nothing changes.
//
// Clusters of which all subdomains are copies by translation share all of this.
#pragma once

#include <memory>
#include <vector>

#include "fem/stiffness.hpp"
#include "feti/subdomain_operator.hpp"
#include "partition/decomposition.hpp"
#include "partition/node_directory.hpp"

namespace mortise::feti {

/// This rank's subdomains and how they hang together: what floats are clusters, each of one subdomain or more. Heavy: moves, does
/// not copy. One thread at a time.
class Clusters {
 public:
  /// No subdomains.
  Clusters();
  /// `subdomains`: in the order of Decomposition::subdomains, whose clusters these are. nodal_stiffness[s][n]: the weights of
  /// averages. Throws Error(machine) if a cluster cannot be factorized.
  Clusters(const partition::Decomposition& decomposition, const partition::Interface& interface, Subdomains subdomains,
           const std::vector<std::vector<double>>& nodal_stiffness, fem::Kinematics kinematics);
  Clusters(Clusters&&) noexcept;
  Clusters& operator=(Clusters&&) noexcept;
  ~Clusters();

  /// Of this rank, in the order of Decomposition::subdomains, which s counts below.
  const Subdomains& subdomains() const { return subdomains_; }
  int modes() const { return modes_; }                        ///< dimension of the kernel of each cluster
  int kernel_dimension() const { return kernel_dimension_; }  ///< sum of these over the clusters of all ranks
  /// Where the kernel of the s-th subdomain's cluster stands among all: coordinates first(s) .. first(s)+modes()-1.
  int first(std::size_t s) const { return first_[s]; }
  /// The orthonormal kernel of the s-th subdomain's cluster on this subdomain, its size x modes().
  Eigen::MatrixXd kernel(std::size_t s) const;
  /// kernel(s)' v and kernel(s) c, for v over the unknowns of the s-th subdomain and c of size modes().
  Eigen::VectorXd coordinates(std::size_t s, const Eigen::VectorXd& v) const;
  Eigen::VectorXd motion(std::size_t s, const Eigen::VectorXd& c) const;
  /// The same motion in the coordinates of the subdomain's own kernel.
  Eigen::VectorXd own_coordinates(std::size_t s, const Eigen::VectorXd& c) const;

  /// How many clusters of several subdomains of this rank have factors of their own; the others share these.
  std::size_t kinds() const { return groups_.size(); }

  /// v[s] of each subdomain becomes K_c^+ v, K_c^+ symmetric, with K_c K_c^+ f = f for forces f that do not move a cluster.
  /// `rounded`: by the factors as they are rounded, which those of clusters of several subdomains must not be.
  void apply_inverse(std::vector<Eigen::VectorXd>& v, bool rounded = false) const;
  /// B0' mu of each subdomain: the forces inside the clusters under the forces f.
  std::vector<Eigen::VectorXd> inner_forces(const std::vector<Eigen::VectorXd>& f) const;

 private:
  struct Shape;
  struct Group {
    std::unique_ptr<const Shape> shape;
    std::vector<std::size_t> clusters;  // the first subdomain of each
  };
  void add(const partition::Decomposition& decomposition, const partition::Interface& interface,
           const std::vector<std::vector<double>>& nodal_stiffness, fem::Kinematics kinematics, std::size_t start,
           std::size_t end);
  template <class Take>
  void balance(const std::vector<Eigen::VectorXd>& f, const Take& take) const;

  Subdomains subdomains_;
  int modes_ = 0, kernel_dimension_ = 0;
  std::vector<int> first_;
  std::vector<Eigen::MatrixXd> part_;  // A of each subdomain; empty where it is alone
  std::vector<Group> groups_;
};

}  // namespace mortise::feti
