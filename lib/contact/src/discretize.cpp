#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <tuple>

#include "base/error.hpp"
#include "contact/mortar.hpp"
#include "face_integrals.hpp"
#include "held_nodes.hpp"
#include "near.hpp"

namespace mortise::contact {

namespace {

// A place covered by less than this part of its surroundings gets no multiplier.
constexpr double least_cover = 0.05;

// One contact on its way from faces to rows.
class Builder {
 public:
  Builder(const Options& options, const NearFaces& near, double reach, int index, std::span<const constraint::Held> held,
          std::span<const constraint::Inclined> inclined, fem::Kinematics kinematics, const Communicator& comm)
      : options_(options),
        index_(index),
        dimension_(fem::dimension(kinematics)),
        comm_(comm),
        secondary_(gather(near.secondary, kinematics, comm)),
        primary_(gather(near.primary, kinematics, comm)),
        places_(find_places(secondary_)),
        primary_places_(find_places(primary_)),
        held_(held, inclined, secondary_.node_id, comm),
        primary_held_(held, inclined, primary_.node_id, comm),
        reach_(reach)
  {
    if (options.obstacle) stand_on(*options.obstacle);
  }

  // Adds the rows of the places that this rank owns. Collective.
  void add_rows(constraint::Contacts& contacts)
  {
    integrate_faces();
    choose_places();
    const auto terms = exchange_terms();
    auto term = terms.begin();
    for (std::size_t p = first_place(comm_.rank()); p < first_place(comm_.rank() + 1); ++p) {
      const auto begin = term;
      while (term != terms.end() && term->place == static_cast<Local>(p)) ++term;
      if (kept_[p] && d_[static_cast<Eigen::Index>(p)] > 0) add_point(p, {begin, term}, contacts);
    }
    const double crossing = comm_.max(crossing_);
    if (crossing > 1e-9 * reach_)
      throw Error(
          ExitStatus::bad_input,
          fmt::format("contact {}: supports hold both sides and push them {:.3g} into each other; change one of the supports",
                      options_.name, crossing));
  }

 private:
  std::size_t first_face(int rank) const
  {
    return secondary_.faces.size() * static_cast<std::size_t>(rank) / static_cast<std::size_t>(comm_.size());
  }
  std::size_t first_place(int rank) const
  {
    return places_.all.size() * static_cast<std::size_t>(rank) / static_cast<std::size_t>(comm_.size());
  }
  std::span<const Local> node_places(std::size_t face) const
  {
    return std::span(places_.of_node)
        .subspan(static_cast<std::size_t>(secondary_.faces.offset[face]), secondary_.faces[face].size());
  }

  // The directions of contact are the obstacle's normals; where a place does not face it, it is out of reach.
  void stand_on(const Obstacle& obstacle)
  {
    for (auto& place : places_.all) {
      Foot at = foot(obstacle, secondary_.points[static_cast<std::size_t>(place.node)]);
      if (place.normal.dot(at.normal) > opposed) at.distance = std::numeric_limits<double>::infinity();
      if (std::isfinite(at.distance)) place.normal = -at.normal;
      distance_.push_back(at.distance);
    }
  }

  void integrate_faces()
  {
    std::vector<Box> boxes;
    for (std::size_t f = 0; f < primary_.facets.size(); ++f) {
      const auto face = primary_.geometry(f);
      Box box;
      for (const auto& p : face.nodes) box.extend(p);
      boxes.push_back(box);
    }
    tree_ = std::make_unique<Tree>(std::move(boxes));
    face_of_middle_.assign(places_.all.size(), {-1, -1});
    for (std::size_t f = 0; f < secondary_.faces.size(); ++f)
      for (std::size_t k = static_cast<std::size_t>(mesh::corner_count(secondary_.faces.type[f])); k < secondary_.faces[f].size();
           ++k)
        face_of_middle_[static_cast<std::size_t>(node_places(f)[k])] = {static_cast<Local>(f), static_cast<Local>(k)};
    integrals_.reserve(first_face(comm_.rank() + 1) - first_face(comm_.rank()));
    for (std::size_t f = first_face(comm_.rank()); f < first_face(comm_.rank() + 1); ++f) integrals_.push_back(integrals_of(f));
  }

  FaceIntegrals integrals_of(std::size_t face)
  {
    if (!options_.obstacle && !nodal()) return integrate(secondary_, places_, face, primary_, primary_places_, *tree_, reach_);
    FaceIntegrals whole = integrate_whole(secondary_, face);
    const auto places = node_places(face);
    if (!nodal()) {  // a face counts if all of it faces the obstacle
      if (!std::all_of(places.begin(), places.end(), [&](Local p) { return meet(static_cast<std::size_t>(p)).found; }))
        whole.covered.setZero();
      return whole;
    }
    const Eigen::MatrixXd control = control_values(face);
    for (Eigen::Index k = 0; k < control.rows(); ++k)
      for (Eigen::Index l = 0; l < control.cols(); ++l)
        if (control(k, l) != 0 && !meet(static_cast<std::size_t>(places[static_cast<std::size_t>(l)])).found)
          whole.covered[k] = 0;
    return whole;
  }

  bool nodal() const { return options_.discretization == "node_to_segment"; }

  // What a row of a face's node sees of the values at all its nodes; see multiplier_basis().
  Eigen::MatrixXd control_values(std::size_t face) const
  {
    return multiplier_basis(secondary_.faces.type[face]).transpose().partialPivLu().inverse();
  }

  // The gap between the smooth surfaces at the node itself, along its normal, as the rows see it: in the middle of edges and
  // faces as a control value. Its mean over the dual basis, which has negative parts, would see an overlap of a twelfth of
  // curvature times cell size squared between surfaces that only touch; that mean is left for nodes which look past the border of
  // the primary side.
  double gap_at(std::size_t p, double mean) const
  {
    const double length = 2 * reach_;
    const auto [face, node] = face_of_middle_[p];
    double gap = 0;
    if (face < 0) {
      gap = ray(p, length);
    } else {
      const Eigen::MatrixXd basis = multiplier_basis(secondary_.faces.type[static_cast<std::size_t>(face)]);
      const Eigen::VectorXd control = basis.transpose().partialPivLu().inverse().row(node);
      for (Eigen::Index k = 0; k < control.size(); ++k)
        if (control[k] != 0)
          gap += control[k] *
                 ray(static_cast<std::size_t>(node_places(static_cast<std::size_t>(face))[static_cast<std::size_t>(k)]), length);
    }
    return std::isfinite(gap) ? gap : mean;
  }

  // What lies opposite a place.
  struct Opposite {
    bool found = false;
    double gap = std::numeric_limits<double>::infinity();
    std::size_t facet = 0;  // of the primary side
    Hit hit;
  };

  // Along the normal of a place to the primary side; not finite if it meets nothing within `length`.
  double ray(std::size_t p, double length) const { return options_.obstacle ? distance_[p] : shoot_from(p, length).gap; }

  Opposite shoot_from(std::size_t p, double length) const
  {
    const Place& place = places_.all[p];
    const Point x = secondary_.points[static_cast<std::size_t>(place.node)];
    const Point margin = Point::Constant(0.02 * length);  // a hit may lie a little beside its face
    Opposite best;
    for (const int m : tree_->swept(Box(x - margin, x + margin), length * place.normal)) {
      const auto facet = static_cast<std::size_t>(m);
      const auto geometry = primary_.geometry(facet);
      const auto hit = shoot(x, place.normal, geometry);
      if (!hit.found) continue;
      const double gap = hit.distance - Bulge(geometry, corner_normals(primary_, primary_places_, facet))(hit.shape);
      if (std::abs(gap) <= length && std::abs(gap) < std::abs(best.gap)) best = {true, gap, facet, hit};
    }
    return best;
  }

  // What a place meets within reach; looked up once for each, for nodal rows and obstacles.
  const Opposite& meet(std::size_t p)
  {
    const auto [entry, is_new] = met_.try_emplace(p);
    if (!is_new) return entry->second;
    if (options_.obstacle)
      entry->second.gap = distance_[p];
    else
      entry->second = shoot_from(p, reach_);
    entry->second.found = std::abs(entry->second.gap) <= reach_;
    return entry->second;
  }

  // Which places carry a multiplier: covered enough, and not held along their normal.
  void choose_places()
  {
    const auto count = static_cast<Eigen::Index>(places_.all.size());
    const auto covered = over_places([&](std::size_t i) { return integrals_[i].covered; });
    const auto whole = over_places([&](std::size_t i) { return integrals_[i].whole; });
    for (Eigen::Index p = 0; p < count; ++p) {
      const auto& place = places_.all[static_cast<std::size_t>(p)];
      directions_.push_back(directions(place.normal, held_at(place), inclined_at(place), dimension_));
    }
    // Places held along their normal leave their share to the others of the face. Where a face has no others, as on a surface
    // that a support moves as a whole, they stay: their rows are felt by the primary side alone (and dropped in add_point if that
    // is held, too).
    std::vector<double> stranded(places_.all.size(), 0.0);
    for (std::size_t i = 0; i < integrals_.size(); ++i) {
      const auto places = node_places(first_face(comm_.rank()) + i);
      const auto is_held = [&](Local p) { return !directions_[static_cast<std::size_t>(p)].free_normal; };
      if (std::all_of(places.begin(), places.end(), is_held))
        for (const Local p : places) stranded[static_cast<std::size_t>(p)] = 1;
    }
    comm_.sum_in_place(stranded);
    for (Eigen::Index p = 0; p < count; ++p) {
      const auto i = static_cast<std::size_t>(p);
      const bool alone = stranded[i] > 0;
      if (alone)
        directions_[i] = directions(places_.all[i].normal, {false, false, false}, {}, dimension_);  // moves() picks the tangents
      kept_.push_back((directions_[i].free_normal || alone) && covered[p] > least_cover * whole[p]);
    }
  }

  // Sums over the faces at each place, in the order of the faces whatever the ranks: values(i) are those at the nodes of this
  // rank's i-th face.
  template <class Values>
  Eigen::VectorXd over_places(const Values& values) const
  {
    std::vector<double> at(secondary_.faces.nodes.size(), 0.0);
    for (std::size_t i = 0; i < first_face(comm_.rank() + 1) - first_face(comm_.rank()); ++i) {
      const Eigen::VectorXd part = values(i);
      for (Eigen::Index k = 0; k < part.size(); ++k)
        at[static_cast<std::size_t>(secondary_.faces.offset[first_face(comm_.rank()) + i]) + static_cast<std::size_t>(k)] =
            part[k];
    }
    comm_.sum_in_place(at);
    Eigen::VectorXd sums = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(places_.all.size()));
    for (std::size_t k = 0; k < at.size(); ++k) sums[places_.of_node[k]] += at[k];
    return sums;
  }

  std::array<bool, 3> held_at(const Place& place) const
  {
    const Global node = secondary_.node_id[static_cast<std::size_t>(place.node)];
    return {held_.find(node, 0) != nullptr, held_.find(node, 1) != nullptr, held_.find(node, 2) != nullptr};
  }

  std::span<const constraint::Inclined> inclined_at(const Place& place) const
  {
    return held_.inclined(secondary_.node_id[static_cast<std::size_t>(place.node)]);
  }

  // Terms of this rank's places, ordered by place, side, node and face. Also sums D.
  std::vector<Term> exchange_terms()
  {
    struct Sent {
      Term term;
      Global face;
    };
    std::vector<std::vector<Sent>> send(static_cast<std::size_t>(comm_.size()));
    std::vector<Eigen::VectorXd> d, rise;
    for (std::size_t i = 0; i < integrals_.size(); ++i) {
      const std::size_t face = first_face(comm_.rank()) + i;
      auto rows = rows_of(face, integrals_[i]);
      integrals_[i] = {};
      d.push_back(std::move(rows.d));
      rise.push_back(std::move(rows.rise));
      for (const auto& term : rows.terms) {
        int rank = 0;
        while (static_cast<std::size_t>(term.place) >= first_place(rank + 1)) ++rank;
        send[static_cast<std::size_t>(rank)].push_back({term, static_cast<Global>(face)});
      }
    }
    integrals_.clear();
    d_ = over_places([&](std::size_t i) { return d[i]; });
    rise_ = over_places([&](std::size_t i) { return rise[i]; });
    // Most terms stay on their rank, and are many.
    std::vector<Sent> all = std::move(send[static_cast<std::size_t>(comm_.rank())]);
    send[static_cast<std::size_t>(comm_.rank())].clear();
    for (const auto& part : comm_.exchange(send)) all.insert(all.end(), part.begin(), part.end());
    std::sort(all.begin(), all.end(), [](const Sent& a, const Sent& b) {
      return std::tie(a.term.place, a.term.on_primary, a.term.node, a.face) <
             std::tie(b.term.place, b.term.on_primary, b.term.node, b.face);
    });
    std::vector<Term> terms;
    for (const auto& sent : all) {
      if (!terms.empty() && terms.back().place == sent.term.place && terms.back().on_primary == sent.term.on_primary &&
          terms.back().node == sent.term.node)
        terms.back().value += sent.term.value;
      else
        terms.push_back(sent.term);
    }
    return terms;
  }

  FaceRows rows_of(std::size_t face, const FaceIntegrals& integrals)
  {
    const auto places = node_places(face);
    std::vector<bool> kept;
    for (const Local p : places) kept.push_back(kept_[static_cast<std::size_t>(p)]);
    return nodal() ? nodal_rows(face, integrals, kept) : dual_rows(integrals, kept, secondary_.faces[face], places);
  }

  // u_s - sum_j N_j u_j at what each node meets, weighted with the node's share of the face.
  FaceRows nodal_rows(std::size_t face, const FaceIntegrals& integrals, const std::vector<bool>& kept)
  {
    const auto places = node_places(face);
    const auto nodes = secondary_.faces[face];
    const Eigen::MatrixXd control = control_values(face);
    FaceRows rows{Eigen::VectorXd::Zero(control.rows()), Eigen::VectorXd::Zero(control.rows()), {}};
    for (Eigen::Index k = 0; k < control.rows(); ++k) {
      if (!kept[static_cast<std::size_t>(k)]) continue;
      const double area = rows.d[k] = integrals.covered[k];
      const Local place = places[static_cast<std::size_t>(k)];
      for (Eigen::Index l = 0; l < control.cols(); ++l) {
        const double weight = control(k, l) * area;
        if (weight == 0) continue;
        rows.terms.push_back({place, nodes[static_cast<std::size_t>(l)], false, weight});
        if (options_.obstacle) continue;
        const Opposite& opposite = meet(static_cast<std::size_t>(places[static_cast<std::size_t>(l)]));
        const auto other = primary_.faces[static_cast<std::size_t>(primary_.face_of[opposite.facet])];
        const FaceShape shape = primary_.shape_in_face(opposite.facet, opposite.hit.shape, opposite.hit.frame, Plane::Zero());
        for (std::size_t j = 0; j < other.size(); ++j)
          rows.terms.push_back({place, other[j], true, -weight * shape[static_cast<Eigen::Index>(j)]});
      }
    }
    return rows;
  }

  void add_point(std::size_t p, std::span<const Term> terms, constraint::Contacts& contacts)
  {
    const Place& place = places_.all[p];
    const double d = d_[static_cast<Eigen::Index>(p)];
    const bool bonded = options_.law == Law::bonded;
    constraint::ContactPoint point{
        index_, secondary_.node_id[static_cast<std::size_t>(place.node)], d, place.normal, {}, contacts.rows.size()};
    const bool held = !moves(terms, d, place.normal);  // on both sides
    if (!held && options_.law != Law::frictionless)
      for (const auto& tangent : directions_[p].tangents)
        if (moves(terms, d, tangent)) point.tangents.push_back(tangent);

    std::vector<Point> frame{place.normal};
    frame.insert(frame.end(), point.tangents.begin(), point.tangents.end());
    Point separation = Point::Zero();  // of the two sides in the mesh, weighted as the row is
    double weight = 0;
    for (const auto& term : terms) {
      const Side& side = term.on_primary ? primary_ : secondary_;
      separation -= term.value / d * side.points[static_cast<std::size_t>(term.node)];
      if (!term.on_primary) weight += term.value / d;
    }
    point.weight = weight;
    point.at = secondary_.points[static_cast<std::size_t>(place.node)];
    point.gap = bonded ? 0
                       : weight * (gap_at(p, (frame[0].dot(separation) - rise_[static_cast<Eigen::Index>(p)] / d) / weight) -
                                   options_.interference);
    if (held) {
      if (!bonded) crossing_ = std::max(crossing_, held_part(terms, d, place.normal) - point.gap);
      return;
    }
    for (std::size_t axis = 0; axis < frame.size(); ++axis) add_row(terms, d, frame[axis], axis == 0 ? point.gap : 0.0, contacts);
    contacts.points.push_back(std::move(point));
    contacts.bonded.push_back(bonded);
  }

  static bool counts(const Term& term, double d, const Point& axis, int c)
  {
    return std::abs(term.value) > 1e-12 * d && std::abs(axis[c]) > 1e-14;
  }
  Global node_of(const Term& term) const
  {
    return (term.on_primary ? primary_ : secondary_).node_id[static_cast<std::size_t>(term.node)];
  }
  const constraint::Held* support_of(const Term& term, int c) const
  {
    return (term.on_primary ? primary_held_ : held_).find(node_of(term), c);
  }

  std::span<const constraint::Inclined> inclined_of(const Term& term) const
  {
    return (term.on_primary ? primary_held_ : held_).inclined(node_of(term));
  }
  // What inclined supports at the node of a term leave of an axis; parts that are rounding are 0.
  Point free_of_inclined(const Term& term, const Point& axis) const
  {
    const auto inclined = inclined_of(term);
    if (inclined.empty()) return axis;
    Point rest = axis;
    for (const auto& i : inclined) rest -= axis.dot(along(i)) * along(i);
    return (rest.array().abs() < 1e-9).select(0.0, rest);
  }

  // Whether supports leave anything of the row.
  bool moves(std::span<const Term> terms, double d, const Point& whole) const
  {
    return std::any_of(terms.begin(), terms.end(), [&](const Term& term) {
      const Point axis = free_of_inclined(term, whole);
      for (int c = 0; c < dimension_; ++c)
        if (counts(term, d, axis, c) && !support_of(term, c)) return true;
      return false;
    });
  }

  // What supports contribute to sum_k value_k / d axis . u(node_k).
  double held_part(std::span<const Term> terms, double d, const Point& whole) const
  {
    double sum = 0;
    for (const auto& term : terms) {
      for (const auto& i : inclined_of(term)) sum += term.value / d * whole.dot(along(i)) * i.value;
      const Point axis = free_of_inclined(term, whole);
      for (int c = 0; c < dimension_; ++c)
        if (counts(term, d, axis, c))
          if (const auto* held = support_of(term, c)) sum += term.value / d * axis[c] * held->value;
    }
    return sum;
  }

  // sum_k value_k / d axis . u(node_k) <= bound, without what supports hold.
  void add_row(std::span<const Term> terms, double d, const Point& whole, double bound, constraint::Contacts& contacts) const
  {
    for (const auto& term : terms) {
      for (const auto& i : inclined_of(term)) {
        const double coefficient = term.value / d * whole.dot(along(i));
        bound -= coefficient * i.value;
        for (const auto& share : std::span(i.shares).first(static_cast<std::size_t>(i.share_count)))
          for (int c = 0; c < dimension_; ++c)
            if (const double part = coefficient * share.part[static_cast<std::size_t>(c)]; part != 0)
              contacts.held.push_back({contacts.rows.size(), c, share.support, part});
      }
      const Point axis = free_of_inclined(term, whole);
      for (int c = 0; c < dimension_; ++c) {
        if (!counts(term, d, axis, c)) continue;
        const double coefficient = term.value / d * axis[c];
        if (const auto* held = support_of(term, c)) {
          bound -= coefficient * held->value;
          contacts.held.push_back({contacts.rows.size(), c, held->support, coefficient});
        } else {
          contacts.rows.entries.push_back({node_of(term), c, coefficient});
        }
      }
    }
    contacts.rows.close(bound);
  }

  const Options& options_;
  int index_;
  int dimension_;
  const Communicator& comm_;
  Side secondary_, primary_;
  Places places_, primary_places_;
  HeldNodes held_, primary_held_;
  double reach_;
  double crossing_ = 0;                   // how far supports alone push the two sides into each other, on this rank
  std::vector<double> distance_;          // of each place from the obstacle, if there is one
  std::map<std::size_t, Opposite> met_;   // by place
  std::unique_ptr<Tree> tree_;            // of the primary facets
  std::vector<FaceIntegrals> integrals_;  // of this rank's faces
  std::vector<std::pair<Local, Local>> face_of_middle_;  // of each place: a face and the node in it, if that is no corner
  std::vector<Directions> directions_;                   // of each place
  std::vector<bool> kept_;
  Eigen::VectorXd d_, rise_;  // of each place: integral psi_i, and of psi_i times the bulge
};

}  // namespace

constraint::Contacts discretize(std::span<const Pair> pairs, std::span<const constraint::Held> held, fem::Kinematics kinematics,
                                const Communicator& comm, std::span<const constraint::Inclined> inclined)
{
  constraint::Contacts contacts;
  const auto sizes = measure(pairs, comm);
  for (std::size_t c = 0; c < pairs.size(); ++c)
    Builder(pairs[c].options, near_faces(pairs[c], sizes[c], comm), sizes[c].reach, static_cast<int>(c), held, inclined,
            kinematics, comm)
        .add_rows(contacts);
  return contacts;
}

}  // namespace mortise::contact
