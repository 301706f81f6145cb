// SPDX-License-Identifier: BSD-3-Clause
#include "peridynamics/monitors/wall_gauge.hpp"

#include "peridynamics/monitors/opening.hpp"

namespace rhexis::peridynamics {
namespace {

class TubeGauge final : public WallGauge {
 public:
  TubeGauge(const WallModel& wall, const Body& body, parallel::Communicator comm)
      : lattice_(wall.lattice()),
        opening_(lattice_, body, comm, wall.setup.ends, wall.setup.thin_spots, wall.general.lattice_number),
        lumen_(lattice_, body, comm, wall.general.lattice_number) {}
  double open_area() const override { return opening_.area(); }
  double resistance_factor() const override { return lumen_.resistance_factor(); }
  double largest_lumen_stretch() const override { return lumen_.largest_stretch(); }

 private:
  Lattice lattice_;
  OpeningGauge opening_;
  LumenGauge lumen_;
};

}  // namespace

std::unique_ptr<WallGauge> make_gauge(const WallModel& wall, const Body& body, parallel::Communicator comm) {
  return std::make_unique<TubeGauge>(wall, body, comm);
}

}  // namespace rhexis::peridynamics
