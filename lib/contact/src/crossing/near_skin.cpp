#include "crossing/near_skin.hpp"

#include <numeric>

#include "search/boxes.hpp"

namespace mortise::contact {

namespace {

// Of the faces of all ranks the largest of each body. Collective.
std::vector<double> largest_faces(const mesh::Surface& near, int bodies, const Communicator& comm)
{
  const auto sizes = sizes_of(near);
  std::vector<double> largest(at(bodies), 0.0);
  for (std::size_t f = 0; f < sizes.size(); ++f) largest[at(near.body[f])] = std::max(largest[at(near.body[f])], sizes[f]);
  const auto all = comm.all_gather(largest);
  for (std::size_t i = 0; i < all.size(); ++i) largest[i % at(bodies)] = std::max(largest[i % at(bodies)], all[i]);
  return largest;
}

// The faces of `all` that are in `some`, whose faces come in the same order.
mesh::Surface same_faces(const mesh::Surface& all, const mesh::Surface& some)
{
  std::vector<std::size_t> chosen;
  for (std::size_t f = 0; f < all.faces.size() && chosen.size() < some.face_id.size(); ++f)
    if (all.face_id[f] == some.face_id[chosen.size()]) chosen.push_back(f);
  return part_of(all, chosen);
}

}  // namespace

NearSkin::NearSkin(const mesh::Surface& now, int bodies, const Lengths& lengths, double reach, fem::Kinematics kinematics,
                   const Communicator& comm)
{
  const PiecesOfBodies pieces(now, bodies, comm);
  near_ = pieces.near_others(now, lengths);
  needed_ = pieces.needed_by_ranks(near_, reach, largest_faces(near_, bodies, comm), comm);
  auto& own = needed_[at(comm.rank())];
  own.resize(near_.faces.size());
  std::iota(own.begin(), own.end(), std::size_t{0});

  SentSurface received;
  std::vector<std::pair<Global, int>> rank_of;  // of faces, by their numbers
  const auto messages = exchange_faces(near_, needed_, near_.body, comm);
  for (int r = 0; r < comm.size(); ++r) {
    const std::size_t before = received.faces.size();
    unpack(messages[at(r)], received);
    for (std::size_t f = before; f < received.faces.size(); ++f) rank_of.emplace_back(received.faces[f].id, r);
  }
  std::sort(rank_of.begin(), rank_of.end());
  for (const auto& [face, rank] : rank_of) rank_.push_back(rank);
  Side side = assemble(std::move(received.nodes), received.faces, kinematics);
  std::vector<int> bodies_of_faces;
  for (const auto& face : received.faces) bodies_of_faces.push_back(face.mark);
  skin_ = skin_of(std::move(side), std::move(bodies_of_faces));
}

std::vector<Point> NearSkin::points_of(const mesh::Surface& surface, const Communicator& comm) const
{
  SentSurface received;
  for (const auto& message : exchange_nodes(same_faces(surface, near_), needed_, comm)) unpack(message, received);
  return points_in_order(std::move(received.nodes));
}

}  // namespace mortise::contact
