#include "constraint/supports.hpp"

#include <gtest/gtest.h>

#include "base/error.hpp"

namespace mortise::constraint {
namespace {

// Every rank sees nodes 0 .. 9 on the first boundary and 8, 9, 10 on the second.
std::vector<PrescribedDof> sample_rows(double x_first, double x_second, const Communicator& comm)
{
  const std::vector<SupportOptions> supports{{"left", {x_first, std::nullopt, 0.0}}, {"corner", {x_second, 2.0, std::nullopt}}};
  const std::vector<std::vector<Global>> nodes{{0, 1, 2, 3, 4, 5, 6, 7, 8, 9}, {8, 9, 10}};
  return dirichlet_rows(supports, nodes, 3, comm);
}

TEST(Supports, EachComponentOfANodeIsHeldOnce)
{
  const Communicator comm;
  const auto prescribed = sample_rows(0.5, 0.5, comm);
  EXPECT_EQ(comm.sum(static_cast<long long>(prescribed.size())), 20 + 3 + 1);  // x and z of ten, y of three, x of node 10
  for (const auto& h : prescribed) {
    EXPECT_EQ(h.node % comm.size(), comm.rank());
    EXPECT_EQ(h.value, h.component == 0 ? 0.5 : h.component == 1 ? 2.0 : 0.0);
  }
}

TEST(Supports, ContradictionNamesBothBoundaries)
{
  const Communicator comm;
  try {
    sample_rows(0.5, 0.6, comm);
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.status(), ExitStatus::bad_input);
    EXPECT_NE(std::string(error.what()).find("\"left\""), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("\"corner\""), std::string::npos);
  }
}

}  // namespace
}  // namespace mortise::constraint
