// How free motions are found: of one body or of several that move as one, and then of several bodies together. The work for each
// is that of what touches it.
#pragma once

#include <map>
#include <span>
#include <vector>

#include "body_rows.hpp"
#include "constraint/sliding_surface.hpp"
#include "unit_motions.hpp"

namespace mortise::feti {

// Collects the free motions, of one unit after the other and then of several bodies together. Its arguments outlive it.
class FreeMotionSearch {
 public:
  FreeMotionSearch(const Bodies& bodies, const BodyRows& rows, const constraint::Contacts& contacts,
                   std::span<const constraint::SlidingSurface> sliding_surfaces, const Communicator& comm);

  // Of bodies that move as one, in ascending order. Collective.
  void find(const std::vector<int>& unit);
  // The null space of all rows once the motions found so far are stopped. Collective.
  void find_joint();

  std::vector<FreeMotion> found;

 private:
  // The rows that feel a unit, weighted, over the amplitudes of its first body.
  struct Felt {
    std::vector<Local> row;  // ascending
    Eigen::MatrixXd values;
  };
  Felt felt(const std::vector<int>& unit, const Eigen::MatrixXd& spread) const;
  std::vector<constraint::SlidingSurface> surfaces_at(const std::vector<int>& unit, const Felt& felt) const;
  RigidMotion motion_of(const std::vector<int>& unit, const Eigen::VectorXd& v) const
  {
    return combine(unit.front(), bodies_.frames[static_cast<std::size_t>(unit.front())], v, bodies_.kinematics);
  }
  Eigen::MatrixXd spread(const std::vector<int>& unit) const;
  double turning(const FreeMotion& motion) const;
  bool along_surfaces(const Felt& rows, const Eigen::VectorXd& v, const RigidMotion& motion,
                      std::span<const constraint::SlidingSurface> sliding_surfaces) const;
  SparseMatrix stops(double weight) const;

  // Where a motion stands among the amplitudes of all bodies.
  struct Amplitudes {
    std::vector<int> unit;
    Eigen::VectorXd values;  // body by body
  };

  const Bodies& bodies_;
  const BodyRows& rows_;
  const constraint::Contacts& contacts_;
  const std::span<const constraint::SlidingSurface> sliding_surfaces_;
  const Communicator& comm_;
  const int body_count_;
  std::vector<int> node_of_row_;                      // of each row the contact node whose normal it is, or -1
  std::map<int, std::vector<std::size_t>> at_;        // of each contact its sliding surfaces
  std::map<int, std::vector<int>> contacts_of_body_;  // that have a sliding surface on it
  // 1 for each row whose resistance is no matter of facets: of supports, bonds, and the cuts of a sector, which are no surfaces
  // that slide past each other. 0 for those of the contacts that sliding surfaces speak of.
  Eigen::VectorXd fixed_;
  std::vector<Amplitudes> amplitudes_;  // of each found motion
};

}  // namespace mortise::feti
