#include "post/model_checks.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "densities.hpp"
#include "wording.hpp"

namespace mortise::post {

namespace {

constexpr double nearly_incompressible = 0.45;
constexpr double most_stress = 0.1, least_stress = 1e-9;  // over Young's modulus
constexpr double weak_stress = 1e-8;                      // the same, where no stress of the solution is larger either
// Of an interference: an overlap of the meshes below this part of it is their error.
constexpr double part_of_interference = 0.1;
// Of a face: no mesh is wrong by more. A polygon of eight faces a turn lies a tenth of one beside its circle.
constexpr double part_of_longest_face = 0.25;
// Of a face: so far apart bonded sides that touch nowhere may be.
constexpr double bonded_apart = 0.02;
constexpr double longest = 1, shortest = 1e-10;  // seconds, or whatever unit: a wave through a body

Warning stress_in_other_units(const AppliedStress& load)
{
  const double part = load.stress / load.young_modulus;
  Warning w{"mixed_units",
            fmt::format("the load on \"{}\" is {:.3g} on the average, {:.2g} of Young's modulus {:.4g}: units look mixed",
                        load.boundary, load.stress, part, load.young_modulus),
            "take one set: N, mm, MPa, t/mm3, or N, m, Pa, kg/m3; look at mesh.scale as well"};
  w.boundary = load.boundary;
  w.value = part;
  w.limit = part > most_stress ? most_stress : least_stress;
  return w;
}

Warning density_in_other_units(const BodyMaterial& b, const OtherDensity& other)
{
  const double factor = b.material.density / other.density;
  Warning w{
      "mixed_units",
      fmt::format("density {:.4g} of body \"{}\" is in {} beside Young's modulus {:.4g} in {}, as far as numbers tell: units "
                  "look mixed, and what it weighs is {:.4g} times what it should be",
                  b.material.density, b.body, other.given, b.material.modulus(), other.stress, factor),
      fmt::format("density: {:.4g}, {}", other.density, other.wanted)};
  w.body = b.body;
  w.value = factor;
  w.limit = 1;
  return w;
}

// By how much the sides overlap without being told to.
double unasked_overlap(const contact::InitialGap& gap, const contact::Options& contact)
{
  if (contact.law == contact::Law::bonded || !gap.overlaps()) return 0;
  const double overlap = gap.largest_overlap();
  const double asked = contact.interference > 0 ? part_of_interference * contact.interference : -contact.interference;
  return overlap > asked ? overlap : 0;
}

Warning overlap_warning(const contact::InitialGap& gap, const contact::Options& contact)
{
  const double overlap = gap.largest_overlap();
  Warning warning{
      "overlap",
      fmt::format("contact {}: the two sides overlap by {:.3g} at ({:.5g}, {:.5g}, {:.5g}) before any load, which presses them "
                  "together and which `interference` does not ask for",
                  contact.name, overlap, gap.at[0], gap.at[1], gap.at[2]),
      fmt::format(
          "if it is the meshes' error: `adjust: {:.2g}`, or `clearance: 0` where the two fit; if it is meant: `clearance: "
          "0, interference: {:.3g}`",
          1.1 * overlap, overlap + std::max(contact.interference, 0.0))};
  warning.at = Point(gap.at[0], gap.at[1], gap.at[2]);
  warning.contact = contact.name;
  warning.value = overlap;
  return warning;
}

}  // namespace

std::vector<Warning> locking(const std::vector<BodyMaterial>& bodies, fem::Kinematics kinematics)
{
  if (kinematics == fem::Kinematics::plane_stress) return {};
  std::vector<Warning> result;
  for (const auto& b : bodies) {
    if (!(b.material.poisson_ratio > nearly_incompressible) || b.formulation != fem::Formulation::standard || !b.first_order)
      continue;
    Warning w{
        "locking",
        fmt::format("body \"{}\" has Poisson's ratio {:.4g} and standard cells of first order, which lock: it is far too stiff",
                    b.body, b.material.poisson_ratio),
        "formulation: bbar (hex8, quad4, prism6), or cells of second order (mesh.order: 2)"};
    w.body = b.body;
    w.value = b.material.poisson_ratio;
    w.limit = nearly_incompressible;
    result.push_back(std::move(w));
  }
  return worst(std::move(result), "bodies");
}

std::vector<Warning> mixed_units(const std::vector<BodyMaterial>& bodies, const std::vector<AppliedStress>& loads)
{
  std::vector<Warning> too_large, too_small, waves, densities;
  for (const auto& load : loads) {
    if (!(load.stress > 0) || !(load.young_modulus > 0)) continue;
    const double part = load.stress / load.young_modulus;
    if (part > most_stress) too_large.push_back(stress_in_other_units(load));
    if (part < least_stress) too_small.push_back(stress_in_other_units(load));
  }
  for (const auto& b : bodies) {
    if (!(b.material.density > 0)) continue;
    if (const auto other = other_density(b.material.modulus(), b.material.density); b.weighs && other) {
      densities.push_back(density_in_other_units(b, *other));
      continue;
    }
    const double time = b.size / std::sqrt(b.material.modulus() / b.material.density);
    if (time <= longest && time >= shortest) continue;
    Warning w{"mixed_units",
              fmt::format(
                  "a sound wave would take {:.2g} s through body \"{}\" of size {:.3g} (Young's modulus {:.4g}, density {:.4g}): "
                  "units look mixed",
                  time, b.body, b.size, b.material.modulus(), b.material.density),
              "take one set: N, mm, MPa and density in t/mm3 (steel 7.85e-9), or N, m, Pa and kg/m3"};
    w.body = b.body;
    w.value = time;
    w.limit = time > longest ? longest : shortest;
    waves.push_back(std::move(w));
  }
  std::vector<Warning> result;
  for (auto& group : {worst(std::move(too_large), "loads"), worst(std::move(too_small), "loads"),
                      worst(std::move(waves), "bodies"), worst(std::move(densities), "bodies")})
    result.insert(result.end(), group.begin(), group.end());
  return result;
}

std::vector<Warning> weak_stresses(const std::vector<AppliedStress>& loads, const Found& von_mises, double modulus,
                                   const std::vector<std::string>& bodies)
{
  const double limit = weak_stress * modulus;
  const auto known = [&](const AppliedStress& load) {  // and not told by mixed_units() already
    return load.stress >= least_stress * load.young_modulus && load.stress < weak_stress * load.young_modulus;
  };
  if (loads.empty() || !std::ranges::all_of(loads, known) || von_mises.body < 0 || !(von_mises.value > 0) ||
      !(von_mises.value < limit))
    return {};
  const auto& most = *std::ranges::max_element(loads, {}, &AppliedStress::stress);
  Warning w{
      "mixed_units",
      fmt::format("the largest stress is {:.3g} (von Mises, in body \"{}\" at {}), the largest load {:.3g} on the average, on "
                  "\"{}\": {:.2g} of Young's modulus {:.4g}, hardly a strain at all: units look mixed",
                  von_mises.value, bodies[static_cast<std::size_t>(von_mises.body)], spell(von_mises.at), most.stress,
                  most.boundary, von_mises.value / modulus, modulus),
      "take one set: N, mm, MPa, or N, m, Pa; a load of 250 MPa beside a modulus in Pa is 250e6"};
  w.at = von_mises.at;
  w.body = bodies[static_cast<std::size_t>(von_mises.body)];
  w.boundary = most.boundary;
  w.value = von_mises.value / modulus;
  w.limit = weak_stress;
  return {w};
}

std::vector<Warning> doubled_contacts(std::span<const contact::Pair> pairs, const Communicator& comm)
{
  // For each face of this rank the sides it is on, 2 * contact + (0 primary, 1 secondary); a face stands on one rank. Most faces
  // have the same ones as their neighbours.
  std::map<Global, std::vector<int>> sides;
  std::map<Global, Point> places;
  for (std::size_t c = 0; c < pairs.size(); ++c)
    for (const int side : {0, 1}) {
      if (side == 0 && !pairs[c].primary) continue;
      const auto& surface = side == 1 ? pairs[c].secondary : *pairs[c].primary;
      for (std::size_t f = 0; f < surface.faces.size(); ++f) {
        sides[surface.face_id[f]].push_back(2 * static_cast<int>(c) + side);
        places.emplace(surface.face_id[f], surface.points[static_cast<std::size_t>(surface.faces[f].front())]);
      }
    }
  std::map<std::vector<int>, Global> kinds;  // and a face of each
  for (const auto& [face, on] : sides)
    if (on.size() > 1) kinds.emplace(on, face);
  // Two contacts that share a face, and by which sides; the place for messages is that of the lowest face.
  struct Shared {
    int first, second;  // sides
    Global face;
    double x, y, z;
  };
  std::map<std::pair<int, int>, Global> pairs_of_sides;
  for (const auto& [on, face] : kinds)
    for (std::size_t j = 0; j < on.size(); ++j)
      for (std::size_t i = 0; i < j; ++i)
        if (on[i] / 2 != on[j] / 2) pairs_of_sides.emplace(std::pair(on[i], on[j]), face);
  std::vector<Shared> mine;
  for (const auto& [both, face] : pairs_of_sides) {
    const Point& at = places.at(face);
    mine.push_back({both.first, both.second, face, at[0], at[1], at[2]});
  }
  std::map<std::pair<int, int>, Shared> shared;
  for (const auto& s : comm.all_gather(mine)) {
    const auto [place, fresh] = shared.emplace(std::pair(s.first, s.second), s);
    if (!fresh && s.face < place->second.face) place->second = s;
  }
  std::vector<Warning> result;
  for (const auto& [both, at] : shared) {
    if (both.first % 2 == 0) continue;  // seen from its secondary side
    if (!shared.contains({both.first - 1, both.second % 2 == 1 ? both.second - 1 : both.second + 1})) continue;
    const auto &a = pairs[static_cast<std::size_t>(both.first / 2)].options,
               &b = pairs[static_cast<std::size_t>(both.second / 2)].options;
    Warning w{
        "doubled_contact",
        fmt::format("contacts {} and {} have faces in common on both sides, as at {}: each acts there as if the other were not",
                    a.name, b.name, spell({at.x, at.y, at.z})),
        "leave one of them out, or narrow their boundaries"};
    w.at = Point(at.x, at.y, at.z);
    w.contact = a.name;
    w.boundary = a.secondary;
    w.value = 2;
    w.limit = 1;
    result.push_back(std::move(w));
  }
  return worst(std::move(result), "pairs of contacts");
}

std::vector<Warning> unasked_overlaps(std::span<const contact::InitialGap> gaps, std::span<const contact::Options> contacts)
{
  std::vector<std::size_t> overlapping;
  for (std::size_t c = 0; c < gaps.size(); ++c)
    if (gaps[c].area > 0 && unasked_overlap(gaps[c], contacts[c]) != 0) overlapping.push_back(c);
  std::stable_sort(overlapping.begin(), overlapping.end(),
                   [&](std::size_t a, std::size_t b) { return gaps[a].smallest < gaps[b].smallest; });
  std::vector<Warning> warnings;
  for (const std::size_t c : overlapping) warnings.push_back(overlap_warning(gaps[c], contacts[c]));
  return warnings;
}

std::vector<Warning> uneven_clearances(std::span<const contact::InitialGap> gaps, std::span<const contact::Options> contacts)
{
  std::vector<Warning> result;
  for (std::size_t c = 0; c < gaps.size(); ++c) {
    const auto& gap = gaps[c];
    const double spread = gap.mesh_largest - gap.mesh_smallest, limit = part_of_longest_face * gap.face;
    if (!contacts[c].clearance || !(gap.area > 0) || !(spread > limit)) continue;
    Warning warning{
        "uneven_clearance",
        fmt::format(
            "contact {}: `clearance` makes a gap of {:.3g} of gaps of {:.3g} to {:.3g}, which is at ({:.5g}, {:.5g}, {:.5g}): "
            "that is more than the meshes can be wrong, and what lies there is pressed like the rest",
            contacts[c].name, *contacts[c].clearance, gap.mesh_smallest, gap.mesh_largest, gap.mesh_largest_at[0],
            gap.mesh_largest_at[1], gap.mesh_largest_at[2]),
        "name the faces that fit alone, without chamfers and reliefs; or `adjust` in place of `clearance`, which leaves larger "
        "gaps"};
    warning.at = Point(gap.mesh_largest_at.data());
    warning.contact = contacts[c].name;
    warning.value = spread;
    warning.limit = limit;
    result.push_back(std::move(warning));
  }
  return worst(std::move(result), "contacts");
}

std::vector<Warning> coarse_arcs(std::span<const contact::InitialGap> gaps, std::span<const contact::Options> contacts)
{
  constexpr double degree = std::numbers::pi / 180, limit_touching = 28, limit_apart = 20, touching = 0.5;
  std::vector<Warning> result;
  for (std::size_t c = 0; c < gaps.size(); ++c) {
    const auto& gap = gaps[c];
    const bool touches = gap.near_area > touching * gap.area, stands_off = gap.smallest > gap.touching;
    const double limit = stands_off ? limit_apart : limit_touching;
    if (!(gap.turn > limit * degree) || !(touches || stands_off)) continue;
    Warning warning{
        "coarse_arc",
        fmt::format("contact {}: a face at ({:.5g}, {:.5g}, {:.5g}) spans {:.0f} degrees of a round surface and stands back from "
                    "it by {:.3g} between its nodes; that is taken for an error of the mesh, and the side for round",
                    contacts[c].name, gap.turn_at[0], gap.turn_at[1], gap.turn_at[2], gap.turn / degree, gap.rise),
        "if the side is round, make its faces smaller; if it has flats, mesh each with two faces or more across"};
    warning.at = Point(gap.turn_at.data());
    warning.contact = contacts[c].name;
    warning.value = gap.turn / degree;
    warning.limit = limit;
    result.push_back(std::move(warning));
  }
  return worst(std::move(result), "contacts");
}

std::vector<Warning> bonded_gaps(std::span<const contact::InitialGap> gaps, std::span<const contact::Options> contacts)
{
  std::vector<Warning> result;
  for (std::size_t c = 0; c < gaps.size(); ++c) {
    const auto& gap = gaps[c];
    if (contacts[c].law != contact::Law::bonded || contacts[c].preload || contacts[c].cyclic || !(gap.area > 0)) continue;
    const bool nowhere = gap.mesh_smallest > bonded_apart * gap.face;  // they touch
    const double apart = nowhere ? gap.mesh_smallest : gap.mesh_largest;
    const double limit = (nowhere ? bonded_apart : part_of_longest_face) * gap.face;
    if (!(apart > limit)) continue;
    const auto where =
        fmt::format("at ({:.5g}, {:.5g}, {:.5g})", gap.mesh_largest_at[0], gap.mesh_largest_at[1], gap.mesh_largest_at[2]);
    Warning warning{
        "bonded_gap",
        nowhere
            ? fmt::format("contact {} bonds sides that touch nowhere: they are {:.3g} to {:.3g} apart, which is {}, and move as "
                          "if there were something between them",
                          contacts[c].name, gap.mesh_smallest, gap.mesh_largest, where)
            : fmt::format("contact {} bonds what touches, and what is up to {:.3g} apart besides, which is {}: that is more than "
                          "the meshes can be wrong, and moves as if there were something between",
                          contacts[c].name, gap.mesh_largest, where),
        fmt::format("if {} to be apart: a `search_distance` below {:.3g}, or name the {} that are bonded",
                    nowhere ? "they are" : "that is", apart, nowhere ? "pairs" : "faces")};
    warning.at = Point(gap.mesh_largest_at.data());
    warning.contact = contacts[c].name;
    warning.value = apart;
    warning.limit = limit;
    result.push_back(std::move(warning));
  }
  return worst(std::move(result), "contacts");
}

}  // namespace mortise::post
