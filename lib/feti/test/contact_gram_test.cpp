// B D^-1 B' of contact rows that share nodes, against the same matrix whole.
#include "../src/contact_gram.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "base/dense.hpp"
#include "testing/blocks.hpp"

namespace mortise::feti {
namespace {

// Two blocks, the points of whose contact each meet two nodes of the lower one: rows of one line of nodes hang together.
struct Chains : Blocks {
  Chains()
      : Blocks({{"lower", {{0, 0, 0}, {1, 1, 1}, {3, 3, 2}, "hex8"}}, {"upper", {{0, 0, 1}, {1, 1, 1}, {3, 3, 2}, "hex8"}}},
               {{"lower", {2, 1, 1}}, {"upper", {1, 2, 1}}}, [](int id) { return 1.0 + id; })
  {
    const auto above = nodes_of("upper.zmin"), below = nodes_of("lower.zmax");
    auto& contacts = constraints.contacts;
    for (std::size_t i = 0; i < above.size(); ++i) {
      if (static_cast<int>(i) % comm.size() != comm.rank()) continue;
      contacts.nodes.push_back({0, above[i].id, 1, Point(0, 0, -1), {}, contacts.rows.size()});
      contacts.bonded.push_back(false);
      contacts.rows.entries.push_back({above[i].id, 2, -1});
      const bool pair = i % 4 != 3;  // not from one chain to the next
      contacts.rows.entries.push_back({below[i].id, 2, pair ? 0.5 : 1});
      if (pair && i != 4) contacts.rows.entries.push_back({below[i + 1].id, 2, 0.5});
      contacts.rows.close(0);
    }
  }
};

TEST(ContactGram, IsInvertedBlockByBlock)
{
  const Chains chains;
  const auto& comm = chains.comm;
  const JumpOperator jump(chains.decomposition, *chains.directory, chains.interface, {}, {}, chains.constraints.contacts, {},
                          comm);
  const auto [first, end] = jump.contact_rows();
  const auto size = static_cast<Eigen::Index>(end - first);
  ASSERT_EQ(size, 16);
  Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(size, size);
  const auto touched = jump.touched_rows()->getNodeElementList();
  for (std::size_t s = 0; s < jump.blocks().size(); ++s) {
    const auto& block = jump.blocks()[s];
    Eigen::MatrixXd b = Eigen::MatrixXd::Zero(size, block.size);
    for (std::size_t r = 0; r < block.row.size(); ++r)
      if (const Global row = touched[block.row[r]]; row >= first && row < end)
        for (std::size_t i = block.offset[r]; i < block.offset[r + 1]; ++i)
          b(row - first, block.unknown[i]) += block.coefficient[i];
    for (Eigen::Index i = 0; i < b.cols(); ++i)
      b.col(i) /= std::sqrt(chains.system.nodal_stiffness[s][static_cast<std::size_t>(i / 3)]);
    gram += b * b.transpose();
  }
  comm.sum_in_place({gram.data(), static_cast<std::size_t>(gram.size())});
  EXPECT_LT((gram.diagonal().array() - 1).abs().maxCoeff(), 1e-12);
  EXPECT_GT((gram - Eigen::MatrixXd::Identity(size, size)).cwiseAbs().maxCoeff(), 0.1);

  ContactGram contact(jump, chains.system.nodal_stiffness, 3, comm);
  for (const int every : {0, 3, 5}) {  // rows that are fixed
    std::vector<Local> fixed;
    Eigen::VectorXd right = Eigen::VectorXd::Zero(size);
    Vector x(jump.rows());
    for (Local i = jump.ranges().contacts; i < jump.ranges().extra; ++i) {
      const Global row = jump.rows()->getGlobalElement(i) - first;
      view(x)[i] = right[row] = std::sin(1.0 + static_cast<double>(row));
      if (every > 0 && row % every == 0) fixed.push_back(i);
    }
    comm.sum_in_place({right.data(), static_cast<std::size_t>(size)});
    Eigen::MatrixXd expected = gram;
    for (Eigen::Index row = 0; every > 0 && row < size; row += every) {
      expected.row(row).setZero();
      expected.col(row).setZero();
      expected(row, row) = 1;
    }
    contact.fix(fixed);
    contact.apply_inverse(x);
    const Eigen::VectorXd solution = dense::solve_symmetric(expected, right);
    EXPECT_GT((solution - right).norm(), 0.05);
    for (Local i = jump.ranges().contacts; i < jump.ranges().extra; ++i)
      EXPECT_NEAR(view(x)[i], solution[jump.rows()->getGlobalElement(i) - first], 1e-11);
  }
}

}  // namespace
}  // namespace mortise::feti
