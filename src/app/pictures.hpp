/// Starting ParaView for a run, or saying why there will be no pictures.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "insitu/parameters.hpp"
#include "insitu/pipeline.hpp"
#include "parallel/communicator.hpp"

namespace rhexis::app {

struct Pictures {
  std::unique_ptr<insitu::Pipeline> pipeline;  ///< null: no pictures
  std::string description;                     ///< who draws, or why nobody does
};

/// Collective. Throws RunError for a bad script.
Pictures start_pictures(const insitu::Parameters& parameters, const std::filesystem::path& results,
                        parallel::Communicator comm);

}  // namespace rhexis::app
