// SPDX-License-Identifier: BSD-3-Clause
// Measured against closed forms: what the tests in this folder hold and postprocessing/verify.py reports.
#pragma once

#include <string>
#include <vector>

#include "peridynamics/parameters.hpp"

namespace rhexis::verification {

/// An arrangement of particles in the wall of the paper's vessel (Table 2).
struct Discretisation {
  std::string cross_section, correction, layer;
  double across = 5;           ///< spacings across the wall
  double horizon_ratio = 3.5;  ///< horizon in spacings
  std::string precision = "double";
};

/// An endless piece of that vessel, resolved.
peridynamics::Parameters vessel(const Discretisation& d);

/// Elastic energy in the wall under a homogeneous strain, relative to the exact one, less 1: over the whole
/// wall, and the extremes over its columns.
struct EnergyError {
  double wall = 0, least = 0, most = 0;
};
enum class Strain { axial, torsion, hydrostatic };
EnergyError energy_error(const Discretisation& d, Strain strain);

/// Frequency of the gravest axisymmetric plane-strain vibration of a free tube, Hz: u_r = A J1(k r) + B Y1(k
/// r) with both surfaces free.
double breathing_frequency(const peridynamics::Parameters& p);
/// Its radial displacement at r, of arbitrary size.
double breathing_shape(const peridynamics::Parameters& p, double r);

/// Frequency (Hz) at which the particles breathe, with a step of `fraction` of the stable one: from the times
/// at which their displacement along the exact mode passes zero.
double measured_breathing(const Discretisation& d, double fraction);

/// Error of displacements after a quarter of a breath with a step of `fraction`, against a step of 1/64 of
/// the stable one; L2, relative to the displacements at the start.
double time_step_error(const Discretisation& d, double fraction);

/// Largest relative difference of displacement between single- and double-precision bonds after half a
/// breath.
double precision_error(const Discretisation& d);

/// Plane longitudinal waves along the axis, u_z = cos(k z), in the bulk: phase speed over that of long waves.
struct Dispersion {
  double per_wavelength = 0;  ///< spacings
  double measured = 0;        ///< from the forces on a particle with a whole family
  double exact = 0;           ///< of the PMB continuum with the same horizon
};
std::vector<Dispersion> dispersion(double horizon_ratio);

/// Energy of the vessel that breathes undamped, from strains of `amplitude`, with a step of `fraction` of the
/// stable one: means over tenths of so many steps, relative to the first, less 1.
std::vector<double> energy_drift(const Discretisation& d, double amplitude, double fraction, long steps);

/// Mean radial displacement (m) of each ring of a polar vessel at rest under a dead pressure (Pa) of any
/// size.
struct Ring {
  double r = 0, displacement = 0;
};
std::vector<Ring> expansion(const Discretisation& d, double pressure);

/// A vessel with free ends, so many rows long, at rest under a small pressure, against Lame's tube without
/// axial force, at mid-length: L2 error of the radial displacement relative to his, and the axial strain over
/// his less 1.
struct FreeEnds {
  double displacement = 0, axial_strain = 0;
};
FreeEnds free_ends(const Discretisation& d, int rows);

}  // namespace rhexis::verification
