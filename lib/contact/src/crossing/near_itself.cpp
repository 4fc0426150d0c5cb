#include "crossing/near_itself.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <set>

#include "search/boxes.hpp"

namespace mortise::contact {

namespace {

// Boxes of a rank's piece of a body that the other ranks are told of.
constexpr std::size_t boxes_of_piece = 64;

// Boxes round places now and before, and round displacements.
struct Motion {
  Box now, before, moved;

  void extend(const Motion& other)
  {
    now.extend(other.now);
    before.extend(other.before);
    moved.extend(other.moved);
  }

  // Whether two places, one of each, may be the same now: before they were apart by what they have moved towards each other.
  bool may_meet(const Motion& other) const
  {
    if (!now.intersects(other.now)) return false;
    for (int c = 0; c < 3; ++c)
      if (before.min()[c] - other.before.max()[c] > other.moved.max()[c] - moved.min()[c] ||
          before.max()[c] - other.before.min()[c] < other.moved.min()[c] - moved.max()[c])
        return false;
    return true;
  }
};

// Faces of bodies before and after something moved.
struct MovedFaces {
  const std::vector<Point>&before, &now;
  const mesh::Cells& faces;
  const std::vector<int>& body;
  std::vector<Motion> motion = {};

  MovedFaces(const std::vector<Point>& points, const std::vector<Point>& moved, const mesh::Cells& cells,
             const std::vector<int>& bodies)
      : before(points), now(moved), faces(cells), body(bodies), motion(cells.size())
  {
    for (std::size_t f = 0; f < faces.size(); ++f)
      for (const Local n : faces[f]) {
        motion[f].now.extend(now[at(n)]);
        motion[f].before.extend(before[at(n)]);
        motion[f].moved.extend(now[at(n)] - before[at(n)]);
      }
  }

  bool share_a_node(std::size_t f, std::size_t g) const
  {
    const auto nodes = faces[f], others = faces[g];
    return std::find_first_of(nodes.begin(), nodes.end(), others.begin(), others.end()) != nodes.end();
  }

  // Whether no node of g lies beyond those of f along a direction.
  bool apart_along(std::size_t f, std::size_t g, const Point& direction) const
  {
    double highest = -std::numeric_limits<double>::max(), lowest = -highest, other_highest = highest, other_lowest = lowest;
    for (const Local n : faces[f]) {
      const double s = direction.dot(now[at(n)]);
      highest = std::max(highest, s), lowest = std::min(lowest, s);
    }
    for (const Local n : faces[g]) {
      const double s = direction.dot(now[at(n)]);
      other_highest = std::max(other_highest, s), other_lowest = std::min(other_lowest, s);
    }
    return lowest > other_highest || other_lowest > highest;
  }

  // Whether a plane along f, or across it through an edge, lies between the nodes of both.
  bool apart(std::size_t f, std::size_t g) const
  {
    const auto nodes = faces[f];
    const auto corners = at(mesh::corner_count(faces.type[f]));
    const auto corner = [&](std::size_t k) -> const Point& { return now[at(nodes[k % corners])]; };
    if (corners == 2) {
      const Point line = corner(1) - corner(0);
      return apart_along(f, g, Point(line[1], -line[0], 0)) || apart_along(f, g, line);
    }
    const Point normal = corners == 3 ? (corner(1) - corner(0)).cross(corner(2) - corner(0))
                                      : (corner(2) - corner(0)).cross(corner(3) - corner(1));
    if (apart_along(f, g, normal)) return true;
    for (std::size_t k = 0; k < corners; ++k)
      if (apart_along(f, g, normal.cross(corner(k + 1) - corner(k)))) return true;
    return false;
  }
};

// Calls use(f, g), f < g, for the faces of one body that may cross. Of `first`, `first` + `step`, ... each with all.
template <class Use>
void pairs_that_may_cross(const MovedFaces& all, std::size_t first, std::size_t step, const Use& use)
{
  std::vector<Box> boxes;
  for (const auto& motion : all.motion) boxes.push_back(motion.now);
  const Tree tree(std::move(boxes));
  std::vector<int> found;
  for (std::size_t f = first; f < all.faces.size(); f += step) {
    tree.candidates(all.motion[f].now, found);
    for (auto next = std::upper_bound(found.begin(), found.end(), static_cast<int>(f)); next != found.end(); ++next) {
      const std::size_t g = at(*next);
      if (all.body[f] == all.body[g] && all.motion[f].may_meet(all.motion[g]) && !all.share_a_node(f, g) && !all.apart(f, g) &&
          !all.apart(g, f))
        use(f, g);
    }
  }
}

// Of each body, up to the last that has a face, whether faces of several ranks are its; `body`: of each face of this rank.
// Collective.
std::vector<char> on_several_ranks(std::span<const int> body, const Communicator& comm)
{
  const int most = body.empty() ? -1 : std::ranges::max(body);
  std::vector<double> ranks(static_cast<std::size_t>(comm.max(static_cast<long long>(most)) + 1), 0.0);
  for (const int b : body) ranks[at(b)] = 1;
  comm.sum_in_place(ranks);
  std::vector<char> result;
  for (const double count : ranks) result.push_back(count > 1);
  return result;
}

// Faces that may meet a part of their body that another rank has. Collective.
std::vector<std::size_t> near_other_ranks(const MovedFaces& faces, const Communicator& comm)
{
  struct Part {
    std::array<std::array<double, 3>, 6> corners;
    int body, rank;
  };
  const auto shared = on_several_ranks(faces.body, comm);
  std::map<int, std::vector<int>> of_body;
  for (std::size_t f = 0; f < faces.faces.size(); ++f)
    if (shared[at(faces.body[f])]) of_body[faces.body[f]].push_back(static_cast<int>(f));
  std::vector<Box> boxes;
  for (const auto& motion : faces.motion) boxes.push_back(motion.now);
  std::vector<Part> parts;
  for (auto& [body, some] : of_body)
    halve(boxes, some, std::max<std::size_t>(4, 2 * some.size() / boxes_of_piece), [&](const Box&, std::span<const int> members) {
      Motion motion;
      for (const int f : members) motion.extend(faces.motion[at(f)]);
      Part part{{}, body, comm.rank()};
      std::size_t k = 0;
      for (const auto* box : {&motion.now, &motion.before, &motion.moved})
        for (const Point& x : {box->min(), box->max()}) part.corners[k++] = {x[0], x[1], x[2]};
      parts.push_back(part);
    });
  parts = comm.all_gather(parts);
  std::erase_if(parts, [&](const Part& part) { return part.rank == comm.rank() || !of_body.contains(part.body); });
  std::vector<Motion> motions;
  std::vector<Box> now;
  for (const auto& part : parts) {
    const auto box = [&](std::size_t k) {
      const auto &low = part.corners[k], &high = part.corners[k + 1];
      return Box(Point(low[0], low[1], low[2]), Point(high[0], high[1], high[2]));
    };
    motions.push_back({box(0), box(2), box(4)});
    now.push_back(box(0));
  }
  const Tree tree(std::move(now));
  std::vector<std::size_t> chosen;
  std::vector<int> found;
  for (std::size_t f = 0; f < faces.faces.size(); ++f) {
    tree.candidates(faces.motion[f].now, found);
    if (std::any_of(found.begin(), found.end(),
                    [&](int p) { return parts[at(p)].body == faces.body[f] && faces.motion[f].may_meet(motions[at(p)]); }))
      chosen.push_back(f);
  }
  return chosen;
}

}  // namespace

std::vector<std::size_t> near_other_ranks(const mesh::Surface& skin, double margin, const Communicator& comm)
{
  MovedFaces faces(skin.points, skin.points, skin.faces, skin.body);
  for (auto& motion : faces.motion) motion.now = motion.before = grown(motion.now, margin * motion.now.diagonal().norm());
  return near_other_ranks(faces, comm);
}

std::vector<std::size_t> near_itself(const mesh::Surface& before, const mesh::Surface& now, fem::Kinematics kinematics,
                                     const Communicator& comm)
{
  const MovedFaces mine(before.points, now.points, now.faces, now.body);
  std::vector<char> taken(now.faces.size(), 0);
  pairs_that_may_cross(mine, 0, 1, [&](std::size_t f, std::size_t g) { taken[f] = taken[g] = 1; });
  if (comm.size() > 1) {
    const auto seam = near_other_ranks(mine, comm);
    const Skin skin = gather_skin(part_of(now, seam), kinematics, comm);
    const auto points = gather_points(part_of(before, seam), comm);
    const MovedFaces all(points, skin.side.points, skin.side.faces, skin.body);
    std::vector<Global> crossing;
    pairs_that_may_cross(all, static_cast<std::size_t>(comm.rank()), static_cast<std::size_t>(comm.size()),
                         [&](std::size_t f, std::size_t g) {
                           crossing.push_back(skin.face_id[f]);
                           crossing.push_back(skin.face_id[g]);
                         });
    const auto gathered = comm.all_gather(crossing);
    const std::set<Global> chosen(gathered.begin(), gathered.end());
    for (std::size_t f = 0; f < taken.size(); ++f)
      if (chosen.contains(now.face_id[f])) taken[f] = 1;
  }
  std::vector<std::size_t> result;
  for (std::size_t f = 0; f < taken.size(); ++f)
    if (taken[f]) result.push_back(f);
  return result;
}

}  // namespace mortise::contact
