// SPDX-License-Identifier: BSD-3-Clause
#include "convergence/studies.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "peridynamics/statics/equilibrium.hpp"
#include "support/vessels.hpp"

namespace rhexis::verification {

using namespace peridynamics;

namespace {

constexpr double nu = Pmb::poisson_ratio;

struct Elastic {
  double lambda, mu;
};

Elastic elastic(const Parameters& p) {
  return {p.young_modulus * nu / ((1 + nu) * (1 - 2 * nu)), p.young_modulus / (2 * (1 + nu))};
}

double wave_speed(const Parameters& p) {
  const Elastic e = elastic(p);
  return std::sqrt((e.lambda + 2 * e.mu) / p.density);
}

using Field = std::array<std::vector<double>, 3>;

/// u_r = shape(r).
template <class Shape>
auto radial(const Shape& shape) {
  return [shape](const std::array<double, 3>& x) -> std::array<double, 3> {
    const double r = std::hypot(x[0], x[1]), u = shape(r);
    return {u * x[0] / r, u * x[1] / r, 0};
  };
}

Field displacement(const Body& body) {
  const auto u = body.displacement();
  Field copy;
  for (std::size_t k = 0; k < 3; ++k) copy[k].assign(u[k].begin(), u[k].end());
  return copy;
}

double inner_product(const Field& a, const Field& b) {
  double sum = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t i = 0; i < a[k].size(); ++i) sum += a[k][i] * b[k][i];
  }
  return sum;
}

constexpr double strain_amplitude = 1e-5;

Field initial_displacement(const Body& body, const Parameters& p, double amplitude = strain_amplitude) {
  const double scale = amplitude * p.inner_radius / breathing_shape(p, p.inner_radius);
  return test::sample(body, radial([&](double r) { return scale * breathing_shape(p, r); }));
}

/// Steps of length `step` (s), from the exact mode's displacement at rest; after each, `visit(time, u)`;
/// until that returns false.
template <class Visit>
void breathe(const Discretisation& d, double step, const Visit& visit) {
  const Parameters p = vessel(d);
  const auto body = make_body(test::setup_of(p, step), test::self());
  body->set_state(initial_displacement(*body, p), test::sample(*body, test::nothing));
  for (long i = 1;; ++i) {
    body->advance(0, 0);
    if (!visit(static_cast<double>(i) * step, *body)) return;
  }
}

double stable_step(const Discretisation& d) {
  return test::stable_step_of(test::setup_of(vessel(d), 1e-7));
}

Field after_a_quarter(const Discretisation& d, double fraction) {
  const double time = 0.25 / breathing_frequency(vessel(d));
  const auto steps = std::llround(std::ceil(time / (fraction * stable_step(d))));
  const double step = time / static_cast<double>(steps);
  Field u;
  breathe(d, step, [&](double now, const Body& body) {
    if (now < time - 0.5 * step) return true;
    u = displacement(body);
    return false;
  });
  return u;
}

/// Relative to what the particles set out with.
double relative_difference(const Discretisation& d, const Field& a, const Field& b) {
  const auto body = make_body(test::setup_of(vessel(d), 1e-7), test::self());
  const Field start = initial_displacement(*body, vessel(d));
  Field difference = a;
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t i = 0; i < b[k].size(); ++i) difference[k][i] -= b[k][i];
  }
  return std::sqrt(inner_product(difference, difference) / inner_product(start, start));
}

/// Stress-free surfaces: (lambda + 2 mu) u' + lambda u / r = 0 for u = J1(k r) or Y1(k r), over (lambda + 2
/// mu).
double surface_stress(double k, double r, bool first_kind) {
  const double x = k * r;
  const auto c0 = first_kind ? std::cyl_bessel_j(0, x) : std::cyl_neumann(0, x);
  const auto c1 = first_kind ? std::cyl_bessel_j(1, x) : std::cyl_neumann(1, x);
  const double ratio = nu / (1 - nu);  // lambda / (lambda + 2 mu)
  return k * (c0 - c1 / x) + ratio * c1 / r;
}

double breathing_wave_number(const Parameters& p) {
  const auto determinant = [&](double k) {
    return surface_stress(k, p.inner_radius, true) * surface_stress(k, p.outer_radius, false) -
           surface_stress(k, p.inner_radius, false) * surface_stress(k, p.outer_radius, true);
  };
  double low = 0.05 / p.outer_radius, high = low;
  while (determinant(low) * determinant(high) > 0) high *= 1.02;
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    (determinant(low) * determinant(middle) > 0 ? low : high) = middle;
  }
  return low;
}

}  // namespace

Parameters vessel(const Discretisation& d) {
  Parameters p = test::endless_vessel(d.cross_section, d.correction, d.layer, d.across, d.horizon_ratio);
  p.bond_precision = value_of<Precision>(d.precision).value();
  resolve(p);
  return p;
}

EnergyError energy_error(const Discretisation& d, Strain strain) {
  Parameters p = vessel(d);
  p.ends = peridynamics::EndCondition::free;  // these displacements are not periodic; rows in the middle do
                                              // not feel the ends
  p.end_length.reset();
  resolve(p);
  const auto body = make_body(test::setup_of(p, 1e-7), test::self());
  const Elastic e = elastic(p);
  constexpr double a = strain_amplitude;
  const double twist = a / p.outer_radius;
  body->set_state(test::sample(*body,
                               [&](const std::array<double, 3>& x) -> std::array<double, 3> {
                                 switch (strain) {
                                   case Strain::axial:
                                     return {0, 0, a * x[2]};
                                   case Strain::torsion:
                                     return {-twist * x[1] * x[2], twist * x[0] * x[2], 0};
                                   case Strain::hydrostatic:
                                     break;
                                 }
                                 return {a * x[0], a * x[1], a * x[2]};
                               }),
                  test::sample(*body, test::nothing));
  const Observation& o = body->observe(0);
  const peridynamics::ColumnLayout& l = *body->columns();
  const Lattice lattice = make_lattice(p);
  EnergyError error{0, INFINITY, -INFINITY};
  double total = 0, exact_total = 0;
  for (std::int64_t c = 0; c < l.columns; ++c) {
    const auto i = static_cast<std::size_t>(c);
    const double r = std::hypot(lattice.section.x[i], lattice.section.y[i]);
    double exact = 0;
    switch (strain) {
      case Strain::axial:
        exact = 0.5 * (e.lambda + 2 * e.mu) * a * a;
        break;
      case Strain::torsion:
        exact = 0.5 * e.mu * twist * twist * r * r;
        break;
      case Strain::hydrostatic:
        exact = 1.5 * (3 * e.lambda + 2 * e.mu) * a * a;
        break;
    }
    const double energy = o.strain_energy_density[static_cast<std::size_t>(c * l.rows + l.rows / 2)];
    total += energy * lattice.section.area[i];
    exact_total += exact * lattice.section.area[i];
    error.least = std::min(error.least, energy / exact - 1);
    error.most = std::max(error.most, energy / exact - 1);
  }
  error.wall = total / exact_total - 1;
  return error;
}

double breathing_frequency(const Parameters& p) {
  return breathing_wave_number(p) * wave_speed(p) / (2 * std::numbers::pi);
}

double breathing_shape(const Parameters& p, double r) {
  const double k = breathing_wave_number(p);
  return std::cyl_bessel_j(1, k * r) * surface_stress(k, p.inner_radius, false) -
         std::cyl_neumann(1, k * r) * surface_stress(k, p.inner_radius, true);
}

double measured_breathing(const Discretisation& d, double fraction) {
  const Parameters p = vessel(d);
  const double step = fraction * stable_step(d);
  Field mode;
  double before = 1, quarter = 0, three_quarters = 0;
  breathe(d, step, [&](double now, const Body& body) {
    if (mode[0].empty()) mode = test::sample(body, radial([&](double r) { return breathing_shape(p, r); }));
    const double along = inner_product(displacement(body), mode);
    const double zero = now - step * along / (along - before);  // of the line through both moments
    const bool falls = before > 0 && along <= 0, rises = before < 0 && along >= 0;
    if (falls && quarter == 0 && now > step) quarter = zero;
    if (rises) three_quarters = zero;
    before = along;
    return three_quarters == 0;
  });
  return 0.5 / (three_quarters - quarter);
}

double time_step_error(const Discretisation& d, double fraction) {
  return relative_difference(d, after_a_quarter(d, fraction), after_a_quarter(d, 1.0 / 64));
}

double precision_error(const Discretisation& d) {
  Discretisation single = d, both = d;
  single.precision = "single";
  both.precision = "double";
  return relative_difference(d, after_a_quarter(single, 0.8), after_a_quarter(both, 0.8));
}

std::vector<Dispersion> dispersion(double horizon_ratio) {
  // A square rod, wide enough for its middle column to have a whole family.
  const int half = static_cast<int>(std::ceil(horizon_ratio)) + 1;
  constexpr std::int64_t rows = 240;
  BodySetup setup;
  for (int i = -half; i <= half; ++i) {
    for (int j = -half; j <= half; ++j) {
      setup.lattice.section.x.push_back(i);
      setup.lattice.section.y.push_back(j);
      setup.lattice.section.area.push_back(1);
    }
  }
  setup.lattice.rows = rows;
  setup.lattice.row_spacing = setup.lattice.spacing = 1;
  setup.lattice.horizon = horizon_ratio;
  setup.families = std::make_shared<const BondFamilies>(find_families(setup.lattice));
  setup.layer = {std::vector<double>(setup.lattice.section.size()),
                 std::vector<double>(setup.lattice.section.size())};
  setup.ends = EndCondition::axial_periodic;
  setup.density = 1;
  setup.bond_constant = Pmb::bond_constant(1, horizon_ratio);
  setup.critical_stretch = 1;
  setup.time_step = 1e-3;
  setup.energy_scale = 1;
  setup.double_bonds = true;
  const std::size_t middle = setup.lattice.section.size() / 2;
  const double c = setup.bond_constant;
  const auto body = make_body(std::move(setup), test::self());

  std::vector<Dispersion> result;
  for (const int waves : {2, 6, 12, 24, 40, 60, 80, 120}) {
    const double k = 2 * std::numbers::pi * waves / rows;
    constexpr double amplitude = 1e-6;
    body->set_state(test::sample(*body,
                                 [&](const std::array<double, 3>& x) -> std::array<double, 3> {
                                   return {0, 0, amplitude * std::cos(k * (x[2] - 0.5))};
                                 }),
                    test::sample(*body, test::nothing));
    const double force = body->observe(0).force_density[2][middle * rows];  // at the crest
    // omega^2 = c integral (1 - cos k z) z^2/|xi|^3 dV; over spheres, with m = cos of the angle to z:
    // 2 pi c int_0^delta r int_-1^1 m^2 (1 - cos(k r m)) dm dr.
    double exact = 0;
    constexpr int n = 400;
    for (int ir = 0; ir < n; ++ir) {
      const double r = (ir + 0.5) / n * horizon_ratio;
      for (int im = 0; im < n; ++im) {
        const double m = (im + 0.5) / n;
        exact += r * m * m * (1 - std::cos(k * r * m));
      }
    }
    exact *= 2 * 2 * std::numbers::pi * c * horizon_ratio / (n * n);
    const double long_waves = 1.2;  // (lambda + 2 mu) / rho = 3 * 0.4 E / rho
    result.push_back({2 * std::numbers::pi / k, std::sqrt(-force / amplitude / (k * k) / long_waves),
                      std::sqrt(exact / (k * k) / long_waves)});
  }
  return result;
}

std::vector<double> energy_drift(const Discretisation& d, double amplitude, double fraction, long steps) {
  const Parameters p = vessel(d);
  const BodySetup setup = test::setup_of(p, fraction * stable_step(d));
  const auto body = make_body(BodySetup(setup), test::self());
  body->set_state(initial_displacement(*body, p, amplitude), test::sample(*body, test::nothing));
  constexpr long parts = 10;
  std::vector<double> means;
  for (long part = 0; part < parts; ++part) {
    double sum = 0;
    long looks = 0;
    for (long i = 0; i < steps / parts; ++i) {
      body->advance(0, 0);
      if (i % 100 != 0) continue;
      sum += test::shadow_energy(*body, setup);
      i += 2;
      ++looks;
    }
    means.push_back(sum / static_cast<double>(looks));
  }
  std::vector<double> drift;
  for (double mean : means) drift.push_back(mean / means.front() - 1);
  return drift;
}

std::vector<Ring> expansion(const Discretisation& d, double pressure) {
  const Parameters p = vessel(d);
  const auto body = make_body(test::setup_of(p, 0.6 * stable_step(d)), test::self());
  test::bring_to_rest(*body, pressure, static_cast<int>(800 * d.across));
  const peridynamics::ColumnLayout& l = *body->columns();
  std::map<long, Ring> rings;
  std::map<long, int> count;
  for (std::int64_t c = 0; c < l.columns; ++c) {
    const auto x = body->reference_position(l.particle(c, 0));
    const double r = std::hypot(x[0], x[1]);
    const auto i = static_cast<std::size_t>(c * l.rows);
    const long ring = std::lround(r / p.inner_radius * 1e6);
    rings[ring].r = r;
    rings[ring].displacement += (body->displacement()[0][i] * x[0] + body->displacement()[1][i] * x[1]) / r;
    ++count[ring];
  }
  std::vector<Ring> result;
  for (auto& [key, ring] : rings) result.push_back({ring.r, ring.displacement / count[key]});
  return result;
}

FreeEnds free_ends(const Discretisation& d, int rows) {
  Parameters p = vessel(d);
  p.ends = peridynamics::EndCondition::free;
  p.length = rows * *p.spacing;
  constexpr double pressure = 500;  // strains of 5e-4: small
  const auto body = make_body(test::setup_of(p, 1e-7), test::self());
  const Equilibrium rest = find_equilibrium(test::setup_of(p, 1e-7), pressure, 1e-4, test::self());
  const double inner2 = p.inner_radius * p.inner_radius, outer2 = p.outer_radius * p.outer_radius;
  const double strain = pressure * inner2 / (p.young_modulus * (outer2 - inner2));
  const peridynamics::ColumnLayout& l = *body->columns();
  const std::int64_t middle = l.rows / 2;
  const Lattice lattice = make_lattice(p);
  double error = 0, size = 0, slope = 0, area = 0;
  for (std::int64_t c = 0; c < l.columns; ++c) {
    const auto x = body->reference_position(l.particle(c, middle));
    const auto at = [&](std::int64_t row) { return static_cast<std::size_t>(c * l.rows + row); };
    const double r = std::hypot(x[0], x[1]), weight = lattice.section.area[static_cast<std::size_t>(c)];
    const double u = (rest.displacement[0][at(middle)] * x[0] + rest.displacement[1][at(middle)] * x[1]) / r;
    const double exact = strain * ((1 - nu) * r + (1 + nu) * outer2 / r);
    error += weight * (u - exact) * (u - exact);
    size += weight * exact * exact;
    slope += weight * (rest.displacement[2][at(middle + 1)] - rest.displacement[2][at(middle - 1)]);
    area += weight;
  }
  return {std::sqrt(error / size), slope / (2 * lattice.row_spacing * area) / (-2 * nu * strain) - 1};
}

}  // namespace rhexis::verification
