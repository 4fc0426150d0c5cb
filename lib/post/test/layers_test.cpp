// The claimed error of pads between two held sides, whose displacements are given. The same on any ranks.
#include <gtest/gtest.h>

#include "post/stress_recovery.hpp"
#include "testing/cut.hpp"

namespace mortise::post {
namespace {

constexpr double pad_width = 20, pad_height = 4, pad_nu = 0.499;

// A pad of quad4 in subdomains along x, pressed by a strain of 1e-3, with its two faces at the ends.
struct LayeredPad {
  Communicator comm;
  partition::Decomposition decomposition;
  std::unique_ptr<partition::NodeDirectory> directory;
  partition::Interface interface;
  std::vector<fem::Constitution> constitution;
  std::vector<Eigen::VectorXd> displacement;
  SymmetricNodes symmetric;

  explicit LayeredPad(int layers)
  {
    mesh::Options mesh;
    auto& block = mesh.blocks["pad"];
    block.element = "quad4";
    block.size = {pad_width, pad_height, 0};
    block.cells = {6, layers, 1};
    partition::Options options;
    options.method = "grid";
    options.counts["pad"] = {3, 1, 1};
    decomposition = partition::cut_of(mesh, options, comm, 2);
    for (const auto& s : decomposition.subdomains) {
      constitution.push_back({fem::Material{5, pad_nu, 0, 0}, fem::Formulation::bbar});
      auto& u = displacement.emplace_back(Eigen::VectorXd::Zero(2 * static_cast<Eigen::Index>(s.mesh.node_count())));
      for (std::size_t n = 0; n < s.mesh.node_count(); ++n) u[2 * static_cast<Eigen::Index>(n) + 1] = -1e-3 * s.mesh.points[n][1];
      auto& faces = symmetric.held_faces.emplace_back();
      for (std::size_t c = 0; c < s.mesh.cells.size(); ++c)
        for (std::size_t f = 0; f < 4; ++f) {
          double least = pad_width, most = 0;
          for (const int k : mesh::faces(mesh::CellType::quad4)[f].nodes) {
            const double x = s.mesh.points[static_cast<std::size_t>(s.mesh.cells[c][static_cast<std::size_t>(k)])][0];
            least = std::min(least, x);
            most = std::max(most, x);
          }
          if (most < 1e-9 || least > pad_width - 1e-9)
            faces.push_back({static_cast<Local>(c), static_cast<int>(f), Point::UnitY(), 0, false, false});
        }
    }
    directory = std::make_unique<partition::NodeDirectory>(partition::even_directory(decomposition, comm));
    interface = partition::find_interface(decomposition, *directory, comm);
  }
  // Over the squared norm.
  double error(std::span<const Global> loose = {}) const
  {
    ElasticBodies bodies{decomposition, interface, fem::Kinematics::plane_strain, constitution, 1};
    bodies.symmetric = &symmetric;
    const auto field = recover_stress(bodies, displacement, comm, loose);
    return field.squared_error / (2 * field.strain_energy);
  }
};

// As if the layer went on without end it would lack more than it has. Only cells at its ends count for its norm here.
TEST(Layers, BetweenHeldSides)
{
  const double bulk = 5 / (3 * (1 - 2 * pad_nu)), mu = 5 / (2 * (1 + pad_nu)), uniaxial = bulk + 4 * mu / 3,
               t = bulk - 2 * mu / 3;
  const double endless = 2 * pad_height * t * t / std::sqrt(12 * mu * uniaxial) / (pad_width * uniaxial), at_ends = 2.0 / 6;
  EXPECT_NEAR(LayeredPad(1).error(), endless * std::tanh(at_ends / endless), 1e-9);
  EXPECT_LT(LayeredPad(2).error(), 1e-20);  // nodes between the sides are free
}

// Where nodes slide, cells relieve more themselves; any rank may know that they do.
TEST(Layers, LooseNodes)
{
  const LayeredPad pad(1);
  std::vector<Global> loose;
  for (const auto& s : pad.decomposition.subdomains)
    for (std::size_t n = 0; n < s.mesh.node_count(); ++n)
      if (s.mesh.points[n][0] < 1e-9) loose.push_back(s.mesh.node_id[n]);
  EXPECT_GT(pad.error(loose), 1.001 * pad.error());
}

}  // namespace
}  // namespace mortise::post
