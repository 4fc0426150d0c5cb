#include "model/doubled_nodes.hpp"

#include <algorithm>
#include <array>
#include <map>

#include "contact/doubled_faces.hpp"
#include "contact_sides.hpp"
#include "partition/skin.hpp"

namespace mortise::model {

std::vector<DoubledNodes> doubled_nodes(const Model& model, const Communicator& comm)
{
  const auto skin = partition::outer_surface(model.decomposition(), comm);
  const auto doubled = contact::find_doubled_faces(skin, model.deck().kinematics, comm);
  if (doubled.empty()) return {};
  const auto sides = sides_of_contacts(model, nullptr, comm);
  std::map<int, std::map<std::array<Global, 2>, Point>> of_body;
  for (const auto& two : doubled) {
    if (sides.opposite(two.faces[0], two.faces[1])) continue;
    for (const auto& node : two.nodes) of_body[two.body].emplace(node.numbers, node.at);
  }
  std::vector<DoubledNodes> result;
  for (const auto& [body, nodes] : of_body) {
    constexpr double nearer = 1e-6;
    Point mean = Point::Zero();
    for (const auto& [numbers, x] : nodes) mean += x / static_cast<double>(nodes.size());
    const Point* best = &nodes.begin()->second;
    for (const auto& [numbers, x] : nodes)
      if ((x - mean).norm() < (1 - nearer) * (*best - mean).norm()) best = &x;
    result.push_back({body, static_cast<long long>(nodes.size()), *best});
  }
  std::stable_sort(result.begin(), result.end(), [](const auto& a, const auto& b) { return a.nodes > b.nodes; });
  return result;
}

}  // namespace mortise::model
