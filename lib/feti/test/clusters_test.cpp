// What a cluster answers to forces, against the equations it stands for.
#include "feti/clusters.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "testing/cut.hpp"

namespace mortise::feti {
namespace {

struct Setting {
  const char* name;
  fem::Kinematics kinematics;
  const char* element;
  std::array<int, 3> cells, counts;
  int size;  // of a cluster
};

std::ostream& operator<<(std::ostream& out, const Setting& setting)
{
  return out << setting.name;
}

// One block away from the axis, every third subdomain of it a thousand times as stiff.
struct Block {
  Communicator comm;
  partition::Decomposition decomposition;
  partition::Interface interface;
  Clusters clusters;

  explicit Block(const Setting& setting)
  {
    const int dimension = fem::dimension(setting.kinematics);
    mesh::Options mesh;
    mesh.blocks["block"] = {{1, 0, 0}, {2, 1, 1}, setting.cells, setting.element};
    partition::Options options;
    options.method = "grid";
    options.counts["block"] = setting.counts;
    options.subdomains_per_cluster = setting.size;
    decomposition = partition::cut_of(mesh, options, comm, dimension);
    std::vector<std::vector<double>> weight;
    Subdomains subdomains;
    for (const auto& s : decomposition.subdomains) {
      const auto k = fem::stiffness(s.mesh, fem::Material{s.id % 3 == 2 ? 1e3 : 1.0, 0.3, 0, 0}, setting.kinematics);
      weight.push_back(nodal_stiffness(k.diagonal(), dimension));
      subdomains.push_back(std::make_shared<ElasticSubdomain>(k, fem::rigid_motions(s.mesh.points, setting.kinematics),
                                                              s.mesh.points, dimension, "cholmod"));
    }
    const partition::NodeDirectory directory(decomposition, weight, comm);
    interface = partition::find_interface(decomposition, directory, comm);
    clusters = Clusters(decomposition, interface, subdomains, weight, setting.kinematics);
  }

  // Forces that do not move any cluster.
  std::vector<Eigen::VectorXd> forces(double frequency) const
  {
    std::vector<Eigen::VectorXd> f;
    Eigen::VectorXd resultant = Eigen::VectorXd::Zero(clusters.kernel_dimension());
    for (std::size_t s = 0; s < decomposition.subdomains.size(); ++s) {
      auto& own = f.emplace_back(clusters.subdomains()[s]->size());
      for (Eigen::Index i = 0; i < own.size(); ++i) own[i] = std::sin(frequency * static_cast<double>(i + 7 * s + 1));
      resultant.segment(clusters.first(s), clusters.modes()) += clusters.coordinates(s, own);
    }
    for (std::size_t s = 0; s < f.size(); ++s) f[s] -= clusters.motion(s, resultant.segment(clusters.first(s), clusters.modes()));
    return f;
  }
};

double dot(const std::vector<Eigen::VectorXd>& a, const std::vector<Eigen::VectorXd>& b)
{
  double sum = 0;
  for (std::size_t s = 0; s < a.size(); ++s) sum += a[s].dot(b[s]);
  return sum;
}

double norm(const std::vector<Eigen::VectorXd>& a)
{
  return std::sqrt(dot(a, a));
}

class Answers : public testing::TestWithParam<Setting> {};

// K u + B0' mu = f; u lets the inner forces of other loads do no work, B0 u = 0; K^+ is symmetric, of loads that move clusters
// too.
TEST_P(Answers, AreInEquilibriumAndJoined)
{
  const Block block(GetParam());
  const auto& clusters = block.clusters;
  EXPECT_LT(block.decomposition.cluster_count(), block.decomposition.subdomain_count());
  EXPECT_EQ(clusters.kernel_dimension(), block.decomposition.cluster_count() * clusters.modes());
  const auto f = block.forces(0.7), g = block.forces(1.9);
  auto u = f, v = g;
  clusters.apply_inverse(u);
  clusters.apply_inverse(v);
  const auto inner = clusters.inner_forces(f);
  double residual = 0;
  for (std::size_t s = 0; s < f.size(); ++s) residual += (clusters.subdomains()[s]->apply(u[s]) + inner[s] - f[s]).squaredNorm();
  EXPECT_LE(std::sqrt(residual), 1e-10 * norm(f));  // a rank without a cluster has 0 on both sides
  EXPECT_GE(norm(inner), 0.01 * norm(f));
  EXPECT_LE(std::abs(dot(u, clusters.inner_forces(g))), 1e-10 * norm(u) * norm(g));
  EXPECT_NEAR(dot(g, u), dot(f, v), 1e-10 * norm(g) * norm(u));
  std::vector<Eigen::VectorXd> ones, answer;
  for (const auto& own : f) ones.emplace_back(Eigen::VectorXd::Ones(own.size()));
  answer = ones;
  clusters.apply_inverse(answer);
  EXPECT_NEAR(dot(f, answer), dot(u, ones), 1e-9 * norm(f) * norm(answer));
}

// Rigid motions of a cluster are orthonormal, cost no energy and fulfil its constraints.
TEST_P(Answers, KernelsAreRigidMotionsOfClusters)
{
  const Block block(GetParam());
  const auto& clusters = block.clusters;
  const auto inner = clusters.inner_forces(block.forces(0.7));
  Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(clusters.kernel_dimension(), clusters.modes());
  Eigen::VectorXd work = Eigen::VectorXd::Zero(clusters.kernel_dimension());
  for (std::size_t s = 0; s < inner.size(); ++s) {
    const Eigen::MatrixXd kernel = clusters.kernel(s);
    gram.middleRows(clusters.first(s), clusters.modes()) += kernel.transpose() * kernel;
    work.segment(clusters.first(s), clusters.modes()) += clusters.coordinates(s, inner[s]);
    for (Eigen::Index k = 0; k < kernel.cols(); ++k)
      EXPECT_LT(clusters.subdomains()[s]->apply(kernel.col(k)).norm(), 1e-10 * clusters.subdomains()[s]->diagonal().norm());
  }
  EXPECT_LE(work.norm(), 1e-10 * norm(inner));
  for (std::size_t s = 0; s < inner.size(); ++s)
    EXPECT_LT(
        (gram.middleRows(clusters.first(s), clusters.modes()) - Eigen::MatrixXd::Identity(clusters.modes(), clusters.modes()))
            .norm(),
        1e-12);
}

INSTANTIATE_TEST_SUITE_P(
    Clusters, Answers,
    testing::Values(Setting{"solid", fem::Kinematics::solid, "hex8", {8, 4, 4}, {4, 2, 2}, 8},
                    Setting{"pairs", fem::Kinematics::solid, "hex8", {8, 2, 2}, {4, 1, 1}, 2},
                    Setting{"single_cells", fem::Kinematics::solid, "hex8", {6, 3, 3}, {6, 3, 3}, 27},  // rows depend on others
                    Setting{"second_order", fem::Kinematics::solid, "tet10", {4, 2, 2}, {4, 2, 2}, 8},
                    Setting{"plane", fem::Kinematics::plane_strain, "quad4", {8, 8, 1}, {4, 4, 1}, 4},
                    Setting{"rings", fem::Kinematics::axisymmetric, "quad4", {8, 8, 1}, {4, 4, 1}, 4}));

// Clusters that are copies share one factor: their answers to copies of a load are the same.
TEST(Clusters, OfCopiesAnswerAlike)
{
  const Communicator alone(MPI_COMM_SELF);
  mesh::Options mesh;
  mesh.blocks["block"] = {{0.5, 0, 1}, {2, 1, 1}, {24, 12, 12}, "hex8"};  // no coordinate is exact
  partition::Options options;
  options.method = "grid";
  options.counts["block"] = {12, 6, 6};
  options.subdomains_per_cluster = 8;
  const auto d = partition::cut_of(mesh, options, alone);
  ASSERT_EQ(d.cluster_count(), 54);
  const auto& cells = d.subdomains.front().mesh;
  const auto k = fem::stiffness(cells, fem::Material{1, 0.3, 0, 0}, fem::Kinematics::solid);
  const auto make = [&] {
    return std::make_shared<ElasticSubdomain>(k, fem::rigid_motions(cells.points, fem::Kinematics::solid), cells.points, 3,
                                              "cholmod");
  };
  const std::vector<std::vector<double>> weight(d.subdomains.size(), nodal_stiffness(k.diagonal(), 3));
  const partition::NodeDirectory directory(d, weight, alone);
  const auto interface = partition::find_interface(d, directory, alone);
  Subdomains own;
  for (std::size_t s = 0; s < d.subdomains.size(); ++s) own.push_back(make());
  const Clusters shared(d, interface, Subdomains(d.subdomains.size(), make()), weight, fem::Kinematics::solid);
  const Clusters apart(d, interface, own, weight, fem::Kinematics::solid);
  EXPECT_EQ(shared.kinds(), 1U);
  EXPECT_EQ(apart.kinds(), 54U);
  std::vector<Eigen::VectorXd> u;
  for (std::size_t s = 0; s < d.subdomains.size(); ++s)
    u.emplace_back(Eigen::VectorXd::LinSpaced(k.cols(), static_cast<double>(s), 1).array().sin());
  auto v = u;
  shared.apply_inverse(u);
  apart.apply_inverse(v);
  for (std::size_t s = 0; s < u.size(); ++s) EXPECT_LT((u[s] - v[s]).norm(), 1e-9 * v[s].norm()) << s;
}

}  // namespace
}  // namespace mortise::feti
