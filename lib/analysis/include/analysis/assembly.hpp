// What load steps have in common: the bodies cut into subdomains, with their factors.
#pragma once

#include <vector>

#include "base/context.hpp"
#include "feti/dual_problem.hpp"
#include "model/model.hpp"
#include "partition/congruence.hpp"

namespace mortise::analysis {

/// Does not change once it is made. Heavy: neither copies nor moves.
class Assembly {
 public:
  /// Stiffness and factors; `copies` as of Model::congruent. Refers to the model. Throws Error(bad_input) that names the body
  /// whose matrix cannot be factorized, and the probable cause. Collective.
  Assembly(const model::Model& model, const std::vector<partition::CopyOf>& copies, const Context& context);
  Assembly(const Assembly&) = delete;
  Assembly& operator=(const Assembly&) = delete;

  const model::Model& model() const { return model_; }
  const model::Deck& deck() const { return model_.deck(); }
  const partition::Decomposition& decomposition() const { return model_.decomposition(); }
  const partition::NodeDirectory& directory() const { return directory_; }
  const partition::Interface& interface() const { return interface_; }
  const feti::SubdomainSystem& system() const { return system_; }
  /// For each subdomain of this rank the first one that it is a copy of.
  const std::vector<partition::CopyOf>& copies() const { return copies_; }
  /// f of each subdomain of this rank: its nodal forces, unknown dimension * node + component. Collective.
  std::vector<Eigen::VectorXd> loads(const model::LoadState& state, const Communicator& comm) const;

 private:
  struct Stiffness {
    std::vector<SparseMatrix> matrices;  // of the subdomains that are no copies; of boundary elements empty, and:
    std::vector<std::shared_ptr<const feti::SubdomainOperator>> dense;
    std::vector<std::vector<double>> of_nodes;  // of all
  };
  Assembly(const model::Model& model, const std::vector<partition::CopyOf>& copies, Stiffness stiffness, const Context& context);
  static Stiffness assemble(const model::Model& model, const std::vector<partition::CopyOf>& copies, const Context& context);

  const model::Model& model_;
  std::vector<partition::CopyOf> copies_;
  partition::NodeDirectory directory_;
  partition::Interface interface_;
  feti::SubdomainSystem system_;
};

}  // namespace mortise::analysis
