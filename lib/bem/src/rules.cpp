#include "rules.hpp"

#include <cmath>
#include <map>
#include <numbers>

namespace mortise::bem {

namespace {

std::vector<Node> make_gauss(int n)
{
  std::vector<Node> nodes;
  for (int i = 0; i < n; ++i) {
    double x = std::cos(std::numbers::pi * (i + 0.75) / (n + 0.5)), slope = 1;
    for (int step = 0; step < 100; ++step) {
      double before = 1, value = x;
      for (int k = 2; k <= n; ++k) {
        const double next = ((2 * k - 1) * x * value - (k - 1) * before) / k;
        before = value;
        value = next;
      }
      slope = n * (x * value - before) / (x * x - 1);
      const double change = value / slope;
      x -= change;
      if (std::abs(change) < 1e-16) break;
    }
    nodes.push_back({(1 - x) / 2, 1 / ((1 - x * x) * slope * slope)});
  }
  return nodes;
}

// Orbits of the symmetric group: (1 - 2 a, a, a) and its three places, or (1 - a - b, a, b) and its six.
struct Orbit {
  double a, b, weight;  // b = a: three places
};

TriangleRule symmetric(double centre, const std::vector<Orbit>& orbits)
{
  TriangleRule rule;
  if (centre > 0) rule.push_back({{1.0 / 3, 1.0 / 3, 1.0 / 3}, centre});
  for (const auto& [a, b, weight] : orbits) {
    const double c = 1 - a - b;
    rule.insert(rule.end(), {{{c, a, b}, weight}, {{b, c, a}, weight}, {{a, b, c}, weight}});
    if (a != b) rule.insert(rule.end(), {{{c, b, a}, weight}, {{a, c, b}, weight}, {{b, a, c}, weight}});
  }
  return rule;
}

TriangleRule product(int n)
{
  TriangleRule rule;
  for (const auto& [s, ws] : gauss(n))
    for (const auto& [t, wt] : gauss(n)) rule.push_back({{1 - s, s * (1 - t), s * t}, 2 * s * ws * wt});
  return rule;
}

}  // namespace

const std::vector<Node>& gauss(int n)
{
  static std::map<int, std::vector<Node>> known;
  auto& nodes = known[n];
  if (nodes.empty()) nodes = make_gauss(n);
  return nodes;
}

const TriangleRule& triangle_rule(int index)
{
  static const std::array<TriangleRule, triangle_rules> table{
      symmetric(0, {{1.0 / 6, 1.0 / 6, 1.0 / 3}}),
      symmetric(0, {{0.445948490915965, 0.445948490915965, 0.223381589678011},
                    {0.091576213509771, 0.091576213509771, 0.109951743655322}}),
      symmetric(0, {{0.249286745170910, 0.249286745170910, 0.116786275726379},
                    {0.063089014491502, 0.063089014491502, 0.050844906370207},
                    {0.053145049844817, 0.310352451033784, 0.082851075618374}}),
      symmetric(0.144315607677787, {{0.459292588292723, 0.459292588292723, 0.095091634267285},
                                    {0.170569307751760, 0.170569307751760, 0.103217370534718},
                                    {0.050547228317031, 0.050547228317031, 0.032458497623198},
                                    {0.008394777409958, 0.263112829634638, 0.027230314174435}}),
      product(6),
      product(7),
      product(8)};
  return table[static_cast<std::size_t>(index)];
}

}  // namespace mortise::bem
