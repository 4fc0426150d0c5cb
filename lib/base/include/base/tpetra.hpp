// Distributed vectors and operators: Tpetra, with its four template parameters fixed once.
// Costly to compile: only modules that work with distributed vectors (qp, feti and those that use them) include it.
#pragma once

#include <Teuchos_RCP.hpp>
#include <Tpetra_Core.hpp>
#include <Tpetra_Import.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_Operator.hpp>
#include <Tpetra_Vector.hpp>

#include "base/communicator.hpp"
#include "base/types.hpp"

namespace mortise {

using Node = Tpetra::Map<>::node_type;
using Map = Tpetra::Map<Local, Global, Node>;
using Import = Tpetra::Import<Local, Global, Node>;
using MultiVector = Tpetra::MultiVector<Scalar, Local, Global, Node>;
using Vector = Tpetra::Vector<Scalar, Local, Global, Node>;
using Operator = Tpetra::Operator<Scalar, Local, Global, Node>;

/// A communicator as Teuchos has it, for constructors of Tpetra maps. Collective.
Teuchos::RCP<const Teuchos::Comm<int>> teuchos(const Communicator& comm);

/// The entries of `x` on this rank, read only and writable. Refers to x.
inline Eigen::Map<const Eigen::VectorXd> view(const Vector& x)
{
  const auto data = x.getData();
  return {data.getRawPtr(), static_cast<Eigen::Index>(data.size())};
}
inline Eigen::Map<Eigen::VectorXd> view(Vector& x)
{
  const auto data = x.getDataNonConst();
  return {data.getRawPtr(), static_cast<Eigen::Index>(data.size())};
}

}  // namespace mortise
