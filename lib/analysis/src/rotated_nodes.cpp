#include "rotated_nodes.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <tuple>

#include "contact/cyclic.hpp"

namespace mortise::analysis {

namespace {

constexpr double negligible = 1e-6;  // of a row's coefficients

// Nodes that a contact makes one: that of its secondary side has the other one's displacement, rotated.
struct Union {
  Global secondary, primary;
  int contact;
};

Eigen::Matrix3d rotation_of_bond(const Rows& rows, int contact)
{
  return contact::rotation_of(rows.pairs[static_cast<std::size_t>(contact)].options)->rotation;
}

// The node that the rows of a contact node make one with it; none if they speak of several.
std::optional<Global> partner(const constraint::Contacts& contacts, const constraint::ContactNode& node)
{
  std::map<Global, double> size;
  double largest = 0;
  for (auto row = node.row; row <= node.row + node.tangents.size(); ++row)
    for (const auto& entry : contacts.rows[row]) {
      auto& of_node = size[entry.node];
      of_node = std::max(of_node, std::abs(entry.coefficient));
      largest = std::max(largest, of_node);
    }
  std::erase_if(size, [&](const auto& of_node) { return of_node.second <= negligible * largest; });
  if (size.erase(node.node) == 0 || size.size() != 1) return std::nullopt;
  return size.begin()->first;
}

std::vector<Union> unions(const Rows& rows)
{
  const auto& contacts = rows.constraints.contacts;
  std::vector<Union> result;
  for (std::size_t i = 0; i < contacts.nodes.size(); ++i) {
    const auto& node = contacts.nodes[i];
    if (!contacts.bonded[i]) continue;
    if (!rows.pairs[static_cast<std::size_t>(node.contact)].options.cyclic) continue;
    if (const auto other = partner(contacts, node)) result.push_back({node.node, *other, node.contact});
  }
  for (const auto& node : contacts.without_rows)  // wholly held on both cuts
    if (node.opposite >= 0 && rows.pairs[static_cast<std::size_t>(node.contact)].options.cyclic)
      result.push_back({node.node, node.opposite, node.contact});
  return result;
}

}  // namespace

std::vector<std::vector<post::RotatedNode>> find_rotated_nodes(const Rows& rows, const partition::Decomposition& decomposition,
                                                               const partition::NodeDirectory& directory,
                                                               const Communicator& comm)
{
  const auto found = unions(rows);
  if (!comm.any(!found.empty())) return {};
  std::vector<Global> nodes;
  for (const auto& at : found) nodes.insert(nodes.end(), {at.secondary, at.primary});
  const auto copies = directory.find(nodes, comm);
  struct AtCopy {
    Global subdomain, subdomain_of_other;
    Local node, other;
    int contact;
    bool secondary;
  };
  std::vector<std::vector<AtCopy>> send(static_cast<std::size_t>(comm.size()));
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const auto& other = copies[i % 2 == 0 ? i + 1 : i - 1].front();
    for (const auto& copy : copies[i])
      send[static_cast<std::size_t>(decomposition.rank_of(copy.subdomain))].push_back(
          {copy.subdomain, other.subdomain, copy.node, other.node, found[i / 2].contact, i % 2 == 0});
  }
  std::vector<AtCopy> own;
  for (const auto& part : comm.exchange(send)) own.insert(own.end(), part.begin(), part.end());
  std::sort(own.begin(), own.end(), [](const AtCopy& a, const AtCopy& b) {
    return std::tie(a.subdomain, a.node, a.subdomain_of_other, a.other) <
           std::tie(b.subdomain, b.node, b.subdomain_of_other, b.other);
  });
  std::vector<std::vector<post::RotatedNode>> result(decomposition.subdomains.size());
  const Global first = decomposition.first[static_cast<std::size_t>(comm.rank())];
  for (const auto& at : own) {
    const Eigen::Matrix3d rotation = rotation_of_bond(rows, at.contact);
    result[static_cast<std::size_t>(at.subdomain - first)].push_back(
        {at.node, at.subdomain_of_other, at.other, at.secondary ? rotation : Eigen::Matrix3d(rotation.transpose())});
  }
  return result;
}

}  // namespace mortise::analysis
