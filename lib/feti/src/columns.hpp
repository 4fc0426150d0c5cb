// Right-hand sides and solutions as our solver of Amesos2 sees them: columns that stay where they are. Amesos2's own adapters, of
// Tpetra's and Kokkos' arrays, want columns at equal distances, and those of subdomains that share a factor are vectors of their
// own: to bring them together and back took some 10 % of a sweep of 4,000 unknowns. One rank.
#pragma once

#include <Amesos2_MultiVecAdapter_decl.hpp>
#include <span>

#include "base/tpetra.hpp"

namespace mortise::feti {

struct Columns {
  std::span<double* const> data;
};

}  // namespace mortise::feti

/// What Amesos2::SolverCore asks of an adapter, and the columns for the concrete solver.
template <>
struct Amesos2::MultiVecAdapter<mortise::feti::Columns> {
  using scalar_t = mortise::Scalar;
  using local_ordinal_t = mortise::Local;
  using global_ordinal_t = mortise::Global;
  using node_t = mortise::Node;

  explicit MultiVecAdapter(const Teuchos::RCP<mortise::feti::Columns>& columns) : columns(columns->data) {}

  std::span<double* const> columns;
};
