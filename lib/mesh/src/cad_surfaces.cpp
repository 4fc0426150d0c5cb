// Shapes are told by places, normals and curvatures all over a face and not by the kind of surface that a file says: many
// programs write cylinders as splines. What fits all places is that surface.
#include "cad_surfaces.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "gmsh_library.hpp"
#include "mesh/curved_surface.hpp"

namespace mortise::mesh {

namespace {

constexpr int places_along = 6;             // of a face, each way
constexpr double exactly = 1e-7;            // of the radius: the places fit
constexpr double nearly_on_surface = 1e-4;  // of the radius: the nodes do; edges are curves of their own
constexpr double almost_flat = 1e4;         // radius over the size of the face

// Points of the face in its parameters, well inside, and what gmsh says there.
struct Samples {
  std::vector<Point> x;
  std::vector<Point> out;  // from the centre of the larger curvature, or into it; faces alone
  double size = 0;
};

std::vector<Point> points(const std::vector<double>& coordinates)
{
  std::vector<Point> result;
  for (std::size_t i = 0; i + 2 < coordinates.size(); i += 3)
    result.emplace_back(coordinates[i], coordinates[i + 1], coordinates[i + 2]);
  return result;
}

std::vector<double> parameters(int dimension, int tag)
{
  std::vector<double> low, high, result;
  library().getParametrizationBounds(dimension, tag, low, high);
  if (low.size() != static_cast<std::size_t>(dimension) || high.size() != low.size()) return {};
  for (std::size_t d = 0; d < low.size(); ++d)
    if (!(std::abs(low[d]) < 1e30 && std::abs(high[d]) < 1e30 && high[d] > low[d])) return {};
  const auto at = [&](std::size_t d, int i) { return low[d] + (i + 0.5) / places_along * (high[d] - low[d]); };
  for (int i = 0; i < places_along; ++i) {
    if (dimension == 1) result.push_back(at(0, i));
    for (int j = 0; dimension == 2 && j < places_along; ++j) result.insert(result.end(), {at(0, i), at(1, j)});
  }
  return result;
}

Samples sample(int dimension, int tag)
{
  const auto at = parameters(dimension, tag);
  if (at.empty()) return {};
  std::vector<double> coordinates;
  library().getValue(dimension, tag, at, coordinates);
  Samples samples{points(coordinates), {}, 0};
  for (const auto& x : samples.x) samples.size = std::max(samples.size, (x - samples.x[0]).norm());
  if (dimension == 1) return samples;
  std::vector<double> most, least, direction, other, normal;
  library().getNormal(tag, at, normal);
  library().getPrincipalCurvatures(tag, at, most, least, direction, other);
  const auto normals = points(normal);
  if (normals.size() != samples.x.size() || most.size() != samples.x.size() || least.size() != samples.x.size()) return {};
  for (std::size_t i = 0; i < samples.x.size(); ++i) {
    const double curvature = std::abs(most[i]) > std::abs(least[i]) ? most[i] : least[i];
    samples.out.emplace_back(normals[i] / curvature);  // no number where it is flat, which fits nothing
  }
  return samples;
}

std::size_t farthest(const std::vector<Point>& from, const Point& x)
{
  const auto distance = [&](const Point& p) { return (p - x).squaredNorm(); };
  return static_cast<std::size_t>(
      std::max_element(from.begin(), from.end(), [&](const auto& a, const auto& b) { return distance(a) < distance(b); }) -
      from.begin());
}

bool fits(const CurvedSurface& surface, const std::vector<Point>& points, double tolerance)
{
  return std::all_of(points.begin(), points.end(),
                     [&](const Point& x) { return std::abs(surface.distance(x)) <= tolerance * surface.radius; });
}

Point mean(const std::vector<Point>& points)
{
  Point sum = Point::Zero();
  for (const auto& p : points) sum += p;
  return sum / static_cast<double>(points.size());
}

// The cone or the cylinder on whose axis all centres of curvature are.
CurvedSurface cone_through(const Samples& s, const std::vector<Point>& centres)
{
  const Point first = centres[farthest(centres, centres[0])], last = centres[farthest(centres, first)];
  CurvedSurface result{first, (last - first).normalized(), 0, 0};
  const auto along = [&](const Point& x) { return (x - first).dot(result.axis); };
  const auto radius = [&](const Point& x) { return (x - first - along(x) * result.axis).norm(); };
  const auto by_height = [&](const Point& a, const Point& b) { return along(a) < along(b); };
  const auto [low, high] = std::minmax_element(s.x.begin(), s.x.end(), by_height);
  result.slope = (radius(*high) - radius(*low)) / (along(*high) - along(*low));
  const double middle = along(mean(s.x));
  result.point = first + middle * result.axis;
  result.radius = radius(*low) + result.slope * (middle - along(*low));
  return result;
}

// The circle in the plane z = 0 through three of the points.
CurvedSurface circle_through(const std::vector<Point>& x)
{
  const Point a = x[2] - x[0], b = x[4] - x[0];
  const double twice = 2 * (a[0] * b[1] - a[1] * b[0]), aa = a.squaredNorm(), bb = b.squaredNorm();
  const Point out((aa * b[1] - bb * a[1]) / twice, (bb * a[0] - aa * b[0]) / twice, 0);
  return {x[0] + out, Point::UnitZ(), out.norm(), 0};
}

std::optional<CurvedSurface> shape_of(int dimension, int tag)
{
  std::string type;
  library().getType(dimension, tag, type);
  if (type.rfind("Plane", 0) == 0 || type.rfind("Line", 0) == 0 || type.find("iscrete") != std::string::npos) return {};
  const auto samples = sample(dimension, tag);
  if (samples.x.size() < places_along) return {};
  std::vector<CurvedSurface> candidates;
  if (dimension == 1) {
    candidates.push_back(circle_through(samples.x));
  } else {
    for (const double sign : {1.0, -1.0}) {  // gmsh turns the normals of some faces, and leaves their curvature
      std::vector<Point> centres;
      for (std::size_t i = 0; i < samples.x.size(); ++i) centres.emplace_back(samples.x[i] + sign * samples.out[i]);
      const Point centre = mean(centres);
      candidates.push_back({centre, Point::Zero(), (samples.x[0] - centre).norm(), 0});
      candidates.push_back(cone_through(samples, centres));
    }
  }
  for (const auto& candidate : candidates)
    if (candidate.point.allFinite() && candidate.axis.allFinite() && std::isfinite(candidate.slope) && candidate.radius > 0 &&
        candidate.radius < almost_flat * samples.size && fits(candidate, samples.x, exactly))
      return candidate;
  return {};
}

std::vector<Point> nodes_on(int dimension, int tag)
{
  std::vector<std::size_t> tags;
  std::vector<double> coordinates, parametric;
  library().getNodes(tags, coordinates, parametric, dimension, tag, true, false);
  return points(coordinates);
}

}  // namespace

void mark_curved_surfaces(int dimension)
{
  gmsh::vectorpair faces;
  library().getEntities(faces, dimension - 1);
  std::map<std::string, std::vector<int>> named;
  for (const auto& [dim, tag] : faces)
    if (const auto shape = shape_of(dim, tag); shape && fits(*shape, nodes_on(dim, tag), nearly_on_surface))
      named[name_of(*shape)].push_back(tag);
  for (const auto& [name, tags] : named)
    library().setPhysicalName(dimension - 1, library().addPhysicalGroup(dimension - 1, tags, -1), name);
}

}  // namespace mortise::mesh
