#include "model/indefinite.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace mortise::model {

namespace {

// What double precision still bears, found by trying: the matrices' condition grows with the square of the first, ..
constexpr double slender = 1000, graded = 1e5;
// .. with the inverse of the distance to 0.5, and with the ratio of stiffnesses.
constexpr double nearly_incompressible = 0.4999999, stiff = 1e9;

struct Lengths {
  double shortest = std::numeric_limits<double>::infinity(), longest = 0;
  double slenderest = 1;  // longest to shortest edge of one cell
};

// Edges between corners, as the faces of the cells have them.
Lengths edge_lengths(const mesh::Mesh& mesh)
{
  Lengths all;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    const auto nodes = mesh.cells[c];
    Lengths cell;
    for (const auto& face : mesh::faces(mesh.cells.type[c])) {
      const auto corners = static_cast<std::size_t>(mesh::corner_count(face.type));
      for (std::size_t i = 0; i < corners; ++i) {
        const auto place = [&](std::size_t k) {
          return mesh.points[static_cast<std::size_t>(nodes[static_cast<std::size_t>(face.nodes[k % corners])])];
        };
        const double length = (place(i) - place(i + 1)).norm();
        cell.shortest = std::min(cell.shortest, length);
        cell.longest = std::max(cell.longest, length);
      }
    }
    all.shortest = std::min(all.shortest, cell.shortest);
    all.longest = std::max(all.longest, cell.longest);
    all.slenderest = std::max(all.slenderest, cell.longest / cell.shortest);
  }
  return all;
}

}  // namespace

std::string why_indefinite(const partition::Subdomain& subdomain, const fem::Materials& materials, const std::string& name)
{
  std::string causes;
  const auto cause = [&](const std::string& text) { causes += "\n  " + text; };
  const auto edges = edge_lengths(subdomain.mesh);
  if (edges.slenderest >= slender)
    cause(fmt::format(
        "cells are up to {:.3g} times longer than thick (edges from {:.3g} to {:.3g}): mesh the thin parts finer along, "
        "or leave them out",
        edges.slenderest, edges.shortest, edges.longest));
  else if (edges.longest >= graded * edges.shortest)
    cause(fmt::format("edges of cells are from {:.3g} to {:.3g} long: mesh with cells of more equal sizes", edges.shortest,
                      edges.longest));
  double softest = std::numeric_limits<double>::infinity(), stiffest = 0;
  for (std::size_t c = 0; c < subdomain.mesh.cells.size(); ++c) {
    const auto& material = materials[materials.index(c)];
    softest = std::min(softest, material.modulus());
    stiffest = std::max(stiffest, material.modulus());
    if (material.poisson_ratio <= nearly_incompressible) continue;
    cause(fmt::format("Poisson's ratio is {}: take at most {}", material.poisson_ratio, nearly_incompressible));
    break;
  }
  if (stiffest >= stiff * softest)
    cause(fmt::format("Young's moduli are from {:.3g} to {:.3g}: make them less unlike, or tie two bodies by a bonded contact",
                      softest, stiffest));
  if (causes.empty())
    causes =
        fmt::format("\n  its edges are from {:.3g} to {:.3g} long: look for cells without volume", edges.shortest, edges.longest);
  return fmt::format("the stiffness matrix of the body \"{}\" is not positive definite to the accuracy of numbers; probably:{}",
                     name, causes);
}

}  // namespace mortise::model
