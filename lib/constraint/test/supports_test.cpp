#include "constraint/supports.hpp"

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "nodes.hpp"

namespace mortise::constraint {
namespace {

// Every rank sees nodes 0 .. 9 on the first boundary and 8, 9, 10 on the second.
std::vector<PrescribedDof> sample_rows(double x_first, double x_second, const Communicator& comm)
{
  const std::vector<Support> supports{{"left", {x_first, std::nullopt, 0.0}}, {"corner", {x_second, 2.0, std::nullopt}}};
  const auto nodes = anywhere({{0, 1, 2, 3, 4, 5, 6, 7, 8, 9}, {8, 9, 10}});
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

// Two boundaries that meet in a node and follow one field agree, though its formulas differ by rounding; elsewhere they do not.
TEST(Supports, FormulasAreTakenNodeByNode)
{
  const Communicator comm;
  std::vector<Support> supports{{"left", {deck::Formula("0.3 * x + y")}}, {"right", {deck::Formula("0.1 * x + 0.2 * x + y")}}};
  const std::vector<SupportNodes> nodes{{{1, 2}, {Point(3, 1, 0), Point(0.7, -0.21, 0)}}, {{2}, {Point(0.7, -0.21, 0)}}};
  for (const auto& h : dirichlet_rows(supports, nodes, 3, comm)) EXPECT_NEAR(h.value, h.node == 1 ? 1.9 : 0, 1e-15);
  supports[1].displacement[0] = deck::Formula("0.3 * x + y + 1e-9");
  EXPECT_THROW(dirichlet_rows(supports, nodes, 3, comm), Error);
  supports[1].displacement[0] = deck::Formula("1 / (x - 0.7)");
  EXPECT_THROW(dirichlet_rows(supports, nodes, 3, comm), Error);
}

}  // namespace
}  // namespace mortise::constraint
