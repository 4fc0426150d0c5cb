#include "search/boxes.hpp"

#include <algorithm>

namespace mortise::contact {

void halve(const std::vector<Box>& boxes, std::span<int> order, std::size_t most,
           const std::function<void(const Box&, std::span<const int>)>& use)
{
  if (order.empty()) return;
  Box all;
  for (const int i : order) all.extend(boxes[static_cast<std::size_t>(i)]);
  if (order.size() <= most) return use(all, order);
  Eigen::Index axis = 0;
  all.sizes().maxCoeff(&axis);
  const std::size_t middle = order.size() / 2;
  std::nth_element(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(middle), order.end(), [&](int a, int b) {
    return boxes[static_cast<std::size_t>(a)].center()[axis] < boxes[static_cast<std::size_t>(b)].center()[axis];
  });
  halve(boxes, order.first(middle), most, use);
  halve(boxes, order.subspan(middle), most, use);
}

std::vector<Box> boxes_of_faces(const mesh::Surface& side)
{
  std::vector<Box> boxes(side.faces.size());
  for (std::size_t f = 0; f < side.faces.size(); ++f)
    for (const Local n : side.faces[f]) boxes[f].extend(side.points[static_cast<std::size_t>(n)]);
  return boxes;
}

mesh::Surface part_of(const mesh::Surface& side, std::span<const std::size_t> chosen)
{
  std::vector<Local> local(side.points.size(), -1);
  for (const std::size_t f : chosen)
    for (const Local n : side.faces[f]) local[static_cast<std::size_t>(n)] = 0;
  mesh::Surface result;
  for (std::size_t n = 0; n < local.size(); ++n) {
    if (local[n] < 0) continue;
    local[n] = static_cast<Local>(result.points.size());
    result.points.push_back(side.points[n]);
    result.node_id.push_back(side.node_id[n]);
  }
  for (const std::size_t f : chosen) {
    std::vector<Local> nodes;
    for (const Local n : side.faces[f]) nodes.push_back(local[static_cast<std::size_t>(n)]);
    result.faces.add(side.faces.type[f], nodes);
    result.face_id.push_back(side.face_id[f]);
    result.body.push_back(side.body[f]);
  }
  return result;
}

}  // namespace mortise::contact
