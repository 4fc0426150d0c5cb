#include "base/tpetra.hpp"

#include <Teuchos_DefaultMpiComm.hpp>

namespace mortise {

Teuchos::RCP<const Teuchos::Comm<int>> teuchos(const Communicator& comm)
{
  return Teuchos::rcp(new Teuchos::MpiComm<int>(comm.mpi()));
}

}  // namespace mortise
