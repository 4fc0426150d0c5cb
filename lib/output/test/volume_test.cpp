// solution.pvd and blocks.pvd as pieces.
#include "output/volume.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <set>

#include "deck_of_blocks.hpp"
#include "output/blocks.hpp"
#include "output/contact_sides.hpp"

namespace mortise::output {
namespace {

using Names = std::vector<std::string>;

Eigen::Vector3d eigenvalues(const fem::Stress& s)
{
  const Eigen::Matrix3d tensor = (Eigen::Matrix3d() << s[0], s[3], s[5], s[3], s[1], s[4], s[5], s[4], s[2]).finished();
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(tensor).eigenvalues().reverse();
}

Point mean_of_cell(const io::Piece& piece, std::size_t cell)
{
  Point sum = Point::Zero();
  for (const Local n : piece.cells[cell]) sum += piece.points[static_cast<std::size_t>(n)];
  return sum / static_cast<double>(piece.cells[cell].size());
}

// The fields of the deck and no others; copies of a node are one point, and two bodies share none.
TEST(Volume, HasEachNodeOnceWithTheFieldsThatAreAskedFor)
{
  const DeckOfBlocks blocks(
      "axes: {column: {axis: [0, 0, 1], point: [1, 0.5, 0]}}\n"
      "output: {fields: [principal_stress, displacement], axes: column}\n");
  NodeValues heights{"height", 1, {}};
  std::set<Global> nodes;
  for (const auto& subdomain : blocks.decomposition.subdomains) {
    auto& values = heights.of_subdomain.emplace_back(static_cast<Eigen::Index>(subdomain.mesh.node_count()), 1);
    for (std::size_t n = 0; n < subdomain.mesh.node_count(); ++n)
      values(static_cast<Eigen::Index>(n), 0) = subdomain.mesh.points[n][2];
    nodes.insert(subdomain.mesh.node_id.begin(), subdomain.mesh.node_id.end());
  }
  const auto volume = make_volume(blocks.deck, blocks.decomposition, blocks.displacement, blocks.fields, {heights});
  const auto& piece = volume.piece;
  EXPECT_EQ(volume.ids, std::vector<Global>(nodes.begin(), nodes.end()));
  EXPECT_EQ(names_of(piece.point_fields), (Names{"displacement", "principal_stress", "displacement_local", "height"}));
  EXPECT_EQ(names_of(piece.cell_fields), (Names{"body", "subdomain"}));
  for (std::size_t p = 0; p < piece.points.size(); ++p) {
    const Point& x = piece.points[p];
    const Point u = DeckOfBlocks::moved(x);
    EXPECT_EQ(at(piece.point_fields, "displacement", p), Eigen::VectorXd(u));
    EXPECT_LT((at(piece.point_fields, "principal_stress", p) - eigenvalues(DeckOfBlocks::stress(x))).norm(), 1e-12);
    EXPECT_EQ(at(piece.point_fields, "height", p)[0], x[2]);
    Point radial(x[0] - 1, x[1] - 0.5, 0);
    if (radial.norm() == 0) continue;
    radial.normalize();
    const Point along(radial.dot(u), radial[0] * u[1] - radial[1] * u[0], u[2]);
    EXPECT_LT((at(piece.point_fields, "displacement_local", p) - Eigen::VectorXd(along)).norm(), 1e-12);
  }
  for (std::size_t c = 0; c < piece.cells.size(); ++c)
    EXPECT_EQ(at(piece.cell_fields, "body", c)[0], mean_of_cell(piece, c)[2] > 1 ? 1 : 0);
  EXPECT_EQ(blocks.comm.sum(static_cast<long long>(piece.cells.size())), blocks.decomposition.catalogue.cell_count);
}

// Stresses jump at x = 1, where the material of the lower block changes.
TEST(Volume, HasAPointForEachMaterialThatMeetsAtANode)
{
  DeckOfBlocks blocks("output: {fields: [stress]}\n");
  constexpr double jump = 100;
  auto& stress = blocks.fields.stress;
  const auto material = [](const Point& x) { return x[2] < 1 && x[0] > 1 ? 1 : 0; };
  for (std::size_t s = 0; s < blocks.decomposition.subdomains.size(); ++s) {
    const auto& mesh = blocks.decomposition.subdomains[s].mesh;
    auto& both = stress.by_material.emplace_back(stress.nodal[s].rows(), 12);
    both << stress.nodal[s], (stress.nodal[s].array() + jump).matrix();
    auto& of_cells = stress.cell_block.emplace_back();
    for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
      Point middle = Point::Zero();
      for (const Local n : mesh.cells[c]) middle += mesh.points[static_cast<std::size_t>(n)] / 8;
      of_cells.push_back(material(middle));
    }
  }
  const auto volume = make_volume(blocks.deck, blocks.decomposition, blocks.displacement, blocks.fields, {});
  const auto& piece = volume.piece;
  for (std::size_t c = 0; c < piece.cells.size(); ++c) {
    const double raised = jump * material(mean_of_cell(piece, c));
    for (const Local p : piece.cells[c]) {
      const auto i = static_cast<std::size_t>(p);
      const Eigen::VectorXd expected = (DeckOfBlocks::stress(piece.points[i]).array() + raised).matrix();
      EXPECT_LT((at(piece.point_fields, "stress", i) - expected).norm(), 1e-12);
    }
  }
  for (const auto& subdomain : blocks.decomposition.subdomains)
    for (std::size_t n = 0; n < subdomain.mesh.node_count(); ++n) {
      const auto& x = subdomain.mesh.points[n];
      const bool left = subdomain.body == 1 || x[0] <= 1;
      EXPECT_EQ(piece.points[static_cast<std::size_t>(volume.point(subdomain.mesh.node_id[n], left ? 0 : 1))], x);
    }
}

double area_of(const io::Piece& piece, const Communicator& comm)
{
  double area = 0;
  for (std::size_t c = 0; c < piece.cells.size(); ++c) {
    const auto corner = [&](std::size_t i) -> const Point& { return piece.points[static_cast<std::size_t>(piece.cells[c][i])]; };
    area += Point((corner(2) - corner(0)).cross(corner(3) - corner(1))).norm() / 2;
  }
  return comm.sum(area);
}

// Boundaries that supports and loads name stand once, though they are named twice, and have the fields of the volume.
TEST(Blocks, AreBodiesContactsAndBoundaries)
{
  const DeckOfBlocks blocks(
      "output: {fields: [displacement]}\n"
      "supports: [{boundary: lower.zmin, displacement: {z: 0}}, {boundary: lower.zmin, displacement: {x: 0, y: 0}}]\n"
      "loads: [{boundary: upper.zmax, pressure: 1}]\n");
  const auto volume = make_volume(blocks.deck, blocks.decomposition, blocks.displacement, blocks.fields, {});
  const std::vector pairs{blocks.joint()};
  const std::vector states{DeckOfBlocks::no_state(pairs[0].secondary)};
  const auto found =
      named_blocks(blocks.deck, blocks.decomposition, pairs, blocks.fields.stress, volume, contact_sides(pairs, states));
  Names names;
  for (const auto& block : found) names.push_back(block.group + "/" + block.name);
  EXPECT_EQ(names, (Names{"bodies/lower", "bodies/upper", "contacts/joint", "boundaries/lower.zmin", "boundaries/upper.zmax"}));
  const long long cells[] = {16, 12, 6, 8, 6};
  for (std::size_t b = 0; b < found.size(); ++b)
    EXPECT_EQ(blocks.comm.sum(static_cast<long long>(found[b].piece.cells.size())), cells[b]) << names[b];
  EXPECT_NEAR(area_of(found[3].piece, blocks.comm), 2, 1e-12);
  EXPECT_NEAR(area_of(found[4].piece, blocks.comm), 1, 1e-12);
  for (const std::size_t b : {1, 4})
    for (std::size_t p = 0; p < found[b].piece.points.size(); ++p)
      EXPECT_EQ(at(found[b].piece.point_fields, "displacement", p),
                Eigen::VectorXd(DeckOfBlocks::moved(found[b].piece.points[p])));
}

TEST(Blocks, AreWrittenWhereTheyAreFewUnlessTheDeckSaysSo)
{
  const auto wants = [](const std::string& output, std::size_t contacts) {
    const DeckOfBlocks blocks(output);
    return wants_blocks(blocks.deck, blocks.decomposition.catalogue, contacts);
  };
  EXPECT_TRUE(wants("", 38));  // beside two bodies
  EXPECT_FALSE(wants("", 39));
  EXPECT_TRUE(wants("output: {blocks: true}\n", 39));
  EXPECT_FALSE(wants("output: {blocks: false}\n", 0));
}

}  // namespace
}  // namespace mortise::output
