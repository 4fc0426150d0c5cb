#include "rows/one_part.hpp"

#include <algorithm>
#include <numeric>

namespace mortise::contact {

std::vector<Local> connected_parts(const Side& side, std::span<const std::vector<Local>> bonded)
{
  std::vector<Local> parent(side.points.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](Local n) {
    while (parent[static_cast<std::size_t>(n)] != n)
      n = parent[static_cast<std::size_t>(n)] = parent[static_cast<std::size_t>(parent[static_cast<std::size_t>(n)])];
    return n;
  };
  const auto join = [&](std::span<const Local> nodes) {
    for (const Local n : nodes) parent[static_cast<std::size_t>(root(n))] = root(nodes[0]);
  };
  for (std::size_t f = 0; f < side.faces.size(); ++f) join(side.faces[f]);
  for (const auto& nodes : bonded) join(nodes);
  for (Local n = 0; n < static_cast<Local>(parent.size()); ++n) parent[static_cast<std::size_t>(n)] = root(n);
  return parent;
}

OnePart::OnePart(const Side& primary)
    : primary_(primary), first_(primary.points.size() + 1, 0), faces_(primary.faces.nodes.size())
{
  for (const Local n : primary.faces.nodes) ++first_[static_cast<std::size_t>(n) + 1];
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  auto next = first_;
  for (std::size_t f = 0; f < primary.faces.size(); ++f)
    for (const Local n : primary.faces[f]) faces_[next[static_cast<std::size_t>(n)]++] = static_cast<Local>(f);
}

std::vector<char> OnePart::reached_from(std::size_t face, std::span<const Term> terms) const
{
  std::vector<char> reached(terms.size(), 0);
  std::vector<std::size_t> next;
  const auto take_face = [&](std::size_t f, bool any) {
    std::vector<std::size_t> found;
    for (const Local n : primary_.faces[f]) {
      const auto at = std::lower_bound(terms.begin(), terms.end(), n, [](const Term& t, Local node) { return t.node < node; });
      if (at != terms.end() && at->node == n) found.push_back(static_cast<std::size_t>(at - terms.begin()));
    }
    if (!any && found.size() < primary_.faces[f].size()) return;
    for (const std::size_t i : found)
      if (!reached[i]) reached[i] = 1, next.push_back(i);
  };
  take_face(face, true);
  while (!next.empty()) {
    const auto node = static_cast<std::size_t>(terms[next.back()].node);
    next.pop_back();
    for (std::size_t i = first_[node]; i < first_[node + 1]; ++i) take_face(static_cast<std::size_t>(faces_[i]), false);
  }
  return reached;
}

void OnePart::take(const Opposite& met, std::vector<Term>& terms) const
{
  const auto begin = std::find_if(terms.begin(), terms.end(), [](const Term& t) { return t.on_primary; });
  const std::span mine(begin, terms.end());
  const auto reached = reached_from(static_cast<std::size_t>(primary_.face_of[met.facet]), mine);
  if (std::all_of(reached.begin(), reached.end(), [](char r) { return r != 0; })) return;
  const double all = std::accumulate(mine.begin(), mine.end(), 0.0, [](double sum, const Term& t) { return sum + t.value; });
  std::vector<Term> result(terms.begin(), begin);
  const auto face = static_cast<std::size_t>(primary_.face_of[met.facet]);
  const FaceShape shape = primary_.shape_in_face(met.facet, met.hit.shape, met.hit.frame, Plane::Zero());
  for (std::size_t k = 0; k < primary_.faces[face].size(); ++k)
    result.push_back({primary_.faces[face][k], true, all * shape[static_cast<Eigen::Index>(k)]});
  terms = std::move(result);
}

}  // namespace mortise::contact
