#include "cut_faces.hpp"

#include <algorithm>

namespace mortise::contact {

CutFaces::CutFaces(const Side& side, const SurfaceNodes& surface_nodes, const std::vector<char>& own)
    : side_(side), nodes_(surface_nodes), begin_(side.faces.size(), 0), end_(side.faces.size(), 0)
{
  std::vector<char> touched = own;
  const auto touches = [&](std::size_t f) {
    const auto nodes = side.faces[f];
    return std::any_of(nodes.begin(), nodes.end(), [&](Local n) { return touched[static_cast<std::size_t>(n)] != 0; });
  };
  for (std::size_t f = 0; f < side.faces.size(); ++f)
    if (touches(f)) near_.push_back(f);
  for (const std::size_t f : near_)
    for (const Local n : side.faces[f]) touched[static_cast<std::size_t>(n)] = 1;
  for (std::size_t f = 0; f < side.faces.size(); ++f)
    if (touches(f)) round_.push_back(f);
}

void CutFaces::add(std::size_t face, std::span<const PieceIntegrals> pieces)
{
  begin_[face] = store_.size();
  for (const auto& piece : pieces) store_.add(piece);
  end_[face] = store_.size();
}

std::size_t CutFaces::place_of(std::size_t face, const PieceStore::View& piece, Eigen::Index k) const
{
  auto node = static_cast<std::size_t>(k);
  if (piece.facet >= 0) node = static_cast<std::size_t>(side_.corners[static_cast<std::size_t>(piece.facet)][node]);
  return static_cast<std::size_t>(surface_nodes_of(face)[node]);
}

void CutFaces::sort_by_nodes()
{
  first_.assign(nodes_.all.size() + 1, 0);
  const auto each = [&](const auto& use) {
    for (const std::size_t f : near_)
      for (const std::size_t i : pieces(f)) {
        const auto piece = store_[i];
        for (Eigen::Index k = 0; k < piece.covered.size(); ++k) use(place_of(f, piece, k), Function{f, i, k});
      }
  };
  each([&](std::size_t p, const Function&) { ++first_[p + 1]; });
  for (std::size_t p = 0; p < nodes_.all.size(); ++p) first_[p + 1] += first_[p];
  functions_.resize(first_.back());
  auto next = first_;
  each([&](std::size_t p, const Function& function) { functions_[next[p]++] = function; });
}

}  // namespace mortise::contact
