// SPDX-License-Identifier: BSD-3-Clause
#include "peridynamics/monitors/wall_gauge.hpp"

#include "peridynamics/monitors/opening.hpp"

namespace rhexis::peridynamics {
namespace {

class TubeGauge final : public WallGauge {
 public:
  TubeGauge(const BodySetup& setup, const Body& body, parallel::Communicator comm)
      : lattice_(setup.lattice),
        opening_(lattice_, body, comm, setup.ends, setup.thin_spots),
        lumen_(lattice_, body, comm) {}
  double open_area() const override { return opening_.area(); }
  double resistance_factor() const override { return lumen_.resistance_factor(); }
  double largest_lumen_stretch() const override { return lumen_.largest_stretch(); }

 private:
  Lattice lattice_;
  OpeningGauge opening_;
  LumenGauge lumen_;
};

}  // namespace

std::unique_ptr<WallGauge> make_gauge(const BodySetup& setup, const Body& body, parallel::Communicator comm) {
  return std::make_unique<TubeGauge>(setup, body, comm);
}

}  // namespace rhexis::peridynamics
