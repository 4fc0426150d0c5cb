#include "mesh/curved_surface.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>

namespace mortise::mesh {

namespace {

// gmsh cuts the names of physical groups after 127 characters: seven numbers in hexadecimal digits leave room for a few more.
constexpr std::string_view beginning = "@curved:";
constexpr std::size_t digits = 16;

constexpr double nearly_same = 1e-6;  // of the smaller radius

}  // namespace

double CurvedSurface::distance(const Point& x) const
{
  const Point out = x - point;
  const double along = out.dot(axis);
  return (out - along * axis).norm() - radius - slope * along;
}

bool same(const CurvedSurface& a, const CurvedSurface& b)
{
  const double allowed = nearly_same * std::min(a.radius, b.radius);
  if (a.axis.isZero(0) != b.axis.isZero(0)) return false;
  const Point apart = b.point - a.point;
  if (a.axis.isZero(0)) return apart.norm() <= allowed && std::abs(a.radius - b.radius) <= allowed;
  if (a.axis.cross(b.axis).norm() > nearly_same) return false;
  const double along = apart.dot(a.axis), sign = a.axis.dot(b.axis) > 0 ? 1 : -1;
  return (apart - along * a.axis).norm() <= allowed && std::abs(a.slope - sign * b.slope) <= nearly_same &&
         std::abs(a.radius + a.slope * along - b.radius) <= allowed;
}

CurvedSurface moved(const CurvedSurface& surface, const Motion& motion)
{
  return {motion(surface.point), motion.rotation * surface.axis, surface.radius, surface.slope};
}

CurvedSurface scaled(const CurvedSurface& surface, double factor)
{
  return {factor * surface.point, surface.axis, factor * surface.radius, surface.slope};
}

std::string name_of(const CurvedSurface& s)
{
  // The length of the axis has the radius; a sphere has none, and its radius stands where the slope does.
  const bool sphere = s.axis.isZero(0);
  const Point axis = s.radius * s.axis;
  std::string name(beginning);
  for (const double x : {s.point[0], s.point[1], s.point[2], axis[0], axis[1], axis[2], sphere ? s.radius : s.slope})
    name += fmt::format("{:016x}", std::bit_cast<std::uint64_t>(x));
  return name;
}

std::optional<CurvedSurface> curved_surface(const std::string& name)
{
  std::array<double, 7> x{};
  if (name.rfind(beginning, 0) != 0 || name.size() != beginning.size() + x.size() * digits) return {};
  for (std::size_t i = 0; i < x.size(); ++i) {
    const char* first = name.data() + beginning.size() + i * digits;
    std::uint64_t bits = 0;
    if (const auto [end, error] = std::from_chars(first, first + digits, bits, 16); end != first + digits || error != std::errc())
      return {};
    x[i] = std::bit_cast<double>(bits);
    if (!std::isfinite(x[i])) return {};
  }
  const Point point(x[0], x[1], x[2]), axis(x[3], x[4], x[5]);
  const bool sphere = axis.isZero(0);
  const double radius = sphere ? x[6] : axis.norm();
  if (!(radius > 0)) return {};
  return CurvedSurface{point, sphere ? axis : Point(axis / radius), radius, sphere ? 0 : x[6]};
}

}  // namespace mortise::mesh
