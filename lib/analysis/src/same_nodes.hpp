// Points of contacts that stay the same while other components of their nodes are prescribed.
#pragma once

#include <map>

#include "analysis/carried_contact.hpp"
#include "constraint/constraints.hpp"

namespace mortise::analysis {

/// Where each point stands among `contacts.nodes`.
inline std::map<NodeKey, std::size_t> index(const constraint::Contacts& contacts)
{
  std::map<NodeKey, std::size_t> result;
  for (std::size_t i = 0; i < contacts.nodes.size(); ++i) {
    NodeKey key{contacts.nodes[i].contact, contacts.nodes[i].node, 0};
    while (!result.emplace(key, i).second) ++std::get<2>(key);
  }
  return result;
}

/// A vector in the tangent plane of one point, from its entries along that point's tangents, to entries along those of another.
template <class From, class To>
void change_tangents(const constraint::ContactNode& from, const constraint::ContactNode& to, const From& entry, const To& take)
{
  Point v = Point::Zero();
  for (std::size_t t = 0; t < from.tangents.size(); ++t) v += entry(t) * from.tangents[t];
  for (std::size_t t = 0; t < to.tangents.size(); ++t) take(t, v.dot(to.tangents[t]));
}

}  // namespace mortise::analysis
