#include "surface/fitted_normals.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <span>
#include <utility>

#include "surface/fitted_surface.hpp"

namespace mortise::contact {

namespace {

// Nodes round one that determine a surface of second order, with one to spare, and one of third order.
constexpr std::size_t enough = 6, enough_for_third = 12;
// Heights below this part of the distances are rounding.
constexpr double plane_surface = 1e-10;
// What a surface of second order may leave of the heights for nothing of third order to be looked for.
constexpr double nothing_left = 1e-4;

// Where it leaves more than this of the nodes round and of those round these, it may be two surfaces, and is if they leave as
// little as `of_two`, and so much less: in the line in which a cylinder runs into a fillet 0.01 to 0.04, in a row of nodes beside
// it 0.12 to 0.16.
constexpr double of_one = 0.2, of_two = 0.05, explained = 0.2;
// Cosine: lines from node to node go on as straight as this.
constexpr double straight = -0.9;
constexpr std::size_t enough_for_two = 9;

// The surface nodes that share a facet with each, ascending.
class Neighbours {
 public:
  Neighbours(const Side& side, const SurfaceNodes& surface_nodes) : offset_(surface_nodes.all.size() + 1, 0)
  {
    std::vector<std::pair<Local, Local>> pairs;
    for (std::size_t f = 0; f < side.facets.size(); ++f) {
      const auto begin = static_cast<std::size_t>(side.facets.offset[f]), n = side.facets[f].size();
      for (std::size_t a = 0; a < n; ++a)
        for (std::size_t b = 0; b < n; ++b)
          if (a != b) pairs.emplace_back(surface_nodes.of_corner[begin + a], surface_nodes.of_corner[begin + b]);
    }
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    for (const auto& [from, to] : pairs) {
      ++offset_[static_cast<std::size_t>(from) + 1];
      to_.push_back(to);
    }
    for (std::size_t p = 0; p + 1 < offset_.size(); ++p) offset_[p + 1] += offset_[p];
  }

  std::span<const Local> operator[](std::size_t p) const { return {to_.data() + offset_[p], offset_[p + 1] - offset_[p]}; }

  // Those round a surface node, and if `farther` those round these.
  void round(std::size_t p, bool farther, std::vector<Local>& result) const
  {
    result.assign((*this)[p].begin(), (*this)[p].end());
    if (!farther) return;
    std::vector<Local> next;
    for (const Local q : (*this)[p])
      for (const Local r : (*this)[static_cast<std::size_t>(q)])
        if (r != static_cast<Local>(p) && !std::binary_search((*this)[p].begin(), (*this)[p].end(), r)) next.push_back(r);
    std::sort(next.begin(), next.end());
    result.insert(result.end(), next.begin(), std::unique(next.begin(), next.end()));
  }

 private:
  std::vector<std::size_t> offset_;
  std::vector<Local> to_;
};

// Two surfaces that meet in a line through a surface node.
struct TwoSurfaces {
  std::size_t at;
  Few<Local, 2> ends;  // the next surface nodes of the line
  Point normal;

  bool leads_to(std::size_t p) const { return std::find(ends.begin(), ends.end(), static_cast<Local>(p)) != ends.end(); }
};

class Fits {
 public:
  Fits(const Side& side, const SurfaceNodes& surface_nodes)
      : side_(side), surface_nodes_(surface_nodes), neighbours_(side, surface_nodes)
  {
  }

  // Turns the normal to that of the surface through the nodes round one; where they lie in its plane, to that of the `mean`.
  void turn(std::size_t p, bool border, const Point& mean, SurfaceNode& node)
  {
    const Point start = node.normal;
    gather(p, border || neighbours_[p].size() < enough);
    if (d_.empty()) return;
    if (std::all_of(d_.begin(), d_.end(), [&](const Point& v) { return std::abs(v.dot(mean)) < plane_surface * v.norm(); })) {
      node.normal = mean;
      return;
    }
    const FittedSurface one = fit_second_order(d_, start);
    node.normal = one.normal;
    gather(p, true);
    const double left = one.left == 1 ? 1 : one.left_of(d_);
    if (left > of_one) {
      attempt_two(p, border, start);
    } else if (left > nothing_left) {
      const bool few = border || d_.size() < enough_for_third;
      if (const auto third = few ? normal_of_cone(d_, one) : normal_of_third_order(d_, one)) {
        node.normal = *third;
        node.lean = one.normal - *third;
        node.third_order = true;
      }
    } else {
      node.third_order = true;
    }
  }

  // Those that explain the nodes, where the next node of the line says the same: by chance a single node may look like it.
  std::vector<TwoSurfaces> two_surfaces() const
  {
    const auto says = [&](Local end, std::size_t p) {
      const auto other = std::ranges::lower_bound(two_, static_cast<std::size_t>(end), {}, &TwoSurfaces::at);
      return other != two_.end() && other->at == static_cast<std::size_t>(end) && other->leads_to(p);
    };
    std::vector<TwoSurfaces> result;
    std::ranges::copy_if(two_, std::back_inserter(result), [&](const TwoSurfaces& two) {
      return std::any_of(two.ends.begin(), two.ends.end(), [&](Local end) { return says(end, two.at); });
    });
    return result;
  }

 private:
  // The nodes round a surface node, and if `farther` those round these: the first `near_` are the nodes next to it.
  void gather(std::size_t p, bool farther)
  {
    const auto at = [&](std::size_t q) -> const Point& {
      return side_.points[static_cast<std::size_t>(surface_nodes_.all[q].node)];
    };
    neighbours_.round(p, farther, round_);
    std::erase_if(round_, [&](Local q) { return at(static_cast<std::size_t>(q)) == at(p); });
    near_ = static_cast<std::size_t>(
        std::ranges::count_if(round_, [&](Local q) { return std::ranges::binary_search(neighbours_[p], q); }));
    d_.clear();
    for (const Local q : round_) d_.push_back(at(static_cast<std::size_t>(q)) - at(p));
  }

  // In one of the lines from node to node, or at a border, where lines may end, in one from it.
  void attempt_two(std::size_t p, bool border, const Point& start)
  {
    if (d_.size() < enough_for_two) return;
    TwoSurfaces best{p, {}, start};
    double least = std::min(explained * fit_second_order(d_, start).left, of_two);
    const auto attempt = [&](const Point& line, const Few<Local, 2>& ends) {
      if (const FittedSurface two = fit_second_order(d_, start, &line); two.left < least) {
        least = two.left;
        best.ends = ends;
        best.normal = two.normal;
      }
    };
    for (std::size_t a = 0; a < near_; ++a) {
      if (border) attempt(d_[a], {round_[a]});
      for (std::size_t b = 0; b < a; ++b)
        if (d_[a].dot(d_[b]) < straight * d_[a].norm() * d_[b].norm())
          attempt((d_[a].normalized() - d_[b].normalized()).normalized(), {round_[a], round_[b]});
    }
    if (best.ends.size() > 0) two_.push_back(best);
  }

  const Side& side_;
  const SurfaceNodes& surface_nodes_;
  const Neighbours neighbours_;
  std::vector<Local> round_;
  std::vector<Point> d_;
  std::size_t near_ = 0;
  std::vector<TwoSurfaces> two_;  // ascending
};

}  // namespace

void fit_normals(const Side& side, const SurfaceNodes& means, const std::vector<bool>& border, SurfaceNodes& surface_nodes)
{
  Fits fits(side, surface_nodes);
  for (std::size_t p = 0; p < surface_nodes.all.size(); ++p) fits.turn(p, border[p], means.all[p].normal, surface_nodes.all[p]);
  for (const auto& two : fits.two_surfaces()) surface_nodes.all[two.at].normal = two.normal;
}

}  // namespace mortise::contact
