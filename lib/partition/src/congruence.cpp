#include "partition/congruence.hpp"

#include <algorithm>
#include <unordered_map>

namespace mortise::partition {

namespace {

constexpr double tolerance = 1e-10;  // of distances, relative to the size of the subdomain

bool same_cells(const mesh::Cells& a, const mesh::Cells& b)
{
  return a.type == b.type && a.nodes == b.nodes;
}

bool same_shape(const mesh::Mesh& a, const mesh::Mesh& b)
{
  if (a.points.size() != b.points.size() || !same_cells(a.cells, b.cells)) return false;
  if (a.points.empty()) return true;
  double size = 0;
  for (const auto& p : a.points) size = std::max(size, (p - a.points.front()).norm());
  for (std::size_t n = 0; n < a.points.size(); ++n)
    if (((a.points[n] - a.points.front()) - (b.points[n] - b.points.front())).norm() > tolerance * size) return false;
  return true;
}

}  // namespace

std::vector<std::size_t> congruent(const std::vector<Subdomain>& subdomains, const std::vector<int>& kind)
{
  std::vector<std::size_t> result(subdomains.size());
  std::unordered_multimap<std::size_t, std::size_t> originals;  // by what is cheap to compare
  for (std::size_t s = 0; s < subdomains.size(); ++s) {
    const auto& mesh = subdomains[s].mesh;
    const std::size_t key = (mesh.node_count() * 1000003U + mesh.cells.size()) * 1000003U + static_cast<std::size_t>(kind[s]);
    result[s] = s;
    const auto [begin, end] = originals.equal_range(key);
    for (auto it = begin; it != end && result[s] == s; ++it)
      if (kind[it->second] == kind[s] && same_shape(subdomains[it->second].mesh, mesh)) result[s] = it->second;
    if (result[s] == s) originals.emplace(key, s);
  }
  return result;
}

}  // namespace mortise::partition
