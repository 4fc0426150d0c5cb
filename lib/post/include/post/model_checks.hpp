// What can be seen of a model before it is solved: materials, units and contacts that do not go together.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "base/warning.hpp"
#include "contact/mortar.hpp"
#include "fem/options.hpp"
#include "post/bodies.hpp"

namespace mortise::post {

/// A material of a body; a body of several materials has an entry for each.
struct BodyMaterial {
  std::string body;
  double size = 0;  ///< of the body, see body_sizes()
  fem::Material material;
  fem::Formulation formulation = fem::Formulation::standard;
  bool first_order = true;  ///< some cell of it has straight edges
  bool weighs = false;      ///< a load on it uses the density
};

/// "locking": Poisson's ratio above 0.45 with standard cells of first order, which are then far too stiff; plane stress is
/// exempt, as are the formulations for such materials.
std::vector<Warning> locking(const std::vector<BodyMaterial>& bodies, fem::Kinematics kinematics);

/// A load on a boundary.
struct AppliedStress {
  std::string boundary;
  double stress = 0;         ///< its force over the boundary's area
  double young_modulus = 0;  ///< of its bodies, the smallest
};

/// "mixed_units": a load above a tenth of Young's modulus, or below its 1e-9th part; a wave that takes longer than a second to
/// cross a body, or less than 1e-10 s, by its size over sqrt(E / density) (7850 kg/m3 with MPa and mm: 20 s for 100 mm); a
/// density that loads use and that is no real material's beside Young's modulus in any consistent set of units, but is one's in
/// kg/mm3 beside MPa, or by another such mistake.
std::vector<Warning> mixed_units(const std::vector<BodyMaterial>& bodies, const std::vector<AppliedStress>& loads);

/// "mixed_units" of a solution: neither loads on boundaries nor the largest von Mises stress reach 1e-8 of Young's modulus, as
/// with pressures in MPa beside a modulus in Pa. `loads`: the largest of all states; none if one of them is not known. `modulus`:
/// the smallest of all bodies, `bodies`: their names.
std::vector<Warning> weak_stresses(const std::vector<AppliedStress>& loads, const Found& von_mises, double modulus,
                                   const std::vector<std::string>& bodies);

/// "doubled_contact": two contacts have faces in common on both of their sides, so that each presses as if the other were not
/// there. Collective.
std::vector<Warning> doubled_contacts(std::span<const contact::Pair> pairs, const Communicator& comm);

/// "overlap": the sides of a contact overlap before any load, and no `interference` asks for it, but for a tenth of that; bonded
/// ones may. One for each contact, the largest overlap first. `gaps`: of each of `contacts`, the same on every rank.
std::vector<Warning> unasked_overlaps(std::span<const contact::InitialGap> gaps, std::span<const contact::Options> contacts);

/// "uneven_clearance": `clearance` stands for gaps of the meshes that differ by more than a quarter of the longest secondary
/// face: no error of meshes is as large; a chamfer, a relief or a lead-in is part of the contact and pressed like its fit. As
/// above.
std::vector<Warning> uneven_clearances(std::span<const contact::InitialGap> gaps, std::span<const contact::Options> contacts);

/// "coarse_arc": one face of a contact that touches over more than half of its area spans more than 28 degrees of a round surface,
/// as of a circle of twelve faces, or is a flat on one; or more than 20 where the contact touches nowhere, but would on flats:
/// what such a face stands back by between its nodes is not seen. As above.
std::vector<Warning> coarse_arcs(std::span<const contact::InitialGap> gaps, std::span<const contact::Options> contacts);

/// "bonded_gap": a bonded contact whose sides touch nowhere, with gaps above a fiftieth of the longest secondary face, or touch
/// in part, with gaps above a quarter of it elsewhere: what is between them pulls and shears as if it were there. As above;
/// pretension sections aside.
std::vector<Warning> bonded_gaps(std::span<const contact::InitialGap> gaps, std::span<const contact::Options> contacts);

}  // namespace mortise::post
