#include "tree.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace mortise::contact {

Tree::Tree(std::vector<Box> boxes) : boxes_(std::move(boxes)), order_(boxes_.size())
{
  std::iota(order_.begin(), order_.end(), 0);
  if (!order_.empty()) build(0, static_cast<int>(order_.size()));
}

int Tree::build(int begin, int end)
{
  constexpr int leaf = 4;
  const auto index = static_cast<int>(branches_.size());
  Branch branch{Box(), begin, end};
  for (int i = begin; i < end; ++i) branch.box.extend(boxes_[static_cast<std::size_t>(order_[static_cast<std::size_t>(i)])]);
  branches_.push_back(branch);
  if (end - begin > leaf) {
    Eigen::Index axis = 0;
    branch.box.sizes().maxCoeff(&axis);
    const int middle = (begin + end) / 2;
    std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end, [&](int a, int b) {
      return std::pair(boxes_[static_cast<std::size_t>(a)].center()[axis], a) <
             std::pair(boxes_[static_cast<std::size_t>(b)].center()[axis], b);
    });
    const int left = build(begin, middle), right = build(middle, end);
    branches_[static_cast<std::size_t>(index)].left = left;
    branches_[static_cast<std::size_t>(index)].right = right;
  }
  return index;
}

std::vector<int> Tree::meeting(const Box& box) const
{
  std::vector<int> found, stack;
  if (!branches_.empty()) stack.push_back(0);
  while (!stack.empty()) {
    const Branch& branch = branches_[static_cast<std::size_t>(stack.back())];
    stack.pop_back();
    if (!branch.box.intersects(box)) continue;
    if (branch.left >= 0) {
      stack.push_back(branch.left);
      stack.push_back(branch.right);
      continue;
    }
    for (int i = branch.begin; i < branch.end; ++i)
      if (boxes_[static_cast<std::size_t>(order_[static_cast<std::size_t>(i)])].intersects(box))
        found.push_back(order_[static_cast<std::size_t>(i)]);
  }
  std::sort(found.begin(), found.end());
  return found;
}

std::vector<int> Tree::swept(const Box& box, const Point& direction) const
{
  // A slanted sweep in pieces, for its one box would hold much that it does not meet.
  constexpr double most = 64;
  const double size = box.sizes().maxCoeff();
  const auto pieces = static_cast<int>(std::clamp(std::ceil(2 * direction.norm() / std::max(size, 1e-300)), 1.0, most));
  std::vector<int> found;
  for (int i = 0; i < pieces; ++i) {
    Box piece = box.translated(direction * (2.0 * i / pieces - 1));
    piece.extend(box.translated(direction * (2.0 * (i + 1) / pieces - 1)));
    const auto part = meeting(piece);
    found.insert(found.end(), part.begin(), part.end());
  }
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

}  // namespace mortise::contact
