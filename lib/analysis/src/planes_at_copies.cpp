#include "planes_at_copies.hpp"

#include <algorithm>
#include <array>
#include <tuple>

#include "sent_points.hpp"

namespace mortise::analysis {

namespace {

struct PlaneAtCopy {
  Global subdomain;
  Local node;
  int number;  // among the planes of the node
  std::array<double, 3> normal;
  double traction;
};

}  // namespace

std::vector<std::vector<post::SymmetricNode>> planes_at_copies(std::span<const Global> nodes,
                                                               std::span<const std::vector<Point>> normals,
                                                               const partition::Decomposition& decomposition,
                                                               const partition::NodeHomes& homes, const Communicator& comm,
                                                               std::span<const std::vector<double>> tractions)
{
  std::vector<std::vector<PlaneAtCopy>> planes(static_cast<std::size_t>(comm.size()));
  for (std::size_t i = 0; i < nodes.size(); ++i)
    for (const auto& copy : homes.copies(nodes[i]))
      for (std::size_t k = 0; k < normals[i].size(); ++k) {
        planes[static_cast<std::size_t>(decomposition.rank_of(copy.subdomain))].push_back(
            {copy.subdomain, copy.node, static_cast<int>(k), components(normals[i][k]), tractions.empty() ? 0 : tractions[i][k]});
      }
  std::vector<PlaneAtCopy> own;
  for (const auto& part : comm.exchange(planes)) own.insert(own.end(), part.begin(), part.end());
  std::sort(own.begin(), own.end(), [](const PlaneAtCopy& a, const PlaneAtCopy& b) {
    return std::tie(a.subdomain, a.node, a.number) < std::tie(b.subdomain, b.node, b.number);
  });
  std::vector<std::vector<post::SymmetricNode>> result(decomposition.subdomains.size());
  const Global first = decomposition.first[static_cast<std::size_t>(comm.rank())];
  for (const auto& plane : own) {
    auto& of_subdomain = result[static_cast<std::size_t>(plane.subdomain - first)];
    if (of_subdomain.empty() || of_subdomain.back().node != plane.node) of_subdomain.push_back({plane.node, {}});
    of_subdomain.back().normals.push_back(point(plane.normal));
    if (!tractions.empty()) of_subdomain.back().tractions.push_back(plane.traction);
  }
  return result;
}

}  // namespace mortise::analysis
