// SPDX-License-Identifier: BSD-3-Clause
/// An artery's wall: layers of a neo-Hookean matrix with families of collagen fibres.
///
///   W = W_neo-Hookean(mu, lambda; F) + sum over families k1/(2 k2) (exp(k2 <E>^2) - 1),
///   E = kappa (I1 - 3) + (1 - 3 kappa) (|F a|^2 - 1),   <E> = max(E, 0),
///   P = P_neo-Hookean + sum 2 k1 <E> exp(k2 <E>^2) (kappa F + (1 - 3 kappa) F a (x) a),
///
/// with the direction a of a family at rest, along the wall, and its dispersion kappa, from 0 (aligned) to
/// 1/3 (no direction); fibres bear tension only. Holzapfel, Gasser & Ogden 2000, J. Elasticity 61, 1-48; with
/// dispersion Gasser, Ogden & Holzapfel 2006, J. R. Soc. Interface 3, 15-35. The invariants are those of F
/// itself, as in Nolan, Gower, Destrade, Ogden & McGarry 2014, J. Mech. Behav. Biomed. Mater. 39, 48-60: with
/// those of its isochoric part, fibres would blow up a wall that is slightly compressible.
///
///   [material]
///   law = "fibre_reinforced"
///   poisson_ratio = 0.49
///   [[layer]]                # from the lumen outwards
///   name = "media"
///   thickness = 0.67         # its share of the wall's
///   shear_modulus = "3 kPa"
///   [[fibre]]
///   layer = "media"
///   angle = "29 deg"         # from the circumference towards the axis
///   k1 = "2.3632 kPa"
///   k2 = 0.8393
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string_view>
#include <utility>
#include <vector>

#include "peridynamics/geometry/wall_frame.hpp"
#include "peridynamics/laws/correspondence/neo_hookean.hpp"
#include "peridynamics/laws/correspondence/wall_layers.hpp"

namespace rhexis::peridynamics {

struct FibreReinforced {
  static constexpr std::string_view name = "fibre_reinforced";
  static constexpr std::string_view meaning =
      "an artery's layers of matrix and collagen fibres, by its deformation gradient";
  static constexpr std::string_view source = "Holzapfel, Gasser & Ogden 2000; Gasser, Ogden & Holzapfel 2006";

  std::vector<WallLayer> layers;
  double shear_modulus = 0;  ///< Pa, the unit of stress: the stiffest matrix's
  double lame = 0;           ///< lambda / mu of every matrix

  FibreReinforced(std::vector<WallLayer> of_wall, double poisson_ratio)
      : layers(std::move(of_wall)), lame(lame_ratio(poisson_ratio)) {
    for (const WallLayer& layer : layers) shear_modulus = std::max(shear_modulus, layer.shear_modulus);
  }

  /// The layer at a depth, from 0 at the lumen to 1 at the outer surface.
  const WallLayer& layer_at(double depth) const {
    double until = 0;
    for (const WallLayer& layer : layers) {
      until += layer.thickness;
      if (depth < until) return layer;
    }
    return layers.back();
  }

  /// By how much it may stiffen up to a stretch: the largest tangent modulus over that at rest.
  double stiffening(double stretch) const {
    double most = 1;
    for (const WallLayer& layer : layers) {
      double fibres = 0;
      for (const FibreFamily& family : layer.fibres) {
        // d2W/dl2 at the stretch l, with E = c (l^2 - 1), where the other stretches are 1 at most.
        const double l = 1 + stretch, c = 1 - 2 * family.dispersion, e = c * (l * l - 1), de = 2 * c * l;
        const double q = family.k2 * e * e;
        fibres += family.k1 * std::exp(q) * ((1 + 2 * q) * de * de + 2 * c * e);
      }
      most = std::max(most, 1 + fibres / (layer.shear_modulus * (lame + 2)));
    }
    return most;
  }

  /// The law at the particles of a rank.
  template <class Real>
  class AtParticles {
   public:
    /// `frames`: of each particle; null where none stands.
    AtParticles(const FibreReinforced& law, const std::vector<const WallFrame*>& frames)
        : lame_(static_cast<Real>(law.lame)), matrix_(frames.size(), Real(0)) {
      for (std::size_t i = 0; i < frames.size(); ++i) {
        if (frames[i] == nullptr) continue;
        const WallLayer& layer = law.layer_at(frames[i]->depth);
        matrix_[i] = static_cast<Real>(layer.shear_modulus / law.shear_modulus);
        for (std::size_t f = 0; f < layer.fibres.size(); ++f) {
          if (f == families_.size()) families_.emplace_back(frames.size());
          families_[f].put(i, layer.fibres[f], *frames[i], law.shear_modulus);
        }
      }
    }

    /// Shear modulus of the matrix of the particles from `i` on, in units of the law's.
    template <Number X>
    HWY_INLINE X shear_modulus(std::size_t i) const {
      return number_at<X>(matrix_, i);
    }

    /// First Piola-Kirchhoff stress of the particles from `i` on, in units of the law's shear modulus.
    template <Number X>
    HWY_INLINE Tensor<X> stress(const Deformation<X>& f, std::size_t i) const {
      Tensor<X> p = product(shear_modulus<X>(i), neo_hookean_stress(f, X(lame_)));
      for (const Family& family : families_) {
        const auto fibre = family.template at<X>(i);
        const Extension<X> extension(f, fibre);
        const X e = max(extension.strain, X(0));
        const X pull = X(2) * fibre.k1 * e * exp(fibre.k2 * e * e);
        const X along = pull * (X(1) - X(3) * fibre.dispersion);
        add_product(p, pull * fibre.dispersion, f.deformation());
        add_dyad(p, along, extension.direction, fibre.direction);
      }
      return p;
    }

    /// W of particle `i`, in units of the law's shear modulus.
    double energy(const Deformation<double>& f, std::size_t i) const {
      double energy = double{matrix_[i]} * neo_hookean_energy(f, double{lame_});
      for (const Family& family : families_) {
        const auto fibre = family.template at<double>(i);
        const double e = std::max(Extension<double>(f, fibre).strain, 0.0);
        energy += fibre.k1 / (2 * fibre.k2) * std::expm1(fibre.k2 * e * e);
      }
      return energy;
    }

    /// The largest stretch |F a| of the fibre families of particle `i`; 1 where it has none.
    double fibre_stretch(const Deformation<double>& f, std::size_t i) const {
      double largest = 0;
      for (const Family& family : families_) {
        if (family.k1[i] == 0) continue;
        const auto& [x, y, z] = Extension<double>(f, family.template at<double>(i)).direction;
        largest = std::max(largest, std::hypot(x, y, z));
      }
      return largest > 0 ? largest : 1;
    }

   private:
    // clang++ 14 crashes where these two are constrained to Number.
    template <class X>
    struct Fibre {
      X direction[3], k1, k2, dispersion;
    };

    /// What a deformation does to a fibre: F a and E.
    template <class X>
    struct Extension {
      X direction[3], strain;

      HWY_INLINE Extension(const Deformation<X>& f, const Fibre<X>& fibre)
          : Extension(f, fibre, times(f.gradient, fibre.direction)) {}

     private:
      HWY_INLINE Extension(const Deformation<X>& f, const Fibre<X>& fibre, const std::array<X, 3>& step)
          : direction{fibre.direction[0] + step[0], fibre.direction[1] + step[1],
                      fibre.direction[2] + step[2]},
            strain(fibre.dispersion * f.first_invariant() +
                   (X(1) - X(3) * fibre.dispersion) * ((direction[0] + fibre.direction[0]) * step[0] +
                                                       (direction[1] + fibre.direction[1]) * step[1] +
                                                       (direction[2] + fibre.direction[2]) * step[2])) {}
    };

    struct Family {
      explicit Family(std::size_t particles)
          : k1(particles, Real(0)), k2(particles, Real(1)), dispersion(particles, Real(0)) {
        for (auto& component : direction) component.assign(particles, Real(0));
      }
      void put(std::size_t i, const FibreFamily& family, const WallFrame& frame, double unit) {
        const std::array<double, 3> a = frame.along_wall(family.angle);
        for (std::size_t k = 0; k < 3; ++k) direction[k][i] = static_cast<Real>(a[k]);
        k1[i] = static_cast<Real>(family.k1 / unit);
        k2[i] = static_cast<Real>(family.k2);
        dispersion[i] = static_cast<Real>(family.dispersion);
      }
      template <Number X>
      HWY_INLINE Fibre<X> at(std::size_t i) const {
        return {{number_at<X>(direction[0], i), number_at<X>(direction[1], i), number_at<X>(direction[2], i)},
                number_at<X>(k1, i),
                number_at<X>(k2, i),
                number_at<X>(dispersion, i)};
      }

      std::array<std::vector<Real>, 3> direction;
      std::vector<Real> k1, k2, dispersion;  ///< k1 is 0 where a particle has no such family
    };

    template <Number X>
    static HWY_INLINE X number_at(const std::vector<Real>& values, std::size_t i) {
      if constexpr (is_lanes<X>) {
        return X::load(values.data() + i);
      } else {
        return static_cast<X>(values[i]);
      }
    }

    Real lame_;
    std::vector<Real> matrix_;
    std::vector<Family> families_;
  };
};

}  // namespace rhexis::peridynamics
