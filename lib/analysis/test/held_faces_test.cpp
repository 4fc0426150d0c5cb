// Which faces reach from one held side of a body to another, beside what supports, loads and contacts do there. The same on any
// ranks.
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "analysis/symmetric_nodes.hpp"
#include "model/resolution.hpp"
#include "partition/decompose.hpp"
#include "testing/cut.hpp"

namespace mortise::analysis {
namespace {

// A pad of 2 x 2 x 1 cells between the ground and a plate.
const std::string between = R"(
mesh:
  blocks:
    pad: {size: [2, 2, 1], cells: [2, 2, 1]}
    plate: {origin: [0, 0, 1], size: [2, 2, 1], cells: [2, 2, 2]}
materials: {m: {young_modulus: 1000, poisson_ratio: 0.3}}
bodies: {pad: {material: m}, plate: {material: m}}
decomposition: {method: grid, counts: {pad: [2, 1, 1], plate: [1, 2, 1]}}
supports:
  - {boundary: pad.zmin, displacement: {x: 0, y: 0, z: 0}}
)";

std::string contact(const std::string& law)
{
  return "contacts: [{secondary: pad.zmax, primary: plate.zmin" + (law.empty() ? "" : ", friction: {" + law + "}") + "}]\n";
}

// The faces of all ranks, by their middles.
class HeldFaces {
 public:
  explicit HeldFaces(const std::string& text)
  {
    const Quiet quiet;
    const auto& context = quiet.context;
    const Communicator comm;
    deck::Document document(text, "deck.yaml", {});
    const auto deck = model::read_deck(document, "");
    document.check();
    const auto resolved =
        model::resolve(deck, document, partition::decompose(deck.mesh, deck.decomposition, 3, context), context);
    const model::Model model(deck, resolved.contacts, resolved.decomposition, resolved.temperatures);
    const auto directory = partition::even_directory(resolved.decomposition, comm);
    const auto interface = partition::find_interface(resolved.decomposition, directory, comm);
    const auto state = model::load_states(deck, resolved.contacts).at(0);
    const auto rows = place(make_rows(model, state, {}, context), model, directory, {}, comm);
    const auto nodes = find_symmetric_nodes(model, rows, directory, interface, comm);
    struct Face {
      std::array<double, 3> middle;
      double traction;
      bool slides, ends_inside, across_z;
    };
    std::vector<Face> own;
    for (std::size_t s = 0; s < nodes.held_faces.size(); ++s)
      for (const auto& face : nodes.held_faces[s]) {
        const auto& mesh = resolved.decomposition.subdomains[s].mesh;
        const auto c = static_cast<std::size_t>(face.cell);
        Point middle = Point::Zero();
        for (const int k : mesh::faces(mesh.cells.type[c])[static_cast<std::size_t>(face.face)].nodes)
          middle += mesh.points[static_cast<std::size_t>(mesh.cells[c][static_cast<std::size_t>(k)])] / 4;
        own.push_back(
            {{middle[0], middle[1], middle[2]}, face.traction, face.slides, face.ends_inside, std::abs(face.across[2]) > 0.9});
      }
    for (const auto& face : comm.all_gather(own)) {
      EXPECT_TRUE(face.across_z);
      if (face.ends_inside) {
        EXPECT_FALSE(face.slides);
        (face.middle[2] > 1 ? of_plate_ : of_pad_)++;
        continue;
      }
      EXPECT_LT(face.middle[2], 1);
      tractions_.emplace(face.middle, face.traction);
      slide_ += face.slides;
    }
  }

  std::size_t size() const { return tractions_.size(); }
  std::size_t sliding() const { return slide_; }
  // Outer ones with nodes on one side alone.
  int of_pad() const { return of_pad_; }
  int of_plate() const { return of_plate_; }
  // Between cells; of outer ones with this traction.
  auto inside() const
  {
    return std::ranges::count_if(tractions_, [](const auto& face) { return std::isnan(face.second); });
  }
  auto with(double traction) const
  {
    return std::ranges::count_if(tractions_, [&](const auto& face) { return std::abs(face.second - traction) < 1e-12; });
  }

 private:
  std::multimap<std::array<double, 3>, double> tractions_;
  std::size_t slide_ = 0;
  int of_pad_ = 0, of_plate_ = 0;
};

// Four cells have two faces each between them, and two at the ends.
TEST(HeldFaces, OfAPadThatIsBonded)
{
  const HeldFaces found(between + contact("bonded: true"));
  EXPECT_EQ(found.size(), 16U);
  EXPECT_EQ(found.inside(), 8);
  EXPECT_EQ(found.with(0), 8);
  EXPECT_EQ(found.sliding(), 0U);
  EXPECT_EQ(found.of_pad(), 0);
  EXPECT_EQ(found.of_plate(), 8);
}

TEST(HeldFaces, OfContacts)
{
  EXPECT_EQ(HeldFaces(between + contact("coulomb: 0.3")).sliding(), 0U);
  const HeldFaces smooth(between + contact(""));
  EXPECT_EQ(smooth.size(), 16U);
  EXPECT_EQ(smooth.sliding(), 16U);
  EXPECT_EQ(smooth.of_plate(), 0);
  const HeldFaces alone(between);
  EXPECT_EQ(alone.size(), 0U);
  EXPECT_EQ(alone.of_pad(), 8);
}

TEST(HeldFaces, Supports)
{
  const HeldFaces both(between + "  - {boundary: pad.zmax, displacement: {x: 0, y: 0.1, z: 0}}\n");
  EXPECT_EQ(both.size(), 16U);
  EXPECT_EQ(both.sliding(), 0U);
  // Nodes that slide along supports are no contact's.
  EXPECT_EQ(HeldFaces(between + "  - {boundary: pad.zmax, displacement: {z: 0}}\n").size(), 0U);
  // Planes of symmetry.
  const HeldFaces quarter(between +
                          "  - {boundary: pad.xmin, displacement: {x: 0}}\n"
                          "  - {boundary: pad.ymin, displacement: {y: 0}}\n" +
                          contact("bonded: true"));
  EXPECT_EQ(quarter.inside(), 8);
  EXPECT_EQ(quarter.with(0), 4);
}

TEST(HeldFaces, Loads)
{
  const std::string bonded = contact("bonded: true") + "loads:\n";
  const HeldFaces pressed(between + bonded +
                          "  - {boundary: pad.xmax, pressure: 1 + y}\n  - {boundary: pad.xmax, pressure: 1}\n");
  EXPECT_EQ(pressed.size(), 16U);
  EXPECT_EQ(pressed.with(-2.5), 1);
  EXPECT_EQ(pressed.with(-3.5), 1);
  EXPECT_EQ(pressed.with(0), 6);
  EXPECT_EQ(HeldFaces(between + bonded + "  - {boundary: pad.xmax, traction: [1, 0, 0]}\n").size(), 14U);
}

}  // namespace
}  // namespace mortise::analysis
