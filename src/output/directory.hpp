/// The folder that a run writes to.
#pragma once

#include <filesystem>
#include <memory>

#include "parallel/communicator.hpp"

namespace rhexis::output {

/// What becomes of the results that an earlier run left in the folder.
enum class EarlierResults {
  remove,  ///< so that results of two runs never mix
  keep     ///< a restart continues them
};

/// Makes `directory` with its parents, `images/` and `checkpoints/`, and makes sure that it can be written
/// to. Of earlier results only the files that runs write are removed (run.json, history.csv, particles*.h5
/// and .xdmf, network.*, tables, movie.mp4, images/<name>_<digits>.png, and the same in a cascade's folders
/// event_<digits>); checkpoints and everything else stay. The samples of an ensemble, which took long, are
/// not removed: their folder is refused, and so is one where another run is still writing: as long as what
/// is returned lives, this run is known to (flock, on the root). Collective; throws InputError on all ranks
/// if the folder cannot be used, and then leaves nothing new behind.
std::shared_ptr<const void> prepare_directory(const std::filesystem::path& directory, EarlierResults earlier,
                                              const parallel::Communicator& communicator);

}  // namespace rhexis::output
