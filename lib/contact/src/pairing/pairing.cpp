#include "contact/pairing.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "pairing/facing.hpp"
#include "pairing/patches.hpp"
#include "pairing/skin.hpp"

namespace mortise::contact {

namespace {

// Sides whose sizes or flatness differ by less are equal.
constexpr double finer = 0.1, flatter = 1e-3;

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
ContactCandidate describe_candidate(const Bodies& bodies, const std::vector<int>& faces, const std::vector<Facing>& facing,
                                    const Ground& ground)
{
  const auto& skin = ground.skin;
  std::array<Half, 2> halves;
  halves[0].body = bodies.first;
  halves[1].body = bodies.second;
  const auto half_of = [&](int face) -> Half& { return halves[skin.body[at(face)] == bodies.first ? 0 : 1]; };
  for (const int face : faces) half_of(face).faces.push_back(skin.face_id[at(face)]);
  std::set<int> seen;
  ContactCandidate candidate;
  candidate.least_gap = std::numeric_limits<double>::infinity();
  candidate.largest_gap = -candidate.least_gap;
  for (const auto& f : facing) {
    seen.insert({f.face, f.other});
    candidate.least_gap = std::min(candidate.least_gap, f.gap);
    candidate.largest_gap = std::max(candidate.largest_gap, f.gap);
  }
  for (const int face : seen) {
    auto& half = half_of(face);
    ++half.facing;
    half.area += skin.area[at(face)];
    half.normal += skin.area[at(face)] * skin.normal[at(face)];
  }
  if (!is_secondary(halves[0], halves[1], fem::dimension(skin.side.kinematics) == 2)) std::swap(halves[0], halves[1]);
  candidate.secondary = halves[0].body;
  candidate.primary = halves[1].body;
  candidate.secondary_faces = std::move(halves[0].faces);
  candidate.primary_faces = std::move(halves[1].faces);
  candidate.secondary_facing = halves[0].facing;
  candidate.primary_facing = halves[1].facing;
  candidate.area = halves[0].area;
  candidate.reach = reach_of(facing, ground);
  return candidate;
}

}  // namespace

std::vector<ContactCandidate> find_contact_candidates(const mesh::Surface& skin, int bodies, const std::set<Bodies>& known,
                                                      const Options& options, fem::Kinematics kinematics,
                                                      const Communicator& comm)
{
  const Lengths lengths{options.search_distance, options.interference, options.law == Law::bonded, diagonals(skin, bodies, comm)};
  const auto near = gather_skin(PiecesOfBodies(skin, bodies, comm).near_others(skin, lengths), kinematics, comm);
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

  std::vector<ContactCandidate> result;
  number = 0;
  for (const auto& [two, facing] : pairs) {
    const std::size_t first = result.size();
    for (auto patch = patches.lower_bound({number, 0}); patch != patches.end() && patch->first.first == number; ++patch) {
      std::vector<Facing> own;
      for (const auto& f : facing)
        if (std::binary_search(patch->second.begin(), patch->second.end(), f.face)) own.push_back(f);
      result.push_back(describe_candidate(two, patch->second, own, ground));
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
