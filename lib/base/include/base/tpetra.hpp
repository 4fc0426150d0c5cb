// Distributed vectors and operators: Tpetra, with its four template parameters fixed once.
// Costly to compile: only the modules that hold distributed vectors (qp, feti, friction) include it.
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

/// The Teuchos face of a communicator, for constructors of Tpetra maps.
Teuchos::RCP<const Teuchos::Comm<int>> teuchos(const Communicator& comm);

/// The entries of `x` on this rank, read only / writable.
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
