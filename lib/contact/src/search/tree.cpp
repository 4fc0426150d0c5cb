#include "search/tree.hpp"

#include <algorithm>
#include <array>
#include <numeric>

namespace mortise::contact {

namespace {

// Whether a box of half size `half` meets `box` on its way from centre - direction to centre + direction: whether that segment
// meets the box grown by `half`, slab by slab.
bool meets_sweep(const Box& box, const Point& centre, const Point& half, const Point& direction)
{
  double begin = -1, end = 1;
  for (int c = 0; c < 3; ++c) {
    const double low = box.min()[c] - half[c] - centre[c], high = box.max()[c] + half[c] - centre[c];
    if (direction[c] == 0) {
      if (low > 0 || high < 0) return false;
      continue;
    }
    const double first = low / direction[c], last = high / direction[c];
    begin = std::max(begin, std::min(first, last));
    end = std::min(end, std::max(first, last));
    if (begin > end) return false;
  }
  return true;
}

}  // namespace

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

// Calls visit(index) for all boxes for which meets(box) holds, which must hold for every box round such a one, until it returns
// false.
template <class Meets, class Visit>
void Tree::walk(const Meets& meets, const Visit& visit) const
{
  std::array<int, 64> stack;  // halving goes no deeper
  std::size_t waiting = 0;
  if (!branches_.empty()) stack[waiting++] = 0;
  while (waiting > 0) {
    const Branch& branch = branches_[static_cast<std::size_t>(stack[--waiting])];
    if (!meets(branch.box)) continue;
    if (branch.left >= 0) {
      stack[waiting++] = branch.right;
      stack[waiting++] = branch.left;
      continue;
    }
    for (int i = branch.begin; i < branch.end; ++i) {
      const int candidate = order_[static_cast<std::size_t>(i)];
      if (meets(boxes_[static_cast<std::size_t>(candidate)]) && !visit(candidate)) return;
    }
  }
}

void Tree::candidates(const Box& box, std::vector<int>& found) const
{
  found.clear();
  walk([&](const Box& other) { return other.intersects(box); }, [&](int i) { return found.push_back(i), true; });
  std::sort(found.begin(), found.end());
}

std::vector<int> Tree::candidates(const Box& box) const
{
  std::vector<int> found;
  candidates(box, found);
  return found;
}

bool Tree::meets(const Box& box) const
{
  return any_of(box, [](int) { return true; });
}

bool Tree::any_of(const Box& box, const std::function<bool(int)>& holds) const
{
  bool any = false;
  walk([&](const Box& other) { return other.intersects(box); },
       [&](int i) {
         any = holds(i);
         return !any;
       });
  return any;
}

void Tree::swept(const Box& box, const Point& direction, std::vector<int>& found) const
{
  const Point centre = box.center(), half = 0.5 * box.sizes();
  found.clear();
  walk([&](const Box& other) { return meets_sweep(other, centre, half, direction); },
       [&](int i) { return found.push_back(i), true; });
  std::sort(found.begin(), found.end());
}

std::vector<int> Tree::swept(const Box& box, const Point& direction) const
{
  std::vector<int> found;
  swept(box, direction, found);
  return found;
}

}  // namespace mortise::contact
