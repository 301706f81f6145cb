// SPDX-License-Identifier: BSD-3-Clause
// Prints one study as a table of comma-separated values, for postprocessing/verify.py:
//
//   verification elasticity|energy|breathing|time_step|precision|expansion DISCRETISATION [NUMBER]
//   verification dispersion HORIZON_RATIO
//   verification drift DISCRETISATION AMPLITUDE STEPS
//   verification free_ends DISCRETISATION ROWS
//
// DISCRETISATION: cross-section, surface correction, layer, spacings across the wall, horizon in spacings.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "convergence/studies.hpp"
#include "parallel/communicator.hpp"
#include "peridynamics/statics/elastic_error.hpp"
#include "support/vessels.hpp"

namespace rhexis::verification {
namespace {

int run(int argc, char** argv) {
  const std::string study = argc > 1 ? argv[1] : "";
  if (study == "dispersion" && argc == 3) {
    std::puts("spacings_per_wavelength,measured,exact");
    for (const Dispersion& row : dispersion(std::atof(argv[2])))
      std::printf("%.10g,%.10g,%.10g\n", row.per_wavelength, row.measured, row.exact);
    return 0;
  }
  if (argc < 7) {
    std::fputs("usage: verification STUDY CROSS_SECTION CORRECTION LAYER ACROSS RATIO [NUMBER]\n", stderr);
    return 2;
  }
  const Discretisation d{argv[2], argv[3], argv[4], std::atof(argv[5]), std::atof(argv[6])};
  const double number = argc > 7 ? std::atof(argv[7]) : 0.8;
  if (study == "elasticity") {
    const peridynamics::Parameters p = vessel(d);
    const auto setup = test::setup_of(p, 1e-7);
    const peridynamics::ElasticError e = peridynamics::elastic_error(p, setup, INFINITY).value();
    std::puts("columns,bonds_a_particle,stable_step_s,error,spread");
    std::printf(
        "%zu,%.10g,%.10g,%.10g,%.10g\n", setup.lattice.section.size(),
        static_cast<double>(setup.families->bonds.size()) / static_cast<double>(setup.lattice.section.size()),
        test::stable_step_of(setup), e.relative_l2, e.spread);
  } else if (study == "energy") {
    std::puts("strain,wall,least,most");
    const std::pair<const char*, Strain> strains[] = {
        {"axial", Strain::axial}, {"torsion", Strain::torsion}, {"hydrostatic", Strain::hydrostatic}};
    for (const auto& [name, strain] : strains) {
      const EnergyError e = energy_error(d, strain);
      std::printf("%s,%.10g,%.10g,%.10g\n", name, e.wall, e.least, e.most);
    }
  } else if (study == "breathing") {
    const double exact = breathing_frequency(vessel(d)), measured = measured_breathing(d, number);
    std::puts("exact_Hz,measured_Hz,error");
    std::printf("%.10g,%.10g,%.10g\n", exact, measured, measured / exact - 1);
  } else if (study == "time_step") {
    std::printf("error\n%.10g\n", time_step_error(d, number));
  } else if (study == "precision") {
    std::printf("difference\n%.10g\n", precision_error(d));
  } else if (study == "drift" && argc == 9) {
    const long steps = std::atol(argv[8]);
    std::puts("step,drift");
    long part = 0;
    for (double drift : energy_drift(d, number, 0.65, steps))
      std::printf("%ld,%.10g\n", ++part * steps / 10, drift);
  } else if (study == "free_ends" && argc == 8) {
    const FreeEnds e = free_ends(d, std::atoi(argv[7]));
    std::printf("displacement,axial_strain\n%.10g,%.10g\n", e.displacement, e.axial_strain);
  } else if (study == "expansion") {
    std::puts("r_m,displacement_m");
    for (const Ring& ring : expansion(d, number)) std::printf("%.10g,%.10g\n", ring.r, ring.displacement);
  } else {
    std::fprintf(stderr, "no study %s\n", study.c_str());
    return 2;
  }
  return 0;
}

}  // namespace
}  // namespace rhexis::verification

int main(int argc, char** argv) {
  const rhexis::parallel::Session session(argc, argv);
  return rhexis::verification::run(argc, argv);
}
