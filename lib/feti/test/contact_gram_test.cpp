// B D^-1 B' of contact rows that share nodes, against the same matrix whole.
#include "../src/contact_gram.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "base/dense.hpp"
#include "testing/blocks.hpp"

namespace mortise::feti {
namespace {

// Two blocks, the points of whose contact each meet two nodes of the lower one: rows of one line of nodes hang together. With
// tangents, a point has three rows, and the last of the point `bare` has no entry.
struct Chains : Blocks {
  static constexpr std::size_t bare = 7;
  explicit Chains(bool tangents)
      : Blocks({{"lower", {{0, 0, 0}, {1, 1, 1}, {3, 3, 2}, "hex8"}}, {"upper", {{0, 0, 1}, {1, 1, 1}, {3, 3, 2}, "hex8"}}},
               {{"lower", {2, 1, 1}}, {"upper", {1, 2, 1}}}, [](int id) { return 1.0 + id; })
  {
    const auto above = nodes_of("upper.zmin"), below = nodes_of("lower.zmax");
    auto& contacts = constraints.contacts;
    for (std::size_t i = 0; i < above.size(); ++i) {
      if (static_cast<int>(i) % comm.size() != comm.rank()) continue;
      std::vector<Point> axes;
      if (tangents) axes = {Point(1, 0, 0), Point(0, 1, 0)};
      contacts.nodes.push_back({0, above[i].id, 1, Point(0, 0, -1), axes, contacts.rows.size()});
      contacts.bonded.push_back(false);
      const bool pair = i % 4 != 3;  // not from one chain to the next
      for (const int component : tangents ? std::vector{2, 0, 1} : std::vector{2}) {
        if (component == 1 && i == bare) {
          contacts.rows.close(0);
          continue;
        }
        contacts.rows.entries.push_back({above[i].id, component, -1});
        contacts.rows.entries.push_back({below[i].id, component, pair ? 0.5 : 1});
        if (pair && i != 4) contacts.rows.entries.push_back({below[i + 1].id, component, 0.5});
        contacts.rows.close(0);
      }
    }
  }

  JumpOperator jump() const { return {decomposition, *directory, interface, {}, {}, constraints.contacts, comm}; }
};

// B D^-1 B' of the contact rows, on every rank.
Eigen::MatrixXd dense_gram(const Chains& chains, const JumpOperator& jump)
{
  const auto [first, end] = jump.contact_rows();
  const auto size = static_cast<Eigen::Index>(end - first);
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
  chains.comm.sum_in_place({gram.data(), static_cast<std::size_t>(size * size)});
  return gram;
}

// What apply_inverse() makes of sin(1 + row), against `expected` of it.
void expect_inverse(const ContactGram& contact, const JumpOperator& jump, const Eigen::MatrixXd& expected)
{
  const Global first = jump.contact_rows().first;
  Eigen::VectorXd right(expected.cols());
  for (Eigen::Index row = 0; row < right.size(); ++row) right[row] = std::sin(1.0 + static_cast<double>(row));
  Vector x(jump.rows());
  for (Local i = jump.ranges().contacts; i < jump.ranges().extra; ++i)
    view(x)[i] = right[jump.rows()->getGlobalElement(i) - first];
  contact.apply_inverse(x);
  const Eigen::VectorXd solution = expected * right;
  EXPECT_GT((solution - right).norm(), 0.05);
  for (Local i = jump.ranges().contacts; i < jump.ranges().extra; ++i)
    EXPECT_NEAR(view(x)[i], solution[jump.rows()->getGlobalElement(i) - first], 1e-11);
}

TEST(ContactGram, IsInvertedBlockByBlock)
{
  const Chains chains(false);
  const JumpOperator jump = chains.jump();
  const Eigen::MatrixXd gram = dense_gram(chains, jump);
  const auto size = gram.rows();
  ASSERT_EQ(size, 16);
  EXPECT_LT((gram.diagonal().array() - 1).abs().maxCoeff(), 1e-12);
  EXPECT_GT((gram - Eigen::MatrixXd::Identity(size, size)).cwiseAbs().maxCoeff(), 0.1);

  ContactGram contact(jump, chains.system.nodal_stiffness, 3, {}, chains.comm);
  for (const int every : {0, 3, 5}) {  // rows that are fixed
    std::vector<Local> fixed;
    for (Local i = jump.ranges().contacts; i < jump.ranges().extra; ++i)
      if (every > 0 && (jump.rows()->getGlobalElement(i) - jump.contact_rows().first) % every == 0) fixed.push_back(i);
    Eigen::MatrixXd t = Eigen::MatrixXd::Identity(size, size);
    for (Eigen::Index row = 0; every > 0 && row < size; row += every) t(row, row) = 0;
    const Eigen::MatrixXd ones = Eigen::MatrixXd::Identity(size, size) - t;
    contact.fix(fixed, {});
    expect_inverse(contact, jump, dense::solve_symmetric(t * gram * t + ones, Eigen::MatrixXd::Identity(size, size)));
  }
}

TEST(ContactGram, OfPairsThatSlipHasTheTangentsAndTheirCurvatures)
{
  const Chains chains(true);
  const JumpOperator jump = chains.jump();
  Eigen::MatrixXd gram = dense_gram(chains, jump);
  const auto size = gram.rows();
  ASSERT_EQ(size, 48);
  EXPECT_EQ((gram.diagonal().array() == 0).count(), 1);
  for (double& entry : gram.diagonal()) entry = entry == 0 ? 1 : entry;
  std::vector<qp::Disc> discs;
  for (Local i = jump.ranges().contacts; i < jump.ranges().extra; i += 3) discs.push_back({{i + 1, i + 2}});
  ContactGram contact(jump, chains.system.nodal_stiffness, 3, discs, chains.comm);
  EXPECT_TRUE(contact.usable());
  for (const int pass : {0, 1, 2}) {  // others slip, in other directions, and none at last
    Eigen::MatrixXd t = Eigen::MatrixXd::Identity(size, size), sigma = Eigen::MatrixXd::Zero(size, size);
    std::vector<Local> fixed;
    std::vector<qp::SlipDirection> slips;
    const auto state = [&](Global point) { return pass == 2 ? 0 : (point + pass) % 3; };  // 0 sticks, 1 slips, 2 is open
    for (Eigen::Index row = 0; row < size; row += 3) {
      const Global point = row / 3;
      if (state(point) == 0) continue;
      t.block(row + 1, row + 1, 2, 2).setZero();
      sigma(row + 1, row + 1) = sigma(row + 2, row + 2) = 1;
      if (state(point) == 2) {
        t(row, row) = 0;
        sigma(row, row) = 1;
        continue;
      }
      const double angle = static_cast<double>(point + 5 * pass), curvature = point % 2 == 0 ? 0.3 : 40;
      t(row + 1, row + 1) = std::cos(angle);
      t(row + 2, row + 1) = std::sin(angle);
      sigma(row + 1, row + 1) = curvature;
    }
    for (Local i = jump.ranges().contacts; i < jump.ranges().extra; i += 3) {
      const Global row = jump.rows()->getGlobalElement(i) - jump.contact_rows().first, point = row / 3;
      if (state(point) == 2) fixed.insert(fixed.end(), {i, i + 1, i + 2});
      if (state(point) == 1)
        slips.push_back({{i + 1, i + 2}, Eigen::Vector2d(t(row + 1, row + 1), t(row + 2, row + 1)), sigma(row + 1, row + 1)});
    }
    contact.fix(fixed, slips);
    Eigen::MatrixXd expected_inverse = t * dense::solve_symmetric(t.transpose() * gram * t + sigma, t.transpose());
    for (Eigen::Index row = 0; row < size; ++row)
      if (state(row / 3) == 2) expected_inverse(row, row) = 1;
    expect_inverse(contact, jump, expected_inverse);

    Vector x(jump.rows()), y(jump.rows());
    x.putScalar(1);
    contact.add_curvature(x, y);
    const Eigen::VectorXd expected = t * sigma * t.transpose() * Eigen::VectorXd::Ones(size);
    for (Local i = jump.ranges().contacts; i < jump.ranges().extra; ++i)
      EXPECT_NEAR(view(y)[i], expected[jump.rows()->getGlobalElement(i) - jump.contact_rows().first], 1e-12);
  }
}

}  // namespace
}  // namespace mortise::feti
