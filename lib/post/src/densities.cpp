#include "densities.hpp"

#include <algorithm>
#include <array>

namespace mortise::post {

namespace {

// A range of materials, in Pa and kg/m3.
struct Range {
  double least_modulus, most_modulus, least_density, most_density;
};
constexpr std::array materials{
    Range{3e10, 8e11, 5000, 23000},   // metals, hard metal
    Range{1e10, 3e10, 9000, 12000},   // lead, bismuth
    Range{3e10, 1.5e12, 1400, 5000},  // light metals, ceramics, glass, rock, laminates
    Range{1e9, 1e11, 1400, 3300},     // rock, concrete, brick, ice and moulded composites
    Range{2e9, 2e10, 120, 1300},      // wood
    Range{5e8, 1e10, 830, 2400},      // polymers
    Range{1e3, 1e5, 850, 1300},       // gels, soft rubber
    Range{1e5, 1e9, 850, 2400},       // rubber, soils
};

// Those that most models are made of.
constexpr std::array common{
    Range{0.9e11, 2.3e11, 6800, 9200},    // steel, cast iron, copper, nickel, zinc
    Range{4e10, 8e10, 1700, 2900},        // aluminium, magnesium, glass, granite
    Range{1e11, 1.25e11, 4300, 4700},     // titanium
    Range{1.3e10, 1.8e10, 10500, 12000},  // lead
    Range{3e11, 4.3e11, 3000, 4000},      // ceramics
    Range{3.4e11, 6.5e11, 14000, 19500},  // tungsten, hard metal
    Range{2e10, 4.5e10, 2200, 2600},      // concrete
    Range{3e10, 1.6e11, 1400, 2000},      // laminates
    Range{8e9, 1.6e10, 350, 800},         // wood
    Range{8e8, 5e9, 880, 1450},           // polymers
    Range{1e3, 1e8, 900, 1300},           // rubber, gels
};

// Foams grow stiffer with the square of their density.
bool foam(double modulus, double density)
{
  return density >= 5 && density < 850 && modulus >= 1e3 && modulus <= 3e9 * density / 1000 * density / 1000;
}

template <std::size_t n>
bool among(const std::array<Range, n>& ranges, double modulus, double density)
{
  return std::any_of(ranges.begin(), ranges.end(), [&](const Range& r) {
    return modulus >= r.least_modulus && modulus <= r.most_modulus && density >= r.least_density && density <= r.most_density;
  });
}

bool real(double modulus, double density)
{
  return foam(modulus, density) || among(materials, modulus, density);
}

// What 1 of stress and of density is, in Pa and kg/m3.
struct Units {
  double stress, density;
};
constexpr double g = 9.80665, pound = 0.45359237, inch = 0.0254, foot = 12 * inch, psi = pound * g / inch / inch;
// A mass is a force over an acceleration: lbf s2/in, in cubes of lengths.
constexpr double slinch = pound * g / inch / (inch * inch * inch), slug = pound * g / foot / (foot * foot * foot);
constexpr std::array usual{
    Units{1, 1},         // m, s with kg
    Units{1e3, 1e3},     // and t
    Units{1e6, 1e12},    // mm, s with t
    Units{1e9, 1e9},     // mm, ms with kg
    Units{1e6, 1e6},     // and g
    Units{1e6, 1e18},    // um, s with kg
    Units{psi, slinch},  // inches, s with lbf
};
// In these a pair counts as right if it is one of the common materials: with every material there, some would suit any number.
constexpr std::array seldom{
    Units{1e3, 1e9},                 // mm, s with kg
    Units{0.1, 1e3},                 // cm, s with g
    Units{1e11, 1e3},                // cm, us with g
    Units{1e7, 1e11},                // cm, s with kN
    Units{1e9, 1e15},                // mm, s with kN
    Units{1e3, 1e15},                // um, s with g
    Units{1e3 * psi, 1e3 * slinch},  // inches, s with kip
    Units{psi / 144, slug},          // feet, s with lbf
    Units{g, g},                     // m, s with kgf
    Units{1e4 * g, 1e8 * g},         // cm
    Units{1e6 * g, 1e12 * g},        // mm
};

// A unit of density that stands beside a modulus where another one belongs.
struct Mistake {
  Units units;
  const char *stress, *given, *wanted;
  double factor;  // of the density
};
constexpr std::array mistakes{
    Mistake{{1e6, 1e9}, "MPa", "kg/mm3", "t/mm3 goes with MPa and mm", 1e-3},
    Mistake{{1e6, 1}, "MPa", "kg/m3", "t/mm3 goes with MPa and mm", 1e-12},
    Mistake{{1, 1e9}, "Pa", "kg/mm3", "kg/m3 goes with Pa and m", 1e9},
    Mistake{{1, 1e12}, "Pa", "t/mm3", "kg/m3 goes with Pa and m", 1e12},
    Mistake{{1, 1e3}, "Pa", "g/cm3", "kg/m3 goes with Pa and m", 1e3},
    Mistake{{psi, pound / (inch * inch * inch)},
            "psi",
            "lb/in3",
            "lbf s2/in4 goes with psi and inches",
            pound / (inch * inch * inch) / slinch},
};

}  // namespace

std::optional<OtherDensity> other_density(double young_modulus, double density)
{
  constexpr double least = 1e3;  // numbers below are no real material's in Pa, MPa or psi
  if (!(young_modulus >= least) || !(density > 0)) return {};
  const auto fits = [&](const Units& u) { return real(young_modulus * u.stress, density * u.density); };
  const auto is_common = [&](const Units& u) { return among(common, young_modulus * u.stress, density * u.density); };
  if (std::any_of(usual.begin(), usual.end(), fits) || std::any_of(seldom.begin(), seldom.end(), is_common)) return {};
  for (const auto& m : mistakes)
    if (fits(m.units)) return OtherDensity{m.stress, m.given, m.wanted, density * m.factor};
  return {};
}

}  // namespace mortise::post
