#include "app/network_tier.hpp"

namespace rhexis::app {

std::unique_ptr<NetworkTier> make_tier(const Configuration& c, parallel::Communicator comm) {
  return make_implicit_tier(c, comm);
}

}  // namespace rhexis::app
