// Which nodes lie on planes of symmetry, and which on faces without shear, beside what loads, supports and contacts do there. The
// same on any ranks.
#include "analysis/symmetric_nodes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "model/resolution.hpp"
#include "partition/decompose.hpp"
#include "testing/cut.hpp"

namespace mortise::analysis {
namespace {

constexpr double pi = 3.14159265358979323846;

// Two blocks of 2 x 2 x 2 cells, the upper one on the lower; corners at 0, 0.5 and 1, the upper one's up to 2.
const std::string two_blocks = R"(
mesh:
  blocks:
    lower: {size: [1, 1, 1], cells: [2, 2, 2]}
    upper: {origin: [0, 0, 1], size: [1, 1, 1], cells: [2, 2, 2]}
materials: {steel: {young_modulus: 1000, poisson_ratio: 0.3}}
bodies: {lower: {material: steel}, upper: {material: steel}}
decomposition: {method: grid, counts: {lower: [2, 1, 1], upper: [1, 2, 1]}}
)";
const std::string ground = "  - {boundary: lower.zmin, displacement: {x: 0, y: 0, z: 0}}\n";
const std::string quarter = "supports:\n" + ground + R"(
  - {name: lower_x, boundary: lower.xmin, displacement: {x: 0}}
  - {name: upper_x, boundary: upper.xmin, displacement: {x: 0}}
  - {boundary: lower.ymin, displacement: {y: 0}}
  - {boundary: upper.ymin, displacement: {y: 0}}
)";
const std::string pressed = "loads:\n  - {boundary: upper.zmax, pressure: 2}\n";

// The normals of each node that has some, by body, place and order; of the state after `steps`.
class Found {
 public:
  using Nodes = std::vector<std::vector<post::SymmetricNode>> post::SymmetricNodes::*;
  explicit Found(const std::string& text, int dimension = 3, std::size_t steps = 1,
                 Nodes wanted = &post::SymmetricNodes::mirrored)
  {
    const Quiet quiet;
    const auto& context = quiet.context;
    deck::Document document(text, "deck.yaml", {});
    const auto deck = model::read_deck(document, "");
    document.check();
    const auto resolved =
        model::resolve(deck, document, partition::decompose(deck.mesh, deck.decomposition, dimension, context), context);
    const model::Model model(deck, resolved.contacts, resolved.decomposition, resolved.temperatures);
    const auto directory = partition::even_directory(resolved.decomposition, comm_);
    const auto interface = partition::find_interface(resolved.decomposition, directory, comm_);
    const auto state = model::load_states(deck, resolved.contacts).at(steps - 1);
    const auto rows = place(make_rows(model, state, {}, context), model, directory, {}, comm_);
    const auto nodes = find_symmetric_nodes(model, rows, directory, interface, comm_).*wanted;
    struct Normal {
      int body;
      std::array<double, 3> at, normal;
      double traction;
      Global subdomain;
    };
    std::vector<Normal> own;
    for (std::size_t s = 0; s < nodes.size(); ++s)
      for (const auto& node : nodes[s])
        for (std::size_t k = 0; k < node.normals.size(); ++k) {
          const Point& n = node.normals[k];
          const auto& subdomain = resolved.decomposition.subdomains[s];
          const Point& x = subdomain.mesh.points[static_cast<std::size_t>(node.node)];
          own.push_back({subdomain.body,
                         {x[0], x[1], x[2]},
                         {n[0], n[1], n[2]},
                         node.tractions.empty() ? 0 : node.tractions[k],
                         subdomain.id});
        }
    std::map<std::pair<int, std::array<double, 3>>, std::map<Global, std::vector<Point>>> copies;
    for (const auto& n : comm_.all_gather(own)) {
      copies[{n.body, n.at}][n.subdomain].emplace_back(n.normal[0], n.normal[1], n.normal[2]);
      tractions_[{n.body, n.at}].emplace_back(Point(n.normal[0], n.normal[1], n.normal[2]), n.traction);
    }
    for (const auto& [at, of] : copies) {
      normals_[at] = of.begin()->second;
      for (const auto& [subdomain, normals] : of) EXPECT_EQ(normals, of.begin()->second);
    }
    for (std::size_t s = 0; s < nodes.size(); ++s)  // every copy has them
      for (std::size_t i = 0; i < interface.nodes[s].size(); ++i) {
        const auto& subdomain = resolved.decomposition.subdomains[s];
        const Point& x = subdomain.mesh.points[static_cast<std::size_t>(interface.nodes[s][i])];
        const auto found = copies.find({subdomain.body, {x[0], x[1], x[2]}});
        if (found == copies.end()) continue;
        EXPECT_EQ(found->second.size(), interface.copies[s][i].size());
      }
  }

  std::size_t size() const { return normals_.size(); }
  std::vector<Point> at(int body, double x, double y, double z) const
  {
    const auto found = normals_.find({body, {x, y, z}});
    return found == normals_.end() ? std::vector<Point>() : found->second;
  }
  // The traction along a normal that is found there, of all copies.
  double traction(int body, const Point& x, const Point& normal) const
  {
    std::vector<double> values;
    for (const auto& [n, value] : tractions_.at({body, {x[0], x[1], x[2]}}))
      if ((n - normal).norm() < 1e-9) values.push_back(value);
    EXPECT_FALSE(values.empty());
    for (const double value : values) EXPECT_EQ(std::isnan(value), std::isnan(values[0])) << value;
    for (const double value : values)
      if (!std::isnan(value)) EXPECT_EQ(value, values[0]);
    return values.empty() ? 0 : values[0];
  }
  // How many of a body's nodes are on a plane with this normal.
  int on(int body, const Point& normal) const
  {
    int count = 0;
    for (const auto& [at, normals] : normals_)
      for (const Point& n : normals) count += at.first == body && (n - normal).norm() < 1e-9;
    return count;
  }

 private:
  Communicator comm_;
  std::map<std::pair<int, std::array<double, 3>>, std::vector<Point>> normals_;
  std::map<std::pair<int, std::array<double, 3>>, std::vector<std::pair<Point, double>>> tractions_;
};

const Point along_x = Point::UnitX(), along_y = Point::UnitY();

TEST(SymmetricNodes, TwoPlanesMeetInAnEdge)
{
  const Found found(two_blocks + quarter + pressed);
  for (const int body : {0, 1}) {
    EXPECT_EQ(found.on(body, -along_x), 9);
    EXPECT_EQ(found.on(body, -along_y), 9);
  }
  EXPECT_EQ(found.size(), 2U * 15);
  EXPECT_EQ(found.at(0, 0, 0, 0.5), (std::vector<Point>{-along_x, -along_y}));
  EXPECT_EQ(found.at(0, 0, 0, 0), (std::vector<Point>{-along_x, -along_y}));  // what is clamped is so beyond the plane as well
  EXPECT_EQ(found.at(1, 0.5, 0, 2), (std::vector<Point>{-along_y}));
}

// What a load shears along the normal of one plane it shears along the other.
TEST(SymmetricNodes, LoadsAlongTheNormal)
{
  const Found pushed(two_blocks + quarter + "loads:\n  - {boundary: upper.zmax, traction: [1, 0, -2]}\n");
  EXPECT_EQ(pushed.on(1, -along_x), 6);
  EXPECT_EQ(pushed.on(1, -along_y), 9);
  const Found rounded(two_blocks + quarter + "loads:\n  - {boundary: upper.zmax, traction: [1.0e-15, 0, -2]}\n");
  EXPECT_EQ(rounded.on(1, -along_x), 9);
  const Found along(two_blocks + quarter + "loads:\n  - {boundary: upper.xmin, traction: [1, 0, -2]}\n");
  EXPECT_EQ(along.on(1, -along_x), 0);
  EXPECT_EQ(along.on(1, -along_y), 9);
  const Found across(two_blocks + quarter + "loads:\n  - {boundary: upper.xmin, force: [1, 0, 0]}\n");
  EXPECT_EQ(across.on(1, -along_x), 9);
}

TEST(SymmetricNodes, OtherSupports)
{
  const Found twice(two_blocks + quarter + "  - {boundary: upper.xmin, displacement: {z: 0}}\n" + pressed);
  EXPECT_EQ(twice.on(1, -along_x), 0);
  EXPECT_EQ(twice.on(1, -along_y), 9);
  EXPECT_EQ(twice.on(0, -along_x), 9);
  const Found springs(two_blocks + quarter + "  - {boundary: upper.xmin, stiffness: {z: 5}}\n" + pressed);
  EXPECT_EQ(springs.on(1, -along_x), 0);
  const Found beside(two_blocks + quarter + "  - {boundary: upper.zmax, stiffness: {x: 5, z: 5}}\n" + pressed);
  EXPECT_EQ(beside.on(1, -along_x), 9);
  const Found moved(two_blocks + "supports:\n" + ground + "  - {boundary: upper.xmax, displacement: {x: 0.1}}\n" + pressed);
  EXPECT_EQ(moved.on(1, along_x), 9);
  EXPECT_EQ(moved.size(), 9U);
  const Found coupled(two_blocks + quarter + pressed + "couplings: {top: {boundary: upper.zmax, point: [0, 0, 2]}}\n");
  EXPECT_EQ(coupled.on(1, -along_x), 6);
}

TEST(SymmetricNodes, AreThoseOfTheLoadStep)
{
  const auto steps = two_blocks + quarter + pressed + "steps: [{name: on}, {name: off, off: [upper_x]}]\n";
  EXPECT_EQ(Found(steps, 3, 1).on(1, -along_x), 9);
  EXPECT_EQ(Found(steps, 3, 2).on(1, -along_x), 0);
}

// Friction along the normal is none where supports hold both sides.
TEST(SymmetricNodes, Contacts)
{
  const std::string rubs = "contacts: [{secondary: upper.zmin, primary: lower.zmax, friction: {coulomb: 0.5}}]\n",
                    glued = "contacts: [{secondary: upper.zmin, primary: lower.zmax, friction: {bonded: true}}]\n";
  for (const auto& contact : {rubs, glued}) {
    const Found both(two_blocks + quarter + pressed + contact);
    EXPECT_EQ(both.on(0, -along_x), 9);
    EXPECT_EQ(both.on(1, -along_x), 9);
  }
  for (const std::string body : {"lower", "upper"}) {
    const auto one = two_blocks + "supports:\n" + ground + "  - {boundary: " + body + ".xmin, displacement: {x: 0}}\n" + pressed;
    const int held = body == "lower" ? 0 : 1;
    EXPECT_EQ(Found(one).on(held, -along_x), 9);
    EXPECT_EQ(Found(one + rubs).on(held, -along_x), 6) << body;
    if (held == 1) {
      EXPECT_EQ(Found(one + glued).on(held, -along_x), 6);
    }
    EXPECT_EQ(Found(one + "contacts: [{secondary: upper.zmin, primary: lower.zmax}]\n").on(held, -along_x), 9) << body;
  }
}

// Normals, and local axes.
TEST(SymmetricNodes, Askew)
{
  const std::string turned = R"(
mesh: {blocks: {part: {size: [1, 1, 1], cells: [2, 2, 2]}}}
materials: {steel: {young_modulus: 1000, poisson_ratio: 0.3}}
bodies: {part: {material: steel, instances: [{rotate: {axis: [0, 0, 1], angle: 30}}]}}
axes: {askew: {x: [0.8660254037844387, 0.5, 0], y: [0, 1, 0]}}
)";
  const Point normal(-std::cos(pi / 6), -std::sin(pi / 6), 0), across(std::sin(pi / 6), -std::cos(pi / 6), 0);
  const Found found(turned + R"(
supports:
  - {boundary: part.xmin, displacement: {normal: 0}}
  - {boundary: part.ymin, axes: askew, displacement: {y: 0}}
  - {boundary: part.zmin, displacement: {z: 0}}
)");
  EXPECT_EQ(found.on(0, normal), 9);
  EXPECT_EQ(found.on(0, across), 9);
  EXPECT_EQ(found.on(0, -Point::UnitZ()), 9);
  EXPECT_EQ(Found(turned + "supports: [{boundary: part.xmin, displacement: {x: 0}}]\n").size(), 0U);
}

// What is held along the normals of a curved surface may be sheared along each of its facets.
TEST(SymmetricNodes, CurvedSurfaces)
{
  const std::string ring = R"(
dimension: plane_strain
mesh: {file: )" MORTISE_SOURCE_DIR R"(/regression/cases/quarter_ring.geo, constants: {n: 2}}
materials: {steel: {young_modulus: 1000, poisson_ratio: 0.3}}
bodies: {ring: {material: steel}}
supports:
  - {boundary: along_x, displacement: {y: 0}}
  - {boundary: along_y, displacement: {normal: 0}}
)";
  for (const std::string bore : {"", "  - {boundary: bore, displacement: {normal: 0}}\n"}) {
    const Found found(ring + bore, 2);
    EXPECT_EQ(found.on(0, -along_x), 5) << bore;
    EXPECT_EQ(found.on(0, -along_y), 5) << bore;
    EXPECT_EQ(found.size(), 10U) << bore;
  }
}

// Where the body reaches beyond the plane stress has no limit, nor in an edge of 120 degrees.
TEST(SymmetricNodes, EdgesOfMoreThanARightAngle)
{
  const std::string part = R"(
dimension: plane_strain
mesh: {file: )" MORTISE_SOURCE_DIR R"(/lib/analysis/test/ledge.geo}
materials: {steel: {young_modulus: 1000, poisson_ratio: 0.3}}
bodies: {part: {material: steel}}
supports:
)";
  const Found ledge(part + "  - {boundary: ledge, displacement: {y: 0}}\n", 2);
  EXPECT_EQ(ledge.on(0, along_y), 2);
  EXPECT_TRUE(ledge.at(0, 1, 1, 0).empty());
  const std::string foot = "  - {boundary: foot, displacement: {y: 0}}\n";
  EXPECT_EQ(Found(part + foot, 2).on(0, -along_y), 5);
  const Found right(part + foot + "  - {boundary: side, displacement: {normal: 0}}\n", 2);
  EXPECT_EQ(right.on(0, -along_y), 5);
  EXPECT_EQ(right.on(0, along_x), 3);
  const Found blunt(part + foot + "  - {boundary: flank, displacement: {normal: 0}}\n", 2);
  EXPECT_TRUE(blunt.at(0, 0, 0, 0).empty());
  EXPECT_EQ(blunt.on(0, -along_y), 4);  // those of faces away from the edge
}

// On the axis of revolution stress is the same all round; of the end that a support holds, too.
TEST(SymmetricNodes, TheAxisOfRevolution)
{
  const Found found(R"(
dimension: axisymmetric
mesh: {blocks: {disc: {size: [1, 1], cells: [2, 2], element: quad4}}}
materials: {steel: {young_modulus: 1000, poisson_ratio: 0.3}}
bodies: {disc: {material: steel}}
supports: [{boundary: disc.ymin, displacement: {y: 0}}]
)",
                    2);
  EXPECT_EQ(found.on(0, -along_x), 3);
  EXPECT_EQ(found.on(0, -along_y), 3);
  EXPECT_EQ(found.at(0, 0, 1, 0).size(), 2U);
  EXPECT_EQ(found.at(0, 0, 0, 0).size(), 3U);
}

// Beside faces that are clamped, pulled along themselves or bonded something may shear; pressure does not.
TEST(ShearFreeNodes, BlocksOnEachOther)
{
  const auto nodes = &post::SymmetricNodes::shear_free;
  const Found found(two_blocks + "supports:\n" + ground + pressed, 3, 1, nodes);
  EXPECT_EQ(found.size(), 26U - 9U + 26U);
  EXPECT_EQ(found.on(0, along_x), 6);
  EXPECT_EQ(found.on(1, -along_y), 9);
  EXPECT_EQ(found.at(1, 0.5, 0.5, 2), std::vector<Point>{Point::UnitZ()});
  EXPECT_EQ(found.at(1, 1, 0.5, 2).size(), 2U);
  EXPECT_EQ(found.at(1, 1, 1, 2).size(), 3U);
  const Found pulled(two_blocks + "supports:\n" + ground + "loads: [{boundary: upper.zmax, traction: [1, 0, 0]}]\n", 3, 1, nodes);
  EXPECT_EQ(pulled.size(), 26U - 9U + 26U - 9U);
  EXPECT_EQ(pulled.on(1, along_x), 6);
  const Found slides(two_blocks + quarter + pressed, 3, 1, nodes);
  EXPECT_EQ(slides.on(1, -along_x), 9);
  for (const std::string law : {"", ", friction: {bonded: true}"}) {
    const Found joined(
        two_blocks + "supports:\n" + ground + "contacts: [{secondary: upper.zmin, primary: lower.zmax" + law + "}]\n" + pressed,
        3, 1, nodes);
    EXPECT_EQ(joined.size(), 26U - 9U - 9U + 26U - 9U) << law;
  }
}

// Faces of a curved surface have one normal together; at a reentrant edge there is none.
// Loads add up; what holds or pushes along the normal leaves the traction unknown.
TEST(ShearFreeNodes, TractionsAcrossFaces)
{
  const auto shear_free = &post::SymmetricNodes::shear_free;
  const Point along_z = Point::UnitZ();
  const Found found(two_blocks + quarter + "  - {boundary: upper.ymax, stiffness: {normal: 5}}\n" +
                        "loads:\n  - {boundary: upper.zmax, pressure: \"2+x\"}\n  - {boundary: upper.zmax, pressure: 1}\n",
                    3, 1, shear_free);
  EXPECT_NEAR(found.traction(1, {0.5, 0.5, 2}, along_z), -3.5, 1e-12);
  EXPECT_NEAR(found.traction(1, {1, 0.5, 2}, along_z), -4, 1e-12);
  EXPECT_EQ(found.traction(1, {1, 0.5, 2}, along_x), 0);
  EXPECT_EQ(found.traction(1, {1, 0.5, 1.5}, along_x), 0);
  EXPECT_TRUE(std::isnan(found.traction(1, {0.5, 0, 1.5}, -along_y)));
  EXPECT_TRUE(std::isnan(found.traction(1, {0.5, 1, 1.5}, along_y)));
  EXPECT_NEAR(found.traction(1, {0.5, 1, 2}, along_z), -3.5, 1e-12);
}

TEST(ShearFreeNodes, EdgesAndCurvedSurfaces)
{
  const auto nodes = &post::SymmetricNodes::shear_free;
  const std::string steel = "materials: {steel: {young_modulus: 1000, poisson_ratio: 0.3}}\n";
  const Found ledge("dimension: plane_strain\nmesh: {file: " MORTISE_SOURCE_DIR "/lib/analysis/test/ledge.geo}\n" + steel +
                        "bodies: {part: {material: steel}}\n",
                    2, 1, nodes);
  EXPECT_TRUE(ledge.at(0, 1, 1, 0).empty());
  EXPECT_TRUE(ledge.at(0, 0, 0, 0).empty());  // 120 degrees
  EXPECT_EQ(ledge.at(0, 2, 0, 0).size(), 2U);
  const Found ring("dimension: plane_strain\nmesh: {file: " MORTISE_SOURCE_DIR
                   "/regression/cases/quarter_ring.geo, constants: {n: 2}}\n" +
                       steel + "bodies: {ring: {material: steel}}\nsupports: [{boundary: along_x, displacement: {x: 0, y: 0}}]\n",
                   2, 1, nodes);
  EXPECT_EQ(ring.size(), 24U - 5U);
  EXPECT_EQ(ring.on(0, -along_x), 5);
}

}  // namespace
}  // namespace mortise::analysis
