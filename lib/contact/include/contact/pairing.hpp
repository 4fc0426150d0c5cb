// Which bodies can meet: outer faces of different bodies that face each other, with or without a name. The deck's
// `contacts: auto`.
//
// From places of every face a line goes along its normal, both ways. What looks back at it there, near enough and with nothing of
// the two bodies between, faces it: so the two sides of a plate do not meet through it, and bodies that overlap do. From the
// faces found a patch grows over edges without a kink as far as the contact can reach, so that there is room for the zone of
// contact. The faces near other bodies stand on every rank; the work is shared out.
#pragma once

#include <set>
#include <utility>
#include <vector>

#include "base/communicator.hpp"
#include "contact/options.hpp"
#include "fem/options.hpp"
#include "mesh/mesh.hpp"

namespace mortise::contact {

/// Two bodies, the lower number first.
using Bodies = std::pair<int, int>;

/// Faces of two bodies that face each other, and those round them: one contact. The same on every rank.
struct ContactCandidate {
  int secondary = 0, primary = 0;                      ///< bodies
  int patch = 0;                                       ///< 1, 2, ... if these bodies meet in several patches; 0: in one
  std::vector<Global> secondary_faces, primary_faces;  ///< Surface::face_id, ascending
  /// How many of them face the other body within the distance that is searched.
  long long secondary_facing = 0, primary_facing = 0;
  double area = 0;  ///< of the facing faces of the secondary side; in axisymmetry of the whole turn
  /// Between the flat faces, so that of curved bodies the bulge of the faces is missing; negative: they overlap.
  double least_gap = 0, largest_gap = 0;
  double reach = 0;  ///< for Options::search_distance of the contact
};

/// All pairs of bodies that face each other but those in `known`, ordered by bodies. `skin`: the outer surface of all bodies,
/// this rank's faces; `bodies`: how many there are. Of `options` the search distance, the interference and whether the contact is
/// bonded are used.
///
/// Faces f and g face each other if the line along the normal of one meets the other, their normals are opposed, and the gap is
/// at most search_distance or, if that is 0, half the size (the longest distance of two corners) of the smaller one of f and g. A
/// positive interference is added to the gaps that are searched, a negative one to the overlaps.
/// Patches are connected by edges that turn by less than about 40 degrees and by what faces each other. The secondary side is the
/// one with the smaller faces by more than a tenth (square root of the mean area; plane models: mean length), else the flatter
/// one, else that of the lower body.
/// The reach is search_distance or, if that is 0, the size of the largest facing face, or a fiftieth of the diagonal of the
/// smaller body where that is more; bonded sides are tied only where they face each other within the distance above. Collective.
std::vector<ContactCandidate> find_contact_candidates(const mesh::Surface& skin, int bodies, const std::set<Bodies>& known,
                                                      const Options& options, fem::Kinematics kinematics,
                                                      const Communicator& comm);

/// The largest distance that find_contact_candidates() searches if the deck gives none. Collective.
double widest_distance(const mesh::Surface& skin, const Communicator& comm);

}  // namespace mortise::contact
