// SPDX-License-Identifier: BSD-3-Clause
#include "peridynamics/engine/body.hpp"

#include <stdexcept>

#include "peridynamics/engine/column_body_observe.hpp"
#include "peridynamics/engine/column_body_restart.hpp"
#include "peridynamics/engine/column_body_step.hpp"
#include "peridynamics/laws/all_laws.hpp"
#include "peridynamics/laws/correspondence/wall_deformation.hpp"

namespace rhexis::peridynamics {

std::unique_ptr<Body> make_body(BodySetup setup, parallel::Communicator comm) {
  return with_law(setup.law, [&]<class Law>(const Law& law) -> std::unique_ptr<Body> {
    if (setup.double_bonds) return std::make_unique<ColumnBody<Law, double>>(law, std::move(setup), comm);
    return std::make_unique<ColumnBody<Law, float>>(law, std::move(setup), comm);
  });
}

WallDeformation Body::wall_deformation(std::size_t /*particle*/) const {
  throw std::logic_error("this body knows no deformation of a wall");
}

double body_bytes(const LawChoice& law, bool double_bonds, const BodySize& size) {
  return with_law(law, [&]<class Law>(const Law&) {
    return double_bonds ? ColumnBody<Law, double>::bytes(size) : ColumnBody<Law, float>::bytes(size);
  });
}

}  // namespace rhexis::peridynamics
