#include "app/network_tier.hpp"

#include "core/error.hpp"

namespace rhexis::app {

namespace {

std::unique_ptr<NetworkTier> make_tier(const Configuration& c, parallel::Communicator comm) {
  const bool is_tree = c.network.source == "tree";
  if (c.network.tier == "implicit" || (c.network.tier == "auto" && is_tree))
    return make_implicit_tier(c, comm);
  if (c.network.tier == "distributed") return make_distributed_tier(c, comm);
  return make_explicit_tier(c, comm);
}

}  // namespace

std::unique_ptr<NetworkTier> prepared_tier(const Configuration& c, parallel::Communicator comm) {
  auto tier = make_tier(c, comm);
  try {
    tier->prepare();
  } catch (const InputError& error) {
    throw input::located(error, c.resolved);
  }
  return tier;
}

const char* kind_text(network::VesselKind kind) {
  return kind == network::VesselKind::artery ? "artery"
         : kind == network::VesselKind::vein ? "vein"
                                             : "vessel";
}

}  // namespace rhexis::app
