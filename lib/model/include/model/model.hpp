// From the deck to the pieces of the dual problem: boundaries by name, stiffness, loads, supports, contact pairs.
#pragma once

#include <functional>
#include <optional>

#include "base/context.hpp"
#include "constraint/supports.hpp"
#include "contact/mortar.hpp"
#include "fem/constitution.hpp"
#include "feti/dual_problem.hpp"
#include "friction/law.hpp"
#include "io/nodal_field.hpp"
#include "model/deck.hpp"
#include "model/face_action.hpp"
#include "partition/congruence.hpp"

namespace mortise::model {

/// The names of a body's materials, each once.
std::vector<std::string> material_names(const fem::BodyOptions& body);

/// The law of each contact.
std::vector<friction::Law> friction_laws(const Contacts& contacts);
/// The preload of each preloaded contact in a state. Locked ones keep their length: they are prescribed at `shortenings`, of the
/// state before, one for each.
std::vector<constraint::Preload> preloads(const Contacts& contacts, const LoadState& state,
                                          const std::vector<double>& shortenings);

/// The fields of temperature that loads read from files, by the number of the load.
using Temperatures = std::map<std::size_t, std::shared_ptr<const io::NodalField>>;

/// The deck on this rank's subdomains. Refers to its arguments, and does not change.
class Model {
 public:
  Model(const Deck& deck, const Contacts& contacts, const partition::Decomposition& decomposition, Temperatures temperatures)
      : deck_(deck), contacts_(contacts), decomposition_(decomposition), temperatures_(std::move(temperatures))
  {
  }

  const Deck& deck() const { return deck_; }
  const Contacts& contacts() const { return contacts_; }
  const partition::Decomposition& decomposition() const { return decomposition_; }
  const Temperatures& temperatures() const { return temperatures_; }
  /// partition::outer_surface(), which the first call makes. Collective.
  const mesh::Surface& outer_surface(const Communicator& comm) const;

  /// The materials of a subdomain, in the same order in every subdomain of a body.
  fem::Materials materials(const partition::Subdomain& subdomain) const;
  /// The largest number of materials in one body.
  std::size_t most_materials() const;
  /// Throws Error(bad_input), with the line of the deck, if a body has cells that its formulation is not for, or reaches beyond
  /// the axis of revolution, or if a support or a contact names a boundary that has no part on its body. Collective.
  void require_fit(deck::Document& document, const Communicator& comm) const;
  /// Materials, formulation, temperature change and acceleration of every subdomain of this rank.
  std::vector<fem::Constitution> constitution(const LoadState& state) const;
  /// For each subdomain the first one of this rank with the same shape and material.
  std::vector<partition::CopyOf> congruent() const;
  /// Stiffness of a subdomain: its lower triangle. Errors name the body.
  SparseMatrix stiffness(const partition::Subdomain& subdomain) const;
  /// The Steklov-Poincare operator of a subdomain of boundary elements. Errors name the body.
  Eigen::MatrixXd steklov_poincare(const partition::Subdomain& subdomain) const;
  /// The consistent nodal loads of every subdomain; of boundary elements those on the surface alone. Throws Error(bad_input) if a
  /// formula is no number somewhere, or a loaded boundary has no area. Collective.
  std::vector<Eigen::VectorXd> loads(const LoadState& state, const Communicator& comm) const;
  /// Of each body, of what pressures and tractions on its boundaries add up to, what cancels: all round a bore, or on two sides.
  /// The areas of meshes, by polygons of different sides, leave some of it. Forces; throws as loads(). Collective.
  std::vector<double> opposed_loads(const LoadState& state, const Communicator& comm) const;
  /// The deck's supports, and in axisymmetry one more: on the axis nothing moves sideways. Those that do not act hold nothing.
  /// Each coupling stands for one more, of its name, without displacements.
  std::vector<constraint::Support> supports(const LoadState& state) const;
  /// Nodes of this rank on the boundary, or at the places, of each of `supports`, which are supports(). Collective.
  std::vector<constraint::SupportNodes> support_nodes(std::span<const constraint::Support> supports,
                                                      const Communicator& comm) const;
  /// The distance from an axis, a length, below which a node counts as lying on it. Collective.
  double rounding(const Communicator& comm) const;
  /// The boundaries of those of supports() that hold along normals, this rank's faces; the others are empty.
  std::vector<mesh::Surface> support_surfaces() const;
  /// The boundaries of supports that act along their normals alone, this rank's faces: prescribed or on springs.
  std::vector<mesh::Surface> surfaces_prescribed_along_normals(const LoadState& state) const;
  /// What supports, loads and couplings of a state do at the nodes of this rank's faces. In axisymmetry the axis is a face as
  /// well. Collective.
  std::vector<FaceAction> face_actions(const LoadState& state, const Communicator& comm) const;
  /// Of this rank's faces that loads press or springs push.
  std::vector<FacePressure> face_pressures(const LoadState& state) const;
  /// For each body whether it is one of those `touched`, one of the deck's supports lies on it, or a coupling or a spring ties it
  /// to such a body. Collective.
  std::vector<bool> supported(const std::vector<bool>& touched, const Communicator& comm) const;
  struct Facts {
    double area = 0;
    Point centre = Point::Zero();
    double young_modulus = 0;  ///< the smallest of its bodies
    double mean_modulus = 0;   ///< over its area, of the softest material of each subdomain
  };
  /// Of a boundary, by its name in the deck. Collective.
  Facts facts(const std::string& boundary, const Communicator& comm) const;
  /// The deck's couplings by name, with what loads and supports make of them. Collective.
  std::vector<constraint::Coupling> couplings(const LoadState& state, const Communicator& comm) const;
  /// This rank's faces of the rigid ones; the others are empty.
  std::vector<mesh::Surface> coupling_surfaces() const;
  /// The rows of the distributing ones whose points supports hold, on rank 0. Collective.
  std::vector<constraint::MeanMotion> mean_motions(const std::vector<constraint::Coupling>& couplings,
                                                   const Communicator& comm) const;
  /// The foundations of supports that act, and the springs between points. The same on every rank. Collective.
  constraint::Springs springs(const LoadState& state, const Communicator& comm) const;
  /// The motion of each coupling's point, U and then T in radians: the mean motion of its boundary. `displacement`: of each
  /// subdomain. Collective.
  std::vector<std::array<double, 6>> motions_of_points(const std::vector<Eigen::VectorXd>& displacement,
                                                       const Communicator& comm) const;
  /// The number of the first coupling among supports().
  int first_coupling() const { return static_cast<int>(deck_.supports.size()); }
  /// This rank's faces of both sides of each contact, with its options; overlaps are those of the state.
  std::vector<contact::Pair> contact_pairs(const LoadState& state) const;

 private:
  struct Selection {
    int boundary;
    std::vector<bool> on_body;
  };
  Selection select(const std::string& name) const;
  std::vector<bool> bodies_named(const std::string& name) const;
  fem::Formulation formulation(const partition::Subdomain& subdomain) const;
  /// Degrees, the sum of all loads on its body.
  fem::Temperature temperature_change(const partition::Subdomain& subdomain, const LoadState& state) const;
  /// The sum of all accelerations of its body.
  Point acceleration(const partition::Subdomain& subdomain, const LoadState& state) const;
  /// A formula of loads[index] at x, times the load's factor. Throws Error(bad_input) if it is no number there.
  double load_at(std::size_t index, const deck::Formula& formula, const LoadState& state, const Point& x) const;
  double pressure_at(std::size_t index, const LoadState& state, const Point& x) const;
  /// The traction of loads[index] along the axes of the model, a function of the place; empty if it has none. `state` outlives
  /// it.
  std::function<Point(const Point&)> traction_of(std::size_t index, const LoadState& state) const;
  void add_boundary_load(std::size_t index, const LoadState& state, std::vector<Eigen::VectorXd>& f,
                         const Communicator& comm) const;
  /// The force or moment of a load along the axes of the model; zero if it has none.
  Point along_model(const fem::LoadOptions& load, const std::optional<std::array<double, 3>>& value) const;
  struct NodeAtPoint;
  class CandidatesAtPoints;
  struct NodesAtPoints;
  std::vector<std::vector<NodeAtPoint>> candidates_at_points(const Communicator& comm) const;
  NodesAtPoints nodes_at_points(const Communicator& comm) const;
  std::string wrong_name(const std::string& name, const std::string& body, bool one,
                         const std::vector<NodeAtPoint>& candidates) const;
  void add_point_forces(const LoadState& state, std::vector<Eigen::VectorXd>& f, const Communicator& comm) const;
  void add_distributed(const std::vector<constraint::Coupling>& couplings, std::vector<Eigen::VectorXd>& f,
                       const Communicator& comm) const;
  struct Area;  // of a coupling's boundary
  struct SpringMatrix;
  void add_foundation(std::size_t support, const Communicator& comm, SpringMatrix& springs) const;
  void add_foundation_along_normals(std::size_t support, const Communicator& comm, SpringMatrix& springs) const;
  Area area_of(const constraint::CouplingOptions& coupling, const Communicator& comm) const;
  static void keep_along(const Area& area, constraint::Coupling& coupling);
  void require_formulations(deck::Document& document) const;
  void require_axis(deck::Document& document, double rounding) const;
  void require_temperatures(deck::Document& document) const;
  /// That some node of the surface lies at each place that supports or loads name. Throws as require_fit. Collective.
  void require_points(deck::Document& document, const Communicator& comm) const;

  const Deck& deck_;
  const Contacts& contacts_;
  const partition::Decomposition& decomposition_;
  Temperatures temperatures_;
  mutable std::optional<mesh::Surface> outer_surface_;
};

}  // namespace mortise::model
