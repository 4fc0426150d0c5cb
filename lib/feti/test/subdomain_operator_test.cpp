#include "feti/subdomain_operator.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "base/error.hpp"
#include "fem/stiffness.hpp"
#include "mesh/blocks.hpp"

namespace mortise::feti {
namespace {

mesh::Mesh block(std::array<int, 3> cells, std::array<double, 3> size)
{
  mesh::Options options;
  mesh::BlockOptions box;
  box.cells = cells;
  box.size = size;
  options.blocks["box"] = box;
  return mesh::generate(options, 3, 0, {0, 0, 0}, cells);
}

class Inverse : public testing::TestWithParam<std::tuple<std::string, std::array<double, 3>>> {};

// K K^+ f = f for every f in the image of K, whatever the shape of the subdomain; K K^+ K = K is the same statement.
TEST_P(Inverse, IsAGeneralisedInverse)
{
  const auto& [factorization, size] = GetParam();
  const auto mesh = block({4, 3, 3}, size);
  const auto k = fem::stiffness(mesh, fem::Material{2e5, 0.3, 0, 0}, fem::Kinematics::solid);
  const ElasticSubdomain subdomain(k, fem::rigid_motions(mesh.points, fem::Kinematics::solid), mesh.points, 3, factorization);
  Eigen::MatrixXd u = Eigen::MatrixXd::Random(subdomain.size(), 3), f(subdomain.size(), 3);
  for (int c = 0; c < 3; ++c) f.col(c) = subdomain.apply(u.col(c));
  Eigen::MatrixXd x = f;
  const std::array<double*, 3> columns{x.col(0).data(), x.col(1).data(), x.col(2).data()};
  subdomain.apply_inverse(columns);
  for (int c = 0; c < 3; ++c) EXPECT_LT((subdomain.apply(x.col(c)) - f.col(c)).norm(), 1e-9 * f.col(c).norm());
  EXPECT_LT(subdomain.apply(subdomain.kernel().col(5)).norm(), 1e-9 * k.norm());
}

INSTANTIATE_TEST_SUITE_P(Shapes, Inverse,
                         testing::Combine(testing::Values("cholmod", "cholmod_plain", "klu2"),
                                          testing::Values(std::array<double, 3>{1, 1, 1}, std::array<double, 3>{100, 1, 1},
                                                          std::array<double, 3>{50, 50, 1})));

TEST(Inverse, GoesThroughSharedFactorsInBlocks)
{
  const auto mesh = block({3, 2, 2}, {1, 1, 1}), other = block({2, 2, 2}, {1, 1, 1});
  const auto make = [](const mesh::Mesh& m) {
    return std::make_shared<const ElasticSubdomain>(fem::stiffness(m, fem::Material{2e5, 0.3, 0, 0}, fem::Kinematics::solid),
                                                    fem::rigid_motions(m.points, fem::Kinematics::solid), m.points, 3, "cholmod");
  };
  const auto a = make(mesh), b = make(other);
  Subdomains subdomains;
  std::vector<Eigen::VectorXd> v, expected;
  for (int s = 0; s < 150; ++s) {  // more than two blocks of copies of a, one b among them
    subdomains.push_back(s == 70 ? b : a);
    v.emplace_back(Eigen::VectorXd::LinSpaced(subdomains.back()->size(), s, 2 * s + 1));
    expected.push_back(v.back());
    double* const column = expected.back().data();
    subdomains.back()->apply_inverse({&column, 1});
  }
  apply_inverse(subdomains, v);
  for (std::size_t s = 0; s < v.size(); ++s) EXPECT_LT((v[s] - expected[s]).norm(), 1e-12 * expected[s].norm()) << s;
}

// By a rounded factor: near K^+ as it says, symmetric to rounding, and refined as if it were not rounded; a turned copy, too.
TEST(Inverse, IsRefinedWhereItsFactorIsRounded)
{
  const auto mesh = block({5, 4, 3}, {1, 1, 1});
  const auto make = [&](std::optional<double> most_rounded) {
    return std::make_shared<const ElasticSubdomain>(fem::stiffness(mesh, fem::Material{2e5, 0.3, 0, 0}, fem::Kinematics::solid),
                                                    fem::rigid_motions(mesh.points, fem::Kinematics::solid), mesh.points, 3,
                                                    "cholmod", most_rounded);
  };
  const auto exact = make({}), rounded = make(1e-5), refused = make(1e-12);
  EXPECT_EQ(exact->rounding(), 0);
  EXPECT_EQ(refused->rounding(), 0);
  EXPECT_GT(rounded->rounding(), 1e-9);
  EXPECT_LT(rounded->rounding(), 1e-5);
  EXPECT_EQ(rounded->factor_bytes(), exact->factor_bytes());
  const auto solve = [](const SubdomainOperator& s, Eigen::MatrixXd x, bool quickly) {
    std::vector<double*> columns;
    for (auto column : x.colwise()) columns.push_back(column.data());
    if (quickly)
      s.apply_rounded_inverse(columns);
    else
      s.apply_inverse(columns);
    return x;
  };
  for (const int count : {1, 2, 16, 19}) {
    const Eigen::MatrixXd f = Eigen::MatrixXd::Random(exact->size(), count);
    const Eigen::MatrixXd x = solve(*exact, f, false), quick = solve(*rounded, f, true);
    EXPECT_LT((solve(*rounded, f, false) - x).norm(), 1e-12 * x.norm());
    EXPECT_EQ(solve(*refused, f, true), x);
    EXPECT_GT((quick - x).norm(), 1e-9 * x.norm());
    EXPECT_LT((quick - x).norm(), 1e-4 * x.norm());
    const Eigen::MatrixXd product = f.transpose() * quick;
    EXPECT_LT((product - product.transpose()).norm(), 1e-13 * product.norm());
  }
  const Eigen::Matrix3d rotation = Eigen::AngleAxisd(2.1, Point(1, -2, 0.5).normalized()).matrix();
  const RotatedSubdomain turned(rounded, rotation, 3), turned_exactly(exact, rotation, 3);
  EXPECT_EQ(turned.rounding(), rounded->rounding());
  const Eigen::MatrixXd f = Eigen::MatrixXd::Random(exact->size(), 1), x = solve(turned_exactly, f, false);
  EXPECT_LT((solve(turned, f, false) - x).norm(), 1e-12 * x.norm());
}

// A strip ten thousand times as long as thick bends so easily that rounding alone bends it, and every factorization has its own.
// Refined, they agree.
TEST(Inverse, IsRefinedWhereASubdomainIsSlender)
{
  const auto strip = [&](double thick, const std::string& factorization, bool refined) {
    const auto mesh = block({40, 2, 1}, {1000, 50, thick});
    return ElasticSubdomain(fem::stiffness(mesh, fem::Material{2e5, 0.3, 0, 0}, fem::Kinematics::solid),
                            fem::rigid_motions(mesh.points, fem::Kinematics::solid), mesh.points, 3, factorization, {},
                            refined ? inaccurate : 1e9);
  };
  EXPECT_LT(strip(50, "cholmod", true).inaccuracy(), inaccurate);
  const auto slender = strip(0.1, "cholmod", true);
  ASSERT_GT(slender.inaccuracy(), inaccurate);
  EXPECT_EQ(strip(0.1, "cholmod", false).inaccuracy(), 0);
  const Eigen::VectorXd f = Eigen::VectorXd::Random(slender.size());
  const auto solve = [&](const std::string& factorization, bool refined, bool quickly) {
    const auto subdomain = strip(0.1, factorization, refined);
    Eigen::VectorXd x = f;
    double* const column = x.data();
    if (quickly)
      subdomain.apply_rounded_inverse({&column, 1});
    else
      subdomain.apply_inverse({&column, 1});
    return x;
  };
  const Eigen::VectorXd x = solve("cholmod", true, false);
  EXPECT_EQ(solve("cholmod", true, true), x);
  const double plain = (solve("cholmod", false, false) - solve("klu2", false, false)).norm();
  EXPECT_LT((solve("klu2", true, false) - x).norm(), 1e-2 * plain);
}

// A rotated copy behaves as what its own mesh gives.
TEST(Inverse, OfATurnedCopyIsItsOwn)
{
  const auto mesh = block({3, 2, 2}, {1, 1, 1});
  const Eigen::Matrix3d rotation = Eigen::AngleAxisd(2.1, Point(1, -2, 0.5).normalized()).matrix();
  auto rotated_mesh = mesh;
  for (auto& p : rotated_mesh.points) p = rotation * p + Point(3, 1, 4);
  const auto make = [](const mesh::Mesh& m) {
    return std::make_shared<const ElasticSubdomain>(fem::stiffness(m, fem::Material{2e5, 0.3, 0, 0}, fem::Kinematics::solid),
                                                    fem::rigid_motions(m.points, fem::Kinematics::solid), m.points, 3, "cholmod");
  };
  const auto original = make(mesh), own = make(rotated_mesh);
  const auto rotated = std::make_shared<const RotatedSubdomain>(original, rotation, 3);
  const Eigen::VectorXd u = Eigen::VectorXd::Random(own->size());
  const Eigen::VectorXd f = own->apply(u);
  EXPECT_LT((rotated->apply(u) - f).norm(), 1e-12 * f.norm());
  EXPECT_LT((rotated->kernel() * (rotated->kernel().transpose() * own->kernel()) - own->kernel()).norm(), 1e-12);
  const Subdomains subdomains{original, rotated};
  std::vector<Eigen::VectorXd> v{original->apply(u), f};
  apply_inverse(subdomains, v);
  EXPECT_LT((own->apply(v[1]) - f).norm(), 1e-11 * f.norm());
  Eigen::VectorXd alone = f;
  double* const column = alone.data();
  rotated->apply_inverse({&column, 1});
  EXPECT_LT((alone - v[1]).norm(), 1e-12 * alone.norm());
}

TEST(FixingNodes, AreFewForACompactSubdomain)
{
  const auto mesh = block({6, 6, 6}, {1, 1, 1});
  const auto nodes = fixing_nodes(mesh.points, fem::rigid_motions(mesh.points, fem::Kinematics::solid), 3);
  EXPECT_GE(nodes.size(), 3U);
  EXPECT_LE(nodes.size(), 8U);
}

// The middles of a beam's slices stand on its axis; a few nodes beside it keep it from turning about that.
TEST(FixingNodes, KeepASlenderBeamFromTurning)
{
  for (const double length : {20.0, 100.0, 1000.0}) {
    mesh::Options options;
    mesh::BlockOptions box;
    box.cells = {40, 2, 2};
    box.size = {length, 1, 1};
    box.element = "hex27";
    options.blocks["box"] = box;
    const auto mesh = mesh::generate(options, 3, 0, {0, 0, 0}, box.cells);
    const auto kernel = fem::rigid_motions(mesh.points, fem::Kinematics::solid);
    const auto nodes = fixing_nodes(mesh.points, kernel, 3);
    EXPECT_LT(nodes.size(), 50U) << length;
    const auto k = fem::stiffness(mesh, fem::Material{2e5, 0.3, 0, 0}, fem::Kinematics::solid);
    const ElasticSubdomain subdomain(k, kernel, mesh.points, 3, "cholmod");
    const Eigen::VectorXd u = Eigen::VectorXd::LinSpaced(subdomain.size(), -1, 2).array().sin();
    const Eigen::VectorXd f = subdomain.apply(u);
    Eigen::VectorXd x = f;
    double* const column = x.data();
    subdomain.apply_inverse({&column, 1});
    EXPECT_LT((subdomain.apply(x) - f).norm(), 1e-9 * f.norm()) << length;
  }
}

TEST(DirectSolver, RefusesWhatIsNotPositiveDefinite)
{
  SparseMatrix a(2, 2);
  a.insert(0, 0) = 1;
  a.insert(1, 0) = 2;
  a.insert(1, 1) = 1;
  a.makeCompressed();
  try {
    DirectSolver("cholmod", a);
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.status(), ExitStatus::bad_input);  // no lack of memory
  }
  EXPECT_THROW(DirectSolver("pencil", a), Error);
}

}  // namespace
}  // namespace mortise::feti
