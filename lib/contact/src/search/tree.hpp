// A bounding-volume tree: axis-aligned boxes, split at the median of their centres across the longest side.
#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <span>
#include <vector>

#include "base/types.hpp"

namespace mortise::contact {

using Box = Eigen::AlignedBox3d;

class Tree {
 public:
  explicit Tree(std::vector<Box> boxes);
  /// Indices of all boxes that meet `box`, ascending.
  std::vector<int> candidates(const Box& box) const;
  /// Whether any box meets `box`.
  bool meets(const Box& box) const;
  /// Whether `holds` of the index of any box that meets `box`.
  bool any_of(const Box& box, const std::function<bool(int)>& holds) const;
  /// Indices of those that meet what `box` sweeps when it moves by -direction to +direction.
  std::vector<int> swept(const Box& box, const Point& direction) const;
  // The same, into `found`.
  void candidates(const Box& box, std::vector<int>& found) const;
  void swept(const Box& box, const Point& direction, std::vector<int>& found) const;

 private:
  struct Branch {
    Box box;
    int begin, end;  // into order_
    int left = -1, right = -1;
  };
  int build(int begin, int end);
  template <class Meets, class Visit>
  void walk(const Meets& meets, const Visit& visit) const;

  std::vector<Box> boxes_;
  std::vector<int> order_;
  std::vector<Branch> branches_;
};

}  // namespace mortise::contact
