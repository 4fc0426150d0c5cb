#include "contact/pairing.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <tuple>

#include "near.hpp"
#include "side.hpp"
#include "tree.hpp"

namespace mortise::contact {

namespace {

// Part of the smaller face's size that a gap may have where the deck gives no distance.
constexpr double part_of_face = 0.5;
// Part of the smaller body's diagonal over which a zone of contact can grow. Hertz: at its border the surfaces of a sphere of
// radius R were a^2 / 2R apart, which is 0.07 R for a = 0.37 R.
constexpr double part_of_body = 0.02;
// Faces round those within reach that normals depend on, as in near_faces().
constexpr double rings = 9;
// Cosine of the angle from which neighbouring faces make a kink, as in find_places().
constexpr double kink = 0.766;
// Lengths below this part of a face's size are rounding.
constexpr double rounding = 1e-6;
// Parts of a rank's piece of a body that the other ranks are told of.
constexpr std::size_t most_boxes = 64;
// Places from which lines start: the centre of a facet, and so far from there to its corners.
constexpr double to_corners = 0.9;
// Sides whose sizes or flatness differ by less are equal.
constexpr double finer = 0.1, flatter = 1e-3;

std::size_t at(int index)
{
  return static_cast<std::size_t>(index);
}

Box grown(const Box& box, double margin)
{
  return Box(box.min() - Point::Constant(margin), box.max() + Point::Constant(margin));
}

// How far lines go and patches reach.
struct Lengths {
  double given;         // the deck's distance, or 0
  double interference;  // of the deck
  bool bonded;
  std::vector<double> diagonal;  // of each body

  // The range of gaps of faces of these sizes that face each other.
  std::pair<double, double> window(double size, double other) const
  {
    const double d = given > 0 ? given : part_of_face * std::min(size, other);
    return {-d + std::min(interference, 0.0), d + std::max(interference, 0.0)};
  }
  double longest(double size) const { return (given > 0 ? given : part_of_face * size) + std::abs(interference); }
  double reach(double largest, int body, int other) const
  {
    const double usual = std::max(largest, part_of_body * std::min(diagonal[at(body)], diagonal[at(other)]));
    return (given > 0 ? given : usual) + std::abs(interference);
  }
  // Faces farther apart than this have nothing to do with each other: the rays of a discretization go twice as far as its reach.
  double margin(double size, int body, double other_size, int other) const
  {
    const double largest = std::max(size, other_size);
    return 2 * reach(largest, body, other) + rings * largest;
  }
};

// The diagonals of the bodies' boxes. Collective.
std::vector<double> diagonals(const mesh::Surface& skin, int bodies, const Communicator& comm)
{
  constexpr double none = std::numeric_limits<double>::max();
  std::vector<std::array<double, 6>> mine(at(bodies), {none, none, none, -none, -none, -none});
  const auto extend = [](std::array<double, 6>& box, std::size_t c, double low, double high) {
    box[c] = std::min(box[c], low);
    box[3 + c] = std::max(box[3 + c], high);
  };
  for (std::size_t f = 0; f < skin.faces.size(); ++f)
    for (const Local n : skin.faces[f])
      for (std::size_t c = 0; c < 3; ++c) {
        const double x = skin.points[at(n)][static_cast<Eigen::Index>(c)];
        extend(mine[at(skin.body[f])], c, x, x);
      }
  const auto all = comm.all_gather(mine);
  for (std::size_t i = 0; i < all.size(); ++i)
    for (std::size_t c = 0; c < 3; ++c) extend(mine[i % at(bodies)], c, all[i][c], all[i][3 + c]);
  std::vector<double> result;
  for (const auto& box : mine)
    result.push_back(box[0] > box[3] ? 0 : Point(box[3] - box[0], box[4] - box[1], box[5] - box[2]).norm());
  return result;
}

// A box round some faces of one body.
struct Part {
  std::array<double, 6> box;
  double size;  // of its largest face
  int body;
};

std::vector<double> sizes_of(const mesh::Surface& skin)
{
  std::vector<double> sizes;
  for (std::size_t f = 0; f < skin.faces.size(); ++f) sizes.push_back(corners_of(skin, f).size());
  return sizes;
}

// Of all ranks. Collective.
std::vector<Part> parts_of(const mesh::Surface& skin, const std::vector<Box>& boxes, const std::vector<double>& sizes,
                           const Communicator& comm)
{
  std::map<int, std::vector<int>> of_body;
  for (std::size_t f = 0; f < boxes.size(); ++f) of_body[skin.body[f]].push_back(static_cast<int>(f));
  std::vector<Part> parts;
  for (auto& [body, faces] : of_body)
    halve(boxes, faces, std::max<std::size_t>(4, 2 * faces.size() / most_boxes), [&](const Box& box, std::span<const int> some) {
      Part part{{box.min()[0], box.min()[1], box.min()[2], box.max()[0], box.max()[1], box.max()[2]}, 0, body};
      for (const int f : some) part.size = std::max(part.size, sizes[at(f)]);
      parts.push_back(part);
    });
  return comm.all_gather(parts);
}

// This rank's faces that have to do with another body. Collective.
mesh::Surface near_others(const mesh::Surface& skin, const Lengths& lengths, const Communicator& comm)
{
  const auto boxes = boxes_of_faces(skin);
  const auto sizes = sizes_of(skin);
  const auto parts = parts_of(skin, boxes, sizes, comm);
  std::vector<Box> part_boxes;
  std::vector<double> largest(lengths.diagonal.size(), 0.0);
  for (const auto& part : parts) {
    part_boxes.emplace_back(Point(part.box[0], part.box[1], part.box[2]), Point(part.box[3], part.box[4], part.box[5]));
    largest[at(part.body)] = std::max(largest[at(part.body)], part.size);
  }
  const Tree tree(part_boxes);
  std::vector<std::size_t> chosen;
  for (std::size_t f = 0; f < boxes.size(); ++f) {
    const int body = skin.body[f];
    double widest = 0;
    for (std::size_t b = 0; b < largest.size(); ++b)
      if (static_cast<int>(b) != body && largest[b] > 0)
        widest = std::max(widest, lengths.margin(sizes[f], body, largest[b], static_cast<int>(b)));
    const auto near = tree.meeting(grown(boxes[f], widest));
    if (std::any_of(near.begin(), near.end(), [&](int p) {
          const auto& part = parts[at(p)];
          return part.body != body &&
                 grown(boxes[f], lengths.margin(sizes[f], body, part.size, part.body)).intersects(part_boxes[at(p)]);
        }))
      chosen.push_back(f);
  }
  return part_of(skin, chosen);
}

// The near faces of all bodies, the same on every rank.
struct Skin {
  Side side;
  std::vector<Global> face_id;
  std::vector<int> body;           // of each face, as what follows
  std::vector<double> size, area;  // of the face through its corners
  std::vector<Point> normal;
  std::vector<Box> box;
  std::vector<FaceGeometry> facet;  // of each facet, as what follows
  std::vector<Point> facet_normal;

  std::size_t count() const { return body.size(); }
};

// Collective.
Skin gather_skin(const mesh::Surface& near, fem::Kinematics kinematics, const Communicator& comm)
{
  struct Owner {
    Global face;
    int body;
  };
  std::vector<Owner> owners;
  for (std::size_t f = 0; f < near.faces.size(); ++f) owners.push_back({near.face_id[f], near.body[f]});
  owners = comm.all_gather(owners);
  std::sort(owners.begin(), owners.end(), [](const Owner& a, const Owner& b) { return a.face < b.face; });
  Skin skin{gather(near, kinematics, comm), {}, {}, {}, {}, {}, {}, {}, {}};
  for (const auto& owner : owners) {
    skin.face_id.push_back(owner.face);
    skin.body.push_back(owner.body);
  }
  const auto& faces = skin.side.faces;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    FaceGeometry corners{mesh::first_order(faces.type[f]), {}};
    for (int k = 0; k < mesh::corner_count(faces.type[f]); ++k) corners.nodes.push_back(skin.side.points[at(faces[f][at(k)])]);
    skin.size.push_back(corners.size());
    skin.normal.push_back(corners.normal());
    Box box;
    for (const Local n : faces[f]) box.extend(skin.side.points[at(n)]);
    skin.box.push_back(box);
    skin.area.push_back(0);
  }
  for (std::size_t i = 0; i < skin.side.facets.size(); ++i) {
    skin.facet.push_back(skin.side.geometry(i));
    skin.facet_normal.push_back(skin.facet.back().normal());
    const auto corners = static_cast<Eigen::Index>(skin.facet.back().nodes.size());
    Eigen::Vector4d middle = Eigen::Vector4d::Zero();
    middle.head(corners).setConstant(1.0 / static_cast<double>(corners));
    skin.area[at(skin.side.face_of[i])] += skin.facet.back().area() * skin.side.thickness(i, middle);
  }
  return skin;
}

Tree tree_of(const std::vector<FaceGeometry>& faces)
{
  std::vector<Box> boxes(faces.size());
  for (std::size_t i = 0; i < faces.size(); ++i)
    for (const auto& x : faces[i].nodes) boxes[i].extend(x);
  return Tree(std::move(boxes));
}

// Where a line leaves or enters a body.
struct Crossing {
  double s;  // along the line
  int face;
  bool entered;  // the face looks back along the line
};

// What the line through `x` along `direction` crosses between -length and length, but the face it starts from.
std::vector<Crossing> cross_skin(const Point& x, const Point& direction, double length, int from, const Skin& skin,
                                 const Tree& facets)
{
  std::vector<Crossing> result;
  const Point point = Point::Constant(rounding * skin.size[at(from)]);
  for (const int i : facets.swept(Box(x - point, x + point), length * direction)) {
    const int face = skin.side.face_of[at(i)];
    if (face == from) continue;
    const double cosine = direction.dot(skin.facet_normal[at(i)]);
    if (std::abs(cosine) < -opposed) continue;
    const bool entered = cosine < 0;
    const auto hit = shoot(x, entered ? direction : Point(-direction), skin.facet[at(i)]);
    const double s = entered ? hit.distance : -hit.distance;
    if (hit.found && std::abs(s) <= length) result.push_back({s, face, entered});
  }
  return result;
}

// Whether nothing of the two bodies, in a gap nothing at all, lies between the start of the line and a crossing.
bool in_sight(const Crossing& seen, int from, const std::vector<Crossing>& crossings, const Skin& skin)
{
  const double nothing = 10 * rounding * std::max(skin.size[at(from)], skin.size[at(seen.face)]);
  const double low = std::min(seen.s, 0.0) + nothing, high = std::max(seen.s, 0.0) - nothing;
  return std::none_of(crossings.begin(), crossings.end(), [&](const Crossing& c) {
    const int body = skin.body[at(c.face)];
    const bool matters = seen.s > 0 || body == skin.body[at(from)] || body == skin.body[at(seen.face)];
    return matters && c.s > low && c.s < high;
  });
}

// Two faces that face each other, and how far apart they are at one place.
struct Facing {
  int face, other;
  double gap;
};

// What faces `face` on the line from `x`: the nearest, or several at one distance.
void look(const Point& x, const Point& direction, int face, const Lengths& lengths, const Skin& skin, const Tree& facets,
          std::vector<Facing>& result)
{
  const double size = skin.size[at(face)];
  const auto crossings = cross_skin(x, direction, lengths.longest(size), face, skin, facets);
  std::vector<Facing> seen;
  double nearest = std::numeric_limits<double>::infinity();
  for (const auto& c : crossings) {
    if (!c.entered || skin.body[at(c.face)] == skin.body[at(face)]) continue;
    const auto [least, largest] = lengths.window(size, skin.size[at(c.face)]);
    if (c.s < least || c.s > largest || !in_sight(c, face, crossings, skin)) continue;
    seen.push_back({face, c.face, c.s});
    nearest = std::min(nearest, std::abs(c.s));
  }
  for (const auto& f : seen)
    if (std::abs(f.gap) <= nearest + rounding * size) result.push_back(f);
}

// All faces that face each other, ordered. Collective.
std::vector<Facing> find_facing(const Skin& skin, const Tree& facets, const Lengths& lengths, const std::set<Bodies>& known,
                                const Communicator& comm)
{
  std::vector<Facing> mine;
  for (std::size_t i = static_cast<std::size_t>(comm.rank()); i < skin.facet.size(); i += static_cast<std::size_t>(comm.size())) {
    const int face = skin.side.face_of[i];
    const Point centre = skin.facet[i].centre();
    look(centre, skin.facet_normal[i], face, lengths, skin, facets, mine);
    for (const auto& corner : skin.facet[i].nodes)
      look(centre + to_corners * (corner - centre), skin.facet_normal[i], face, lengths, skin, facets, mine);
  }
  std::erase_if(mine,
                [&](const Facing& f) { return known.contains(std::minmax(skin.body[at(f.face)], skin.body[at(f.other)])); });
  auto all = comm.all_gather(mine);
  std::sort(all.begin(), all.end(),
            [](const Facing& a, const Facing& b) { return std::tie(a.face, a.other, a.gap) < std::tie(b.face, b.other, b.gap); });
  return all;
}

// For each face those that it goes on to without a kink.
std::vector<std::vector<int>> smooth_neighbours(const Skin& skin)
{
  struct Edge {
    std::array<Local, 2> nodes;
    int face;
  };
  std::vector<Edge> edges;
  const auto& faces = skin.side.faces;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const auto corners = at(mesh::corner_count(faces.type[f]));
    for (std::size_t k = 0; k < corners; ++k) {
      const Local a = faces[f][k], b = corners == 2 ? -1 : faces[f][(k + 1) % corners];
      edges.push_back({{std::min(a, b), std::max(a, b)}, static_cast<int>(f)});
    }
  }
  std::sort(edges.begin(), edges.end(),
            [](const Edge& a, const Edge& b) { return std::tie(a.nodes, a.face) < std::tie(b.nodes, b.face); });
  std::vector<std::vector<int>> result(faces.size());
  for (std::size_t i = 0; i < edges.size(); ++i)
    for (std::size_t j = i + 1; j < edges.size() && edges[j].nodes == edges[i].nodes; ++j) {
      const int a = edges[i].face, b = edges[j].face;
      if (skin.normal[at(a)].dot(skin.normal[at(b)]) < kink) continue;
      result[at(a)].push_back(b);
      result[at(b)].push_back(a);
    }
  return result;
}

// What all pairs of bodies share while their patches grow.
struct Ground {
  const Skin& skin;
  const Tree& facets;
  const Lengths& lengths;
  std::vector<std::vector<int>> neighbours;
  struct Body {
    std::vector<int> faces;
    double largest;  // size of these
    Tree tree;       // of their boxes
  };
  std::map<int, Body> of_body;
};

// Whether a face lies near enough to another body that its patch may need it.
bool near_body(int face, int other, const Ground& ground)
{
  const auto& skin = ground.skin;
  const auto& lengths = ground.lengths;
  const auto& [faces, largest, tree] = ground.of_body.at(other);
  const int body = skin.body[at(face)];
  const auto near = tree.meeting(grown(skin.box[at(face)], lengths.margin(skin.size[at(face)], body, largest, other)));
  return std::any_of(near.begin(), near.end(), [&](int i) {
    const int f = faces[at(i)];
    return grown(skin.box[at(face)], lengths.margin(skin.size[at(face)], body, skin.size[at(f)], other))
        .intersects(skin.box[at(f)]);
  });
}

// Whether a face meets another body only through one of the two: the far side of a thin body, which its patch must not reach.
bool is_far_side(int face, int other, double reach, const Ground& ground)
{
  const auto& skin = ground.skin;
  for (Local i = skin.side.first_facet[at(face)]; i < skin.side.first_facet[at(face) + 1]; ++i) {
    const auto crossings = cross_skin(skin.facet[at(i)].centre(), skin.facet_normal[at(i)], reach, face, skin, ground.facets);
    bool meets = false, sees = false;
    for (const auto& c : crossings) {
      if (!c.entered || skin.body[at(c.face)] != other) continue;
      meets = true;
      sees = sees || in_sight(c, face, crossings, skin);
    }
    if (meets && !sees) return true;
  }
  return false;
}

// A face of one of the patches in which two bodies meet.
struct Member {
  int pair, patch, face;
};

int root_of(std::map<int, int>& parent, int face)
{
  while (parent.at(face) != face) face = parent.at(face) = parent.at(parent.at(face));
  return face;
}

double reach_of(const std::vector<Facing>& facing, const Ground& ground)
{
  const auto& skin = ground.skin;
  const auto& lengths = ground.lengths;
  double largest = 0, widest = 0;
  for (const auto& f : facing) {
    const double a = skin.size[at(f.face)], b = skin.size[at(f.other)];
    largest = std::max({largest, a, b});
    widest = std::max({widest, lengths.window(a, b).second, -lengths.window(a, b).first});
  }
  if (lengths.bonded) return widest;
  return lengths.reach(largest, skin.body[at(facing.front().face)], skin.body[at(facing.front().other)]);
}

// The patches of one pair of bodies, numbered by their lowest faces.
void grow_patches(int pair, const Bodies& bodies, const std::vector<Facing>& facing, const Ground& ground,
                  std::vector<Member>& members)
{
  const auto& skin = ground.skin;
  const double reach = reach_of(facing, ground);
  std::map<int, int> parent;
  std::vector<int> open;
  for (const auto& f : facing)
    for (const int face : {f.face, f.other})
      if (parent.emplace(face, face).second) open.push_back(face);
  std::set<int> refused;
  while (!open.empty()) {
    const int face = open.back();
    open.pop_back();
    for (const int next : ground.neighbours[at(face)]) {
      if (parent.contains(next) || refused.contains(next)) continue;
      const int other = skin.body[at(next)] == bodies.first ? bodies.second : bodies.first;
      if (!near_body(next, other, ground) || is_far_side(next, other, reach, ground)) {
        refused.insert(next);
        continue;
      }
      parent.emplace(next, next);
      open.push_back(next);
    }
  }
  const auto join = [&](int a, int b) {
    const int x = root_of(parent, a), y = root_of(parent, b);
    parent.at(std::max(x, y)) = std::min(x, y);
  };
  for (const auto& [face, at_first] : parent)
    for (const int next : ground.neighbours[at(face)])
      if (parent.contains(next)) join(face, next);
  for (const auto& f : facing) join(f.face, f.other);
  std::map<int, int> patch;
  for (const auto& [face, above] : parent) {
    const int number = patch.emplace(root_of(parent, face), static_cast<int>(patch.size())).first->second;
    members.push_back({pair, number, face});
  }
}

// One body's part of a patch.
struct Half {
  int body = 0;
  std::vector<Global> faces;
  long long facing = 0;
  double area = 0;  // of the facing faces, as what follows
  Point normal = Point::Zero();

  double size(bool plane) const
  {
    const double mean = area / static_cast<double>(facing);
    return plane ? mean : std::sqrt(mean);
  }
  double flatness() const { return normal.norm() / area; }
};

bool is_secondary(const Half& a, const Half& b, bool plane)
{
  const double small = std::min(a.size(plane), b.size(plane)), large = std::max(a.size(plane), b.size(plane));
  if (large > (1 + finer) * small) return a.size(plane) < b.size(plane);
  if (std::abs(a.flatness() - b.flatness()) > flatter) return a.flatness() > b.flatness();
  return a.body < b.body;
}

// A patch as a contact; `facing` are those of its faces.
Meeting describe_meeting(const Bodies& bodies, const std::vector<int>& faces, const std::vector<Facing>& facing,
                         const Ground& ground)
{
  const auto& skin = ground.skin;
  std::array<Half, 2> halves;
  halves[0].body = bodies.first;
  halves[1].body = bodies.second;
  const auto half_of = [&](int face) -> Half& { return halves[skin.body[at(face)] == bodies.first ? 0 : 1]; };
  for (const int face : faces) half_of(face).faces.push_back(skin.face_id[at(face)]);
  std::set<int> seen;
  Meeting meeting;
  meeting.least_gap = std::numeric_limits<double>::infinity();
  meeting.largest_gap = -meeting.least_gap;
  for (const auto& f : facing) {
    seen.insert({f.face, f.other});
    meeting.least_gap = std::min(meeting.least_gap, f.gap);
    meeting.largest_gap = std::max(meeting.largest_gap, f.gap);
  }
  for (const int face : seen) {
    auto& half = half_of(face);
    ++half.facing;
    half.area += skin.area[at(face)];
    half.normal += skin.area[at(face)] * skin.normal[at(face)];
  }
  if (!is_secondary(halves[0], halves[1], fem::dimension(skin.side.kinematics) == 2)) std::swap(halves[0], halves[1]);
  meeting.secondary = halves[0].body;
  meeting.primary = halves[1].body;
  meeting.secondary_faces = std::move(halves[0].faces);
  meeting.primary_faces = std::move(halves[1].faces);
  meeting.secondary_facing = halves[0].facing;
  meeting.primary_facing = halves[1].facing;
  meeting.area = halves[0].area;
  meeting.reach = reach_of(facing, ground);
  return meeting;
}

}  // namespace

std::vector<Meeting> find_meetings(const mesh::Surface& skin, int bodies, const std::set<Bodies>& known, const Options& options,
                                   fem::Kinematics kinematics, const Communicator& comm)
{
  const Lengths lengths{options.search_distance, options.interference, options.law == Law::bonded, diagonals(skin, bodies, comm)};
  const auto near = gather_skin(near_others(skin, lengths, comm), kinematics, comm);
  const Tree facets = tree_of(near.facet);
  std::map<Bodies, std::vector<Facing>> pairs;
  for (const auto& f : find_facing(near, facets, lengths, known, comm))
    pairs[std::minmax(near.body[at(f.face)], near.body[at(f.other)])].push_back(f);

  Ground ground{near, facets, lengths, smooth_neighbours(near), {}};
  std::map<int, std::vector<int>> faces_of;
  for (std::size_t f = 0; f < near.count(); ++f) faces_of[near.body[f]].push_back(static_cast<int>(f));
  for (auto& [body, faces] : faces_of) {
    std::vector<Box> boxes;
    double largest = 0;
    for (const int f : faces) {
      boxes.push_back(near.box[at(f)]);
      largest = std::max(largest, near.size[at(f)]);
    }
    ground.of_body.emplace(body, Ground::Body{std::move(faces), largest, Tree(std::move(boxes))});
  }
  std::vector<Member> members;
  int number = 0;
  for (const auto& [two, facing] : pairs) {
    if (number % comm.size() == comm.rank()) grow_patches(number, two, facing, ground, members);
    ++number;
  }
  members = comm.all_gather(members);
  std::map<std::pair<int, int>, std::vector<int>> patches;  // pair, patch: faces
  for (const auto& m : members) patches[{m.pair, m.patch}].push_back(m.face);

  std::vector<Meeting> result;
  number = 0;
  for (const auto& [two, facing] : pairs) {
    const std::size_t first = result.size();
    for (auto patch = patches.lower_bound({number, 0}); patch != patches.end() && patch->first.first == number; ++patch) {
      std::vector<Facing> own;
      for (const auto& f : facing)
        if (std::binary_search(patch->second.begin(), patch->second.end(), f.face)) own.push_back(f);
      result.push_back(describe_meeting(two, patch->second, own, ground));
    }
    if (result.size() - first > 1)
      for (std::size_t i = first; i < result.size(); ++i) result[i].patch = static_cast<int>(i - first) + 1;
    ++number;
  }
  return result;
}

double widest_distance(const mesh::Surface& skin, const Communicator& comm)
{
  const auto sizes = sizes_of(skin);
  return part_of_face * comm.max(sizes.empty() ? 0.0 : *std::max_element(sizes.begin(), sizes.end()));
}

}  // namespace mortise::contact
