#include "search/share.hpp"

#include <algorithm>
#include <array>
#include <numeric>

#include "pairing/skin.hpp"
#include "search/boxes.hpp"
#include "surface/kinks.hpp"

namespace mortise::contact {

namespace {

// Parts into which a rank's share is cut at least: shares differ by so much in size.
constexpr long long parts_of_share = 32;
// Rows of a node need the integrals of the faces round the nodes of the faces round it, and where the points of their nodes lie,
// for which normals of their neighbours are compared.
constexpr double rings_of_integrals = 3;

// Some faces of a rank, which lie together.
struct FacesOfRank {
  std::array<double, 6> box;
  long long faces;
  int rank;  // that has them
};

Box box_of(const FacesOfRank& part)
{
  return Box(Point(part.box[0], part.box[1], part.box[2]), Point(part.box[3], part.box[4], part.box[5]));
}

// Gives the parts `order` to the ranks from `first` to before `last`, by their faces.
void deal_out(const std::vector<FacesOfRank>& parts, std::span<int> order, int first, int last, std::vector<int>& owner)
{
  if (last - first == 1 || order.empty()) {
    for (const int i : order) owner[static_cast<std::size_t>(i)] = first;
    return;
  }
  const auto part = [&](int i) -> const FacesOfRank& { return parts[static_cast<std::size_t>(i)]; };
  Box all;
  long long faces = 0;
  for (const int i : order) {
    all.extend(box_of(part(i)));
    faces += part(i).faces;
  }
  Eigen::Index axis = 0;
  all.sizes().maxCoeff(&axis);
  std::sort(order.begin(), order.end(), [&](int a, int b) {
    return std::pair(box_of(part(a)).center()[axis], a) < std::pair(box_of(part(b)).center()[axis], b);
  });
  const int middle = (first + last) / 2;
  const auto wanted = faces * (middle - first) / (last - first);
  std::size_t cut = 0;
  for (long long sum = 0; cut < order.size() && sum + part(order[cut]).faces / 2 < wanted; ++cut) sum += part(order[cut]).faces;
  deal_out(parts, order.first(cut), first, middle, owner);
  deal_out(parts, order.subspan(cut), middle, last, owner);
}

// The shares of all ranks, and which of this rank's faces are in which.
struct Shares {
  std::vector<FacesOfRank> parts;
  std::vector<int> owner;    // of each part
  std::vector<int> of_face;  // of each face of this rank
};

// Collective.
Shares deal_out(const std::vector<Box>& boxes, const Communicator& comm)
{
  const auto total = comm.sum(static_cast<long long>(boxes.size()));
  const auto most = std::max<long long>(4, total / (parts_of_share * comm.size()));
  std::vector<int> order(boxes.size());
  std::iota(order.begin(), order.end(), 0);
  std::vector<FacesOfRank> mine;
  std::vector<std::vector<int>> members;
  halve(boxes, order, static_cast<std::size_t>(most), [&](const Box& box, std::span<const int> some) {
    mine.push_back({{box.min()[0], box.min()[1], box.min()[2], box.max()[0], box.max()[1], box.max()[2]},
                    static_cast<long long>(some.size()),
                    comm.rank()});
    members.emplace_back(some.begin(), some.end());
  });
  Shares shares;
  shares.parts = comm.all_gather(mine);
  shares.owner.resize(shares.parts.size());
  std::vector<int> all(shares.parts.size());
  std::iota(all.begin(), all.end(), 0);
  deal_out(shares.parts, all, 0, comm.size(), shares.owner);
  shares.of_face.resize(boxes.size());
  std::size_t next = 0;
  for (std::size_t p = 0; p < shares.parts.size(); ++p) {
    if (shares.parts[p].rank != comm.rank()) continue;
    for (const int face : members[next]) shares.of_face[static_cast<std::size_t>(face)] = shares.owner[p];
    ++next;
  }
  return shares;
}

// Sends each face, with its nodes, to the ranks whose shares it is nearer to than `distance`. Collective.
Side deliver(const mesh::Surface& surface, const std::vector<Box>& boxes, const Shares& shares, const Tree& parts,
             std::span<const int> owner, double distance, fem::Kinematics kinematics, std::vector<SentFace>& faces,
             const Communicator& comm)
{
  std::vector<std::vector<std::size_t>> chosen(static_cast<std::size_t>(comm.size()));
  std::vector<int> met;
  for (std::size_t f = 0; f < boxes.size(); ++f) {
    parts.candidates(grown(boxes[f], distance), met);
    for (const int part : met) {
      auto& faces_of = chosen[static_cast<std::size_t>(shares.owner[static_cast<std::size_t>(part)])];
      if (faces_of.empty() || faces_of.back() != f) faces_of.push_back(f);
    }
  }
  SentSurface received;
  for (const auto& part : exchange_faces(surface, chosen, owner, comm)) unpack(part, received);
  faces = std::move(received.faces);
  return assemble(std::move(received.nodes), faces, kinematics);
}

}  // namespace

Share share_out(const Pair& pair, const PairSize& size, fem::Kinematics kinematics, const Communicator& comm)
{
  const mesh::Surface secondary = near_secondary(pair, size, comm);
  const auto boxes = boxes_of_faces(secondary);
  const auto shares = deal_out(boxes, comm);
  std::vector<Box> round;
  for (const auto& part : shares.parts) round.push_back(box_of(part));
  const Tree parts(std::move(round));

  Share share;
  std::vector<SentFace> faces;
  const double ring = slack * std::max(size.secondary_face, size.primary_face), round_it = (rings_of_integrals + rings) * ring;
  // What stands between a face and what it would meet.
  share.secondary = deliver(secondary, boxes, shares, parts, shares.of_face, size.reach + round_it, kinematics, faces, comm);
  share.own.assign(share.secondary.points.size(), 0);
  for (std::size_t f = faces.size(); f > 0; --f)
    for (const Local n : share.secondary.faces[f - 1])
      share.own[static_cast<std::size_t>(n)] = faces[f - 1].mark == comm.rank() ? 1 : 0;
  if (!pair.primary) {
    find_kinks(share.secondary);
    return share;
  }
  // Rays go twice as far as the search.
  share.primary = deliver(*pair.primary, boxes_of_faces(*pair.primary), shares, parts, {}, 2 * size.reach + round_it, kinematics,
                          faces, comm);
  find_kinks(share.secondary, share.primary);
  return share;
}

}  // namespace mortise::contact
