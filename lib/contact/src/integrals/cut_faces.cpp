#include "integrals/cut_faces.hpp"

#include <algorithm>

namespace mortise::contact {

CutFaces::CutFaces(const Side& side, const SurfaceNodes& surface_nodes, const std::vector<char>& own, int rings)
    : side_(side), nodes_(surface_nodes), begin_(side.faces.size(), 0), end_(side.faces.size(), 0)
{
  std::vector<char> touched = own;
  const auto touches = [&](std::size_t f) {
    const auto nodes = side.faces[f];
    return std::any_of(nodes.begin(), nodes.end(), [&](Local n) { return touched[static_cast<std::size_t>(n)] != 0; });
  };
  for (std::size_t f = 0; f < side.faces.size(); ++f)
    if (touches(f)) near_.push_back(f);
  round_ = near_;
  for (int ring = 0; ring < rings; ++ring) {
    for (const std::size_t f : round_)
      for (const Local n : side.faces[f]) touched[static_cast<std::size_t>(n)] = 1;
    round_.clear();
    for (std::size_t f = 0; f < side.faces.size(); ++f)
      if (touches(f)) round_.push_back(f);
  }
}

void CutFaces::add(std::size_t face, std::span<const PieceIntegrals> pieces)
{
  begin_[face] = store_.size();
  for (const auto& piece : pieces) store_.add(piece);
  end_[face] = store_.size();
}

std::size_t CutFaces::surface_node_of(std::size_t face, const PieceStore::View& piece, Eigen::Index k) const
{
  auto node = static_cast<std::size_t>(k);
  if (!piece.corner.empty() && piece.corner[node] >= 0)
    node = static_cast<std::size_t>(piece.beside[node]);
  else if (piece.facet >= 0)
    node = static_cast<std::size_t>(side_.corners[static_cast<std::size_t>(piece.facet)][node]);
  else if (node >= side_.faces[face].size())
    node = 0;  // of a corner without a function
  return static_cast<std::size_t>(surface_nodes_of(face)[node]);
}

std::size_t CutFaces::place_of(std::size_t face, const PieceStore::View& piece, Eigen::Index k) const
{
  const std::size_t p = surface_node_of(face, piece, k);
  if (piece.corner.empty() || piece.corner[static_cast<std::size_t>(k)] < 0) return p;
  const auto at = std::lower_bound(corners_.begin(), corners_.end(),
                                   std::pair(piece.corner[static_cast<std::size_t>(k)], static_cast<Local>(p)));
  return nodes_.all.size() + static_cast<std::size_t>(at - corners_.begin());
}

void CutFaces::number_corners()
{
  for (const std::size_t f : round_)
    for (const std::size_t i : pieces(f)) {
      const auto piece = store_[i];
      for (std::size_t k = 0; k < piece.corner.size(); ++k)
        if (piece.corner[k] >= 0)
          corners_.emplace_back(piece.corner[k], static_cast<Local>(surface_node_of(f, piece, static_cast<Eigen::Index>(k))));
    }
  std::sort(corners_.begin(), corners_.end());
  corners_.erase(std::unique(corners_.begin(), corners_.end()), corners_.end());
}

void CutFaces::sort_by_nodes()
{
  first_.assign(places() + 1, 0);
  const auto each = [&](const auto& use) {
    for (const std::size_t f : near_)
      for (const std::size_t i : pieces(f)) {
        const auto piece = store_[i];
        for (Eigen::Index k = 0; k < piece.covered.size(); ++k) use(place_of(f, piece, k), Function{f, i, k});
      }
  };
  each([&](std::size_t p, const Function&) { ++first_[p + 1]; });
  for (std::size_t p = 0; p < places(); ++p) first_[p + 1] += first_[p];
  functions_.resize(first_.back());
  auto next = first_;
  each([&](std::size_t p, const Function& function) { functions_[next[p]++] = function; });
}

}  // namespace mortise::contact
