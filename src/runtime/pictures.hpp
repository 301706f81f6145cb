// SPDX-License-Identifier: BSD-3-Clause
/// Starting ParaView for a run, or saying why there will be no pictures.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "insitu/parameters.hpp"
#include "insitu/pipeline.hpp"
#include "output/results_folder.hpp"
#include "output/staging_folder.hpp"
#include "parallel/communicator.hpp"

namespace rhexis::runtime {

struct Pictures {
  /// Whether some script wants this moment. Collective; throws as insitu::Pipeline.
  bool wants(long step, double time_s);
  /// Runs the scripts; their pictures become results, in images/, when they are complete. Collective; throws
  /// as insitu::Pipeline, and RunError where a picture would replace one of the user's or of another script.
  void process(long step, double time_s, const insitu::Channels& channels);

  std::unique_ptr<output::StagingFolder> staging;  ///< where scripts draw
  std::unique_ptr<insitu::Pipeline> pipeline;      ///< null: no pictures
  std::string description;                         ///< who draws, or why nobody does; empty: not started
  /// Where several runs share them, one after the other: steps and seconds of those before, which scripts see
  /// added to those of the run at hand.
  long steps_before = 0;
  double seconds_before = 0;
};

/// What a run is to draw.
struct PicturesPlan {
  insitu::Parameters insitu = {};
  std::vector<insitu::ChannelFields> channels = {};  ///< that the run has
  std::string obstacle = {};  ///< why there can be no pictures, where scripts are named; else empty
};

/// The scripts named in the input become absolute paths: of Rhexis's own by a plain name, of the user's by a
/// path. Then reads them without running them, where there can be pictures, or says what the obstacle is;
/// what is wrong with a script is an InputError of the key insitu.scripts. Collective.
void find_scripts(PicturesPlan& plan, const std::string& input_file, parallel::Communicator comm);

/// `before_abort`: see insitu::Settings. Collective. Throws InputError for a script that has become bad since
/// `find_scripts`.
Pictures start_pictures(const PicturesPlan& plan, const output::ResultsFolder& results,
                        parallel::Communicator comm, std::function<void(const std::string&)> before_abort);

}  // namespace rhexis::runtime
