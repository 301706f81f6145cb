#include "app/network_tier.hpp"

namespace rhexis::app {

std::unique_ptr<NetworkTier> make_tier(const Configuration& c, parallel::Communicator comm) {
  const bool is_tree = c.network.source == "tree";
  if (c.network.tier == "implicit" || (c.network.tier == "auto" && is_tree))
    return make_implicit_tier(c, comm);
  if (c.network.tier == "distributed") return make_distributed_tier(c, comm);
  return make_explicit_tier(c, comm);
}

const char* kind_text(network::VesselKind kind) {
  return kind == network::VesselKind::artery ? "artery"
         : kind == network::VesselKind::vein ? "vein"
                                             : "vessel";
}

}  // namespace rhexis::app
