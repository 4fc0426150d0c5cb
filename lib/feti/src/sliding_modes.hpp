// Rigid motions that let surfaces in contact slide along themselves: free, whatever the facets of the mesh resist.
#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>
#include <span>
#include <vector>

#include "base/dense.hpp"
#include "constraint/sliding_surface.hpp"
#include "unit_motions.hpp"

namespace mortise::feti {

/// What the surfaces in contact of bodies that move as one, and those that they touch, say of their motions, amplitudes of the
/// first body's.
class SlidingModes {
 public:
  SlidingModes(const std::vector<int>& bodies, const BodyFrame& frame, fem::Kinematics kinematics,
               std::span<const constraint::SlidingSurface> sliding_surfaces)
  {
    const auto moves = [&](int body) { return std::find(bodies.begin(), bodies.end(), body) != bodies.end(); };
    std::map<int, bool> inside, outside;  // contacts that have a side on the bodies, and on others or on obstacles
    std::map<int, int> sides;
    for (const auto& surface : sliding_surfaces) {
      (moves(surface.body) ? inside : outside)[surface.contact] = true;
      sides[surface.contact] |= surface.secondary ? 1 : 2;
    }
    for (const auto& surface : sliding_surfaces) {
      const bool obstacle = sides[surface.contact] != 3;
      if (!inside.contains(surface.contact) || (!obstacle && !outside.contains(surface.contact))) continue;
      const int modes = fem::rigid_motion_count(kinematics);
      Eigen::MatrixXd there(6, modes);  // the body's unit motions at the slide's centre
      for (int k = 0; k < modes; ++k) {
        const auto motion = unit_motion(bodies.front(), frame, k, kinematics);
        there.col(k) << motion.at(surface.centre), motion.rotation * surface.length;
      }
      auto& side = moves(surface.body) ? own_[surface.contact] : other_[surface.contact];
      side.push_back({dense::form(surface.whole, there), dense::form(surface.of_faces, there), dense::form(surface.smooth, there),
                      dense::form(surface.speed, there), surface.tilt, surface.tilt_with_kinks});
    }
  }

  // Motions that surfaces let slide along themselves, in the space of the orthonormal columns of `basis` and of `taken`: those
  // that are free already, which a roller's turn about its own axis needs where its centre of mass is not quite on it. Without
  // their part in `taken` they are orthonormal.
  Eigen::MatrixXd free(const Eigen::MatrixXd& basis, const Eigen::MatrixXd& taken) const
  {
    Eigen::MatrixXd found(basis.rows(), 0), known = taken;
    if (own_.empty() || basis.cols() == 0) return found;
    Eigen::MatrixXd all(basis.rows(), basis.cols() + taken.cols());
    all << basis, taken;
    std::vector<Eigen::VectorXd> candidates;
    for (const auto* sides : {&own_, &other_}) {
      Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(basis.rows(), basis.rows());
      Eigen::MatrixXd speed = exact * exact * Eigen::MatrixXd::Identity(basis.rows(), basis.rows());
      for (const auto& [contact, parts] : *sides)
        for (const auto& part : parts) {
          normal += part.smooth / std::pow(part.tolerance(), 2);
          speed += part.speed;
        }
      const auto eigen = dense::generalized_eigenpairs(dense::form(normal, all), dense::form(speed, all));
      for (Eigen::Index k = 0; k < all.cols(); ++k) {
        const Eigen::VectorXd v = all * eigen.vectors.col(k).normalized();
        if (slides(v)) candidates.push_back(v);
      }
    }
    // What a plane says of a motion is exact, what a cylinder says of it is not: the least felt ones first.
    std::stable_sort(candidates.begin(), candidates.end(),
                     [&](const auto& a, const auto& b) { return resistance(a) < resistance(b); });
    for (const auto& v : candidates) {
      const Eigen::VectorXd rest = v - known * (known.transpose() * v);
      if (rest.norm() < 0.1) continue;  // known by the other side
      known.conservativeResize(Eigen::NoChange, known.cols() + 1);
      known.rightCols(1) = rest.normalized();
      found.conservativeResize(Eigen::NoChange, found.cols() + 1);
      found.rightCols(1) = v / rest.norm();
    }
    return found;
  }

  // The root mean square of what the surfaces feel of a motion, facets left out.
  double resistance(const Eigen::VectorXd& v) const
  {
    double result = 0;
    for (const auto& [contact, parts] : own_) {
      const auto side = [&](const std::vector<Part>& all) {
        double worst = 0;
        for (const auto& part : all) worst = std::max(worst, v.dot(part.smooth * v));
        return worst;
      };
      const auto facing = other_.find(contact);
      result = std::max(result, facing == other_.end() ? side(parts) : std::min(side(parts), side(facing->second)));
    }
    return std::sqrt(std::max(result, 0.0));
  }

  // Whether at each contact one of the two surfaces slides along itself.
  bool slides(const Eigen::VectorXd& v) const
  {
    const auto all = [&](const std::vector<Part>& parts) {
      return std::all_of(parts.begin(), parts.end(), [&](const Part& part) { return part.slides(v); });
    };
    return std::all_of(own_.begin(), own_.end(), [&](const auto& contact) {
      const auto facing = other_.find(contact.first);
      return all(contact.second) || (facing != other_.end() && all(facing->second));
    });
  }

  // The height of a facet's arc over the radius of the surface, theta^2 / 8 with the angle theta between two facets, which is
  // twice that between a facet and the normals at its nodes.
  double sagitta() const
  {
    double tilt = 0;
    for (const auto* sides : {&own_, &other_})
      for (const auto& [contact, parts] : *sides)
        for (const auto& part : parts) tilt = std::max(tilt, part.tilt);
    return tilt / 2;
  }

 private:
  static constexpr double exact = 1e-6;  // what flat surfaces leave by rounding
  struct Part {
    Eigen::MatrixXd whole, of_faces, smooth, speed;
    double tilt, tilt_with_kinks;
    // What facets leave in quadratic polynomials is a small part of the angles between them: 1 to 7 % on meshes of cylinders.
    double tolerance() const { return 0.1 * std::sqrt(tilt) + exact; }
    bool slides(const Eigen::VectorXd& v) const
    {
      const double square = v.dot(speed * v) + 1e-12;
      const double felt = v.dot(whole * v);
      const double rounding = exact * exact;
      return v.dot(smooth * v) <= tolerance() * tolerance() * square && felt <= (tilt_share * tilt + rounding) * square &&
             (felt <= (sure_share * tilt_with_kinks + rounding) * square || v.dot(of_faces * v) <= mean_share * felt);
    }
    // Of n . v squared that may be due to tilts: teeth are more. Of a turn about the axis a facet of its own feels nothing in the
    // mean, faces that are parts of a flat do: it is 1/3 of the tilts if there is one face a flat, 2/3 and 1 if there are two and
    // three, 3/4 and 8/9 of it in the means of faces.
    static constexpr double tilt_share = 2, sure_share = 0.5, mean_share = 0.6;
  };
  using Sides = std::map<int, std::vector<Part>>;  // by contact

  Sides own_, other_;
};

}  // namespace mortise::feti
