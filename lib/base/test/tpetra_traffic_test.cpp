// What Tpetra sends from its own library is counted too.
#include <gtest/gtest.h>

#include "base/tpetra.hpp"
#include "base/traffic.hpp"

namespace mortise {
namespace {

// Every rank owns 10 numbers and wants the first 3 of the next rank's.
TEST(Traffic, OfAnImportIsWhatOthersWant)
{
  const Communicator comm;
  const auto owned = Teuchos::rcp(new Map(10 * comm.size(), 10, 0, teuchos(comm)));
  const Global next = 10 * ((comm.rank() + 1) % comm.size());
  const std::vector<Global> wanted{next, next + 1, next + 2};
  const auto target = Teuchos::rcp(new Map(Teuchos::OrdinalTraits<Global>::invalid(), wanted.data(), 3, 0, teuchos(comm)));
  const Import import(owned, target);
  Vector from(owned), to(target);
  view(from).setConstant(1.0 + comm.rank());
  const Traffic before = traffic();
  to.doImport(from, import, Tpetra::INSERT);
  const Traffic found = traffic() - before;
  EXPECT_EQ(found.messages, comm.size() == 1 ? 0 : 1);
  EXPECT_EQ(found.bytes, comm.size() == 1 ? 0 : 24);
  EXPECT_EQ(view(std::as_const(to))[2], 1.0 + (comm.rank() + 1) % comm.size());
}

}  // namespace
}  // namespace mortise
