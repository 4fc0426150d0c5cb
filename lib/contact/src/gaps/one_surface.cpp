#include "gaps/one_surface.hpp"

#include <algorithm>
#include <cmath>

#include "rows/by_node.hpp"

namespace mortise::contact {

namespace {

template <class Second>
void sort_uniquely(std::vector<std::pair<Local, Second>>& pairs)
{
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
}

// The entries of `first`.
template <class Second>
std::span<const std::pair<Local, Second>> entries(const std::vector<std::pair<Local, Second>>& pairs, Local first)
{
  const auto begin = std::lower_bound(pairs.begin(), pairs.end(), first, [](const auto& p, Local f) { return p.first < f; });
  const auto end = std::upper_bound(begin, pairs.end(), first, [](Local f, const auto& p) { return f < p.first; });
  return {begin, end};
}

bool equal(const mesh::CurvedSurface& a, const mesh::CurvedSurface& b)
{
  return a.point == b.point && a.axis == b.axis && a.radius == b.radius && a.slope == b.slope;
}

// Of each of `here` those of `there` that are the same.
std::vector<std::vector<int>> matches(const std::vector<mesh::CurvedSurface>& here, const std::vector<mesh::CurvedSurface>& there)
{
  std::vector<std::vector<int>> result(here.size());
  for (std::size_t h = 0; h < here.size(); ++h)
    for (std::size_t t = 0; t < there.size(); ++t)
      if (mesh::same(here[h], there[t])) result[h].push_back(static_cast<int>(t));
  return result;
}

}  // namespace

CurvedFaces::CurvedFaces(std::span<const CurvedFace> faces, const Communicator& comm)
{
  any_ = comm.any(!faces.empty());
  if (any_) own_ = by_node<CurvedFace>(faces, comm);
}

std::vector<int> CurvedFaces::of(const Side& side, std::vector<mesh::CurvedSurface>& surfaces, const Communicator& comm) const
{
  std::vector<int> result;
  if (!any_) return result;
  const auto found = answer(own_, ask(side.face_id, comm), comm);
  for (const Global id : side.face_id) {
    const auto at = std::lower_bound(found.begin(), found.end(), id, [](const CurvedFace& f, Global n) { return f.node < n; });
    if (at == found.end() || at->node != id) {
      result.push_back(-1);
      continue;
    }
    const auto surface = at->surface();
    auto known = std::find_if(surfaces.begin(), surfaces.end(), [&](const auto& s) { return equal(s, surface); });
    if (known == surfaces.end()) known = surfaces.insert(known, surface);
    result.push_back(static_cast<int>(known - surfaces.begin()));
  }
  return result;
}

OneSurface::OneSurface(const Side& secondary, const SurfaceNodes& surface_nodes, const Side& primary, const CurvedFaces& faces,
                       const std::optional<mesh::Motion>& rotation, const Communicator& comm)
{
  std::vector<mesh::CurvedSurface> here, there;
  const auto of_secondary = faces.of(secondary, here, comm);
  auto of_primary = faces.of(primary, there, comm);
  if (here.empty() || there.empty()) return;
  if (rotation)
    for (auto& surface : there) surface = mesh::moved(surface, *rotation);
  const auto common = matches(here, there);
  if (std::all_of(common.begin(), common.end(), [](const auto& same) { return same.empty(); })) return;
  of_primary_ = std::move(of_primary);
  for (std::size_t f = 0; f < secondary.faces.size(); ++f) {
    if (of_secondary[f] < 0) continue;
    for (const int s : common[static_cast<std::size_t>(of_secondary[f])])
      for (std::size_t k = 0; k < secondary.faces[f].size(); ++k)
        at_surface_node_.emplace_back(surface_nodes.of_node[static_cast<std::size_t>(secondary.faces.offset[f]) + k], s);
  }
  for (std::size_t f = 0; f < primary.faces.size(); ++f)
    if (of_primary_[f] >= 0)
      for (const Local n : primary.faces[f]) at_node_.emplace_back(n, static_cast<Local>(f));
  sort_uniquely(at_surface_node_);
  sort_uniquely(at_node_);
}

bool OneSurface::knows(std::size_t surface_node) const
{
  return !entries(at_surface_node_, static_cast<Local>(surface_node)).empty();
}

bool OneSurface::holds(std::size_t surface_node, std::size_t primary_face) const
{
  if (!anywhere()) return false;
  const auto here = entries(at_surface_node_, static_cast<Local>(surface_node));
  return std::any_of(here.begin(), here.end(), [&](const auto& entry) { return entry.second == of_primary_[primary_face]; });
}

bool OneSurface::holds(std::size_t surface_node, std::span<const Term> terms) const
{
  bool any = false;
  for (const auto& term : terms) {
    if (!term.on_primary) continue;
    const auto faces = entries(at_node_, term.node);
    if (std::none_of(faces.begin(), faces.end(),
                     [&](const auto& entry) { return holds(surface_node, static_cast<std::size_t>(entry.second)); }))
      return false;
    any = true;
  }
  return any;
}

}  // namespace mortise::contact
